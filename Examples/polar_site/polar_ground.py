"""A generated terrain at the Moon's south pole: hills, a ridge, and craters from a size-frequency distribution, seeded."""
import numpy as np

RADIUS = 1737400.0  # [m] of the Moon's sphere
POLAR = ('PROJCS["Moon south pole",GEOGCS["Moon 2000",DATUM["Moon 2000",SPHEROID["Moon 2000",1737400,0]],PRIMEM["Reference meridian",0],'
         'UNIT["degree",0.0174532925199433]],PROJECTION["Polar_Stereographic"],PARAMETER["latitude_of_origin",-90],'
         'PARAMETER["central_meridian",0],PARAMETER["scale_factor",1],UNIT["metre",1]]')


def heights(side, spacing, seed=7):
    """Heights [m] (side, side), row 0 in the north of the map, `spacing` metres apart."""
    random = np.random.default_rng(seed)
    span = side * spacing
    y, x = np.mgrid[0:side, 0:side].astype(np.float32) * np.float32(spacing)
    z = hills(random, side, spacing)
    # A ridge 12 km long through the middle, which the hills bend.
    bend = (4.0 * z).astype(np.float32)
    along = (x - 0.5 * span) * 0.8 + (y - 0.5 * span) * 0.6
    across = (x - 0.5 * span) * -0.6 + (y - 0.5 * span) * 0.8 + bend
    z += 900.0 * np.exp(-np.abs(across / 2200.0) ** 1.6 - (along / 6000.0) ** 4)
    # Craters of diameters from 8 km down to 5 posts: N(> D) ~ D^-2.
    least, most = 5.0 * spacing, 0.15 * span
    for share in np.sort(random.uniform(0.0, 1.0, 2500)):
        diameter = 1.0 / np.sqrt(share / least**2 + (1.0 - share) / most**2)
        crater(z, spacing, random.uniform(0.0, span, 2), diameter, age=random.uniform(0.2, 1.0))
    return z


def hills(random, side, spacing):
    """Noise whose amplitude grows with the wavelength to the power 1.2, to 400 m root mean square."""
    frequency = np.hypot(np.fft.fftfreq(side, spacing)[:, None], np.fft.rfftfreq(side, spacing)[None, :])
    amplitude = np.maximum(frequency, 1.0 / (side * spacing)) ** -2.2
    amplitude[0, 0] = 0.0
    noise = np.fft.irfft2(amplitude * np.exp(2j * np.pi * random.uniform(0.0, 1.0, frequency.shape)), (side, side))
    return (400.0 * noise / noise.std()).astype(np.float32)


def crater(z, spacing, centre, diameter, age):
    """A bowl a fifth as deep as wide with a raised rim (Pike 1977: rims of 4 % of the diameter), flattened by `age`."""
    radius = 0.5 * diameter
    reach = int(np.ceil(2.5 * radius / spacing))
    column, row = (np.asarray(centre) / spacing).astype(int)
    rows, columns = (slice(max(0, c - reach), min(z.shape[0], c + reach + 1)) for c in (row, column))
    y, x = np.mgrid[rows, columns]
    r = np.hypot(x * spacing - centre[0], y * spacing - centre[1]) / radius
    rim = 0.04 * diameter
    bowl = (0.2 * diameter + rim) * (r * r - 1.0) + rim
    z[rows, columns] += (age * np.where(r < 1.0, bowl, rim * np.maximum(r, 1e-6) ** -3 * (r < 2.5))).astype(np.float32)


def write(path, side=2000, spacing=20.0, seed=7):
    """Writes the terrain as a GeoTIFF in a polar stereographic projection, heights above the Moon's sphere. Returns its heights
    (side, side)."""
    from osgeo import gdal
    gdal.UseExceptions()
    z = heights(side, spacing, seed)
    data = gdal.GetDriverByName("GTiff").Create(str(path), side, side, 1, gdal.GDT_Float32, ["COMPRESS=DEFLATE", "PREDICTOR=3"])
    data.SetGeoTransform((-0.5 * side * spacing, spacing, 0, 0.5 * side * spacing, 0, -spacing))
    data.SetProjection(POLAR)
    data.SetMetadataItem("VERTICAL_DATUM", "sphere")
    data.GetRasterBand(1).WriteArray(z)
    return z
