"""The Sun of a scene."""
import numpy as np

from dspace._core.fields import keywords, numbers, put, put_given, put_vector, reject
from dspace._core.strict import Strict
from dspace.errors import InvalidArgument, WrongType
from dspace.sky.sky import follow_sun, stop_sun
from dspace.terrain.terrain import Terrain

SUN = ("direction", "frame", "azimuth_deg", "elevation_deg", "terrain", "at", "radius_deg", "irradiance",
       "distance_au")


class Sun(Strict):
    """The one Sun of a scene, which its light "sun" shows: its properties are read and set, and set() changes several at
    once. A new scene has it at azimuth 315, elevation 45 degrees of the root (X east, Y north, Z up), 1 au away."""

    def __init__(self, scene):
        self._scene = scene

    def set(self, **values):
        """Changes the Sun in one command; what is not given keeps its value. A scene without a Sun gets one.

        Direction: either `direction`, the vector towards the Sun, of any length, in `frame` (a frame or a path; default:
        the root); or azimuth_deg, clockwise from north, and elevation_deg, -90 to 90 (below the horizon it is night), on
        a terrain (`terrain`: a Terrain or its name; `at`: map x, y; default: its middle), or without one in the axes X
        east, Y north, Z up of `frame`. The Sun then keeps its direction in the terrain's frame, or in `frame`.

        Disc: radius_deg, its angular radius, 0 (a point) to 90; 0.2666 in a new scene.

        Brightness: irradiance [W/m^2] on a surface that faces it, 0 to 1.361e15; or distance_au, above 0: the irradiance
        is 1361 / distance_au**2. Either makes the light white."""
        command = self._scene._command()
        self._fill(command.set_sun.sun, values)
        self._scene._execute(command)

    def _fill(self, message, values):
        """Fills a SunState from the arguments of set()."""
        keywords(values, SUN, "light 'sun'")
        values = {key: value for key, value in values.items() if value is not None}
        message.SetInParent()
        angles = [key for key in ("azimuth_deg", "elevation_deg") if key in values]
        if len(angles) == 1:
            raise InvalidArgument(f"light 'sun': {angles[0]} is given alone; accepted: azimuth_deg and elevation_deg",
                                  "light 'sun'")
        if angles and "direction" in values:
            raise InvalidArgument("light 'sun': direction and azimuth_deg are given; accepted: one of them",
                                  "light 'sun'")
        if not angles and ("terrain" in values or "at" in values):
            raise InvalidArgument("light 'sun': a place is given without angles; accepted: terrain and at with "
                                  "azimuth_deg and elevation_deg", "light 'sun'")
        if "frame" in values:
            message.frame = self._scene._frame_id(values["frame"])
        if "direction" in values:
            put_vector(message.direction, values["direction"], "the direction", "light 'sun'")
        if angles:
            put(message.horizontal, "light 'sun'", azimuth_deg=values["azimuth_deg"],
                elevation_deg=values["elevation_deg"])
            self._put_place(message.horizontal, values.get("terrain"), values.get("at"))
        put_given(message, "light 'sun'", radius_deg=values.get("radius_deg"), irradiance=values.get("irradiance"),
                  distance_au=values.get("distance_au"))

    def follow(self, frame=None, body=None, axes=None, site=None, geodetic=False):
        """Lets it follow the scene's time: direction, disc and irradiance (1361 W/m^2 at 1 au) as the Sun shines on a
        place, at once and whenever the time is set. Light time and stellar aberration are applied.

        frame: in which it keeps its direction (default: the root). The place is what the frame stands for
        (Scene.add_celestial_frame), or `body` (a name or NAIF id) with the reference frame `axes` (default J2000) or
        with a `site` = longitude, latitude [deg], height [m], whose axes are X east, Y north, Z up.

        Rejected in a scene with a body that is the Sun (Scene.add_body): that gives direction, disc and irradiance
        itself, and the distance would count twice.

            scene.sun.follow(body="moon", site=(29.1957, -84.7906))"""
        follow_sun(self._scene, frame, body, axes, site, geodetic)

    def stop(self):
        """Ends follow(): the Sun stays where it is, and may be set again."""
        stop_sun(self._scene)

    def _put_place(self, message, terrain, at):
        """Writes the place on a terrain into a message."""
        if isinstance(terrain, Terrain):
            self._scene._require_own(terrain, "terrain", "light 'sun'")
            terrain = terrain.name
        elif terrain is not None and not isinstance(terrain, str):
            reject("light 'sun'", "terrain", terrain, "a dspace.Terrain or its name", WrongType)
        put_given(message, "light 'sun'", terrain=terrain)
        if at is not None:
            message.map_x, message.map_y = numbers(at, 2, "at", "light 'sun'", "map x, y")

    def _info(self, terrain=None, at=None):
        command = self._scene._command()
        command.get_sun.SetInParent()
        self._put_place(command.get_sun, terrain, at)
        return self._scene._execute(command).sun

    @property
    def direction(self):
        """Towards the Sun in the root, unit; may be set, to a vector in the root of any length."""
        v = self._info().direction
        return np.array([v.x, v.y, v.z])

    @direction.setter
    def direction(self, direction):
        self.set(direction=direction)

    def angles(self, terrain=None, at=None):
        """(azimuth_deg, elevation_deg) of the Sun's centre on a terrain, at map x, y (default: its middle); without a
        terrain in the root's axes X east, Y north, Z up. Azimuth 0 to 360, clockwise from north."""
        info = self._info(terrain, at)
        return info.azimuth_deg, info.elevation_deg

    @property
    def radius_deg(self):
        """Angular radius of its disc, 0 (a point) to 90."""
        return self._info().radius_deg

    @radius_deg.setter
    def radius_deg(self, radius_deg):
        self.set(radius_deg=radius_deg)

    @property
    def irradiance(self):
        """[W/m^2] on a surface that faces it; may be set, which makes its light white."""
        return self._info().irradiance

    @irradiance.setter
    def irradiance(self, irradiance):
        self.set(irradiance=irradiance)

    @property
    def distance_au(self):
        """The distance that the irradiance belongs to: the square root of 1361 / irradiance; may be set."""
        return self._info().distance_au

    @distance_au.setter
    def distance_au(self, distance_au):
        self.set(distance_au=distance_au)

    def __repr__(self):
        try:
            azimuth, elevation = self.angles()
            return (f"<dspace.Sun, azimuth {azimuth:.6g}, elevation {elevation:.6g} deg in the root, "
                    f"{self.irradiance:.6g} W/m^2>")
        except Exception:  # a repr never raises
            return "<dspace.Sun, none>"
