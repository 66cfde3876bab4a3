"""Generates Commands.md from the comments of the .proto files: python3 Documentation/make_commands.py

It needs protoc, but no build of Dspace. --check: exit code 1 if Commands.md is out of date.
"""
import pathlib
import re
import subprocess
import sys
import tempfile

from google.protobuf import descriptor_pb2, message_factory
from google.protobuf.descriptor_pb2 import FieldDescriptorProto as Field

ROOT = pathlib.Path(__file__).resolve().parents[1]
PROTOS = ROOT / "Libraries" / "Session"
PAGE = ROOT / "Documentation" / "Commands.md"
FILES = ("commands", "frames", "objects", "robots", "cameras", "viewports", "terrain", "layers", "geodesy",
         "telemetry", "messages", "sky", "trajectories", "visibility", "sights", "maps", "work", "lenses", "ranges", "common", "service")
TYPES = {getattr(Field, name): name[5:].lower() for name in dir(Field) if name.startswith("TYPE_")}
HEAD = """# The commands

`Documentation/make_commands.py` generates this page from the comments of `Libraries/Session/dspace/proto/*.proto`. Edit
the comments, not this page. [Wire.md](Wire.md) describes how commands are sent.

The comments state the units: metres [m], seconds [s], degrees if the name ends in `_deg`, pixels. "absent" and "empty"
state the meaning of a field that is not set. Each command and field has a number that identifies it on the wire.
Numbers are never reused.
"""

EFFECTS = {"CHANGE": "changes the scene", "REQUEST": "a request"}


def joined(text):
    """A .proto file's text, in which each comment behind a declaration is on one line.

    protoc takes the first line of such a comment for the declaration and the following lines for the next one. A line
    that has only a comment, below the comment of the line before it, continues that comment."""
    lines, column = [], None
    for line in text.splitlines():
        alone = re.match(r" *//", line)
        if alone and column is not None and alone.end() - 2 == column:
            lines[-1] += " " + line.strip().lstrip("/").strip()
            continue
        behind = re.match(r" *[^ /].*?[;{},] *//", line)
        column = behind.end() - 2 if behind else None
        lines.append(line)
    return "\n".join(lines) + "\n"


def read_protos():
    """The files' descriptors with their comments, by name, and what reads the options of options.proto."""
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "all.pb"
        for proto in (PROTOS / "dspace/proto").glob("*.proto"):
            copy = pathlib.Path(folder) / "dspace/proto" / proto.name
            copy.parent.mkdir(parents=True, exist_ok=True)
            copy.write_text(joined(proto.read_text(encoding="utf-8")), encoding="utf-8")
        subprocess.run(["protoc", f"-I{folder}", "--include_imports", "--include_source_info",
                        f"--descriptor_set_out={out}", *[f"dspace/proto/{name}.proto" for name in FILES]],
                       check=True, cwd=folder)
        files = descriptor_pb2.FileDescriptorSet.FromString(out.read_bytes()).file
    return {pathlib.Path(file.name).stem: file for file in files}, Options(files)


class Options:
    """Reads the options of options.proto, without code that protoc made of it."""

    def __init__(self, files):
        self._classes = message_factory.GetMessages(
            [file for file in files if pathlib.Path(file.name).stem in ("descriptor", "options")])
        pool = self._classes["dspace.v1.CommandOptions"].DESCRIPTOR.file.pool
        self._command = pool.FindExtensionByName("dspace.v1.command")
        self._accepts = pool.FindExtensionByName("dspace.v1.accepts")
        self._effects = self._classes["dspace.v1.CommandOptions"].DESCRIPTOR.enum_types_by_name["Effect"]

    def _read(self, kind, options):
        return self._classes[f"google.protobuf.{kind}"].FromString(options.SerializeToString())

    def command(self, message):
        """(effect in words, [results]) of a command's message."""
        found = self._read("MessageOptions", message.options).Extensions[self._command]
        results = list(found.reply)
        return EFFECTS[self._effects.values_by_number[found.effect].name], [] if results == ["none"] else results

    def limits(self, field):
        """What a field accepts and its default, in words; "" without either."""
        found = self._read("FieldOptions", field.options).Extensions[self._accepts]
        words = []
        if found.HasField("minimum") and found.HasField("maximum"):
            words.append(f"{found.minimum:,.10g} to {found.maximum:,.10g}")
        elif found.HasField("minimum"):
            words.append(f"{found.minimum:,.10g} on")
        elif found.HasField("maximum"):
            words.append(f"up to {found.maximum:,.10g}")
        if found.HasField("most_bytes"):
            words.append(f"up to {found.most_bytes:,} bytes")
        if found.HasField("standard"):
            words.append(("0" if found.zero_is_absent else "absent") + f": {found.standard:,.10g}")
        elif found.zero_is_absent:
            words.append("or 0")
        if found.HasField("standard_text"):
            words.append(f'empty: "{found.standard_text}"')
        return "; ".join(words)


