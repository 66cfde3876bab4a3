"""Makes a test authority and certificates with the openssl command."""
import os
import pathlib
import shutil
import subprocess
import tempfile

from dspace._core.files import atomic_write
from dspace.command_line import Failed

DAYS = "30"


def make_test_certificates(folder):
    """Writes ca.pem, server.pem, server.key, client.pem and client.key into `folder`, which must not have them. The
    authority's own key is deleted, so no further certificates can be issued. Raises Failed."""
    openssl = shutil.which("openssl")
    if not openssl:
        raise Failed("--make-test-certificates needs the openssl command (Debian: openssl)")
    folder = pathlib.Path(folder)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        tempfile.TemporaryFile(dir=folder).close()
    except OSError as error:
        raise Failed(f"--make-test-certificates {str(folder)!r}: {error.strerror}; accepted: a folder that may be made "
                     "and written") from None
    names = ("ca.pem", "server.pem", "server.key", "client.pem", "client.key")
    there = [name for name in names if (folder / name).exists()]
    if there:
        raise Failed(f"folder '{folder}': it has {', '.join(there)}; accepted: a folder without them")
    mask, made = os.umask(0o077), []
    try:
        with tempfile.TemporaryDirectory(prefix="dspace-certificates-") as work:  # deletes the authority's key
            work = pathlib.Path(work)
            _make(openssl, work)
            for name in names:
                atomic_write(folder / name, (work / name).read_bytes(), new=True)
                made.append(folder / name)
    except BaseException:
        for path in made:  # an incomplete set is useless
            path.unlink(missing_ok=True)
        raise
    finally:
        os.umask(mask)


def _make(openssl, folder):
    def run(*arguments):
        done = subprocess.run((openssl,) + arguments, cwd=folder, stdin=subprocess.DEVNULL,
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        if done.returncode:
            raise Failed(f"openssl {arguments[0]} failed: {done.stdout.strip()[-300:]}")

    new_key = ("-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes")
    run("req", "-x509", *new_key, "-keyout", "ca.key", "-out", "ca.pem", "-days", DAYS,
        "-subj", "/CN=Dspace test authority", "-addext", "basicConstraints=critical,CA:TRUE",
        "-addext", "keyUsage=critical,keyCertSign")
    for name, use in (("server", "serverAuth"), ("client", "clientAuth")):
        run("req", *new_key, "-keyout", f"{name}.key", "-out", "request.pem",
            "-subj", f"/CN=Dspace test {name}")
        atomic_write(folder / "extensions.txt",
                     f"extendedKeyUsage={use}\nsubjectAltName=DNS:localhost,IP:127.0.0.1,IP:::1\n".encode())
        run("x509", "-req", "-in", "request.pem", "-CA", "ca.pem", "-CAkey", "ca.key", "-CAcreateserial",
            "-out", f"{name}.pem", "-days", DAYS, "-extfile", "extensions.txt")
