"""Makes the detail of Data/field: the site about the drive in posts of 5 cm, its colours in pixels of
2.5 cm, its rocks, and the hills around the field.

    python3 make_site.py [folder]

The site continues what field.tif states to smaller sizes: craters of the same size-frequency law, relief of the same
power spectrum. Rocks follow Golombek and Rapp (1997). Seeded; metres, X east, Y north from the field's centre. README.md
beside the data has the laws and their sources.
"""
import json
import sys
from pathlib import Path

import numpy as np

import make_field
from make_field import Field


class Site:
    """The parameters."""
    seed = 20261
    spacing = 0.05  # [m]
    west, east, south, north = -34.0, 34.0, -24.0, 26.0  # of the outer posts [m]
    color_spacing = 0.025  # of its colours [m]
    color_reach = 12.0  # from the route [m]
    color_fade = 4.0  # over which it ends [m]
    darkest, brightest, shades = 0.34, 0.66, 16  # of the palette: sRGB values of its red
    quantum = 1.0 / 1024.0  # heights are multiples of it [m]
    hurst = 0.5  # of waves shorter than two of the field's posts (README.md)
    # Craters below those of the field: N(>= D) = Field.coefficient * D^-Field.exponent a square metre.
    smallest, largest = 0.2, Field.smallest  # diameters [m]
    # Rocks: the share of the ground that rocks of diameter >= D cover is k exp(-q D), q = 1.79 + 0.152 / k.
    rock_share = 0.03  # k
    rock_decay = 1.79 + 0.152 / rock_share  # q [1/m]
    rock_smallest, rock_largest = 0.05, 1.2  # in the site [m]
    rock_smallest_around = 0.3  # in the rest of the field [m]
    rock_in_heights = 0.10  # smaller ones are narrower than two posts
    rock_steps = 4000  # of the table by which diameters are drawn
    lane = 1.0  # no rock lies nearer to the route, seen from above [m]


class Hills:
    """The surroundings of the field."""
    seed = 20262
    posts, spacing = 129, 16.0
    quantum = 1.0 / 16.0
    plain = -0.6  # height of the level ground around the field [m]
    floor = -4.0  # below the field's edge, out of its way
    edge = 100.0, 140.0  # distances from the centre between which the floor rises to the plain [m]
    hole = 64.0  # |x| and |y| up to which there is none: the field covers it
    no_data = -32768
    begin, full = 140.0, 700.0  # ... and the hills to their height
    deviation = 26.0  # of their heights [m]
    longest_wave, hurst = 900.0, 0.85
    smallest, largest = 64.0, 200.0  # diameters of their craters, by the field's law [m]


def axes(site=Site):
    """x of the columns, y of the rows (row 0 north)."""
    columns = int(round((site.east - site.west) / site.spacing)) + 1
    rows = int(round((site.north - site.south) / site.spacing)) + 1
    return site.west + site.spacing * np.arange(columns), site.north - site.spacing * np.arange(rows)


# --- heights -------------------------------------------------------------------------------------

def _cubic(places, count):
    """(places, count) weights of Catmull-Rom interpolation between posts 0 .. count - 1."""
    i = np.clip(np.floor(places).astype(int), 1, count - 3)
    t = places - i
    weights = np.zeros((len(places), count))
    row = np.arange(len(places))
    for offset, w in ((-1, ((-t + 2) * t - 1) * t), (0, (3 * t - 5) * t * t + 2), (1, ((-3 * t + 4) * t + 1) * t),
                      (2, (t - 1) * t * t)):
        weights[row, i + offset] = w / 2
    return weights


def base_relief(field_heights, site=Site):
    """The field's posts, interpolated by cubics: no facets of its triangles show."""
    x, y = axes(site)
    half = (Field.posts - 1) * Field.spacing / 2
    across = _cubic((x + half) / Field.spacing, Field.posts)
    down = _cubic((half - y) / Field.spacing, Field.posts)
    return down @ field_heights.astype(float) @ across.T


