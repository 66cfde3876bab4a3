"""Stars of the package kstars-data: 125,982 of the Hipparcos and Tycho catalogues."""
import os

import numpy as np

from dspace._core.replies import warn
from dspace.errors import Corrupt, Io, NotFound
from dspace.stars.catalog import StarCatalog

KSTARS_PATH = "/usr/share/kstars/stars.dat"


def read_kstars(path=KSTARS_PATH):
    """The star catalogue that the Debian package kstars-data installs, as a StarCatalog of the epoch J2000.

    The file is read where it is and never copied: it is under the GPL, made of the Hipparcos and Tycho catalogues (ESA
    1997, public domain), to magnitude 9. Positions are those of 2000.0, to 0.2 arcsec. Names are the common ones. Lines
    without position or magnitude are left out with a warning."""
    path = os.fspath(path)
    label = f"file {path!r}"
    try:
        with open(path, encoding="utf-8", errors="replace") as file:
            lines = [line for line in file if line.strip() and not line.startswith("#")]
    except FileNotFoundError:
        raise NotFound(f"{label}: it does not exist; accepted: stars.dat of the package kstars-data (apt-get install "
                       f"kstars-data)", label) from None
    except OSError as error:
        raise Io(f"{label}: {error.strerror}", label) from None
    rows, names, left_out = [], [], 0
    for line in lines:
        try:
            rows.append(_row(line))
            parts = line[56:].split(",")
            names.append(parts[2].strip() if len(parts) > 2 else "")
        except ValueError:
            left_out += 1
    if not rows:
        raise Corrupt(f"{label}: no line of it has a star; accepted: stars.dat of the package kstars-data", label)
    if left_out:
        warn(f"{label}: {left_out} stars without position or magnitude are left out")
    ra, dec, pm_ra, pm_dec, parallax, magnitude, color = np.array(rows).T
    return StarCatalog(ra, dec, magnitude, color, pm_ra, pm_dec, np.maximum(parallax, 0.0), names)


def _row(line):
    """Fixed columns: hhmmss.ss, +ddmmss.s, proper motions and parallax [mas], V, B-V."""
    ra = 15.0 * (int(line[0:2]) + int(line[2:4]) / 60.0 + float(line[4:9]) / 3600.0)
    dec = int(line[11:13]) + int(line[13:15]) / 60.0 + float(line[15:19]) / 3600.0
    sign = {"+": 1.0, "-": -1.0}.get(line[10])
    if sign is None:
        raise ValueError(line[10])
    values = (float(line[a:b]) for a, b in ((20, 29), (29, 38), (38, 45)))
    pm_ra, pm_dec, parallax = (1e-3 * value for value in values)
    return ra, sign * dec, pm_ra, pm_dec, parallax, float(line[46:51]), float(line[51:56])
