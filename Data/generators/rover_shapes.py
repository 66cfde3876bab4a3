"""The rover's parts as meshes, each in its link's axes, metres, and where its joints are."""
import numpy as np

from meshkit import (Part, box, cylinder, loft, moved, prism, revolve, rounded_path, sweep, tube,
                     turn)
from rover_finish import CELLS, MARKS, PLATE, faced


class Layout:
    """Where the joints are, in the chassis frame with all joints at zero [m]; left side (Y > 0)."""
    wheel_radius = 0.20  # over the grousers
    wheel_width = 0.24
    wheel_y = 0.62
    front_x, middle_x, rear_x = 0.82, 0.0, -0.82
    rocker = np.array([0.0, 0.40, 0.56])
    bogie = np.array([-0.41, 0.46, 0.36])  # halfway between its wheels
    steer_z = 0.50
    mast = np.array([0.36, -0.17, 0.725])
    mast_pan_z, mast_tilt_z = 0.60, 0.075  # above the mast's foot, above the pan joint
    antenna = np.array([-0.30, 0.27, 0.725])
    antenna_z, dish_z = 0.20, 0.05
    arm = np.array([0.64, 0.22, 0.50])
    upper_arm, fore_arm = 0.44, 0.40


def bolts(n, radius, size, axis="y", centre=(0, 0, 0), offset=0.0):
    """A ring of small hexagonal heads about an axis, each reaching `size` along it."""
    solids = []
    for k in range(n):
        a = 2 * np.pi * k / n
        p = {"y": (radius * np.sin(a), offset, radius * np.cos(a)),
             "z": (radius * np.cos(a), radius * np.sin(a), offset)}[axis]
        solids.append(moved(cylinder(size, size, 6, axis), np.add(p, centre)))
    return solids


def crinkled(size, cells, amplitude, centre, seed):
    """Box of foil: its faces subdivided and dented at random."""
    size = np.asarray(size, float)
    solid = []
    index, vertices = {}, []

    def vertex(g):
        g = tuple(g)
        if g not in index:
            index[g] = len(vertices)
            vertices.append((np.array(g) / cells - 0.5) * size)
        return index[g]

    for axis in range(3):
        i, j = (axis + 1) % 3, (axis + 2) % 3
        for side in (0, cells[axis]):
            for a in range(cells[i]):
                for b in range(cells[j]):
                    q = []
                    for da, db in ((0, 0), (1, 0), (1, 1), (0, 1)):
                        g = [0, 0, 0]
                        g[axis], g[i], g[j] = side, a + da, b + db
                        q.append(vertex(g))
                    if side == 0:
                        q = q[::-1]
                    k = (a + b) % 2
                    solid += [(q[k], q[k + 1], q[k + 2]), (q[k], q[k + 2], q[(k + 3) % 4])]
    v = np.array(vertices)
    v += amplitude * (np.random.default_rng(seed).random(v.shape) * 2 - 1)
    return moved((v, np.array(solid)), centre)


