"""`dspace log pack`: copies the files that a recording needs into it (RecordingPack.h)."""
import os

from dspace.recording.file import carry_out, path_of


def pack(options):
    out = b"" if options.out is None else os.fsencode(path_of(options.out))
    report = carry_out("Pack", os.fsencode(path_of(options.file)), out).pack
    print(f"{options.out or options.file}: {report.files} files, {report.bytes} bytes, are packed")
    for each in report.missing:
        print(f"not packed: {os.fsdecode(each)}")
    return 1 if report.missing else 0
