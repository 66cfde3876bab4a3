"""The recipes of Cookbook.md: read from the page, run, and their pictures."""
import contextlib
import os
import pathlib
import re
import warnings

from pictures.paths import IMAGES, ROOT

PAGE = ROOT / "Documentation" / "Cookbook.md"
SIZE = (320, 240)  # pixels of a picture on the page


def recipes(text=None):
    """Returns the lines that every recipe begins with, and {name of its picture: code}."""
    text = PAGE.read_text(encoding="utf-8") if text is None else text
    head, *parts = re.split(r"^## ", text, flags=re.M)
    code = lambda part: re.search(r"^```python\n(.*?)^```", part, re.M | re.S)[1]
    found = {re.search(r"\(images/cookbook/(\w+)\.jpg\)", part)[1]: code(part) for part in parts}
    assert len(found) == len(parts), "two recipes have the same picture"
    return code(head), found


def run(prelude, name, code, folder):
    """Runs a recipe in a folder that has Data. Returns the path of its picture. A warning is an error."""
    data = pathlib.Path(folder) / "Data"
    if not data.exists():
        data.symlink_to(ROOT / "Data")
    before = os.getcwd()
    names = {"__name__": name}
    os.chdir(folder)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            exec(compile(prelude + code, f"Cookbook.md, {name}", "exec"), names)
    finally:
        os.chdir(before)
        if "session" in names:
            with contextlib.suppress(Exception):
                names["session"].close()
    picture = pathlib.Path(folder) / f"{name}.png"
    return picture if picture.exists() else min(pathlib.Path(folder).glob("flight/*.png"))


def cookbook():
    """The small pictures of the page."""
    import tempfile

    from osgeo import gdal
    gdal.UseExceptions()
    to = IMAGES / "cookbook"
    to.mkdir(exist_ok=True)
    prelude, found = recipes()
    for old in to.glob("*.jpg"):
        if old.stem not in found:
            old.unlink()
    for name, code in found.items():
        with tempfile.TemporaryDirectory() as folder:
            picture = run(prelude, name, code, folder)
            small = gdal.Translate("", str(picture), format="MEM", width=SIZE[0], height=SIZE[1], resampleAlg="average",
                                   bandList=[1, 2, 3])
            gdal.SetConfigOption("GDAL_PAM_ENABLED", "NO")
            gdal.GetDriverByName("JPEG").CreateCopy(str(to / f"{name}.jpg"), small, options=["QUALITY=82"])
