"""Dim extended lights beside the Sun: planets, and the sky of an atmosphere."""
import math

from dspace._core.fields import number, numbers, reject, text
from dspace.errors import WrongType

# Mean radius [km] and visual geometric albedo: D. R. Williams, NASA Planetary Fact Sheets, NSSDCA.
BODIES = {"earth": (6371.0, 0.434), "moon": (1737.4, 0.12), "mercury": (2439.7, 0.142), "venus": (6051.8, 0.689),
          "mars": (3389.5, 0.170), "jupiter": (69911.0, 0.538), "saturn": (58232.0, 0.499), "uranus": (25362.0, 0.488),
          "neptune": (24622.0, 0.442)}
SOLAR_CONSTANT = 1361.0  # [W/m^2] at 1 au


def lambert_phase(phase_deg):
    """Brightness of a Lambertian sphere at a phase angle [deg] (Sun, sphere, observer), against that of the full one:
    (sin a + (pi - a) cos a) / pi (J. H. Lambert, Photometria, 1760)."""
    a = math.radians(phase_deg)
    return (math.sin(a) + (math.pi - a) * math.cos(a)) / math.pi


def planetshine(about, body=None, distance=None, phase_deg=0.0, radius=None, albedo=None, irradiance=None):
    """Irradiance [W/m^2] by a planet on a surface that faces it, and the angular radius of its disc [deg]."""
    if body is not None:
        if not isinstance(body, str):
            reject(about, "the body", body, "a name", WrongType)
        if body.lower() not in BODIES:
            reject(about, "the body", body, f"{', '.join(sorted(BODIES))}; others by radius= and albedo=")
        kilometres, own = BODIES[body.lower()]
        radius = 1e3 * kilometres if radius is None else radius
        albedo = own if albedo is None else albedo
    values = {}
    for name, value, low, high, accepted in (
            ("radius", radius, 1.0, 1e15, "metres, or a body"), ("distance", distance, 1.0, 1e18, "metres"),
            ("albedo", albedo, 0.0, 2.0, "geometric, 0 to 2, or a body"),
            ("phase_deg", phase_deg, 0.0, 180.0, "0 (full) to 180 (new)"),
            ("irradiance", SOLAR_CONSTANT if irradiance is None else irradiance, 0.0, 1.361e15, "W/m^2 by the Sun there")):
        if value is None:
            reject(about, f"the {name}", "not given", accepted)
        values[name] = number(value, f"the {name}", about)
        if not low <= values[name] <= high:
            reject(about, f"the {name}", value, accepted)
    if values["distance"] <= values["radius"]:
        reject(about, "the distance", distance, f"more than the radius, {values['radius']:g} m")
    ratio = values["radius"] / values["distance"]
    return (values["irradiance"] * values["albedo"] * ratio ** 2 * lambert_phase(values["phase_deg"]),
            math.degrees(math.asin(ratio)))


class Shine:
    """Makes the lights, for Scene."""

    def __init__(self, scene):
        self._scene = scene

    def add_sky(self, irradiance, up=(0.0, 0.0, 1.0), frame=None, color=(1.0, 1.0, 1.0), name="sky"):
        """Adds the light of a sky of even brightness, as of an atmosphere, and returns the Light.

        irradiance: diffuse [W/m^2] on level ground, 0 to 1.361e15. A surface whose normal is at an angle a from `up`, in
        `frame`, sees the part (1 + cos a) / 2 of it. What stands around hides none of it, and it throws no shadow. color:
        sRGB. The Sun's own irradiance stays: dim it by what the atmosphere takes (scene.sun.irradiance)."""
        name = text(name, "the name", "new light")
        about = f"light {name!r}"
        value = number(irradiance, "the irradiance", about)
        if not 0.0 <= value <= 1.361e15:
            reject(about, "the irradiance", irradiance, "0 to 1.361e15 W/m^2")
        direction = tuple(-each for each in numbers(up, 3, "up", about))
        return self._scene.add_light(name, direction=direction, frame=frame, color=color, radius_deg=90.0,
                                     intensity=value / SOLAR_CONSTANT)

    def add_planetshine(self, direction, body=None, distance=None, phase_deg=0.0, radius=None, albedo=None,
                        irradiance=None, frame=None, color=(1.0, 1.0, 1.0), name=None):
        """Adds light that a planet reflects, from its disc, and returns the Light. It throws no shadow.

        direction: towards the planet, in `frame`. body: "earth", "moon", "mars", ..., or radius [m] and geometric albedo.
        distance [m] of its centre. phase_deg: 0 to 180, the angle Sun - planet - observer; 0 is the full planet.
        irradiance [W/m^2] by the Sun at the planet: 1361 by default. The planet shines as a Lambertian sphere:
        irradiance * albedo * (radius / distance)**2 * (sin a + (pi - a) cos a) / pi. color: sRGB. The albedos of bodies
        are visual: the irradiance is that of the visible band, stated as if the planet had the Sun's spectrum.

            scene.add_planetshine(direction=(0.3, 0, 0.9), body="earth", distance=384.4e6, phase_deg=40)"""
        if name is None:
            name = f"{body}shine" if isinstance(body, str) else "planetshine"
        name = text(name, "the name", "new light")
        about = f"light {name!r}"
        value, radius_deg = planetshine(about, body, distance, phase_deg, radius, albedo, irradiance)
        away = tuple(-each for each in numbers(direction, 3, "the direction", about))
        return self._scene.add_light(name, direction=away, frame=frame, color=color, radius_deg=radius_deg,
                                     intensity=value / SOLAR_CONSTANT)
