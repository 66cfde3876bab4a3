"""Settings and connection for all kinds of links to a server."""
import os

from dspace._core.fields import flag, number, reject, text
from dspace._core.replies import make_error, to_reply, warn
from dspace._core.signals import SLICE, check_signals
from dspace.errors import WrongType


def prepare(link, address, certificate, key, authority, insecure, timeout, label):
    """Checks the settings that all kinds of links share, and applies them to `link`. Returns a function that applies
    them to another link and returns that link."""
    if "\0" in text(address, "the address", label):
        reject(label, "the address", address, "one without a character of code 0")
    files = []
    for value, what in ((certificate, "certificate"), (key, "key"), (authority, "authority")):
        if value is not None and not isinstance(value, (str, os.PathLike)):
            reject(label, what, value, "the path of a PEM file", WrongType)
        files.append("" if value is None else os.path.abspath(os.fspath(value)))
    flag(insecure, "insecure", label)
    seconds = number(timeout, "the timeout", label)
    if not 0 < seconds <= 1e6:
        reject(label, "the timeout", timeout, "seconds above 0, up to 1e6")

    def prepared(other):
        other.SetCertificates(*files)
        other.SetInsecure(insecure)
        other.SetTimeout(seconds)
        return other

    prepared(link)
    if insecure:
        warn(f"{label}: nothing is encrypted, and the identity of the server is not checked")
    return prepared


def make_connection(link, address, name):
    """Connects a link of any kind. Raises the reason if the connection fails."""
    reply = to_reply(link.BeginConnect(address, name))
    state = -1 if reply.HasField("error") else 0
    while state == 0:
        state = link.WaitForConnect(SLICE)
        check_signals()
        if state < 0:
            reply = to_reply(link.TakeReply())
    if reply.HasField("error"):
        raise make_error(reply.error)
