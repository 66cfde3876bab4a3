"""Illumination over many terrains that differ by the errors of the heights."""
import hashlib
import json
import os
import shutil
import warnings

import numpy as np

from dspace._core.fields import array_of, file_path, flag, integer, reject
from dspace._core.files import AtomicFile, atomic_write
from dspace.errors import AlreadyExists, DspaceWarning, NotFound, Unsupported, WrongType
from dspace.measure.map_file import MapFile
from dspace.measure.maps import LIT, Maps
from dspace.measure.variogram import Variogram
from dspace.terrain.factory import TerrainFactory

MOST_MEMBERS = 10_000
ROWS = 64  # of the maps of all members that are read at once
HORIZONS = 0.95  # of the work on a member


class Ensembles:
    """Maps ensembles for a Scene, which delegates to it."""

    def __init__(self, scene):
        self._scene = scene

    def illumination_ensemble(self, raster, path, variogram, *, members=20, seed=0, percentiles=(5.0, 50.0, 95.0),
                              quantities=("lit_fraction", "longest_night"), height=0.0, azimuths=360, extent=None, cell_size=0.0, fast=False,
                              start=None, end=None, step=3600.0, body=None, sun=None, earth=None, eclipses=True, terrain=None,
                              keep=False, replace=False, threads=0, progress=None):
        """Writes how much an illumination map depends on the errors of the heights to a GeoTIFF: of each quantity the mean and
        percentiles over an ensemble of terrains, as Barker et al. 2021 judge landing sites. Returns a MapFile.

        Each member is the raster plus random errors with the stated variogram, which cover all of it; it has a horizon map and
        an illumination map of its own. raster: a file of heights that GDAL reads. path: of a new file. variogram: a Variogram.
        members: 2 to 10,000. seed: a whole number, 0 or more; member k of a seed has the same errors in every ensemble.
        percentiles: 0 to 100, of the members' values (linear between them). terrain: a dict of arguments of add_terrain, such as
        dict(on_body=True). height, azimuths, extent, cell_size, fast: as of horizon_map(); start, end, step, body, sun, earth, eclipses,
        quantities: as of illumination_map(). threads and progress: as of both.

        The map of each finished member stays in the folder "PATH.members" until the ensemble is complete, with keep=True also
        after that; the same call continues, and its result is the same to the byte. While a member's map is made the scene has its
        terrain. replace=True: an existing file is replaced, and maps of members of other inputs are removed.

        Errors on a raster that stands on its body are functions of straight distances between places (Variogram.field_at), others
        of distances on the map (Variogram.field). Needs python3-gdal, and files of this machine. Raises what horizon_map() and
        illumination_map() raise, and dspace.AlreadyExists for members of other inputs."""
        about = "illumination ensemble"
        raster, path = file_path(raster, "the raster", about), os.path.abspath(file_path(path, "the path", about))
        if not isinstance(variogram, Variogram):
            reject(about, "the variogram", variogram, "a dspace.Variogram", WrongType)
        if not 2 <= integer(members, "members", about) <= MOST_MEMBERS:
            reject(about, "members", members, f"2 to {MOST_MEMBERS}")
        if integer(seed, "seed", about) < 0:
            reject(about, "seed", seed, "a whole number, 0 or more")
        shares = array_of(percentiles, "percentiles", "numbers from 0 to 100", about).reshape(-1)
        if not ((shares >= 0.0) & (shares <= 100.0)).all():
            reject(about, "percentiles", shares.tolist(), "numbers from 0 to 100")
        chosen = [quantities] if isinstance(quantities, str) else list(quantities)
        for quantity in chosen:
            if quantity not in LIT:
                reject(about, "a quantity", quantity, ", ".join(LIT))
        terrain = {} if terrain is None else terrain
        if not isinstance(terrain, dict):
            reject(about, "terrain", terrain, "a dict of arguments of add_terrain", WrongType)
        if os.path.lexists(path) and not flag(replace, "replace", about):
            raise AlreadyExists(f"file {path!r}: it exists; accepted: a new file, or replace=True", path)
        places = {"height": height, "azimuths": azimuths, "extent": extent, "cell_size": cell_size, "fast": fast}
        times = {"start": start, "end": end, "step": step, "body": body, "sun": _listed(sun), "earth": _listed(earth),
                 "eclipses": flag(eclipses, "eclipses", about)}
        work = _Work(self._scene, raster, path, variogram, seed, terrain, places, times, chosen, replace, threads, progress, members)
        made = [work.member(k) for k in range(members)]
        found = _statistics(path, made, chosen, shares, {"DSPACE_MEMBERS": str(members), "DSPACE_SEED": str(seed),
                                                         "DSPACE_VARIOGRAM": repr(variogram)})
        if not keep:
            shutil.rmtree(work.folder)
        return found


