"""A rover on a circle, driven over the wire by a program that has nothing of Dspace but its .proto files.

    protoc -I Libraries/Session --python_out=STUBS --grpc_out=STUBS \\
        --plugin=protoc-gen-grpc=/usr/bin/grpc_python_plugin Libraries/Session/dspace/proto/*.proto
    PYTHONPATH=STUBS python3 Examples/wire_client/rover.py unix:/tmp/dspace --out rover.ppm

Debian: protobuf-compiler, protobuf-compiler-grpc, python3-grpcio, python3-protobuf.
"""
import argparse
import math
import sys

import grpc
from drive import Driver, Rejected, new, open_channel

STEPS, DT = 500, 0.01  # s
RADIUS, RATE = 3.0, 0.2  # of the circle [m], along it [rad/s]
WHEEL, HALF_BASE, HALF_TRACK = 0.2, 0.5, 0.45  # radius, places of the wheels [m]
ROVER, WHEELS = 10, (11, 12, 13, 14)  # ids of frames: ours to choose, so that nothing is waited for
CORNERS = ((HALF_BASE, HALF_TRACK), (HALF_BASE, -HALF_TRACK), (-HALF_BASE, HALF_TRACK), (-HALF_BASE, -HALF_TRACK))


def clear(link):
    """Takes away what an earlier run has left: scenes stay in a server."""
    ask = new()
    ask.list_viewports.SetInParent()
    for name in link.ask(ask).viewports.name:
        remove = new()
        remove.remove_viewport.viewport = name
        link.send(remove)
    ask.list_scenes.SetInParent()  # another of the command's oneof takes the first one's place
    for name in link.ask(ask).scenes.name:
        link.send(_with(new(name), lambda c: c.remove_scene.SetInParent()))


def build(link):
    """The scene: each line of it is one command, made whole or not at all."""
    link.send(_with(new(), lambda c: c.create_scene.SetInParent()))
    link.send(_frame(ROVER, 0, "rover", (0.0, 0.0, WHEEL)))
    for number, (x, y) in zip(WHEELS, CORNERS):
        link.send(_frame(number, ROVER, f"wheel_{number}", (x, y, 0.0)))
        wheel = _object(number, "wheel", (0.15, 0.15, 0.16))
        wheel.create_primitive.cylinder.radius, wheel.create_primitive.cylinder.height = WHEEL, 0.15
        turn = wheel.create_primitive.object.offset.rotation  # a cylinder stands along Z: about X by 90 degrees
        turn.w, turn.x = math.sqrt(0.5), math.sqrt(0.5)
        link.send(wheel)
    body = _object(ROVER, "body", (0.85, 0.65, 0.25))
    size = body.create_primitive.box.size
    size.x, size.y, size.z = 1.2, 0.7, 0.25
    link.send(body)
    ground = _object(0, "ground", (0.62, 0.48, 0.38))
    ground.create_primitive.plane.width, ground.create_primitive.plane.height = 20.0, 20.0
    link.send(ground)
    camera = new()
    camera.set_camera.name = "main"
    camera.set_camera.projection.perspective.vertical_fov_deg = 40.0
    look = camera.set_camera.mount.look_at
    look.eye.x, look.eye.y, look.eye.z = 7.0, -3.0, 4.0
    look.target.x, look.target.y, look.target.z = 1.0, 2.5, 0.0
    link.send(camera)
    view = new()
    view.create_viewport.name, view.create_viewport.camera = "view", "main"
    view.create_viewport.width, view.create_viewport.height = 320, 240
    return link.ask(view)  # waits for the reply, and raises errors of earlier commands


def poses(time_s):
    """Rows px py pz qw qx qy qz scale of the rover in the root and of its wheels in the rover."""
    along = RATE * time_s
    rows = [RADIUS * math.sin(along), RADIUS * (1.0 - math.cos(along)), WHEEL,
            math.cos(along / 2), 0.0, 0.0, math.sin(along / 2), 1.0]
    for x, y in CORNERS:
        turned = along * (RADIUS - y) / WHEEL  # about Y, the way it rolls
        rows += [x, y, 0.0, math.cos(turned / 2), 0.0, math.sin(turned / 2), 0.0, 1.0]
    return rows


def drive(link, break_at=None):
    for step in range(1, STEPS + 1):
        time = new()
        time.set_time.time_s = step * DT
        link.send(time)  # before the poses of the step
        move = new()
        move.set_poses.frame.extend((ROVER, *WHEELS))
        move.set_poses.pose.extend(poses(step * DT))  # packed: on the wire the array itself
        link.send(move)
        if step == break_at:
            link.replies.cancel()  # as if a cable was pulled


def show(link, path):
    """What the server has: the poses in the root, and the picture."""
    ask = new()
    ask.get_poses.frame.extend((ROVER, *WHEELS))
    ask.get_poses.relative_to = 1  # the root
    rows = link.ask(ask).poses.pose
    for number, frame in enumerate((ROVER, *WHEELS)):
        print(frame, *(repr(value) for value in rows[8 * number:8 * number + 8]))
    capture = new()
    capture.capture.viewport, capture.capture.color, capture.capture.inline_data = "view", True, True
    picture = link.ask(capture).capture
    plane = picture.plane[0]  # 4 bytes a pixel, r g b a, the top row first
    with open(path, "wb") as file:
        file.write(b"P6 %d %d 255\n" % (picture.width, picture.height))
        for pixel in range(0, len(plane.data), 4):
            file.write(plane.data[pixel:pixel + 3])


def _with(command, fill):
    fill(command)
    return command


def _frame(number, parent, name, place):
    command = new()
    command.create_frame.id, command.create_frame.parent, command.create_frame.name = number, parent, name
    position = command.create_frame.pose.position
    position.x, position.y, position.z = place
    return command


def _object(frame, name, color):
    command = new()
    settings = command.create_primitive.object
    settings.frame, settings.name = frame, f"{name} {frame}"
    settings.material.color.r, settings.material.color.g, settings.material.color.b = color
    return command


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("address", help="of `dspace serve`: unix:PATH or host:port")
    parser.add_argument("--out", default="rover.ppm", help="the picture at the end, PPM")
    parser.add_argument("--cert", help="PEM files for mutual TLS, all three")
    parser.add_argument("--key")
    parser.add_argument("--ca")
    parser.add_argument("--break-at", type=int, metavar="STEP",
                        help="break the connection at this step, to test reconnection")
    options = parser.parse_args()
    channel = open_channel(options.address, options.cert, options.key, options.ca)
    link = Driver(channel, "wire rover")
    clear(link)
    build(link)
    drive(link, options.break_at)
    show(link, options.out)
    for event in link.events:
        print(f"{getattr(event, 'from')} says: {event.WhichOneof('kind')}")
    link.close()
    print(f"{link.number} commands, {link.broken} times made again")


if __name__ == "__main__":
    try:
        main()
    except grpc.RpcError as error:
        sys.exit(f"wire rover: {error.details()}")
    except (Rejected, ConnectionError, OSError, ValueError) as error:
        sys.exit(f"wire rover: {error}")
