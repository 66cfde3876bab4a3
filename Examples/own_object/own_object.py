"""A solar sail that a plug-in draws, behind and before a spacecraft's body.

    python3 own_object.py PLUGIN [OUT.png]

PLUGIN: the library that CMakeLists.txt builds (libsolar_sail.so). The script writes a picture and checks the planes of
the sail: depths, labels and the fragment that hides it."""
import struct
import sys

import numpy as np

import dspace


def sail(edge, ripple, phase=0.0):
    """The plug-in's parameters: three doubles, metres and radians."""
    return struct.pack("<3d", edge, ripple, phase)


def build(session, plugin):
    session.load_plugin(plugin)
    scene = session.scene()
    craft = scene.add_frame("craft", position=(1e8, 0, 0))  # far from the root: precision holds
    scene.add_box((1.2, 1.2, 1.2), frame=craft, name="body", position=(0, 0, 0.3), color="#b0b4bc")
    scene.add_fragment("sails")
    sheet = scene.add_drawn("solar_sail", sail(10.0, 0.15), frame=craft, name="sail", fragment="sails")
    scene.add_camera(frame=craft, eye=(8, -12, 6), target=(0, 0, 0))
    return scene, craft, sheet


def main(plugin, out=None):
    with dspace.Session() as session:
        scene, craft, sheet = build(session, plugin)
        view = scene.add_viewport(size=(640, 400), name="view")
        if out:
            view.save(out)
        labels, depth = view.labels(), view.depth()
        body = scene.object("body").id
        shown = labels == sheet.id
        assert shown.sum() > 20000 and (labels == body).sum() > 1000, "the sail and the body are in the label plane"
        assert np.isfinite(depth[shown]).all(), "the sail has depths"

        # The sail is the surface z = 0.15 sin(k x) cos(k y) in its own frame: the picks lie on it.
        k, checked = 2 * np.pi * 3 / 10.0, 0
        for y, x in np.argwhere(shown)[::4001]:
            pick = view.pick(int(x), int(y))
            p = pick.in_frame
            assert pick.object == sheet and pick.frame == craft
            assert abs(p[2] - 0.15 * np.sin(k * p[0]) * np.cos(k * p[1])) < 0.01, p  # chords of the grid
            checked += 1

        view.hide("sails")  # in this viewport only
        assert not (view.labels() == sheet.id).any()
        other = scene.add_viewport(size=(320, 200), name="other")
        assert (other.labels() == sheet.id).any()
        print(f"{shown.sum()} pixels of the sail, {checked} picks on its surface")


if __name__ == "__main__":
    main(*sys.argv[1:])
