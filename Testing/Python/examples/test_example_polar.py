"""The polar study from end to end, small: the report has its parts, and its numbers are those of the parts."""
import pathlib
import re
import subprocess
import sys

from needs import needs_module

EXAMPLE = pathlib.Path(__file__).resolve().parents[3] / "Examples" / "polar_site" / "polar_site.py"


def test_the_study_makes_a_report(tmp_path):
    needs_module("jinja2", "python3-jinja2")
    needs_module("matplotlib", "python3-matplotlib")
    done = subprocess.run([sys.executable, str(EXAMPLE), "--out", str(tmp_path), "--side", "260", "--start", "2024-01-01",
                           "--end", "2024-03-01"], capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr
    page = (tmp_path / "polar_site.html").read_text()
    for title in ("Site and horizon", "Light and power", "Direct to Earth", "Light around the site", "Inputs", "Versions"):
        assert f"<h2>{title}</h2>" in page
    assert page.count("<svg") >= 4
    lit = float(re.search(r"lit ([0-9.]+) %", done.stdout).group(1))
    assert 5.0 < lit <= 100.0 and f">{lit:.3g}"[:4] in page  # in the table, to more digits
    assert (tmp_path / "light.tif").exists() and not list(tmp_path.glob("*.part"))
    assert "Traceback" not in done.stderr
