"""What a process loads before its first session."""
import os
import re

from dspace import vtk


def test_libraries_that_are_loaded_first_are_those_of_the_classes():
    with open("/proc/self/maps", encoding="utf-8") as maps:
        loaded = {line.split()[-1] for line in maps if "/libDspace" in line}
    first = [os.path.realpath(path) for path in vtk._libraries()]
    assert len(first) == 2 and set(first) <= loaded
    names = [re.sub(r"\.so.*", "", os.path.basename(path)) for path in loaded]
    assert len(names) == len(set(names))  # none from two folders
