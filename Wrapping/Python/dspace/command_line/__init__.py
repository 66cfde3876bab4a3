"""The `dspace` command. Each subcommand has a module, which defines its arguments and executes it.

Exit code: 0 on success; 1 when something failed, with one line on the error stream that names it; 2 when the command
line itself is wrong.
"""
import argparse
import importlib
import importlib.util
import os
import re
import sys
import warnings

from dspace.errors import Error

WORDS = {"camera": "project, check and convert camera models, and draw through them",
         "contacts": "find when bodies, spacecraft and stations stand above the horizon of a site",
         "ephemeris": "print states of bodies and spacecraft",
         "horizon": "measure the horizon around a site on terrain",
         "illumination": "map the time that ground is lit by the Sun",
         "kernels": "describe SPICE kernels",
         "lit": "measure the sunlit area and the power of a panel on terrain",
         "log": "show, compare, cut, pack and salvage recordings",
         "los": "test lines of sight over terrain",
         "movie": "make a movie of a run from a text file of camera key frames",
         "play": "draw pictures of a recording, without a simulation",
         "power": "profile the power of solar panels at a site over a span of time",
         "scan": "measure ranges with a lidar or an altimeter on terrain or in a recording",
         "serve": "serve a session to simulations and viewers in other processes",
         "sky": "draw the sky over a site, and print the direction of a body",
         "terrain": "describe and draw rasters of heights",
         "viewshed": "map the ground that is seen from sites on terrain",
         "watch": "draw pictures of a running simulation through its server"}


class Failed(Exception):
    """A failure that the command reports in one line."""


def later(module, function="run"):
    """The function of a module that is imported when the command runs, so that help does not wait for it."""
    def run(options):
        return getattr(importlib.import_module(f"{__name__}.{module}"), function)(options)
    return run


def lazy(name):
    """A module that is loaded when something of it is used."""
    if name in sys.modules:
        return sys.modules[name]
    found = importlib.util.find_spec(name)
    found.loader = importlib.util.LazyLoader(found.loader)
    module = sys.modules[name] = importlib.util.module_from_spec(found)
    found.loader.exec_module(module)
    return module


class Parser(argparse.ArgumentParser):
    """An ArgumentParser that prints errors in one line and accepts values such as "-60,10"."""

    def __init__(self, *arguments, **named):
        super().__init__(*arguments, **named)
        self._negative_number_matcher = re.compile(r"^-[0-9.][0-9.,eE+-]*$")

    def error(self, message):
        self.exit(2, f"{self.prog}: {' '.join(message.split())}; see {self.prog} --help\n")


def main(arguments=None):
    """Executes a command line and returns the exit code."""
    arguments = sys.argv[1:] if arguments is None else list(arguments)
    parser = Parser(prog="dspace", description="Measures and draws what simulations do.")
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)
    asked = next((a for a in arguments if not a.startswith("-")), None)
    for word, purpose in WORDS.items():
        command = commands.add_parser(word, help=purpose, description=purpose)
        if word == asked:  # the modules of other commands are not imported
            importlib.import_module(f"{__name__}.{word}").add_arguments(command)
    options = parser.parse_args(arguments)
    warnings.showwarning = lambda message, *_: print(f"dspace: note: {message}", file=sys.stderr)
    try:
        done = options.run(options) or 0
        sys.stdout.flush()
        return done
    except BrokenPipeError:  # the reader, such as `| head`, has ended
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    except (Failed, Error, OSError, RuntimeError) as error:  # RuntimeError: GDAL's
        return tell(error)


def tell(error):
    """Prints an error in one line on the error stream. Returns the exit code of a failure."""
    print("dspace: " + " ".join(str(error).split()), file=sys.stderr)
    return 1

