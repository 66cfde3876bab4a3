"""Events of viewers: a viewer sends them, the simulation receives them."""
import math
import warnings

from dspace._core.fields import items, number, put, real, reject, text, word
from dspace._core.traits import DEFAULT_SCENE
from dspace.errors import DspaceWarning, WrongType
from dspace.frames.frame import Frame, put_pose
from dspace.frames.poses import Pose, to_pose
from dspace.objects.graphics import GraphicsObject
from dspace.proto import service_pb2

KINDS = {kind: kind for kind in ("picked", "selection", "answer", "edited", "dragged", "input")}


def _value(name, about):
    """The label of an edited value in messages. Rejects an empty name."""
    if not text(name, "the name", about):
        reject(about, "the name of a value", name, "one that is not empty")
    return f"value {name!r}"


def process_events(client, wait):
    """ViewerEvents.process_events() of a client."""
    wait = real(wait, "the wait", "session", "seconds")
    events = []
    while True:
        event = client.take_event(0.0 if events else wait)
        if event is None:
            return events
        events.append(event)
        for kind, callback in list(client.events.callbacks):
            if kind is None or event.WhichOneof("kind") == kind:
                callback(event)


class ViewerEvents:
    """Sends and receives events of viewers, for a Session or Watcher, which delegates to it.

    A Watcher sends events to the driver of the server. A Session (or RemoteSession) sends them to itself, so that a
    program with its own window works in the same way.
    """

    def __init__(self, session):
        self._session = session

    # --- Receiving -----------------------------------------------------------------------------

    def on_event(self, callback, kind=None):
        """Registers `callback`, which process_events() calls with each ViewerEvent (dspace.proto.service_pb2).

        kind: "picked", "selection", "answer", "edited", "dragged" or "input" (a key or a click that moved no camera); None: all kinds. Callbacks stay until the
        session is closed. Raises dspace.WrongType or dspace.InvalidArgument."""
        if not callable(callback):
            reject("session", "the callback", callback, "a function of one ViewerEvent", WrongType)
        if kind is not None:
            word(kind, KINDS, "the kind", "session")
        self._session._client.events.callbacks.append((kind, callback))

    def on_edited(self, name, callback, low=-math.inf, high=math.inf, unit=""):
        """Registers `callback`, which is called with each number that a person enters for the value `name`.

        low, high: inclusive bounds. unit: the required unit ("m", "deg", ...). A number out of bounds or in another
        unit does not reach the callback and gives a dspace.DspaceWarning. Numbers are never converted or clipped."""
        label = _value(name, "session")
        low, high = number(low, "low", label), number(high, "high", label)
        text(unit, "the unit", label)
        if not low <= high:
            reject(label, "low, high", (low, high), "low <= high")
        if not callable(callback):
            reject(label, "the callback", callback, "a function of one number", WrongType)

        def hear(event):
            edited = event.edited
            if edited.name != name:
                return
            if edited.unit != unit or not low <= edited.value <= high:
                who = getattr(event, "from") or "a person"  # a word of Python's
                warnings.warn(f"{label}: {who} has entered {edited.value!r} "
                              f"{edited.unit!r}; accepted: {low!r} to {high!r} {unit!r}; the value is unchanged",
                              DspaceWarning, stacklevel=3)
                return
            callback(edited.value)

        self.on_event(hear, "edited")

    def process_events(self, wait=0.0):
        """Passes viewers' events to the callbacks of on_event and returns the events. Waits up to `wait` seconds
        for the first one. If a callback raises, the remaining events stay for the next call. If the
        connection to the server cannot be restored, a wait raises its error."""
        return process_events(self._session._client, wait)

    # --- Sending -------------------------------------------------------------------------------

    def send_event(self, event):
        """Sends a dspace.proto.service_pb2.ViewerEvent of up to 1 MiB to the simulation. A Watcher raises
        dspace.NotFound if the server has no driver."""
        if not isinstance(event, service_pb2.ViewerEvent):
            reject("event", "it", event, "a dspace.proto.service_pb2.ViewerEvent", WrongType)
        self._session._client.send_event(event)

    def answer(self, question, answer):
        """Answers a question of the simulation."""
        event = service_pb2.ViewerEvent()
        event.answer.question = text(question, "the question", "event")
        event.answer.answer = text(answer, "the answer", "event")
        self.send_event(event)

    def edited(self, name, value, unit=None):
        """Sends a finite value that a person has entered. If a scene has a telemetry channel of that name, the value
        must be one of its numbers or choices, in its unit, which is the default for `unit`."""
        label = _value(name, "event")
        value = number(value, "the value", label)
        if not math.isfinite(value):
            reject(label, "it", value, "a finite number")
        channel = next((scene.telemetry[name] for scene in self._session.scenes.values() if name in scene.telemetry), None)
        if channel is not None:
            if channel.kind == "text" or (channel.kind == "choice" and value not in channel.labels):
                reject(label, "it", value, "a channel of numbers or choices" if channel.kind == "text"
                       else ", ".join(f"{number} ({label})" for number, label in channel.labels.items()))
            if unit is not None and unit != channel.unit:
                reject(label, "the unit", unit, repr(channel.unit))
            unit = channel.unit
        unit = "" if unit is None else unit
        event = service_pb2.ViewerEvent()
        put(event.edited, label, name=name, value=value, unit=text(unit, "the unit", label))
        self.send_event(event)

    def select(self, objects):
        """Sends the selection: a list of objects of one scene. An empty list means that nothing is selected."""
        event = service_pb2.ViewerEvent()
        objects = items(objects, "the objects", "event", "a list of objects")
        for each in objects:
            if not isinstance(each, GraphicsObject):
                reject("event", "an object", each, "a GraphicsObject", WrongType)
        scenes = {each.scene.name for each in objects}
        if len(scenes) > 1:
            reject("event", "the selection's scenes", sorted(scenes), "objects of one scene")
        event.selection.scene = scenes.pop() if scenes else ""
        event.selection.object.extend(each.id for each in objects)
        self.send_event(event)

    def dragged(self, goal, position=None, quaternion=None, pose=None, relative_to=None, scene=DEFAULT_SCENE,
                done=True):
        """Sends the pose that a person requests for a goal, such as one of an end effector, a wheel or a drive.

        goal: a Frame, or the goal's name in the simulation. position [m], quaternion or pose: X_GF, in the frame
        `relative_to` (a Frame; default: the root). done: False while the person is still dragging. This call moves
        nothing; the simulation decides."""
        label = f"goal {goal.path if isinstance(goal, Frame) else text(goal, 'the goal', 'event')!r}"
        event = service_pb2.ViewerEvent()
        message = event.dragged
        message.scene = text(scene, "the scene", label)
        for frame, field in ((goal, "frame"), (relative_to, "relative_to")):
            if isinstance(frame, Frame):
                message.scene = frame.scene.name
                setattr(message, field, frame.id)
        if not isinstance(relative_to, (Frame, type(None))):
            reject(label, "relative_to", relative_to, "a Frame, or None for the root", WrongType)
        message.goal = goal.path if isinstance(goal, Frame) else goal
        put_pose(message.pose, to_pose(position, quaternion, None, pose))
        put(message, label, done=done)
        self.send_event(event)


def pose_of(message):
    """Returns the dspace.Pose of a Pose message, such as ViewerEvent.Dragged.pose. Absent fields are identity."""
    p, q = message.position, message.rotation
    return Pose((p.x, p.y, p.z), (q.w, q.x, q.y, q.z) if message.HasField("rotation") else (1, 0, 0, 0),
                message.scale if message.HasField("scale") else 1.0)
