"""Docstrings, which are plain text with code in backquotes and indented examples, as reStructuredText."""
import re

SPECIAL = re.compile(r"([*|\\])|(\w)_(?!\w)")


def to_rst(text):
    """The same text, in which names in backquotes are code, indented lines are literal blocks, and no other character
    is markup."""
    blocks = []
    for paragraph in re.split(r"\n[ \t]*\n", text.strip("\n")):
        lines = paragraph.splitlines()
        while lines:
            indented = bool(re.match(r"\s{2,}\S", lines[0]))
            count = next((i for i, line in enumerate(lines) if bool(re.match(r"\s{2,}\S", line)) != indented), len(lines))
            blocks.append((indented, lines[:count]))
            lines = lines[count:]
    out, literal = [], False
    for indented, lines in blocks:
        if indented and not literal:
            out += ["::", ""]
        out += lines if indented else ["".join(_inline(part) for part in re.split(r"(`[^`]*`)", line)) for line in lines]
        out.append("")
        literal = indented
    return "\n".join(out)


def _inline(part):
    if len(part) > 2 and part[0] == part[-1] == "`":
        return f"`{part}`"
    part = part.replace("`", "'")
    return SPECIAL.sub(lambda found: "\\" + found[1] if found[1] else found[2] + "\\_", part)
