"""What the tests of the dspace package share."""
import atexit
import os
import shutil
import sys
import tempfile
import warnings

import numpy as np
import pytest


# Nothing is written to the user's own cache, by no process that a test starts either.
os.environ["XDG_CACHE_HOME"] = tempfile.mkdtemp(prefix="dspace-test-cache-")
atexit.register(shutil.rmtree, os.environ["XDG_CACHE_HOME"], ignore_errors=True)


def pytest_sessionfinish(session, exitstatus):
    """A module that skips as a whole passes: pytest itself ends as if it had found no tests. See needs.py."""
    stats = session.config.pluginmanager.get_plugin("terminalreporter").stats
    if exitstatus == pytest.ExitCode.NO_TESTS_COLLECTED and stats.get("skipped"):
        session.exitstatus = pytest.ExitCode.OK


def pytest_terminal_summary(terminalreporter):
    """Says so when nothing was tested; ctest then reports the module as skipped."""
    stats = terminalreporter.stats
    if stats.get("skipped") and not any(stats.get(kind) for kind in ("passed", "failed", "error", "xfailed", "xpassed")):
        reasons = {report.longrepr[2].removeprefix("Skipped: ") for report in stats["skipped"]}
        terminalreporter.write_line(f"Every test was skipped: {'; '.join(sorted(reasons))}")


@pytest.fixture
def session():
    import dspace
    with dspace.Session() as session:
        yield session


@pytest.fixture
def scene(session):
    return session.scene()


@pytest.fixture(params=["local", "served"])
def anywhere(request, tmp_path):
    """A session of this process, then one that is connected to a server."""
    import dspace
    from served_support import Served
    if request.param == "local":
        with dspace.Session() as session:
            yield session
    else:
        with Served(tmp_path) as served, dspace.connect(served.address) as session:
            yield session


def picture_of(scene):
    """All that can be asked about a scene, as text."""
    parts = []
    for kind in ("list_frames", "list_objects", "list_fragments", "list_lights", "list_vantages",
                 "list_robots", "list_terrains", "get_time"):
        parts.append(str(scene._ask(kind)))
    frames = list(scene.frames.values())
    parts.append(scene.poses(frames).tobytes().hex() if frames else "")
    for vantage in scene.vantages.values():
        parts.extend(str(camera._info()) for camera in vantage.cameras.values())
    return "\n".join(parts)


@pytest.fixture
def refused(scene):
    """refused(kind, text): the block raises `kind` with `text` and leaves the scene as it was."""
    class Rejected:
        def __init__(self, kind, text=""):
            self.kind, self.text = kind, text

        def __enter__(self):
            self.before = picture_of(scene)

        def __exit__(self, kind, error, trace):
            assert kind is not None, f"nothing was raised; expected {self.kind.__name__}"
            if not issubclass(kind, self.kind):
                return False
            assert self.text in str(error), str(error)
            assert picture_of(scene) == self.before
            return True

    return Rejected


@pytest.fixture
def field(tmp_path):
    """A raster of 33 x 33 posts, 1 m apart, z = x / 2 about its middle; an ESRI grid."""
    x = np.arange(33) - 16
    rows = "\n".join(" ".join(f"{v / 2}" for v in x) for _ in range(33))
    path = tmp_path / "field.asc"
    path.write_text(f"ncols 33\nnrows 33\nxllcorner 99.5\nyllcorner 199.5\ncellsize 1\n{rows}\n")
    return path


@pytest.fixture(autouse=True)
def no_warnings_about_rasters():
    # The rasters made here state neither datum nor CRS, which is pointed out each time.
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message=".*(vertical datum|no CRS|unit of height).*")
        yield


sys.dont_write_bytecode = True