def wheel():
    """Metal wheel about Y: crowned tyre with chevron grousers, curved spokes, hub. Its outer face
    is at +Y."""
    p = Part("wheel")
    r, h = Layout.wheel_radius - 0.010, Layout.wheel_width / 2
    skin = [(r - 0.016, -h), (r - 0.004, -h), (r, -h + 0.012), (r, h - 0.012), (r - 0.004, h),
            (r - 0.016, h), (r - 0.016, h - 0.008), (r - 0.005, h - 0.012),
            (r - 0.005, -h + 0.012), (r - 0.016, -h + 0.008)]
    p.add("wheel_metal", revolve(skin, 48, "y", closed=True), crease_deg=30)
    bead = [(r - 0.022, -0.012), (r - 0.004, -0.012), (r - 0.004, 0.012), (r - 0.022, 0.012)]
    p.add("wheel_metal", revolve(bead, 48, "y", closed=True))
    section = np.array([(-0.0055, -0.004), (0.0055, -0.004), (0.0028, 0.010), (-0.0028, 0.010)])
    count = 24
    for k in range(count):
        rings = []
        for y in (-h + 0.004, -h / 2, 0.0, h / 2, h - 0.004):
            lead = 0.10 * (1 - abs(y) / h)  # chevron pointing along the roll
            a = 2 * np.pi * k / count + lead
            radial, along = np.array([np.sin(a), 0, np.cos(a)]), np.array([np.cos(a), 0, -np.sin(a)])
            rings.append([radial * (r + s[1]) + along * s[0] + [0, y, 0] for s in section[::-1]])
        p.add("grouser", loft(rings))
    for k in range(8):
        s = np.linspace(0, 1, 9)
        radius = 0.050 + s * (r - 0.010 - 0.050)
        angle = 2 * np.pi * k / 8 + 0.75 * np.sin(np.pi * s) * 0.62 + 0.25 * s
        path = np.column_stack([radius * np.sin(angle), 0.012 * np.sin(np.pi * s) + 0 * s,
                                radius * np.cos(angle)])
        thick, wide = 0.0045, 0.030
        # Rings of the strip: across Y and along the direction normal to the path in the XZ plane.
        tangent = np.gradient(path, axis=0)
        normal = np.cross(tangent, [0, 1, 0])
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        rings = []
        for c, q in zip(path, normal):
            y = np.array([0, 1.0, 0])
            rings.append([c - q * thick - y * wide, c - q * thick + y * wide, c + q * thick + y * wide,
                          c + q * thick - y * wide])
        p.add("titanium", loft(rings), crease_deg=50)
    hub = [(0, -0.075), (0.046, -0.075), (0.052, -0.069), (0.052, 0.045), (0.044, 0.058),
           (0.030, 0.062), (0.024, 0.070), (0, 0.072)]
    p.add("structure", revolve(hub, 28, "y"))
    p.add("dark_anodised", *bolts(8, 0.039, 0.0055, offset=0.0605))
    p.add("accent", cylinder(0.010, 0.006, 16, "y", (0, 0.0745, 0)))
    return p


def rocker():
    """Left rocker about its pivot: forward arm to the front steering, rear arm to the bogie."""
    p = Part("rocker_left")
    o = Layout.rocker
    front = np.array([Layout.front_x, Layout.wheel_y, Layout.steer_z + 0.05]) - o
    pivot = np.array([0, 0.02, 0])
    path = rounded_path([pivot, (0.46, 0.03, 0.045), (0.66, 0.19, 0.03), front - [0.02, 0, 0]], 0.12)
    p.add("structure", tube(path, np.linspace(0.040, 0.030, len(path))))
    end = np.array([Layout.bogie[0], 0.02, Layout.bogie[2]]) - [o[0], 0, o[2]]
    path = rounded_path([pivot, (-0.24, 0.02, -0.035), end + [0.0, 0, 0.0]], 0.14)
    p.add("structure", tube(path, np.linspace(0.040, 0.032, len(path))))
    p.add("titanium", cylinder(0.062, 0.080, 28, "y", pivot, 0.006))
    p.add("dark_anodised", cylinder(0.045, 0.02, 24, "y", pivot + [0, 0.047, 0], 0.004))
    p.add("structure", *bolts(8, 0.053, 0.006, centre=pivot, offset=0.041))
    p.add("titanium", cylinder(0.048, 0.066, 24, "y", end, 0.005))
    p.add(*steering_housing(front))
    p.add("dark_anodised", cylinder(0.030, 0.05, 20, "z", front + [0, 0, 0.085], 0.006))
    # Harness clamped along the forward arm.
    cable = rounded_path([(0.05, 0.02, 0.045), (0.45, 0.03, 0.086), (0.655, 0.185, 0.066),
                          tuple(front + [-0.03, 0, 0.045])], 0.1, 4)
    p.add("dark_anodised", tube(cable, 0.006, 6))
    for s in (0.15, 0.30):
        p.add("accent", cylinder(0.043, 0.016, 20, "x", (s, 0.0225, 0.1 * s), 0.003))
    return p


def steering_housing(at):
    """Material and solid of a steering actuator's fixed part."""
    return ("white_paint", cylinder(0.052, 0.11, 24, "z", np.add(at, [0, 0, 0.015]), 0.008))


