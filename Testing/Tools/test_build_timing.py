"""build_timing.py on a log written by hand."""
import pytest

import build_timing

# start [ms], end [ms], time of the end [s], output, command
LOG = (
    (0, 10_000, 1010, "Libraries/Core/CMakeFiles/DspaceBase.dir/cmake_pch.hxx.gch", "a"),
    (0, 20_000, 1020, "Libraries/Core/dspace/import/CMakeFiles/DspaceImport.dir/gltf/GltfNodes.cxx.o", "b"),
    (10_000, 14_000, 1014, "Libraries/Core/dspace/scene/CMakeFiles/TestScene.dir/__/__/Testing/TestScene.cxx.o", "c"),
    (0, 1_000, 1001, "Libraries/Session/dspace/session/commands.pb.h", "protoc"),  # two outputs of one job
    (0, 1_000, 1001, "Libraries/Session/dspace/session/commands.pb.cc", "protoc"),
    (14_000, 20_000, 1020, "Libraries/Session/CMakeFiles/DspaceSession.dir/dspace/session/commands.pb.cc.o", "d"),
    (20_000, 22_000, 1022, "lib/libDspaceSession.so.0.1.0", "e"),
    (22_000, 23_000, 1023, "bin/TestScene", "f"),
    (0, 30_000, 900, "bin/BenchLink", "old"),  # built again later, in another run
    (0, 5_000, 2005, "bin/BenchLink", "g"),
    (5_000, 8_000, 2008, "Testing/Benchmarks/CMakeFiles/BenchLink.dir/BenchLink.cxx.o", "h"),
    (0, 99_000, 1099, "bin/Removed", "i"),  # its output is gone
    (8_000, 12_000, 2012, "Libraries/Core/CMakeFiles/Core.dir/Unity/unity_0_cxx.cxx.o", "j"),
)


@pytest.fixture
def build(tmp_path):
    lines = ["# ninja log v5"]
    for start, end, seconds, output, command in LOG:
        lines.append(f"{start}\t{end}\t{seconds * 10**9}\t{output}\t{command}")
        if output != "bin/Removed":
            (tmp_path / output).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / output).touch()
    (tmp_path / ".ninja_log").write_text("\n".join(lines) + "\n")
    return tmp_path


def test_jobs_are_counted_once_and_only_while_their_outputs_exist(build):
    jobs = build_timing.read_log(build)
    assert len(jobs) == 10
    assert sum(job.seconds for job in jobs) == pytest.approx(10 + 20 + 4 + 1 + 6 + 2 + 1 + 5 + 3 + 4)


def test_wall_time_leaves_out_the_time_between_builds(build):
    assert build_timing.wall_time(build_timing.read_log(build)) == pytest.approx(23 + 12)


def test_kinds(build):
    sums = {name: seconds for name, seconds, _ in build_timing.grouped(build_timing.read_log(build),
                                                                       build_timing.kind_of)}
    assert sums == {"library objects": 24, "test objects": 4, "generated code": 7, "precompiled headers": 10,
                    "linking": 3, "benchmarks": 8}
    assert set(sums) == set(build_timing.KINDS)


def test_folders_are_those_of_the_sources():
    folder = build_timing.folder_of
    assert folder(LOG[1][3]) == "Libraries/Core/dspace/import/gltf"
    assert folder(LOG[2][3]) == "Libraries/Core/Testing"
    assert folder(LOG[12][3]) == "Libraries/Core (Core, unity)"


def test_the_page(build):
    page = "\n".join(build_timing.report(build))
    assert page.startswith("10 jobs, 56 job-seconds in 0.6 minutes of wall time: 1.6 jobs at a time\n")
    assert "ccache" not in page and page.count("\n") < 60
    slowest = page.splitlines()[page.splitlines().index("The 10 slowest jobs") + 1:]
    assert slowest[:2] == ["    20.0 s  Libraries/Core/dspace/import/gltf/GltfNodes.cxx",
                           "    10.0 s  Libraries/Core/CMakeFiles/DspaceBase.dir/cmake_pch.hxx.gch"]
    (build / "CMakeCache.txt").write_text("DSPACE_CCACHE:FILEPATH=DSPACE_CCACHE-NOTFOUND\n")
    assert "ccache" not in "\n".join(build_timing.report(build))
    (build / "CMakeCache.txt").write_text("DSPACE_CCACHE:FILEPATH=/usr/bin/ccache\n")
    assert "This build uses ccache" in "\n".join(build_timing.report(build))


def test_what_is_no_log_is_rejected(tmp_path):
    (tmp_path / ".ninja_log").write_text("something else\n")
    with pytest.raises(ValueError, match="the first line is .*expected '# ninja log v5'"):
        build_timing.read_log(tmp_path)
