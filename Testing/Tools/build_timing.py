"""Prints where the time of a build goes, from ninja's log; `./dspace build --timing` runs it.

build_timing.py BUILD

ninja's log holds each job's latest run. A job's time is from its start to its end (seconds of one of the processors'
slots), so that the sum over all jobs is the work, and the work over the wall time is the parallelism.
"""
import collections
import os
import pathlib
import re
import sys

SLOWEST = 15
FOLDERS = 30
KINDS = ("library objects", "test objects", "generated code", "precompiled headers", "linking", "benchmarks")

Job = collections.namedtuple("Job", "output seconds end")  # end: Unix time [s]


def read_log(build):
    """The jobs of a build folder whose outputs still exist. A command with several outputs is one job."""
    path = build / ".ninja_log"
    lines = path.read_text(encoding="utf-8").splitlines()
    if not lines or not lines[0].startswith("# ninja log v"):
        raise ValueError(f"{path}: the first line is {lines[:1]}; expected '# ninja log v5'")
    latest = {}
    for line in lines[1:]:
        start, end, changed, output, command = line.split("\t")
        latest[output] = (int(start), int(end), int(changed), command)
    jobs = {}
    for output, (start, end, changed, command) in latest.items():
        if (build / output).exists():
            jobs.setdefault((start, end, command), Job(output, (end - start) / 1000, changed / 1e9))
    return list(jobs.values())


def source_of(output):
    """(target, source) of an object file's path as CMake forms it; None for all other outputs."""
    found = re.fullmatch(r"(?:(.*)/)?CMakeFiles/([^/]+)\.dir/(.*)\.o", output)
    if not found:
        return None
    folder, target, source = found.groups()
    return target, os.path.normpath(os.path.join(folder or ".", source.replace("__/", "../")))


def kind_of(output):
    found = source_of(output)
    if "Testing/Benchmarks/" in output or re.fullmatch(r"bin/Bench\w+", output):
        return "benchmarks"
    if output.endswith(".gch"):
        return "precompiled headers"
    if found:
        target, source = found
        if source.endswith(".pb.cc") or target.endswith("Python") or "PythonWrapped" in target:
            return "generated code"
        if "/Testing/" in source or re.match("Test|Fuzz|dspace_tests", target):
            return "test objects"
        return "library objects"
    if re.search(r"^bin/|\.so(\.[0-9.]+)?$|\.a$", output):
        return "linking"
    return "generated code"


def folder_of(output):
    """The source folder of an object; the target in brackets where one object holds several sources."""
    target, source = source_of(output)
    folder = os.path.dirname(source)
    if os.path.basename(folder) == "Unity":
        return f"{os.path.dirname(folder)} ({target}, unity)"
    return folder


def wall_time(jobs):
    """Seconds in which at least one job ran."""
    total, reached = 0.0, float("-inf")
    for begin, end in sorted((job.end - job.seconds, job.end) for job in jobs):
        if end > reached:
            total += end - max(begin, reached)
            reached = end
    return total


def table(title, rows):
    yield ""
    yield f"{title:<72} {'seconds':>8} {'jobs':>5}"
    for name, seconds, count in rows:
        yield f"  {name:<70} {seconds:8.1f} {count:5d}"


def grouped(jobs, key):
    sums = collections.defaultdict(lambda: [0.0, 0])
    for job in jobs:
        entry = sums[key(job.output)]
        entry[0] += job.seconds
        entry[1] += 1
    return sorted(((name, *entry) for name, entry in sums.items()), key=lambda row: -row[1])


def report(build):
    """The page, as lines."""
    jobs = read_log(build)
    work, wall = sum(job.seconds for job in jobs), wall_time(jobs)
    yield (f"{len(jobs)} jobs, {work:.0f} job-seconds in {wall / 60:.1f} minutes of wall time: "
           f"{work / wall if wall else 0:.1f} jobs at a time")
    cache = build / "CMakeCache.txt"
    if cache.exists() and re.search(r"^DSPACE_CCACHE:FILEPATH=/", cache.read_text(encoding="utf-8"), re.MULTILINE):
        yield "This build uses ccache: a job whose result is in the cache takes almost no time."
    kinds = {name: (seconds, count) for name, seconds, count in grouped(jobs, kind_of)}
    yield from table("By kind", [(name, *kinds.get(name, (0.0, 0))) for name in KINDS])
    folders = grouped([job for job in jobs if source_of(job.output)], folder_of)
    yield from table(f"By folder of the sources (the first {FOLDERS} of {len(folders)})", folders[:FOLDERS])
    slowest = sorted(jobs, key=lambda job: -job.seconds)[:SLOWEST]
    yield ""
    yield f"The {len(slowest)} slowest jobs"
    for job in slowest:
        source = source_of(job.output)
        yield f"  {job.seconds:6.1f} s  {source[1] if source else job.output}"


def main():
    if len(sys.argv) != 2:
        sys.exit("build_timing.py BUILD: one argument, the build folder")
    build = pathlib.Path(sys.argv[1])
    if not (build / ".ninja_log").exists():
        sys.exit(f"{build} has no .ninja_log: build it first")
    print("\n".join(report(build)))


if __name__ == "__main__":
    main()
