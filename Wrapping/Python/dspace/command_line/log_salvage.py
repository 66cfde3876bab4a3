"""`dspace log salvage`: recovers the intact commands of a damaged recording (RecordingSalvage.h)."""
import os

from dspace.command_line.log_show import foreign_text
from dspace.recording.file import carry_out, path_of, unpack_limit_of


def salvage(options):
    report = carry_out("Salvage", os.fsencode(path_of(options.file)), os.fsencode(path_of(options.out)),
                       unpack_limit_of(options.unpack_limit)).salvage
    print(f"{options.out}: {report.commands} commands, {report.snapshots} snapshots, {report.assets} files")
    if report.begin_lost:
        print(f"lost: the state before command {report.begin + 1}")
    for each in report.lost:
        print(f"lost: commands {each.first} to {each.last}")
    for path in report.broken:
        print(f"lost: the packed content of {os.fsdecode(path)!r}")
    if report.unknown_assets:
        print(f"lost: what is known of {report.unknown_assets} files")
    if report.foreign.count:
        print(foreign_text(report.foreign))
    print(f"what came after {report.last_command} is not known, nor which files after the first {report.last_asset} it "
          "needs")
    return 1 if report.lost or report.broken or report.unknown_assets or report.begin_lost else 0
