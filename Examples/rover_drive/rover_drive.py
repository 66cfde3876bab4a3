"""A rover drives a curved path over terrain, seen through four viewports of one scene.

Makes, in the folder given by --out: demo.mp4 (the four views tiled), one PNG a viewport, a contact
sheet and report.txt. The simulation runs at 60 steps a second, the movie at 30 frames a second.
"""
import argparse
import contextlib
import pathlib
import sys
import time
import warnings

import numpy as np

import dspace
from dspace._core.files import atomic_write
from dspace.movies.encode import Encoder
from dspace.rover import Path, load_vehicle
from dspace.shipped.field import add_field, floor_of_ruts, roll
from dspace.links.serving import ServerProcess

from movie import save_image, tile
from vehicle import Ground, PlacedVehicle
from views import Views

STEPS_PER_SECOND = 60
STEPS_PER_FRAME = 2
DATA = pathlib.Path(__file__).resolve().parents[2] / "Data"


def read_size(text):
    try:
        width, height = (int(v) for v in text.lower().split("x"))
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}' is no size; accepted: WIDTHxHEIGHT, as 1280x720")
    if not (64 <= width <= 7680 and 64 <= height <= 4320) or width % 4 or height % 4:
        raise argparse.ArgumentTypeError(
            f"'{text}': accepted are 64x64 to 7680x4320, both multiples of 4")
    return width, height


def read_seconds(text):
    seconds = float(text)
    if not 0.1 <= seconds <= 3600:
        raise argparse.ArgumentTypeError(f"'{text}': accepted are 0.1 to 3600 seconds")
    return seconds


def arguments():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--terrain", type=pathlib.Path, default=DATA / "field" / "field.tif",
                        help="heights: any raster that GDAL opens (default: the cratered field)")
    parser.add_argument("--image", type=pathlib.Path, help="an image to drape over the terrain")
    parser.add_argument("--mode", choices=("clipmap", "triangles"), default="clipmap",
                        help="how the terrain is drawn (default: clipmap, for rasters of any size)")
    parser.add_argument("--vertical-scale", type=float, default=None,
                        help="metres a unit of height, where the file does not say")
    parser.add_argument("--pixel-size", type=float, default=None,
                        help="metres a pixel, where the file has no georeference (else 1 is taken)")
    parser.add_argument("--model", type=pathlib.Path, default=DATA / "rover" / "rover.urdf",
                        help="URDF, frames.json, glTF/GLB, VRML, OBJ, STL or PLY (default: the rover)")
    parser.add_argument("--scale", type=float, default=1.0,
                        help="metres a unit of the model; for a URDF keep 1 (default)")
    parser.add_argument("--up", choices=("y", "z"), default=None,
                        help="the model file's upward axis (default: the format's own)")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("out/demo"))
    parser.add_argument("--seconds", type=read_seconds, default=12.0)
    parser.add_argument("--size", type=read_size, default=(1280, 720),
                        help="of the movie, WIDTHxHEIGHT (default 1280x720)")
    parser.add_argument("--served", action="store_true",
                        help="the scene is in a server process of its own, driven over the wire")
    parser.add_argument("--record", type=pathlib.Path, metavar="FILE",
                        help="records the session into a new file, for `dspace play`")
    options = parser.parse_args()
    return options


@contextlib.contextmanager
def open_session(options):
    """A session here, or in a server process that is ended with it."""
    if not options.served:
        with dspace.Session() as session:
            with session.record(options.record) if options.record else contextlib.nullcontext():
                yield session
        return
    files = [options.terrain, options.model] + ([options.image] if options.image else [])
    roots = {DATA} | {file.resolve().parent for file in files} | {options.out.resolve()}
    with ServerProcess(sorted(roots), record=options.record) as server, \
            dspace.connect(server.address, name="rover_drive") as session:
        print(f"dspace demo: served by process {server.pid} at {server.address}", flush=True)
        yield session


def of_shipped_field(options):
    return options.terrain.resolve() == (DATA / "field" / "field.tif").resolve()


def in_detail(options):
    """Whether the drive is on the shipped field with its detail, in which wheels leave ruts."""
    given = (options.image, options.vertical_scale, options.pixel_size)
    return of_shipped_field(options) and options.mode == "clipmap" and all(value is None for value in given)


