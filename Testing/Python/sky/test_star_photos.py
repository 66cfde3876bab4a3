"""The four photographs of tetra3 (ESA, github esa/tetra3) against the sky that Dspace draws for their lens and pointing.

Pointing, focal length, centre and one radial term of the lens are solved here, by least squares from stars that are
identified from the rough pointings below (found once by triangles of the brightest stars). The site and the time scale are
not published: the zenith is that of 52.22 N 4.42 E (ESTEC) at the file names' time as UTC, from which all four stand 41.2
degrees high and 90 degrees of azimuth apart. What the air lifts differs by 20 arcsec over a photograph (half a pixel)."""
import math
import os
import pathlib
import re
import shutil
import subprocess

import numpy as np
import pytest
from needs import lacks, needs_module

import dspace
from dspace.frames.poses import quaternion_of_matrix
from dspace.stars import read_kstars
from dspace.stars.kstars import KSTARS_PATH

FOLDER = pathlib.Path(os.environ.get("DSPACE_DATA", "/nonexistent")) / "stars/tetra3_photos"
UTC, SITE = "2019-07-29T20:47:26", (4.42, 52.22)
SIZE = (1024, 768)
# Right ascension and declination of the axis, and of the picture's upper edge [deg].
ROUGH = {"-135": (230.735, 10.992), "-45": (172.362, 57.649), "135": (296.756, 11.308), "45": (355.213, 58.155)}
# Semiregular variables (GCVS): Z Ursae Majoris (V 6.2 to 9.4), V450 Aquilae. [deg]
VARIABLE = ((179.126, 57.871), (293.442, 5.466))
WINDOW = 12  # [pixels] about a star


def smooth(a, sigma):
    """A Gaussian filter, by rows and columns."""
    reach = int(4 * sigma + 1)
    kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) / sigma) ** 2)
    kernel /= kernel.sum()
    for axis in (0, 1):
        a = np.apply_along_axis(lambda row: np.convolve(np.pad(row, reach, "edge"), kernel, "valid"), axis, a)
    return a


def centre(picture, x, y):
    """The centroid of the star near a place, by a Gaussian window that follows it; NaN: none, or it is at the border."""
    for _ in range(20):
        column, row = int(round(x)), int(round(y))
        if not (WINDOW <= column < SIZE[0] - WINDOW and WINDOW <= row < SIZE[1] - WINDOW):
            return np.nan, np.nan
        part = picture[row - WINDOW:row + WINDOW + 1, column - WINDOW:column + WINDOW + 1]
        v, u = np.mgrid[row - WINDOW:row + WINDOW + 1, column - WINDOW:column + WINDOW + 1]
        away = np.hypot(u - x, v - y)
        level = np.median(part[(away > 5) & (away < 11)])
        weight = np.clip(part - level, 0, None) * np.exp(-away ** 2 / (2 * 1.2 ** 2)) * (away < 4)
        if weight.sum() <= 0:
            return np.nan, np.nan
        du, dv = (weight * (u - x)).sum() / weight.sum(), (weight * (v - y)).sum() / weight.sum()
        x, y = x + 1.5 * du, y + 1.5 * dv
        if math.hypot(du, dv) < 1e-4:
            break
    return x, y


def brightness(picture, x, y, sigma=1.2):
    """The star's light by a Gaussian's profile, over the median around it."""
    column, row = int(round(x)), int(round(y))
    part = picture[row - WINDOW:row + WINDOW + 1, column - WINDOW:column + WINDOW + 1]
    v, u = np.mgrid[row - WINDOW:row + WINDOW + 1, column - WINDOW:column + WINDOW + 1]
    away = np.hypot(u - x, v - y)
    profile = np.exp(-away ** 2 / (2 * sigma ** 2)) * (away < 4)
    return ((part - np.median(part[(away > 5) & (away < 11)])) * profile).sum() / (profile ** 2).sum()


def turned(rotation, about):
    """The rotation after a small one about the camera's axes [rad]."""
    angle = np.linalg.norm(about)
    if angle == 0.0:
        return rotation
    x, y, z = np.asarray(about) / angle
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return rotation @ (np.eye(3) + math.sin(angle) * k + (1 - math.cos(angle)) * k @ k)


def projected(lens, rotation, directions):
    """Pixels of unit vectors. rotation: columns are the camera's X right, Y down, Z forward. lens: f, k1, cx, cy."""
    seen = directions @ rotation
    place = seen[:, :2] / seen[:, 2:]
    return lens[2:] + lens[0] * place * (1.0 + lens[1] * (place ** 2).sum(axis=1, keepdims=True))


