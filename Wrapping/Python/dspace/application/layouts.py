"""Saved arrangements of the docks of DspaceQt."""
import json

from dspace._core.fields import text


class Layouts:
    """The named layouts; they are kept in the user's settings. A layout has the places of docks and views; views that are
    gone are made anew with a camera at that of the latest view."""

    def __init__(self, host):
        self._host = host

    def _ask(self, what, name=""):
        return json.loads(self._host.extend(json.dumps({"do": "layout", "what": what, "name": name})))

    @property
    def names(self):
        """The names, sorted."""
        return self._ask("names")["names"]

    def save(self, name):
        """Saves the present layout under a name of 1 to 60 letters; one of that name is replaced."""
        self._ask("save", text(name, "the name", "layout"))

    def restore(self, name):
        """Arranges the docks as they were saved."""
        self._ask("restore", text(name, "the name", "layout"))

    def remove(self, name):
        """Forgets a layout."""
        self._ask("remove", text(name, "the name", "layout"))


def show_dialog(host, name):
    """Opens "preferences", "guide", "keys", "messages" or "about"; nothing waits for it."""
    host.extend(json.dumps({"do": "dialog", "name": text(name, "the name", "dialog")}))


def show_dock(host, name):
    """Brings a dock to the front, by its name."""
    host.extend(json.dumps({"do": "dock", "name": text(name, "the name", "dock")}))


def set_theme(host, name):
    """The colours of all windows, kept in the user's settings: "system", "dark", "light"."""
    host.extend(json.dumps({"do": "theme", "name": text(name, "the theme", "theme")}))
