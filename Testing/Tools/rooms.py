"""Checks that includes between the rooms of Libraries/ go the allowed way.

A room is a folder of sources. `rooms.txt` has a line for each: `room: the rooms that it may include`. A room may
also include every room that those may include. `rooms.py` prints each include that the table does not allow, and
exits with 1 if there is one.
"""
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
INCLUDE = re.compile(r'^\s*#include\s+[<"]([^>"]+)[>"]', re.MULTILINE)


def read_table(text):
    """{room: set of rooms that it may include, directly or through another}."""
    direct = {}
    for number, line in enumerate(text.splitlines(), 1):
        line = line.split("#")[0].strip()
        if not line:
            continue
        room, colon, allowed = line.partition(":")
        if not colon or room in direct:
            raise ValueError(f"rooms.txt, line {number}: '{line}' is not 'room: rooms', or names a room again")
        for other in allowed.split():
            if other not in direct:
                raise ValueError(f"rooms.txt, line {number}: room '{room}' may include '{other}', which is not above it")
        direct[room] = set(allowed.split())
    closed = {}
    for room, allowed in direct.items():  # in the order of the file: those above are closed already
        closed[room] = allowed.union(*(closed[other] for other in allowed))
    return closed


def room_of(path):
    """The room of a source under Libraries/: `Core/dspace/import/obj/ObjText.h` is in `import/obj`."""
    library, _, rest = path.partition("/")
    folder = rest.rpartition("/")[0]
    if not folder:  # classes derived from vtkObject stand beside the library's CMakeLists.txt
        return {"Core": "render", "Session": "session"}.get(library, library)
    return folder.partition("/")[2] or "base"


def sources(libraries):
    """Each source under Libraries/, as a path relative to it. Tests may include everything."""
    for file in sorted(libraries.rglob("*")):
        path = file.relative_to(libraries).as_posix()
        if file.suffix in (".h", ".cxx") and "/Testing/" not in path:
            yield path


def wrong_includes(libraries, table):
    """(source, its room, header, the header's room) of each include that the table does not allow."""
    paths = list(sources(libraries))
    room_of_header = {path.split("/", 1)[1]: room_of(path) for path in paths if path.endswith(".h")}
    for path in paths:
        room = room_of(path)
        if room not in table:
            yield path, room, "", "rooms.txt does not name it"
            continue
        for header in INCLUDE.findall((libraries / path).read_text()):
            if header.startswith("dspace/proto/") and ".pb." in header:
                other = "proto"
            else:
                other = room_of_header.get(header)
            if other is not None and other != room and other not in table[room]:
                yield path, room, header, other


def main():
    table = read_table((pathlib.Path(__file__).parent / "rooms.txt").read_text())
    wrong = list(wrong_includes(ROOT / "Libraries", table))
    for path, room, header, other in wrong:
        print(f"Libraries/{path}: room '{room}' may not include <{header}> of room '{other}'")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
