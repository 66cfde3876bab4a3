"""Includes and imports between rooms go the allowed way, and each room says what it is."""
import pathlib

import pytest

import rooms

TABLE = rooms.read_table((pathlib.Path(rooms.__file__).parent / "rooms.txt").read_text())
LIBRARIES = rooms.ROOT / "Libraries"
PACKAGES = rooms.ROOT / "Wrapping" / "Python"


def test_the_tree_keeps_to_the_table():
    assert list(rooms.wrong_includes(LIBRARIES, TABLE)) == []
    assert list(rooms.wrong_imports(PACKAGES, TABLE)) == []


def test_every_room_of_the_table_has_sources_and_a_readme():
    folders = {rooms.room_of(path): (LIBRARIES / path).parent for path in rooms.sources(LIBRARIES)}
    folders.update({rooms.room_of(path): (LIBRARIES / path).parent
                    for path in rooms.sources(LIBRARIES) if "/dspace/" in path})
    folders["proto"] = LIBRARIES / "Session" / "dspace" / "proto"
    python = {rooms.room_of_module(rooms.module_of(path)): PACKAGES / path for path in rooms.modules(PACKAGES)}
    assert set(TABLE) == set(folders) | set(python)
    folders.update((room, path.parent) for room, path in python.items() if path.parent.name != "dspace")
    assert [room for room, folder in sorted(folders.items()) if not (folder / "README.md").is_file()] == []


def test_a_room_that_includes_the_wrong_way_is_found(tmp_path):
    for path, text in {
        "Low/dspace/low/Low.h": "",
        "Low/dspace/low/Low.cxx": "#include <dspace/low/Low.h>\n#include <dspace/high/High.h>\n",
        "High/dspace/high/High.h": "#include <dspace/low/Low.h>\n#include <string>\n",
        "High/dspace/other/Other.h": "",
        "Low/Testing/low/TestLow.cxx": "#include <dspace/high/High.h>\n",
    }.items():
        file = tmp_path / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    table = rooms.read_table("low:\nhigh: low # above\n")
    assert list(rooms.wrong_includes(tmp_path, table)) == [
        ("High/dspace/other/Other.h", "other", "", "rooms.txt does not name it"),
        ("Low/dspace/low/Low.cxx", "low", "dspace/high/High.h", "high"),
    ]


def test_a_room_that_imports_the_wrong_way_is_found(tmp_path):
    for path, text in {
        "dspace/__init__.py": "from dspace.high.b import B\n",
        "dspace/low/__init__.py": "",
        "dspace/low/a.py": "import os\n\ndef f():\n    from dspace.high.b import B\n    from dspace.low import c\n",
        "dspace/low/c.py": "from dspace import Scene, __version__\nfrom ..high import b\nfrom . import a\n",
        "dspace/high/b.py": "import dspace.low.a\nfrom dspace import low\nfrom .. import other\n",
        "dspace/other.py": "",
    }.items():
        file = tmp_path / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)
    table = rooms.read_table("dspace.low:\ndspace.high: dspace.low\ndspace: dspace.high\n")
    assert list(rooms.wrong_imports(tmp_path, table)) == [
        ("dspace/high/b.py", "dspace.high", "dspace", "dspace"),
        ("dspace/low/a.py", "dspace.low", "dspace.high.b", "dspace.high"),
        ("dspace/low/c.py", "dspace.low", "dspace", "dspace"),
        ("dspace/low/c.py", "dspace.low", "dspace.high", "dspace.high"),
        ("dspace/other.py", "dspace.other", "", "rooms.txt does not name it"),
    ]


def test_a_room_may_include_what_its_rooms_may_include():
    assert rooms.read_table("a:\nb: a\nc: b\n")["c"] == {"a", "b"}


@pytest.mark.parametrize("text", ["a: b\nb:\n", "a\n", "a:\na:\n"])
def test_a_table_with_a_cycle_or_a_room_twice_is_rejected(text):
    with pytest.raises(ValueError, match="rooms.txt|room 'a'"):
        rooms.read_table(text)
