"""What the links to a server share: their settings, and waits that hear Ctrl-C."""
import os
import time

from dspace._client import make_error, to_reply, warn
from dspace._fields import flag, number, refuse, text
from dspace.errors import WrongType

SLICE = 0.1  # [s] of a wait without hearing signals


def hear_signals():
    """Between two slices of a wait. CPython 3.11 does not notice a signal that another thread than the main one has
    caught, such as gRPC's, until its lock has been let go, which this does."""
    time.sleep(0)


def prepare(link, address, certificate, key, authority, insecure, timeout, label):
    """What connect() and watch() share: checks, and sets what all kinds of links take. Returns a function that sets
    the same on another link, and returns that."""
    if "\0" in text(address, "the address", label):
        refuse(label, "the address", address, "one without a character of code 0")
    files = []
    for value, what in ((certificate, "certificate"), (key, "key"), (authority, "authority")):
        if value is not None and not isinstance(value, (str, os.PathLike)):
            refuse(label, what, value, "the path of a PEM file", WrongType)
        files.append("" if value is None else os.path.abspath(os.fspath(value)))
    flag(insecure, "insecure", label)
    seconds = number(timeout, "the timeout", label)
    if not 0 < seconds <= 1e6:
        refuse(label, "the timeout", timeout, "seconds above 0, up to 1e6")

    def prepared(other):
        other.SetCertificates(*files)
        other.SetInsecure(insecure)
        other.SetTimeout(seconds)
        return other

    prepared(link)
    if insecure:
        warn(f"{label}: nothing is encrypted, and nobody knows who is there")
    return prepared


def make_connection(link, address, name):
    """Of all kinds of links; raises why there is none."""
    reply = to_reply(link.BeginConnect(address, name))
    state = -1 if reply.HasField("error") else 0
    while state == 0:
        state = link.WaitForConnect(SLICE)
        hear_signals()
        if state < 0:
            reply = to_reply(link.TakeReply())
    if reply.HasField("error"):
        raise make_error(reply.error)
