"""What a new user waits for, against a Python that only imports numpy: help of each command, a session, a terrain.

Python files are compiled, as they are after the first run and in an installed tree."""
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
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


def run(*arguments):
    return subprocess.run([sys.executable, *arguments], check=True, capture_output=True, text=True).stdout


def seconds(*arguments):
    began = time.perf_counter()
    run(*arguments)
    return time.perf_counter() - began


def within(code):
    before = "" if "Session" in code else "scene = dspace.Session().scene()"
    return float(run("-c", WITHIN.format(code=code, before=before)))


def tell(what, pairs):
    ratios = [a / b for a, b in pairs]
    print(f"{what}: ratio {statistics.median(ratios):.2f} ({min(ratios):.2f}..{max(ratios):.2f}), {len(pairs)} pairs; "
          f"{statistics.median(a for a, _ in pairs):.3f} s against {statistics.median(b for _, b in pairs):.3f} s")


def main():
    from dspace.command_line import WORDS
    bare = lambda: seconds("-c", "import numpy")
    with tempfile.TemporaryDirectory() as compiled:
        os.environ["PYTHONPYCACHEPREFIX"] = compiled
        os.environ.pop("PYTHONDONTWRITEBYTECODE", None)
        bare()
        for word in WORDS:
            help = ("-m", "dspace", word, "--help")
            run(*help)
            tell(" ".join(help[1:]), [(seconds(*help), bare()) for _ in range(PAIRS)])
        for what, code in WAITS.items():
            within(code)
            tell(what, [(within(code), bare()) for _ in range(PAIRS)])


if __name__ == "__main__":
    main()
