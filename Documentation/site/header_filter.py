"""Doxygen's filter of headers: plain comments that describe a declaration become Doxygen's.

A block of `//` lines before a declaration describes it, and one behind it on its line too. The first block of a file
describes the file."""
import re
import sys


def filtered(text):
    lines = text.split("\n")
    out, i, column = [], 0, None  # column: of the comment behind the line before
    while i < len(lines):
        alone = re.match(r"(\s*)//(?!/)(.*)", lines[i])
        if alone and column is not None and len(alone[1]) == column:
            out.append(lines[i].replace("//", "///<", 1))
            i += 1
            continue
        if alone:
            column = None
            end = i
            while end < len(lines) and re.match(r"\s*//(?!/)", lines[end]):
                end += 1
            following = lines[end].strip() if end < len(lines) else ""
            block = [re.sub(r"//", "///", line, count=1) for line in lines[i:end]]
            if following.startswith("#ifndef") and i == 0:
                block.insert(0, "/// @file")
            elif not following or following.startswith(("#", "}", "public:", "private:", "protected:")):
                block = lines[i:end]
            out += block
            i = end
            continue
        behind = re.match(r"(?!\s*#)(.*[^\s{}/]\s+)//(?!/)", lines[i])
        column = len(behind[1]) if behind else None
        out.append(f"{behind[1]}///<{lines[i][column + 2:]}" if behind else lines[i])
        i += 1
    return "\n".join(out)


if __name__ == "__main__":
    with open(sys.argv[1], encoding="utf-8") as file:
        sys.stdout.write(filtered(file.read()))
