"""./dspace with stand-ins for cmake, ninja, ctest and Debian's packages: what each command configures and builds."""
import os
import pathlib
import shutil
import subprocess

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
# cmake --preset NAME -DX=Y ...: keeps the options in a cache as cmake does.
CMAKE = """#!/bin/sh
echo "cmake $*" >>"$CALLS"
mkdir -p "build/$2" && touch "build/$2/build.ninja" "build/$2/CMakeCache.txt"
for word; do case "$word" in
  -D*) option="${word#-D}"; sed -i "/^${option%%=*}:/d" "build/$2/CMakeCache.txt"
       echo "${option%%=*}:BOOL=${option#*=}" >>"build/$2/CMakeCache.txt" ;;
esac; done
"""
NINJA = """#!/bin/sh
case " $* " in *" -n "*) [ -n "$BUILT" ] || echo "[1/1] something"; exit ;; esac
echo "ninja ${*#-C }" >>"$CALLS"
"""
CTEST = """#!/bin/sh
echo "ctest${LD_LIBRARY_PATH:+ with $LD_LIBRARY_PATH} in $(basename "$PWD"): $*" >>"$CALLS"
"""
DPKG = """#!/bin/sh
for name in $INSTALLED; do echo "$name install ok installed"; done
"""


@pytest.fixture
def dspace(tmp_path):
    """dspace(*words): runs ./dspace of a tree in tmp_path; returns the calls of the programs."""
    shutil.copy(ROOT / "dspace", tmp_path)
    for name, text in (("cmake", CMAKE), ("ninja", NINJA), ("ctest", CTEST), ("dpkg-query", DPKG)):
        path = tmp_path / "bin" / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
        path.chmod(0o755)
    script = tmp_path / "Examples/rover_drive/rover_drive.py"
    script.parent.mkdir(parents=True)
    script.write_text("import os\nprint('demo', file=open(os.environ['CALLS'], 'a'))\n")
    calls = tmp_path / "calls"
    kinds = ("build", "run", "extra", "app", "test", "bench", "lint")
    installed = subprocess.run([tmp_path / "dspace", "setup", "--list", *kinds], check=True, capture_output=True,
                               text=True).stdout

    def run(*words, **environment):
        calls.write_text("")
        subprocess.run([tmp_path / "dspace", *words], check=True, capture_output=True, text=True, env={
            **os.environ, "PATH": f"{tmp_path / 'bin'}:{os.environ['PATH']}", "CALLS": str(calls),
            "INSTALLED": " ".join(installed.split()), "DSPACE_STAGES": str(tmp_path / "stages"), **environment})
        return calls.read_text().replace(str(tmp_path) + "/", "").splitlines()

    return run


def test_the_demo_needs_neither_tests_nor_benchmarks(dspace):
    assert dspace("demo") == ["cmake --preset release -DDSPACE_TESTS=OFF -DDSPACE_BENCHMARKS=OFF",
                              "ninja build/release dspace_runtime", "demo"]
    assert dspace("demo", BUILT="1") == ["demo"]  # the second start


def test_the_same_build_folder_serves_all_commands(dspace):
    dspace("demo")
    assert dspace("test", "--quick") == ["cmake --preset release -DDSPACE_TESTS=ON",
                                         "ninja build/release dspace_runtime dspace_tests",
                                         "ctest in release: -j 3 --output-on-failure --no-tests=error"]
    assert dspace("demo") == ["ninja build/release dspace_runtime", "demo"]
    assert dspace("build", "--all") == ["cmake --preset release -DDSPACE_BENCHMARKS=ON",
                                        "ninja build/release dspace_runtime dspace_tests dspace_benchmarks"]
    assert dspace("test", "--quick", BUILT="1") == ["ctest in release: -j 3 --output-on-failure --no-tests=error"]


def test_sanitizers_come_first(dspace):
    assert [line.split(" --output")[0] for line in dspace("test")] == [
        "cmake --preset release -DDSPACE_TESTS=OFF -DDSPACE_BENCHMARKS=OFF -DDSPACE_TESTS=ON",
        "ninja build/release dspace_runtime dspace_tests", "cmake --preset sanitize", "ninja build/sanitize",
        "ctest with build/sanitize/lib in release: -j 3", "ctest in release: -j 3"]
    named = dspace("test", "Pose", "Scene", BUILT="1")
    assert named == ["ctest in release: -j 3 --output-on-failure --no-tests=error -R Pose|Scene"]


def test_headings_are_the_stages(dspace, tmp_path):
    dspace("test")
    names = [line.split("\t")[1] for line in (tmp_path / "stages").read_text().splitlines()]
    assert names == ["Configuring", "Building (progress: [done/total])", "Building the libraries with the sanitizers",
                     "Tests with the address and undefined-behaviour sanitizers", "Tests in the release build"]


def test_unknown_options_are_rejected(dspace):
    for words, said in ((("build", "x"), "build accepts --all and --timing, not 'x'"),
                        (("test", "--slow"), "test accepts --long, --quick, --sanitize and names, not '--slow'"),
                        (("install",), "install needs a folder"), (("paint",), "there is no command 'paint'")):
        with pytest.raises(subprocess.CalledProcessError) as error:
            dspace(*words)
        assert error.value.returncode == 2 and said in error.value.stderr
