"""Delivery of frame events to callbacks, and the queue of viewers' events."""
from collections import deque

from dspace.errors import Resource
from dspace.frames.events import FrameEvent

# As FrameEvents.h has them.
MAXIMUM_ROUNDS = 100
MAXIMUM_CAUSED = 100000


class FrameListeners:
    """The callbacks of one client, and the events that are not delivered yet."""

    def __init__(self):
        self._entries = {}  # token: (scene, callback), in the order of registration
        # (message, the last token when it was queued, round, the token of the callback that caused it or 0)
        self._waiting = deque()
        self._last_token = 0
        self._delivering = False
        self._round = 0  # the round of the event being delivered; 0: not caused by a callback
        self._calling = 0  # the token of the callback being called
        self._caused = 0  # the number of events that callbacks caused in this delivery

    def __bool__(self):
        return bool(self._entries)

    def add(self, scene, callback):
        """Returns a token, never 0 and never reused. The callback gets no events that are already queued."""
        self._last_token += 1
        self._entries[self._last_token] = (scene, callback)
        return self._last_token

    def remove(self, scene, token):
        """False when the scene has no such listener."""
        if token not in self._entries or self._entries[token][0] != scene:
            return False
        del self._entries[token]
        return True

    def follows(self, scene):
        return any(each == scene for each, _ in self._entries.values())

    def forget_scene(self, name):
        self._entries = {token: entry for token, entry in self._entries.items()
                         if entry[0].name != name}

    def clear(self):
        self._entries.clear()
        self._waiting.clear()

    def put(self, messages):
        round, cause = (self._round + 1, self._calling) if self._delivering else (0, 0)
        self._waiting.extend((message, self._last_token, round, cause) for message in messages)
        if self._delivering:
            self._caused += len(messages)

    def deliver(self):
        """Passes every queued event to the callbacks of its scene, in order.

        A callback may execute commands; their events follow after all callbacks have got the present one.
        If a callback raises, the others and the queued events are still processed, and the first exception
        is raised at the end. A callback whose commands cause events without end gets no more events
        in this delivery."""
        if self._delivering:
            return  # the delivery in progress includes them
        self._delivering = True
        self._caused = 0
        first = None
        silent = set()
        try:
            while self._waiting:
                message, last_token, self._round, cause = self._waiting.popleft()
                endless = self._round > MAXIMUM_ROUNDS or self._caused > MAXIMUM_CAUSED
                if endless and cause and cause not in silent:
                    silent.add(cause)
                    if first is None:
                        first = self._endless(cause)
                for token, (scene, callback) in list(self._entries.items()):
                    if (token > last_token or token not in self._entries or token in silent
                            or scene.name != message.scene):
                        continue
                    self._calling = token
                    try:
                        callback(FrameEvent(scene, message))
                    except Exception as error:
                        if first is None:
                            first = error
        finally:
            self._delivering = False
        if first is not None:
            raise first

    def _endless(self, token):
        _, callback = self._entries.get(token, (None, "a callback that was removed"))
        return Resource(f"on_frame_change: the commands of {callback!r} cause further ones without end "
                        f"(round {self._round}, {self._caused} changes); accepted: up to "
                        f"{MAXIMUM_ROUNDS} rounds and {MAXIMUM_CAUSED} changes", "on_frame_change")


class EventQueue:
    """The queued ViewerEvents that a session sent to itself, and the callbacks for viewers' events."""

    def __init__(self):
        self._told = deque()
        self.callbacks = []  # (kind or None, callback), in the order of registration

    def put(self, event):
        copy = type(event)()
        copy.CopyFrom(event)
        self._told.append(copy)

    def take(self):
        return self._told.popleft() if self._told else None

    def clear(self):
        self._told.clear()
        self.callbacks.clear()
