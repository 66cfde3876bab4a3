"""Closed solids from numpy, and their glTF 2.0 files: what make_rover.py builds its parts with.

A solid is (V, T): vertices (n, 3) in metres and triangles (m, 3), wound outwards, closed (every
edge is run once each way). `Part` gathers solids by material; `write_gltf` shades and writes it.
"""
import json
import struct
import zlib

import numpy as np


# --- solids -------------------------------------------------------------------------------------

def merge(*solids):
    """Several solids as one list of vertices and triangles (they stay separate components)."""
    vertices, triangles, n = [], [], 0
    for v, t in solids:
        vertices.append(np.asarray(v, float))
        triangles.append(np.asarray(t, int) + n)
        n += len(v)
    return np.vstack(vertices), np.vstack(triangles)


def moved(solid, xyz=(0, 0, 0), rotation=None):
    """`solid` turned by the 3 × 3 `rotation`, then moved by `xyz`."""
    v, t = solid
    r = np.eye(3) if rotation is None else np.asarray(rotation)
    return v @ r.T + np.asarray(xyz, float), t


def mirrored_y(solid):
    """`solid` mirrored in the XZ plane, still wound outwards."""
    v, t = solid
    return v * [1, -1, 1], t[:, ::-1]


def turn(axis, angle_deg):
    """Rotation matrix about 'x', 'y' or 'z'."""
    c, s = np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))
    i, j = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]
    r = np.eye(3)
    r[i, i] = r[j, j] = c
    r[i, j], r[j, i] = -s, s
    return r


def loft(rings):
    """Closed solid through rings of equally many points; each ring runs counter-clockwise seen from
    the last ring's side. The two ends are closed by fans, so end rings are convex."""
    rings = [np.asarray(r, float) for r in rings]
    n = len(rings[0])
    v = np.vstack(rings)
    t = []
    for k in range(len(rings) - 1):
        for i in range(n):
            a, b = k * n + i, k * n + (i + 1) % n
            t += [(a, b, b + n), (a, b + n, a + n)]
    last = (len(rings) - 1) * n
    for i in range(1, n - 1):
        t += [(0, i + 1, i), (last, last + i, last + i + 1)]
    return v, np.array(t)


def prism(outline, z0, z1, bevel=0.0):
    """Convex outline (x, y), counter-clockwise, between two heights; edges bevelled at both ends."""
    p = np.asarray(outline, float)
    centre = p.mean(0)
    if bevel:
        size = np.linalg.norm(p - centre, axis=1, keepdims=True)
        inner = centre + (p - centre) * (1 - bevel * 1.2 / size)
        levels = [(inner, z0), (p, z0 + bevel), (p, z1 - bevel), (inner, z1)]
    else:
        levels = [(p, z0), (p, z1)]
    return loft([np.column_stack([q, np.full(len(q), z)]) for q, z in levels])


def box(size, centre=(0, 0, 0), bevel=0.0):
    """Box of edges `size`, all twelve edges and eight corners chamfered by `bevel`."""
    h = np.asarray(size, float) / 2
    if not bevel:
        x, y, z = h
        return moved(prism([(-x, -y), (x, -y), (x, y), (-x, y)], -z, z), centre)
    b = min(bevel, 0.45 * h.min() * 2)
    x, y = h[:2]

    def ring(inset):
        c = b + inset
        return [(-x + c, -y + inset), (x - c, -y + inset), (x - inset, -y + c), (x - inset, y - c),
                (x - c, y - inset), (-x + c, y - inset), (-x + inset, y - c), (-x + inset, -y + c)]

    levels = [(ring(b), -h[2]), (ring(0), -h[2] + b), (ring(0), h[2] - b),
              (ring(b), h[2])]
    return moved(loft([[(*p, z) for p in r] for r, z in levels]), centre)


def revolve(profile, n=32, axis="z", closed=False):
    """Solid of revolution. `profile` lists (radius, height), with the solid on the left of its
    direction of travel; open profiles start and end on the axis (radius 0), closed ones are
    rings. Axis 'z', 'y' or 'x'."""
    p = np.asarray(profile, float)
    a = 2 * np.pi * np.arange(n) / n
    v, index = [], []
    for r, z in p:
        if r < 1e-9:
            index.append([len(v)] * n)
            v.append((0, 0, z))
        else:
            index.append(list(range(len(v), len(v) + n)))
            v += [(r * np.cos(s), r * np.sin(s), z) for s in a]
    t = []
    m = len(p)
    for k in range(m if closed else m - 1):
        lower, upper = index[k], index[(k + 1) % m]
        for i in range(n):
            j = (i + 1) % n
            if lower[i] != lower[j]:
                t.append((lower[i], lower[j], upper[j]))
            if upper[i] != upper[j]:
                t.append((lower[i], upper[j], upper[i]))
    v = np.array(v)
    order = {"z": [0, 1, 2], "y": [1, 2, 0], "x": [2, 0, 1]}[axis]  # even permutations
    return v[:, order], np.array(t)


