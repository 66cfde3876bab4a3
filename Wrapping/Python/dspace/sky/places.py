"""What frames of a scene stand for."""
from dspace._core.fields import flag, numbers, put, reject, text
from dspace.errors import WrongType


def axes_of(body):
    """The reference frame that turns with a body, by the body's name."""
    return {"moon": "MOON_ME", "earth": "ITRF93"}.get(body.lower(), f"IAU_{body.upper()}")


def put_place(message, body, axes, site, geodetic, about):
    """Writes a body (a name or NAIF id), a reference frame (or None) and a site (longitude, latitude[, height]; or
    None) into a CelestialPlace."""
    if isinstance(body, int) and not isinstance(body, bool):
        body = str(body)
    message.body = text(body, "the body", about, "a name or NAIF id")
    if axes is not None:
        message.axes = text(axes, "the reference frame", about, "a name such as 'MOON_ME'")
    flag(geodetic, "geodetic", about)
    if site is None:
        if geodetic:
            reject(about, "geodetic", geodetic, "it only with a site")
        return
    try:
        count = len(site)
    except TypeError:
        reject(about, "the site", site, "longitude, latitude [deg] and, if not 0, height [m]", WrongType)
    values = numbers(site, 2 if count == 2 else 3, "the site", about, "longitude, latitude [deg] and, if not 0, height [m]")
    put(message.site, about, longitude_deg=values[0], latitude_deg=values[1], height=values[2] if count == 3 else 0.0,
        geodetic=geodetic)
