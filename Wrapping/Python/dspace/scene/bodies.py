"""Adds the Sun, planets and moons to a scene."""
import re

import numpy as np

from dspace._core.fields import array_of, file_path, put, put_given, put_vector, reject
from dspace.errors import InvalidArgument, WrongType
from dspace.objects.bodies import put_atmosphere, put_rings
from dspace.objects.graphics import GraphicsObject, put_settings
from dspace.sky.places import axes_of

_OWN = ("frame", "on_body", "mode", "image_crs", "image_extent")  # of add_terrain, which add_body sets
LEVEL_SIZE = 252  # cells along a level of a clipmap: the finest, for the limb of the whole body
_AXES = re.compile(r'(?:ELLIPSOID|SPHEROID)\["[^"]*",\s*([0-9.eE+-]+),\s*([0-9.eE+-]+)')


def _is(value, default):
    return isinstance(value, str) and value == default  # an array compares item by item


class BodyFactory:
    """Adds the bodies of a Scene, which delegates to it."""

    def __init__(self, scene):
        self._scene = scene

    def add_body(self, body=None, radii=None, texture=None, left_edge_deg=None, geodetic=None, albedo=None, sun=None,
                 eclipses=None, rings=None, atmosphere=None, point_gain=None, point_spread=None, terrain=None, center=None,
                 axes=None, center_axes="J2000", correction="NONE", **settings):
        """Adds the Sun, a planet or a moon: an ellipsoid that is seen from the ground to where it is a point.

        body: "sun", "earth", "moon", "mars", "saturn", ... (an unknown name lists all; radii of IAU's report of 2015), or any
        other by its radii [m], a number or three along X, Y, Z. Its axes are those of `frame`: X to longitude 0, Z to the
        north pole. The object's name is the body's unless given.
        texture: an image in plate carree from pole to pole, whose left edge has the longitude left_edge_deg (default
        -180). Its rows are planetocentric latitudes; geodetic=True (default for the Earth): geodetic ones.
        albedo: geometric albedo to which colour and texture are scaled; default: without texture and colour that of the
        body, else they are taken as they are. Photometry: reflectance=; default by body (the Moon: lunar-Lambert).
        sun: it is the Sun (default for "sun"): the light "sun" then comes from it, its irradiance is that at 1 au, and
        bodies with `eclipses` (default: all others) hide it from other things, penumbra included.
        rings: (inner, outer [m], optical depth[, colour]) each, from the inside out; () for none; default: Saturn's own.
        atmosphere: a dict of top, rayleigh, rayleigh_height, mie, mie_extinction, mie_height, mie_asymmetry [m, 1/m], or
        False for none; default: those of the Earth and of Mars (single scattering of Rayleigh's kind and by haze).
        What is smaller than a few pixels shares out the light of its disc among them: it keeps its irradiance.
        point_gain, point_spread: as gain and spread of add_stars, for a planet among stars, where its disc has a radius below
        half a pixel (default: 1, and 0 pixels). They fade up to a radius of 2 pixels. Not for the Sun.

        center: the body follows the scene's time: it stands on a new frame of its name, which add_celestial_frame makes
        below `frame` (default: the root) with center, center_axes and correction, and with `axes` (default: those that
        turn with the body: MOON_ME, ITRF93, IAU_...). With center=body it turns about the origin. GraphicsObject.frame
        is that frame.
        terrain: a raster of heights of the whole body, or of a part of it, that lies on it: its path, or a dict of path
        and what add_terrain takes besides (patches of higher resolution, vertical_datum, ...). It is drawn in place of the
        ellipsoid where the disc has a radius of 12 pixels or more, in the body's texture, albedo and reflectance, so that
        one scene goes from deep space to the ground. The terrain is named as the body with " terrain" behind it
        (scene.terrains) unless the dict names it, and has the finest level_size (252); remove it with the body. radii are by default those of its CRS.
        A texture lies on it as the layer "texture"; without one, and without an image or colour in the dict, it is white
        times the albedo. On a CRS with an ellipsoid, rows of textures must be geodetic latitudes."""
        if body is not None and (not isinstance(body, str) or not body):
            reject("body", "the body", body, "a name, or None with radii", WrongType)
        label = f"body {body!r}" if body else "body"
        if center is None and not (axes is None and _is(correction, "NONE") and _is(center_axes, "J2000")):
            reject(label, "axes, center_axes or correction", (axes, center_axes, correction), "these with center")
        made = []  # to be removed when something is rejected
        try:
            if center is not None:
                if body is None:
                    reject(label, "the center", center, "a center with the name of the body")
                frame = self._scene.add_celestial_frame(
                    settings.get("name") or body, body, axes=axes_of(body) if axes is None else axes, parent=settings.get("frame"),
                    center=center, center_axes=center_axes, correction=correction)
                made.append(frame)
                settings["frame"] = frame
            ground = None
            if terrain is not None:
                ground = self._open_ground(terrain, settings.get("name") or body or "body", settings, texture, label)
                made.append(ground)
                self._drape(ground, texture, left_edge_deg, geodetic, body, label)
            command = self._scene._command()
            message = command.create_body
            label = put_settings(self._scene, message.object, label, texture=texture, **settings)
            if ground is not None:
                if message.object.HasField("offset"):
                    reject(label, "position, quaternion or stretch", "given", "none of them with terrain: move the frame")
                message.ground = ground.object.id
            put_given(message, label, left_edge_deg=left_edge_deg, geodetic=geodetic, albedo=albedo, sun=sun,
                      eclipses=eclipses,
                      point_gain=point_gain, point_spread=point_spread)
            if body is not None:
                put(message, label, body=body)
            if radii is not None:
                given = array_of(radii, "radii", "a number, or three", label)
                if given.shape not in ((), (3,)):
                    raise InvalidArgument(f"{label}: radii have the shape {given.shape}; accepted: a number, or three [m]")
                put_vector(message.radii, np.broadcast_to(given, 3), "the radii", label)
            put_rings(message, rings, label)
            put_atmosphere(message, atmosphere, label)
            return GraphicsObject(self._scene, self._scene._execute(command).object.object)
        except Exception:
            for each in reversed(made):
                each.remove()
            raise

    def _open_ground(self, terrain, name, settings, texture, label):
        given = dict(terrain) if isinstance(terrain, dict) else {"path": file_path(terrain, "the terrain", label)}
        if "path" not in given:
            reject(label, "the terrain", terrain, "a path, or a dict that has a path")
        taken = [key for key in _OWN if key in given]
        if taken:
            reject(label, f"{taken[0]} of the terrain", given[taken[0]], "none: add_body sets it")
        given.setdefault("name", f"{name} terrain")
        given.setdefault("level_size", LEVEL_SIZE)
        if not {"image", "color", "relief"} & set(given):
            given["color"] = settings.get("color") or (1.0, 1.0, 1.0)
        return self._scene.add_terrain(given.pop("path"), frame=settings.get("frame"), on_body=True, mode="clipmap", **given)

    @staticmethod
    def _drape(ground, texture, left_edge_deg, geodetic, body, label):
        if texture is None:
            return
        equator, flattening = map(float, _AXES.search(ground.crs).groups())
        if flattening and not (geodetic or geodetic is None and str(body).lower() == "earth"):
            reject(label, "its texture", texture, "with terrain on an ellipsoid one of geodetic latitudes (geodetic=True)")
        axes = f"+a={equator!r} +rf={flattening!r}" if flattening else f"+R={equator!r}"
        left = -180.0 if left_edge_deg is None else float(left_edge_deg)
        ground.add_image(texture, name="texture", crs=f"+proj=longlat {axes} +no_defs", extent=(left, 90.0, left + 360.0, -90.0))
