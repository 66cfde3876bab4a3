"""What the tests of shadows share: exact rays to points of the Sun's disc."""
import numpy as np

RADIUS_DEG = 0.2666  # of the Sun's disc, unless a test says otherwise


def towards(azimuth_deg, elevation_deg):
    a, e = np.radians(azimuth_deg), np.radians(elevation_deg)
    return np.array([np.sin(a) * np.cos(e), np.cos(a) * np.cos(e), np.sin(e)])


def across(to_sun):
    """Two unit vectors across the rays."""
    u = np.cross(to_sun, np.eye(3)[np.argmin(np.abs(to_sun))])
    u /= np.linalg.norm(u)
    return u, np.cross(to_sun, u)


def disc(to_sun, count=100, radius_deg=RADIUS_DEG):
    """(count, 3): directions to points of the disc that stand for equal shares of it (Vogel's spiral)."""
    u, v = across(to_sun)
    k = np.arange(count)
    r = np.tan(np.radians(radius_deg)) * np.sqrt((k + 0.5) / count)
    angle = np.pi * (3 - np.sqrt(5)) * k
    rays = to_sun + (r * np.cos(angle))[:, None] * u + (r * np.sin(angle))[:, None] * v
    return rays / np.linalg.norm(rays, axis=1)[:, None]


def lit_by_rays(terrain, points, to_sun, count=100, lift=1e-3, radius_deg=RADIUS_DEG):
    """The part of the disc that rays from over the ground at points (n, 3) see: 0 to 1."""
    points = np.asarray(points, float)
    rays = disc(to_sun, count, radius_deg)
    start = points[:, None] + lift * terrain.normals(points[:, :2])[:, None]
    return np.isinf(terrain.intersect(start, rays[None])).mean(axis=1)


def on_ground(terrain, points):
    """The points, moved up or down to the terrain's surface."""
    points = np.array(points, float)
    points[:, 2] = terrain.heights(points[:, :2])
    return points


def near_edges(terrain, points, exact, to_sun, reach, count=9, lift=1e-3, radius_deg=RADIUS_DEG):
    """Whether rays say something else within `reach` of points (n, 3)."""
    edge = np.zeros(len(points), bool)
    for k in range(16):
        turn = np.pi * k / 8
        step = reach * (1.0 if k % 2 == 0 else 0.5)
        beside = on_ground(terrain, points + step * np.array([np.cos(turn), np.sin(turn), 0]))
        good = np.isfinite(beside[:, 2])
        lit = np.where(good, exact, 0.0)
        lit[good] = lit_by_rays(terrain, beside[good], to_sun, count, lift, radius_deg)
        edge |= np.abs(lit - exact) > 0.25
    return edge


def crater(side=257, post=0.5, radius=30.0, depth=12.0, rim=2.5):
    """Heights [m] of a fresh crater in level ground: a parabolic bowl and a flank that falls as the third power."""
    x = (np.arange(side) - side // 2) * post
    r = np.hypot(x[None, :], x[:, None]) / radius
    return np.where(r < 1, (depth + rim) * r**2 - depth, rim * np.maximum(r, 1.0) ** -3)
