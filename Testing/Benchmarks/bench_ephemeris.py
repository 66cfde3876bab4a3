"""States from a type 2 SPK: a million times through a session, against python3-jplephem with arrays, in turn."""
import os
import pathlib
import statistics
import time

import dspace
import numpy as np
from jplephem.spk import SPK

KERNEL = pathlib.Path(os.environ.get("DSPACE_DATA", "../shared/data"), "ephemeris/spice_test_kernels/de405s_littleendian.bsp")
COUNT = 1_000_000
ROUNDS = 5
# Target, observer, and the segments that jplephem adds up for them.
CASES = (("mars barycenter", "ssb", ((0, 4),)), ("mars", "earth", ((4, 499), (0, 4), (0, 3), (3, 399))))


def main():
    if not KERNEL.exists():
        print(f"ephemeris: {KERNEL} is absent; set DSPACE_DATA")
        return
    times = np.linspace(-9.4e7, 3.1e8, COUNT)
    theirs = SPK.open(str(KERNEL))
    with dspace.Session() as session:
        scene = session.scene()
        scene.kernels.load(KERNEL)
        for target, observer, segments in CASES:
            spent = {"ours": [], "jplephem": []}
            for _ in range(ROUNDS):
                start = time.perf_counter()
                states = scene.ephemeris(target, observer, times)
                spent["ours"].append(time.perf_counter() - start)
                start = time.perf_counter()
                found = [theirs[pair].compute_and_differentiate(2451545.0, times / 86400.0) for pair in segments]
                spent["jplephem"].append(time.perf_counter() - start)
            if len(segments) == 1:
                assert np.abs(states.position - 1e3 * found[0][0].T).max() < 1.0  # the same was computed
            ours, other = (statistics.median(spent[name]) for name in ("ours", "jplephem"))
            print(f"ephemeris: {COUNT:,} states of {target} from {observer} ({len(segments)} segments): {ours:.2f} s, "
                  f"{COUNT / ours / 1e6:.2f} million a second (goal 1); jplephem {other:.2f} s, {other / ours:.1f} x (goal 5)")


if __name__ == "__main__":
    main()
