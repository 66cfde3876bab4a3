"""`dspace kernels info`: what SPICE kernels contain."""
import json
import math
import sys


def add_arguments(parser):
    commands = parser.add_subparsers(dest="what", metavar="WHAT", required=True)
    info = commands.add_parser(
        "info", help="list segments, coverage, frames, clocks and fields of view",
        description="Lists what SPICE kernels contain: segments with their coverage, and what text kernels and "
        "tables of the IERS assign: leap seconds, radii, frames, clocks, fields of view. All files are loaded together: with the clock of a spacecraft (SCLK), the times of its "
        "attitude (CK) are known; with leap seconds (LSK), theirs are used.")
    info.add_argument("files", nargs="+", metavar="FILE", help="SPK, CK, PCK, LSK, FK, IK, SCLK, a meta-kernel, "
                      "or the IERS's finals2000A or EOP C04")
    info.add_argument("--json", action="store_true", help="print JSON")
    info.set_defaults(run=run)


def run(options):
    import dspace
    with dspace.Session() as session:
        scene = session.scene()
        scene.kernels.load(*options.files)
        kernels = scene.kernels
        found = {
            "files": kernels.files,
            "segments": [dict(s._asdict(), begin_utc=_utc(scene, s.begin_s), end_utc=_utc(scene, s.end_s))
                         for s in kernels.segments],
            "contents": [c._asdict() for c in kernels.contents],
            "frames": [f._asdict() for f in kernels.frames],
            "clocks": [dict(c._asdict(), begin_utc=_utc(scene, c.begin_s), end_utc=_utc(scene, c.end_s))
                       for c in kernels.clocks],
            "instruments": [dict(i._asdict(), boresight=i.boresight.tolist(), boundary=i.boundary.tolist())
                            for i in kernels.instruments.values()],
            "conflicts": [c._asdict() for c in kernels.conflicts]}
    if options.json:
        for segment in found["segments"]:
            for key in ("begin_s", "end_s"):
                segment[key] = segment[key] if math.isfinite(segment[key]) else None
        json.dump(found, sys.stdout, indent=2, ensure_ascii=False, allow_nan=False)
        print()
    else:
        _print(found)


def _utc(scene, tdb):
    """UTC as text; TDB where there is no UTC; None: not known."""
    import dspace
    if not math.isfinite(tdb):
        return None
    try:
        return scene.utc(tdb, decimals=0)
    except dspace.InvalidArgument:  # before 1960, after 9999
        pass
    try:
        return scene.time_text(tdb, "TDB", decimals=0) + " TDB"
    except dspace.InvalidArgument:  # before the year 1, after 9999
        return f"{tdb:.0f} s past J2000 TDB"


def _print(found):
    for file in found["files"]:
        print(file)
        for s in found["segments"]:
            if s["file"] == file:
                span = f"{s['begin_utc']} to {s['end_utc']}" if s["begin_utc"] else "load its clock (SCLK) for its times"
                center = f" from {s['center']}" if s["kind"] == "SPK" else ""
                name = f"  '{s['name']}'" if s["name"] else ""
                print(f"  {s['kind']} type {s['type']}: {s['body']}{center} in {s['frame']}, {span}{name}")
        for c in found["contents"]:
            if c["file"] == file:
                print(f"  {c['kind'] or 'text kernel'}" + (f": {c['variables']} variables" if c["variables"] else ""))
                for item in c["items"]:
                    print(f"  {item}")
        for f in found["frames"]:
            if f["kernel"] == file:
                print(f"  frame {f['name']} ({f['id']}): {f['kind']}, centre {f['center']}")
    for c in found["clocks"]:
        print(f"clock {c['id']}: {c['begin_utc']} to {c['end_utc']}")
    for i in found["instruments"]:
        print(f"instrument {i['id']}: {i['shape'].lower()} in {i['frame']}, {len(i['boundary'])} boundary vectors")
    for c in found["conflicts"]:
        print(f"conflict: {c['name']} is that of '{c['winner']}', not of '{c['loser']}'")
