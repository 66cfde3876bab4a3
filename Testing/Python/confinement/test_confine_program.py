"""dspace-confine: what is left to a program that it becomes."""
import os
import socket
import subprocess
import time

import pytest

from dspace.command_line import confinement

PYTHON = ["/usr/bin/python3", "-I", "-c"]
SYSTEM = [word for place in ("/usr", "/lib", "/lib64") if os.path.exists(place) for word in ("--program", place)] + [
    "--read", "/etc/ld.so.cache", "--device", "/dev/null"]


def run(rules, *words, **options):
    return subprocess.run([confinement.program(), *map(str, rules), "--", *map(str, words)], capture_output=True, text=True,
                          **options)


def landlock_abi():
    """As the launcher says."""
    said = run(["--program", "/"], *PYTHON, "import os; print(os.environ['DSPACE_CONFINED'])").stdout.split()
    return int(said[1]) if said[0] == "landlock" else 0


@pytest.fixture
def folders(tmp_path):
    """One that is allowed and one that is not, with a file in each."""
    for name in ("inside", "outside"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "file").write_text(name)
    return tmp_path / "inside", tmp_path / "outside"


def needs(version):
    if landlock_abi() < version:
        pytest.skip(f"this kernel has no Landlock of version {version}")


# --- Files ------------------------------------------------------------------------------------------

@pytest.mark.parametrize("version", range(1, 8))
def test_files_outside_are_neither_read_nor_changed(folders, version):
    """With the rights of each version of Landlock that this kernel knows."""
    needs(version)
    inside, outside = folders
    (inside / "link").symlink_to(outside / "file")
    (inside / "hard").write_text("x")
    script = f"""
import os
inside, outside = {str(inside)!r}, {str(outside)!r}
assert open(inside + "/file").read() == "inside"
open(inside + "/new", "w").write("new")
os.rename(inside + "/new", inside + "/newer")
os.mkdir(inside + "/folder")
os.truncate(inside + "/newer", 1) if {version >= 3} else None
os.unlink(inside + "/newer")
os.rmdir(inside + "/folder")
for what in (lambda: open(outside + "/file"), lambda: open(outside + "/file", "r+"), lambda: open(outside + "/new", "w"),
             lambda: open(inside + "/link"), lambda: open(inside + "/../outside/file"), lambda: os.listdir(outside),
             lambda: os.unlink(outside + "/file"), lambda: os.rename(outside + "/file", inside + "/taken"),
             lambda: os.rename(inside + "/hard", outside + "/hard"), lambda: os.link(outside + "/file", inside + "/taken"),
             lambda: os.truncate(outside + "/file", 0), lambda: os.mkdir(outside + "/folder"), lambda: os.rmdir(outside),
             lambda: os.symlink("/", inside + "/root"), lambda: os.mkfifo(inside + "/pipe"), lambda: os.chmod(outside + "/file", 0),
             lambda: os.chown(outside + "/file", 1, 1), lambda: os.utime(outside + "/file", (0, 0)),
             lambda: os.setxattr(outside + "/file", "user.a", b"b"), lambda: os.chmod(inside + "/file", 0)):
    try:
        what()
    except OSError as error:
        assert error.errno in (1, 13, 18), error
    else:
        raise AssertionError(what.__code__.co_consts)
"""
    before = os.stat(outside / "file")
    done = run(["--abi", version, *SYSTEM, "--write", inside], *PYTHON, script)
    assert done.returncode == 0, done.stderr
    after = os.stat(outside / "file")
    assert (outside / "file").read_text() == "outside" and os.listdir(outside) == ["file"]
    assert (before.st_mode, before.st_mtime_ns, before.st_uid) == (after.st_mode, after.st_mtime_ns, after.st_uid)


def test_what_may_be_read_may_not_be_written(folders):
    needs(1)
    inside, _ = folders
    done = run([*SYSTEM, "--read", inside], "/bin/sh", "-c", f"cat {inside}/file; echo x > {inside}/file; {inside}/file")
    assert done.stdout == "inside" and done.stderr.lower().count("permission denied") == 2
    assert (inside / "file").read_text() == "inside"