def fine_relief(site=Site):
    """The part of the field's fractal relief that is too short for its posts. The spectrum goes on from that of the
    field, whose rms height difference over 1 m it has, with the site's Hurst exponent; longer waves are faded out."""
    rng = np.random.default_rng(site.seed + 1)
    n = 2400
    assert n * site.spacing >= Field.longest_wave
    kx = np.fft.fftfreq(n, site.spacing)[:, None]
    ky = np.fft.rfftfreq(n, site.spacing)[None, :]
    k = np.hypot(kx, ky)
    k[0, 0] = 1.0
    shortest = 1.0 / (2 * Field.spacing)  # [1/m] that the field's posts hold
    amplitude = k ** -(1 + Field.hurst) * np.maximum(k / shortest, 1.0) ** (Field.hurst - site.hurst)
    amplitude[k < 1.0 / Field.longest_wave] = 0.0
    phase = rng.random(k.shape) * 2 * np.pi
    strength = np.sqrt(-2 * np.log(1 - rng.random(k.shape)))
    spectrum = amplitude * strength * np.exp(1j * phase)
    whole = np.fft.irfft2(spectrum, (n, n))
    lag = int(round(1.0 / site.spacing))
    rms = np.sqrt(0.5 * (np.mean((whole[lag:] - whole[:-lag]) ** 2) + np.mean((whole[:, lag:] - whole[:, :-lag]) ** 2)))
    share = np.clip((k - 0.8 * shortest) / (0.4 * shortest), 0, 1)
    x, y = axes(site)
    short = np.fft.irfft2(spectrum * share, (n, n))[:len(y), :len(x)]
    return short * (Field.deviation / rms)


def crater_catalogue(seed, low, high, smallest, largest):
    """Rows x, y, D, K as in make_field, by its law, in a rectangle from `low` to `high` and one largest crater around."""
    rng = np.random.default_rng(seed)
    low, high = np.array(low) - largest, np.array(high) + largest
    least, greatest = largest ** -Field.exponent, smallest ** -Field.exponent
    count = rng.poisson(Field.coefficient * (greatest - least) * np.prod(high - low))
    u = rng.random((count, 4))
    diameter = (greatest - u[:, 0] * (greatest - least)) ** (-1 / Field.exponent)
    age = Field.youngest + (Field.oldest - Field.youngest) * u[:, 1] ** 2
    xy = low + u[:, 2:] * (high - low)
    rows = np.column_stack([xy, diameter, age])
    return rows[np.argsort(-diameter, kind="stable")]


def site_craters(site=Site):
    return crater_catalogue(site.seed + 2, (site.west, site.south), (site.east, site.north), site.smallest, site.largest)


def craters_relief(catalogue, x, y):
    """Sum of the craters' heights at posts of columns x and rows y (row 0 north)."""
    up = y[::-1]
    total = np.zeros((len(y), len(x)))
    ages = np.linspace(Field.youngest, Field.oldest, 48)
    reference = 10.0
    s, profiles = make_field.worn_profiles(ages, reference)
    reach = s[-1]
    taper = np.clip((reach - s) / (reach - 3.0), 0, 1)
    profiles = profiles * taper * taper * (3 - 2 * taper)
    for cx, cy, diameter, age in catalogue:
        radius = diameter / 2
        i0, i1 = np.searchsorted(x, [cx - reach * radius, cx + reach * radius])
        j0, j1 = np.searchsorted(up, [cy - reach * radius, cy + reach * radius])
        if i0 == i1 or j0 == j1:
            continue
        k = (age - ages[0]) / (ages[1] - ages[0])
        a = min(int(k), len(ages) - 2)
        profile = profiles[a] + (k - a) * (profiles[a + 1] - profiles[a])
        profile = profile * (make_field.fresh_profile(0.0, diameter) / make_field.fresh_profile(0.0, reference))
        d = np.hypot(x[None, i0:i1] - cx, up[j0:j1, None] - cy) / radius
        total[j0:j1, i0:i1] += np.interp(d, s, profile, right=0.0)
    return total[::-1]


# --- rocks ---------------------------------------------------------------------------------------

def rocks_per_area(smallest, largest, site=Site):
    """Rocks of diameters in [smallest, largest) a square metre: the integral of the covered share's derivative over the
    area of a disc, k q exp(-q D) / (pi D^2 / 4), by Simpson's rule on a logarithmic scale."""
    u = np.linspace(np.log(smallest), np.log(largest), 2001)
    d = np.exp(u)
    f = site.rock_share * site.rock_decay * np.exp(-site.rock_decay * d) / (np.pi * d * d / 4) * d
    w = np.ones(len(u))
    w[1:-1:2], w[2:-1:2] = 4, 2
    return float((w * f).sum() * (u[1] - u[0]) / 3)


def _diameters(u, smallest, largest, site):
    """Diameters of that law for uniform u, by its table."""
    d = np.geomspace(smallest, largest, site.rock_steps)
    density = site.rock_share * site.rock_decay * np.exp(-site.rock_decay * d) / (np.pi * d * d / 4)
    less = np.concatenate([[0], np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(d))])
    return np.interp(u * less[-1], less, d)