def bogie():
    """Left bogie about its pivot: forward arm to the middle wheel, rear arm to the rear steering."""
    p = Part("bogie_left")
    o = Layout.bogie
    hub = np.array([Layout.middle_x, 0.475, Layout.wheel_radius]) - o
    rear = np.array([Layout.rear_x, Layout.wheel_y, Layout.steer_z + 0.05]) - o
    path = rounded_path([(0, 0, 0), (0.26, 0.0, -0.015), hub + [-0.03, 0, 0.03], hub], 0.10)
    p.add("structure", tube(path, np.linspace(0.034, 0.028, len(path))))
    path = rounded_path([(0, 0, 0), (-0.17, 0.01, 0.13), (-0.28, 0.12, 0.18), rear + [0.02, 0, 0]], 0.09)
    p.add("structure", tube(path, np.linspace(0.034, 0.030, len(path))))
    p.add("titanium", cylinder(0.050, 0.072, 24, "y", (0, 0.0, 0), 0.006))
    p.add("dark_anodised", cylinder(0.034, 0.018, 20, "y", (0, 0.042, 0), 0.004))
    p.add(*steering_housing(rear))
    p.add("dark_anodised", cylinder(0.030, 0.05, 20, "z", rear + [0, 0, 0.085], 0.006))
    p.add("titanium", cylinder(0.042, 0.100, 24, "y", hub + [0, 0.02, 0], 0.006))
    p.add("dark_anodised", cylinder(0.030, 0.05, 20, "y", hub + [0, -0.05, 0], 0.005))
    return p


def steering():
    """Left steering bracket about the steering axis: down the wheel's inner side to its hub."""
    p = Part("steer_left")
    drop = Layout.steer_z - Layout.wheel_radius
    p.add("titanium", cylinder(0.045, 0.054, 24, "z", (0, 0, -0.020), 0.004))
    path = rounded_path([(0, 0, -0.055), (0, -0.165, -0.055), (0, -0.165, -drop)], 0.07)
    section = np.array([(-0.034, -0.011), (0.034, -0.011), (0.034, 0.011), (-0.034, 0.011)])
    p.add("structure", sweep(path, section))
    p.add("titanium", cylinder(0.044, 0.10, 24, "y", (0, -0.135, -drop), 0.006))
    p.add("dark_anodised", cylinder(0.030, 0.045, 20, "y", (0, -0.200, -drop), 0.005))
    p.add("structure", *bolts(6, 0.036, 0.005, "z", (0, 0, 0), -0.047))
    return p


