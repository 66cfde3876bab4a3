"""`dspace log salvage`: commands out of the raw pages of a damaged recording.

SQLite's file format (sqlite.org/fileformat2.html): pages of one size; a leaf page of a table begins with
byte 13, the number of its cells at 3, their places from 8 on. A cell is the payload's length, the row's id (both
varints), the payload, and where it does not fit, the number of the first page of a chain that holds the rest.
The payload is a record: types of its columns, then their values. What is found is believed only where the
row's own checksum holds.
"""
import collections
import contextlib
import mmap
import os
import struct

from dspace.command_line import Failed
from dspace.errors import Error
from dspace.recording_assets import Asset, Content
from dspace.recording_file import NewerFormat, RecordingFile, Row, checksum, new_recording

SIZES = (65536, 4096)  # of pages: ours, and a common one, where ours finds nothing
LEAF = 13
TURNS = 8  # of a log: pages of how many are looked at


def salvage(options):
    if not os.path.isfile(options.file):
        raise Failed(f"recording {options.file!r}: there is no such file")
    require_format(options.file)
    with new_recording(os.path.abspath(options.out)) as database:
        with database:
            for table, row in found_rows(options.file):
                put(database, table, row)
        counts = {table: database.execute(f"SELECT count(*), max({key}) FROM {table}").fetchone()
                  for table, key in (("command", "seq"), ("snapshot", "seq"), ("asset", "id"))}
        if not any(count for count, _ in counts.values()):
            raise Failed(f"recording {options.file!r}: nothing in it survives")
        last = max(counts["command"][1] or 0, counts["snapshot"][1] or 0)
        begin = begin_of(options.file, database)
        lost = gaps((seq for seq, in database.execute("SELECT seq FROM command ORDER BY seq")), last, begin)
        stateless = not database.execute("SELECT 1 FROM snapshot WHERE seq = ?", (begin,)).fetchone()
        unknown, broken = unknown_files(database), unpackable(database)
        with database:
            if begin:
                database.execute("INSERT INTO meta VALUES('begin', ?)", (begin,))
            database.execute("INSERT INTO meta VALUES('lost', ?)", (" ".join(f"{a}-{b}" for a, b in lost),))
    print(f"{options.out}: {counts['command'][0]} commands, {counts['snapshot'][0]} snapshots, "
          f"{counts['asset'][0]} files")
    if stateless:
        print(f"lost: the state before command {begin + 1}")
    for first, end in lost:
        print(f"lost: commands {first} to {end}")
    for path in broken:
        print(f"lost: the packed content of {path!r}")
    if unknown:
        print(f"lost: what is known of {unknown} files")
    print(f"what came after {counts['command'][1] or 0} is not known, nor which files after the first "
          f"{counts['asset'][1] or 0} it needs")
    return 1 if lost or broken or unknown or stateless else 0


def require_format(path):
    """Refuses a recording that says of itself that a newer Dspace wrote it: its rows may mean something else."""
    try:
        with RecordingFile(path):
            pass
    except NewerFormat:
        raise
    except Error:  # damaged, as expected
        pass


def begin_of(path, database):
    """The snapshot that a recording which was cut begins with, where that is among what was found; else 0."""
    try:
        with RecordingFile(path) as file:
            begin = file.begin
    except Error:  # damaged: what it lacks is lost
        return 0
    return begin if database.execute("SELECT 1 FROM snapshot WHERE seq = ?", (begin,)).fetchone() else 0


def put(database, table, row):
    if table == "asset":
        # Packing changes a row that is there, and its page from before may be found, too: what is packed is newer.
        database.execute("INSERT INTO asset VALUES(?,CAST(? AS TEXT),?,?,?,?,?) ON CONFLICT(id) DO UPDATE SET "
                         "path = excluded.path, state = excluded.state, size = excluded.size, sha256 = excluded.sha256, "
                         "packed = excluded.packed, checksum = excluded.checksum WHERE excluded.packed",
                         (row.id, os.fsencode(row.path), *row[2:], row.checksum))
    else:
        proof = row.checksum if table == "content" else checksum(row, table)
        database.execute(f"INSERT OR IGNORE INTO {table} VALUES(?,?,?,?,?,?)", (*row, proof))


def unknown_files(database):
    """How many files there must have been, by their ids, which have no gaps, here and in content, of which no row is
    there. Of those after the last nothing tells."""
    count, last = database.execute("SELECT count(*), coalesce(max(id), 0) FROM asset").fetchone()
    return max(last, database.execute("SELECT coalesce(max(asset), 0) FROM content").fetchone()[0]) - count


