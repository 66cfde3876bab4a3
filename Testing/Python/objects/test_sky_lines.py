"""Grids of the sky and figures of constellations: places, pictures, bad input."""
import json

import numpy as np
import pytest

import dspace
from dspace.stars import bright_stars
from dspace.stars.constellation_names import NAMES
from dspace.stars.lines import RADIUS, constellation_names, constellations, directions, grid


def test_grids_lie_on_their_circles():
    points, lines = grid("equatorial", 15, "grid")
    unit = points / RADIUS
    np.testing.assert_allclose(np.linalg.norm(unit, axis=1), 1.0, atol=1e-12)
    assert np.linalg.norm(unit[lines[:, 0]] - unit[lines[:, 1]], axis=1).max() < np.radians(2.01)
    on = np.degrees(np.arcsin(np.clip(unit[:, 2], -1, 1)))
    longitude = np.degrees(np.arctan2(unit[:, 1], unit[:, 0]))
    both = np.stack([on, longitude], 1) / 15.0
    assert np.all(np.abs(both - np.round(both)).min(axis=1) < 1e-9)
    # The pole of the ecliptic of J2000: right ascension 270, declination 66.5607 degrees.
    points, _ = grid("ecliptic", 30, "grid")
    pole = directions(270.0, 90.0 - 84381.448 / 3600.0)
    assert np.degrees(np.linalg.norm(points / RADIUS - pole, axis=1).min()) < 1e-6


def test_a_figure_goes_through_its_stars(tmp_path):
    stars = bright_stars()
    names = ("Betelgeuse", "Alnilam", "Rigel")
    row = [[float(stars.named(n).ra_deg[0]), float(stars.named(n).dec_deg[0])] for n in names]
    path = tmp_path / "lines.json"
    feature = {"id": "Ori", "geometry": {"type": "MultiLineString", "coordinates": [row]}}
    path.write_text(json.dumps({"features": [feature]}), encoding="utf-8")
    points, lines = constellations(path)
    unit = points / RADIUS
    for name in names:
        assert np.linalg.norm(unit - stars.named(name).directions(), axis=1).min() < 1e-9
    # Between them along great circles: in one plane with both ends.
    a, b = (stars.named(name).directions()[0] for name in names[:2])
    first = unit[:int(np.argmin(np.linalg.norm(unit - b, axis=1))) + 1]
    assert np.abs(first @ np.cross(a, b)).max() < 1e-12


def test_they_are_drawn_as_ornaments():
    with dspace.Session() as session:
        scene = session.scene()
        scene.add_camera(eye=(0, 0, 0), target=(1, 0, 0), fov_deg=20.0)
        view = scene.add_viewport(size=(101, 101))
        empty = view.image()
        lines = scene.add_sky_grid("horizon", 15, line_width=2, color=(1, 0, 0))
        drawn = view.image().astype(int) - empty
        assert drawn[50, 10, 0] > 100 and drawn[10, 50, 0] > 100  # elevation 0 and the meridian of X cross in the middle
        assert drawn[20, 20, 0] == 0
        assert view.pick(50, 50) is None
        lines.visible = False
        assert np.array_equal(view.image(), empty)


def test_names_stand_in_the_middle_of_their_figures(tmp_path):
    assert len(NAMES) == 88 and NAMES["Boo"] == "Boötes" and NAMES["CrA"] == "Corona Australis"
    path = tmp_path / "lines.json"
    square = [[-1, -1], [-1, 1], [1, 1], [1, -1], [-1, -1]]  # closed: the first place counts once
    path.write_text(json.dumps({"features": [
        {"id": "Ori", "geometry": {"type": "MultiLineString", "coordinates": [square]}},
        {"id": "mine", "geometry": {"type": "LineString", "coordinates": [[90, 0], [90, 10]]}}]}), encoding="utf-8")
    names = constellation_names(path)
    assert [name for name, _ in names] == ["Orion", "mine"]
    np.testing.assert_allclose(names[0][1], (1, 0, 0), atol=1e-9)
    np.testing.assert_allclose(names[1][1], directions(90.0, 5.0), atol=1e-9)
    with dspace.Session() as session:
        scene = session.scene()
        scene.add_camera(eye=(0, 0, 0), target=(1, 0, 0), fov_deg=20.0)
        view = scene.add_viewport(size=(201, 201))
        empty = view.image()
        words = scene.add_constellation_names(path, font_size=20)
        assert [each.name for each in words] == ["constellation Orion", "constellation mine"]
        drawn = np.abs(view.image().astype(int) - empty).max(axis=2) > 40
        rows, columns = np.nonzero(drawn)
        assert len(rows) > 60 and abs(columns.mean() - 100) < 12 and abs(rows.mean() - 100) < 12
        assert np.array_equal(view.image(physical_only=True), empty) and view.pick(100, 100) is None
        for each in words:
            each.remove()
        assert np.array_equal(view.image(), empty)


def test_what_is_wrong_is_rejected(tmp_path):
    with dspace.Session() as session:
        scene = session.scene()
        with pytest.raises(dspace.InvalidArgument, match="kind is 'galactic'.*equatorial"):
            scene.add_sky_grid("galactic")
        with pytest.raises(dspace.InvalidArgument, match="step_deg is 7.*whole part of 90"):
            scene.add_sky_grid(step_deg=7)
        with pytest.raises(dspace.NotFound, match="missing.json"):
            scene.add_constellations(tmp_path / "missing.json")
        path = tmp_path / "points.json"
        path.write_text('{"features": [{"id": "a", "geometry": {"type": "Point", "coordinates": [1, 2]}}]}', encoding="utf-8")
        with pytest.raises(dspace.Corrupt, match="'a' is a Point"):
            scene.add_constellations(path)
        assert not scene.objects
