"""Measurements between points that are clicked on in the windows."""
import json
import math

from dspace._core.fields import word
from dspace.scene.scene import Scene

KINDS = {kind: kind for kind in ("line", "area", "angle")}


def measure(app, kind, points, terrain=None):
    """Measures in the scene in the docks and shows what came of it. Returns a dspace.MeasuredLine or MeasuredArea, or for an
    angle degrees."""
    kind = word(kind, KINDS, "the kind", "measure")
    scene = _scene(app)
    profile = None
    if kind == "angle":
        result = scene.measure_angle(*points)
        rows = [("Angle", result, "angle")]
    elif kind == "area":
        result = scene.measure_area(points, terrain)
        rows = _area_rows(result)
    else:
        result = scene.measure_line(points, terrain)
        rows = _line_rows(result)
        profile = result.profile and {
            "distance": result.profile.distance.tolist(), "height": _known(result.profile.height.tolist()),
            "point": [_known(point) for point in result.profile.point.tolist()]}
    shown = [list(map(float, point)) for point in points] if kind == "angle" else result.points.tolist()
    app._host.extend(json.dumps({
        "do": "measured", "kind": kind, "points": shown, "profile": profile,
        "rows": [(name, *_known([value]), unit) for name, value, unit in rows]}))
    return result


def _scene(app):
    """The scene in the docks: of this window's session, of a recording, or of a server."""
    shown, name = app._host.active()
    clients = [app.session._client, *(run.session._client for run in app.runs), *(link._client for link in app.links)]
    return Scene(next((client for client in clients if client.shown() is shown), app.session._client), name)


def _known(values):
    """JSON has no NaN."""
    return [value if math.isfinite(value) else None for value in values]


def _line_rows(line):
    on_ground = line.terrain is not None
    rows = [("Straight length", line.length, "length")]
    if on_ground:
        rows += [("Horizontal distance", line.distance, "length"), ("Length on the ground", line.ground_length, "length"),
                 ("Climb", line.climb, "length"), ("Descent", line.descent, "length")]
    for i, length in enumerate(line.lengths):
        rows.append((f"Leg {i + 1}: straight length", length, "length"))
        if on_ground:
            rows += [(f"Leg {i + 1}: distance", line.distances[i], "length"),
                     (f"Leg {i + 1}: azimuth", line.azimuth_deg[i], "angle"),
                     (f"Leg {i + 1}: rise", line.rises[i], "length"), (f"Leg {i + 1}: slope", line.slope_deg[i], "angle")]
        else:
            x, y, z = line.points[i + 1] - line.points[i]
            rows += [(f"Leg {i + 1}: along {axis}", value, "length") for axis, value in (("X", x), ("Y", y), ("Z", z))]
    return rows


def _area_rows(area):
    rows = [("Area", area.area, "area"), ("Perimeter", area.perimeter, "length")]
    if area.terrain is not None:
        rows += [("Area of the sloping ground", area.surface_area, "area"), ("Mean slope", area.mean_slope_deg, "angle"),
                 ("Least height", area.least_height, "length"), ("Mean height", area.mean_height, "length"),
                 ("Greatest height", area.greatest_height, "length"), ("Part with data", area.covered, "share")]
    return rows
