"""What the rover's surfaces are like: materials, the texture of its deck, and where faces show it."""
import numpy as np


def material(r, g, b, metallic, roughness, **more):
    """glTF material; colour in linear values."""
    return {"pbrMetallicRoughness": {"baseColorFactor": [r, g, b, 1.0], "metallicFactor": metallic,
                                     "roughnessFactor": roughness}, **more}


MATERIALS = {
    "white_paint": material(0.80, 0.80, 0.78, 0.0, 0.55),
    "gold_foil": material(0.86, 0.55, 0.15, 0.6, 0.34),
    "wheel_metal": material(0.50, 0.51, 0.53, 0.65, 0.42),
    "grouser": material(0.30, 0.31, 0.32, 0.8, 0.5),
    "structure": material(0.62, 0.63, 0.65, 0.45, 0.38),
    "titanium": material(0.27, 0.26, 0.25, 0.6, 0.45),
    "dark_anodised": material(0.035, 0.037, 0.042, 0.4, 0.5),
    "radiator": material(0.88, 0.90, 0.92, 0.0, 0.25),
    "lens": material(0.012, 0.015, 0.03, 0.1, 0.08),
    "accent": material(0.75, 0.13, 0.03, 0.0, 0.5),
    "deck_texture": {"pbrMetallicRoughness": {
        "baseColorTexture": {"index": 0}, "baseColorFactor": [1.0, 1.0, 1.0, 1.0],
        "metallicFactor": 0.15, "roughnessFactor": 0.35}},
}

CELLS = (0.0, 0.0, 1.0, 0.75)  # u0 v0 u1 v1 of the solar cells in the texture, v down
PLATE = (0.0, 0.78, 0.75, 1.0)  # name plate
MARKS = (0.78, 0.78, 1.0, 1.0)  # chequered fiducial
PLAIN = (0.4, 0.765)  # a point of plain dark edge
FONT = {"D": "11110 10001 10001 10001 10001 10001 11110", "S": "01111 10000 10000 01110 00001 00001 11110",
        "P": "11110 10001 10001 11110 10000 10000 10000", "A": "01110 10001 10001 11111 10001 10001 10001",
        "C": "01111 10000 10000 10000 10000 10000 01111", "E": "11111 10000 10000 11110 10000 10000 11111"}


def texture():
    """256 × 256 RGB: 4 × 3 solar cells, name plate, fiducial mark."""
    n = 256
    image = np.full((n, n, 3), (26, 26, 30), np.uint8)
    y, x = np.mgrid[0:192, 0:256]
    cx, cy = x % 64, y % 64
    inside = (cx >= 2) & (cx < 62) & (cy >= 2) & (cy < 62)
    inside &= np.minimum(cx, 63 - cx) + np.minimum(cy, 63 - cy) > 12  # cut corners
    shade = 1.0 + 0.12 * ((x // 64 + 2 * (y // 64)) % 3 - 1) + 0.10 * (cy - 32) / 32
    cell = np.clip(np.array([18, 30, 82]) * shade[..., None], 0, 255)
    image[:192][inside] = cell[inside].astype(np.uint8)
    image[:192][inside & (cy % 6 == 3)] = (62, 74, 124)  # fingers
    image[:192][inside & ((abs(cx - 22) < 1) | (abs(cx - 42) < 1))] = (168, 172, 180)  # bus bars
    image[200:, :192] = (224, 224, 220)
    image[200:204, :192] = image[252:, :192] = (190, 46, 18)
    for k, letter in enumerate("DSPACE"):
        bits = np.array([[int(c) for c in row] for row in FONT[letter].split()], bool)
        big = np.kron(bits, np.ones((4, 4), bool))
        image[214:242, 14 + 28 * k:34 + 28 * k][big] = (20, 22, 28)
    yy, xx = np.mgrid[0:56, 0:56]
    marks = ((yy // 14 + xx // 14) % 2).astype(bool)
    image[200:, 200:] = np.where(marks[..., None], 240, 16)
    return image


def faced(normal, u_axis, v_axis, window):
    """Texture mapping: faces along `normal` are stretched over `window`, with u along u_axis and v
    (running down in the image) along v_axis; the other faces get the plain dark point."""
    def mapping(p, n):
        uv = np.tile(PLAIN, (len(p), 1)).astype(float)
        front = n @ np.asarray(normal, float) > 0.9
        a, b = p[front] @ np.asarray(u_axis, float), p[front] @ np.asarray(v_axis, float)
        a, b = (a - a.min()) / np.ptp(a), (b - b.min()) / np.ptp(b)
        u0, v0, u1, v1 = window
        uv[front] = np.column_stack([u0 + a * (u1 - u0), v0 + b * (v1 - v0)])
        return uv
    return mapping