def route(options, terrain, length):
    """Way points: the shipped route on the shipped field, else an S about the terrain's middle."""
    if of_shipped_field(options):
        import json
        with open(DATA / "field" / "route.json") as file:
            return np.array(json.load(file)["way_points_m"], float)
    west, east, south, north = terrain.extent
    reach = min(0.2 * min(east - west, north - south), 6.0 * length)
    shape = reach * np.array([(-1, -0.35), (-0.5, 0.05), (0, 0), (0.5, -0.05), (1, 0.35)])
    # Of places about the middle, then of all places, the nearest that a rover climbs, else the most level one; where
    # holes leave no room, a shorter route.
    whole = shape
    for shrink, steps in ((1, np.linspace(-0.25, 0.25, 11)), (1, np.linspace(-0.45, 0.45, 37)),
                          (0.5, np.linspace(-0.45, 0.45, 37)), (0.25, np.linspace(-0.45, 0.45, 37))):
        shape = shrink * whole
        places = np.array([(0.5 * (west + east) + u * (east - west), 0.5 * (south + north) + v * (north - south))
                           for u in steps for v in steps])
        places = places[~holes(terrain, places, shape, length)]
        if len(places):
            break
    else:
        raise ValueError(f"{options.terrain}: no place has data under a route of {0.5 * reach:.3g} m; accepted: a raster "
                         "with fewer holes (gdal_fillnodata.py fills them)")
    line = places[:, None, :] + shape[None, :, :]
    slopes = np.nan_to_num(terrain.slope_deg(line[..., 0], line[..., 1]), nan=90.0).max(axis=1)
    distance = np.hypot(*(places - 0.5 * np.array([west + east, south + north])).T)
    order = np.lexsort((distance, np.maximum(slopes, 12.0)))
    return places[order[0]] + shape


def holes(terrain, places, shape, length):
    """Whether ground is missing within a vehicle's length of the route at each place."""
    way = Path(shape, speed=1.0)
    along = np.column_stack(way.sample(np.linspace(0, way.length, 25))[:2])
    beside = length * np.array([(0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)])
    at = places[:, None, :] + (along[:, None] + beside).reshape(-1, 2)
    return ~np.isfinite(terrain.height(at[..., 0], at[..., 1])).all(axis=1)


def show_coarse(options, terrain, length):
    """On ground whose posts are farther apart than the vehicle is long: lines that show its slope, and a note."""
    west, east, _, _ = terrain.extent
    post = (east - west) / max(terrain.size[0] - 1, 1)
    if options.mode != "clipmap" or post < 2.0 * length:
        return
    print(f"dspace demo: note: the heights of {options.terrain.name} are {post:.3g} m apart and the vehicle is "
          f"{length:.3g} m long, so that it stands on one flat facet, whose slope contours show. For relief "
          f"give heights less than {length:.2g} m apart"
          + ("." if options.model.suffix.lower() == ".urdf" else f", or a model as large with --scale {post / length:.2g}."),
          file=sys.stderr)
    interval = 10.0 ** np.floor(np.log10(length / 4))
    terrain.set_style(contours={"interval": float(interval), "color": "#5a4632", "width": 1.2})


def main():
    options = arguments()
    warnings.showwarning = lambda message, *_: print(f"dspace demo: note: {message}", file=sys.stderr)
    for path in (options.terrain, options.model):
        if not path.exists():
            sys.exit(f"dspace demo: there is no file {path}")
    options.out.mkdir(parents=True, exist_ok=True)
    began = time.perf_counter()
    with open_session(options) as session:
        scene = session.scene("demo")
        terrain = add_terrain(scene, options)
        description = load(scene, options)
        length = description.length
        way_points = route(options, terrain, length)
        way = Path(way_points, speed=1.0, ramp=1.0)
        # The whole route in the time asked for, but no faster than a rover's brisk pace.
        speed = min(way.length / max(options.seconds - 1.0, 0.5), 0.6 * length)
        way = Path(way_points, speed=speed, ramp=1.0)
        steps = int(round(options.seconds * STEPS_PER_SECOND))
        times = np.arange(steps + 1) / STEPS_PER_SECOND
        route_line = np.column_stack(way.sample(np.linspace(0, way.length, 400))[:2])
        show_coarse(options, terrain, length)
        terrain.focus(route_line[::8], radius=1.5 * length)
        ground = Ground(terrain)
        ruts = in_detail(options) and description.wheeled
        below = floor_of_ruts(terrain, route_line, reach=2.0 * length) if ruts else ground
        states = description.vehicle.drive(way, times, below)
        placed = PlacedVehicle(scene, description)
        placed.move(states[0], pan_deg=0.0)
        views = Views(scene, placed, terrain, options.size, way_points[-1], route_line, ground, in_detail(options))
        print(f"dspace demo: {description.vehicle!r} on {terrain!r}; "
              f"set up in {time.perf_counter() - began:.1f} s", flush=True)

        worst = 0.0
        with Encoder(options.out / "demo.mp4", options.size, STEPS_PER_SECOND / STEPS_PER_FRAME,
                     quick=True) as movie:
            sheet = []
            drawn = time.perf_counter()
            frames = steps // STEPS_PER_FRAME + 1
            for step, state in enumerate(states):
                scene.time = state.time
                placed.move(state, pan_deg=40.0 * np.sin(2 * np.pi * state.time / 8.0))
                views.update(state)
                if ruts:
                    roll(terrain, description.vehicle, [state])
                if step % STEPS_PER_FRAME:
                    continue
                worst = max(worst, off_ground(state, ground))
                pictures = views.pictures()
                movie.add(tile(pictures))
                frame = step // STEPS_PER_FRAME
                if frame in {round(i * (frames - 1) / 8) for i in range(9)}:
                    sheet.append(tile(pictures))
                if frame == frames * 2 // 3:
                    views.save(options.out)
                if sys.stderr.isatty() and frame % 10 == 0:
                    print(f"\r  frame {frame} of {frames}", end="", file=sys.stderr, flush=True)
            drawn = time.perf_counter() - drawn
        if sys.stderr.isatty():
            print("\r" + " " * 40 + "\r", end="", file=sys.stderr)
        save_image(options.out / "contact_sheet.png", contact_sheet(sheet))
        report(options, session, terrain, description, views, way, states, frames, drawn, worst)


