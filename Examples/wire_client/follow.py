"""Follows a simulation over the wire, without Dspace: prints where one of its frames is, and when who drives.

    PYTHONPATH=STUBS python3 Examples/wire_client/follow.py unix:/tmp/dspace rover

A viewer gets the commands that make the present state, and then every accepted one. This one keeps of them what it
is about: time, and the frame's pose in its parent. See rover.py for the stubs.
"""
import argparse
import sys

import grpc
from dspace.proto import service_pb2, service_pb2_grpc
from drive import PROTOCOL, open_channel


class Follower:
    def __init__(self, name):
        self.name, self.ids, self.pose, self.time = name, set(), None, 0.0

    def apply(self, command):
        """Keeps what it understands of a command; others are no concern of it."""
        kind = command.WhichOneof("command")
        if kind == "set_time":
            self.time = command.set_time.time_s
        elif kind == "create_frame" and command.create_frame.name == self.name:
            self.ids.add(command.create_frame.id)
            p = command.create_frame.pose.position
            self.pose = (p.x, p.y, p.z)
        elif kind == "set_poses":
            for number, frame in enumerate(command.set_poses.frame):
                if frame in self.ids:
                    self.pose = tuple(command.set_poses.pose[8 * number:8 * number + 3])
        else:
            return
        if self.pose is not None and kind != "set_time":
            print(f"{self.time:.3f} s: {self.name} at " + " ".join(repr(value) for value in self.pose), flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("address")
    parser.add_argument("frame", help="its name")
    options = parser.parse_args()
    stub = service_pb2_grpc.DspaceStub(open_channel(options.address))
    follower = Follower(options.frame)
    stream = stub.Watch(service_pb2.WatchRequest(protocol=PROTOCOL, viewer="follow"), wait_for_ready=True)
    sequence = None
    try:
        for message in stream:
            kind = message.WhichOneof("kind")
            if kind == "snapshot":  # all that came before is to be forgotten
                follower = Follower(options.frame)
                for command in message.snapshot.command:
                    follower.apply(command)
            elif kind == "command":
                if message.sequence != sequence + 1:
                    sys.exit(f"command {message.sequence} came after {sequence}")
                follower.apply(message.command)
            elif kind == "writer":
                state = "drives" if message.writer.connected else "has gone"
                print(f"simulation {message.writer.name!r} {state}" if message.writer.name else "no driver",
                      flush=True)
                if message.writer.name and not message.writer.connected:
                    break
            sequence = message.sequence
    except grpc.RpcError as error:
        sys.exit(f"the server has gone: {error.details()}")


if __name__ == "__main__":
    main()
