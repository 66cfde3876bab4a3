"""The link's side of a simulation without Dspace: numbered commands, replies, and going on after a break.

Made of the .proto files alone; Documentation/Wire.md explains each step.
"""
import collections
import os
import queue
import time

import grpc
from dspace.proto import commands_pb2, service_pb2, service_pb2_grpc

PROTOCOL = "dspace.v1"
OPTIONS = [("grpc.max_receive_message_length", -1)]  # pictures are larger than gRPC's 4 MiB


FINAL = {grpc.StatusCode.INVALID_ARGUMENT, grpc.StatusCode.FAILED_PRECONDITION, grpc.StatusCode.ALREADY_EXISTS,
         grpc.StatusCode.RESOURCE_EXHAUSTED, grpc.StatusCode.UNIMPLEMENTED}  # asking again would not help


class Rejected(Exception):
    """The error of a command that the server rejected."""


def open_channel(address, certificate=None, key=None, authority=None):
    """A channel to "host:port" or "unix:PATH"; with PEM files it is mutual TLS, all three."""
    if certificate is None:
        return grpc.insecure_channel(address, OPTIONS)
    read = lambda path: open(path, "rb").read()
    credentials = grpc.ssl_channel_credentials(read(authority), read(key), read(certificate))
    return grpc.secure_channel(address, credentials, OPTIONS)


class Driver:
    """Drives a server. A connection that breaks is made again; each command is carried out once."""

    def __init__(self, channel, name, patience=20.0):
        self.stub = service_pb2_grpc.DspaceStub(channel)
        self.name, self.patience = name, patience
        self.key = os.urandom(16)  # identifies this client when it reconnects
        self.number = 0  # of the last command
        self.acknowledged = 0  # the highest number whose reply has come
        self.pending = collections.OrderedDict()  # number: request; sent, and not known to be done
        self.events = []  # what viewers have said
        self.broken = 0  # how often the connection was made again
        hello = self.stub.Hello(service_pb2.HelloRequest(protocol=PROTOCOL), timeout=patience, wait_for_ready=True)
        self.largest = hello.maximum_message
        self._open()

    def send(self, command, reply=False):
        """Sends it, and does not wait. Without `reply` only an error, a warning or an event is answered."""
        if command.ByteSize() > self.largest:
            raise ValueError(f"the command has {command.ByteSize()} bytes; accepted: up to {self.largest}")
        self.number += 1
        request = service_pb2.DriveRequest()
        request.send.number = self.number
        request.send.command.CopyFrom(command)
        request.send.no_reply = not reply
        request.send.acknowledged = self.acknowledged
        self.pending[self.number] = request
        self.requests.put(request)
        while len(self.pending) > 256:  # no more than so many on their way
            self._hear()
        return self.number

    def ask(self, command):
        """Its Reply, after that of all that was sent before it."""
        number = self.send(command, reply=True)
        while True:
            done = self._hear()
            if done is not None and done.number == number and done.HasField("reply"):
                return done.reply

    def close(self):
        self.requests.put(None)  # closes the request stream, so that the server sees a regular end
        for _ in self.replies:
            pass

    # --- The stream ----------------------------------------------------------------------------

    def _open(self):
        """Connects, or reconnects with the same key and sends pending commands again that have not arrived."""
        end = time.monotonic() + self.patience
        while True:
            self.requests = queue.Queue()
            self.replies = self.stub.Drive(iter(self.requests.get, None), wait_for_ready=True)
            first = service_pb2.DriveRequest()
            first.open.protocol, first.open.client, first.open.key = PROTOCOL, self.name, self.key
            first.open.acknowledged = self.acknowledged
            first.open.again = bool(self.number)
            self.requests.put(first)
            try:
                opened = next(self.replies).opened
                break
            except grpc.RpcError as error:  # rejected permanently, or the server is not running
                if error.code() == grpc.StatusCode.ABORTED:
                    raise ConnectionError("the server was restarted: the scene is lost") from None
                if error.code() in FINAL or time.monotonic() > end:
                    raise
                time.sleep(0.1)
        if self.number and not opened.resumed:
            raise ConnectionError("the server was restarted: the scene is lost")
        for number, request in self.pending.items():
            if number > opened.last:
                self.requests.put(request)

    def _hear(self):
        """Takes one message in; the Done, if it is one."""
        try:
            message = next(self.replies)
        except (grpc.RpcError, StopIteration) as error:
            if isinstance(error, grpc.RpcError) and error.code() in FINAL:
                raise
            self.broken += 1
            self._open()
            return None
        kind = message.WhichOneof("kind")
        if kind == "event":
            self.events.append(message.event)
        elif kind == "closed":
            raise ConnectionError(message.closed.error.message)
        elif kind == "done":
            done = message.done
            for number in [number for number in self.pending if number <= done.number]:
                del self.pending[number]
            if done.HasField("reply") and done.number > self.acknowledged:
                self.acknowledged = done.number
                if done.reply.HasField("error"):
                    raise Rejected(f"command {done.number}: {done.reply.error.message}")
                for warning in done.reply.warning:
                    print(f"warning: {warning}")
                return done
        return None


def new(scene="scene"):
    return commands_pb2.Command(scene=scene)