def off_ground(state, ground):
    """[m] by which the lowest point of a wheel misses the ground that is drawn, ruts included."""
    if not state.contacts:
        return 0.0
    contacts = np.array(list(state.contacts.values()))
    return float(np.abs(contacts[:, 2] - ground.heights(contacts[:, :2])).max())


def add_terrain(scene, options):
    if in_detail(options):
        return add_field(scene, DATA / "field")
    settings = {"mode": options.mode}
    if options.mode == "triangles":
        settings["triangles"] = 60000  # a software renderer draws them twenty times a second
    if options.image:
        settings["image"] = options.image
    elif of_shipped_field(options):
        settings["image"] = DATA / "field" / "field_color.tif"
    else:
        settings["color"] = (0.58, 0.54, 0.49)
    if options.vertical_scale is not None:
        settings["vertical_scale"] = options.vertical_scale
    if options.pixel_size is not None:
        settings["pixel_size"] = options.pixel_size
    return scene.add_terrain(options.terrain, name="terrain", **settings)


def load(scene, options):
    from vehicle import Described
    return Described(scene, options.model, options.scale, options.up)


def contact_sheet(pictures, columns=3, width=480):
    small = []
    for picture in pictures:
        step = max(picture.shape[1] // width, 1)
        h, w = picture.shape[0] // step * step, picture.shape[1] // step * step
        blocks = picture[:h, :w].reshape(h // step, step, w // step, step, 3)
        small.append(blocks.mean(axis=(1, 3)).astype(np.uint8))
    while len(small) % columns:
        small.append(np.zeros_like(small[0]))
    rows = [np.hstack(small[i:i + columns]) for i in range(0, len(small), columns)]
    return np.vstack(rows)


def drawn_how(terrain):
    if terrain.mode == "triangles":
        return f"{terrain.triangles} triangles of the terrain, every post about the route"
    tiles = terrain.tiles
    return (f"a clipmap of {tiles['levels']} levels over {terrain.size[0]} x {terrain.size[1]} posts; "
            f"{tiles['bytes'] / 2**20:.1f} MiB of tiles in memory, {tiles['loads']} read")


def report(options, session, terrain, described, views, way, states, frames, drawn, worst):
    triangles, of_terrain = views.triangles(session)
    median, most = views.screen_error(states[-1])
    lines = [
        f"model       {options.model.name}: {described.vehicle!r}",
        f"terrain     {options.terrain.name}: {terrain!r}",
        f"path        {way.length:.1f} m long, {states[-1].time:.1f} s at 60 steps a second",
        f"tilt        at most {max(s.tilt_deg for s in states):.1f} deg",
        f"wheels      at most {1000 * worst:.2f} mm from the ground that is drawn"
        if described.wheeled else "carried     on the ground under its footprint",
        f"frames      {frames} of four viewports, {options.size[0]} x {options.size[1]} together",
        f"rate        {frames / drawn:.1f} frames a second, drawing, reading back and encoding",
        f"renderer    {session.statistics['renderer']}",
        f"drawn       {drawn_how(terrain)}",
        "triangles   " + ", ".join(f"{name} {count}" for name, count in triangles.items())
        + f"; of them terrain in all {of_terrain}",
        f"ground      drawn within {median:.2g} pixels of the height query in half of a view from behind "
        f"the rover, within {most:.2g} in 99 % of it",
    ]
    atomic_write(options.out / "report.txt", ("\n".join(lines) + "\n").encode())
    print("\n".join("  " + line for line in lines))
    print("made:")
    for path in sorted(options.out.iterdir()):
        print(f"  {path}")


if __name__ == "__main__":
    try:
        main()
    except (dspace.Error, ValueError, OSError) as error:
        sys.exit(f"dspace demo: {error}")
