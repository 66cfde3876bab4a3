"""What makes the site of documents readable: docstrings and the comments of headers."""
import pathlib
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "Documentation" / "site"))

import docstrings  # noqa: E402
import header_filter  # noqa: E402


def test_docstrings_become_paragraphs_code_and_examples():
    text = ("Sets `x` to a*b, and x_ too.\n\n    with s as t:\n        t.run()\n\nThen *args\\n | b.\n")
    assert docstrings.to_rst(text) == (
        "Sets ``x`` to a\\*b, and x\\_ too.\n\n::\n\n    with s as t:\n        t.run()\n\nThen \\*args\\\\n \\| b.\n")


def test_an_example_may_follow_a_line_at_once():
    assert docstrings.to_rst("So:\n    a = 1\n\n    b = 2\nEnd.") == "So:\n\n::\n\n    a = 1\n\n    b = 2\n\nEnd.\n"


def test_comments_of_headers_belong_to_what_they_describe():
    header = ("// Of the file.\n#ifndef A_H\n#define A_H\n#include <a> // why\n\n// Of A.\nstruct A {\n  int b = 1; // of b,\n"
              "             // and more\n  // Of c.\n  int c;\npublic:\n  // A remark.\n\n  enum E { F, // no member\n    G // of G\n"
              "  };\n};\n#endif\n")
    assert header_filter.filtered(header) == (
        "/// @file\n/// Of the file.\n#ifndef A_H\n#define A_H\n#include <a> // why\n\n/// Of A.\nstruct A {\n"
        "  int b = 1; ///< of b,\n             ///< and more\n  /// Of c.\n  int c;\npublic:\n  // A remark.\n\n"
        "  enum E { F, ///< no member\n    G ///< of G\n  };\n};\n#endif\n")
