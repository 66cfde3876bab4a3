"""One rule for the exit codes of all words of the `dspace` command (its module has it)."""
import pytest

from command_support import run
from dspace.command_line import WORDS

NONE = "/nonexistent/file"
TIMES = ("--time", "2026-11-01,2026-11-02")
SPAN = ("--from", "2026-11-01", "--to", "2026-11-02")
# Of each word: a value of the wrong form, and what is understood and rejected.
CASES = {
    "camera": (("project", NONE, "--point", "1,2"), ("info", NONE)),
    "contacts": (("--site", "1,2", "--body", "moon", "--target", "sun", *TIMES, "--station-mask", "x"),
                 ("--site", "1,2", "--body", "vulcan", "--target", "sun", *TIMES)),
    "ephemeris": (("moon", "--time", "2026-11-01", "--correction", "X"), ("vulcan", "--time", "2026-11-01")),
    "horizon": (("--terrain", NONE, "--site", "1,2", "--height", "x"), ("--terrain", NONE, "--site", "1,2")),
    "illumination": (("--terrain", NONE, *SPAN, "--step", "x"), ("--terrain", NONE, *SPAN, "--out", "/nonexistent/a.tif")),
    "kernels": (("info",), ("info", NONE)),
    "lit": (("--terrain", NONE, "--site", "1,2", "--samples", "x"), ("--terrain", NONE, "--site", "1,2", "--sun", "0,30")),
    "log": (("cat", NONE, "--first", "x"), ("info", NONE)),
    "los": (("--terrain", NONE, "--from", "1,2,3", "--to", "1,2,3", "--wavelength", "x"),
            ("--terrain", NONE, "--from", "1,2,3", "--to", "1,2,3")),
    "movie": ((NONE, "--run", NONE, "--out", "a.mp4", "--size", "3"), (NONE, "--run", NONE, "--out", "a.mp4")),
    "play": ((NONE, "--at", "x"), (NONE, "--at", "0", "--out", "/nonexistent/a")),
    "power": (("--site", "1,2", "--body", "moon", "--panel", "1", *TIMES, "--load", "x"),
              ("--site", "1,2", "--body", "vulcan", "--panel", "1", *TIMES)),
    "scan": (("--terrain", NONE, "--site", "1,2", "--height", "x"), ("--terrain", NONE, "--site", "1,2")),
    "serve": (("--max-connections", "x"), ("--listen", "nowhere")),
    "sites": (("--terrain", NONE, "--site", "1,2", "--radius", "x", *SPAN),
              ("--terrain", NONE, "--site", "1,2", "--radius", "100", *SPAN)),
    "sky": (("--time", "2026-11-01", "--site", "3", "--look-at", "sun"),
            ("--time", "2026-11-01", "--site", "3,4", "--look-at", "vulcan")),
    "terrain": (("render", NONE, "--out", "a.png", "--fov", "x"), ("info", NONE)),
    "viewshed": (("--terrain", NONE, "--site", "1,2", "--height", "x"),
                 ("--terrain", NONE, "--site", "1,2", "--out", "/nonexistent/a.tif")),
    "watch": (("unix:/nonexistent/socket", "--out", "a", "--every", "x"), ("unix:/nonexistent/socket", "--out", "a")),
}


def test_every_word_is_here():
    assert set(CASES) == set(WORDS)


@pytest.mark.parametrize("word", sorted(WORDS))
def test_the_codes(word, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    code, out, _ = run(capsys, word, "--help")
    assert code == 0 and word in out
    malformed, rejected = CASES[word]
    for arguments in (malformed, ("--no-such-option",), (*rejected, "--no-such-option")):
        code, out, err = run(capsys, word, *arguments)
        assert code == 2 and out == "", (arguments, err)
        assert err.startswith("dspace") and len(err.strip().splitlines()) == 1, err
    code, out, err = run(capsys, word, *rejected)
    assert code == 1, err
    lines = err.strip().splitlines()
    assert lines[-1].startswith("dspace: ") and sum("note:" not in line for line in lines) == 1, err
    assert not list(tmp_path.iterdir())


def test_without_a_word_the_code_is_2(capsys):
    assert run(capsys)[0] == 2 and run(capsys, "no-such-word")[0] == 2 and run(capsys, "--help")[0] == 0
