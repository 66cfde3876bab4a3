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


# A link to a file or an anchor of this tree, outside of code.
LINK = re.compile(r"\]\(([^)\s]+)\)")
CODE = re.compile(r"^```.*?^```|`[^`\n]*`|^(?: {4}|\t).*?$", re.MULTILINE | re.DOTALL)


def anchors(text):
    """The anchors of a document's headings, as GitHub and the site name them."""
    found = {}
    for title in re.findall(r"^#{1,6}\s+(.+?)\s*#*$", re.sub(r"^```.*?^```", "", text, flags=re.M | re.S), re.M):
        title = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", title)
        name = re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-")
        found[name] = found.get(name, -1) + 1
    return {name + (f"-{i}" if i else "") for name, count in found.items() for i in range(count + 1)}


def broken(document, text):
    """The links in a document's text that lead nowhere."""
    for link in LINK.findall(CODE.sub("", text)):
        path, _, anchor = link.partition("#")
        if re.match(r"[a-z]+:", link):
            continue
        target = document.parent / path if path else document
        if path and not target.exists() or anchor and anchor not in anchors(text if not path else target.read_text()):
            yield link


def test_broken_links_are_found():
    text = ("# A title, with `code`\n\n[a](README.md) [b](#a-title-with-code) [c](#nowhere) [d](none.md)\n"
            "[e](Documentation/Terrain.md#nowhere) `[f](g.md)` https://h ![i](https://j/k.png)\n## A title, with `code`\n"
            "[l](#a-title-with-code-1)\n```\n[m](n.md)\n```\n")
    assert list(broken(ROOT / "TEXT.md", text)) == ["#nowhere", "none.md", "Documentation/Terrain.md#nowhere"]


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_the_links_of_a_document_lead_somewhere(document):
    assert list(broken(document, document.read_text())) == []


def test_the_words_of_importers_warnings_are_theirs():
    page = (ROOT / "Documentation/Formats.md").read_text()
    table = page.split("Words of warnings")[1].split("## ")[0]
    sources = " ".join(path.read_text() for path in (ROOT / "Libraries/Core/dspace/import").rglob("*.cxx"))
    sources = re.sub(r"\"\s*\"", "", sources)  # parts of one text
    rows = re.findall(r"^\| `([^`]+)`", table, re.M)
    assert len(rows) == 10
    for words in rows:
        for part in re.split(r"'?\b[A-Z]+\b'?", words):
            assert part.strip(" ,;'") in sources, f"{part!r} of {words!r} is in no importer"


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: str(path.relative_to(ROOT)))
def test_the_files_that_a_document_names_exist(document):
    assert list(missing(document, document.read_text())) == []
