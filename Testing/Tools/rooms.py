"""Checks that includes between the rooms of Libraries/, and imports between those of the Python package, go the
allowed way.

A room is a folder of sources, in Python also a module beside the folders. `rooms.txt` has a line for each:
`room: the rooms that it may include`. A room may also include every room that those may include. `rooms.py` prints each
include and each import that the table does not allow, and exits with 1 if there is one.
"""
import ast
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
        return {"Core": "render", "Session": "session", "Widgets": "widgets"}.get(library, library)
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


def room_of_module(module):
    """The room of a Python module: `dspace.movies.draw` is in `dspace.movies`. `dspace` itself names everything public."""
    return ".".join(module.split(".")[:2])


def module_of(path):
    """The Python module of a source: `dspace/movies/draw.py` is `dspace.movies.draw`."""
    return path.removesuffix(".py").removesuffix("/__init__").replace("/", ".")


def modules(packages):
    """Each source of the Python package, as a path relative to the folder of packages."""
    return sorted(file.relative_to(packages).as_posix() for file in (packages / "dspace").rglob("*.py"))


def imported(path, text, table):
    """Each module of the package that a source imports, anywhere in it."""
    package = module_of(path) if path.endswith("/__init__.py") else module_of(path).rpartition(".")[0]
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Import):
            names = [name.name for name in node.names]
        elif isinstance(node, ast.ImportFrom):
            base = package.split(".")[:len(package.split(".")) - node.level + 1] if node.level else []
            module = ".".join([*base, *filter(None, [node.module])])
            # `from dspace import vtk` imports a room, `from dspace import Scene` what names everything.
            names = [f"dspace.{name.name}" if f"dspace.{name.name}" in table else module
                     for name in node.names if name.name != "__version__"] if module == "dspace" else [module]
        else:
            continue
        yield from (name for name in names if name.split(".")[0] == "dspace")


def wrong_imports(packages, table):
    """(source, its room, module, the module's room) of each import that the table does not allow."""
    for path in modules(packages):
        room = room_of_module(module_of(path))
        if room not in table:
            yield path, room, "", "rooms.txt does not name it"
            continue
        for module in imported(path, (packages / path).read_text(), table):
            other = room_of_module(module)
            if other != room and other not in table[room]:
                yield path, room, module, other


def main():
    table = read_table((pathlib.Path(__file__).parent / "rooms.txt").read_text())
    wrong = list(wrong_includes(ROOT / "Libraries", table))
    for path, room, header, other in wrong:
        print(f"Libraries/{path}: room '{room}' may not include <{header}> of room '{other}'")
    packages = list(wrong_imports(ROOT / "Wrapping" / "Python", table))
    for path, room, module, other in packages:
        print(f"Wrapping/Python/{path}: room '{room}' may not import {module} of room '{other}'")
    return 1 if wrong or packages else 0


if __name__ == "__main__":
    sys.exit(main())
