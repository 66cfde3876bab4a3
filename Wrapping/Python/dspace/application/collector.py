"""Python's collector of garbage, which must not run in a thread beside the windows': what it destroys may hold a window's
session, whose OpenGL belongs to the windows' thread."""
import gc

_paused, _was_on = 0, True


def pause():
    """No garbage is collected from now on, until resume() was called as often. In the windows' thread."""
    global _paused, _was_on
    if _paused == 0:
        _was_on = gc.isenabled()
        gc.disable()
    _paused += 1


def resume():
    """Ends a pause()."""
    global _paused
    _paused -= 1
    if _paused == 0 and _was_on:
        gc.enable()
