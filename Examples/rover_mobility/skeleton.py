"""The model's bodies as frames and shapes of a scene; knows nothing of this rover but its description."""
import numpy as np

from dspace.frames.poses import quaternion_of_axis


def build(scene, model):
    """Frames and shapes of all bodies; returns the frames' ids, in the bodies' order, for set_poses."""
    frames = {}
    for body in model.bodies:
        frames[body.name] = scene.add_frame(body.name, frames.get(body.parent), position=body.position)
        for number, shape in enumerate(body.shapes):
            add_shape(scene, frames[body.name], f"{body.name} {number}", shape)
    return np.array([frames[body.name].id for body in model.bodies])


def add_shape(scene, frame, name, shape):
    settings = dict(frame=frame, name=name, color=shape.color, roughness=0.6)
    if shape.kind == "box":
        return scene.add_box(shape.size, position=shape.position, **settings)
    if shape.kind == "cylinder":  # a scene's cylinders stand along Z
        return scene.add_cylinder(*shape.size, position=shape.position, quaternion=quaternion_of_axis("x", 90),
                                  **settings)
    if shape.kind == "tube":
        end = np.array(shape.position)
        length = np.linalg.norm(end)
        axis, angle = np.cross((0, 0, 1), end), np.degrees(np.arccos(end[2] / length))
        if np.linalg.norm(axis) < 1e-12:
            axis = (1, 0, 0)
        return scene.add_cylinder(shape.size[0], length, position=0.5 * end,
                                  quaternion=quaternion_of_axis(axis, angle), **settings)
    raise ValueError(f"shape {name!r}: its kind is {shape.kind!r}; accepted: box, cylinder, tube")
