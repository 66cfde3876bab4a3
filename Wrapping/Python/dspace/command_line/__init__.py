"""The `dspace` command: one module a word, which says what it takes and carries it out.

Exit code 0; 1 when something failed, with one line on the error stream that names it; 2 when the
command line itself is wrong.
"""
import argparse
import importlib
import os
import re
import sys
import warnings

from dspace.errors import Error

WORDS = {"log": "what recordings hold, where two part, what survives damage",
         "movie": "a movie of a run, from a text file of camera key frames",
         "play": "pictures of a recording, with no simulation",
         "serve": "a session for simulations and viewers in other processes",
         "terrain": "what a raster of heights is, and pictures of it",
         "watch": "pictures of a simulation that runs, from a server"}


class Failed(Exception):
    """Told in one line."""


class Parser(argparse.ArgumentParser):
    """Whose errors are one line, and which takes "-60,10" for a value."""

    def __init__(self, *arguments, **named):
        super().__init__(*arguments, **named)
        self._negative_number_matcher = re.compile(r"^-[0-9.][0-9.,eE+-]*$")

    def error(self, message):
        self.exit(2, f"{self.prog}: {' '.join(message.split())}; see {self.prog} --help\n")


def main(arguments=None):
    """Carries out a command line; returns the exit code."""
    arguments = sys.argv[1:] if arguments is None else list(arguments)
    parser = Parser(prog="dspace", description="Measures and draws what simulations do.")
    commands = parser.add_subparsers(dest="command", metavar="COMMAND", required=True)
    asked = next((a for a in arguments if not a.startswith("-")), None)
    for word, purpose in WORDS.items():
        command = commands.add_parser(word, help=purpose, description=purpose)
        if word == asked:  # others need not be read
            importlib.import_module(f"{__name__}.{word}").add_arguments(command)
    options = parser.parse_args(arguments)
    warnings.showwarning = lambda message, *_: print(f"dspace: note: {message}", file=sys.stderr)
    try:
        done = options.run(options) or 0
        sys.stdout.flush()
        return done
    except BrokenPipeError:  # `| head` has read enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 1
    except (Failed, Error, OSError, RuntimeError) as error:  # RuntimeError: GDAL's
        return tell(error)


def tell(error):
    """One line on the error stream; returns the exit code of failures."""
    print("dspace: " + " ".join(str(error).split()), file=sys.stderr)
    return 1

