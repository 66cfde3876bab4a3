"""Shader code of objects: replacements at the tags of VTK's shaders, and uniforms."""
import numpy as np

from dspace._core.fields import flag, items, keywords, reject, text
from dspace._core.wire import decode
from dspace.errors import Unsupported, WrongType
from dspace.proto import objects_pb2

STAGES = {"vertex": objects_pb2.SetShader.Replacement.VERTEX, "fragment": objects_pb2.SetShader.Replacement.FRAGMENT}
KEYS = (*STAGES, "uniforms")
REPLACEMENT = ("tag", "code", "after", "first_only")

_Uniform = objects_pb2.SetShader.Uniform
_VECTORS = {2: _Uniform.VECTOR2, 3: _Uniform.VECTOR3, 4: _Uniform.VECTOR4}
_MATRICES = {(3, 3): _Uniform.MATRIX3, (4, 4): _Uniform.MATRIX4}
_SHAPES = {_Uniform.FLOAT: (), _Uniform.INTEGER: (), _Uniform.VECTOR2: (2,), _Uniform.VECTOR3: (3,),
           _Uniform.VECTOR4: (4,), _Uniform.MATRIX3: (3, 3), _Uniform.MATRIX4: (4, 4)}


def put_shader(message, shader, about, vtk=None):
    """Writes a shader into a SetShader message: None, a dict as in GraphicsObject.shader, or a vtkShaderProperty, which
    `vtk`, a function that returns the vtkDspaceSession, converts."""
    if shader is None:
        return
    if hasattr(shader, "GetNthShaderReplacementTypeAsString"):
        _put_property(message, shader, about, vtk)
        return
    if not isinstance(shader, dict):
        reject(about, "the shader", shader, "None, a vtkShaderProperty, or a dict with 'vertex', 'fragment', 'uniforms'",
               WrongType)
    keywords(shader, KEYS, about)
    for stage, number in STAGES.items():
        for replacement in _replacements(shader.get(stage) or {}, stage, about):
            _put_replacement(message.replacement.add(), number, replacement, about)
    uniforms = shader.get("uniforms") or {}
    if not isinstance(uniforms, dict):
        reject(about, "the uniforms", uniforms, "a dict of values by their names", WrongType)
    for name, value in uniforms.items():
        put_uniform(message.uniform.add(), name, value, about)


def _put_property(message, shader, about, vtk):
    session = vtk()
    problem = session.CheckShader(shader)
    if problem:
        raise Unsupported(f"{about() if callable(about) else about}: {problem}")
    data = session.SerializeShader(shader)
    if isinstance(data, str):  # VTK decodes bytes that are UTF-8
        data = data.encode()
    message.MergeFrom(decode(objects_pb2.SetShader, data, "shader"))


def _replacements(given, stage, about):
    if isinstance(given, dict):
        return [{"tag": tag, "code": code} for tag, code in given.items()]
    given = items(given, f"the {stage} replacements", about, "a dict of code by tag, or a list of dicts")
    for each in given:
        if not isinstance(each, dict) or "tag" not in each or "code" not in each:
            reject(about, f"a {stage} replacement", each, f"a dict of {', '.join(REPLACEMENT)}", WrongType)
        keywords(each, REPLACEMENT, about)
    return given


def _put_replacement(message, stage, values, about):
    message.stage = stage
    message.original = text(values["tag"], "a tag", about)
    message.replacement = text(values["code"], "the code", about)
    message.after = flag(values.get("after", False), "after", about)
    message.first_only = flag(values.get("first_only", False), "first_only", about)


def put_uniform(message, name, value, about):
    """Writes a uniform: an int, a float, 2 to 4 numbers (a vector), a 3 x 3 or 4 x 4 matrix, or more of them in an array
    with one dimension more."""
    message.name = text(name, "a uniform's name", about)
    accepted = "an int, a float, 2 to 4 numbers, a 3 x 3 or 4 x 4 matrix, or an array of one of them"
    try:
        array = np.asarray(value)
    except ValueError:  # rows of unequal lengths
        array = np.asarray(None)
    if array.dtype.kind not in "buif" or not array.size:
        reject(about, f"the uniform {name!r}", value, accepted, WrongType)
    if array.ndim == 0:
        message.type = _Uniform.FLOAT if array.dtype.kind == "f" else _Uniform.INTEGER
    elif array.shape in _MATRICES or array.shape[1:] in _MATRICES:
        message.type = _MATRICES[array.shape[-2:]]
        message.count = array.shape[0] if array.ndim == 3 else 0
        array = array.swapaxes(-1, -2)  # column by column
    elif array.shape[-1] in _VECTORS and array.ndim <= 2:
        message.type = _VECTORS[array.shape[-1]]
        message.count = array.shape[0] if array.ndim == 2 else 0
    elif array.ndim == 1:
        message.type = _Uniform.FLOAT if array.dtype.kind == "f" else _Uniform.INTEGER
        message.count = array.shape[0]
    else:
        reject(about, f"the uniform {name!r}, of shape {array.shape},", value, accepted)
    message.value.extend(array.astype(float).ravel().tolist())


def read_shader(message):
    """The dict of a SetShader message: replacements as lists of dicts, uniforms by name."""
    stages = {number: [] for number in STAGES.values()}
    for each in message.replacement:
        stages[each.stage].append({"tag": each.original, "code": each.replacement, "after": each.after,
                                   "first_only": each.first_only})
    shader = {stage: stages[number] for stage, number in STAGES.items()}
    shader["uniforms"] = {each.name: _value_of(each) for each in message.uniform}
    return shader


def _value_of(uniform):
    values = np.array(uniform.value)
    shape = _SHAPES[uniform.type]
    if uniform.type == _Uniform.INTEGER:
        values = values.astype(int)
    values = values.reshape(((uniform.count,) if uniform.count > 1 else ()) + shape)
    values = values.swapaxes(-1, -2) if len(shape) == 2 else values
    return values.item() if values.ndim == 0 else values
