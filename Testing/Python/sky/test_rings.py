"""Drawn rings, pixel by pixel: where they lie, their light by an integral over the slab, the planet's shadow, and what shines through."""
import numpy as np
import pytest

PLANET = 6.0e7
RINGS = [(7.5e7, 9.5e7, 0.4, (0.6, 0.6, 0.6)), (1.0e8, 1.35e8, 2.5, (0.8, 0.7, 0.5))]
WIDTH, HEIGHT, FOV = 360, 260, 30.0


def linear(color):
    color = np.asarray(color)
    return np.where(color <= 0.04045, color / 12.92, ((color + 0.055) / 1.055) ** 2.4)


def slab(depth, mu, mu0, same_side):
    """The radiance factor of a slab whose particles scatter once, 1 of an opaque one seen and lit along its normal, by layers."""
    layers = 20000
    t = (np.arange(layers) + 0.5) * depth / layers
    way_in = np.exp(-t / mu0)
    way_out = np.exp(-(t if same_side else depth - t) / mu)
    return 2.0 / mu * np.sum(way_in * way_out) * depth / layers


def rays_of(eye, ahead, up):
    right = np.cross(ahead, up)
    right /= np.linalg.norm(right)
    down = np.cross(ahead, right)
    step = 2.0 * np.tan(np.radians(FOV) / 2) / HEIGHT
    x, y = (np.arange(WIDTH) - (WIDTH - 1) / 2) * step, (np.arange(HEIGHT) - (HEIGHT - 1) / 2) * step
    rays = ahead + x[None, :, None] * right + y[:, None, None] * down
    return rays / np.linalg.norm(rays, axis=2)[:, :, None]


def nearest_of_sphere(origin, rays, radius):
    """Along rays from a point or from points; infinity where they miss."""
    b = (origin * rays).sum(axis=-1)
    root = b * b - (origin * origin).sum(axis=-1) + radius**2
    with np.errstate(invalid="ignore"):
        t = -b - np.sqrt(root)
    return np.where((root > 0) & (t > 0), t, np.inf)


@pytest.mark.parametrize("eye, sun", [((2.5e8, -2.5e8, 2.2e8), (0.7, 0.2, 0.5)), ((3.4e8, 1.0e8, -1.3e8), (0.2, -0.9, 0.35)),
                                      ((0.0, 4.2e8, 3e7), (-0.5, -0.5, 0.6))], ids=("lit side", "dark side", "grazing"))
def test_rings(scene, eye, sun):
    eye, sun = np.array(eye), np.array(sun) / np.linalg.norm(sun)
    scene.sun.set(direction=sun, irradiance=1361.0)
    scene.add_camera(eye=eye, target=(0, 0, 0), up=(0, 0, 1), fov_deg=FOV)
    view = scene.add_viewport((WIDTH, HEIGHT), samples=1)
    body = scene.add_body(radii=PLANET, albedo=0.3, name="bare", rings=())
    bare = view.radiance().astype(float)
    body.remove()
    scene.add_body(radii=PLANET, albedo=0.3, name="ringed", rings=RINGS)
    drawn = view.radiance().astype(float)

    ahead = -eye / np.linalg.norm(eye)
    rays = rays_of(eye, ahead, np.array([0.0, 0.0, 1.0]))
    t = -eye[2] / rays[:, :, 2]
    place = eye + t[:, :, None] * rays
    radius = np.hypot(place[:, :, 0], place[:, :, 1])
    shown = (t > 0) & (t < nearest_of_sphere(eye, rays, PLANET))
    shadow = np.isfinite(nearest_of_sphere(place, sun, PLANET))
    mu, mu0 = np.abs(rays[:, :, 2]), abs(sun[2])
    pixel = np.abs(np.stack(np.gradient(radius))).max(axis=0)
    expected, sure, seen = bare.copy(), np.ones(radius.shape, bool), 0
    for inner, outer, depth, color in RINGS:
        sure &= (np.abs(radius - inner) > 1.5 * pixel) & (np.abs(radius - outer) > 1.5 * pixel)
        within = shown & (radius > inner) & (radius < outer)
        seen += within.sum()
        levels = np.linspace(mu[within].min(), mu[within].max(), 60)
        factor = np.interp(mu[within], levels, [slab(depth, m, mu0, eye[2] * sun[2] > 0) for m in levels])
        light = linear(color) * 1361.0 / np.pi * (factor * ~shadow[within])[:, None]
        expected[within] = bare[within] * np.exp(-depth / mu[within])[:, None] + light
    edges = np.zeros(radius.shape, bool)  # of the planet's disc and of its shadow
    for mask in (shown, shadow & shown):
        for axis in (0, 1):
            for shift in (-1, 1):
                edges |= mask ^ np.roll(mask, shift, axis)
    sure &= ~edges
    assert seen > 3000 and (shadow & shown & sure & (radius > RINGS[0][0]) & (radius < RINGS[1][1])).sum() > 20
    np.testing.assert_allclose(drawn[sure], expected[sure], rtol=0.005, atol=0.05)
    assert (sure & shown & (bare.max(axis=2) > 1.0)).sum() > 50  # the planet through its rings
