"""Shares work among the workers of a Dask scheduler (Debian: python3-distributed)."""
import contextlib
import socket
import time as clock

from dspace.errors import Error, Io, NotFound

TO_CONNECT = 30.0  # seconds
PATIENCE = 30.0  # seconds without a scheduler or a worker


@contextlib.contextmanager
def connected(scheduler):
    """A client of the scheduler at that address, which has a worker. Raises dspace.NotFound without Dask, and dspace.Io if no
    scheduler answers, or if it has no worker, for 30 s."""
    try:
        from distributed import Client
    except ImportError:
        raise NotFound("Dask is not installed; accepted: Debian's package python3-distributed",
                       "python3-distributed") from None
    _require_listener(scheduler)
    try:
        client = Client(scheduler, timeout=TO_CONNECT, set_as_default=False)
    except (OSError, ValueError, TimeoutError) as error:
        raise Io(f"scheduler {scheduler!r}: {error}; accepted: the address of a Dask scheduler, tcp://HOST:PORT",
                 scheduler) from None
    with client:
        end = clock.monotonic() + PATIENCE
        while not workers(client):
            if clock.monotonic() > end:
                raise _without_workers(scheduler)
            clock.sleep(0.1)
        yield client


def results(client, scheduler, function, calls):
    """Lets the workers call the function with each of the tuples of arguments, and yields what it returns in the order of completion.
    At its end, and where it is closed, what is left is cancelled. An Error of the function is raised as it is, any other one as
    dspace.Io; also when there has been no worker for 30 s."""
    waiting = [client.submit(function, *arguments, pure=False) for arguments in calls]
    try:
        yield from finished(client, scheduler, waiting)
    finally:
        with contextlib.suppress(OSError, RuntimeError):  # the scheduler has stopped
            client.cancel(waiting)


def _require_listener(scheduler):
    """Waits until the address accepts a connection, for up to 30 s. A Dask client that never connected prints several
    lines when it ends; this check avoids them."""
    host, _, port = scheduler.partition("://")[2].rpartition(":")
    end = clock.monotonic() + TO_CONNECT
    while True:
        try:
            socket.create_connection((host.strip("[]"), int(port)), timeout=TO_CONNECT).close()
            return
        except OSError as error:
            if clock.monotonic() > end or isinstance(error, socket.gaierror):
                raise Io(f"scheduler {scheduler!r}: {error}; accepted: the address of a Dask scheduler, "
                         "tcp://HOST:PORT", scheduler) from None
            clock.sleep(0.1)


def workers(client):
    """How many there are."""
    try:
        return len(client.scheduler_info()["workers"]) if client.status == "running" else 0
    except (OSError, RuntimeError):  # the scheduler has stopped
        return 0


def _without_workers(scheduler):
    return Io(f"scheduler {scheduler!r}: it has had no worker for {PATIENCE:g} s, or has stopped; accepted: one with "
              "a worker (dask worker ADDRESS)", scheduler)


def finished(client, scheduler, waiting):
    """Yields the results in the order of completion. Each is removed from `waiting`, so that no worker keeps it."""
    from distributed import CancelledError
    seen = clock.monotonic()  # the last time at which there was a worker
    while waiting:
        done = [future for future in waiting if future.done()]
        for future in done:
            try:
                result = future.result(timeout=4 * PATIENCE)
            except TimeoutError:  # its worker died before it sent the result; another worker does it again
                continue
            except Error:
                raise
            except CancelledError:  # the scheduler has stopped
                raise _without_workers(scheduler) from None
            except Exception as error:  # an error inside Dask
                raise Io(f"scheduler {scheduler!r}: {type(error).__name__}: {error}", scheduler) from None
            waiting.remove(future)
            future.release()
            del future
            yield result
            del result
        if not done:
            clock.sleep(0.1)
        if workers(client):
            seen = clock.monotonic()
        elif clock.monotonic() - seen > PATIENCE:
            raise _without_workers(scheduler)