def unpackable(database):
    """Packed files of which parts are lost. Such a file is no longer told to be packed."""
    sizes = dict(database.execute("SELECT asset, sum(size) FROM content GROUP BY asset"))
    found = []
    with database:
        for values in database.execute("SELECT id, CAST(path AS BLOB), state, size, sha256, packed FROM asset "
                                       "WHERE packed").fetchall():
            asset = Asset(values[0], os.fsdecode(values[1]), *values[2:5], True)
            if sizes.get(asset.id, 0) != asset.size:
                found.append(asset.path)
                database.execute("UPDATE asset SET packed = 0, checksum = ? WHERE id = ?",
                                 (asset._replace(packed=False).checksum, asset.id))
    return found


def gaps(seqs, last, begin=0):
    """Ranges of begin + 1..last that are not there."""
    found, expected = [], begin + 1
    for seq in seqs:
        if seq > expected:
            found.append((expected, seq - 1))
        expected = seq + 1
    if last >= expected:
        found.append((expected, last))
    return found


def rows_in(path):
    """Commands and snapshots by number."""
    found = {"command": {}, "snapshot": {}}
    for table, row in found_rows(path):
        if table in found:
            found[table].setdefault(row.seq, row)
    return found["command"], found["snapshot"]


def found_rows(path):
    """(table, row) of everything in a recording's pages, and in those that its log holds, whose checksum holds.
    One that is there several times may come as often."""
    with opened(path) as data, opened(path + "-wal") as log:
        for size in SIZES:  # the head that states it may be damaged
            sources = [Pages(data, log, size, turn) for turn in turns_of(log, size)]
            any_found = False
            for page in every_page(data, log, size):
                for found in rows_of(page, sources, size):
                    any_found = True
                    yield found
            if any_found:
                return


@contextlib.contextmanager
def opened(path):
    """A file's bytes, mapped; none where there is no such file, or it is empty."""
    if not os.path.exists(path) or not os.path.getsize(path):
        yield b""
        return
    with open(path, "rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as data:
        yield data


def frames_of(log, size):
    """(page number, salt, place of the page) of every frame in a write-ahead log."""
    for at in range(32, len(log) - 24, 24 + size):
        yield struct.unpack(">I", log[at:at + 4])[0], log[at + 8:at + 16], at + 24


def turns_of(log, size):
    """Which pages a log holds in each of its turns, told by their salts: the log's own first, then the others (the
    head may be damaged); and none, which leaves the file itself."""
    turns = collections.defaultdict(dict)
    for number, salt, place in frames_of(log, size):
        turns[salt][number] = place
    own = log[16:24]
    order = sorted(turns, key=lambda salt: (salt != own, -len(turns[salt])))
    return [turns[salt] for salt in order[:TURNS]] + [{}]


class Pages:
    """Pages by number, the log's before the file's."""

    def __init__(self, data, log, size, turn):
        self.data, self.log, self.size, self.turn = data, log, size, turn

    def get(self, number):
        if number in self.turn:
            place = self.turn[number]
            return self.log[place:place + self.size]
        return self.data[(number - 1) * self.size:number * self.size] if number > 0 else b""


def every_page(data, log, size):
    """Of the file, and all versions in the log."""
    for place in range(0, len(data), size):
        yield data[place:place + size]
    for _, _, place in frames_of(log, size):
        yield log[place:place + size]


def rows_of(page, sources, size):
    """(table, row) of a leaf page, those whose checksum holds."""
    for start in (0, 100):  # the first page begins with the file's head
        if len(page) < start + 8 or page[start] != LEAF:
            continue
        count = struct.unpack(">H", page[start + 3:start + 5])[0]
        for n in range(min(count, size // 2)):
            place = page[start + 8 + 2 * n:start + 10 + 2 * n]
            if len(place) < 2:
                break
            for pages in sources:
                try:
                    found = row_at(page, struct.unpack(">H", place)[0], pages, size)
                except (IndexError, struct.error, ValueError, OverflowError):
                    continue  # no such row, or one that is damaged
                if found is not None:
                    yield found
                    break


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
    return believed(seq, columns)


def believed(key, columns):
    """(table, row) of a record whose checksum holds, or None."""
    if len(columns) == 7 and isinstance(columns[1], bytes) and isinstance(columns[2], bytes):
        asset = Asset(key, os.fsdecode(columns[1]), columns[2].decode(), columns[3], columns[4], bool(columns[5]))
        if isinstance(asset.size, int) and isinstance(asset.sha256, bytes) and asset.checksum == columns[6]:
            return "asset", asset
    if len(columns) != 6 or columns[0] is not None or not isinstance(columns[4], bytes):
        return None
    if all(isinstance(each, int) for each in columns[1:4]):
        content = Content(key, *columns[1:5])
        if content.checksum == columns[5]:
            return "content", content
    if not all(isinstance(each, (int, float)) for each in columns[1:4]):
        return None
    row = Row(key, float(columns[1]), float(columns[2]), columns[3], columns[4])
    for table in ("command", "snapshot"):
        if checksum(row, table) == columns[5]:
            return table, row
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
        if len(chained) < 4 or following in seen:
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
