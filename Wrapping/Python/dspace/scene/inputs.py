"""Keys and clicks in viewports that the controls of the camera do not use, and the callbacks that get them."""
from dataclasses import dataclass

from dspace._core.fields import reject
from dspace.errors import WrongType

BUTTON_NAMES = {1: "left", 2: "middle", 3: "right"}


@dataclass(frozen=True)
class Input:
    """A key, or a click (without a drag), in a viewport.

    key: its name, as Viewport.event got it; "" for a click. button: "left", "middle" or "right"; None for a key.
    x, y: the pointer's position in pixels. shift, control, alt: modifier keys that were held. pick: what a click
    hit, a PickReply; None where it hit nothing, and for a key."""
    viewport: object
    key: str
    button: str
    x: float
    y: float
    shift: bool
    control: bool
    alt: bool
    pick: object


class ViewportInputs:
    """The callbacks of one client, by the name of the viewport."""

    def __init__(self):
        self._callbacks = {}  # (viewport, "key" or "click"): callbacks, in the order of registration

    def add(self, viewport, kind, callback):
        if not callable(callback):
            reject(f"viewport {viewport!r}", "the callback", callback, "a function of one dspace.Input", WrongType)
        self._callbacks.setdefault((viewport, kind), []).append(callback)

    def forget(self, viewport):
        for kind in ("key", "click"):
            self._callbacks.pop((viewport, kind), None)

    def tell(self, viewport, message, reply):
        """Calls the callbacks of a Viewport, if the reply to a ViewportEvent has a key or a click for them."""
        kind = "key" if reply.input.key else "click" if reply.HasField("input") or reply.HasField("pick") else None
        callbacks = self._callbacks.get((viewport.name, kind), ())
        if not callbacks:
            return
        pick = reply.pick if reply.HasField("pick") else reply.input.pick
        found = Input(viewport, reply.input.key, BUTTON_NAMES.get(message.button) if kind == "click" else None,
                      message.x, message.y, message.shift, message.control, message.alt,
                      pick if kind == "click" and pick.object else None)
        for callback in list(callbacks):
            callback(found)
