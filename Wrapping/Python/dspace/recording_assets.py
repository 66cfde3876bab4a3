"""The files that a recording's commands need: noted, packed into it, and unpacked. Recording.md has the tables."""
import hashlib
import os
import re
import shutil
import struct
import tempfile
import weakref
import zlib
from typing import NamedTuple

from dspace.errors import Corrupt, Io, NotFound, Resource
from dspace.session import commands_pb2 as pb

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


def is_packed(assets):
    """Whether the files that there were are in the recording, all of them."""
    return any(asset.packed for asset in assets) and all(asset.packed for asset in assets if asset.state == "read")


def hash_of(path, take=lambda place, block: None):
    """(bytes, SHA-256) of a file, read block by block."""
    digest, size = hashlib.sha256(), 0
    with open(path, "rb") as file:
        for block in iter(lambda: file.read(PART), b""):
            digest.update(block)
            take(size, block)
            size += len(block)
    return size, digest.digest()


def check_assets(file, assets=None):
    """That files on this machine, absent: all, are what they were; raises with the first one that is not."""
    for asset in assets_of(file) if assets is None else assets:
        named = f"{file.label}: file {asset.path!r}"
        if asset.state == "changed":
            raise Corrupt(f"{named} had changed between its reading and its recording; accepted: only "
                          "check_assets=False, where its present content will do", asset.path)
        if asset.state == "absent" and os.path.lexists(asset.path):
            raise Corrupt(f"{named} was not there when it was recorded, and now is", asset.path)
        if asset.state != "read":  # it could not be read then: a folder, or on a server
            continue
        if not os.path.isfile(asset.path):
            raise NotFound(f"{named}, which it needs, is not there", asset.path)
        if os.path.getsize(asset.path) != asset.size or hash_of(asset.path)[1] != asset.sha256:
            raise Corrupt(f"{named} has changed since it was recorded; accepted: its {asset.size} bytes of "
                          f"SHA-256 {asset.sha256.hex()}", asset.path)


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


class Unpacked:
    """The packed files of a recording in a folder of their own, at their own paths below it, so that they name
    each other as they did. Nothing is ever written elsewhere; close() removes all of it."""

    def __init__(self, file):
        self._places = {}  # of the recording's paths
        self.folder = os.path.realpath(tempfile.mkdtemp(prefix="dspace-play-"))
        self._remove = weakref.finalize(self, shutil.rmtree, self.folder, ignore_errors=True)
        try:
            self.add(file, assets_of(file))
        except BaseException:
            self.close()
            raise

    def add(self, file, assets):
        """Unpacks these, too: of a path that is there already in its place."""
        for asset in assets:
            if asset.state == "changed":
                raise Corrupt(f"{file.label}: file {asset.path!r} had changed between its reading and its recording",
                              asset.path)
        packed = [asset for asset in assets if asset.packed]
        needed, free = sum(asset.size for asset in packed), shutil.disk_usage(self.folder).free
        if needed > free:
            raise Resource(f"{file.label}: its files need {needed} bytes in {self.folder!r}, where "
                           f"{free} are free; accepted: TMPDIR with more", file.label)
        for asset in packed:
            if asset.path in self._places and os.path.lexists(self._places[asset.path]):
                os.remove(self._places[asset.path])
        self._places.update((asset.path, self.place(asset.path)) for asset in packed)
        numbers = part_numbers(file)
        for asset in packed:
            self._unpack(file, asset, numbers.get(asset.id, ()))
        for target in self._places.values():  # one that came before may name one that has come now
            self._mend(target)

    def close(self):
        self._remove()

    def place(self, path):
        """Where a path of the recording's is: below the folder, whatever it holds."""
        # normpath of an absolute path has no ".." left.
        return self.folder + os.path.normpath("/" + path.replace("\0", "")).replace("//", "/")

    def _unpack(self, file, asset, numbers):
        if not asset.path.startswith("/") or "\0" in asset.path:
            raise file.corrupt(f"{asset.path!r} is no path of a file")
        digest = hashlib.sha256()
        target = self._places[asset.path]
        try:
            os.makedirs(os.path.dirname(target), mode=0o700, exist_ok=True)
            flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | os.O_NOFOLLOW
            with os.fdopen(os.open(target, flags, 0o600), "wb") as out:
                for data in parts_of(file, asset, numbers):
                    digest.update(data)
                    out.write(data)
        except OSError as error:
            if isinstance(error, (FileExistsError, NotADirectoryError, IsADirectoryError)):
                raise file.corrupt(f"{asset.path!r} is there twice, or is a file and a folder") from None
            raise Io(f"{file.label}: {asset.path!r} cannot be unpacked: {error}", file.label) from None
        if digest.digest() != asset.sha256:
            raise file.corrupt(f"the content of {asset.path!r} is not what it was")

    def _mend(self, target):
        """Absolute names of other packed files in a mosaic or a robot's description, which are XML."""
        with open(target, "rb") as file:
            start = file.read(4096)
            if not any(mark in start for mark in (b"<VRTDataset", b"<OGRVRTDataSource", b"<robot")):
                return
            text = start + file.read()
        # A whole name only: what stands around it ends a value of XML.
        names = {os.fsencode(path): os.fsencode(place) for path, place in self._places.items()}
        either = b"|".join(re.escape(name) for name in sorted(names, key=len, reverse=True))
        text = re.sub(rb"(?<=[\">'])(file://)?(" + either + rb")(?=[\"<'])",
                      lambda found: (found[1] or b"") + names[found[2]], text)
        with open(target, "wb") as file:
            file.write(text)

    def map(self, payload):
        """A serialized command with its paths made those of the folder."""
        if b"/" not in payload:
            return payload
        command = pb.Command.FromString(payload)
        if command.WhichOneof("command") == "set_poses":
            return payload
        self._map_fields(command)
        if command.HasField("open_terrain"):
            terrain = command.open_terrain
            # Overviews of another machine are not to be had: they are built here, before the terrain opens.
            built = terrain.build_overviews if terrain.HasField("build_overviews") else True
            if not terrain.HasField("overview_cache") or terrain.overview_cache:
                terrain.overview_cache = os.path.join(self.folder, "overviews") if built else ""
        return command.SerializeToString()

    def _map_fields(self, message):
        for field, value in message.ListFields():
            if field.message_type is not None:
                for each in value if field.label == field.LABEL_REPEATED else (value,):
                    if hasattr(each, "ListFields"):
                        self._map_fields(each)
            elif field.name in ("path", "texture") and isinstance(value, str) and value:
                setattr(message, field.name, self._map_path(value))

    def _map_path(self, path):
        if path.startswith("/") and not path.startswith("/vsi"):
            return self.place(path)
        for known in sorted(self._places, key=len, reverse=True):  # a part of a file: "/vsizip/...", NETCDF:"..."
            if known in path:
                return path.replace(known, self._places[known])
        return path


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
