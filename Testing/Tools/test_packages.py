"""./dspace installs everything that the sources use: an import or a find_package() without a package fails here."""
import ast
import pathlib
import re
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
FOLDERS = ("Data", "Documentation", "Examples", "Testing", "Wrapping")
# Python modules of others, and what find_package() and the like look for: the Debian packages that bring them.
MODULES = {"distributed": "python3-distributed", "google": "python3-protobuf", "grpc": "python3-grpcio",
           "cv2": "python3-opencv", "jinja2": "python3-jinja2", "jplephem": "python3-jplephem", "matplotlib": "python3-matplotlib",
           "mrcal": "python3-mrcal", "numpy": "python3-numpy", "OpenImageIO": "python3-openimageio", "osgeo": "python3-gdal", "pytest": "python3-pytest",
           "vtkmodules": "python3-vtk9"}
FOUND = {"assimp": "libassimp-dev", "Coin": "libcoin-dev", "console_bridge": "libconsole-bridge-dev",
         "Eigen3": "libeigen3-dev", "Freetype": "libfreetype-dev", "GDAL": "libgdal-dev", "gRPC": "libgrpc++-dev",
         "GTest": "libgtest-dev", "jsoncpp": "libjsoncpp-dev", "OpenGL": "libegl-dev",
         "OpenSceneGraph": "libopenscenegraph-dev", "OpenSSL": "libssl-dev", "PkgConfig": "pkg-config",
         "PROJ": "libproj-dev", "Protobuf": "libprotobuf-dev", "Python3": "libpython3-dev", "SQLite3": "libsqlite3-dev",
         "Threads": "g++", "tinyobjloader": "libtinyobjloader-dev", "urdfdom": "liburdfdom-dev", "VTK": "libvtk9-dev",
         "ZLIB": "zlib1g-dev", "PNG": "libpng-dev", "CAIRO": "libcairo2-dev", "embree": "libembree-dev",
         "ERFA": "liberfa-dev", "SECCOMP": "libseccomp-dev",
         "GEOGRAPHICLIB": "libgeographiclib-dev", "DSPACE_OIIO_INCLUDE": "libopenimageio-dev",
         "DSPACE_OIIO_LIBRARY": "libopenimageio-dev", "DSPACE_OIIO_UTIL_LIBRARY": "libopenimageio-dev",
         "DSPACE_IMATH_INCLUDE": "libimath-dev", "TinyGLTF": "libtinygltf-dev",
         "DSPACE_TINYXML_LIBRARY": "libtinyxml-dev", "Qt6": "qt6-base-dev"}
OPTIONAL = {"DSPACE_CCACHE", "grass"}  # used where it is installed
PROGRAMS = {"ffmpeg": "ffmpeg", "ffprobe": "ffmpeg", "openssl": "openssl", "ruby": "ruby-grpc",
            "protoc": "protobuf-compiler", "clang-format": "clang-format", "clang-tidy": "clang-tidy", "git": "git",
            "Xvfb": "xvfb", "xauth": "xauth", "openbox": "openbox", "glslangValidator": "glslang-tools",
            "xdotool": "xdotool", "strace": "strace", "doxygen": "doxygen", "solve-field": "astrometry.net"}


def listed(*kinds):
    return set(subprocess.run([ROOT / "dspace", "setup", "--list", *kinds], check=True, capture_output=True,
                              text=True).stdout.split())


def imports(path):
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (name.name.split(".")[0] for name in node.names)
        elif isinstance(node, ast.ImportFrom) and node.level == 0:
            yield node.module.split(".")[0]


def scripts(folder):
    return sorted(path for path in (ROOT / folder).rglob("*.py"))


def test_imported_modules():
    own = {name for folder in FOLDERS for path in scripts(folder) for name in (path.stem, path.parent.name)}
    own.add("dspace")
    needed = {name: set() for name in MODULES}
    for folder in FOLDERS:
        for path in scripts(folder):
            for name in set(imports(path)) - own - set(sys.stdlib_module_names):
                assert name in MODULES, f"{path.relative_to(ROOT)} imports {name}: which package brings it?"
                needed[name].add(path)
    everything = listed("run", "extra", "test", "bench")
    assert {MODULES[name] for name, paths in needed.items() if paths} <= everything
    # The demo installs only what it runs: nothing that it imports at its start is among the extra packages.
    demo = {name for path in scripts("Examples/rover_drive") for name in imports(path)} & set(MODULES)
    assert {MODULES[name] for name in demo} <= listed("run")


def test_found_packages():
    pattern = re.compile(r"^\s*(?:find_package|find_path|find_library|find_program|pkg_check_modules)\((\w+)",
                         re.MULTILINE)
    names = set()
    for folder in ("CMake", "Libraries", "Testing/Benchmarks", "Wrapping", "."):
        files = [ROOT / "CMakeLists.txt"] if folder == "." else [
            path for pattern_ in ("CMakeLists.txt", "*.cmake") for path in (ROOT / folder).rglob(pattern_)]
        for path in files:
            found = set(pattern.findall(path.read_text(encoding="utf-8"))) - OPTIONAL
            unknown = found - set(FOUND)
            assert not unknown, f"{path.relative_to(ROOT)} looks for {unknown}: which package brings it?"
            names |= found
    assert set(FOUND) - names == set(), "the table names what nothing looks for"
    assert {FOUND[name] for name in names} <= listed("build", "app", "test", "bench")


def programs(path):
    """The programs that a script names: the first word of a command, or what it looks for in PATH."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if not isinstance(node, ast.Call) or not node.args:
            continue
        name, first = ast.unparse(node.func), node.args[0]
        if name in ("subprocess.run", "subprocess.Popen") and isinstance(first, ast.List):
            first = first.elts[0]
        elif name not in ("shutil.which", "needs_program"):
            continue
        if isinstance(first, ast.Constant):
            yield first.value


def test_programs_that_scripts_call():
    names = {name for folder in FOLDERS for path in scripts(folder) if path.parent != HERE
             and path.name != "test_needs.py" for name in programs(path)}
    assert {"openssl", "protoc", "ruby"} <= names <= set(PROGRAMS) | OPTIONAL
    assert set(PROGRAMS.values()) <= listed("run", "extra", "build", "test", "lint", "docs")


def test_packages_whose_lack_tests_report():
    pattern = re.compile(r"\b(?:needs_module|needs_program)\([^,()]+, \"([^\"]+)\"\)|\blacks\(\"([^\"]+)\"\)")
    names = {name for path in scripts("Testing/Python") if path.name != "test_needs.py"
             for found in pattern.findall(path.read_text(encoding="utf-8")) for name in found if name}
    missing = re.compile(r"DSPACE_MISSING_PACKAGE\(\"([^\"]+)\"\)")
    names |= {name for path in (ROOT / "Libraries").glob("*/Testing/**/*.cxx")
              for name in missing.findall(path.read_text(encoding="utf-8"))}
    assert {"python3-gdal", "python3-distributed", "proj-data", "glslang-tools"} <= names
    assert names <= listed("run", "extra", "build", "app", "test")


def test_lists_hold_existing_kinds_only():
    done = subprocess.run([ROOT / "dspace", "setup", "--list", "demo"], capture_output=True, text=True)
    assert done.returncode == 2 and "there are no packages for 'demo'; accepted: build run extra app test bench lint docs" in (
        done.stderr)
