"""`dspace serve`: serves a session to simulations and viewers in other processes."""
import contextlib
import faulthandler
import math
import os
import select
import signal
import socket
import stat
import sys
import time

from dspace.command_line import Failed, confinement, set_limits
from dspace.command_line.certificates import make_test_certificates

TO_END = 60.0  # time limit [s] for closing connections after the session has ended


def add_arguments(parser):
    parser.add_argument("--listen", default="127.0.0.1:0", metavar="ADDRESS",
                        help="unix:PATH or host:port, port 0 for a free one (default 127.0.0.1:0); addresses "
                        "beyond this machine need certificates or --insecure")
    parser.add_argument("--name", default="dspace", help="the server's name, shown to clients (default dspace)")
    parser.add_argument("--cert", default="", metavar="PEM", help="the server's certificate")
    parser.add_argument("--key", default="", metavar="PEM", help="the private key of the certificate")
    parser.add_argument("--ca", default="", metavar="PEM", help="the authority that signed the clients' certificates")
    parser.add_argument("--insecure", action="store_true",
                        help="listen beyond this machine without encryption and without checking clients")
    parser.add_argument("--allow-root", action="append", metavar="DIR",
                        help="a folder whose files commands may name, for reading and writing; may be "
                        "given several times (default: the working folder)")
    parser.add_argument("--max-message", type=int, default=64 << 20, metavar="BYTES",
                        help="largest size of a message to the server (default 64 MiB)")
    parser.add_argument("--max-connections", type=int, default=32, metavar="N",
                        help="largest number of connections (default 32)")
    parser.add_argument("--max-frames", type=int, default=1000000, metavar="N",
                        help="largest number of frames in one scene (default 1,000,000)")
    parser.add_argument("--max-rate", type=float, default=100000.0, metavar="N",
                        help="largest number of commands a second; a faster simulation is slowed down "
                        "(default 100,000)")
    parser.add_argument("--limit", action="append", metavar="NAME=VALUE", default=[],
                        help="a limit of memory or time, see dspace.limits; may be given several times")
    parser.add_argument("--fresh-on-connect", action="store_true",
                        help="remove the scenes and viewports of earlier simulations when another one connects "
                        "(one that comes back after a broken connection goes on with its own)")
    parser.add_argument("--record", metavar="FILE", help="record the session into a new file, for `dspace play`")
    parser.add_argument("--pack", action="store_true", help="with --record: include the files that commands need")
    confinement.add_argument(parser, "the server")
    parser.add_argument("--allow-network", action="store_true",
                        help="allow connections to other machines, for a host name of --listen that DNS resolves")
    parser.add_argument("--end-with-input", action="store_true",
                        help="end when the standard input does, that is with the program that started the server")
    parser.add_argument("--make-test-certificates", metavar="DIR",
                        help="write an authority and certificates for a server and clients on this machine "
                        "into DIR, and exit; for tests only")
    parser.set_defaults(run=run)


def input_ended():
    return bool(select.select([0], [], [], 0)[0]) and not os.read(0, 4096)


def remove_left(path):
    """Removes the socket of a server that has died: a confined server cannot ask whether it lives."""
    with contextlib.suppress(OSError), socket.socket(socket.AF_UNIX) as probe:
        probe.setblocking(False)
        try:
            probe.connect(path)
        except ConnectionRefusedError:
            if stat.S_ISSOCK(os.lstat(path).st_mode):
                os.unlink(path)


def rules_of(options):
    """What the server may do: read and write in the roots, and what its options name."""
    is_unix = options.listen.startswith("unix:")
    rules = confinement.Rules(listen="listen-unix" if is_unix else "listen", connect=options.allow_network)
    for root in options.allow_root or [os.getcwd()]:
        rules.add("write", root)
    for path in (options.cert, options.key, options.ca):
        rules.add("read", path)
    if options.record:
        rules.add("write", os.path.dirname(os.path.abspath(options.record)))
    if is_unix:
        path = os.path.abspath(options.listen[len("unix:"):])
        remove_left(path)
        rules.add("socket", os.path.dirname(path))
    rules.add_cache()
    return rules


def run(options):
    if options.make_test_certificates:
        make_test_certificates(options.make_test_certificates)
        return 0
    for name, value, accepted in (
            ("--max-message", options.max_message, (1 << 10, 1 << 30, "1024 to 1073741824 bytes")),
            ("--max-connections", options.max_connections, (1, 1000, "1 to 1000")),
            ("--max-frames", options.max_frames, (1, math.inf, "1 or more")),
            ("--max-rate", options.max_rate, (sys.float_info.min, math.inf, "any number above 0"))):
        if not accepted[0] <= value <= accepted[1]:
            raise Failed(f"{name} {value:{'g' if isinstance(value, float) else ''}}; accepted: {accepted[2]}")
    files_are_restricted = confinement.confine(options, lambda: rules_of(options),
                                                 confinement.SAFEST_FORMATS)
    from dspace import vtk
    set_limits(options.limit)
    server = vtk.vtkDspaceServer()
    if not files_are_restricted:
        server.GetSession().ConfineProcess(True)
    server.SetListen(options.listen)
    server.SetName(options.name)
    server.SetCertificates(options.cert, options.key, options.ca)
    server.SetInsecure(options.insecure)
    for root in options.allow_root or [os.getcwd()]:
        server.AddAllowedRoot(root)
    server.SetMaximumMessage(options.max_message)
    server.SetMaximumConnections(options.max_connections)
    server.SetMaximumFrames(min(options.max_frames, 1 << 62))
    server.SetMaximumRate(options.max_rate)
    server.SetFreshOnConnect(options.fresh_on_connect)
    stop = []
    for number in (signal.SIGTERM, signal.SIGINT):
        signal.signal(number, lambda *_: stop.append(True))
    if options.pack and options.record is None:
        raise Failed("--pack without --record; accepted: both")
    if options.record is not None:
        if not options.record:
            raise Failed("--record ''; accepted: a new file")
        if os.path.lexists(options.record):
            raise Failed(f"--record {options.record!r}: there is such a file; accepted: a new one")
        trouble = server.GetSession().Record(os.path.abspath(options.record), 0.1, options.pack)
        if trouble:
            raise Failed(trouble)
    trouble = server.Start()
    if trouble:
        if options.record is not None:  # an empty recording would block the next start
            server.GetSession().StopRecording()
            for end in ("", "-wal", "-shm"):
                with contextlib.suppress(OSError):
                    os.unlink(options.record + end)
        raise Failed(trouble)
    if options.insecure and not options.cert:
        print("dspace: note: --insecure: nothing is encrypted, and anyone who reaches the server may drive it",
              file=sys.stderr, flush=True)
    print(f"dspace serve: listening on {server.GetAddress()}", flush=True)
    while not stop and server.Run(0.2):
        time.sleep(0)  # lets Python handle a signal that another thread received
        if options.end_with_input and input_ended():
            break
    server.Stop()
    trouble = server.GetSession().StopRecording()
    for path in server.GetSession().GetRecordingMissing().splitlines():
        print(f"dspace: note: not packed: {path}", file=sys.stderr, flush=True)
    # Everything is written. If closing the connections hangs, print where and exit.
    faulthandler.dump_traceback_later(TO_END, exit=True)
    if trouble:
        raise Failed(trouble)
    return 0
