"""The protobuf messages of commands and replies: `from dspace.proto import commands_pb2`."""
