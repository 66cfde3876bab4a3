"""Arrays in and out of messages without a Python number for each element.

A packed repeated field is, on the wire, its tag, its length and the little-endian array itself.
"""
import numpy as np


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
