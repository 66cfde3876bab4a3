"""lint.py: which files it reads, and with which compiler flags."""
import json
import subprocess

import lint


def git(folder, *words):
    subprocess.run(["git", "-c", "user.name=a", "-c", "user.email=a@b", "-c", "init.defaultBranch=main", *words],
                   cwd=folder, check=True, capture_output=True)


def test_changed_files_are_those_since_the_previous_release(tmp_path):
    library = tmp_path / "Libraries"
    library.mkdir()
    for name in ("Old.cxx", "Edited.cxx", "Removed.cxx", "notes.md"):
        (library / name).write_text("1\n")
    git(tmp_path, "init")
    git(tmp_path, "add", ".")
    git(tmp_path, "commit", "-m", "one")
    (library / "Edited.cxx").write_text("2\n")
    git(tmp_path, "commit", "-a", "-m", "two")
    assert lint.changed_files(tmp_path) is None  # no release so far
    git(tmp_path, "tag", "v0.1.0", "HEAD^")
    (library / "New.h").write_text("3\n")
    (library / "notes.md").write_text("3\n")
    (library / "Removed.cxx").unlink()
    git(tmp_path, "add", "-A")
    git(tmp_path, "commit", "-m", "three")
    expected = [library / "Edited.cxx", library / "New.h"]
    assert lint.changed_files(tmp_path) == expected
    git(tmp_path, "tag", "v0.2.0")  # a release is compared with the one before it
    assert lint.changed_files(tmp_path) == expected


def test_the_sample_exists():
    assert [path.name for path in lint.sample()] == list(lint.SAMPLE)


def test_flags_are_those_of_the_build_without_precompiled_headers(tmp_path):
    build = tmp_path / "build"
    header = build / "CMakeFiles/Base.dir/cmake_pch.hxx"
    header.parent.mkdir(parents=True)
    header.write_text("#include <string>\n")
    source, part = tmp_path / "A.cxx", tmp_path / "B.cxx"
    unity = build / "Unity/unity_0_cxx.cxx"
    unity.parent.mkdir()
    unity.write_text(f'#include "{part}"\n')
    flags = f"/usr/bin/c++ -DX='a b' -Wall -Werror -Winvalid-pch -include {header} -c"
    (build / "compile_commands.json").write_text(json.dumps([
        {"directory": str(build), "file": str(source), "command": f"{flags} {source}"},
        {"directory": str(build), "file": str(unity), "command": f"{flags} {unity}"}]))
    entries = lint.compile_commands(build, [source, part, tmp_path / "C.cxx", tmp_path / "A.h"])
    assert list(entries) == [source, part]
    folder = tmp_path / "lint"
    folder.mkdir()
    for path, entry in entries.items():
        assert lint.tidy_command(entry, path, folder) == [
            "/usr/bin/c++", "-DX=a b", "-Wall", "-include", str(folder / "Base.dir.hxx"), "-c", str(path)]
    assert (folder / "Base.dir.hxx").read_text() == "#include <string>\n"
