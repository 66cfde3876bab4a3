"""Paths of the pictures of the documentation."""
import os
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[2]
IMAGES = ROOT / "Documentation" / "images"
DATA = os.environ.get("DSPACE_DATA", "")  # real data; empty: pictures of them are left as they are
