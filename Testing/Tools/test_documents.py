"""Files that the documents name exist."""
import pathlib
import re

import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
DOCUMENTS = sorted(path for folder in (ROOT, *(ROOT / name for name in (
    "Documentation", "Examples", "Libraries", "Testing", "Wrapping"))) for path in (
        folder.glob("*.md") if folder == ROOT else folder.rglob("*.md")))
# Folders that a path may be relative to, besides the document's own. Architecture.md abbreviates the libraries.
BASES = ("", "Libraries/Core", "Libraries/Terrain", "Libraries/Session", "Wrapping/Python", "Wrapping/Python/dspace",
         "Testing/Python")
LETTERS = {"S": "Libraries/Session/dspace", "T": "Libraries/Terrain/dspace", "C": "Libraries/Core/dspace",
           "A": "Libraries/Analysis/dspace"}
NAMED = re.compile(r"[`(]((?:[\w.]+/)+\w+\.(?:cxx|h|md|proto|py|txt))[`)]")
PATTERNS = ("dspace/ROOM/NAME.h",)  # of the recipes


def missing(document, text):
    """The paths in a document's text that lead to no file."""
    for path in NAMED.findall(text):
        letter, _, rest = path.partition("/")
        bases = [document.parent, *(ROOT / base for base in BASES)]
        wanted = [base / path for base in bases] + ([ROOT / LETTERS[letter] / rest] if letter in LETTERS else [])
        if path not in PATTERNS and not path.endswith((".pb.h", "_pb2.py")) and not any(each.is_file() for each in wanted):
            yield path


def test_missing_paths_are_found():
    text = "`Testing/Tools/test_documents.py`, `S/link/Nowhere.h`, [a](nowhere/b.md), `S/link/LinkAddress.h`"
    assert list(missing(ROOT / "README.md", text)) == ["S/link/Nowhere.h", "nowhere/b.md"]


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_the_files_that_a_document_names_exist(document):
    assert list(missing(document, document.read_text())) == []