def cylinder(radius, length, n=24, axis="z", centre=(0, 0, 0), bevel=0.0):
    """Cylinder along an axis about `centre`, end edges bevelled."""
    h, b = length / 2, bevel
    if b:
        profile = [(0, -h), (radius - b, -h), (radius, -h + b), (radius, h - b), (radius - b, h), (0, h)]
    else:
        profile = [(0, -h), (radius, -h), (radius, h), (0, h)]
    return moved(revolve(profile, n, axis), centre)


def rounded_path(points, radius, steps=5):
    """Polyline with each inner corner replaced by an arc-like curve starting `radius` before it."""
    p = np.asarray(points, float)
    out = [p[0]]
    for a, b, c in zip(p[:-2], p[1:-1], p[2:]):
        u = a + (b - a) * max(0.5, 1 - radius / np.linalg.norm(b - a))
        w = c + (b - c) * max(0.5, 1 - radius / np.linalg.norm(b - c))
        for s in np.linspace(0, 1, steps + 1):
            out.append((1 - s) ** 2 * u + 2 * s * (1 - s) * b + s * s * w)
    out.append(p[-1])
    return np.array(out)


def sweep(path, section):
    """Convex section (k, 2), counter-clockwise, or one a path point, swept along a polyline without
    twist. The section's first axis starts horizontal where the path is not vertical."""
    p = np.asarray(path, float)
    tangent = np.gradient(p, axis=0)
    tangent /= np.linalg.norm(tangent, axis=1, keepdims=True)
    up = np.array([0, 0, 1.0]) if abs(tangent[0, 2]) < 0.95 else np.array([1.0, 0, 0])
    first = np.cross(up, tangent[0])
    rings = []
    for i, t in enumerate(tangent):
        first = first - t * (first @ t)
        first /= np.linalg.norm(first)
        second = np.cross(t, first)
        s = np.asarray(section[i] if np.ndim(section) == 3 else section, float)
        rings.append(p[i] + s[:, :1] * first + s[:, 1:] * second)
    return loft(rings)


def tube(path, radius, n=14):
    """Round tube along a polyline; `radius` one number or one a point."""
    a = 2 * np.pi * np.arange(n) / n
    circle = np.column_stack([np.cos(a), np.sin(a)])
    r = np.broadcast_to(radius, (len(path),))
    return sweep(path, np.array([circle * q for q in r]))


# --- shading and files --------------------------------------------------------------------------

def shade(solid, crease_deg=35.0):
    """Corner normals, smooth across edges flatter than the crease angle, and the split vertices:
    (positions, normals, triangles). Areas weigh the faces."""
    v, t = solid
    key = np.round(v, 7)
    _, weld = np.unique(key, axis=0, return_inverse=True)
    w = weld.ravel()[t]
    area = np.cross(v[t[:, 1]] - v[t[:, 0]], v[t[:, 2]] - v[t[:, 0]])
    length = np.linalg.norm(area, axis=1)
    keep = length > 1e-14
    t, w, area, length = t[keep], w[keep], area[keep], length[keep]
    unit = area / length[:, None]
    faces = {}
    for f, corners in enumerate(w):
        for c in corners:
            faces.setdefault(c, []).append(f)
    limit = np.cos(np.radians(crease_deg))
    table, positions, normals, out = {}, [], [], []
    for f, corners in enumerate(w):
        row = []
        for k, c in enumerate(corners):
            near = np.array(faces[c])
            near = near[unit[near] @ unit[f] >= limit]
            n = area[near].sum(0)
            n /= np.linalg.norm(n)
            name = (c, *np.round(n, 4))
            if name not in table:
                table[name] = len(positions)
                positions.append(v[t[f, k]])
                normals.append(n)
            row.append(table[name])
        out.append(row)
    return np.array(positions), np.array(normals), np.array(out)


