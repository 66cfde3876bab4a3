"""What a plug-in draws: recorded by name, left out where the plug-in is missing, rejected by servers and for bad input."""
import os
import struct
import sys
import warnings

import dspace
from dspace.links.serving import ServerProcess

plugin, folder = sys.argv[1:]
path = os.path.join(folder, "sail.dspace")
good = struct.pack("<3d", 4.0, 0.1, 0.0)


def rejected(kind, word, call, *arguments, **settings):
    try:
        call(*arguments, **settings)
    except kind as error:
        assert word in str(error), error
    else:
        raise AssertionError(f"accepted: {arguments} {settings}")


with dspace.Session() as session:
    scene = session.scene()
    rejected(dspace.NotFound, "registered: none", scene.add_drawn, "solar_sail", good)
    rejected(dspace.InvalidArgument, "nowhere.so", session.load_plugin, "/nowhere.so")
    rejected(dspace.InvalidArgument, "DspacePlugIn", session.load_plugin, "libm.so.6")
    session.load_plugin(plugin)
    rejected(dspace.InvalidArgument, "already", session.load_plugin, plugin)
    rejected(dspace.NotFound, "'solar_sail'", scene.add_drawn, "sail", good)
    rejected(dspace.InvalidArgument, "three doubles", scene.add_drawn, "solar_sail", b"short")
    rejected(dspace.InvalidArgument, "ripple", scene.add_drawn, "solar_sail", struct.pack("<3d", 4.0, 9.0, 0.0))
    rejected(dspace.WrongType, "bytes", scene.add_drawn, "solar_sail", "text")
    assert not scene.objects
    if os.path.exists(path):
        os.remove(path)
    with session.record(path), warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        sail = scene.add_drawn("solar_sail", good, name="sail", color="#ff0000")
        scene.time = 1.0
    assert len(told) == 1 and "solar_sail" in str(told[0].message), told
    assert sail.drawer == "solar_sail" and not sail.left_out
    scene.add_camera(eye=(0, -1, 8), target=(0, 0, 0))
    view = scene.add_viewport(size=(80, 60), samples=1)
    assert (view.labels() == sail.id).sum() > 500
    red = view.image()[30, 40]
    assert red[0] > 4 * max(red[1], red[2], 1), red
    sail.remove()
    assert not view.labels().any()

    # A flat sail 4 m wide hangs 5 m over a floor under the Sun: its shadow is as large, though the picture does not show it.
    floor = scene.add_plane(40, 40, color="#ffffff", position=(0, 0, -5))
    scene.sun.direction = (0, 0, 1)
    scene.add_camera("low", eye=(0, -7, -2), target=(0, 0, -5))
    low = scene.add_viewport(size=(80, 60), camera="low", samples=1)
    assert (low.lit_fraction()[low.labels() == floor.id] == 1).all()
    sail = scene.add_drawn("solar_sail", struct.pack("<3d", 4.0, 0.0, 0.0))
    lit = low.lit_fraction()
    assert not (low.labels() == sail.id).any()
    inside = outside = 0
    for y in range(0, 60, 3):
        for x in range(0, 80, 3):
            hit = low.pick(x, y)
            if hit is None:
                continue
            aside = max(abs(hit.in_root[0]), abs(hit.in_root[1])) - 2.0  # beyond the sail's edge [m]
            inside += aside < -0.05
            outside += aside > 0.05
            if abs(aside) > 0.05:
                assert lit[y, x] == (aside > 0), (x, y, hit.in_root, lit[y, x])
    assert inside > 20 and outside > 100, (inside, outside)
    sail.frame = scene.add_frame("far", position=(100, 0, 0))
    assert (low.lit_fraction()[low.labels() == floor.id] == 1).all()

with warnings.catch_warnings(record=True) as told:
    warnings.simplefilter("always")
    with dspace.Playback(path) as playback:
        playback.seek(playback.times[-1])
        playback.seek(playback.times[0])
        playback.seek(playback.times[-1])
        sail = playback.session.scene().object("sail")
        assert sail.left_out and sail.drawer == "solar_sail", sail
    left_out = [each for each in told if "plug-in 'solar_sail'" in str(each.message)]
    assert len(left_out) == 1, [str(each.message) for each in told]

with ServerProcess([]) as server, dspace.connect(server.address) as remote:
    command = dspace.proto.commands_pb2.Command()
    command.create_scene.SetInParent()
    remote.execute(command)
    command.create_drawn.drawer = "solar_sail"
    rejected(dspace.Unsupported, "in process", remote.execute, command)
    rejected(dspace.Unsupported, "in the server", remote.scene().add_drawn, "solar_sail", good)
print("the plug-in is recorded by name, left out elsewhere, and rejected over the wire")
