"""Events that a simulation logs, and questions that it asks the operator."""
import math
import time as _time

import numpy as np

from dspace._core.fields import items, number, put, put_vector, real, reject, shown, text, word
from dspace._core.strict import Strict
from dspace.errors import DeadlineExceeded, NotFound, WrongType
from dspace.frames.frame import Frame
from dspace.proto import service_pb2
from dspace.telemetry.viewer_events import process_events

SEVERITIES = {"info": 0, "caution": 1, "warning": 2, "alarm": 3}
WORDS = tuple(SEVERITIES)
_text = text  # also the name of arguments

# Kinds with a common meaning; other words are accepted. The list is that of messages.proto.
WELL_KNOWN = ("staging", "separation", "deployment", "parachute", "ignition", "cutoff", "contact", "touchdown",
              "collision", "mode", "fault", "command", "message", "goal", "note")


class Event(Strict):
    """An event in a scene's log: see scene.events() and playback.events().

    number: counts a scene's events from 1. time: of the simulation [s]. kind: a word for programs. text: for people.
    severity: "info", "caution", "warning" or "alarm". frame_path: the path, at that time, of the frame where the event
    happened; "" for none. position: in that frame [m], or None. data: {name: number or str}. units: {name: unit} of
    the data that have one."""

    def __init__(self, message, scene=None):
        self._message, self._scene = message, scene

    @property
    def number(self):
        return self._message.number

    @property
    def time(self):
        return self._message.time_s

    @property
    def kind(self):
        return self._message.kind

    @property
    def text(self):
        return self._message.text

    @property
    def severity(self):
        return WORDS[self._message.severity] if self._message.severity < len(WORDS) else "alarm"

    @property
    def frame(self):
        """The Frame where the event happened, or None if there is none or it was removed."""
        return Frame(self._scene, self._message.frame) if self._scene and self._message.frame else None

    @property
    def frame_path(self):
        return self._message.frame_path

    @property
    def position(self):
        if not self._message.HasField("position"):
            return None
        p = self._message.position
        return np.array([p.x, p.y, p.z])

    @property
    def data(self):
        return {datum.name: datum.text if datum.WhichOneof("value") == "text" else datum.number
                for datum in self._message.datum}

    @property
    def units(self):
        return {datum.name: datum.unit for datum in self._message.datum if datum.unit}

    def __repr__(self):
        return f"<dspace.Event {self.number}, {self.time!r} s, {self.severity}, {self.kind!r}: {shown(self.text)}>"


class Question(Strict):
    """A question to the operator, returned by scene.ask() or listed by scene.questions.

    The simulation that asked calls wait(), or session.process_events() until `answer` is not None. The first
    answer among the choices counts and closes the question. A viewer calls reply(). `answer` is set only on the
    object that scene.ask() returned; scene.questions lists open questions."""

    def __init__(self, scene, message):
        self._scene, self._message = scene, message
        self._answer = self._who = None
        self._open, self._hears = True, False

    @property
    def name(self):
        return self._message.name

    @property
    def text(self):
        return self._message.text

    @property
    def choices(self):
        """The accepted answers; an empty list accepts any text."""
        return list(self._message.choice)

    @property
    def severity(self):
        return WORDS[self._message.severity] if self._message.severity < len(WORDS) else "alarm"

    @property
    def time(self):
        """Simulation time when it was asked [s]."""
        return self._message.time_s

    @property
    def answer(self):
        """The answer, or None."""
        return self._answer

    @property
    def who(self):
        """The name of the viewer that answered, or None."""
        return self._who

    def _listen(self):
        # Only the object that scene.ask() returned listens, so that the question is closed once.
        self._hears = True
        self._scene._client.events.callbacks.append(("answer", self._hear))

    def _hear(self, event):
        answer = event.answer
        if not self._open or answer.question != self.name or (self.choices and answer.answer not in self.choices):
            return
        self._answer, self._who = answer.answer, getattr(event, "from")  # a word of Python's
        self._close(self._answer, self._who)

    def _close(self, answer=None, who=""):
        self._open = False
        if self._hears:
            callbacks = self._scene._client.events.callbacks
            callbacks[:] = [each for each in callbacks if each[1] != self._hear]
        command = self._scene._command()
        put(command.close_question, f"question {self.name!r}", name=self.name)
        if answer is not None:
            command.close_question.answer = answer
        setattr(command.close_question, "from", who)
        try:
            self._scene._execute(command)
        except NotFound:  # another client has closed it
            pass

    def wait(self, timeout):
        """Waits up to `timeout` seconds of wall time and returns the answer. Other events of viewers go to their
        callbacks during the wait. Raises dspace.DeadlineExceeded if no answer arrived; the question stays open."""
        timeout = real(timeout, "the timeout", f"question {self.name!r}", "seconds")
        end = _time.monotonic() + timeout
        while self._open and self._answer is None:
            left = end - _time.monotonic()
            if left <= 0:
                raise DeadlineExceeded(f"question {self.name!r}: no answer in {timeout!r} s", f"question {self.name!r}")
            if not process_events(self._scene._client, min(left, 1.0)):
                _time.sleep(min(left, 0.01))  # a local session does not wait
        return self._answer

    def withdraw(self):
        """Closes the question without an answer. Does nothing if it is closed."""
        if self._open:
            self._close()

    def reply(self, answer):
        """Answers the question, from a Watcher or in a local session."""
        label = f"question {self.name!r}"
        text(answer, "the answer", label)
        if self.choices and answer not in self.choices:
            reject(label, "the answer", answer, ", ".join(map(repr, self.choices)))
        event = service_pb2.ViewerEvent()
        event.answer.question, event.answer.answer = self.name, answer
        self._scene._client.send_event(event)

    def __repr__(self):
        return f"<dspace.Question {self.name!r}: {shown(self.text)}, answer {self._answer!r}>"


