"""`dspace kernels` and `dspace ephemeris`."""
import csv
import io
import json
import os
import pathlib

import pytest

from dspace.command_line import main

DATA = pathlib.Path(os.environ.get("DSPACE_DATA", "/nonexistent")) / "ephemeris"


def run(capsys, *arguments):
    code = main([str(each) for each in arguments])
    out = capsys.readouterr()
    return code, out.out, out.err


def test_kernels_of_cassini_are_listed(capsys):
    folder = DATA / "spice_test_kernels"
    if not folder.is_dir():
        pytest.skip("real data absent: set DSPACE_DATA to the folder that has ephemeris/spice_test_kernels")
    files = [folder / name for name in ("13056_13057ra.bc", "cas00167.tsc", "cas_v40.tf", "cas_iss_v10.ti")]
    code, out, _ = run(capsys, "kernels", "info", "--json", *files)
    assert code == 0
    found = json.loads(out)
    assert {s["body"] for s in found["segments"]} == {-82000}
    assert found["segments"][0]["begin_utc"].startswith("2013-02-2")
    assert found["clocks"][0]["id"] == -82
    assert "CASSINI_ISS_NAC" in {f["name"] for f in found["frames"]}
    assert {i["id"] for i in found["instruments"]} == {-82360, -82361, -82368, -82369}
    code, out, _ = run(capsys, "kernels", "info", files[0])
    assert code == 0 and "load its clock" in out


def test_what_text_kernels_assign_is_listed(capsys):
    files = [DATA / name for name in ("naif0012.tls", "pck00011.tpc", "gm_de440.tpc", "de430_excerpt_2015-03-02.bsp")]
    if not all(file.is_file() for file in files):
        pytest.skip("real data absent: set DSPACE_DATA to the folder that has ephemeris/naif0012.tls")
    code, out, _ = run(capsys, "kernels", "info", *files)
    lines = [line.strip() for line in out.splitlines()]
    assert code == 0 and "leap seconds up to that of 2017-01-01 (TAI - UTC = 37 s)" in lines
    assert any(line.startswith("radii of SUN, MERCURY, VENUS, MOON, EARTH") for line in lines)
    assert any(line.startswith("orientation of SUN") for line in lines) and any(line.startswith("GM of ") for line in lines)
    code, out, _ = run(capsys, "kernels", "info", "--json", *files)
    contents = json.loads(out)["contents"]
    assert code == 0 and [c["kind"] for c in contents] == ["LSK", "PCK", "PCK"] and contents[0]["variables"] == 5
    # Several kernels behind one option, as for `dspace sky`.
    code, out, _ = run(capsys, "ephemeris", "mars", "--observer", "sun", "--time", "2015-03-02", "--kernel", files[0], files[3])
    assert code == 0 and "de430_excerpt" in out


def test_ephemeris_prints_tables(capsys):
    code, out, _ = run(capsys, "ephemeris", "moon", "--time", "2026-11-01,2026-11-01T01:00,1800", "--csv")
    rows = list(csv.DictReader(io.StringIO(out)))
    assert code == 0 and [row["utc"] for row in rows] == [
        "2026-11-01T00:00:00.000", "2026-11-01T00:30:00.000", "2026-11-01T01:00:00.000"]
    distance = sum(float(rows[0][axis]) ** 2 for axis in ("x_m", "y_m", "z_m")) ** 0.5
    assert 3.5e8 < distance < 4.1e8
    assert abs(float(rows[0]["light_time_s"]) - distance / 299792458.0) < 1e-9
    code, out, _ = run(capsys, "ephemeris", "mars", "--observer", "sun", "--time", "2026-11-01 TDB")
    assert code == 0 and out.startswith("# ")


@pytest.mark.parametrize("arguments", [
    ("ephemeris", "vulcan", "--time", "2026-11-01"), ("ephemeris", "moon", "--time", "yesterday"),
    ("ephemeris", "moon", "--time", "2026-11-01,2026-11-02"), ("ephemeris", "moon", "--time", "2026-11-02,2026-11-01,5"),
    ("ephemeris", "moon", "--time", "2026-11-01", "--frame", "IAU_MONO"), ("kernels", "info", "/nonexistent.bsp")])
def test_bad_input_is_one_line(capsys, arguments):
    code, out, err = run(capsys, *arguments)
    assert code == 1 and out == "" and len(err.strip().splitlines()) == 1