def chassis():
    """Warm-electronics box in foil, deck with solar cells, radiators, cameras, mast and arm feet."""
    p = Part("chassis")
    p.add("gold_foil", crinkled((1.10, 0.56, 0.25), (22, 10, 5), 0.007, (-0.04, 0, 0.545), 7),
          crease_deg=12)
    # Deck: a plate with cut corners, its edge rail, and two side wings of cells.
    outline = [(-0.66, -0.26), (-0.56, -0.36), (0.46, -0.36), (0.58, -0.24), (0.58, 0.24),
               (0.46, 0.36), (-0.56, 0.36), (-0.66, 0.26)]
    p.add("white_paint", prism(outline, 0.675, 0.715, 0.006))
    p.add("structure", prism(np.array(outline) * 0.965, 0.655, 0.678))
    top, up = 0.715, (0, 0, 1)
    tiles = [(-0.49, y) for y in (-0.20, 0.0)] + [(-0.19, y) for y in (-0.20, 0.0)] \
        + [(0.11, y) for y in (0.02, 0.23)] + [(0.11, -0.19)]
    for x, y in tiles:
        p.add_textured("deck_texture", box((0.28, 0.19, 0.012), (x, y, top + 0.006), 0.0025),
                       faced(up, (1, 0, 0), (0, -1, 0), CELLS))
    for side in (-1, 1):  # hinged wings, tilted slightly, over the wheels
        for x in (-0.43, -0.12):
            wing = moved(box((0.29, 0.22, 0.014), (0, 0, 0), 0.003), (x, side * 0.485, 0.742),
                         turn("x", side * 9))
            normal = turn("x", side * 9) @ [0, 0, 1]
            p.add_textured("deck_texture", wing, faced(normal, (1, 0, 0), (0, -1, 0), CELLS))
            for dx in (-0.09, 0.09):
                p.add("structure", cylinder(0.010, 0.05, 12, "x", (x + dx, side * 0.368, 0.722)))
    for x, y in ((0.50, 0.19), (0.50, -0.03), (-0.60, 0.0)):
        p.add_textured("deck_texture", box((0.07, 0.07, 0.004), (x, y, top + 0.002)),
                       faced(up, (1, 0, 0), (0, -1, 0), MARKS))
    for side in (-1, 1):  # name plates and side radiators
        p.add_textured("deck_texture", box((0.36, 0.012, 0.10), (0.26, side * 0.289, 0.585), 0.002),
                       faced((0, side, 0), (-side, 0, 0), (0, 0, -1), PLATE))
        p.add("radiator", box((0.40, 0.018, 0.16), (-0.33, side * 0.290, 0.575), 0.004))
        for k in range(9):
            p.add("radiator", box((0.38, 0.014, 0.005), (-0.33, side * 0.303, 0.508 + 0.0165 * k)))
        # Differential: housing on the wall where the rocker's axle leaves the box.
        p.add("titanium", cylinder(0.075, 0.05, 28, "y", (0, side * 0.300, Layout.rocker[2]), 0.006))
        p.add("structure", cylinder(0.036, 0.10, 24, "y", (0, side * 0.350, Layout.rocker[2])))
    # Rear: finned radiator canister.
    p.add("dark_anodised", cylinder(0.085, 0.42, 28, "y", (-0.70, 0, 0.58), 0.010))
    for a in range(110, 251, 20):
        fin = box((0.08, 0.40, 0.006), (0.115, 0, 0))
        p.add("white_paint", moved(fin, (-0.70, 0, 0.58), turn("y", a)))
    for y in (-0.15, 0.15):
        p.add("structure", box((0.06, 0.03, 0.05), (-0.605, y, 0.58), 0.004))
    # Front: hazard cameras on a bracket, lamps, arm shoulder plate.
    p.add("structure", box((0.05, 0.34, 0.035), (0.525, -0.05, 0.652), 0.005))
    for y in (-0.19, -0.13, 0.03, 0.09):
        p.add("white_paint", box((0.055, 0.042, 0.042), (0.558, y, 0.640), 0.004))
        p.add("dark_anodised", cylinder(0.016, 0.016, 18, "x", (0.590, y, 0.640)))
        p.add("lens", cylinder(0.012, 0.004, 18, "x", (0.598, y, 0.640)))
    for y in (-0.22, 0.22):  # rear cameras
        p.add("white_paint", box((0.05, 0.042, 0.042), (-0.60, y, 0.650), 0.004))
        p.add("lens", cylinder(0.012, 0.008, 18, "x", (-0.627, y, 0.650)))
    p.add("titanium", box((0.10, 0.15, 0.15), (0.555, Layout.arm[1], Layout.arm[2]), 0.010))
    # Deck furniture: mast foot, antenna foot, whip antenna, sample box, handrails, bolts.
    m, h = Layout.mast, Layout.antenna
    p.add("titanium", cylinder(0.075, 0.03, 28, "z", (m[0], m[1], m[2]), 0.006))
    p.add("structure", *bolts(8, 0.062, 0.006, "z", (m[0], m[1], 0), m[2] + 0.017))
    p.add("titanium", cylinder(0.050, 0.025, 24, "z", (h[0], h[1], h[2]), 0.005))
    p.add("dark_anodised", cylinder(0.028, 0.10, 20, "z", (-0.52, 0.26, 0.765), 0.006))
    p.add("white_paint", cylinder(0.006, 0.36, 10, "z", (-0.52, 0.26, 0.98)))
    p.add("white_paint", box((0.16, 0.13, 0.07), (0.36, 0.06, 0.750), 0.008))
    p.add("accent", box((0.10, 0.020, 0.008), (0.36, 0.06, 0.789)))
    p.add("dark_anodised", box((0.10, 0.13, 0.05), (-0.52, -0.30, 0.738), 0.006))
    rail = rounded_path([(0.40, -0.33, 0.71), (0.40, -0.33, 0.755), (0.20, -0.33, 0.755),
                         (0.20, -0.33, 0.71)], 0.02, 3)
    p.add("accent", tube(rail, 0.007, 8))
    p.add("titanium", box((0.9, 0.05, 0.03), (-0.04, 0, 0.41), 0.006))
    return p


