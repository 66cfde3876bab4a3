"""Builds the site of documents: python3 Documentation/site/make_site.py BUILD_FOLDER

The result is BUILD_FOLDER/html/index.html. It needs the built Python package (`./dspace docs` builds it), Sphinx with its
Markdown parser, and Doxygen.
"""
import importlib
import os
import pathlib
import re
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
# The guides in the order of the contents, by chapter; a page of Documentation that is in none goes to the last one.
CHAPTERS = {
    "Start": ("README.md", "Documentation/Start.md", "Documentation/Cookbook.md", "Documentation/Conventions.md"),
    "Guides": ("Documentation/Terrain.md", "Documentation/Views.md", "Documentation/Cameras.md", "Documentation/Measurements.md",
               "Documentation/Sky.md", "Documentation/Frames.md", "Documentation/Ephemeris.md", "Documentation/Formats.md",
               "Documentation/VTK.md", "Documentation/OwnObjects.md", "Documentation/Telemetry.md", "Documentation/Movies.md",
               "Documentation/Recording.md", "Documentation/Server.md", "SECURITY.md", "Documentation/Application.md",
               "Documentation/CppLocal.md"),
    "Reference": ("reference/python.rst", "reference/cpp.md", "Documentation/Wire.md", "Documentation/Commands.md"),
    "Inside Dspace": ("Documentation/Architecture.md", "CONTRIBUTING.md", "CHANGELOG.md")}
IMAGES = (".png", ".jpg", ".svg")
# Rooms of the package by chapter of the reference.
ROOMS = {"Sessions": ("clients", "links"), "Scenes": ("scene", "objects", "frames", "cameras"),
         "Terrain and measurements": ("terrain", "measure", "reports"), "Sky": ("sky", "stars"), "Telemetry": ("telemetry",),
         "Recordings and movies": ("recording", "playback", "movies"), "Errors and limits": ("errors", "limits")}
# Modules that are documented as a whole.
MODULES = ("dspace.rover", "dspace.stars", "dspace.trajectories")


def documents():
    """The documents of the site, relative to the root."""
    pages = [ROOT / name for name in ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "SECURITY.md")]
    pages += sorted((ROOT / "Documentation").glob("*.md")) + sorted((ROOT / "Data").glob("*/README.md"))
    return [str(page.relative_to(ROOT)) for page in pages]


def stage(folder):
    """Copies documents and their pictures."""
    for name in documents():
        to = folder / name
        to.parent.mkdir(parents=True, exist_ok=True)
        text = (ROOT / name).read_text(encoding="utf-8")
        to.write_text(text, encoding="utf-8")
        for link in re.findall(r"\]\(([^)#\s]+)\)", text):
            source = (ROOT / name).parent / link
            if source.suffix in IMAGES and source.is_file():
                target = to.parent / link
                target.parent.mkdir(parents=True, exist_ok=True)
                shutil.copy(source, target)


def chapter_of(module):
    room = module.split(".")[1]
    return next((chapter for chapter, rooms in ROOMS.items() if room in rooms), "Scenes")


def write_python(folder):
    """A page for each class and function that the package exports, and their contents. Returns their number."""
    import dspace
    chapters = {chapter: [] for chapter in ROOMS}
    for name in sorted(set(dspace.__all__)):
        made = getattr(dspace, name)
        module = made.__module__
        chapters[chapter_of(module)].append(name)
        kind = "autoclass" if isinstance(made, type) else "autofunction"
        options = "\n   :members:\n   :undoc-members:" if kind == "autoclass" else ""
        if kind == "autoclass" and not issubclass(made, BaseException):
            options += "\n   :inherited-members: object, Mapping, dict, tuple, Strict"
        title = f"dspace.{name}"
        (folder / f"{name}.rst").write_text(
            f"{title}\n{'=' * len(title)}\n\n.. {kind}:: {module}.{name}{options}\n", encoding="utf-8")
    lines = ["Python reference", "================", "", "``import dspace`` provides these names. The guides show how to use them.",
             ""]
    for chapter, names in chapters.items():
        lines += [chapter, "-" * len(chapter), "", ".. toctree::", "   :maxdepth: 1", "", *(f"   {name}" for name in names), ""]
    lines += ["Modules", "-------", "", ".. toctree::", "   :maxdepth: 1", ""]
    for name in MODULES:
        importlib.import_module(name)
        lines.append(f"   {name}")
        (folder / f"{name}.rst").write_text(
            f"{name}\n{'=' * len(name)}\n\n.. automodule:: {name}\n   :members:\n   :imported-members:\n", encoding="utf-8")
    (folder / "python.rst").write_text("\n".join(lines) + "\n", encoding="utf-8")
    return sum(map(len, chapters.values()))


