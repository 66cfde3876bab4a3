"""Waits that hear Ctrl-C."""
import time

SLICE = 0.1  # [s] of a wait without hearing signals


def check_signals():
    """Between two slices of a wait. CPython 3.11 does not notice a signal that another thread than the main one has
    caught, such as gRPC's, until its lock has been let go, which this does."""
    time.sleep(0)
