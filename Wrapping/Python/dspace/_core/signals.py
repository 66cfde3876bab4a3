"""Waits that Ctrl-C can interrupt."""
import time

SLICE = 0.1  # [s], the longest wait without a check of signals


def check_signals():
    """Lets Python handle a pending signal; called between two slices of a wait. If another thread caught the signal,
    for example one of gRPC, CPython 3.11 notices it only after the main thread released the interpreter's lock."""
    time.sleep(0)
