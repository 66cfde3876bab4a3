"""What the pieces of a batch are."""
import importlib
from dataclasses import dataclass, field
from typing import Callable


@dataclass(frozen=True)
class Kind:
    """A kind of batch. A module of that kind has it as KIND, and a function draw_pieces(words, run, numbers, folder, tell), which
    makes the files of the pieces `numbers` in a folder, in this order, and calls tell(how many are left) after each.

    noun: in messages, and in the names of the folder's own files: NOUN.json, NOUN.lock. script: the name of the file with the
    batch's text. module: the module's name.
    prefix: of the files of a piece, with its number. endings: a regular expression for the rest of their names. whole: called
    with the folder and a number: whether the piece is complete. final: the end of the name of the file that is written last; the
    others come before it in the order of their names."""
    noun: str
    script: str
    module: str
    prefix: str
    endings: str
    whole: Callable
    final: str

    def last(self, number):
        """The name of the file of a piece that is written last."""
        return self.prefix % number + self.final


def kind_of(module):
    """The Kind of a module of that name."""
    return importlib.import_module(module).KIND


@dataclass(frozen=True)
class Batch:
    """A batch: its Kind, its text, from which a process makes any of its pieces, and what else tells it from others."""
    kind: Kind
    text: str
    settings: dict = field(default_factory=dict)