def mast():
    """Mast up to the pan joint; origin at its foot."""
    p = Part("mast")
    z = Layout.mast_pan_z
    p.add("white_paint", tube([(0, 0, 0.0), (0, 0, 0.10), (0, 0, z - 0.05)], [0.045, 0.034, 0.030], 20))
    p.add("titanium", cylinder(0.045, 0.05, 24, "z", (0, 0, 0.06), 0.006))
    p.add("titanium", cylinder(0.044, 0.06, 24, "z", (0, 0, z - 0.035), 0.006))
    for k in (0.20, 0.32, 0.44):
        p.add("dark_anodised", cylinder(0.037, 0.012, 20, "z", (0, 0, k), 0.002))
    cable = rounded_path([(-0.04, 0.02, 0.02), (-0.042, 0.0, 0.25), (-0.040, 0.0, z - 0.03)], 0.1, 3)
    p.add("dark_anodised", tube(cable, 0.007, 8))
    return p


def mast_pan():
    """Turning base of the head: yoke with two cheeks; origin at the pan joint."""
    p = Part("mast_pan")
    p.add("titanium", cylinder(0.042, 0.03, 24, "z", (0, 0, 0.014), 0.004))
    p.add("structure", box((0.06, 0.16, 0.016), (0, 0, 0.032), 0.004))
    for side in (-1, 1):
        p.add("structure", box((0.055, 0.014, 0.075), (0, side * 0.075, 0.062), 0.004))
        p.add("dark_anodised", cylinder(0.022, 0.022, 18, "y", (0, side * 0.090, Layout.mast_tilt_z), 0.004))
    return p


def mast_head():
    """Camera head; origin at the tilt joint, looking along +X."""
    p = Part("mast_head")
    p.add("structure", cylinder(0.018, 0.14, 18, "y"))
    p.add("white_paint", box((0.13, 0.34, 0.11), (0.015, 0, 0.078), 0.012))
    p.add("gold_foil", box((0.05, 0.30, 0.09), (-0.068, 0, 0.075), 0.010))
    for y, r in ((-0.115, 0.034), (0.115, 0.034), (-0.040, 0.019), (0.040, 0.019)):
        barrel = [(0, 0), (r, 0), (r, 0.045), (r - 0.005, 0.045), (r - 0.005, 0.020), (0, 0.020)]
        p.add("dark_anodised", moved(revolve(barrel, 24, "x"), (0.078, y, 0.080)))
        glass = [(0, 0.0), (r - 0.006, 0.0), (r - 0.008, 0.006), (0.5 * r, 0.011), (0, 0.013)]
        p.add("lens", moved(revolve(glass, 20, "x"), (0.0985, y, 0.080)))
    p.add("white_paint", cylinder(0.036, 0.10, 24, "x", (0.025, 0, 0.165), 0.008))
    p.add("lens", cylinder(0.026, 0.006, 24, "x", (0.076, 0, 0.165)))
    p.add("accent", box((0.08, 0.345, 0.014), (0.010, 0, 0.078), 0.002))
    return p


def antenna_post():
    """Azimuth stage of the high-gain antenna; origin at its joint."""
    p = Part("antenna_post")
    p.add("structure", cylinder(0.030, 0.03, 20, "z", (0, 0, 0.015), 0.004))
    p.add("structure", box((0.03, 0.07, 0.06), (0, 0, 0.045), 0.005))
    p.add("dark_anodised", cylinder(0.017, 0.09, 18, "y", (0, 0, Layout.dish_z), 0.003))
    return p


def antenna_mount():
    """Fixed post below the azimuth joint; origin at the deck."""
    p = Part("antenna_mount")
    p.add("white_paint", cylinder(0.022, Layout.antenna_z, 20, "z", (0, 0, Layout.antenna_z / 2), 0.003))
    p.add("titanium", cylinder(0.028, 0.03, 20, "z", (0, 0, Layout.antenna_z - 0.018), 0.004))
    return p


