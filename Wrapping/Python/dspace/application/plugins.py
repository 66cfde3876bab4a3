"""What plug-ins add to the window: docks of values and controls, menu entries, keys, read-outs in the status bar."""
import importlib
import importlib.util
import json
import os
import traceback

from dspace._core import fields
from dspace._core.fields import reject, text
from dspace.errors import Error, InvalidArgument, NotFound, WrongType


class Row:
    """One row of a Panel; set() changes what it shows."""

    def __init__(self, panel, number, value=None, function=None):
        self._panel, self._number, self._function = panel, number, function
        self.value = value  # of a slider, choice, check or entry, as the user left it

    def set(self, **changes):
        """text, state ("", "amber", "red"), value, options, rows, append (a row of a table), enabled, tip."""
        self._panel._ask("set", row=self._number, changes=changes)
        if "value" in changes:
            self.value = changes["value"]

    def _changed(self, value):
        if value is not None:
            self.value = value
        if self._function is not None:
            self._function() if value is None else self._function(value)


class Panel:
    """A dock with rows of values and controls; App.add_dock() makes it. Functions of controls are called with the value
    that the user set, those of buttons without arguments."""

    def __init__(self, ask, title, area):
        self.title, self._asked, self._rows = title, ask, []
        self._number = ask({"do": "panel", "title": title, "area": area})["panel"]

    def _ask(self, what, **fields):
        return self._asked({"do": what, "panel": self._number, **fields})

    def _add(self, kind, name="", function=None, value=None, **fields):
        if function is not None and not callable(function):
            reject(f"dock {self.title!r}", "the function", function, "one that can be called", WrongType)
        row = {"kind": kind, "name": text(name, "the name", f"dock {self.title!r}"), **fields}
        if value is not None:
            row["value"] = value
        made = Row(self, self._ask("row", row=row)["row"], value, function)
        self._rows.append(made)
        return made

    def heading(self, text):
        """Bold text."""
        return self._add("heading", text=text)

    def text(self, text):
        """Text over the whole width."""
        return self._add("text", text=text)

    def read_out(self, name, text="", tip=""):
        """A value as text, which Row.set(text=, state=) changes; "amber" and "red" mark it."""
        return self._add("value", name, text=text, tip=tip)

    def button(self, text, function, name="", tip=""):
        """Calls function() when it is pressed."""
        return self._add("button", name, function, text=text, tip=tip)

    def slider(self, name, low, high, value, function=None, unit="", decimals=2, tip=""):
        """A number from `low` to `high`."""
        if not low < high:
            reject(f"dock {self.title!r}", f"the range of {name!r}", (low, high), "low < high")
        return self._add("slider", name, function, value, low=low, high=high, unit=unit, decimals=decimals, tip=tip)

    def choice(self, name, options, value=None, function=None, tip=""):
        """One of some texts."""
        options = [text(option, "an option", f"dock {self.title!r}") for option in options]
        return self._add("choice", name, function, options[0] if value is None else value, options=options, tip=tip)

    def check(self, name, value=False, function=None, tip=""):
        """Yes or no."""
        return self._add("check", name, function, bool(value), tip=tip)

    def entry(self, name, value="", function=None, tip=""):
        """A line of text."""
        return self._add("entry", name, function, value, tip=tip)

    def table(self, columns, rows=(), height=6):
        """Rows of texts; Row.set(append=[...]) adds one."""
        return self._add("table", columns=list(columns), rows=[list(map(str, row)) for row in rows], height=height)

    def close(self):
        """Removes the dock."""
        self._ask("close")


class ReadOut:
    """A value in the status bar; App.add_read_out() makes it."""

    def __init__(self, ask, name, words, tip):
        self.name, self._asked, self._state = text(name, "the name", "read-out"), ask, ""
        self._text = text(words, "the text", f"read-out {name!r}")
        self._number = ask({"do": "read_out", "name": name, "text": words, "tip": text(tip, "the tip", f"read-out {name!r}")})["read_out"]

    def set(self, text=None, state=None):
        """text: the value. state: "", "amber" or "red", which colour it."""
        about = f"read-out {self.name!r}"
        words = self._text if text is None else fields.text(text, "the text", about)
        marked = self._state if state is None else fields.text(state, "the state", about)
        self._asked({"do": "tell", "read_out": self._number, "text": words, "state": marked})
        self._text, self._state = words, marked

    def close(self):
        """Removes it."""
        self._asked({"do": "untell", "read_out": self._number})


class PlugIns:
    """The plug-ins of an App."""

    def __init__(self, host):
        self._host = host
        self._panels, self._actions = {}, {}
        self.loaded = {}  # by name: the module

    def _ask(self, request):
        return json.loads(self._host.extend(json.dumps(request)))

    def add_dock(self, title, area="right"):
        made = Panel(self._ask, text(title, "the title", "dock"), area)
        self._panels[made._number] = made
        return made

    def add_read_out(self, name, words, tip):
        return ReadOut(self._ask, name, words, tip)

    def add_action(self, menu, words, function, key="", tip=""):
        self._put({"do": "action", "menu": text(menu, "the menu", "action"), "text": text(words, "the text", "action"),
                   "key": key, "tip": tip}, function)

    def on_key(self, key, function):
        self._put({"do": "key", "key": text(key, "the key", "key")}, function)

    def _put(self, request, function):
        if not callable(function):
            reject(request["do"], "the function", function, "one without arguments", WrongType)
        self._actions[self._ask(request)["action"]] = function

    def load(self, name, app):
        """Imports a module or a file .py and calls its plugin(app); or loads a library .so of C++
        (dspace/widgets/window/WindowPlugIn.h) and returns None."""
        name = os.fspath(name)
        about = f"plug-in {name!r}"
        if name.endswith(".so") or ".so." in os.path.basename(name):
            self._ask({"do": "library", "path": os.path.abspath(name)})
            return None
        if name.endswith(".py"):
            if not os.path.exists(name):
                raise NotFound(f"{about}: there is no such file", about)
            spec = importlib.util.spec_from_file_location(os.path.splitext(os.path.basename(name))[0], name)
            module = importlib.util.module_from_spec(spec)
            spec.loader.exec_module(module)
        else:
            try:
                module = importlib.import_module(name)
            except ModuleNotFoundError as error:
                raise NotFound(f"{about}: {error}; accepted: a module, or a file .py", about) from None
        if not callable(getattr(module, "plugin", None)):
            raise InvalidArgument(f"{about}: it has no function plugin(app)", about)
        module.plugin(app)
        self.loaded[name] = module
        return module

    def load_folder(self, folder, app):
        """Loads each .py and .so file of a folder; one that raises is reported, and the others go on."""
        for entry in sorted(os.listdir(folder)) if os.path.isdir(folder) else ():
            if entry.endswith((".py", ".so")):
                try:
                    self.load(os.path.join(folder, entry), app)
                except Exception:
                    self._host.message(f"plug-in {entry} failed (see the Python dock)")
                    traceback.print_exc()

    # --- Called by the program -------------------------------------------------------------------

    def triggered(self, action):
        self._run(self._actions[action])

    def changed(self, panel, row, value):
        found = self._panels[panel]._rows[row]
        self._run(lambda: found._changed(value))

    def _run(self, function):
        try:
            function()
        except Error as error:
            self._host.message(str(error))
            traceback.print_exc()
        except Exception:
            self._host.message("a plug-in failed (see the Python dock)")
            traceback.print_exc()
