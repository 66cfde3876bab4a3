"""`dspace camera`: info, check, project, convert, render (one image or a data set)."""
import argparse
import json
import math
import sys

from dspace.command_line import Failed
from dspace.command_line.recorded import add_recording, recorded_scene

PLANES = ("color", "radiance", "depth", "range", "label", "lit_fraction", "incidence", "emission", "phase",
          "normal", "point")


def add_arguments(parser):
    commands = parser.add_subparsers(dest="what", metavar="WHAT", required=True)

    info = commands.add_parser("info", help="print the camera models of a file, or what an image says about its camera",
                               description="Prints the camera models of a file: name, type, size, frame, field of view. Of an "
                               "image that Dspace wrote (.png, .tif, .exr): plane, time, camera, pose and sensor.")
    info.add_argument("model", metavar="MODEL", help="a file of camera models, or an image")
    info.add_argument("--json", action="store_true", help="print JSON: a list of models")
    info.set_defaults(run=run_info)

    check = commands.add_parser(
        "check", help="say where a lens folds, and what its image covers",
        description="Prints where a lens folds the image, which part of the image sees nothing, and how the pixels are "
        "spread. The exit code is 1 where pixels of the image have no ray.")
    add_model(check)
    check.add_argument("--json", action="store_true", help="print JSON")
    check.set_defaults(run=run_check)

    project = commands.add_parser(
        "project", help="print pixels of points, and rays of pixels",
        description="Prints the pixels of points, and the rays of pixels: origin [m] and unit direction. Points and rays "
        "are in the model's frame.")
    add_model(project)
    project.add_argument("--point", type=numbers(3, "X,Y,Z"), action="append", default=[], metavar="X,Y,Z",
                         help="a point [m]; may be given several times")
    project.add_argument("--pixel", type=numbers(2, "U,V"), action="append", default=[], metavar="U,V",
                         help="a pixel; (0, 0) is the centre of the top-left one; may be given several times")
    project.add_argument("--camera-axes", action="store_true",
                         help="points and rays are in the camera's axes: X right, Y down, Z forward")
    project.add_argument("--json", action="store_true", help="print JSON")
    project.set_defaults(run=run_project)

    convert = commands.add_parser(
        "convert", help="write a model in another format, or as another type",
        description="Writes a model in the format of --out's ending: .json, .cahv, .cahvor, .cahvore, .yaml (OpenCV's), "
        ".cameramodel (mrcal's). With --type the nearest model of that type is fitted, and the residual is printed.")
    add_model(convert)
    convert.add_argument("--type", metavar="TYPE", help="brown, cahv, cahvor, cahvore, double_sphere, equidistant, eucm, "
                         "kannala_brandt, owen, pinhole, ucm (default: the model's own)")
    convert.add_argument("--scaled", type=size, metavar="WxH", help="for an image of this size and the same shape")
    convert.add_argument("--out", required=True, metavar="FILE")
    convert.set_defaults(run=run_convert)

    render = commands.add_parser(
        "render", help="draw what the camera sees of a recorded scene, or a data set of many images",
        description="Draws the image that a camera with a lens takes of a recorded scene. --out: .png (color), .tif or .exr (one "
        "plane), with the camera's model, pose and time in the file, or .npz (numpy; every plane of --plane). With a JOB.toml in "
        "place of MODEL: draws the images of a data set into the folder --out, with a manifest and labels; the same command "
        "continues one that was interrupted.")
    add_model(render)
    add_recording(render, render)
    pose = render.add_mutually_exclusive_group()
    pose.add_argument("--frame", metavar="PATH", help="the scene's frame in which the model's own pose is")
    pose.add_argument("--through", metavar="CAMERA", help="the scene's camera whose pose the lens takes")
    render.add_argument("--plane", action="append", choices=PLANES, default=[], metavar="PLANE",
                        help=f"one of {', '.join(PLANES)}; may be given several times (default: color)")
    render.add_argument("--samples", type=int, metavar="N", help="N x N per source pixel, 1 to 8 (default: 2)")
    render.add_argument("--exposure", type=float, metavar="X", help="factor on linear light of color (default: 1)")
    render.add_argument("--scaled", type=size, metavar="WxH", help="the size of the image, of the model's shape")
    render.add_argument("--jobs", type=jobs, metavar="N", help="of a data set: number of processes that draw, 1 to 64 (1)")
    render.add_argument("--scheduler", metavar="ADDRESS",
                        help="of a data set: a Dask scheduler whose workers draw: tcp://HOST:PORT or tls://...")
    render.add_argument("--redraw", action="store_true",
                        help="of a data set: draw all images, also those that an interrupted command left")
    render.add_argument("--out", required=True, metavar="FILE")
    render.set_defaults(run=run_render)


