"""The session of DspaceQt: files are read in another thread while the windows live."""
from dspace._core.replies import to_reply
from dspace._core.wire import encode
from dspace.clients.local import LocalClient
from dspace.clients.session import Session

READING = ("import_object", "import_nodes", "load_robot", "open_terrain", "add_terrain_layer")  # commands that may read long


class WindowClient(LocalClient):
    """Executes commands in the session of a window; the window reads the files of those that open some."""

    def __init__(self, host):
        super().__init__(host.session())
        self._host = host

    def _carry(self, command):
        if command.WhichOneof("command") not in READING:
            return super()._carry(command)
        self.local()
        reply = self._host.execute(encode(command))
        self.local()  # closed meanwhile?
        return to_reply(reply)


def around(host):
    """The Session of a window."""
    made = Session.__new__(Session)
    made._client = WindowClient(host)
    return made
