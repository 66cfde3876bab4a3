"""Draws the pieces of a data set: what one camera sees at one time."""
import fnmatch
import json
import os
import zlib

import numpy as np

from dspace._core.files import atomic_write
from dspace.batches.kinds import Batch, Kind
from dspace.cameras.image_file import write_image
from dspace.cameras.images import PLANES, UNITS
from dspace.cameras.model import CameraModel
from dspace.cameras.sensor import Sensor
from dspace.cameras.shutter import Shutter
from dspace.datasets.labels import annotations
from dspace.errors import NotFound
from dspace.frames.poses import Pose
from dspace.movies.draw import open_run

PREFIX = "image_%06d"


def is_whole(folder, number):
    """Whether the record of a piece is there, and its files are those that it names."""
    try:
        with open(os.path.join(folder, KIND.last(number)), "rb") as file:
            files = json.load(file)["files"]
        for each in files.values():
            with open(os.path.join(folder, each["name"]), "rb") as file:
                data = file.read()
            if len(data) != each["bytes"] or zlib.crc32(data) != each["crc32"]:
                return False
    except (OSError, ValueError, KeyError, TypeError):
        return False
    return True


KIND = Kind("dataset", "job.json", "dspace.datasets.draw", PREFIX, r"(_[\w-]+\.(png|tif|exr)|\.json)", is_whole, ".json")


def batch_of(job):
    """The Batch of a Job."""
    return Batch(KIND, job.text)


def draw_pieces(words, run, numbers, folder, tell):
    """Draws pieces of a job's text; see dspace.batches.kinds.Kind."""
    from dspace.datasets.job import Job
    job = Job(json.loads(words), run)
    source = open_run(run)
    try:
        stage = Stage(job, source)
        for count, number in enumerate(numbers, 1):
            stage.draw(number, folder)
            tell(len(numbers) - count)
    finally:
        source.close()


class Stage:
    """A job and its run, ready to be drawn."""

    def __init__(self, job, source):
        self.job, self.source = job, source
        self.models = [CameraModel.from_json(json.dumps(each["model"])) for each in job.cameras]
        sensor = job.content["sensor"]
        self.sensor = sensor and Sensor(**sensor["settings"])
        self.shutter = job.content["shutter"] and Shutter(**job.content["shutter"])

    def scene(self, time):
        """The scene of the job at a time."""
        self.source.advance(time)
        scenes, name = self.source.session.scenes, self.job.content["scene"]
        if name in scenes:
            return scenes[name]
        if not name and len(scenes) == 1:
            return next(iter(scenes.values()))
        raise NotFound(f"at {time:g} s of the run the scene is {name!r}; accepted: one of "
                       f"{', '.join(map(repr, scenes)) or 'none'}", name)

    def placed(self, scene, number):
        """The model of a piece and the arguments that say where it stands in a scene."""
        _, pose, index = self.job.parts(number)
        camera, model = self.job.cameras[index], self.models[index]
        if camera["through"]:
            for vantage in scene.vantages.values():
                if camera["through"] in vantage.cameras:
                    return model, {"camera": vantage.cameras[camera["through"]]}
            raise NotFound(f"camera {camera['name']!r}: at {scene.time:g} s the scene has no camera {camera['through']!r}; accepted: "
                           f"one of {', '.join(repr(each) for v in scene.vantages.values() for each in v.cameras) or 'none'}",
                           camera["through"])
        frame = scene.frame(camera["frame"]) if camera["frame"] else scene.root
        if pose is not None:
            pose = self.job.content["poses"][pose]
            model = model.moved(Pose(pose["position"], pose["quaternion"]), model.frame)
        return model, {"frame": frame}

    def draw(self, number, folder):
        """Writes the files of a piece, its record last."""
        content = self.job.content
        time, pose, index = self.job.parts(number)
        scene = self.scene(time)
        model, place = self.placed(scene, number)
        planes = set(content["planes"]) - {"counts"}
        if self.job.labels:
            planes.add("label")
        if "counts" in content["planes"]:
            planes.add("radiance")
        wanted = {name: name in planes for name in PLANES}
        picture = self.taken(scene, time, model, self.job.cameras[index]["line_s"], place, wanted)
        if "counts" in content["planes"]:
            picture["counts"] = self.sensor.expose(picture["radiance"], model, seed=content["sensor"]["seed"], frame=number)
        name, files = self.job.cameras[index]["name"], {}
        for plane in content["planes"]:
            values = picture[plane][..., :3] if plane == "color" else picture[plane]
            ending = {"color": "png", "counts": "png", "label": "tif"}.get(plane, content["floats"])
            file = f"{PREFIX % number}_{name}_{plane}.{ending}"
            told = scene.image_metadata(plane, model, exposure=content["exposure"], sensor=self.sensor if plane == "counts" else None, **place)
            write_image(os.path.join(folder, file), values, told)
            with open(os.path.join(folder, file), "rb") as written:
                data = written.read()
            files[plane] = {"name": file, "bytes": len(data), "crc32": zlib.crc32(data), "unit": UNITS.get(plane, "")}
        told = scene.image_metadata(None, model, **place)
        record = {"number": number, "time_s": time, "camera": name, "pose_number": pose, "scene": told["scene"], "pose": told["pose"],
                  "size": list(model.size), "files": files, "annotations": self.annotations(scene, picture.get("label"))}
        atomic_write(os.path.join(folder, KIND.last(number)), json.dumps(record, sort_keys=True).encode())

    def taken(self, scene, time, model, line_s, place, wanted):
        """The planes of a piece. The run is at its time before and after."""
        settings = {"samples": self.job.content["samples"], "exposure": self.job.content["exposure"], **wanted}
        if model.type == "line_scan":
            def at(line):
                self.source.advance(time + line_s * line)
            picture = scene.simulate_lines(model, place["frame"], at if line_s else None, **settings)
            self.source.advance(time)
            return picture
        if self.shutter:
            return scene.simulate_exposure(self.shutter, lambda t: self.source.advance(time + t), model, **settings, **place)
        return scene.simulate_image(model, **settings, **place)

    def annotations(self, scene, labels):
        if not self.job.content["categories"]:
            return []
        objects = {name: thing.id for name, thing in scene.objects.items()}
        categories = []
        for number, category in enumerate(self.job.content["categories"], 1):
            categories.append((number, {id: name for name, id in objects.items()
                                        if any(fnmatch.fnmatchcase(name, each) for each in category["objects"])}))
        return annotations(np.asarray(labels), categories, self.job.content["masks"] == "compressed")
