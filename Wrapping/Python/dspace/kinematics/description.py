"""A vehicle's tree of links and joints, read from a URDF or from a frames.json (see frames_file)."""
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from dspace.errors import InvalidArgument
from . import meshes
from .frames_file import read_frames_file
from .rotations import from_rpy


@dataclass
class Joint:
    """A joint and its child link. Lengths in metres, angles in degrees (`rotation` is a matrix)."""
    name: str
    kind: str  # fixed, revolute, continuous, prismatic, floating, planar
    parent: str
    child: str
    translation: np.ndarray  # joint's origin in the parent link [m]
    rotation: np.ndarray  # 3 × 3, joint's axes in the parent link at position zero
    axis: np.ndarray  # unit, in the joint's axes
    lower: float = -np.inf
    upper: float = np.inf
    mimic: tuple = None  # (joint, multiplier, offset [deg or m])


@dataclass
class Part:
    """A mesh on a frame of a frames.json vehicle: drawn at `matrix` (4 × 4, may mirror)."""
    frame: str
    parent: str  # frame's parent, or None for the root
    path: Path
    matrix: np.ndarray


@dataclass
class Description:
    """The tree: `joints` in file order, `root` the link that is no joint's child."""
    path: Path
    name: str
    root: str
    joints: list
    meshes: dict = field(default_factory=dict)  # link -> [(path, 4 × 4 in the link, scale (3,))]
    cylinders: dict = field(default_factory=dict)  # link -> (radius, length) of a collision cylinder
    shown_cylinders: dict = field(default_factory=dict)  # of a visual one
    parts: list = field(default_factory=list)  # frames.json only

    def joint_of(self, link):
        """The joint whose child is `link`, or None for the root."""
        return next((j for j in self.joints if j.child == link), None)

    def chain(self, link):
        """Joints from the root to `link`."""
        out = []
        j = self.joint_of(link)
        while j is not None:
            out.append(j)
            if len(out) > len(self.joints):
                raise InvalidArgument(f"{self.path}: link '{link}' is in a loop of joints")
            j = self.joint_of(j.parent)
        return out[::-1]

    def link_vertices(self, link):
        """Positions (n, 3) of the link's visual meshes in its frame; none when files are absent."""
        out = [np.zeros((0, 3))]
        for path, matrix, scale in self.meshes.get(link, []):
            try:
                v = meshes.vertices(path) * scale
            except (FileNotFoundError, ValueError):
                continue  # the importer warns about the missing mesh; here it is only not measured
            out.append(v @ matrix[:3, :3].T + matrix[:3, 3])
        return np.vstack(out)


def _floats(text, count, what):
    values = np.array([float(x) for x in text.split()])
    if len(values) != count or not np.isfinite(values).all():
        raise InvalidArgument(f"{what}: expected {count} finite numbers, got '{text}'")
    return values


def _origin(element, what):
    """(translation, rotation) of an <origin> or of its absence."""
    if element is None:
        return np.zeros(3), np.eye(3)
    return (_floats(element.get("xyz", "0 0 0"), 3, what),
            from_rpy(*_floats(element.get("rpy", "0 0 0"), 3, what)))


def read_urdf(path):
    """Description of a URDF. Raises ValueError naming the file and what is wrong with it."""
    path = Path(path)
    try:
        robot = ElementTree.parse(path).getroot()
    except ElementTree.ParseError as e:
        raise InvalidArgument(f"{path}: not well-formed XML ({e})") from e
    if robot.tag != "robot":
        raise InvalidArgument(f"{path}: the root element is <{robot.tag}>, expected <robot>")
    joints = []
    for e in robot.findall("joint"):
        name = e.get("name", "")
        what = f"{path}: joint '{name}'"
        if e.find("parent") is None or e.find("child") is None:
            raise InvalidArgument(f"{what}: needs a parent and a child")
        translation, rotation = _origin(e.find("origin"), what)
        axis = np.array([1.0, 0, 0])
        if e.find("axis") is not None:
            axis = _floats(e.find("axis").get("xyz", "1 0 0"), 3, what)
        if np.linalg.norm(axis) < 1e-9:
            raise InvalidArgument(f"{what}: the axis is zero")
        j = Joint(name, e.get("type", "fixed"), e.find("parent").get("link"), e.find("child").get("link"),
                  translation, rotation, axis / np.linalg.norm(axis))
        unit = 1.0 if j.kind == "prismatic" else 180.0 / np.pi
        limit, mimic = e.find("limit"), e.find("mimic")
        if limit is not None and j.kind in ("revolute", "prismatic"):
            lower, upper = float(limit.get("lower", 0)), float(limit.get("upper", 0))
            if abs(lower) < 1e6 and abs(upper) < 1e6:  # ±1.8e308 is how some files say "no limit"
                j.lower, j.upper = lower * unit, upper * unit
        if mimic is not None:
            j.mimic = (mimic.get("joint"), float(mimic.get("multiplier", 1)),
                       float(mimic.get("offset", 0)) * unit)
        joints.append(j)
    links = [e.get("name") for e in robot.findall("link")]
    children = {j.child for j in joints}
    roots = [n for n in links if n not in children]
    if len(roots) != 1:
        raise InvalidArgument(f"{path}: expected one root link, found {roots or 'none (a loop)'}")
    d = Description(path, robot.get("name", path.stem), roots[0], joints)
    for e in robot.findall("link"):
        name = e.get("name")
        for visual in e.findall("visual"):
            mesh = visual.find("geometry/mesh")
            if mesh is not None:
                matrix = np.eye(4)
                matrix[:3, 3], matrix[:3, :3] = _origin(visual.find("origin"), f"{path}: link '{name}'")
                file = path.parent / mesh.get("filename", "").replace("package://", "")
                scale = _floats(mesh.get("scale", "1 1 1"), 3, f"{path}: link '{name}'")
                d.meshes.setdefault(name, []).append((file, matrix, scale))
        for cylinders, place in ((d.cylinders, "collision"), (d.shown_cylinders, "visual")):
            cylinder = e.find(f"{place}/geometry/cylinder")
            if cylinder is not None:
                cylinders[name] = (float(cylinder.get("radius")), float(cylinder.get("length")))
    return d


def read_frames(path):
    """Description of a frames.json vehicle. Raises ValueError naming the file, the frame and the key."""
    path = Path(path)
    name, frames = read_frames_file(path)
    d = Description(path, name, frames[0].name, [])
    for f in frames:
        if f.mesh is not None:
            d.parts.append(Part(f.name, f.parent, f.mesh, f.matrix))
            d.meshes[f.name] = [(f.mesh, f.matrix, np.ones(3))]
        if f.parent is None:
            continue
        d.joints.append(Joint(f.name, "continuous" if f.axis else "fixed", f.parent, f.name,
                              f.translation, np.eye(3),
                              np.eye(3)["xyz".index(f.axis)] if f.axis else np.array([1.0, 0, 0])))
        if f.wheel_radius is not None:
            v = d.link_vertices(f.name)
            width = float(np.ptp(v[:, 1])) if len(v) else f.wheel_radius
            d.cylinders[f.name] = (f.wheel_radius, width)
    return d
