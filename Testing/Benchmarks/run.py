"""Runs the benchmark programs of a build: run.py BUILD [NAME ...] (substrings choose)."""

import pathlib
import subprocess
import sys


def main():
    build = pathlib.Path(sys.argv[1])
    names = sys.argv[2:]
    programs = sorted((build / "bin").glob("Bench*"))
    scripts = sorted(pathlib.Path(__file__).parent.glob("bench_*.py"))
    # What is built only where something is installed.
    optional = {"BenchEmbree": "it needs libembree-dev", "BenchOsgTerrain": "it needs libopenscenegraph-dev"}
    absent = {n: why for n, why in optional.items() if not (build / "bin" / n).exists()}
    chosen = [p for p in programs + scripts
              if not names or any(n.lower() in p.name.lower() for n in names)]
    left_out = [n for n in absent if not names or any(a.lower() in n.lower() for a in names)]
    if not chosen and not left_out:
        known = ", ".join(p.name for p in programs + scripts)
        sys.exit(f"no benchmark is named {' or '.join(names)}; there are: {known}")
    failed = []
    for name in left_out:
        print(f"-- {name} is left out: this build lacks it ({absent[name]})", flush=True)
    for program in chosen:
        print(f"-- {program.name}", flush=True)
        command = [sys.executable, program] if program.suffix == ".py" else [program]
        if subprocess.run(command).returncode != 0:
            failed.append(program.name)
    if failed:
        sys.exit(f"failed: {', '.join(failed)}")


if __name__ == "__main__":
    main()