def _listed(places):
    return None if places is None else np.asarray(places).tolist()


class _Work:
    """The members of an ensemble."""

    def __init__(self, scene, raster, path, variogram, seed, terrain, places, times, quantities, replace, threads, progress, members):
        self._gdal = _gdal(raster)
        self._scene, self._raster, self._variogram, self._seed = scene, raster, variogram, seed
        self._terrain, self._places, self._times, self._quantities = terrain, places, times, quantities
        self._threads, self._progress, self._members = threads, progress, members
        self._base = None  # not asked yet
        self.folder = f"{path}.members"
        inputs = {"version": 1, "raster": _hash(raster), "variogram": repr(variogram), "seed": seed, "quantities": quantities,
                  "terrain": {name: repr(value) for name, value in terrain.items()}, **places, **times}
        stated = json.dumps(inputs, indent=1, sort_keys=True, default=repr).encode()
        note = os.path.join(self.folder, "inputs.json")
        known = None
        if os.path.exists(note):
            with open(note, "rb") as file:
                known = file.read()
        if os.path.lexists(self.folder) and known != stated:
            if not replace:
                raise AlreadyExists(f"folder {self.folder!r}: it has members of other inputs; accepted: the same inputs, another path, or "
                                    "replace=True", self.folder)
            shutil.rmtree(self.folder)
        os.makedirs(self.folder, exist_ok=True)
        atomic_write(note, stated)

    def member(self, k):
        """The illumination map of a member."""
        lit = os.path.join(self.folder, f"member_{k:04d}.tif")
        if os.path.exists(lit):
            self._tell(k, 1.0, 0.0)
            return MapFile.open(lit)
        ground_file, horizon_file = (os.path.join(self.folder, name) for name in ("ground.tif", f"horizons_{k:04d}.tif"))
        name = f"member {k} of an ensemble"
        terrains, maps = TerrainFactory(self._scene), Maps(self._scene)
        if self._base is None:
            self._base = self._find_base(terrains)
        self._write_ground(k, ground_file)
        with warnings.catch_warnings():  # that of the raster itself has said it
            warnings.simplefilter("ignore", DspaceWarning)
            ground = self._open(terrains, ground_file, name)
        try:
            if os.path.exists(horizon_file):
                horizons = MapFile.open(horizon_file)
            else:
                horizons = maps.horizon_map(ground, horizon_file, threads=self._threads,
                                            progress=lambda done, left: self._tell(k, HORIZONS * done, left), **self._places)
            made = maps.illumination_map(horizons, lit, quantities=self._quantities, terrain=ground, threads=self._threads,
                                         progress=lambda done, left: self._tell(k, HORIZONS + (1.0 - HORIZONS) * done, left),
                                         **self._times)
        finally:
            ground.remove()
        os.remove(horizon_file)
        os.remove(ground_file)
        return MapFile.open(made.path)

    def _tell(self, k, done, left):
        if self._progress is not None:
            self._progress((k + done) / self._members, np.inf if done == 0.0 else left)

    def _open(self, terrains, path, name):
        return terrains.add_terrain(path, name=name, cache=False, build_overviews=False, **{"mode": "clipmap", **self._terrain})

    def _find_base(self, terrains):
        """Of the raster: metres of a step of its values, and a function that makes the errors [m] of its pixels."""
        base = self._open(terrains, self._raster, "ground of an ensemble")
        try:
            data = self._gdal.Open(self._raster)
            x0, dx, bx, y0, by, dy = data.GetGeoTransform(can_return_null=True) or _geotransform(self._terrain, data)
            columns, rows = data.RasterXSize, data.RasterYSize

            def places(c, r):
                c, r = np.broadcast_arrays(c + 0.5, r + 0.5)
                return base.from_map(np.stack((x0 + dx * c + bx * r, y0 + by * c + dy * r, np.zeros(c.shape)), axis=-1))
            scale = base._info().vertical_scale
            if base.on_body:
                everywhere = places(np.arange(columns)[None, :], np.arange(rows)[:, None])
                return scale, lambda random: self._variogram.field_at(everywhere, random)
            corner = places(np.array([0, 1, 0]), np.array([0, 0, 1]))
            spacing = np.linalg.norm(corner[2] - corner[0]), np.linalg.norm(corner[1] - corner[0])
            return scale, lambda random: self._variogram.field((rows, columns), spacing, random)
        finally:
            base.remove()

    def _write_ground(self, k, path):
        """The raster of a member."""
        gdal = self._gdal
        scale, errors = self._base
        data = gdal.Open(self._raster)
        band = data.GetRasterBand(self._terrain.get("band") or 1)
        made = gdal.GetDriverByName("GTiff").Create(path, data.RasterXSize, data.RasterYSize, 1, gdal.GDT_Float32,
                                                    ["TILED=YES", "BIGTIFF=IF_SAFER"])
        if data.GetGeoTransform(can_return_null=True) is not None:
            made.SetGeoTransform(data.GetGeoTransform())
        if data.GetSpatialRef() is not None:
            made.SetSpatialRef(data.GetSpatialRef())
        made.SetMetadata(data.GetMetadata())
        to = made.GetRasterBand(1)
        values = band.ReadAsArray().astype(float)
        known = band.GetMaskBand().ReadAsArray() != 0
        if self._terrain.get("nodata") is not None:
            known &= values != self._terrain["nodata"]
        to.SetNoDataValue(np.nan)
        to.SetUnitType(band.GetUnitType())
        for get, put in ((band.GetScale, to.SetScale), (band.GetOffset, to.SetOffset)):
            if get() is not None:
                put(get())
        to.WriteArray(np.where(known, values + errors(np.random.default_rng([self._seed, k])) / scale, np.nan).astype(np.float32))


