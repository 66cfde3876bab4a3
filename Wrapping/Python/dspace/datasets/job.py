"""The job of a data set: a TOML file, checked, with messages that name its lines."""
import json
import os
import re
import tomllib

import numpy as np

from dspace._core.fields import path as path_of
from dspace._core.traits import SAMPLES
from dspace.cameras.images import PLANES
from dspace.cameras.model import CameraModel
from dspace.cameras.sensor import Sensor
from dspace.cameras.shutter import Shutter
from dspace.errors import Corrupt, Error, InvalidArgument, Io
from dspace.frames.poses import Pose, quaternion_of_matrix

MOST = 10**6  # pieces
TOP = {"run": str, "scene": str, "times": (list, dict), "planes": list, "samples": int, "exposure": (int, float),
       "floats": str, "masks": str, "camera": list, "pose": list, "sensor": dict, "shutter": dict, "category": list}
TABLES = {"camera": {"name": str, "model": str, "camera": str, "size": list, "frame": str, "through": str,
                     "line_s": (int, float)},
          "pose": {"position": list, "quaternion": list, "eye": list, "target": list, "up": list},
          "category": {"name": str, "objects": list}}
WORDS = {str: "a text", list: "a list", int: "a whole number", dict: "a table"}


class Job:
    """A job. content: a dict for JSON with everything that draws its pieces, without files other than the run; run: its path.

    Piece number n shows the time n // (poses x cameras); of one time, all cameras of the first pose come first."""

    def __init__(self, content, run):
        self.content, self.run = content, run

    @classmethod
    def load(cls, path):
        """The job of a file. Paths in it are relative to its folder. Raises dspace.Error that names the file and the line."""
        path = path_of(path, "the path", "job", "the path of a TOML file")
        try:
            with open(path, "rb") as file:
                words = file.read().decode()
            values = tomllib.loads(words)
        except OSError as error:
            raise Io(f"job {path!r}: {error.strerror}; accepted: a file that can be read", path) from None
        except (UnicodeDecodeError, tomllib.TOMLDecodeError) as error:
            raise Corrupt(f"job {path!r}: {error}; accepted: TOML", path) from None
        return _Reader(path, words, values).job()

    @property
    def text(self):
        """The content as JSON. Equal jobs have equal texts."""
        return json.dumps(self.content, sort_keys=True, indent=1)

    @property
    def cameras(self):
        return self.content["cameras"]

    @property
    def total(self):
        """The number of pieces."""
        return len(self.content["times"]) * max(len(self.content["poses"]), 1) * len(self.cameras)

    def parts(self, number):
        """The time [s], the pose's number (None: there are none) and the camera's number of a piece."""
        number, camera = divmod(number, len(self.cameras))
        time, pose = divmod(number, max(len(self.content["poses"]), 1))
        return self.content["times"][time], pose if self.content["poses"] else None, camera

    def span(self, number):
        """The times [s], from the piece's own, of the first and the last state of the run that a piece shows."""
        _, _, index = self.parts(number)
        camera, shutter = self.cameras[index], self.content["shutter"]
        if camera["line_s"]:
            return 0.0, camera["line_s"] * (camera["model"]["model"]["height"] - 1)
        reach = 0.5 * (shutter["exposure_s"] + shutter["readout_s"]) if shutter else 0.0
        return -reach, reach

    @property
    def labels(self):
        """Whether labels are drawn: as a plane, or for annotations."""
        return "label" in self.content["planes"] or bool(self.content["categories"])