def solved(found, start, lens, fixed=False):
    """Least squares by Gauss and Newton: rotations of all photographs and one lens, which may be
    fixed. found: [(directions, pixels)]."""
    lens, rotations = np.array(lens, float), list(start)
    steps = np.array([1.0, 1e-3, 0.1, 0.1, 1e-5, 1e-5, 1e-5])
    for _ in range(12):
        size = 4 + 3 * len(found)
        normal, right = np.zeros((size, size)), np.zeros(size)
        for i, (directions, pixels) in enumerate(found):
            here = projected(lens, rotations[i], directions)
            rest = pixels - here
            weight = 1.0 / np.maximum(1.0, np.linalg.norm(rest, axis=1) / 0.5)
            columns = []
            for j, step in enumerate(steps):
                moved = lens + step * (np.arange(4) == j) if j < 4 else lens
                turn = step * (np.arange(3) == j - 4) if j >= 4 else (0, 0, 0)
                columns.append(((projected(moved, turned(rotations[i], turn), directions) - here) / step).ravel())
            jacobian = np.stack(columns, 1) * np.repeat(weight, 2)[:, None]
            at = [0, 1, 2, 3, 4 + 3 * i, 5 + 3 * i, 6 + 3 * i]
            normal[np.ix_(at, at)] += jacobian.T @ jacobian
            right[at] += jacobian.T @ (rest.ravel() * np.repeat(weight, 2))
        if fixed:
            normal[:4], right[:4] = np.eye(size)[:4], 0.0
        change = np.linalg.solve(normal, right)
        lens = lens + change[:4]
        rotations = [turned(rotation, change[4 + 3 * i:7 + 3 * i]) for i, rotation in enumerate(rotations)]
    return lens, rotations


def ranks(values):
    return np.argsort(np.argsort(values)).astype(float)


def direction(ra, dec):
    ra, dec = np.radians(ra), np.radians(dec)
    return np.stack(np.broadcast_arrays(np.cos(dec) * np.cos(ra), np.cos(dec) * np.sin(ra), np.sin(dec)), -1)


def rough(ra, dec, zenith):
    """Level: the zenith above the picture's middle."""
    ahead = direction(ra, dec)
    right = np.cross(ahead, zenith)
    right /= np.linalg.norm(right)
    return np.stack([right, np.cross(ahead, right), ahead], 1)


def read(path):
    from osgeo import gdal
    return gdal.Open(str(path)).ReadAsArray().astype(float)


def inside(pixels, margin):
    return ((pixels > margin) & (pixels < np.array(SIZE) - 1 - margin)).all(axis=1)


class Sky:
    """The photographs, the stars at their apparent places, and the solution."""

    def __init__(self, scene):
        time = scene.tdb(UTC)
        longitude, latitude = np.radians(SITE)
        vertical = (math.cos(latitude) * math.cos(longitude), math.cos(latitude) * math.sin(longitude), math.sin(latitude))
        self.zenith = scene.reference_frames.rotation("ITRF93", "J2000", time) @ vertical
        velocity = scene.ephemeris("earth", "solar system barycenter", time).velocity
        catalogue = read_kstars()
        self.stars = catalogue.apparent(2019.575, velocity=velocity, zenith=self.zenith)
        self.without_air = catalogue.apparent(2019.575, velocity=velocity).directions()
        self.directions = self.stars.directions()
        self.photos = {key: read(FOLDER / f"2019-07-29T204726_Alt40_Azi{key}_Try1.tiff") for key in ROUGH}
        rotations = [rough(*ROUGH[key], self.zenith) for key in ROUGH]
        lens = (512 / math.tan(math.radians(5.7)), 0.0, 511.5, 383.5)
        lines = {key: smooth(photo - np.median(photo), 0.9) for key, photo in self.photos.items()}
        for reach in (40, 12, 4, 2, 1, 1):
            found = [self._match(lines[key], photo, rotation, lens, reach)
                     for (key, photo), rotation in zip(self.photos.items(), rotations)]
            lens, rotations = solved([(self.directions[s], p) for s, p in found], rotations, lens)
        self.lens, self.rotations = lens, dict(zip(ROUGH, rotations))

    def _match(self, smoothed, photo, rotation, lens, reach):
        """Stars and their centroids: of those that should be there, the brightest place within `reach` pixels."""
        seen = self.seen(rotation, lens, 25 if reach > 4 else 60)
        pixels = projected(lens, rotation, self.directions[seen])
        stars, places = [], []
        for star, (x, y) in zip(seen, pixels):
            column, row, r = int(round(x)), int(round(y)), int(reach)
            if not (r + 16 <= column < SIZE[0] - r - 16 and r + 16 <= row < SIZE[1] - r - 16):
                continue
            part = smoothed[row - r:row + r + 1, column - r:column + r + 1]
            dv, du = np.unravel_index(part.argmax(), part.shape)
            place = centre(photo, column - r + du, row - r + dv)
            if np.isfinite(place).all() and math.hypot(place[0] - x, place[1] - y) < 1.5 * reach + 0.5:
                stars.append(star)
                places.append(place)
        return np.array(stars), np.array(places)

    def seen(self, rotation, lens, count, margin=14):
        """The brightest stars in a photograph, without those beside a brighter one (4 pixels)."""
        ahead = np.flatnonzero(self.directions @ rotation[:, 2] > math.cos(math.radians(8)))
        pixels = projected(lens, rotation, self.directions[ahead])
        ahead, pixels = ahead[inside(pixels, margin)], pixels[inside(pixels, margin)]
        order = np.argsort(self.stars.magnitude[ahead])
        ahead, pixels = ahead[order], pixels[order]
        kept = []
        for i in range(len(ahead)):
            if len(kept) == count:
                break
            if not any(np.hypot(*(pixels[i] - pixels[j])) < 4.0 for j in range(i)):
                kept.append(i)
        return ahead[kept]


