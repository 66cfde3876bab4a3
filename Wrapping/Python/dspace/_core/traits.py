"""The options of commands and their fields in the .proto files (options.proto): traits, ranges and defaults."""
from dspace.proto import commands_pb2 as pb
from dspace.proto import options_pb2
from dspace.proto import viewports_pb2

_COMMANDS = {field.name: field.message_type.GetOptions().Extensions[options_pb2.command]
             for field in pb.Command.DESCRIPTOR.oneofs_by_name["command"].fields}

# Names of the commands that a session which does not wait gives without waiting for the reply.
UNAWAITED = frozenset(name for name, options in _COMMANDS.items()
                      if options.wait == options_pb2.CommandOptions.OPTIONAL)


def results(command):
    """Names of the results in Reply of which a command gives one; none: it gives no result."""
    return [name for name in _COMMANDS[command].reply if name != "none"]


def limits(message, field):
    """The LimitOptions of a field of a message class: minimum, maximum, standard, standard_text."""
    return limits_of(message.DESCRIPTOR.fields_by_name[field])


def limits_of(field):
    """The same of a field's descriptor."""
    return field.GetOptions().Extensions[options_pb2.accepts]


def whole_range(message, field):
    """The least and the greatest whole number that a field accepts."""
    found = limits(message, field)
    return int(found.minimum), int(found.maximum)


def accepted(field):
    """What a field of whole numbers accepts, in words; "" where its .proto states no range."""
    found = limits_of(field)
    if found.HasField("maximum"):
        return f"an integer from {found.minimum:.0f} to {found.maximum:.0f}"
    return f"an integer from {found.minimum:.0f} on" if found.HasField("minimum") else ""


DEFAULT_SCENE = limits(pb.Command, "scene").standard_text  # what a command means that names no scene
SAMPLES = whole_range(viewports_pb2.CreateViewport, "samples")
DEFAULT_SAMPLES = int(limits(viewports_pb2.CreateViewport, "samples").standard)
SIDE = whole_range(viewports_pb2.CreateViewport, "width")  # of a viewport [pixels]
FONT_SIZES = whole_range(viewports_pb2.SetTextTable, "font_size")  # [pixels]


def scene_name(command):
    """The name of the scene that a command is about."""
    return command.scene or DEFAULT_SCENE
