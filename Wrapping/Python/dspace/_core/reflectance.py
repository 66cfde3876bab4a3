"""How surfaces reflect light: photometric models."""
from dspace._core.fields import keywords, put_given, reject, word

MODELS = {"metallic-roughness": 0, "lambert": 1, "lommel-seeliger": 2, "lunar-lambert": 3, "hapke": 4}
HAPKE = ("single_scattering_albedo", "phase_asymmetry", "phase_partition", "opposition_amplitude", "opposition_width",
         "roughness_deg")
PARAMETERS = {"lunar-lambert": ("lunar_weight",), "hapke": HAPKE}


def put_reflectance(message, value, about=None):
    """Writes a model's name, or a dict of it and its parameters, into a Reflectance message."""
    what = "the reflectance"
    if isinstance(value, str):
        value = {"model": value}
    if not isinstance(value, dict) or "model" not in value:
        reject(about, what, value, "a model's name, or a dict with 'model' and its parameters")
    parameters = {k: v for k, v in value.items() if k != "model"}
    model = word(value["model"], MODELS, "the model of the reflectance", about)
    name = next(name for name, number in MODELS.items() if number == model)
    keywords(parameters, PARAMETERS.get(name, ()), about)
    message.Clear()
    message.SetInParent()
    message.model = model
    put_given(message, about, **parameters)


def reflectance_of(message):
    """A dict as put_reflectance accepts it."""
    found = {"model": list(MODELS)[message.model]}
    for key in ("lunar_weight",) + HAPKE:
        if message.HasField(key):
            found[key] = getattr(message, key)
    return found
