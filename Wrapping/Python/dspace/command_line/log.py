"""`dspace log`: shows, compares, cuts, packs and salvages recordings."""
from dspace.command_line import later


def add_arguments(parser):
    what = parser.add_subparsers(dest="what", metavar="WHAT", required=True)
    info = what.add_parser("info", help="its duration and contents; reads and checks the complete file")
    info.add_argument("file", metavar="FILE")
    add_unpack_limit(info)
    info.set_defaults(run=later("log_show", "show"))
    cat = what.add_parser("cat", help="print its commands as text")
    cat.add_argument("file", metavar="FILE")
    cat.add_argument("--first", type=int, default=None, metavar="N", help="the number of the first command to print")
    cat.add_argument("--last", type=int, default=None, metavar="N")
    cat.set_defaults(run=later("log_show", "write_out"))
    diff = what.add_parser("diff", help="find where two runs differ; exit code 1 if they do")
    diff.add_argument("file", metavar="FILE")
    diff.add_argument("other", metavar="OTHER")
    diff.add_argument("--tolerance", type=float, default=0.0, metavar="E",
                      help="largest difference allowed in any floating-point number, in its own unit (poses: m, "
                           "and quaternion components); absent: 0")
    diff.set_defaults(run=later("log_diff", "compare"))
    cut = what.add_parser("cut", help="copy a part of it into a new recording")
    cut.add_argument("file", metavar="FILE")
    cut.add_argument("--from", dest="begin", type=float, metavar="T", help="simulation time [s]")
    cut.add_argument("--to", dest="end", type=float, metavar="T")
    cut.add_argument("--out", required=True, metavar="FILE")
    cut.set_defaults(run=later("log_show", "cut_out"))
    packing = what.add_parser("pack", help="copy the files that it needs into it, so that it replays anywhere; "
                                           "missing or changed files are rejected; files that could not be read when "
                                           "it was recorded are listed, exit code 1")
    packing.add_argument("file", metavar="FILE")
    packing.add_argument("--out", metavar="FILE", help="the packed recording; absent: FILE itself, which no other "
                                                       "process may write or read")
    packing.set_defaults(run=later("log_pack", "pack"))
    rescue = what.add_parser("salvage", help="recover every command of a damaged recording whose checksum matches; "
                                             "exit code 1 if some are lost")
    rescue.add_argument("file", metavar="FILE")
    rescue.add_argument("--out", required=True, metavar="FILE", help="the new recording")
    add_unpack_limit(rescue)
    rescue.set_defaults(run=later("log_salvage", "salvage"))
    add_telemetry(what)


def add_unpack_limit(parser):
    parser.add_argument("--unpack-limit", type=int, default=None, metavar="BYTES",
                        help="the most bytes that packed files may have unpacked; absent: 1 GiB and 20 times the "
                             "recording's size")


def add_telemetry(what):
    telemetry = what.add_parser("telemetry", help="named values over time; without --csv: a list of the names")
    telemetry.add_argument("file", metavar="FILE")
    telemetry.add_argument("--name", action="append", metavar="NAME",
                           help="a channel, or all channels below it (rover: rover/...); may be given several times; "
                                "absent: all")
    telemetry.add_argument("--scene", metavar="NAME")
    telemetry.add_argument("--csv", metavar="OUT", help="write a table of time, name, value and unit, in the order in "
                                                        "which values were set; '-': to the standard output")
    telemetry.set_defaults(run=later("log_telemetry", "list_telemetry"))
    events = what.add_parser("events", help="the events that the simulation logged")
    events.add_argument("file", metavar="FILE")
    events.add_argument("--kind", action="append", metavar="KIND", help="a kind of events; may be given several times")
    events.add_argument("--scene", metavar="NAME")
    events.add_argument("--csv", metavar="OUT", help="write them as a table; '-': to the standard output")
    events.set_defaults(run=later("log_telemetry", "list_events"))
