"""The C++ client of Examples/cpp_client drives a server of the installed package, and a viewer sees it."""
import math
import subprocess
import sys

import dspace
from dspace.links.serving import ServerProcess

drive = sys.argv[1]
with ServerProcess([]) as server:
    for _ in range(2):  # the second run makes the first one's scene again
        said = subprocess.run([drive, server.address, "0.5"], stdout=subprocess.PIPE, text=True, timeout=120, check=True)
    place = [float(each) for each in said.stdout.split("cart at ")[1].split()]
    expected = [4 * math.cos(0.25), 4 * math.sin(0.25), 0.25]
    assert max(abs(a - b) for a, b in zip(place, expected)) < 1e-12, place
    with dspace.watch(server.address) as watcher:
        while not watcher.scenes:
            watcher.update(5.0)
        scene = watcher.scenes["scene"]
        assert abs(scene.time - 0.5) < 1e-12 and list(scene.frames["cart"].position) == place, scene.time
        assert len(scene.objects) == 1 and list(watcher.viewports) == ["view"]
failed = subprocess.run([drive, "unix:/nowhere/socket"], stderr=subprocess.PIPE, text=True, timeout=120)
assert failed.returncode == 1 and "/nowhere/socket" in failed.stderr and failed.stderr.count("\n") == 1, failed.stderr
print("the C++ client drove to", *place)
