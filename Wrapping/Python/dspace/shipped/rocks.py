"""The rocks of the shipped field as meshes: angular stones, some blocks of ground a mesh, coarser with distance."""
import numpy as np

# The rocks of some diameters [m], in square blocks of ground [m] that are one mesh each; of its levels, from fine to coarse:
# the apparent size of the block from which it is drawn [pixels], the least diameter of the rocks that it shows, and the
# diameters from which they are divided once and twice.
LARGE = (0.3, np.inf), 25.0, ((2500, 0.0, 0.0, 0.6), (1000, 0.0, 0.0, np.inf), (0, 0.0, np.inf, np.inf))
SMALL = (0.0, 0.3), 8.0, ((1500, 0.0, 0.13, np.inf), (550, 0.09, np.inf, np.inf), (0, 0.2, np.inf, np.inf))
SHAPES = 12  # different stones
COLOR = np.array((0.55, 0.535, 0.51))  # sRGB; a little brighter than the soil


def add_rocks(scene, path):
    """Adds the rocks of a file that Data/generators/make_site.py writes: rows x, y, ground, diameter, height, turn.
    Returns the meshes."""
    rocks = np.load(path).astype(float)
    stones = [_stones(fineness) for fineness in range(3)]
    made = []
    for name, ((least, most), size, levels) in (("large", LARGE), ("small", SMALL)):
        chosen = rocks[(rocks[:, 3] >= least) & (rocks[:, 3] < most)]
        for block, here in _blocks(chosen, size):
            meshes = [(_mesh(shown, stones, once, twice), pixels) for pixels, smallest, once, twice in levels
                      if len(shown := here[here[:, 3] >= smallest])]
            (finest, pixels), coarser = meshes[0], meshes[1:]
            made.append(scene.add_mesh(**finest, pixels=pixels if coarser else 0.0, levels=coarser, roughness=1.0,
                                       name="{} rocks {} {}".format(name, *block)))
    return made


def _blocks(rocks, size):
    """(column, row), rocks of each square block of ground that has some."""
    blocks = np.floor(rocks[:, :2] / size).astype(int)
    order = np.lexsort(blocks.T)
    rocks, blocks = rocks[order], blocks[order]
    first = np.flatnonzero(np.r_[True, (np.diff(blocks, axis=0) != 0).any(axis=1)])
    return zip(blocks[first], np.split(rocks, first[1:]))


def _mesh(rocks, stones, once, twice):
    """Arrays of a mesh."""
    points, triangles, colors, count = [], [], [], 0
    fineness = (rocks[:, 3] >= once).astype(int) + (rocks[:, 3] >= twice)
    for k, (shapes, faces) in enumerate(stones):
        if not (fineness == k).any():
            continue
        x, y, ground, diameter, height, turn = rocks[fineness == k].T
        number = (np.abs(x * 1000) + np.abs(y * 1000)).astype(int)
        # A little wider and higher than the half ellipsoid in the heights, which it hides.
        p = shapes[number % SHAPES] * np.stack([0.56 * diameter, 0.56 * diameter, 1.12 * height], axis=-1)[:, None]
        c, s = np.cos(turn)[:, None], np.sin(turn)[:, None]
        p = np.stack([x[:, None] + c * p[..., 0] - s * p[..., 1], y[:, None] + s * p[..., 0] + c * p[..., 1],
                      ground[:, None] + p[..., 2]], axis=-1)
        vertices = shapes.shape[1]
        first = count + vertices * np.arange(len(x))
        triangles.append((faces[number % SHAPES] + first[:, None, None]).reshape(-1, 3))
        points.append(p.reshape(-1, 3))
        colors.append(np.repeat(COLOR * (0.85 + 0.3 * (number % 97) / 96)[:, None], vertices, axis=0))
        count += len(x) * vertices
    return {"points": np.vstack(points), "triangles": np.vstack(triangles), "colors": np.clip(np.vstack(colors), 0, 1)}


def _stones(fineness):
    """Points (SHAPES, n, 3) and triangles (SHAPES, m, 3) of all stones, without the quarter that lies lowest in the
    ground."""
    made = [_stone(seed, fineness) for seed in range(SHAPES)]
    keep = len(made[0][1]) * 3 // 4
    highest = [np.argsort(-p[t][:, :, 2].max(axis=1), kind="stable")[:keep] for p, t in made]
    return np.stack([p for p, _ in made]), np.stack([t[k] for (_, t), k in zip(made, highest)])


def _stone(seed, fineness):
    """A stone of about radius 1: an icosahedron, divided and cut by planes; its lowest part lies below 0, in the ground."""
    rng = np.random.default_rng(1000 + seed)
    g = (1 + 5 ** 0.5) / 2
    p = [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g), (0, -1, -g), (0, 1, -g), (g, 0, -1),
         (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]
    t = np.array([(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6),
                  (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10),
                  (8, 6, 7), (9, 8, 1)])
    p = np.array(p) / np.hypot(1, g) @ np.linalg.qr(rng.normal(size=(3, 3)))[0]
    if np.einsum("i,i", p[t[0, 0]], np.cross(p[t[0, 1]], p[t[0, 2]])) < 0:
        t = t[:, ::-1]  # mirrored
    for _ in range(fineness):
        p, t = _divided(p, t)
    # Planes that cut it flat, the same at every fineness, and roughness by direction.
    directions = rng.normal(size=(9, 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    depths = 0.72 + 0.25 * rng.random(9)
    for direction, depth in zip(directions, depths):
        along = p @ direction
        p = p - np.maximum(along - depth, 0)[:, None] * direction
    waves = rng.normal(size=(5, 3)) * 3.0
    p = p * (1 + 0.05 * np.sin(p @ waves.T + rng.random(5) * 6.28).sum(axis=1, keepdims=True) / 2)
    p = p * (1.0 + 0.15 * rng.random(), 0.8 + 0.15 * rng.random(), 1.0)
    p[:, 2] = np.where(p[:, 2] < 0, 0.35 * p[:, 2], p[:, 2] / max(p[:, 2].max(), 0.5))
    return p, t


def _divided(p, t):
    """Each triangle as four, on the unit sphere."""
    edges = np.sort(np.concatenate([t[:, [0, 1]], t[:, [1, 2]], t[:, [2, 0]]]), axis=1)
    unique, back = np.unique(edges, axis=0, return_inverse=True)
    middle = p[unique].sum(axis=1)
    middle /= np.linalg.norm(middle, axis=1, keepdims=True)
    a, b, c = (len(p) + back.ravel()[k * len(t):(k + 1) * len(t)] for k in range(3))
    return (np.vstack([p, middle]),
            np.concatenate([np.column_stack(k) for k in ((t[:, 0], a, c), (a, t[:, 1], b), (c, b, t[:, 2]), (a, b, c))]))
