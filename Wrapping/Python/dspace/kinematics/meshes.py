"""Reads the vertices of a mesh file, from which kinematics measure wheels and bounds.

Drawing reads files through the importers of the core library. This reader returns only positions.
"""
import json
import struct
from pathlib import Path

import numpy as np

from dspace.errors import InvalidArgument

_COMPONENTS = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}


def vertices(path):
    """All vertex positions (n, 3) of a .gltf, .glb or .obj file, in the file's coordinates (glTF:
    node transforms applied). Raises ValueError for other types and for compressed or damaged
    files, FileNotFoundError when the file or its buffer is absent."""
    path = Path(path)
    suffix = path.suffix.lower()
    try:
        if suffix in (".gltf", ".glb"):
            return _gltf(path)
        if suffix == ".obj":
            rows = [line.split()[1:4] for line in path.read_text(errors="replace").splitlines()
                    if line.startswith("v ")]
            return np.array(rows, float).reshape(-1, 3)
    except (KeyError, IndexError, TypeError, struct.error, UnicodeDecodeError) as e:
        raise InvalidArgument(f"{path}: damaged mesh file ({e!r})") from e
    raise InvalidArgument(f"{path}: positions are read from .gltf, .glb and .obj only; pass the bounds")


def _gltf(path):
    data = path.read_bytes()
    blob = None
    if data[:4] == b"glTF":
        size = struct.unpack_from("<I", data, 12)[0]
        document = json.loads(data[20:20 + size])
        blob = data[28 + size:]
    else:
        document = json.loads(data)
    buffers = {}

    def buffer(index):
        if index not in buffers:
            uri = document["buffers"][index].get("uri")
            buffers[index] = blob if uri is None else (path.parent / uri).read_bytes()
        return buffers[index]

    def positions(index):
        accessor = document["accessors"][index]
        view = document["bufferViews"][accessor["bufferView"]]
        kind = np.dtype(_COMPONENTS[accessor["componentType"]])
        step = view.get("byteStride", 3 * kind.itemsize)
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        return np.ndarray((accessor["count"], 3), kind, buffer(view["buffer"]), start,
                          (step, kind.itemsize)).astype(float)

    out = []

    def visit(index, above, depth):
        if depth > 100:
            raise InvalidArgument(f"{path}: nodes are nested more than 100 deep")
        node = document["nodes"][index]
        m = above @ _node_matrix(node)
        if "mesh" in node:
            for primitive in document["meshes"][node["mesh"]]["primitives"]:
                p = positions(primitive["attributes"]["POSITION"])
                out.append(p @ m[:3, :3].T + m[:3, 3])
        for child in node.get("children", []):
            visit(child, m, depth + 1)

    scene = document["scenes"][document.get("scene", 0)]
    for root in scene.get("nodes", []):
        visit(root, np.eye(4), 0)
    return np.vstack(out) if out else np.zeros((0, 3))


def _node_matrix(node):
    if "matrix" in node:
        return np.array(node["matrix"], float).reshape(4, 4).T
    m = np.eye(4)
    x, y, z, w = node.get("rotation", (0, 0, 0, 1))
    m[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                 [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                 [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    m[:3, :3] *= node.get("scale", (1, 1, 1))
    m[:3, 3] = node.get("translation", (0, 0, 0))
    return m
