"""`dspace ephemeris`: states of bodies and spacecraft."""
import csv
import json
import sys

from dspace.command_line import Failed, lazy

np = lazy("numpy")

MOST_TIMES = 10_000_000


def add_arguments(parser):
    parser.add_argument("target", metavar="TARGET", help="a name or NAIF id: moon, mars, -82")
    parser.add_argument("--observer", default="earth", metavar="BODY", help="from which it is seen (default: earth)")
    parser.add_argument("--time", required=True, metavar="T0[,T1,STEP]",
                        help="UTC in ISO 8601, or with ' TDB', ' TT' or ' TAI' behind it; with T1 and a step in seconds, "
                        "times from T0 to T1")
    parser.add_argument("--frame", default="J2000", metavar="F", help="the reference frame of the state (default: J2000)")
    parser.add_argument("--correction", default="NONE", choices=("NONE", "LT", "LT+S", "CN", "CN+S"))
    parser.add_argument("--kernel", action="append", nargs="+", default=[], metavar="FILE",
                        help="SPICE kernels; may be given several times, later ones are asked first")
    form = parser.add_mutually_exclusive_group()
    form.add_argument("--csv", action="store_true")
    form.add_argument("--json", action="store_true")
    parser.set_defaults(run=run)


def run(options):
    import dspace
    parts = options.time.split(",")
    if len(parts) not in (1, 3):
        raise Failed(f"--time {options.time!r}: accepted: T0, or T0,T1,STEP")
    with dspace.Session() as session:
        scene = session.scene()
        if options.kernel:
            scene.kernels.load(*(each for group in options.kernel for each in group))
        times = scene.tdb(parts[:2])
        if len(parts) == 3:
            try:
                step = float(parts[2])
            except ValueError:
                step = 0.0
            if not (step > 0.0 and times[1] >= times[0] and (times[1] - times[0]) / step < MOST_TIMES):
                raise Failed(f"--time {options.time!r}: accepted: T1 not before T0, a step above 0 s, and fewer than "
                             f"{MOST_TIMES} times")
            times = times[0] + step * np.arange(int(np.floor((times[1] - times[0]) / step + 1e-6)) + 1)
        states = scene.ephemeris(options.target, options.observer, times, options.frame, options.correction)
        rows = [(scene.utc(float(t), 3), float(t), *map(float, p), *map(float, v), float(l)) for t, p, v, l in zip(
            times, states.position, states.velocity, states.light_time)]
    names = ("utc", "tdb_s", "x_m", "y_m", "z_m", "vx_m_s", "vy_m_s", "vz_m_s", "light_time_s")
    if options.json:
        json.dump({"target": options.target, "observer": options.observer, "frame": options.frame,
                   "correction": options.correction, "sources": [s._asdict() for s in states.sources],
                   "states": [dict(zip(names, row)) for row in rows]}, sys.stdout, indent=2, allow_nan=False)
        print()
    elif options.csv:
        writer = csv.writer(sys.stdout, lineterminator="\n")
        writer.writerow(names)
        writer.writerows((row[0], *map(repr, row[1:])) for row in rows)
    else:
        for s in states.sources:
            print(f"# {s.body} from {s.center}: {s.source}{', ' + s.accuracy if s.accuracy else ''}")
        for utc, _, x, y, z, vx, vy, vz, light in rows:
            print(f"{utc}  {x / 1e3:.6f} {y / 1e3:.6f} {z / 1e3:.6f} km  {vx / 1e3:.9f} {vy / 1e3:.9f} {vz / 1e3:.9f} km/s"
                  f"  light {light:.6f} s")