def write_gallery(path):
    """A page of the pictures of all guides, each with a link to where it stands."""
    lines = ["# Gallery", "", "The pictures of the guides. A click on a picture opens the text that explains it.", ""]
    seen = set()
    for name in documents():
        for words, link in re.findall(r"!\[([^\]]*)\]\(([^)\s]+)\)", (ROOT / name).read_text(encoding="utf-8")):
            picture = os.path.normpath(os.path.join(os.path.dirname(name), link))
            if picture not in seen and "cookbook" not in picture:
                seen.add(picture)
                lines += [f"[![{words}]({picture})]({name})", "", words, ""]
    path.write_text("\n".join(lines), encoding="utf-8")


def write_index(folder):
    taken = {name for names in CHAPTERS.values() for name in names}
    text = ["Dspace", "======", "", "3D visualization and measurement for spacecraft and rover simulations.", "",
            ".. image:: Documentation/images/banner.png", ""]
    for chapter, names in CHAPTERS.items():
        rest = sorted(set(documents()) - taken) if chapter == list(CHAPTERS)[-1] else []
        names = [name for name in (*names, *rest) if (folder / name).is_file()]
        text += [".. toctree::", "   :maxdepth: 1", f"   :caption: {chapter}", ""]
        text += [f"   {name.rsplit('.', 1)[0]}" for name in names]
        text += ["   gallery"] if chapter == "Start" else []
        text.append("")
    (folder / "index.rst").write_text("\n".join(text), encoding="utf-8")


def run_doxygen(folder, out):
    """The C++ reference of all public headers."""
    inputs = [str(ROOT / "Libraries" / name) for name in ("Core", "Terrain", "Analysis", "Session", "Widgets")]
    settings = {
        "PROJECT_NAME": "Dspace", "INPUT": " ".join(f'"{path}"' for path in inputs), "RECURSIVE": "YES",
        "FILE_PATTERNS": "*.h", "EXCLUDE_PATTERNS": "*/Testing/*", "OUTPUT_DIRECTORY": f'"{out}"', "HTML_OUTPUT": "cpp",
        "GENERATE_LATEX": "NO", "QUIET": "YES", "WARNINGS": "NO", "WARN_IF_DOC_ERROR": "NO", "WARN_LOGFILE": "/dev/null",
        "EXTRACT_ALL": "YES", "SEARCHENGINE": "YES",
        "GENERATE_TREEVIEW": "YES", "HAVE_DOT": "NO", "MARKDOWN_SUPPORT": "NO", "HIDE_UNDOC_RELATIONS": "YES",
        "STRIP_FROM_PATH": " ".join(f'"{path}"' for path in inputs), "VERBATIM_HEADERS": "YES", "SHOW_USED_FILES": "NO",
        # Comments are plain: those before and behind a declaration are its description.
        "INPUT_FILTER": f'"{sys.executable} {HERE / "header_filter.py"}"'}
    file = folder / "Doxyfile"
    file.write_text("".join(f"{key} = {value}\n" for key, value in settings.items()), encoding="utf-8")
    subprocess.run(["doxygen", str(file)], check=True)


def main():
    build = pathlib.Path(sys.argv[1]).resolve()
    source = build / "source"
    shutil.rmtree(source, ignore_errors=True)
    (source / "reference").mkdir(parents=True)
    (source / "extra").mkdir()
    stage(source)
    count = write_python(source / "reference")
    write_gallery(source / "gallery.md")
    (source / "reference" / "cpp.md").write_text(
        "# C++ reference\n\n<a href=\"../cpp/annotated.html\">Classes of all headers</a>, by Doxygen, with a search of its "
        "own.\n\n- [CppLocal](../Documentation/CppLocal.md): a program that draws in its own process\n"
        "- [OwnObjects](../Documentation/OwnObjects.md): objects that a plug-in draws\n", encoding="utf-8")
    write_index(source)
    run_doxygen(build, source / "extra")
    done = subprocess.run([sys.executable, "-m", "sphinx", "-q", "-j", "auto", "-c", str(HERE), "-b", "html",
                           "-D", f"html_extra_path={source / 'extra'}", str(source),
                           str(build / "html")], stderr=subprocess.PIPE, text=True)
    serious = [line for line in done.stderr.splitlines() if re.search(r"ERROR|not found|unknown document|nonexisting", line)]
    print("\n".join(serious), file=sys.stderr)
    if done.returncode:
        print(done.stderr, file=sys.stderr)
        sys.exit(done.returncode)
    print(f"{build / 'html' / 'index.html'}: {count} names of the Python package, {len(documents())} documents")
    sys.exit(1 if serious else 0)


if __name__ == "__main__":
    main()