class SceneMessages:
    """The events and questions of a Scene, which delegates to it."""

    def __init__(self, scene):
        self._scene = scene

    def log_event(self, kind, text="", severity="info", frame=None, position=None, time=None, data=None):
        """Logs an event and returns it.

        kind: a word for programs, such as "staging", "parachute", "ignition", "contact", "touchdown", "mode",
        "fault", "message"; dspace.telemetry.messages.WELL_KNOWN lists them, and other words are accepted.
        text: for people. severity: "info", "caution", "warning" or "alarm". frame: where it happened, and position [m]
        in it. time: of the simulation [s]; default: the scene's. data: a dict of names to numbers, texts, or
        (number, unit) pairs. The scene keeps the newest 10,000."""
        label = f"event {shown(kind)}"
        command = self._scene._command()
        message = command.log_event
        put(message, label, kind=kind, text=text)
        message.severity = word(severity, SEVERITIES, "the severity", label)
        if frame is not None:
            message.frame = self._scene._frame_id(frame)
        if position is not None:
            put_vector(message.position, position, "the position", label)
        if time is not None:
            message.time_s = number(time, "the time", label)
        if data is not None and not hasattr(data, "items"):
            reject(label, "the data", data, "a dict of names to numbers, texts, or (number, unit) pairs", WrongType)
        for name, value in (data or {}).items():
            datum = message.datum.add()
            put(datum, label, name=name)
            if isinstance(value, tuple) and len(value) == 2:
                value, unit = value
                put(datum, label, unit=unit)
            if isinstance(value, str):
                put(datum, label, text=value)
            else:
                datum.number = number(value, f"datum {name!r}", label)
        return Event(self._scene._execute(command).event, self._scene)

    def events(self, after=0, since=-math.inf, until=math.inf, kind=None, severity="info", most=0):
        """Returns the Events that the scene keeps, in the order of their numbers.

        after: only events with larger numbers. since, until: inclusive times [s]. kind: a word, or several.
        severity: the lowest one. most: the number of newest events to return; 0: all."""
        label = f"events of scene {self._scene.name!r}"
        command = self._scene._command()
        message = command.list_events
        put(message, label, after=after, most=most)
        message.since_s, message.until_s = real(since, "since", label), real(until, "until", label)
        kinds = [] if kind is None else [kind] if isinstance(kind, str) else items(kind, "the kinds", label,
                                                                                  "a word, or several")
        message.kind.extend(text(each, "a kind", label, "a word") for each in kinds)
        message.severity = word(severity, SEVERITIES, "the severity", label)
        return [Event(event, self._scene) for event in self._scene._execute(command).events.event]

    def ask(self, name, text, choices=(), severity="info"):
        """Asks the viewers and returns the Question. Question.wait waits for the answer.

        name: unique among the open questions of the session. choices: the accepted answers; an empty list accepts any
        text. severity: "info", "caution", "warning" or "alarm"."""
        label = f"question {shown(name)}"
        command = self._scene._command()
        message = command.ask_operator
        put(message, label, name=name, text=text)
        for choice in items(choices, "the choices", label, "a list of answers"):
            message.choice.append(_text(choice, "a choice", label))
        message.severity = word(severity, SEVERITIES, "the severity", label)
        message.time_s = self._scene.time
        self._scene._execute(command)
        question = Question(self._scene, message)
        question._listen()
        return question

    @property
    def questions(self):
        """The open Questions, in the order in which they were asked."""
        return [Question(self._scene, message) for message in self._scene._ask("list_questions").questions.question]
