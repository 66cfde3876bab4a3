"""Makes a data set: finds the missing pieces, shares their drawing, and writes the manifest and the labels.

Every piece has a record, which is written last and names its files, so an interrupted data set continues without drawing
a piece twice. All ways of sharing the work give the same bytes."""
import json
import time as clock

from dspace import __version__
from dspace._core.fields import integer, path as path_of, reject
from dspace._core.files import atomic_write
from dspace.batches.folder import Folder
from dspace.batches.processes import share
from dspace.datasets.draw import KIND, Stage, batch_of, draw_pieces
from dspace.datasets.job import Job
from dspace.movies.draw import open_run

MANIFEST, COCO = "manifest.json", "coco.json"


def make(job, out, jobs=1, scheduler=None, progress=None, redraw=False):
    """Draws a data set into the folder `out`, and returns the number of pieces that this call drew.

    job: the path of a TOML file (Documentation/Cameras.md), or a Job. jobs: number of processes, 1 to 64. scheduler: the address
    of a Dask scheduler whose workers draw; the run must have the same path on their machines. progress: called with (pieces
    done, total, seconds so far, pieces drawn in them). make() continues an interrupted make() of the same job; redraw: draws all
    again. The folder then has the images, a record of each piece, manifest.json and, where the job has categories, coco.json.

    Raises dspace.Error, which names the line of a job that is wrong, before anything is drawn."""
    about = "data set"
    job = job if isinstance(job, Job) else Job.load(job)
    jobs = integer(jobs, "jobs", about, "an integer from 1 to 64")
    if not 1 <= jobs <= 64:
        reject(about, "jobs", jobs, "an integer from 1 to 64")
    if scheduler is not None:
        from dspace.batches import dask_workers
        dask_workers.require_address(scheduler, about)
    out = path_of(out, "the folder", about)
    check_run(job)
    with Folder(out, batch_of(job), job.run, redraw) as folder:
        missing = folder.missing(job.total)
        began = clock.monotonic()

        def tell(left):
            if progress:
                progress(job.total - left, job.total, clock.monotonic() - began, len(missing) - left)

        tell(len(missing))
        if missing and scheduler:
            dask_workers.share(scheduler, job.run, missing, folder, tell)
        elif missing and jobs > 1:
            share(job.run, missing, min(jobs, len(missing)), folder, tell)
        elif missing:
            draw_pieces(job.text, job.run, missing, folder.folder, tell)
        _write_manifest(job, folder)
    return len(missing)


def check_run(job):
    """Raises dspace.Error, with the job's line, for times, scenes, frames and cameras that the run does not have."""
    where = getattr(job, "where", None)

    def guard(function, *line):
        return function() if where is None else where.guard(function, *line)

    source = guard(lambda: open_run(job.run), "", 0, "run")
    try:
        first, last = source.extent
        for time in job.content["times"]:
            if not first - 1e-9 <= time <= last + 1e-9:
                message = f"the time {time:g} s is outside of the run, {first:g} to {last:g} s; accepted: times within"
                where.reject(message, key="times") if where else reject("data set", "the time", time, f"{first:g} to {last:g} s")
        for number in range(job.total):
            time, _, index = job.parts(number)
            begin, end = job.span(number)
            if time + begin < first - 1e-9 or time + end > last + 1e-9:
                message = (f"at {time:g} s camera {job.cameras[index]['name']!r} is exposed from {time + begin:g} to {time + end:g} s, and "
                           f"the run is from {first:g} to {last:g} s; accepted: exposures within")
                where.reject(message, key="times") if where else reject("data set", "the time", time, f"{first:g} to {last:g} s")
        stage = Stage(job, source)
        scene = guard(lambda: stage.scene(job.content["times"][0]), "", 0, "scene")
        for index in range(len(job.cameras)):
            key = "through" if job.cameras[index]["through"] else "frame"
            guard(lambda: stage.placed(scene, index), "camera", index, key)
    finally:
        source.close()


def _write_manifest(job, folder):
    records = []
    for number in range(job.total):
        with open(folder.path(KIND.last(number)), encoding="utf-8") as file:
            records.append(json.load(file))
    content = job.content
    manifest = {"kind": "dspace data set", "dspace": __version__, "planes": content["planes"], "samples": content["samples"],
                "exposure": content["exposure"], "sensor": content["sensor"], "shutter": content["shutter"],
                "categories": content["categories"],
                "cameras": [{"name": each["name"], "frame": each["frame"], "through": each["through"], "line_s": each["line_s"],
                             "calibration": each["model"]}
                            for each in content["cameras"]],
                "images": [{key: value for key, value in record.items() if key != "annotations"} for record in records]}
    atomic_write(folder.path(MANIFEST), json.dumps(manifest, indent=1, sort_keys=True).encode())
    if content["categories"]:
        atomic_write(folder.path(COCO), json.dumps(_coco(content, records), sort_keys=True).encode())


def _coco(content, records):
    images, labels = [], []
    for record in records:
        shown = record["files"].get("color") or record["files"].get("counts") or next(iter(record["files"].values()))
        width, height = record["size"]
        images.append({"id": record["number"] + 1, "file_name": shown["name"], "width": width, "height": height,
                       "camera": record["camera"], "time_s": record["time_s"]})
        for each in record["annotations"]:
            labels.append({"id": len(labels) + 1, "image_id": record["number"] + 1, **each})
    return {"info": {"description": "Simulated images of Dspace", "version": __version__}, "images": images, "annotations": labels,
            "categories": [{"id": number, "name": each["name"]} for number, each in enumerate(content["categories"], 1)]}
