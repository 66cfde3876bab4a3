"""What a new user waits for, against a Python that only imports numpy: help of each command, a session, a terrain."""
import pathlib
import statistics
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAIRS = 5
# Measured in their process, after dspace is imported.
WAITS = {"a session": "s = dspace.Session(); s.scene()",
         "a terrain of 1001 x 1001 posts": f"t = scene.add_terrain({str(ROOT / 'Data/field/field.tif')!r}, mode='clipmap')",
         "the same of triangles": f"t = scene.add_terrain({str(ROOT / 'Data/field/field.tif')!r}, mode='triangles')"}
WITHIN = """
import time, dspace
{before}
began = time.perf_counter()
{code}
print(time.perf_counter() - began)
"""


def seconds(*arguments):
    began = time.perf_counter()
    subprocess.run([sys.executable, *arguments], check=True, capture_output=True)
    return time.perf_counter() - began


def within(code):
    before = "" if "Session" in code else "scene = dspace.Session().scene()"
    done = subprocess.run([sys.executable, "-c", WITHIN.format(code=code, before=before)], check=True, capture_output=True,
                          text=True)
    return float(done.stdout)


def tell(what, pairs):
    ratios = [a / b for a, b in pairs]
    print(f"{what}: ratio {statistics.median(ratios):.2f} ({min(ratios):.2f}..{max(ratios):.2f}), {len(pairs)} pairs; "
          f"{statistics.median(a for a, _ in pairs):.3f} s against {statistics.median(b for _, b in pairs):.3f} s")


def main():
    from dspace.command_line import WORDS
    bare = lambda: seconds("-c", "import numpy")
    bare()
    for word in WORDS:
        tell(f"dspace {word} --help", [(seconds("-m", "dspace", word, "--help"), bare()) for _ in range(PAIRS)])
    for what, code in WAITS.items():
        tell(what, [(within(code), bare()) for _ in range(PAIRS)])


if __name__ == "__main__":
    main()
