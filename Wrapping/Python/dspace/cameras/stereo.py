"""Stereo pairs: their pictures, rectified, and what disparities mean."""
import math

import numpy as np

from dspace._core.fields import array_of, flag, integers, number, numbers, reject
from dspace._core.strict import Strict
from dspace.cameras.camera import Camera
from dspace.cameras.matching import grey_of, match
from dspace.cameras.model import CameraModel
from dspace.cameras.resample import resample
from dspace.errors import WrongType
from dspace.frames.poses import Pose, quaternion_of_matrix

ROWS = 64  # of directions projected at a time
FLAT_DEG = 80.0  # a picture's borders count within this angle of the rectified axis, when its middle is chosen
FAR = 1e6  # baselines: where directions of lenses whose pupil moves are taken


class StereoPair(Strict):
    """Two cameras that look at the same things, with poses in one frame M. Immutable.

        pair = dspace.StereoPair(dspace.CameraModel.read("cameras.json", "NCAML"), dspace.CameraModel.read("cameras.json", "NCAMR"))
        left, right = pair.capture(scene, frame=rover)
        pictures = pair.rectify(left["color"], right["color"])
        disparity = pair.match(*pictures, nearest=2.0)
        points = pair.points(disparity)  # (h, w, 3) in M

    left, right: CameraModels of any type, whose poses are in one frame; or without `right` the baseline [m], by which the right
    camera is the left one moved along its X axis.

    Rectified pictures are those of two pinholes at the cameras' places, `rectified.left` and `rectified.right`, whose X axis
    lies along the baseline, and whose Z axis is as near as can be to the mean of both cameras'. A thing is in the same row of
    both. focal [pixels], center (cx, cy) and size (w, h): of the pinholes; default: the left camera's pixels per radian at the
    rectified axis, the size of its image, and the middle that both images share.

    Raises dspace.InvalidArgument for cameras at one place, a right camera that is to the left or before, and axes that a lens does
    not see."""

    def __init__(self, left, right=None, baseline=None, focal=None, size=None, center=None):
        about = "stereo pair"
        for model, what in ((left, "the left camera"), (left if right is None else right, "the right camera")):
            if not isinstance(model, CameraModel):
                reject(about, what, model, "a dspace.CameraModel", WrongType)
        if (right is None) == (baseline is None):
            reject(about, "right and baseline", (right, baseline), "one of them")
        if right is None:
            baseline = number(baseline, "the baseline", about)
            if not 0 < baseline < math.inf:
                reject(about, "the baseline", baseline, "above 0, finite metres")
            right = left.moved(Pose(baseline * left.rotation[:, 0]), left.frame)
        if left.frame != right.frame:
            reject(about, "the frame of the right camera", right.frame, f"that of the left one, {left.frame!r}")
        for model, what in ((left, "left"), (right, "right")):
            if model.size is None:
                reject(about, f"the size of the {what} camera's image", None, "a model with a size (with_size)")
        self._left, self._right = left, right
        self._turn = self._axes(about)
        self._maps = None
        shape = self._shape(focal, size, center, about)
        quaternion = quaternion_of_matrix(self._turn)
        self._rectified = tuple(
            CameraModel("pinhole", size=shape["size"], name=f"{model.name} rectified".strip(), frame=model.frame,
                        focal=(shape["focal"],) * 2, center=shape["center"], position=model.position, quaternion=quaternion)
            for model in (left, right))
        self._focal, self._center, self._size = shape["focal"], shape["center"], shape["size"]

    def _axes(self, about):
        """R_MR, whose columns are the axes of the rectified cameras."""
        x = self._right.position - self._left.position
        length = np.linalg.norm(x)
        if not length > 0:
            reject(about, "the place of the right camera", self._right.position.tolist(), "another than the left one's")
        x /= length
        for model, what in ((self._left, "left"), (self._right, "right")):
            if not x @ model.rotation[:, 0] > 0.5:
                angle = math.degrees(math.acos(max(-1.0, min(1.0, x @ model.rotation[:, 0]))))
                reject(about, f"the angle between the baseline and the X axis of the {what} camera", f"{angle:.1f} deg",
                       "below 60 deg: the right camera stands to the right of the left one")
        z = self._left.rotation[:, 2] + self._right.rotation[:, 2]
        z -= (z @ x) * x
        if not np.linalg.norm(z) > 1e-3:
            reject(about, "the axes of the cameras", "along the baseline, or opposite", "axes that look the same way")
        z /= np.linalg.norm(z)
        return np.column_stack((x, np.cross(z, x), z))

    def _shape(self, focal, size, center, about):
        """Focal length, size and center of the rectified pictures."""
        size = self._left.size if size is None else tuple(integers(size, 2, "the size", about, "(width, height) in pixels"))
        if not all(16 <= each <= 32768 for each in size):
            reject(about, "the size", size, "16 to 32768 pixels a side")
        if focal is None:
            far = FAR * self.baseline
            pixel, slope = self._left.project(self._left.position + far * self._turn[:, 2], derivatives=True)
            focal = math.sqrt(abs(np.linalg.det(far * slope @ self._turn[:, :2])))
            if not math.isfinite(focal):
                reject(about, "the rectified axis", self._turn[:, 2].round(6).tolist(), "a direction that the left lens sees, "
                       "or a focal length")
        focal = number(focal, "the focal length", about)
        if not 0 < focal < math.inf:
            reject(about, "the focal length", focal, "above 0, finite pixels")
        if center is None:
            middles = [self._middle(model) for model in (self._left, self._right)]
            center = (np.array(size) - 1) / 2 - focal * np.mean(middles, axis=0)
        center = numbers(center, 2, "the center", about)
        if not np.isfinite(center).all():
            reject(about, "the center", center.tolist(), "2 finite numbers")
        return {"focal": focal, "size": size, "center": center}

    def _middle(self, model):
        """The middle of an image on the plane Z = 1 of the rectified axes."""
        width, height = model.size
        u, v = np.linspace(0, width - 1, 65), np.linspace(0, height - 1, 65)
        _, rays = model.rays(np.stack(np.meshgrid(u, v), axis=-1))
        rays = rays.reshape(-1, 3) @ self._turn
        with np.errstate(invalid="ignore"):
            rays = rays[rays[:, 2] > math.cos(math.radians(FLAT_DEG))]
        if not len(rays):
            return np.zeros(2)
        plane = rays[:, :2] / rays[:, 2:]
        return 0.5 * (plane.min(axis=0) + plane.max(axis=0))

    @property
    def left(self):
        return self._left

    @property
    def right(self):
        return self._right

    @property
    def baseline(self):
        """The distance between the cameras [m]."""
        return float(np.linalg.norm(self._right.position - self._left.position))

    @property
    def rectified(self):
        """The StereoPair of the two pinholes; of a pair that was made from them, an equal one."""
        return StereoPair(*self._rectified, focal=self._focal, size=self._size, center=self._center)

    @property
    def calibration(self):
        """A dict for JSON: baseline [m]; left and right models; of the rectified pictures size, focal, center [pixels] and
        rotation (their axes in M, as columns), and Q, the 4 x 4 matrix of OpenCV's reprojectImageTo3D()."""
        import json
        f, (cx, cy), b = self._focal, self._center, self.baseline
        return {"baseline": b, "left": json.loads(self._left.json), "right": json.loads(self._right.json),
                "rectified": {"size": list(self._size), "focal": f, "center": [float(cx), float(cy)],
                              "rotation": self._turn.tolist(),
                              "Q": [[1, 0, 0, -float(cx)], [0, 1, 0, -float(cy)], [0, 0, 0, f], [0, 0, 1 / b, 0]]}}

    def moved(self, pose, frame=""):
        """The pair with its poses in another frame N. pose: X_NM, of scale 1. frame: the name of N."""
        return StereoPair(self._left.moved(pose, frame), self._right.moved(pose, frame), focal=self._focal, size=self._size,
                          center=self._center)

    # --- Pictures ------------------------------------------------------------------------------

    def capture(self, scene, frame=None, camera=None, **planes):
        """What both cameras see of a scene at its time: two dicts of planes, as Scene.simulate_image() makes them.

        frame: the scene's frame that is M, such as a rover's body; or camera: a Camera of the scene, whose axes the left
        camera's become. planes and the other arguments: as for simulate_image()."""
        about = "stereo pair"
        if (frame is None) == (camera is None):
            reject(about, "frame and camera", (frame, camera), "one of them")
        models = self._left, self._right
        if camera is not None:
            if not isinstance(camera, Camera):
                reject(about, "the camera", camera, "a dspace.Camera of the scene", WrongType)
            # X_GM: the left camera's pose in M, undone, then the scene's camera.
            turn = self._left.rotation.T
            pose = camera.pose_in() @ Pose(-turn @ self._left.position, quaternion_of_matrix(turn))
            models, frame = [model.moved(pose) for model in models], scene.root
        return tuple(scene.simulate_image(model, frame=frame, **planes) for model in models)

    def rectify(self, left, right, nearest=False):
        """Two images (h, w, ...) of the cameras as the rectified pinholes would have taken them. Light is interpolated between
        pixels; nearest=True takes the nearest pixel, for labels and depths. Where a lens sees nothing: 0, or NaN of floats."""
        nearest = flag(nearest, "nearest", "stereo pair")
        if self._maps is None:
            self._maps = tuple(self._map(model) for model in (self._left, self._right))
        out = []
        for image, model, pixels, what in zip((left, right), (self._left, self._right), self._maps, ("left", "right")):
            image = np.asarray(image)
            if image.ndim < 2 or image.shape[1::-1] != model.size:
                reject("stereo pair", f"the shape of the {what} image", image.shape, f"(h, w, ...) with w, h of {model.size}")
            out.append(resample(image, pixels, nearest))
        return tuple(out)

    def _map(self, model):
        """Pixels (h, w, 2) of a camera for the pixels of its rectified picture."""
        width, height = self._size
        out = np.empty((height, width, 2))
        for top in range(0, height, ROWS):
            rays = self._rays(np.arange(top, min(top + ROWS, height)))
            out[top:top + ROWS] = model.project(model.position + FAR * self.baseline * (rays @ self._turn.T))
        return out

    def _rays(self, rows):
        """Directions (rows, w, 3) with Z = 1 of rectified pixels, in the rectified axes."""
        u, v = np.meshgrid(np.arange(self._size[0]), rows)
        return np.stack(((u - self._center[0]) / self._focal, (v - self._center[1]) / self._focal, np.ones(u.shape)), axis=-1)

    # --- Disparities ---------------------------------------------------------------------------

    def match(self, left, right, nearest, window=None, method=None):
        """Disparity (h, w) [pixels], float32, of the left rectified picture; NaN: not found. nearest: the least depth [m] that
        is looked for. Other arguments: as for dspace.cameras.matching.match()."""
        nearest = number(nearest, "nearest", "stereo pair")
        if not 0 < nearest < math.inf:
            reject("stereo pair", "nearest", nearest, "above 0, finite metres")
        most = max(math.ceil(self._focal * self.baseline / nearest), 1)
        return match(left, right, (0, most), window, method)

    def disparity(self, depth):
        """The disparity [pixels] of a depth along Z of the rectified axes [m]."""
        with np.errstate(divide="ignore"):
            return self._focal * self.baseline / np.asarray(depth, float)

    def depth(self, disparity):
        """Metres along Z of the rectified axes; infinite where the disparity is 0 or less, NaN where it is NaN."""
        disparity = array_of(disparity, "the disparity", "an array of pixels", "stereo pair")
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where(disparity <= 0, np.inf, self._focal * self.baseline / disparity)

    def range(self, disparity):
        """Metres from the left camera, of a disparity image (h, w)."""
        depth = self._image(disparity)
        return depth * np.linalg.norm(self._rays(np.arange(self._size[1])), axis=-1)

    def points(self, disparity, in_camera=False):
        """Points (h, w, 3) [m] of a disparity image (h, w), in M, or with in_camera=True in the rectified axes of the left
        camera; NaN where there is no disparity above 0."""
        depth = self._image(disparity)
        depth = np.where(np.isfinite(depth), depth, np.nan)
        points = depth[..., None] * self._rays(np.arange(self._size[1]))
        return points if flag(in_camera, "in_camera", "stereo pair") else self._left.position + points @ self._turn.T

    def _image(self, disparity):
        depth = self.depth(disparity)
        if depth.shape != self._size[::-1]:
            reject("stereo pair", "the disparity's shape", depth.shape, f"(h, w) = {self._size[::-1]}")
        return depth

    @staticmethod
    def anaglyph(left, right):
        """A picture (h, w, 3) uint8 for glasses of red (left eye) and cyan, of two pictures (h, w) or (h, w, 3 or 4) uint8."""
        left, right = (grey_of(each) for each in (left, right))
        if left.shape != right.shape:
            reject("anaglyph", "the right picture's shape", right.shape, f"that of the left one, {left.shape}")
        left, right = (np.clip(np.rint(each), 0, 255).astype(np.uint8) for each in (left, right))
        return np.stack((left, right, right), axis=-1)

    def __eq__(self, other):
        return isinstance(other, StereoPair) and self.calibration == other.calibration

    def __hash__(self):
        return hash((self._left, self._right, self._focal))

    def __repr__(self):
        return (f"<dspace.StereoPair, baseline {self.baseline:g} m, rectified {self._size[0]} x {self._size[1]}, "
                f"focal {self._focal:.6g} pixels>")