def test_a_file_is_allowed_without_its_folder(folders):
    needs(1)
    inside, _ = folders
    (inside / "other").write_text("other")
    done = run([*SYSTEM, "--read", inside / "file"], "/bin/sh", "-c", f"cat {inside}/file; cat {inside}/other; ls {inside}")
    assert done.stdout == "inside" and done.stderr.lower().count("permission denied") == 2


def test_a_descriptor_of_the_caller_is_not_left(folders):
    _, outside = folders
    with open(outside / "file") as file:
        os.set_inheritable(file.fileno(), True)
        done = run(SYSTEM, "/bin/sh", "-c", f"cat <&{file.fileno()}", pass_fds=[file.fileno()])
    assert done.returncode != 0 and done.stdout == ""


def test_a_child_has_no_more_rights(folders):
    needs(1)
    _, outside = folders
    done = run(SYSTEM, "/bin/sh", "-c", f"sh -c 'cat {outside}/file'; exec cat {outside}/file")
    assert done.stdout == "" and done.stderr.lower().count("permission denied") == 2


# --- Sockets and other calls ------------------------------------------------------------------------

SOCKETS = """
import socket, sys
port, path = int(sys.argv[1]), sys.argv[2]
def may(name, what):
    try:
        what()
        print(name)
    except OSError as error:
        assert error.errno in (1, 13), (name, error)
may("tcp", lambda: socket.create_connection(("127.0.0.1", port)).close())
may("fast", lambda: socket.socket().sendto(b"a", 0x20000000, ("127.0.0.1", port)))
may("udp", lambda: socket.socket(type=socket.SOCK_DGRAM).sendto(b"a", ("127.0.0.1", port)))
may("unix", lambda: socket.socket(socket.AF_UNIX).connect(path))
may("unix messages", lambda: socket.socketpair(type=socket.SOCK_DGRAM))
may("listen", lambda: socket.create_server(("127.0.0.1", 0)).close())
may("listen unix", lambda: socket.socket(socket.AF_UNIX).bind(path + "2"))
may("packet", lambda: socket.socket(socket.AF_PACKET, socket.SOCK_DGRAM))
may("vsock", lambda: socket.socket(socket.AF_VSOCK))
may("pair", lambda: socket.socketpair())
socket.socketpair(type=socket.SOCK_SEQPACKET)
"""


@pytest.mark.parametrize("rules, expected", [
    ((), ["pair"]), (("--listen",), ["listen", "pair"]), (("--listen-unix", "--socket", "HERE"), ["listen unix", "pair"]),
    (("--connect",), ["tcp", "fast", "udp", "unix", "unix messages", "pair"]),
    (("--listen", "--connect"), ["tcp", "fast", "udp", "unix", "unix messages", "listen", "pair"])])
@pytest.mark.parametrize("version", [0, 7])
def test_sockets(tmp_path, rules, expected, version):
    """The filter of calls suffices without Landlock; of `listen` with `connect` alone, Landlock stops TCP."""
    with socket.create_server(("127.0.0.1", 0)) as server, socket.socket(socket.AF_UNIX) as other:
        other.bind(str(tmp_path / "socket"))
        other.listen()
        rules = [tmp_path if word == "HERE" else word for word in rules]
        done = run(["--abi", version, *SYSTEM, *rules], *PYTHON, SOCKETS, server.getsockname()[1], tmp_path / "socket")
    assert done.returncode == 0, done.stderr
    got = done.stdout.splitlines()
    if min(version, landlock_abi()) < 4 and "--connect" in rules:  # a socket that may connect can be bound
        expected = [*expected[:5], "listen", "listen unix", *expected[-1:]]
    elif min(version, landlock_abi()) < 1 and "--listen" in rules:  # paths are not restricted
        expected = ["listen", "listen unix", "pair"]
    assert got == expected


