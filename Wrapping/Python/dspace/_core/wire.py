"""Converts messages to and from bytes, and arrays to and from messages without a Python number for each element.

A packed repeated field is, on the wire, its tag, its length and the little-endian array itself.
"""
import numpy as np
from google.protobuf.message import DecodeError, EncodeError

from dspace.errors import Corrupt, Resource
from dspace.proto import commands_pb2 as pb


def decode(kind, data, about, error=Corrupt):
    """Parses bytes into a message of a kind. Raises `error`, which names the subject, for malformed bytes."""
    try:
        return kind.FromString(data)
    except DecodeError:
        raise error(f"{about}: its {len(data)} bytes are not a {kind.DESCRIPTOR.name} message", about) from None


def command_of(payload, about="command"):
    """Parses the bytes of a recording into a Command."""
    return decode(pb.Command, payload, about)


def encode(message, about="command"):
    """Returns the bytes of a message. Raises dspace.Resource for one that is too large to send."""
    try:
        return message.SerializeToString()
    except EncodeError:
        raise Resource(f"{about}: it has more than 2 GiB; accepted: less in one", about) from None


def _varint(value):
    out = bytearray()
    while value > 0x7F:
        out.append(value & 0x7F | 0x80)
        value >>= 7
    out.append(value)
    return bytes(out)


def put_array(message, field, array):
    """Appends `array` to a packed field of doubles or fixed64 of `message`."""
    number = message.DESCRIPTOR.fields_by_name[field].number
    data = np.ascontiguousarray(array).tobytes()
    message.MergeFromString(_varint(number << 3 | 2) + _varint(len(data)) + data)


def get_array(message, field, dtype=np.float64):
    """The packed field as an array; quick when it is the message's only field that is set."""
    if [each.name for each, _ in message.ListFields()] != [field]:
        return np.array(getattr(message, field), dtype=dtype)
    data = message.SerializeToString()
    count = len(getattr(message, field))
    return np.frombuffer(data, dtype=dtype, offset=len(data) - count * np.dtype(dtype).itemsize)


def get_arrays(message, *fields):
    """Packed fields of doubles as arrays of their own, quick: no other field of the message may be set, and their numbers
    ascend."""
    data = message.SerializeToString()
    end = len(data)
    arrays = []
    for field in reversed(fields):
        count = len(getattr(message, field))
        arrays.append(np.frombuffer(data, np.float64, count, end - 8 * count).copy())
        if count:
            number = message.DESCRIPTOR.fields_by_name[field].number
            end -= 8 * count + len(_varint(8 * count)) + len(_varint(number << 3))
    if end:
        raise ValueError(f"fields besides {fields} are set")
    return arrays[::-1]
