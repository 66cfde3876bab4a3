"""Every recipe of Documentation/Cookbook.md runs as it is printed, and makes a picture of something."""
import pathlib
import sys

import numpy as np
import pytest

from needs import needs_module

gdal = needs_module("osgeo.gdal", "python3-gdal")
gdal.UseExceptions()
ROOT = pathlib.Path(__file__).resolve().parents[3]
sys.path.insert(0, str(ROOT / "Documentation"))

from pictures import cookbook  # noqa: E402  (of the documents)

PRELUDE, RECIPES = cookbook.recipes()


def pixels(path):
    return np.moveaxis(gdal.Open(str(path)).ReadAsArray()[:3], 0, -1).astype(float)


def small(image):
    """A picture of 320 x 240 as means of 16 x 16 parts of it."""
    rows, columns = image.shape[0] // 12, image.shape[1] // 16
    return image[:12 * rows, :16 * columns].reshape(12, rows, 16, columns, 3).mean(axis=(1, 3))


@pytest.mark.parametrize("name", RECIPES)
def test_a_recipe_makes_its_picture(name, tmp_path):
    picture = pixels(cookbook.run(PRELUDE, name, RECIPES[name], tmp_path))
    assert picture.shape == (300, 400, 3)
    assert picture.std() > 4, "the picture shows nothing"
    # The page has this picture, smaller and compressed.
    shown = small(pixels(cookbook.IMAGES / "cookbook" / f"{name}.jpg"))
    assert np.abs(small(picture) - shown).mean() < 6


def test_the_pictures_are_those_of_the_recipes_and_small():
    files = sorted((cookbook.IMAGES / "cookbook").iterdir())
    assert [path.stem for path in files] == sorted(RECIPES) and len(files) >= 30
    assert sum(path.stat().st_size for path in files) < 1_500_000


def test_recipes_are_read_from_the_page():
    page = "# C\n\n```python\na = 1\n```\n\n## One\n\n![One](images/cookbook/one.jpg)\n\nText.\n\n```python\nb = a\n```\n"
    assert cookbook.recipes(page) == ("a = 1\n", {"one": "b = a\n"})
