"""Runs the benchmark programs of a build: run.py BUILD [NAME ...] (substrings choose)."""

import pathlib
import subprocess
import sys


def main():
    build = pathlib.Path(sys.argv[1])
    names = sys.argv[2:]
    programs = sorted((build / "bin").glob("Bench*"))
    scripts = sorted(pathlib.Path(__file__).parent.glob("bench_*.py"))
    chosen = [p for p in programs + scripts
              if not names or any(n.lower() in p.name.lower() for n in names)]
    if not chosen:
        known = ", ".join(p.name for p in programs + scripts)
        sys.exit(f"no benchmark is named {' or '.join(names)}; there are: {known}")
    failed = []
    for program in chosen:
        print(f"-- {program.name}", flush=True)
        command = [sys.executable, program] if program.suffix == ".py" else [program]
        if subprocess.run(command).returncode != 0:
            failed.append(program.name)
    if failed:
        sys.exit(f"failed: {', '.join(failed)}")


if __name__ == "__main__":
    main()
