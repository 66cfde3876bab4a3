"""Rings and atmospheres of bodies as messages."""
from dspace._core.fields import keywords, numbers, put, put_color, put_vector, reject
from dspace.errors import WrongType

_TRIPLES = ("rayleigh", "mie", "mie_extinction")
_NUMBERS = ("top", "rayleigh_height", "mie_height", "mie_asymmetry")


def put_rings(message, rings, about):
    """Writes rings, each (inner, outer, optical depth[, colour]), into a CreateBody message. None: those of the table."""
    if rings is None:
        return
    if not isinstance(rings, (list, tuple)):
        reject(about, "rings", rings, "a list of (inner, outer, optical depth[, colour])", WrongType)
    if not rings:
        message.plain = True
    for ring in rings:
        if not isinstance(ring, (list, tuple)) or len(ring) not in (3, 4):
            reject(about, "a ring", ring, "(inner, outer, optical depth[, colour])", WrongType)
        inner, outer, depth = numbers(ring[:3], 3, "a ring", about)
        made = message.ring.add()
        put(made, about, inner=inner, outer=outer, optical_depth=depth)
        if len(ring) == 4:
            put_color(made.color, ring[3], "the colour of a ring", about)


def put_atmosphere(message, atmosphere, about):
    """Writes an atmosphere into a CreateBody message. None: that of the table; False: none."""
    if atmosphere is None:
        return
    if atmosphere is False:
        message.plain = True
        return
    if not isinstance(atmosphere, dict):
        reject(about, "atmosphere", atmosphere, f"a dict of {', '.join(_NUMBERS + _TRIPLES)}, or False", WrongType)
    keywords(atmosphere, _NUMBERS + _TRIPLES, f"{about}, its atmosphere")
    made = message.atmosphere
    made.SetInParent()
    for key, value in atmosphere.items():
        if key in _TRIPLES:
            put_vector(getattr(made, key), (value,) * 3 if isinstance(value, (int, float)) else value, key, about)
        else:
            put(made, about, **{key: value})
