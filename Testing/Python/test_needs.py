"""The rule for tests that skip: which exit status pytest ends with, and what it says."""
import os
import pathlib
import re
import shutil
import subprocess
import sys

import pytest

HERE = pathlib.Path(__file__).resolve().parent
WHOLE = "from needs import needs_module\nneeds_module('dspace_nowhere', 'python3-nowhere')\n\ndef test_a():\n    pass\n"
ONE = "from needs import needs_program\n\ndef test_a():\n    needs_program('dspace-nowhere', 'nowhere')\n"
DATA = "import pytest\n\ndef test_a():\n    pytest.skip('real data absent: set DSPACE_DATA')\n"
SAYS = "Every test was skipped: "


@pytest.fixture
def pytest_on(tmp_path):
    """pytest_on(text, require_all, *options): pytest on a module of that text, with the conftest.py of this folder."""
    def run(text, require_all, *options):
        for name in ("conftest.py", "needs.py"):
            shutil.copy(HERE / name, tmp_path)
        (tmp_path / "test_tiny.py").write_text(text)
        environment = {key: value for key, value in os.environ.items() if key != "DSPACE_REQUIRE_ALL"}
        if require_all:
            environment["DSPACE_REQUIRE_ALL"] = "1"
        return subprocess.run([sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider", *options, "test_tiny.py"],
                              cwd=tmp_path, env=environment, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)

    return run


@pytest.mark.parametrize("text, package", ((WHOLE, "python3-nowhere"), (ONE, "nowhere")))
def test_a_missing_package_skips(pytest_on, text, package):
    done = pytest_on(text, require_all=False)
    assert done.returncode == 0, done.stdout
    assert f"\n{SAYS}{package} is not installed\n" in done.stdout


@pytest.mark.parametrize("text, package", ((WHOLE, "python3-nowhere"), (ONE, "nowhere")))
def test_a_missing_package_fails_where_all_are_required(pytest_on, text, package):
    done = pytest_on(text, require_all=True)
    assert done.returncode in (1, 2), done.stdout
    assert f"{package} is not installed, and DSPACE_REQUIRE_ALL=1" in done.stdout and SAYS not in done.stdout


@pytest.mark.parametrize("require_all", (False, True))
def test_missing_data_always_skips(pytest_on, require_all):
    done = pytest_on(DATA, require_all)
    assert done.returncode == 0, done.stdout
    assert f"\n{SAYS}real data absent: set DSPACE_DATA\n" in done.stdout


def test_a_test_that_runs_is_heard(pytest_on):
    done = pytest_on(ONE + "\ndef test_b():\n    pass\n", require_all=False)
    assert done.returncode == 0 and SAYS not in done.stdout
    done = pytest_on(ONE + "\ndef test_b():\n    assert False\n", require_all=False)
    assert done.returncode == 1 and SAYS not in done.stdout


def test_a_module_without_tests_fails(pytest_on):
    assert pytest_on("", require_all=False).returncode == pytest.ExitCode.NO_TESTS_COLLECTED
    assert pytest_on(ONE, False, "-k", "nothing").returncode == pytest.ExitCode.NO_TESTS_COLLECTED


def test_what_the_helpers_return():
    from needs import needs_module, needs_program
    assert needs_module("os.path", "python3") is os.path
    assert needs_program("python3", "python3") == "/usr/bin/python3"


def test_no_test_goes_round_the_rule():
    """pytest.importorskip() skips even where all packages are required."""
    for path in HERE.rglob("*.py"):
        assert not re.search(r"importorskip\(\"", path.read_text(encoding="utf-8")), f"{path.name}: use needs_module()"