def add_model(parser):
    parser.add_argument("model", metavar="MODEL", help="a file of camera models: JSON, JPL's CAHV(OR(E)) text, a PDS3 or "
                        "VICAR label, OpenCV's YAML, mrcal's .cameramodel, a USGS ISD, a SPICE instrument kernel")
    parser.add_argument("--camera", metavar="NAME", help="the camera of this name, where the file has several")
    parser.add_argument("--size", type=size, metavar="WxH", help="the size of its image, where the file does not say")


def numbers(count, names):
    def read(text):
        try:
            values = tuple(float(part) for part in text.split(","))
        except ValueError:
            values = ()
        if len(values) != count or not all(map(math.isfinite, values)):
            raise argparse.ArgumentTypeError(f"'{text}'; accepted: {names}, {count} finite numbers")
        return values
    return read


def jobs(text):
    if not text.isdigit() or not 1 <= int(text) <= 64:
        raise argparse.ArgumentTypeError(f"'{text}'; accepted: 1 to 64")
    return int(text)


def size(text):
    try:
        width, height = (int(part) for part in text.lower().split("x"))
    except ValueError:
        width = height = 0
    if not all(1 <= side <= 10**6 for side in (width, height)):
        raise argparse.ArgumentTypeError(f"'{text}'; accepted: WIDTHxHEIGHT, each 1 to 1000000")
    return width, height


def model_of(options):
    import dspace
    model = dspace.CameraModel.read(options.model, options.camera)
    return model if options.size is None else model.with_size(options.size)


def run_info(options):
    import pathlib

    import dspace
    if pathlib.Path(options.model).suffix.lower() in (".png", ".tif", ".tiff", ".exr"):
        return run_image_info(options)
    models = dspace.CameraModel.read_all(options.model)
    if options.json:
        json.dump([json.loads(model.json) for model in models], sys.stdout, indent=2)
        print()
        return
    for model in models:
        print(described(model, options.model))


def run_image_info(options):
    """An image in place of a model: what was written about it."""
    import dspace
    from dspace.cameras.image_file import read_metadata
    told = read_metadata(options.model)
    if told is None:
        raise Failed(f"{options.model}: the image does not say how it was made; accepted: one that Dspace wrote with a camera")
    if options.json:
        json.dump(told, sys.stdout, indent=2, sort_keys=True)
        print()
        return
    unit = f" [{told['unit']}]" if told.get("unit") else ""
    print(f"{options.model}: {told.get('plane', 'image')}{unit} of scene {told.get('scene', '')!r} at {told.get('time_s', 0):g} s")
    if "camera" in told:
        print(described(dspace.CameraModel.from_json(json.dumps(told["camera"])), "camera"))
    if "pose" in told:
        place, turn = ((f"{each:.9g}" for each in told["pose"][key]) for key in ("position", "quaternion"))
        print(f"pose of the camera's axes in the root: position ({', '.join(place)}) m, quaternion w, x, y, z ({', '.join(turn)})")
    if "sensor" in told:
        print("sensor: " + ", ".join(f"{key} {value}" for key, value in told["sensor"].items()))


def described(model, file):
    """A model in one line."""
    parts = [model.type]
    if model.size:
        check = model.check()
        parts += [f"{model.size[0]} x {model.size[1]}", f"up to {check.half_angle_deg:.2f} deg from the axis",
                  f"{check.least_density:.2f} to {check.greatest_density:.2f} pixels/deg"]
        if check.without_ray:
            parts.append(f"{100 * check.without_ray:.2f} % of the image sees nothing")
    if model.frame:
        parts.append(f"in {model.frame} at ({', '.join(f'{each:.6g}' for each in model.position)}) m")
    return f"{model.name or file}: {', '.join(parts)}"


def run_check(options):
    model = model_of(options)
    check = model.check()
    if options.json:
        json.dump({"name": model.name, "type": model.type, "size": model.size, **check._asdict()}, sys.stdout, indent=2)
        print()
    else:
        end = f", up to {check.end}" if check.end else ""
        print(f"{model.name or options.model}: {model.type}, {model.size[0]} x {model.size[1]} pixels")
        print(f"one to one within {check.limit_deg:.4f} deg of the axis{end}")
        print(f"the image reaches {check.half_angle_deg:.4f} deg from the axis; {100 * check.without_ray:.3f} % of it sees "
              "nothing")
        print(f"{check.least_density:.4f} to {check.greatest_density:.4f} pixels/deg; the pupil moves by up to "
              f"{check.pupil_shift:.6g} m")
        print(f"pixel to ray to pixel: within {check.round_trip:.2g} pixels")
    return 1 if check.without_ray else 0


