"""The protobuf messages of commands and replies: `from dspace.session import commands_pb2`."""
