"""Makes Data/field: a cratered field with fractal relief, as GeoTIFF, and its colours.

    python3 make_field.py [folder]

Heights are the sum of
- craters whose cumulative number follows a power law, each a fresh simple crater (Pike 1977) worn
  down by topographic diffusion (Soderblom 1970; Fassett and Thomson 2014), and
- fractal relief made in the frequency domain with a stated Hurst exponent.
Everything is drawn from one seeded generator. Metres, X east, Y north from the field's centre.
"""
import sys
from pathlib import Path

import numpy as np


class Field:
    """The parameters; README.md beside the data says where they come from."""
    seed = 20260
    posts = 1001  # a side
    spacing = 0.2  # [m]
    quantum = 1.0 / 1024.0  # heights are multiples of it [m]
    latitude_deg, longitude_deg = 26.1, 3.6  # of the projection's centre
    moon_radius = 1737400.0
    # N(>= D) = coefficient * D^-exponent a square metre
    exponent = 2.0
    coefficient = 0.060  # three quarters of lunar equilibrium's 0.079 (Gault 1970): drivable
    smallest, largest = 0.8, 34.0  # diameters [m]
    # Diffusion age of a crater in units of its radius squared, over 0 ... oldest.
    youngest, oldest = 0.006, 0.35
    hurst = 0.8
    deviation = 0.030  # rms height difference over 1 m [m]
    longest_wave = 120.0  # [m]


def crater_catalogue(field=Field):
    """Craters as an array of rows x, y, D, K: centre and diameter [m], diffusion age [radius²].
    Sorted from large to small. Centres lie up to one largest crater outside the field."""
    rng = np.random.default_rng(field.seed)
    side = (field.posts - 1) * field.spacing + 2 * field.largest
    low, high = field.smallest ** -field.exponent, field.largest ** -field.exponent
    count = int(round(field.coefficient * (low - high) * side * side))
    u = rng.random((count, 4))
    diameter = (low - u[:, 0] * (low - high)) ** (-1 / field.exponent)  # inverse of the power law
    age = field.youngest + (field.oldest - field.youngest) * u[:, 1] ** 2
    # The largest would be walls to a rover if fresh: they are never younger than a tenth.
    age = np.where(diameter > 6.0, np.maximum(age, 0.1 * field.oldest), age)
    xy = (u[:, 2:] - 0.5) * side
    rows = np.column_stack([xy, diameter, age])
    return rows[np.argsort(-diameter, kind="stable")]


def fresh_profile(s, diameter):
    """Height of a fresh simple crater above the plain [m] at s radii from its centre.
    Depth from rim 0.196 D^1.010 and rim height 0.036 D^1.014 with D in km (Pike 1977, craters
    below 15 km); parabolic bowl, rim falling as s^-3 (McGetchin et al. 1973)."""
    km = diameter / 1000.0
    depth, rim = 196.0 * km ** 1.010, 36.0 * km ** 1.014
    bowl = rim - depth * (1 - np.minimum(s, 1.0) ** 2)
    return np.where(s < 1.0, bowl, rim * np.maximum(s, 1.0) ** -3.0)


def worn_profiles(ages, diameter, reach=4.0, cells=160):
    """Radial profiles after axisymmetric diffusion dz/dt = (1/s) d/ds (s dz/ds), one a row of the
    ascending `ages`, and the radii s. Explicit steps; nothing flows through the outer edge."""
    ds = reach / cells
    s = (np.arange(cells) + 0.5) * ds
    z = fresh_profile(s, diameter)
    edge = np.arange(1, cells) * ds
    rows, now = [], 0.0
    for age in ages:
        steps = max(1, int(np.ceil((age - now) / (0.4 * ds * ds))))
        dt = (age - now) / steps
        for _ in range(steps):
            flow = edge * np.diff(z) / ds
            z = z + dt * (np.append(flow, 0) - np.insert(flow, 0, 0)) / (s * ds)
        now = age
        rows.append(z.copy())
    return s, np.array(rows)


def craters_relief(catalogue, field=Field):
    """Sum of the craters' heights at the posts, row 0 north."""
    n, h = field.posts, field.spacing
    half = (n - 1) * h / 2
    axis = np.arange(n) * h - half
    total = np.zeros((n, n))
    ages = np.linspace(field.youngest, field.oldest, 48)
    reference = 10.0
    s, profiles = worn_profiles(ages, reference)
    reach = s[-1]
    taper = np.clip((reach - s) / (reach - 3.0), 0, 1)
    profiles = profiles * taper * taper * (3 - 2 * taper)
    for x, y, diameter, age in catalogue:
        radius = diameter / 2
        i0, i1 = np.searchsorted(axis, [x - reach * radius, x + reach * radius])
        j0, j1 = np.searchsorted(axis, [y - reach * radius, y + reach * radius])
        if i0 == i1 or j0 == j1:
            continue
        k = (age - ages[0]) / (ages[1] - ages[0])
        a = min(int(k), len(ages) - 2)
        profile = profiles[a] + (k - a) * (profiles[a + 1] - profiles[a])
        # Pike's depth is nearly proportional to D: scale from the reference crater.
        profile = profile * (fresh_profile(0.0, diameter) / fresh_profile(0.0, reference))
        d = np.hypot(axis[None, i0:i1] - x, axis[j0:j1, None] - y) / radius
        total[j0:j1, i0:i1] += np.interp(d, s, profile, right=0.0)
    return total[::-1]


