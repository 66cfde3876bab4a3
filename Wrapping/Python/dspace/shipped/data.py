"""Where the shipped data are."""
import os
import pathlib

from dspace.errors import NotFound


def shipped_data():
    """The folder Data of the source tree, or of the installed one."""
    given = os.environ.get("DSPACE_SHIPPED_DATA")
    above = pathlib.Path(__file__).resolve().parents[4:7]
    folders = [pathlib.Path(given)] if given else [each / end for each in above for end in ("Data", "share/dspace/Data")]
    for folder in folders:
        if (folder / "field" / "field.tif").exists():
            return folder
    raise NotFound("the data of the demo are not there; accepted: a source tree, an installed one, or its folder Data "
                   "named by DSPACE_SHIPPED_DATA", f"folder {str(folders[0])!r}")