def test_calls_that_reach_around_are_rejected():
    script = """
import ctypes, errno, os, signal
libc = ctypes.CDLL(None, use_errno=True)
def number(call, *arguments):
    result = libc.syscall(call, *arguments)
    return 0 if result >= 0 else ctypes.get_errno()
rejected = {101: "ptrace", 310: "process_vm_readv", 165: "mount", 272: "unshare", 308: "setns", 161: "chroot", 304:
            "open_by_handle_at", 250: "keyctl", 321: "bpf", 323: "userfaultfd", 175: "init_module", 169: "reboot", 298:
            "perf_event_open", 90: "chmod", 452: "fchmodat2", 227: "clock_settime", 29: "shmget", 68: "msgget", 240: "mq_open"}
for call, name in rejected.items():
    assert number(call, 0, 0, 0, 0, 0) == errno.EPERM, name
for call in (425, 426, 427, 435):  # io_uring, clone3
    assert number(call, 0, 0) == errno.ENOSYS, call
assert number(56, 0x10000000 | signal.SIGCHLD, 0, 0, 0, 0) == errno.EPERM  # clone with a user namespace
assert number(16, 0, 0x5412, ctypes.create_string_buffer(b"x")) == errno.EPERM  # ioctl TIOCSTI
assert number(302, 1, 7, None, None) == errno.EPERM and number(302, 0, 7, None, None) == 0  # prlimit64
child = os.fork()
if not child:
    os._exit(7)
assert os.waitpid(child, 0)[1] == 7 << 8
"""
    if os.uname().machine != "x86_64":
        pytest.skip("the numbers of system calls are those of x86_64")
    done = run(SYSTEM, *PYTHON, script)
    assert done.returncode == 0, done.stderr


def test_no_new_privileges():
    done = run([*SYSTEM, "--read", "/proc"], *PYTHON, "print(open('/proc/self/status').read())")
    assert "NoNewPrivs:\t1" in done.stdout and "Seccomp:\t2" in done.stdout


def test_signals_to_others():
    needs(6)
    done = run(SYSTEM, *PYTHON, "import os, sys\ntry: os.kill(int(sys.argv[1]), 0)\nexcept PermissionError: print('rejected')",
               os.getpid())
    assert done.stdout == "rejected\n", done.stderr


# --- The program itself -----------------------------------------------------------------------------

def test_its_exit_code_and_messages(tmp_path):
    assert run(SYSTEM, "/bin/sh", "-c", "exit 7").returncode == 7
    for rules, words, said in (
            ([], [], "no program is given"), (["--nonsense", "x"], ["/bin/true"], "'--nonsense' is no rule"),
            (["--read", tmp_path / "none"], ["/bin/true"], f"'{tmp_path}/none': No such file"),
            (["--abi", "x"], ["/bin/true"], "--abi 'x'; accepted: an integer"),
            (["--rules", 99], ["/bin/true"], "--rules 99: it cannot be read"),
            (SYSTEM, [tmp_path / "none"], f"'{tmp_path}/none': No such file")):
        done = run(rules, *words)
        assert done.returncode == 126 and done.stderr.startswith("dspace-confine: ") and said in done.stderr, done.stderr


def test_rules_of_a_file(folders):
    needs(1)
    inside, _ = folders
    rules = confinement.Rules()
    rules.words = [str(word) for word in [*SYSTEM, "--read", inside]]
    with open(confinement.rules_file(rules), "rb") as file:
        done = run(["--rules", file.fileno()], "/bin/cat", inside / "file", pass_fds=[file.fileno()])
    assert done.stdout == "inside", done.stderr


def test_a_kernel_without_landlock_is_told():
    done = run(["--abi", "0"], *PYTHON, "import os; print(os.environ['DSPACE_CONFINED'])")
    assert done.stdout == "no landlock\n"


def test_a_temporary_folder(tmp_path):
    """It is the program's only folder to write, and ends with it in any way; nothing else of it stays."""
    needs(1)
    script = "touch $TMPDIR/a; mkdir $TMPDIR/b; echo $TMPDIR; touch {0}/c; ls $TMPDIR; {1}"
    for end, code in (("exit 0", 0), ("kill -9 $$", -9)):
        done = run([*SYSTEM, "--temporary", tmp_path], "/bin/sh", "-c", script.format(tmp_path, end))
        folder, *names = done.stdout.split()
        assert done.returncode == code and names == ["a", "b"] and folder.startswith(f"{tmp_path}/dspace-confined-")
        limit = time.monotonic() + 60
        while os.path.exists(folder):
            assert time.monotonic() < limit
            time.sleep(0.01)
        assert os.listdir(tmp_path) == []
    done = run([*SYSTEM, "--temporary", tmp_path / "none"], "/bin/true")
    assert done.returncode == 126 and f"temporary folder in '{tmp_path}/none': No such file" in done.stderr