class Page:
    def __init__(self, options):
        self.options = options
        self.lines = [HEAD]
        self.comments = {}
        self.headings = set()

    def add(self, *lines):
        self.lines.extend(lines)

    def comment(self, path):
        """What stands before and behind a thing, as one text."""
        place = self.comments.get(tuple(path))
        if place is None:
            return ""
        texts = [place.leading_comments, place.trailing_comments]
        text = " ".join(re.sub(r"\s+", " ", text).strip() for text in texts if text.strip())
        # A rule that parts a file in two belongs to no thing; of a table | would end the cell.
        return re.sub(r"(Requests|Replies|Types) -{5,}\s*", "", text).replace("|", "\\|").strip()

    def file_comment(self, file):
        for place in file.source_code_info.location:
            if list(place.path) == [12]:  # the syntax line
                return "\n\n".join(" ".join(part.split()) for part in place.leading_comments.split("\n\n"))
        return ""

    def type_of(self, field):
        if field.type in (Field.TYPE_MESSAGE, Field.TYPE_ENUM):
            name = field.type_name.split(".dspace.v1.")[-1]
            word = f"[{name}](#{anchor(name)})"
        else:
            word = TYPES[field.type]
        if field.label == Field.LABEL_REPEATED:
            return f"repeated {word}"
        return f"optional {word}" if field.proto3_optional else word

    def message(self, message, path, title, level):
        self.add(f"{'#' * level} {title}", "")
        about = self.comment(path)
        if about:
            self.add(about, "")

    def fields(self, message, path):
        if message.field:
            self.add("| field | number | type | meaning |", "| --- | --- | --- | --- |")
            oneofs = [one.name for one in message.oneof_decl]
            for index, field in enumerate(message.field):
                if message.name == "Command" and field.number >= 10:
                    continue  # in the table above
                meaning = self.comment([*path, 2, index])
                limits = self.options.limits(field)
                meaning = "; ".join(part for part in (meaning, limits) if part)
                if field.HasField("oneof_index") and not field.proto3_optional:
                    meaning = f"one of `{oneofs[field.oneof_index]}`" + (f": {meaning}" if meaning else "")
                self.add(f"| `{field.name}` | {field.number} | {self.type_of(field)} | {meaning} |")
            self.add("")

    def enum(self, enum, path, title, level):
        self.message(enum, path, title, level)
        self.add("| value | number | meaning |", "| --- | --- | --- |")
        for index, value in enumerate(enum.value):
            self.add(f"| `{value.name}` | {value.number} | {self.comment([*path, 2, index])} |")
        self.add("")

    def nested(self, message, path, name, level):
        for index, each in enumerate(message.nested_type):
            self.whole(each, [*path, 3, index], f"{name}.{each.name}", level)
        for index, each in enumerate(message.enum_type):
            self.enum(each, [*path, 4, index], f"{name}.{each.name}", level)

    def whole(self, message, path, name, level):
        self.message(message, path, name, level)
        self.fields(message, path)
        self.nested(message, path, name, min(level + 1, 5))


def anchor(title):
    return re.sub(r"[^a-z0-9_ -]", "", title.lower()).replace(" ", "-")


def make():
    files, options = read_protos()
    command = next(each for each in files["commands"].message_type if each.name == "Command")
    reply = next(each for each in files["commands"].message_type if each.name == "Reply")
    kinds = {field.type_name.split(".")[-1]: field for field in command.field if field.number >= 10}
    results = {field.name: field for field in reply.field if field.number >= 10}
    page = Page(options)
    page.add("| command | number | what it does |", "| --- | --- | --- |")
    table = len(page.lines)
    rows = []
    for name in FILES:
        file = files[name]
        page.comments = {tuple(place.path): place for place in file.source_code_info.location}
        page.add(f"## {name}.proto", "", page.file_comment(file), "")
        others = []
        for index, message in enumerate(file.message_type):
            field = kinds.get(message.name)
            if field is None:
                others.append((index, message))
                continue
            page.message(message, [4, index], message.name, 3)
            effect, answers = options.command(message)
            told = " or ".join(f"`{answer}` ({page.type_of(results[answer])})" for answer in answers)
            page.add(f"`{field.name}`, {field.number} in Command; {effect}; result: {told or 'none'}.", "")
            page.fields(message, [4, index])
            page.nested(message, [4, index], message.name, 4)
            about = page.comment([4, index])
            rows.append((field.number, f"| [{field.name}](#{anchor(message.name)}) | {field.number} | "
                                       f"{first_sentence(about)} |"))
        for index, message in others:
            page.whole(message, [4, index], message.name, 3)
        for index, enum in enumerate(file.enum_type):
            page.enum(enum, [5, index], enum.name, 3)
    page.lines[table:table] = [row for _, row in sorted(rows)] + [""]
    return "\n".join(page.lines).rstrip() + "\n"


def first_sentence(text):
    return re.split(r"(?<=[a-z0-9)])[.:;] ", text + " ")[0].strip().rstrip(".")


def main():
    page = make()
    if "--check" in sys.argv[1:]:
        if not PAGE.is_file() or PAGE.read_text(encoding="utf-8") != page:
            sys.exit("Documentation/Commands.md is out of date; accepted: as Documentation/make_commands.py makes it")
        return
    PAGE.write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