def way_points(folder):
    return np.array(json.loads((Path(folder) / "route.json").read_text())["way_points_m"], float)


def route_line(points, count=2000):
    """Points of the curve through the way points: a natural cubic spline over the chord length, as dspace.rover.Path
    has it to some centimetres."""
    s = np.concatenate([[0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    n, h = len(s), np.diff(s)
    a = np.eye(n)
    b = np.zeros((n, 2))
    for i in range(1, n - 1):
        a[i, i - 1:i + 2] = h[i - 1], 2 * (h[i - 1] + h[i]), h[i]
        b[i] = 6 * ((points[i + 1] - points[i]) / h[i] - (points[i] - points[i - 1]) / h[i - 1])
    m = np.linalg.solve(a, b)
    t = np.linspace(0, s[-1], count)
    i = np.clip(np.searchsorted(s, t, side="right") - 1, 0, n - 2)
    u, v, hi = (t - s[i])[:, None], (s[i + 1] - t)[:, None], h[i][:, None]
    return ((m[i] * v ** 3 + m[i + 1] * u ** 3) / (6 * hi) + (points[i] / hi - m[i] * hi / 6) * v
            + (points[i + 1] / hi - m[i + 1] * hi / 6) * u)


def distance_to(line, xy):
    """[m] from each place to the nearest point of the line."""
    best = np.full(len(xy), np.inf)
    for part in np.array_split(line, 40):
        best = np.minimum(best, np.hypot(xy[:, None, 0] - part[:, 0], xy[:, None, 1] - part[:, 1]).min(axis=1))
    return best


def rock_catalogue(line, site=Site):
    """Rocks as rows x, y, D, H, turn: centre and diameter [m], height over diameter, azimuth [rad]; from large to small.
    Those in the site and, from rock_smallest_around on, those in the rest of the field. A rock that would lie within
    the lane about the route `line`, or in the other area, gets another place."""
    rng = np.random.default_rng(site.seed + 3)
    half = (Field.posts - 1) * Field.spacing / 2
    inside = lambda xy: ((xy[:, 0] >= site.west) & (xy[:, 0] <= site.east)
                         & (xy[:, 1] >= site.south) & (xy[:, 1] <= site.north))
    area = (site.east - site.west) * (site.north - site.south)
    rest = (2 * half) ** 2 - area
    found = []
    for where, smallest, low, high in (
            (area, site.rock_smallest, (site.west, site.south), (site.east, site.north)),
            (rest, site.rock_smallest_around, (-half, -half), (half, half))):
        count = rng.poisson(rocks_per_area(smallest, site.rock_largest, site) * where)
        diameter = _diameters(rng.random(count), smallest, site.rock_largest, site)
        low, high = np.array(low), np.array(high)
        xy = low + rng.random((count, 2)) * (high - low)
        for _ in range(100):
            bad = distance_to(line, xy) < site.lane + diameter / 2
            bad |= inside(xy) != (where == area)
            if not bad.any():
                break
            xy[bad] = low + rng.random((int(bad.sum()), 2)) * (high - low)
        shape = 0.40 + 0.25 * rng.random(count)
        found.append(np.column_stack([xy, diameter, shape * diameter, 2 * np.pi * rng.random(count)]))
    rows = np.vstack(found)
    return rows[np.argsort(-rows[:, 2], kind="stable")]


def with_rocks(z, rocks, site=Site):
    """Heights with the rocks of the site, each the upper half of an ellipsoid on the ground at its centre; and the
    ground's height there [m] (NaN outside the site)."""
    x, y = axes(site)
    z, ground = z.copy(), np.full(len(rocks), np.nan)
    for n, (cx, cy, d, h, _) in enumerate(rocks):
        i, j = (cx - site.west) / site.spacing, (site.north - cy) / site.spacing
        if not (0 <= i <= len(x) - 1 and 0 <= j <= len(y) - 1):
            continue
        ground[n] = z[int(round(j)), int(round(i))]
    for (cx, cy, d, h, _), low in zip(rocks, ground):
        if not np.isfinite(low) or d < site.rock_in_heights:
            continue
        i0, i1 = np.searchsorted(x, [cx - d / 2, cx + d / 2])
        j0, j1 = np.searchsorted(-y, [-cy - d / 2, -cy + d / 2])
        s = np.hypot(x[None, i0:i1] - cx, y[j0:j1, None] - cy) / (d / 2)
        top = low + h * np.sqrt(np.maximum(1 - s * s, 0))
        z[j0:j1, i0:i1] = np.where(s < 1, np.maximum(z[j0:j1, i0:i1], top), z[j0:j1, i0:i1])
    return z, ground


def bare_heights(field_heights, site=Site):
    """The site's ground without rocks [m]."""
    return base_relief(field_heights, site) + fine_relief(site) + craters_relief(site_craters(site), *axes(site))


def rounded(z, quantum):
    """Multiples of the quantum, as int16."""
    counts = np.round(z / quantum)
    assert np.abs(counts).max() < 32768
    return counts.astype(np.int16)


def site(field_heights, line, site=Site):
    """Heights in counts of the quantum (int16), and the rocks: float32 rows x, y, ground, D, H, turn."""
    rocks = rock_catalogue(line, site)
    z, ground = with_rocks(bare_heights(field_heights, site), rocks, site)
    outside = ~np.isfinite(ground)
    half = (Field.posts - 1) * Field.spacing / 2
    u = np.clip((rocks[outside, 0] + half) / Field.spacing, 0, Field.posts - 1.001)
    v = np.clip((half - rocks[outside, 1]) / Field.spacing, 0, Field.posts - 1.001)
    i, j = u.astype(int), v.astype(int)
    a, b = u - i, v - j
    f = field_heights.astype(float)
    ground[outside] = ((f[j, i] * (1 - a) + f[j, i + 1] * a) * (1 - b) + (f[j + 1, i] * (1 - a) + f[j + 1, i + 1] * a) * b)
    rows = np.column_stack([rocks[:, :2], ground, rocks[:, 2:]])
    return rounded(z, site.quantum), np.round(rows, 3).astype(np.float32)


# --- surroundings --------------------------------------------------------------------------------

def hills(hills=Hills):
    """Heights of the surroundings in counts of their quantum (int16), row 0 north: level about the field, hills beyond."""
    rng = np.random.default_rng(hills.seed)
    n = 256
    kx = np.fft.fftfreq(n, hills.spacing)[:, None]
    ky = np.fft.rfftfreq(n, hills.spacing)[None, :]
    k = np.hypot(kx, ky)
    k[0, 0] = 1.0
    amplitude = k ** -(1 + hills.hurst)
    amplitude[k < 1.0 / hills.longest_wave] = 0.0
    z = np.fft.irfft2(amplitude * np.sqrt(-2 * np.log(1 - rng.random(k.shape)))
                      * np.exp(2j * np.pi * rng.random(k.shape)), (n, n))[:hills.posts, :hills.posts]
    z *= hills.deviation / z.std()
    at = (np.arange(hills.posts) - (hills.posts - 1) / 2) * hills.spacing
    distance = np.hypot(at[None, :], at[:, None])
    smooth = lambda begin, full: (lambda s: s * s * (3 - 2 * s))(np.clip((distance - begin) / (full - begin), 0, 1))
    rise, under = smooth(hills.begin, hills.full), 1 - smooth(*hills.edge)
    level = hills.plain + (hills.floor - hills.plain) * under
    reach = -at[0]
    craters = craters_relief(crater_catalogue(hills.seed + 1, (-reach, -reach), (reach, reach), hills.smallest,
                                              hills.largest), at, at[::-1])
    counts = rounded(level + (1 - under) * craters + rise * (z + hills.deviation), hills.quantum)
    counts[np.maximum(np.abs(at[None, :]), np.abs(at[:, None])) <= hills.hole] = hills.no_data
    return counts


# --- soil ----------------------------------------------------------------------------------------

def colours(heights, field_heights, line, site=Site):
    """Indices of the palette (uint8) at pixels of color_spacing, their centres from the north-western post on: grains and
    mottles, brighter on what the fine heights raise and darker in small hollows, about the field's own colours. 0 beyond
    color_reach from the route. Shading by light is left to the renderer."""
    fine = int(round(site.spacing / site.color_spacing))
    x, y = axes(site)
    half = (Field.posts - 1) * Field.spacing / 2
    of_field = make_field.colours(field_heights)[0].astype(float) / 255
    value = (_cubic((half - y) / (2 * Field.spacing), of_field.shape[0]) @ of_field
             @ _cubic((x + half) / (2 * Field.spacing), of_field.shape[1]).T)
    value += 0.07 * np.clip((heights - base_relief(field_heights, site)) / 0.03, -1, 1)
    value = np.kron(value, np.ones((fine, fine)))
    rng = np.random.default_rng(site.seed + 4)
    n = 4096
    k = np.hypot(np.fft.fftfreq(n, site.color_spacing)[:, None], np.fft.rfftfreq(n, site.color_spacing)[None, :])
    k[0, 0] = 1.0
    mottle = np.fft.irfft2(k ** -1.0 * (k > 1 / 10.0) * np.exp(2j * np.pi * rng.random(k.shape)), (n, n))
    value += 0.028 * (mottle / mottle.std())[:value.shape[0], :value.shape[1]]
    value += 0.02 * rng.standard_normal(value.shape)
    last = site.shades - 1
    shades = np.clip(np.round((value - site.darkest) / (site.brightest - site.darkest) * last), 0, last)
    px, py = np.meshgrid(x, y)
    away = distance_to(line[::20], np.column_stack([px.ravel(), py.ravel()])).reshape(px.shape)
    # Scattered towards the end: from afar, where pixels are means, it fades into the colours below.
    near = away <= site.color_reach - site.color_fade * rng.random(away.shape)
    return np.where(np.kron(near, np.ones((fine, fine), bool)), shades + 1, 0).astype(np.uint8)


def palette(site=Site):
    """sRGB of each index of colours()."""
    grey = site.darkest + (site.brightest - site.darkest) * np.arange(site.shades) / (site.shades - 1)
    return np.vstack([[0, 0, 0], np.round(np.outer(grey, (255, 249, 238)))]).astype(np.uint8)


# --- files ---------------------------------------------------------------------------------------

def write_heights(path, counts, spacing, west, north, quantum):
    """Int16 GeoTIFF with scale; posts at the pixels' centres."""
    from osgeo import gdal
    gdal.UseExceptions()
    rows, columns = counts.shape
    data = gdal.GetDriverByName("GTiff").Create(
        str(path), columns, rows, 1, gdal.GDT_Int16, ["COMPRESS=DEFLATE", "PREDICTOR=2", "ZLEVEL=9", "TILED=YES"])
    data.SetGeoTransform([west - spacing / 2, spacing, 0, north + spacing / 2, 0, -spacing])
    data.SetProjection(make_field.projection().ExportToWkt())
    data.SetMetadataItem("AREA_OR_POINT", "Point")
    data.SetMetadataItem("VERTICAL_DATUM", f"sphere:{Field.moon_radius:.0f}")
    band = data.GetRasterBand(1)
    band.SetUnitType("m")
    band.SetDescription("height")
    band.SetScale(quantum)
    band.SetOffset(0.0)
    band.SetNoDataValue(Hills.no_data)
    band.WriteArray(counts)
    data = None


def write_colours(path, indices, site=Site):
    """GeoTIFF with a colour table; index 0 is no data."""
    from osgeo import gdal
    gdal.UseExceptions()
    rows, columns = indices.shape
    data = gdal.GetDriverByName("GTiff").Create(str(path), columns, rows, 1, gdal.GDT_Byte,
                                                ["COMPRESS=DEFLATE", "ZLEVEL=9", "TILED=YES"])
    h = site.color_spacing
    data.SetGeoTransform([site.west - site.spacing / 2, h, 0, site.north + site.spacing / 2, 0, -h])
    data.SetProjection(make_field.projection().ExportToWkt())
    table = gdal.ColorTable()
    for index, color in enumerate(palette(site)):
        table.SetColorEntry(index, (*map(int, color), 255 if index else 0))
    band = data.GetRasterBand(1)
    band.SetColorTable(table)
    band.SetNoDataValue(0)
    band.WriteArray(indices)
    data = None


def make(folder, field_heights=None):
    """Writes site.tif, site_color.tif, rocks.npy and hills.tif into `folder`, which holds route.json."""
    folder = Path(folder)
    z = make_field.heights() if field_heights is None else field_heights
    line = route_line(way_points(folder))
    counts, rocks = site(z, line)
    write_heights(folder / "site.tif", counts, Site.spacing, Site.west, Site.north, Site.quantum)
    np.save(folder / "rocks.npy", rocks)
    reach = (Hills.posts - 1) * Hills.spacing / 2
    write_heights(folder / "hills.tif", hills(), Hills.spacing, -reach, reach, Hills.quantum)
    write_colours(folder / "site_color.tif", colours(counts * Site.quantum, z, line))
    return counts, rocks


if __name__ == "__main__":
    make(sys.argv[1] if len(sys.argv) > 1 else Path(__file__).resolve().parents[1] / "field")
