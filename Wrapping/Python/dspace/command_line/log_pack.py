"""`dspace log pack`: a recording takes the files that it needs into itself."""
import contextlib
import os
import sqlite3

from dspace.command_line import Failed
from dspace.recording_assets import pack as pack_into
from dspace.recording_file import RecordingFile, new_recording


def pack(options):
    with RecordingFile(options.file) as file:
        _ = file.assets  # checked, before anything is written
        path = os.path.abspath(options.out or options.file)
        if options.out is not None:
            with new_recording(path) as copy:
                file.copy_to(copy)
    try:
        with contextlib.closing(sqlite3.connect(path, timeout=1)) as database:
            database.text_factory = os.fsdecode
            # In this mode nobody else may have it open: a writer would number its own rows as we do.
            database.execute("PRAGMA locking_mode=EXCLUSIVE")
            with database:
                database.execute("BEGIN IMMEDIATE")
            missing = pack_into(database, f"recording {path!r}")
            count, size = database.execute("SELECT count(*), coalesce(sum(size), 0) FROM asset WHERE packed").fetchone()
    except BaseException as error:
        if options.out is not None:
            os.unlink(path)  # what is not packed is not what was asked for
        if not isinstance(error, sqlite3.OperationalError):
            raise
        raise Failed(f"recording {path!r}: {error}; accepted: one that nobody is writing or reading, or --out") from None
    print(f"{options.out or options.file}: {count} files, {size} bytes, are packed")
    for each in missing:
        print(f"not packed: {each}")
    return 1 if missing else 0