@pytest.fixture(scope="module")
def scene():
    with dspace.Session() as session:
        yield session.scene()


@pytest.fixture(scope="module")
def sky(scene):
    if not FOLDER.is_dir():
        pytest.skip("real data absent: set DSPACE_DATA to the folder that has stars/tetra3_photos")
    if not os.path.exists(KSTARS_PATH):
        lacks("kstars-data")
    needs_module("osgeo.gdal", "python3-gdal")
    return Sky(scene)


def drawn(scene, sky, key):
    """The radiance that Dspace draws for a photograph's pointing and lens, of all its stars."""
    focal, k1, x, y = sky.lens
    model = dspace.CameraModel("brown", focal=(focal, focal), center=(x, y), radial=(k1,), size=SIZE, position=(0, 0, 0),
                               quaternion=tuple(quaternion_of_matrix(sky.rotations[key])))
    return scene.simulate_image(model, frame=scene.root, color=False, radiance=True)["radiance"][:, :, 1].astype(float)


@pytest.fixture(scope="module")
def pictures(scene, sky):
    scene.add_stars(sky.stars, spread=1.0)
    return {key: drawn(scene, sky, key) for key in ROUGH}


def test_the_photographs_are_of_one_evening_and_one_place(sky):
    """What was solved without the site's latitude or the time: the axes stand equally high and 90 degrees apart."""
    heights = [math.degrees(math.asin(rotation[:, 2] @ sky.zenith)) for rotation in sky.rotations.values()]
    assert max(heights) - min(heights) < 0.5 and all(40.5 < height < 42.0 for height in heights)
    level = [rotation[:, 2] - (rotation[:, 2] @ sky.zenith) * sky.zenith for rotation in sky.rotations.values()]
    level = [each / np.linalg.norm(each) for each in level]
    assert all(abs(math.degrees(math.acos(level[i] @ level[i + 1])) - 90.0) < 2.0 for i in (0, 2))
    assert 2 * math.degrees(math.atan(512 / sky.lens[0])) == pytest.approx(11.4, abs=0.05)  # as published


@pytest.mark.parametrize("key", ROUGH)
def test_the_brightest_stars_are_drawn_where_they_were_photographed(sky, pictures, key):
    stars = sky.seen(sky.rotations[key], sky.lens, 50)
    pixels = projected(sky.lens, sky.rotations[key], sky.directions[stars])
    photographed = np.array([centre(sky.photos[key], *place) for place in pixels])
    found = np.array([centre(pictures[key], *place) for place in pixels])
    apart = np.linalg.norm(photographed - found, axis=1)
    assert len(stars) == 50 and np.isfinite(apart).all()
    assert apart.max() < 0.5, apart.max()
    assert math.sqrt((apart ** 2).mean()) < 0.2
    # What is drawn is where the lens has it: the centroids of blends and of the drawing itself.
    assert np.median(np.linalg.norm(found - pixels, axis=1)) < 0.03
    # Solved alone, the picture has the photograph's pointing within 10 arcsec.
    good = np.linalg.norm(found - pixels, axis=1) < 0.3
    axes = [solved([(sky.directions[stars][good], places[good])], [sky.rotations[key]], sky.lens, True)[1][0][:, 2]
            for places in (photographed, found)]
    assert math.degrees(np.linalg.norm(axes[0] - axes[1])) * 3600.0 < 10.0