class _Reader:
    """Checks the values of a file."""

    def __init__(self, path, words, values):
        self.path, self.lines, self.values = path, words.splitlines(), values
        self.folder = os.path.dirname(os.path.abspath(path))

    def line(self, table="", index=0, key=None):
        """The line of a key in the index-th table of a name, or of the table itself; 1 where neither is there."""
        here, count, header = "", {}, None
        for number, line in enumerate(self.lines, 1):
            opened = re.match(r"\s*\[\[?\s*([\w.-]+)\s*\]\]?", line)
            if opened:
                here = opened[1]
                count[here] = count.get(here, -1) + 1
                if here == table and count[here] == index:
                    header = number
            elif key is not None and here == table and (not table or count[here] == index) and \
                    re.match(rf"\s*[\"']?{re.escape(key)}[\"']?\s*[.=]", line):
                return number
        return header or 1

    def reject(self, message, table="", index=0, key=None, kind=InvalidArgument):
        raise kind(f"job {self.path!r}, line {self.line(table, index, key)}: {message}", self.path)

    def guard(self, function, *where):
        """What a function returns; its error gets the line."""
        try:
            return function()
        except Error as error:
            raise type(error)(f"job {self.path!r}, line {self.line(*where)}: {error}", self.path) from None

    def table(self, values, accepted, table="", index=0):
        about = f"[[{table}]]" if table else "the job"
        if not isinstance(values, dict):
            self.reject(f"{about} is {values!r}; accepted: a table", table, index)
        for key, value in values.items():
            if key not in accepted:
                self.reject(f"unknown {key!r}; accepted: {', '.join(accepted)}", table, index, key)
            kinds = accepted[key] if isinstance(accepted[key], tuple) else (accepted[key],)
            if not isinstance(value, kinds) or isinstance(value, bool):
                self.reject(f"{key} is {value!r}; accepted: {' or '.join(WORDS.get(k, 'a number') for k in kinds)}", table, index,
                            key)
        return values

    def numbers(self, value, count, table, index, key):
        if len(value) != count or not all(isinstance(v, (int, float)) and not isinstance(v, bool) and np.isfinite(v)
                                          for v in value):
            self.reject(f"{key} is {value!r}; accepted: {count} finite numbers", table, index, key)
        return [float(v) for v in value]

    def job(self):
        values = self.table(self.values, TOP)
        for key in ("run", "times", "camera"):
            if key not in values:
                self.reject(f"there is no {'[[camera]]' if key == 'camera' else key}; accepted: a job with run, times and [[camera]]")
        run = os.path.join(self.folder, values["run"])
        script, _, function = run.rpartition(":")
        file = script if script.endswith(".py") and function.isidentifier() else run
        if not os.path.isfile(file):
            self.reject(f"run is {values['run']!r}: there is no such file; accepted: a recording, or FILE.py:NAME", key="run",
                        kind=Io)
        planes = values.get("planes", ["color"])
        sensor = self.sensor(values)
        known = [*PLANES, *(["counts"] if sensor else [])]
        for each in planes:
            if each not in known:
                self.reject(f"the plane {each!r} is unknown; accepted: {', '.join(known)}"
                            + ("" if sensor else ", and counts with a [sensor]"), key="planes")
        if not planes or len(set(planes)) != len(planes):
            self.reject(f"planes is {planes!r}; accepted: each plane once, at least one", key="planes")
        samples, exposure = values.get("samples", 2), values.get("exposure", 1.0)
        if not SAMPLES[0] <= samples <= SAMPLES[1]:
            self.reject(f"samples is {samples}; accepted: {SAMPLES[0]} to {SAMPLES[1]}", key="samples")
        if not 0 < exposure < float("inf"):
            self.reject(f"exposure is {exposure}; accepted: above 0, finite", key="exposure")
        floats = values.get("floats", "tif")
        if floats not in ("tif", "exr"):
            self.reject(f"floats is {floats!r}; accepted: 'tif', 'exr'", key="floats")
        masks = values.get("masks", "lists")
        if masks not in ("lists", "compressed"):
            self.reject(f"masks is {masks!r}; accepted: 'lists', 'compressed'", key="masks")
        content = {"scene": values.get("scene", ""), "times": self.times(values["times"]), "planes": list(planes),
                   "samples": samples, "exposure": float(exposure), "floats": floats, "masks": masks, "sensor": sensor,
                   "shutter": self.shutter(values, sensor),
                   "poses": self.each(values, "pose", self.pose), "cameras": self.each(values, "camera", self.camera),
                   "categories": self.each(values, "category", self.category)}
        for table, what in (("cameras", "camera"), ("categories", "category")):
            names = [each["name"] for each in content[table]]
            for index, name in enumerate(names):
                if name in names[:index]:
                    self.reject(f"there is another {what} {name!r}; accepted: other names", what, index, "name")
        for index, camera in enumerate(content["cameras"]):
            through = camera["through"]
            if content["poses"] and through:
                self.reject(f"camera {camera['name']!r} stands through {through!r}, and the job has [[pose]]; accepted: one of them",
                            "camera", index, "through")
        if (content["shutter"] or any(each["line_s"] for each in content["cameras"])) and file != run:
            self.reject(f"run is {values['run']!r}, which goes forward alone, and exposures and lines overlap; accepted: a recording",
                        key="run")
        for index, camera in enumerate(content["cameras"]):
            scans = camera["model"]["model"]["type"] == "line_scan"
            for given, what in ((content["shutter"], "[shutter]"), (content["poses"], "[[pose]]"), (camera["through"], "through")):
                if scans and given:
                    self.reject(f"camera {camera['name']!r} is a line scan, and the job has {what}; accepted: one of them, and the "
                                "model's own poses", "camera", index)
        job = Job(content, run)
        if job.total > MOST:
            self.reject(f"{job.total} images; accepted: up to {MOST} for each plane", key="times")
        job.where = self  # for errors that only the run shows
        return job

    def each(self, values, table, read):
        found = values.get(table, [])
        if not isinstance(found, list):
            self.reject(f"{table} is {found!r}; accepted: [[{table}]]", key=table)
        return [read(self.table(each, TABLES[table], table, index), index) for index, each in enumerate(found)]

    def times(self, times):
        if isinstance(times, dict):
            self.table(times, {key: (int, float) for key in ("first", "last", "step")})
            if set(times) != {"first", "last", "step"} or not times["step"] > 0 or not times["last"] >= times["first"]:
                self.reject(f"times is {times!r}; accepted: first, last and a step above 0, last not before first", key="times")
            count = int(np.floor((times["last"] - times["first"]) / times["step"] + 1e-9)) + 1
            if count > MOST:
                self.reject(f"{count} times; accepted: up to {MOST}", key="times")
            return [float(times["first"] + times["step"] * k) for k in range(count)]
        times = self.numbers(times, len(times), "", 0, "times")
        if not times or any(b <= a for a, b in zip(times, times[1:])):
            self.reject(f"times is {times!r}; accepted: rising times [s], at least one", key="times")
        return times

    def pose(self, values, index):
        where = "pose", index
        looks = "eye" in values or "target" in values
        if looks and not ("eye" in values and "target" in values and not {"position", "quaternion"} & set(values)):
            self.reject("eye and target, or position and quaternion, are not given alone", *where)
        if not looks:
            if "up" in values or "position" not in values:
                self.reject("there is no position; accepted: eye and target, or position and quaternion", *where)
            position = self.numbers(values["position"], 3, *where, "position")
            quaternion = self.numbers(values.get("quaternion", [1, 0, 0, 0]), 4, *where, "quaternion")
            pose = self.guard(lambda: Pose(position, quaternion), *where, "quaternion")
        else:
            eye, target, up = (np.array(self.numbers(values.get(key, [0, 0, 1]), 3, *where, key)) for key in ("eye", "target", "up"))
            z = target - eye
            x = np.cross(z, up)
            if not np.linalg.norm(z) > 0 or not np.linalg.norm(x) > 1e-9 * np.linalg.norm(z):
                self.reject("eye and target are one place, or up lies along the view; accepted: others", *where)
            z, x = z / np.linalg.norm(z), x / np.linalg.norm(x)
            pose = Pose(eye, quaternion_of_matrix(np.column_stack((x, np.cross(z, x), z))))
        return {"position": pose.position.tolist(), "quaternion": pose.quaternion.tolist()}

    def camera(self, values, index):
        where = "camera", index
        for key in ("name", "model"):
            if key not in values:
                self.reject(f"the camera has no {key}; accepted: a name and a model", *where)
        if not re.fullmatch(r"[\w-]{1,64}", values["name"]):
            self.reject(f"name is {values['name']!r}; accepted: 1 to 64 letters, digits, '_' and '-', as in names of files", *where,
                        "name")
        model = self.guard(lambda: CameraModel.read(os.path.join(self.folder, values["model"]), values.get("camera")), *where,
                           "model")
        if "size" in values:
            size = values["size"]
            model = self.guard(lambda: model.with_size(size) if model.size is None else model.scaled(size), *where, "size")
        if model.size is None:
            self.reject(f"camera {values['name']!r} has no size of its image; accepted: size = [width, height]", *where)
        if "frame" in values and "through" in values:
            self.reject("frame and through are given; accepted: one of them", *where, "through")
        line_s = float(values.get("line_s", 0.0))
        if not 0 <= line_s < float("inf") or line_s and model.type != "line_scan":
            self.reject(f"line_s is {line_s:g}; accepted: seconds from line to line, 0 or above, of a model of type line_scan", *where,
                        "line_s")
        return {"name": values["name"], "model": json.loads(model.json), "frame": values.get("frame", ""),
                "through": values.get("through", ""), "line_s": line_s}

    def category(self, values, index):
        for key in ("name", "objects"):
            if key not in values:
                self.reject(f"the category has no {key}; accepted: a name, and objects: patterns of names", "category", index)
        if not values["objects"] or not all(isinstance(each, str) for each in values["objects"]):
            self.reject(f"objects is {values['objects']!r}; accepted: patterns of names, such as 'rock *'", "category", index,
                        "objects")
        return {"name": values["name"], "objects": values["objects"]}

    def shutter(self, values, sensor):
        if "shutter" not in values:
            return None
        settings = dict(values["shutter"])
        accepted = ("exposure_s", "readout_s", "direction", "samples", "bands")
        for key in settings:
            if key not in accepted:
                self.reject(f"unknown {key!r}; accepted: {', '.join(accepted)}", "shutter", 0, key)
        exposed = sensor and sensor["settings"]["exposure_s"]
        if exposed:
            settings.setdefault("exposure_s", exposed)
        if "exposure_s" not in settings:
            self.reject("there is no exposure_s; accepted: exposure_s, here or in [sensor]", "shutter", 0)
        made = self.guard(lambda: Shutter(**settings), "shutter", 0)
        if exposed and made.exposure_s != exposed:
            self.reject(f"exposure_s is {made.exposure_s:g}; accepted: the sensor's, {exposed:g}", "shutter", 0, "exposure_s")
        return {key: getattr(made, key) for key in accepted}

    def sensor(self, values):
        if "sensor" not in values:
            return None
        settings = dict(values["sensor"])
        seed = settings.pop("seed", 0)
        if not isinstance(seed, int) or isinstance(seed, bool) or not 0 <= seed < 2**64:
            self.reject(f"seed is {seed!r}; accepted: 0 to 2**64 - 1", "sensor", 0, "seed")
        accepted = Sensor().settings
        for key in settings:
            if key not in accepted:
                self.reject(f"unknown {key!r}; accepted: seed, {', '.join(accepted)}", "sensor", 0, key)

        def made():
            return Sensor(**settings).settings
        return {"seed": seed, "settings": self.guard(made, "sensor", 0)}