class Part:
    """One mesh file in the making: solids by material, and textured faces."""

    def __init__(self, name):
        self.name = name
        self.groups = {}
        self.textured = []

    def add(self, material, *solids, crease_deg=35.0):
        self.groups.setdefault(material, []).append((merge(*solids), crease_deg))
        return self

    def add_textured(self, material, solid, mapping):
        """A solid whose texture coordinates are mapping(positions, normals) -> (n, 2), glTF's v
        running down."""
        self.textured.append((material, solid, mapping))
        return self

    def mirrored(self, name):
        """The part in the XZ mirror (textured solids have no mirror)."""
        p = Part(name)
        for material, items in self.groups.items():
            p.groups[material] = [(mirrored_y(s), c) for s, c in items]
        return p

    def primitives(self):
        """(material, positions, normals, texture coordinates or None, triangles), one a material."""
        result = []
        for material, items in self.groups.items():
            p, n, t, count = [], [], [], 0
            for solid, crease in items:
                a, b, c = shade(solid, crease)
                p.append(a), n.append(b), t.append(c + count)
                count += len(a)
            result.append((material, np.vstack(p), np.vstack(n), None, np.vstack(t)))
        for material in dict.fromkeys(item[0] for item in self.textured):
            p, n, uv, t, count = [], [], [], [], 0
            for _, solid, mapping in [item for item in self.textured if item[0] == material]:
                a, b, c = shade(solid)
                p.append(a), n.append(b), uv.append(mapping(a, b)), t.append(c + count)
                count += len(a)
            result.append((material, np.vstack(p), np.vstack(n), np.vstack(uv), np.vstack(t)))
        return result


def write_gltf(part, path, materials, image=None):
    """Writes `part` to .glb, or to .gltf with a .bin beside it. `materials` maps names to glTF
    material objects; one with a baseColorTexture names `image`, a PNG beside the file.
    Coordinates are written as they are: the link's own axes, Z up."""
    blob, views, accessors, primitives, used = b"", [], [], [], []

    def store(array, target, kind, component):
        nonlocal blob
        raw = array.tobytes()
        views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": len(raw), "target": target})
        blob += raw + b"\0" * (-len(raw) % 4)
        accessors.append({"bufferView": len(views) - 1, "componentType": component,
                          "count": len(array), "type": kind})
        return len(accessors) - 1

    for material, p, n, uv, t in part.primitives():
        p = p.astype("<f4")
        attributes = {"POSITION": store(p, 34962, "VEC3", 5126)}
        accessors[-1].update(min=p.min(0).tolist(), max=p.max(0).tolist())
        n = n.astype("<f4")
        attributes["NORMAL"] = store(n, 34962, "VEC3", 5126)
        if uv is not None:
            attributes["TEXCOORD_0"] = store(uv.astype("<f4"), 34962, "VEC2", 5126)
        if len(p) > 65535:
            raise ValueError(f"{part.name}: {len(p)} vertices do not fit 16-bit indices")
        indices = store(t.astype("<u2").ravel(), 34963, "SCALAR", 5123)
        if material not in used:
            used.append(material)
        primitives.append({"attributes": attributes, "indices": indices,
                           "material": used.index(material)})
    doc = {"asset": {"version": "2.0", "generator": "Dspace make_rover.py"}, "scene": 0,
           "scenes": [{"nodes": [0]}], "nodes": [{"name": part.name, "mesh": 0}],
           "meshes": [{"name": part.name, "primitives": primitives}],
           "materials": [dict(materials[m], name=m) for m in used],
           "accessors": accessors, "bufferViews": views, "buffers": [{"byteLength": len(blob)}]}
    if any("baseColorTexture" in m.get("pbrMetallicRoughness", {}) for m in doc["materials"]):
        doc["images"] = [{"uri": image}]
        doc["samplers"] = [{"magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 10497}]
        doc["textures"] = [{"source": 0, "sampler": 0}]
    if path.suffix == ".gltf":
        doc["buffers"][0]["uri"] = path.with_suffix(".bin").name
        path.with_suffix(".bin").write_bytes(blob)
        path.write_text(json.dumps(doc, indent=1) + "\n")
        return
    text = json.dumps(doc, separators=(",", ":")).encode()
    text += b" " * (-len(text) % 4)
    size = 12 + 8 + len(text) + 8 + len(blob)
    path.write_bytes(struct.pack("<4sII", b"glTF", 2, size) + struct.pack("<I4s", len(text), b"JSON")
                     + text + struct.pack("<I4s", len(blob), b"BIN\0") + blob)


def write_png(path, pixels):
    """8-bit RGB image (rows, columns, 3) as PNG."""
    rows, columns, _ = pixels.shape
    raw = b"".join(b"\0" + pixels[r].astype(np.uint8).tobytes() for r in range(rows))

    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data
                + struct.pack(">I", zlib.crc32(kind + data)))

    path.write_bytes(b"\x89PNG\r\n\x1a\n"
                     + chunk(b"IHDR", struct.pack(">IIBBBBB", columns, rows, 8, 2, 0, 0, 0))
                     + chunk(b"IDAT", zlib.compress(raw, 9)) + chunk(b"IEND", b""))
