"""The files that a recording's commands need: noted, and packed into it. Recording.md has the tables."""
import hashlib
import os
import struct
import zlib
from typing import NamedTuple

from dspace.errors import Corrupt

COLUMNS = "id, path, state, size, sha256, packed, checksum"
PART = 4 << 20      # bytes of a file in one row
PARTS_AT_ONCE = 16  # rows in one transaction


class Asset(NamedTuple):
    """A file. state: "read"; "absent", "unreadable" or "changed", these without size, hash and content."""

    id: int
    path: str
    state: str
    size: int
    sha256: bytes
    packed: bool

    @property
    def checksum(self):
        texts = [self.state.encode(), self.path.encode(errors="surrogateescape"), self.sha256]
        head = struct.pack("<cqq?QQQ", b"A", self.id, self.size, self.packed, *map(len, texts))
        return hashlib.sha256(head + b"".join(texts)).digest()[:16]


class Content(NamedTuple):
    """`size` bytes of a packed file from byte `place` on; where `data` is shorter it is zlib's."""

    id: int
    asset: int
    place: int
    size: int
    data: bytes

    @property
    def checksum(self):
        head = struct.pack("<cqqqq", b"P", self.id, self.asset, self.place, self.size)
        return hashlib.sha256(head + self.data).digest()[:16]


def assets_of(file, after=0):
    """A RecordingFile's, of the rows after that of id `after`, each path's last, by path."""
    found = {}
    for values in file.ask(f"SELECT {COLUMNS} FROM asset WHERE id > {int(after)} ORDER BY id"):
        asset = Asset(*values[:5], bool(values[5]))
        try:
            good = asset.checksum == values[6]
        except (struct.error, TypeError, AttributeError):
            good = False
        if not good:
            raise file.corrupt(f"asset {values[0]} is damaged")
        found[asset.path] = asset
    return [found[path] for path in sorted(found)]


def hash_of(path, take=lambda place, block: None):
    """(bytes, SHA-256) of a file, read block by block."""
    digest, size = hashlib.sha256(), 0
    with open(path, "rb") as file:
        for block in iter(lambda: file.read(PART), b""):
            digest.update(block)
            take(size, block)
            size += len(block)
    return size, digest.digest()


def part_numbers(file):
    """The rows of every packed file's content in their order, by asset."""
    numbers = {}
    for asset, number in file.ask("SELECT asset, id FROM content ORDER BY place"):
        numbers.setdefault(asset, []).append(number)
    return numbers


def parts_of(file, asset, numbers):
    """The content of a packed file, part by part, each checked."""
    place = 0
    for number in numbers:
        values = file.ask("SELECT id, asset, place, size, data, checksum FROM content WHERE id = ?", number)[0]
        part = Content(*values[:5])
        try:
            good = part.checksum == values[5]
        except (struct.error, TypeError):
            good = False
        if not good or part.place != place or not 0 < part.size <= PART:
            raise file.corrupt(f"the content of {asset.path!r} is damaged at byte {place}")
        data = part.data
        if len(data) != part.size:
            opened = zlib.decompressobj()
            try:
                data = opened.decompress(data, part.size + 1)  # no more, whatever it would grow to
            except zlib.error:
                data = b""
            if len(data) != part.size:
                raise file.corrupt(f"the content of {asset.path!r} is damaged at byte {place}")
        yield data
        place += part.size
    if place != asset.size:
        raise file.corrupt(f"the content of {asset.path!r} ends at byte {place} of {asset.size}")


def pack(database, label):
    """Takes the content of all files that a recording notes into it. `database`: its connection, open for writing,
    with no transaction under way. Returns the paths of what could not be had. Raises for a file that is not what
    it was."""
    class Asked:  # as assets_of asks a RecordingFile
        @staticmethod
        def ask(sql):
            return database.execute(sql).fetchall()

        @staticmethod
        def corrupt(what):
            return Corrupt(f"{label}: {what}", label)

    missing = []
    for asset in assets_of(Asked):
        if asset.state == "absent" or asset.packed:
            continue
        if asset.state != "read" or not os.path.isfile(asset.path):
            missing.append(asset.path)
            continue
        expected = (asset.size, asset.sha256)
        changed = Corrupt(f"{label}: file {asset.path!r} has changed since it was recorded; accepted: its "
                          f"{asset.size} bytes of SHA-256 {asset.sha256.hex()}", asset.path)
        if hash_of(asset.path) != expected:
            raise changed
        number = (database.execute("SELECT max(id) FROM content").fetchone()[0] or 0)
        found = _put_parts(database, asset, number)
        with database:
            if found != expected:
                database.execute("DELETE FROM content WHERE asset = ?", (asset.id,))
                raise changed
            packed = asset._replace(packed=True)
            database.execute("UPDATE asset SET packed = 1, checksum = ? WHERE id = ?", (packed.checksum, asset.id))
    return missing


def _put_parts(database, asset, number):
    waiting = []

    def put():
        with database:
            database.executemany("INSERT INTO content VALUES(?,?,?,?,?,?)",
                                 ((*part, part.checksum) for part in waiting))
        waiting.clear()

    def take(place, block):
        small = zlib.compress(block, 1)
        data = small if len(small) < 0.9 * len(block) else block
        waiting.append(Content(number + 1 + place // PART, asset.id, place, len(block), data))
        if len(waiting) == PARTS_AT_ONCE:
            put()

    with database:  # of a run that was broken off
        database.execute("DELETE FROM content WHERE asset = ?", (asset.id,))
    found = hash_of(asset.path, take)
    put()
    return found
