"""`dspace log salvage`: commands out of the raw pages of a damaged recording.

SQLite's file format (sqlite.org/fileformat2.html): pages of one size; a leaf page of a table begins with
byte 13, the number of its cells at 3, their places from 8 on. A cell is the payload's length, the row's id (both
varints), the payload, and where it does not fit, the number of the first page of a chain that holds the rest.
The payload is a record: types of its columns, then their values. What is found is believed only where the
row's own checksum holds.
"""
import os
import struct

from dspace.command_line import Failed
from dspace.recording_file import Row, checksum, write_recording

SIZES = (65536, 4096)  # of pages: ours, and a common one
LEAF = 13


def salvage(options):
    if not os.path.isfile(options.file):
        raise Failed(f"recording {options.file!r}: there is no such file")
    commands, snapshots = rows_in(options.file)
    if not commands and not snapshots:
        raise Failed(f"recording {options.file!r}: nothing in it survives")
    write_recording(os.path.abspath(options.out), [commands[seq] for seq in sorted(commands)],
                    [snapshots[seq] for seq in sorted(snapshots)])
    print(f"{options.out}: {len(commands)} commands, {len(snapshots)} snapshots")
    lost = gaps(sorted(commands), max([*commands, *snapshots]))
    for first, last in lost:
        print(f"lost: commands {first} to {last}")
    print(f"what came after {max([*commands, 0])} is not known")
    return 1 if lost else 0


def gaps(seqs, last):
    """Ranges of 1..last that are not there."""
    found, expected = [], 1
    for seq in [*seqs, last + 1]:
        if seq > expected:
            found.append((expected, seq - 1))
        expected = seq + 1
    return found


def rows_in(path):
    """Commands and snapshots by number: of the file's pages, and of those that its log holds."""
    with open(path, "rb") as file:
        data = file.read()
    log = b""
    if os.path.exists(path + "-wal"):
        with open(path + "-wal", "rb") as file:
            log = file.read()
    commands, snapshots = {}, {}
    for size in SIZES:  # the head that states it may be damaged
        whole = pages_of(data, size)
        newest = {**whole, **log_pages(log, size)}
        for pages in (newest, whole) if log else (whole,):
            for page in pages.values():
                for row, table in rows_of(page, pages, size):
                    (snapshots if table == "snapshot" else commands).setdefault(row.seq, row)
    return commands, snapshots


def pages_of(data, size):
    return {n + 1: data[n * size:(n + 1) * size] for n in range((len(data) + size - 1) // size)}


def log_pages(data, size):
    """The last version of every page in a write-ahead log: frames of a head of 24 bytes and a page, those
    whose salt is the log's own (others are of an earlier turn)."""
    pages, salt = {}, data[16:24]
    for at in range(32, len(data) - 24, 24 + size):
        if data[at + 8:at + 16] == salt:
            pages[struct.unpack(">I", data[at:at + 4])[0]] = data[at + 24:at + 24 + size]
    return pages


def rows_of(page, pages, size):
    """(row, table) of a leaf page, those whose checksum holds."""
    for start in (0, 100):  # the first page begins with the file's head
        if len(page) < start + 8 or page[start] != LEAF:
            continue
        count = struct.unpack(">H", page[start + 3:start + 5])[0]
        for n in range(min(count, size // 2)):
            place = page[start + 8 + 2 * n:start + 10 + 2 * n]
            if len(place) < 2:
                break
            try:
                found = row_at(page, struct.unpack(">H", place)[0], pages, size)
            except (IndexError, struct.error, ValueError, OverflowError):
                continue  # no such row, or one that is damaged
            if found is not None:
                yield found


def varint(data, at):
    value = 0
    for n in range(9):
        byte = data[at + n]
        if n == 8:
            return value << 8 | byte, at + 9
        value = value << 7 | byte & 127
        if byte < 128:
            return value, at + n + 1
    raise ValueError


def row_at(page, at, pages, page_size):
    size, at = varint(page, at)
    seq, at = varint(page, at)
    record = payload_at(page, at, size, pages, page_size)
    head, place = varint(record, 0)
    values = head
    columns = []
    while place < head:
        kind, place = varint(record, place)
        value, values = column(record, kind, values)
        columns.append(value)
    if len(columns) != 6 or columns[0] is not None or not isinstance(columns[4], bytes):
        return None
    row = Row(seq, float(columns[1]), float(columns[2]), columns[3], columns[4])
    for table in ("command", "snapshot"):
        if checksum(row, table) == columns[5]:
            return row, table
    return None


def payload_at(page, at, size, pages, page_size):
    """With its overflow pages; how much is on the leaf itself is SQLite's rule."""
    most = page_size - 35
    if size <= most:
        if at + size > len(page):
            raise ValueError
        return page[at:at + size]
    least = (page_size - 12) * 32 // 255 - 23
    local = least + (size - least) % (page_size - 4)
    local = local if local <= most else least
    parts, got = [page[at:at + local]], local
    following = struct.unpack(">I", page[at + local:at + local + 4])[0]
    seen = set()
    while got < size:
        chained = pages.get(following)
        if chained is None or following in seen:
            raise ValueError
        seen.add(following)
        parts.append(chained[4:4 + min(size - got, page_size - 4)])
        got += len(parts[-1])
        if len(chained) < page_size and got < size:
            raise ValueError
        following = struct.unpack(">I", chained[:4])[0]
    return b"".join(parts)


def column(record, kind, at):
    """A value of a record by SQLite's serial types, and where the next one is."""
    sizes = {1: 1, 2: 2, 3: 3, 4: 4, 5: 6, 6: 8}
    if kind == 0:
        return None, at
    if kind in sizes:
        end = at + sizes[kind]
        return int.from_bytes(record[at:end], "big", signed=True), end
    if kind == 7:
        return struct.unpack(">d", record[at:at + 8])[0], at + 8
    if kind in (8, 9):
        return kind - 8, at
    if kind < 12:
        raise ValueError
    end = at + (kind - 12) // 2
    if end > len(record):
        raise ValueError
    return record[at:end], end
