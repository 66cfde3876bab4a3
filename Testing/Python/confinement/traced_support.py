"""Which files a process opened and which sockets it made, as `strace` shows them."""
import json
import pathlib
import re
import subprocess

from needs import needs_program

_OPENED = re.compile(r'(?:openat\([^,]*, |open\(|creat\()"((?:[^"\\]|\\.)*)".* = (-?\d+)')
_CALL = re.compile(r"(socket|connect|sendto)\((.*)\) = (-?\d+)")


def command(log):
    """The words before those of a program, so that all its threads and children are traced into files `log`.PID."""
    return [needs_program("strace", "strace"), "-ff", "-qq", "-s", "4096", "-o", str(log),
            "-e", "trace=open,openat,creat,stat,newfstatat,socket,connect"]


def lines(log):
    log = pathlib.Path(log)
    files = log.parent.glob(log.name + ".*")
    for file in sorted(files, key=lambda each: int(each.suffix[1:])):
        yield from file.read_text(errors="replace").splitlines()


def opened(line, folder):
    """The path below a folder, with links resolved, that a line shows as opened, else None; and whether that succeeded."""
    found = _OPENED.match(line)
    if not found or not found[1].startswith("/"):
        return None, False
    path = pathlib.Path(found[1].encode().decode("unicode_escape", errors="replace"))
    if folder not in path.parents and folder not in path.resolve().parents:
        return None, False
    return str(path), int(found[2]) >= 0


def outgoing(line):
    """Whether a line shows a socket of a network, or a connection to anything."""
    found = _CALL.match(line)
    return bool(found) and (found[1] == "connect" or "AF_INET" in found[2]) and int(found[3]) >= 0


# Opens each document of the standard input with all of GDAL, in a child of its own, and reads it. What it looks at first
# is the name of the document, which so stands in the trace.
PROBE = """
import json, os, sys
from osgeo import gdal
gdal.DontUseExceptions()
gdal.PushErrorHandler("CPLQuietErrorHandler")
gdal.SetConfigOption("GDAL_HTTP_TIMEOUT", "5")
def read(path, shapes):
    data = gdal.OpenEx(path, gdal.OF_VECTOR if shapes else gdal.OF_RASTER)
    for i in range(data.GetLayerCount() if data and shapes else 0):
        data.GetLayer(i).GetNextFeature()
    for i in range(min(4, data.RasterCount) if data else 0):
        band = data.GetRasterBand(i + 1)
        bands = [band, band.GetMaskBand()] + [band.GetOverview(k) for k in range(band.GetOverviewCount())]
        for each in filter(None, bands):
            each.ReadRaster(buf_xsize=4, buf_ysize=4)
            each.ReadRaster()
for line in sys.stdin:
    name, path, shapes = json.loads(line)
    child = os.fork()
    if child:
        os.waitpid(child, 0)
        continue
    try:
        os.stat("/document/" + name)
    except OSError:
        pass
    read(path, shapes)
    os._exit(0)
"""


def probe(log, documents, before=()):
    """Traces all of GDAL as it opens documents. before: words of a program that restricts it."""
    text = "".join(json.dumps(each) + "\n" for each in documents)
    subprocess.run([*command(log), *before, "/usr/bin/python3", "-I", "-W", "ignore", "-c", PROBE], input=text, text=True,
                   check=True)


def by_document(log):
    """{name: lines} of a probe's trace."""
    found, name = {}, None
    for line in lines(log):
        start = re.search(r'"/document/([^"]+)"', line)
        if start:
            name = start[1]
        elif name is not None:
            found.setdefault(name, []).append(line)
    return found
