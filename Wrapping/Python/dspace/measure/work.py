"""Long measurements. The session computes them in its own threads and executes other commands."""
import time

from dspace._core.fields import reject
from dspace.errors import Error, WrongType

FIRST_WAIT_S = 0.05  # that the session waits for a result before it does other things
LONGEST_PAUSE_S = 0.2  # between two questions for the result


def measure(scene, command, message, about, progress=None):
    """Executes a request with a field wait_s, which is in `message`, and returns its Reply.

    progress: called as progress(fraction, left_s) where the work takes long. What it raises, as an interrupt by Ctrl-C,
    cancels the work."""
    if progress is not None and not callable(progress):
        reject(about, "progress", progress, "a function, or None", WrongType)
    message.wait_s = FIRST_WAIT_S
    start = time.monotonic()
    reply = scene._execute(command)
    while reply.WhichOneof("result") == "work":
        work, asking = reply.work.work, False
        try:
            if progress is not None:
                progress(reply.work.fraction, reply.work.left_s)
            time.sleep(min(LONGEST_PAUSE_S, 0.1 * (time.monotonic() - start)))
            asking = True
            reply = scene._do("await_work", about, work=work, wait_s=0.0)
        except BaseException as error:
            if not (asking and isinstance(error, Error)):  # that is the end of the work
                _cancel(scene, work)
            raise
    return reply


def _cancel(scene, work):
    try:
        scene._do("await_work", work=work, cancel=True)
    except Error:
        pass  # it has ended, or the server does not respond: it then drops the work itself