def run_project(options):
    if not options.point and not options.pixel:
        raise Failed("neither --point nor --pixel is given; accepted: at least one of them")
    model = model_of(options)
    pixels, rays = [], []
    if options.point:
        pixels = model.project(options.point, in_camera=options.camera_axes)
    if options.pixel:
        origins, directions = model.rays(options.pixel, in_camera=options.camera_axes)
        rays = list(zip(origins, directions))
    if options.json:
        def listed(array):
            return None if array[0] != array[0] else [float(each) for each in array]
        json.dump({"name": model.name, "frame": "camera" if options.camera_axes else model.frame,
                   "points": [{"point": list(p), "pixel": listed(q)} for p, q in zip(options.point, pixels)],
                   "pixels": [{"pixel": list(p), "origin": listed(o), "direction": listed(d)}
                              for p, (o, d) in zip(options.pixel, rays)]}, sys.stdout, indent=2)
        print()
        return
    for point, pixel in zip(options.point, pixels):
        where = "not seen" if pixel[0] != pixel[0] else f"{pixel[0]:.9f} {pixel[1]:.9f}"
        print(f"{','.join(f'{each:g}' for each in point)}: {where}")
    for pixel, (origin, direction) in zip(options.pixel, rays):
        where = "no ray" if origin[0] != origin[0] else (" ".join(f"{each:.9f}" for each in origin) + "  "
                                                         + " ".join(f"{each:.12f}" for each in direction))
        print(f"{','.join(f'{each:g}' for each in pixel)}: {where}")


def run_convert(options):
    model = model_of(options)
    if options.scaled is not None:
        model = model.scaled(options.scaled)
    residual = ""
    if options.type is not None:
        model, rms, greatest, covered, shift = model.convert(options.type)
        residual = f", residual {rms:.6g} pixels rms, {greatest:.6g} at most, over {100 * covered:.2f} % of the image"
        if shift:
            residual += f"; a pupil that moves by up to {shift:.6g} m is lost"
    model.save(options.out)
    print(f"{options.out}: {model.type}{residual}")


def run_render(options):
    import pathlib
    if pathlib.Path(options.model).suffix.lower() == ".toml":
        return run_dataset(options)
    given = [f"--{name}" for name in ("jobs", "scheduler", "redraw") if getattr(options, name)]
    if given:
        raise Failed(f"{given[0]} is given without a JOB.toml; accepted: for data sets")
    if options.recording is None or (options.frame is None) == (options.through is None):
        raise Failed("accepted: --recording FILE, and one of --frame PATH and --through CAMERA; or a JOB.toml")
    return render_one(options)


def run_dataset(options):
    """A job in place of a model."""
    from dspace.command_line.movie import Bar
    from dspace.datasets.job import Job
    from dspace.datasets.make import make
    for name in ("camera", "size", "recording", "at", "scene", "frame", "through", "plane", "samples", "exposure", "scaled"):
        if getattr(options, name) not in (None, []):
            raise Failed(f"--{name} is given with a job; accepted: in the job, {options.model}")
    job = Job.load(options.model)
    bar = Bar(sys.stderr)
    try:
        drawn = make(job, options.out, jobs=options.jobs or 1, scheduler=options.scheduler, progress=bar.show, redraw=options.redraw)
    except KeyboardInterrupt:
        bar.end()
        print("dspace: interrupted; run the same command again to continue", file=sys.stderr)
        return 130
    bar.end()
    before = job.total - drawn
    print(f"{options.out}: {job.total} images of {len(job.cameras)} cameras, each of {', '.join(job.content['planes'])}"
          + (f"; {before} were there" if before else ""))


def render_one(options):
    import io
    import pathlib

    import numpy as np

    from dspace._core.files import atomic_write
    planes = options.plane or ["color"]
    ending = pathlib.Path(options.out).suffix.lower()
    if ending not in (".png", ".npz", ".tif", ".tiff", ".exr") or ending == ".png" and planes != ["color"] \
            or ending == ".exr" and planes == ["color"] or ending != ".npz" and len(planes) > 1:
        raise Failed(f"--out '{options.out}': accepted: .png for color, .tif for one plane, .exr for one plane but color, .npz for any "
                     "planes")
    model = model_of(options)
    settings = {"samples": 2 if options.samples is None else options.samples,
                "exposure": 1.0 if options.exposure is None else options.exposure}
    with recorded_scene(options) as scene:
        settings.update(camera=options.through, frame=options.frame, size=options.scaled, scale=options.scaled is not None)
        if ending != ".npz":
            lens = scene.save_image(options.out, model, plane=planes[0], **settings)
            width, height = model.size if options.scaled is None else options.scaled
        else:
            picture = scene.simulate_image(model, **settings, **{"color": False, **{plane: True for plane in planes}})
            lens = picture.pop("lens")
            data = io.BytesIO()
            np.savez_compressed(data, model=np.array(model.json), **picture)
            atomic_write(options.out, data.getvalue())
            height, width = next(iter(picture.values())).shape[:2]
    shift = f"; the pupil moves by up to {lens.pupil_shift:.3g} m, {lens.pupil_pixels:.2f} pixels" if lens.pupil_shift else ""
    print(f"{options.out}: {width} x {height} pixels from {lens.source_views} source views of {lens.source_pixels} pixels; "
          f"{lens.without_ray} pixels see nothing{shift}")