def antenna_dish():
    """Dish about its elevation joint, boresight +X."""
    p = Part("antenna_dish")
    radius, focal = 0.19, 0.15
    r = np.linspace(0, radius, 12)
    inner = [(q, q * q / (4 * focal) + 0.050) for q in r[::-1]]  # from the rim to the axis
    outer = [(q, q * q / (4 * focal) + 0.042) for q in r]
    profile = outer + [(radius + 0.005, inner[0][1] - 0.004), (radius + 0.004, inner[0][1] + 0.003)] + inner
    p.add("white_paint", revolve(profile, 40, "x"), crease_deg=30)
    p.add("structure", cylinder(0.024, 0.05, 20, "x", (0.022, 0, 0), 0.004))
    tip = 0.050 + focal * 0.92
    for k in range(3):
        a = 2 * np.pi * k / 3 + 0.3
        c, s = np.cos(a), np.sin(a)
        foot = 0.72 * radius
        p.add("structure", tube([(foot ** 2 / (4 * focal) + 0.048, foot * c, foot * s),
                                 (tip, 0.012 * c, 0.012 * s)], 0.0035, 8))
    feed = [(0, -0.022), (0.014, -0.022), (0.022, -0.006), (0.022, 0.012), (0.016, 0.018), (0, 0.018)]
    p.add("gold_foil", moved(revolve(feed, 20, "x"), (tip, 0, 0)))
    return p


def arm_shoulder():
    p = Part("arm_shoulder")
    p.add("structure", cylinder(0.040, 0.13, 24, "z", (0, 0, 0), 0.006))
    p.add("titanium", cylinder(0.036, 0.09, 24, "x", (0.045, 0, 0), 0.005))
    return p


def arm_upper():
    """Upper arm from the shoulder along -Y (stowed across the front)."""
    p = Part("arm_upper")
    n = Layout.upper_arm
    p.add("structure", tube([(0, -0.03, 0), (0, -n + 0.02, 0)], 0.026, 18))
    p.add("titanium", cylinder(0.036, 0.058, 24, "x", (0, 0, 0), 0.005))
    p.add("titanium", cylinder(0.034, 0.060, 24, "x", (0, -n, 0), 0.005))
    p.add("gold_foil", cylinder(0.029, 0.10, 20, "y", (0, -0.22, 0), 0.004))
    return p


def arm_fore():
    """Forearm from the elbow along +Y (stowed beside the upper arm)."""
    p = Part("arm_fore")
    n = Layout.fore_arm
    p.add("structure", tube([(0, 0.02, 0), (0, n - 0.02, 0)], [0.023, 0.020], 18))
    p.add("titanium", cylinder(0.032, 0.056, 24, "x", (0, 0, 0), 0.005))
    p.add("titanium", cylinder(0.028, 0.054, 24, "x", (0, n, 0), 0.005))
    return p


def arm_turret():
    """Tool turret about the wrist: drill, close-up camera, brush."""
    p = Part("arm_turret")
    p.add("white_paint", cylinder(0.050, 0.075, 28, "x", (0.055, 0, 0), 0.008))
    p.add("dark_anodised", cylinder(0.026, 0.11, 20, "z", (0.055, 0, -0.085), 0.004))
    p.add("titanium", moved(revolve([(0, -0.055), (0.009, -0.035), (0.009, 0), (0, 0)], 14), (0.055, 0, -0.138)))
    p.add("white_paint", box((0.055, 0.07, 0.05), (0.058, 0.068, 0.0), 0.006))
    p.add("lens", cylinder(0.018, 0.010, 20, "y", (0.058, 0.107, 0.0)))
    p.add("accent", cylinder(0.022, 0.05, 20, "z", (0.055, 0, 0.066), 0.004))
    return p


def parts():
    """All mesh parts by file name."""
    left = [rocker(), bogie(), steering()]
    right = [p.mirrored(p.name.replace("left", "right")) for p in left]
    rest = [chassis(), wheel(), mast(), mast_pan(), mast_head(), antenna_mount(), antenna_post(),
            antenna_dish(), arm_shoulder(), arm_upper(), arm_fore(), arm_turret()]
    return {p.name + (".gltf" if p.textured else ".glb"): p for p in left + right + rest}