def _geotransform(terrain, data):
    """That Dspace assumes where the file has none."""
    side = terrain.get("pixel_size") or 1.0
    return 0.0, side, 0.0, data.RasterYSize * side, 0.0, -side


def _statistics(path, members, quantities, shares, metadata):
    gdal = _gdal(path)
    names = [f"{quantity} {what}" for quantity in quantities for what in ("mean", *(f"percentile {share:g}" for share in shares))]
    first = members[0]
    with AtomicFile(path) as file:
        made = gdal.GetDriverByName("GTiff").Create(file.temporary, first.columns, first.rows, len(names), gdal.GDT_Float32,
                                                    ["TILED=YES", "BLOCKXSIZE=64", "BLOCKYSIZE=64", "INTERLEAVE=BAND",
                                                     "BIGTIFF=IF_SAFER"])
        source = gdal.Open(first.path)
        made.SetGeoTransform(source.GetGeoTransform())
        if source.GetSpatialRef() is not None:
            made.SetSpatialRef(source.GetSpatialRef())
        kept = {name: value for name, value in first.metadata.items() if name not in ("DSPACE_KIND", "DSPACE_TERRAIN")}
        made.SetMetadata({**kept, "DSPACE_KIND": "illumination ensemble", **metadata})
        for b, name in enumerate(names):
            made.GetRasterBand(b + 1).SetDescription(name)
        made.GetRasterBand(1).SetNoDataValue(np.nan)
        for row in range(0, first.rows, ROWS):
            count = min(ROWS, first.rows - row)
            for q, quantity in enumerate(quantities):
                values = np.stack([member.read(quantity, rows=(row, count)) for member in members]).astype(float)
                parts = [values.mean(axis=0), *np.percentile(values, shares, axis=0)]
                for p, part in enumerate(parts):
                    made.GetRasterBand(q * len(parts) + p + 1).WriteArray(part.astype(np.float32), 0, row)
        made = None  # writes the file
    return MapFile.open(path)


def _hash(path):
    hashed = hashlib.sha256()
    try:
        with open(path, "rb") as file:
            for block in iter(lambda: file.read(1 << 20), b""):
                hashed.update(block)
    except OSError as error:
        raise NotFound(f"raster {path!r}: {error.strerror}; accepted: a file of this machine", path) from None
    return hashed.hexdigest()


def _gdal(path):
    try:
        from osgeo import gdal
    except ImportError:
        raise Unsupported("GDAL's Python package, which reads maps, is not installed (Debian: python3-gdal)", path) from None
    gdal.UseExceptions()
    return gdal
