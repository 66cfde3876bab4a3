"""Catalogues of stars: where they are, how bright, of which colour."""
from dspace.stars.catalog import StarCatalog, bright_stars, read_stars
from dspace.stars.kstars import read_kstars
from dspace.stars.stellarium import read_stellarium

__all__ = ["StarCatalog", "bright_stars", "read_kstars", "read_stars", "read_stellarium"]
