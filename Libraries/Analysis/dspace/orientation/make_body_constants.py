#!/usr/bin/env python3
"""Writes BodyConstants.inc: the data of NAIF's pck00011.tpc and gm_de440.tpc without their comments, as a C++ raw string.

    python3 make_body_constants.py pck00011.tpc gm_de440.tpc > BodyConstants.inc
"""
import re
import sys


def data_of(path):
    """The assignments between \\begindata and \\begintext: (name, values)."""
    lines, inside = [], False
    with open(path, encoding="ascii") as file:
        for line in file:
            word = line.strip()
            if word in ("\\begindata", "\\begintext"):
                inside = word == "\\begindata"
            elif inside:
                lines.append(word)
    for name, values in re.findall(r"(\S+)\s*\+?=\s*(\([^)]*\)|\S+)", " ".join(lines)):
        yield name, re.sub(r"[(),\s]+", " ", values).strip()


def main():
    print('R"kernel(KPL/PCK')
    print("\\begindata")
    for path in sys.argv[1:]:
        for name, values in data_of(path):
            line = f"{name}=("
            for value in values.split(" "):
                if len(line) + len(value) > 120:
                    print(line.rstrip())
                    line = " "
                line += value + " "
            print(line.rstrip() + ")")
    print(')kernel"')


main()