def test_refraction_counts(sky):
    """Without it, what is solved is worse: the air lifts stars by up to 20 arcsec more at the lower edge."""
    rms = []
    for directions in (sky.directions, sky.without_air):
        found = []
        for key, rotation in sky.rotations.items():
            stars = sky.seen(rotation, sky.lens, 60)
            pixels = projected(sky.lens, rotation, sky.directions[stars])
            places = np.array([centre(sky.photos[key], *place) for place in pixels])
            good = np.linalg.norm(places - pixels, axis=1) < 1.0
            found.append((directions[stars[good]], places[good]))
        lens, rotations = solved(found, list(sky.rotations.values()), sky.lens)
        rest = np.concatenate([places - projected(lens, rotation, seen)
                               for (seen, places), rotation in zip(found, rotations)])
        rms.append(math.sqrt((rest ** 2).sum(axis=1).mean()))
    assert rms[0] < 0.15 and rms[1] > 1.02 * rms[0], rms


@pytest.mark.parametrize("key", ROUGH)
def test_brightness_has_the_order_of_the_photograph(sky, pictures, key):
    """By ranks, after a colour term of the camera (which sees more red than V does), without two variable stars."""
    stars = sky.seen(sky.rotations[key], sky.lens, 50)
    variable = np.min([np.linalg.norm(sky.directions[stars] - direction(*place), axis=1) for place in VARIABLE], axis=0)
    stars = stars[variable > 6e-4]  # two minutes of arc: their places are apparent
    pixels = projected(sky.lens, sky.rotations[key], sky.directions[stars])
    measured = np.log10([brightness(sky.photos[key], *centre(sky.photos[key], *place)) for place in pixels])
    seen = np.log10([brightness(pictures[key], *place) for place in pixels])
    color = np.clip(sky.stars.color_index[stars], -0.4, 2.2)
    terms = np.stack([np.ones_like(color), color], 1)
    weight = np.ones_like(color)
    for _ in range(10):  # saturated stars count little
        rest = measured - seen - terms @ np.linalg.lstsq(terms * weight[:, None], (measured - seen) * weight, rcond=None)[0]
        weight = 1.0 / np.sqrt(np.maximum(0.03, np.abs(rest)))
    term = np.linalg.lstsq(terms * weight[:, None], (measured - seen) * weight, rcond=None)[0][1]
    assert 0.0 < term < 0.2
    correlation = np.corrcoef(ranks(measured), ranks(seen + term * color))[0, 1]
    assert len(stars) >= 48 and correlation >= 0.95, correlation


def solved_by_others(picture, key, folder):
    """The right ascension and declination [deg] of the picture's middle by astrometry.net (Lang et al. 2010) and its index of Tycho-2."""
    cards = ["SIMPLE  =                    T", "BITPIX  =                  -32", "NAXIS   =                    2",
             *(f"NAXIS{k}  = {size:20d}" for k, size in enumerate(SIZE, 1)), "END"]
    path = folder / "picture.fits"
    path.write_bytes("".join(card.ljust(80) for card in cards).ljust(2880).encode()
                     + (picture / picture.max()).astype(">f4").tobytes().ljust(4 * SIZE[0] * SIZE[1] + 2880 - 4 * SIZE[0] * SIZE[1] % 2880, b"\0"))
    done = subprocess.run(["solve-field", "--overwrite", "--no-plots", "--scale-units", "degwidth", "--scale-low", "10", "--scale-high", "13",
                           "--tweak-order", "3", "--ra", f"{ROUGH[key][0]:.0f}", "--dec", f"{ROUGH[key][1]:.0f}", "--radius", "5",
                           "--cpulimit", "60", "--dir", str(folder), str(path)],
                          capture_output=True, text=True, timeout=200)
    center = re.search(r"Field center: \(RA,Dec\) = \(([-0-9.]+), ([-0-9.]+)\) deg", done.stdout)
    assert center, done.stdout[-2000:] + done.stderr[-500:]
    return float(center.group(1)), float(center.group(2))


@pytest.mark.parametrize("key", ROUGH)
def test_another_program_solves_photograph_and_picture_to_one_pointing(sky, pictures, key, tmp_path):
    if not shutil.which("solve-field"):
        lacks("astrometry.net")
    if not list(pathlib.Path("/usr/share/astrometry").glob("index-tycho2-1*.fits")):
        lacks("astrometry-data-tycho2-10-19")
    ours = pictures[key] + 1e-3 * pictures[key].max() * np.random.default_rng(1).random(SIZE[::-1])  # it asks for a sky with noise
    places = [direction(*solved_by_others(picture, key, tmp_path)) for picture in (sky.photos[key], ours)]
    assert math.degrees(np.linalg.norm(places[0] - places[1])) * 3600.0 < 10.0
