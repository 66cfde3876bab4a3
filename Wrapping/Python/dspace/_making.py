"""How a scene makes objects: from files, from numbers, from text."""
import os

import numpy as np

from dspace import _wire
from dspace.cameras import put_projection
from dspace.frames import put_pose
from dspace.objects import UP, GraphicsObject, Primitive, Text, TiltMarker, Trail, put_settings
from dspace.poses import Pose, quaternion_of_axis, to_pose, vector
from dspace.robots import Robot

# What takes a file's axis to Z.
_TURNS = {"z": (1, 0, 0, 0), "y": tuple(quaternion_of_axis("x", 90)),
          "x": tuple(quaternion_of_axis("y", -90)), "-z": (0, 1, 0, 0)}


def _points(points):
    array = np.asarray(points, dtype=float)
    if array.size and (array.ndim != 2 or array.shape[1] != 3):
        raise ValueError(f"the points have shape {array.shape}; accepted: (n, 3)")
    return array


class ObjectMaking:
    """The part of Scene that makes objects; Scene says what all of its functions take."""

    def load(self, path, frame=None, ornamental=False, scale=1.0, up="z", rotation=None,
             levels=(), strict=False, point_cloud=False, **settings):
        """A model file (glTF, GLB, VRML, OBJ, STL, PLY) as a GraphicsObject, or a URDF as a Robot.

        scale: metres a unit of the file. up: the file's axis that becomes Z ("z", "y", "x", "-z");
        rotation: a quaternion that turns it further. levels: coarser files as (path, pixels) pairs,
        each drawn while the object is seen larger than `pixels`; the last one should have 0, and
        `path` then needs its own number: (path, pixels) too.
        strict: a missing texture or mesh raises; else it is a warning (and, in a URDF, a stand-in).
        point_cloud: a file of points is shown, `point_size` pixels large; else no faces, no object.
        A URDF takes position, quaternion, name, fragment, and `pose` of its base frame only."""
        if up not in UP:
            raise ValueError(f"up is {up!r}; accepted: {', '.join(UP)}")
        first, pixels = path if isinstance(path, tuple) else (path, 0.0)
        if os.fspath(first).lower().endswith(".urdf"):
            if levels or pixels or point_cloud:
                raise ValueError(f"file '{os.fspath(first)}': levels {levels!r}, {pixels!r} pixels and "
                                 f"point_cloud={point_cloud!r}; accepted for a URDF: none of these")
            return self._load_robot(first, frame, ornamental, strict, scale, up, rotation, **settings)
        command = self._command()
        message = command.import_object
        put_settings(self, message.object, frame=frame, ornamental=ornamental, **settings)
        message.level.add(path=os.fspath(first), minimum_pixels=pixels)
        for other, minimum in levels:
            message.level.add(path=os.fspath(other), minimum_pixels=minimum)
        message.scale = scale
        message.up = UP[up]
        if rotation is not None:
            q = message.rotation
            q.w, q.x, q.y, q.z = (float(v) for v in rotation)
        message.strict = strict
        message.point_cloud = point_cloud
        return GraphicsObject(self, self._execute(command).object.object)

    def _load_robot(self, path, frame, ornamental, strict, scale, up, rotation, name=None,
                    fragment=None, position=None, quaternion=None, pose=None):
        base = to_pose(position, quaternion, None, pose)
        if up != "z" or rotation is not None or scale != 1.0:
            turn = Pose(quaternion=_TURNS[up], scale=scale)
            base = base @ (turn if rotation is None else Pose(quaternion=rotation) @ turn)
        command = self._command()
        message = command.load_robot
        message.path = os.fspath(path)
        message.name = name or ""
        message.frame = self._frame_id(frame)
        put_pose(message.pose, base)
        message.nature = 1 if ornamental else 0
        message.fragment = self._name(fragment)
        message.strict = strict
        return Robot(self, self._execute(command).robot)

    def _primitive(self, settings, shape, **fields):
        command = self._command()
        put_settings(self, command.create_primitive.object, **settings)
        message = getattr(command.create_primitive, shape)
        message.SetInParent()
        for field, value in fields.items():
            if value is not None:
                setattr(message, field, value)
        return command

    def _make(self, command, kind=Primitive):
        return kind(self, self._execute(command).object.object)

    def add_box(self, size, **settings):
        """size: three edges [m]; centred."""
        command = self._primitive(settings, "box")
        s = command.create_primitive.box.size
        s.x, s.y, s.z = vector(size, "the size")
        return self._make(command)

    def add_sphere(self, radius, resolution=None, **settings):
        """Centred, poles on Z [m]."""
        return self._make(self._primitive(settings, "sphere", radius=radius, resolution=resolution))

    def add_cylinder(self, radius, height, resolution=None, **settings):
        """Centred, along Z [m]."""
        return self._make(self._primitive(settings, "cylinder", radius=radius, height=height,
                                          resolution=resolution))

    def add_cone(self, radius, height, resolution=None, **settings):
        """Along Z, the apex at +height / 2 [m]."""
        return self._make(self._primitive(settings, "cone", radius=radius, height=height,
                                          resolution=resolution))

    def add_plane(self, width, height, **settings):
        """Centred, in XY, facing +Z [m]."""
        return self._make(self._primitive(settings, "plane", width=width, height=height))

    def add_disc(self, radius, resolution=None, **settings):
        """Centred, in XY, facing +Z [m]."""
        return self._make(self._primitive(settings, "disc", radius=radius, resolution=resolution))

    def add_torus(self, radius, tube, resolution=None, **settings):
        """About Z; radius to the middle of the tube [m]."""
        return self._make(self._primitive(settings, "torus", radius=radius, tube=tube,
                                          resolution=resolution))

    def add_arrow(self, length, ornamental=True, **settings):
        """From the origin along +X [m]."""
        return self._make(self._primitive({**settings, "ornamental": ornamental}, "arrow",
                                          length=length))

    def add_axes(self, length, ornamental=True, **settings):
        """X red, Y green, Z blue, from the origin [m]."""
        return self._make(self._primitive({**settings, "ornamental": ornamental}, "axes",
                                          length=length))

    def add_lines(self, points, closed=False, ornamental=True, **settings):
        """One polyline through an array (n, 3), or a list of several such [m]."""
        several = isinstance(points, (list, tuple)) and len(points) and np.ndim(points[0]) == 2
        lines = [_points(line) for line in (points if several else [points])]
        command = self._primitive({**settings, "ornamental": ornamental}, "lines", closed=closed)
        message = command.create_primitive.lines
        _wire.put_array(message, "point", np.concatenate([line.ravel() for line in lines]))
        if several:
            message.count.extend(len(line) for line in lines)
        return self._make(command)

    def add_points(self, points, ornamental=True, **settings):
        """Points of an array (n, 3) [m], `point_size` pixels large."""
        command = self._primitive({**settings, "ornamental": ornamental}, "points")
        _wire.put_array(command.create_primitive.points, "point", _points(points))
        return self._make(command)

    def add_frustum(self, length, size, fov_deg=None, height=None, tangents=None, near=None,
                    ornamental=True, **settings):
        """What a camera (X right, Y down, Z forward) with an image of `size` (width, height) pixels
        sees up to `length` along Z [m]; the projection as in Camera.set_projection."""
        command = self._primitive({**settings, "ornamental": ornamental}, "frustum", length=length,
                                  width=size[0], height=size[1])
        put_projection(command.create_primitive.frustum.projection, fov_deg, height, tangents, near)
        return self._make(command)

    def add_goal(self, height, ornamental=True, **settings):
        """A pole along Z with a flag and a ring on the ground [m]."""
        return self._make(self._primitive({**settings, "ornamental": ornamental}, "goal",
                                          height=height))

    def add_tilt_marker(self, radius, tilt_deg=0.0, warn_deg=None, limit_deg=None, ornamental=True,
                        **settings):
        """A ring with a needle: green upright, yellow at warn_deg (15), red from limit_deg (30)."""
        command = self._primitive({**settings, "ornamental": ornamental}, "tilt", radius=radius,
                                  tilt_deg=tilt_deg, warn_deg=warn_deg, limit_deg=limit_deg)
        return self._make(command, TiltMarker)

    def add_text(self, text, height, ornamental=True, **settings):
        """Flat letters in XY, readable from +Z; a capital letter is `height` metres high."""
        command = self._command()
        put_settings(self, command.create_text.object, ornamental=ornamental, **settings)
        command.create_text.text = text
        command.create_text.solid.height = height
        return self._make(command, Text)

    def add_label(self, text, font_size=None, color=None, background=None, background_opacity=None,
                  offset=None, ornamental=True, **settings):
        """A label that faces the camera; font_size and offset (right, up) in pixels."""
        command = self._command()
        put_settings(self, command.create_text.object, ornamental=ornamental, **settings)
        command.create_text.text = text
        label = command.create_text.label
        label.SetInParent()
        for field, value in (("color", color), ("background", background)):
            if value is not None:
                c = getattr(label, field)
                c.r, c.g, c.b = vector(value, field)
        if font_size is not None:
            label.font_size = font_size
        if background_opacity is not None:
            label.background_opacity = background_opacity
        if offset is not None:
            label.offset_x, label.offset_y = offset
        return self._make(command, Text)

    def add_trail(self, capacity=10000, minimum_spacing=0.0, fade=False, ornamental=True,
                  **settings):
        """A line through the last `capacity` points that Trail.append was given, each at least
        `minimum_spacing` [m] from the one before; fade: older points are fainter."""
        command = self._command()
        message = command.create_trail
        put_settings(self, message.object, ornamental=ornamental, **settings)
        message.capacity = capacity
        message.minimum_spacing = minimum_spacing
        message.fade = fade
        return self._make(command, Trail)