def fractal_relief(field=Field):
    """Gaussian surface with power spectrum ~ k^-(2 + 2 hurst), scaled to the rms deviation over 1 m.
    Made on a periodic grid twice as large and cropped, so that opposite edges are unrelated."""
    rng = np.random.default_rng(field.seed + 1)
    n = 2048
    kx = np.fft.fftfreq(n, field.spacing)[:, None]
    ky = np.fft.rfftfreq(n, field.spacing)[None, :]
    k = np.hypot(kx, ky)
    k[0, 0] = 1.0
    amplitude = k ** -(1 + field.hurst)
    amplitude[k < 1.0 / field.longest_wave] = 0.0
    phase = rng.random(k.shape) * 2 * np.pi
    strength = np.sqrt(-2 * np.log(1 - rng.random(k.shape)))
    z = np.fft.irfft2(amplitude * strength * np.exp(1j * phase), (n, n))[:field.posts, :field.posts]
    lag = int(round(1.0 / field.spacing))
    rms = np.sqrt(0.5 * (np.mean((z[lag:] - z[:-lag]) ** 2) + np.mean((z[:, lag:] - z[:, :-lag]) ** 2)))
    return (z - z.mean()) * (field.deviation / rms)


def heights(field=Field):
    """The field's heights [m], float32, row 0 north, multiples of the quantum."""
    z = craters_relief(crater_catalogue(field), field) + fractal_relief(field)
    return (np.round(z / field.quantum) * field.quantum).astype(np.float32)


def colours(z, field=Field):
    """sRGB colours at every second post: grey-brown soil, mottled, brighter on young rims and
    steep walls, darker in hollows. Shading by light is left to the renderer."""
    h = z[::2, ::2].astype(float)
    gy, gx = np.gradient(h, 2 * field.spacing)
    steep = np.hypot(gx, gy)
    blurred = h.copy()
    for _ in range(24):
        p = np.pad(blurred, 1, mode="edge")
        blurred = (p[:-2, 1:-1] + p[2:, 1:-1] + p[1:-1, :-2] + p[1:-1, 2:]) / 4
    raised = np.clip((h - blurred) / 0.08, -1, 1)
    mottle = fractal_relief(type("Mottle", (field,), {"seed": field.seed + 7, "hurst": 0.25,
                                                       "deviation": 0.35, "longest_wave": 40.0}))
    value = 0.47 + 0.035 * np.clip(mottle[::2, ::2], -2.5, 2.5) + 0.05 * raised \
        + 0.09 * np.clip(steep, 0, 0.6)
    grey = np.clip(np.round(value * 64), 0, 63) / 64  # few levels: compresses well
    return np.clip(np.stack([255 * grey, 249 * grey, 238 * grey]), 0, 255).astype(np.uint8)


def projection(field=Field):
    """Stereographic map about the field's centre on the IAU_2015 sphere of the Moon."""
    from osgeo import osr
    srs = osr.SpatialReference()
    srs.SetFromUserInput("IAU_2015:30100")
    srs.SetProjCS("Dspace field, stereographic on Moon (2015) - Sphere")
    srs.SetStereographic(field.latitude_deg, field.longitude_deg, 1.0, 0.0, 0.0)
    srs.SetLinearUnits("metre", 1.0)
    return srs


def write_geotiff(path, bands, spacing, options, field=Field, point=False):
    """Bands (k, rows, columns), row 0 north, posts from edge to edge of the field."""
    from osgeo import gdal
    gdal.UseExceptions()
    kind = gdal.GDT_Float32 if bands.dtype == np.float32 else gdal.GDT_Byte
    rows, columns = bands.shape[1:]
    data = gdal.GetDriverByName("GTiff").Create(str(path), columns, rows, len(bands), kind, options)
    half = (field.posts - 1) * field.spacing / 2 + spacing / 2  # the outer posts' outer pixel edge
    data.SetGeoTransform([-half, spacing, 0, half, 0, -spacing])
    data.SetProjection(projection(field).ExportToWkt())
    if point:
        data.SetMetadataItem("AREA_OR_POINT", "Point")
        data.SetMetadataItem("VERTICAL_DATUM", f"sphere:{field.moon_radius:.0f}")
        data.GetRasterBand(1).SetUnitType("m")
        data.GetRasterBand(1).SetDescription("height")
    for k, band in enumerate(bands):
        data.GetRasterBand(k + 1).WriteArray(band)
    data = None


def make(folder, field=Field):
    """Writes field.tif and field_color.tif into `folder`."""
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    z = heights(field)
    write_geotiff(folder / "field.tif", z[None], field.spacing,
                  ["COMPRESS=DEFLATE", "PREDICTOR=3", "ZLEVEL=9", "TILED=YES"], field, point=True)
    write_geotiff(folder / "field_color.tif", colours(z, field), 2 * field.spacing,
                  ["COMPRESS=DEFLATE", "PREDICTOR=2", "ZLEVEL=9", "PHOTOMETRIC=RGB"], field)
    return z


if __name__ == "__main__":
    make(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).resolve().parents[1] / "field")
