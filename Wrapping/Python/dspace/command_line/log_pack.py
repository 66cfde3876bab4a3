"""`dspace log pack`: a recording takes the files that it needs into itself."""
import contextlib
import os
import sqlite3

from dspace.command_line import Failed
from dspace.errors import NotFound
from dspace.recording_assets import pack as pack_into
from dspace.recording_file import RecordingFile, new_recording


def require(label, gone):
    """Refuses files that have gone; without them what is packed would replay nowhere."""
    if gone:
        more = f", nor {len(gone) - 1} more" if len(gone) > 1 else ""
        raise NotFound(f"{label}: its file {gone[0]!r} is not there{more}; accepted: all of them as they were recorded",
                       gone[0])


def pack_all(database, path, needed):
    """Returns the paths of what is not packed, and how many files and bytes are."""
    database.text_factory = os.fsdecode
    missing = pack_into(database, f"recording {path!r}")
    require(f"recording {path!r}", [each for each in missing if each in needed])
    return missing, *database.execute("SELECT count(*), coalesce(sum(size), 0) FROM asset WHERE packed").fetchone()


def pack_itself(path, needed):
    """pack_all() of a recording that is there."""
    try:
        with contextlib.closing(sqlite3.connect(path, timeout=1)) as database:
            # In this mode nobody else may have it open: a writer would number its own rows as we do.
            database.execute("PRAGMA locking_mode=EXCLUSIVE")
            with database:
                database.execute("BEGIN IMMEDIATE")
            return pack_all(database, path, needed)
    except sqlite3.OperationalError as error:
        raise Failed(f"recording {path!r}: {error}; accepted: one that nobody is writing or reading, or --out") from None


def pack(options):
    with RecordingFile(options.file) as file:
        needed = {each.path for each in file.assets if each.state == "read" and not each.packed}
        require(file.label, [each for each in sorted(needed) if not os.path.isfile(each)])  # before anything is written
        path = os.path.abspath(options.out or options.file)
        if options.out is not None:
            with new_recording(path) as copy:  # what is not packed is not what was asked for, and does not stay
                file.copy_to(copy)
                missing, count, size = pack_all(copy, path, needed)
    if options.out is None:
        missing, count, size = pack_itself(path, needed)
    print(f"{options.out or options.file}: {count} files, {size} bytes, are packed")
    for each in missing:
        print(f"not packed: {each}")
    return 1 if missing else 0
