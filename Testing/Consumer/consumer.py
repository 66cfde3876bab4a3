"""The installed Python package draws a picture, out of the installed libraries alone."""
import os
import sys

import dspace

prefix, model = os.path.realpath(sys.argv[1]), sys.argv[2]
with dspace.Session() as session:
    scene = session.scene()
    middle, _ = scene.load(model).bounds
    scene.add_camera(eye=middle + (3, -4, 2), target=middle)
    pick = scene.add_viewport(size=(320, 240)).pick(159.5, 119.5)
    assert pick and pick.object, "nothing lies in the middle of the picture"
    picked = pick.object.name

with open("/proc/self/maps", encoding="utf-8") as maps:
    mapped = {line.split(maxsplit=5)[5].strip() for line in maps if ".so" in line}
ours = {file for file in mapped if "dspace" in file.rsplit("/", 1)[-1].lower()}
assert ours, "no library of Dspace is loaded"
for file in [*ours, os.path.realpath(dspace.__file__)]:
    assert file.startswith(prefix + "/"), f"{file} is not of the installed tree"
print(f"Python picked {picked} with {len(ours)} installed libraries")
