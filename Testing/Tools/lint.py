"""Checks the C++ sources with clang-format and clang-tidy, or formats them; `./dspace lint` and `./dspace format`
run it.

lint.py BUILD [--format] [--tidy] [--changed] [--rewrite] [FILE ...]

Without --format and --tidy it runs both. Without FILE it checks every C++ file. BUILD is a configured build folder
whose generated headers exist; clang-tidy takes each file's compiler flags from there.
"""
import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import shlex
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDERS = ("Libraries", "Wrapping", "Testing", "Examples")
BATCH = 40  # files that one clang-format reads
# Checked by --changed while there is no release tag: one source of each part of the libraries, found by its name.
SAMPLE = ("FrameTree.cxx", "GltfMaterials.cxx", "PlyFile.cxx", "Camera.cxx", "GpuStore.cxx", "Crs.cxx", "GridRay.cxx",
          "NoiseLayer.cxx", "ClipmapWindow.cxx", "LinkAddress.cxx", "MessageLog.cxx", "Telemetry.cxx")


def all_files(root=ROOT):
    return sorted(path for folder in FOLDERS for pattern in ("*.cxx", "*.h") for path in (root / folder).rglob(pattern))


def changed_files(root=ROOT):
    """The C++ files that differ from the previous release tag, or None where no commit before this one has a tag."""
    tag = subprocess.run(["git", "describe", "--tags", "--abbrev=0", "--match", "v[0-9]*", "HEAD^"], cwd=root,
                         capture_output=True, text=True)
    if tag.returncode != 0:
        return None
    names = subprocess.run(["git", "diff", "--name-only", "--diff-filter=d", tag.stdout.strip(), "--", *FOLDERS],
                           cwd=root, check=True, capture_output=True, text=True).stdout.splitlines()
    return sorted(root / name for name in names if name.endswith((".cxx", ".h")))


def sample(root=ROOT):
    found = {path.name: path for path in all_files(root)}
    absent = [name for name in SAMPLE if name not in found]
    if absent:
        sys.exit(f"lint: SAMPLE in {pathlib.Path(__file__).name} names files that do not exist: {', '.join(absent)}")
    return [found[name] for name in SAMPLE]


def in_parallel(work, items):
    """The results in the order of the items, each as soon as it is there."""
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        yield from pool.map(work, items)


def check_format(files):
    """Prints what clang-format would change; returns the number of files that it would change."""
    def run(some):
        return subprocess.run(["clang-format", "--dry-run", "-Werror", *some], cwd=ROOT, capture_output=True, text=True)

    failed = set()
    for done in in_parallel(run, [files[i:i + BATCH] for i in range(0, len(files), BATCH)]):
        found = set(re.findall(r"^(.+?):\d+:\d+: error:", done.stderr, re.MULTILINE))
        failed |= found
        print(done.stderr, end="", flush=True)
        if done.returncode != 0 and not found:
            sys.exit("lint: clang-format itself failed")
    print(f"clang-format: {len(failed)} of {len(files)} files need `./dspace format`")
    return len(failed)


def tidy_command(entry, source, folder):
    """The compiler command of an entry of compile_commands.json, for `source`, as clang understands it: GCC's
    precompiled headers become plain headers, which are copied into `folder`."""
    words, command, skip = shlex.split(entry["command"]), [], False
    for word, following in zip(words, [*words[1:], ""]):
        if skip:
            skip = False
        elif word == "-include" and following.endswith("cmake_pch.hxx"):
            header = pathlib.Path(following)
            copy = folder / (header.parent.name + ".hxx")
            copy.write_text(header.read_text(encoding="utf-8"), encoding="utf-8")
            command += ["-include", str(copy)]
            skip = True
        elif word == entry["file"]:
            command.append(str(source))
        elif word not in ("-Winvalid-pch", "-Werror"):
            command.append(word)
    return command


def compile_commands(build, files):
    """The entries of compile_commands.json for the sources among `files`: of a file that a unity source includes, the
    entry of that unity source."""
    entries = {}
    for entry in json.loads((build / "compile_commands.json").read_text(encoding="utf-8")):
        source = pathlib.Path(entry["file"])
        if source.parent.name == "Unity" and source.exists():
            for included in re.findall(r'#include "([^"]+)"', source.read_text(encoding="utf-8")):
                entries.setdefault(included, entry)
        entries.setdefault(entry["file"], entry)
    return {path: entries[str(path)] for path in files if path.suffix == ".cxx" and str(path) in entries}


def check_tidy(build, files):
    """Prints what clang-tidy finds; returns the number of files with findings."""
    folder = build / "lint"
    folder.mkdir(exist_ok=True)
    entries = compile_commands(build, files)
    commands = [{"directory": entry["directory"], "file": str(path),
                 "arguments": tidy_command(entry, path, folder)} for path, entry in entries.items()]
    (folder / "compile_commands.json").write_text(json.dumps(commands, indent=1), encoding="utf-8")
    left_out = [path for path in files if path.suffix == ".cxx" and path not in entries]
    if left_out:
        print(f"clang-tidy: {build} does not compile {', '.join(str(path.relative_to(ROOT)) for path in left_out)}")

    def run(path):
        return subprocess.run(["clang-tidy", "--quiet", "--warnings-as-errors=*", "-p", folder, path], cwd=ROOT,
                              capture_output=True, text=True)

    failed = 0
    for done in in_parallel(run, entries):
        if done.returncode != 0:
            failed += 1
            print(done.stdout or done.stderr, end="", flush=True)
    print(f"clang-tidy: findings in {failed} of {len(entries)} files")
    return failed


def main():
    parser = argparse.ArgumentParser(prog="dspace lint", description="Checks the C++ sources with clang-format and "
                                     "clang-tidy.")
    parser.add_argument("build", type=pathlib.Path, help=argparse.SUPPRESS)
    parser.add_argument("--format", action="store_true", help="only clang-format")
    parser.add_argument("--tidy", action="store_true", help="only clang-tidy")
    parser.add_argument("--changed", action="store_true",
                        help="clang-tidy reads only the files that differ from the previous release tag, or, while "
                        "there is none, a fixed sample of a dozen")
    parser.add_argument("--rewrite", action="store_true", help="format the files instead of checking them")
    parser.add_argument("files", nargs="*", type=pathlib.Path, metavar="FILE", help="default: every C++ file")
    options = parser.parse_intermixed_args()
    both = options.format == options.tidy
    files = [path.resolve() for path in options.files] or all_files()
    if options.rewrite:
        subprocess.run(["clang-format", "-i", *files], cwd=ROOT, check=True)
        return
    failed = 0
    if both or options.format:
        failed += check_format(files)
    if both or options.tidy:
        if options.changed:
            files = changed_files()
            if files is None:
                files = sample()
        failed += check_tidy(options.build.resolve(), files)
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
