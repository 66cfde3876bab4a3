"""stage_minutes: a stage lasts until the next one starts."""
import os
import pathlib
import subprocess

SCRIPT = pathlib.Path(__file__).resolve().parent / "stage_minutes"


def minutes(path, now):
    return subprocess.run([SCRIPT, path], check=True, capture_output=True, text=True,
                          env={**os.environ, "STAGE_MINUTES_NOW": str(now)}).stdout


def test_stages(tmp_path):
    path = tmp_path / "stages"
    path.write_text("1000\tInstalling 3 Debian packages: a b c\n1090\tBuilding\n1270\tTests\n")
    assert minutes(path, 1300) == ("   1.5 min  Installing 3 Debian packages: a b c\n   3.0 min  Building\n"
                                   "   0.5 min  Tests\n   5.0 min  in all\n")


def test_a_run_that_ended_before_its_first_stage(tmp_path):
    path = tmp_path / "stages"
    path.write_text("")
    assert minutes(path, 1300) == ""
