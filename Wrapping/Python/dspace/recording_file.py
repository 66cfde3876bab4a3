"""What a recording holds: Documentation/Recording.md says how. Nothing is drawn here."""
import contextlib
import hashlib
import os
import sqlite3
import struct
from typing import NamedTuple

from dspace._fields import refuse, text
from dspace._files import AtomicFile
from dspace.errors import Closed, Corrupt, Io, NotFound, Unsupported, WrongThread
from dspace.recording_assets import assets_of, part_numbers, parts_of

FORMAT = 1
SCHEMA = """
CREATE TABLE meta(key TEXT PRIMARY KEY, value) WITHOUT ROWID;
CREATE TABLE command(seq INTEGER PRIMARY KEY, time REAL NOT NULL, wall REAL NOT NULL,
  kind INTEGER NOT NULL, payload BLOB NOT NULL, checksum BLOB NOT NULL);
CREATE TABLE snapshot(seq INTEGER PRIMARY KEY, time REAL NOT NULL, wall REAL NOT NULL,
  kind INTEGER NOT NULL, payload BLOB NOT NULL, checksum BLOB NOT NULL);
CREATE INDEX step ON command(time) WHERE kind = 13;
CREATE TABLE asset(id INTEGER PRIMARY KEY, path TEXT NOT NULL, state TEXT NOT NULL,
  size INTEGER NOT NULL, sha256 BLOB NOT NULL, packed INTEGER NOT NULL, checksum BLOB NOT NULL);
CREATE TABLE content(id INTEGER PRIMARY KEY, asset INTEGER NOT NULL, place INTEGER NOT NULL,
  size INTEGER NOT NULL, data BLOB NOT NULL, checksum BLOB NOT NULL);
"""
MAGIC, NOT_A_DATABASE = b"SQLite format 3\0", 26
# Of SQLite's result codes (sqlite.org/rescode.html) those of what is no damage: locks, rights, memory, disks.
OF_THE_SYSTEM = {3, 5, 6, 7, 8, 9, 10, 13, 14, 15, 22, 23}
COLUMNS = "seq, time, wall, kind, payload, checksum"


def path_of(path):
    """An absolute path, of a str or a path object."""
    path = text(os.fspath(path) if isinstance(path, os.PathLike) else path, "the path", "recording",
                "a str or a path")
    if not path or "\0" in path:
        refuse("recording", "the path", path, "one that is not empty and holds no zero bytes")
    return os.path.abspath(path)


def told(label, error):
    """What an error of SQLite is told as: dspace.Closed, dspace.WrongThread or dspace.Io, and what else it may be is
    damage, dspace.Corrupt."""
    said = str(error)
    if isinstance(error, sqlite3.ProgrammingError) and "thread" in said:
        return WrongThread(f"{label}: it is read in another thread; accepted: the one that opened it", label)
    if isinstance(error, sqlite3.ProgrammingError) and "closed" in said:
        return Closed(f"{label}: it is closed; accepted: to open it again", label)
    if (getattr(error, "sqlite_errorcode", None) or 0) & 255 in OF_THE_SYSTEM:
        return Io(f"{label}: {said}; accepted: a file that can be opened and read, in a folder with room, that nobody "
                  "has locked", label)
    return Corrupt(f"{label}: {said}; `dspace log salvage` brings back what survives", label)


class Row(NamedTuple):
    """A command, or a snapshot: the commands that make the state after command `seq`."""

    seq: int
    time: float  # of the simulation [s]
    wall: float  # seconds past 1970 UTC
    kind: int    # field number in Command; of a snapshot: the number of its commands
    payload: bytes


def checksum(row, table):
    head = (b"S" if table == "snapshot" else b"C") + struct.pack("<Qddi", row.seq, row.time, row.wall, row.kind)
    return hashlib.sha256(head + row.payload).digest()[:16]


def commands_of(snapshot):
    """The serialized commands of a snapshot's payload: each after its length as a varint."""
    data, at, found = snapshot.payload, 0, []
    while at < len(data):
        length = shift = 0
        while True:
            byte = data[at]
            at += 1
            length |= (byte & 127) << shift
            shift += 7
            if byte < 128:
                break
        found.append(data[at:at + length])
        at += length
    return found


def _uri(path):
    """For SQLite, which opens it for reading only. It would make files beside one that was not closed well; where it
    cannot, and nothing is in its log, it is told that nobody writes."""
    quoted = path.replace("%", "%25").replace("?", "%3f").replace("#", "%23")
    try:
        finished = os.path.getsize(path + "-wal") == 0
    except FileNotFoundError:
        finished = True
    writable = os.access(os.path.dirname(os.path.abspath(path)), os.W_OK, effective_ids=True)
    return f"file:{quoted}?" + ("mode=ro" if writable or not finished else "immutable=1")


class NewerFormat(Unsupported):
    """A recording of a format that only a newer Dspace knows."""


class RecordingFile:
    """A recording, to be read, also while it is written. Every row is checked against its checksum when it
    is read: a damaged one is dspace.Corrupt, which names the file and the command. What is no recording, or one that a
    newer Dspace wrote, is dspace.Unsupported; what the operating system refuses, or somebody has locked, dspace.Io."""

    def __init__(self, path):
        self.path = path_of(path)
        self.label = f"recording {self.path!r}"
        if not os.path.isfile(self.path):
            raise NotFound(f"{self.label}: there is no such file", self.label)
        self._database = None
        try:
            self._database = sqlite3.connect(_uri(self.path), uri=True, timeout=10)
            self._database.text_factory = os.fsdecode  # paths may be any bytes
            self._check_format()
        except BaseException as error:
            self.close()
            if isinstance(error, sqlite3.Error):
                raise told(self.label, error) from None
            raise

    def _check_format(self):
        if not os.path.getsize(self.path):
            raise self._other("it is empty")
        try:
            tables = {name for name, in self._database.execute("SELECT name FROM sqlite_master")}
        except sqlite3.Error as error:
            begin = self._begin() if getattr(error, "sqlite_errorcode", None) == NOT_A_DATABASE else MAGIC
            if begin != MAGIC:
                raise self._other(f"it begins with {begin!r}") from None
            raise
        if not tables & {"meta", "command"}:
            raise self._other("it is an SQLite file without the tables of one")
        found = self.ask("SELECT value FROM meta WHERE key = 'format'")
        if not found or found[0][0] != FORMAT:
            said = found[0][0] if found else None
            if isinstance(said, int) and said > FORMAT:
                raise NewerFormat(f"{self.label}: its format is {said}, a newer Dspace wrote it; accepted: {FORMAT}",
                                  self.label)
            raise Unsupported(f"{self.label}: its format is {said!r}; accepted: {FORMAT}", self.label)

    def _begin(self):
        # Of what SQLite takes for one of its files this would let go all of this process's locks on it.
        with open(self.path, "rb") as file:
            return file.read(len(MAGIC))

    def _other(self, why):
        return Unsupported(f"{self.label}: it is no recording, {why}; accepted: a .dspace file (of a damaged one "
                           "`dspace log salvage` brings back what survives)", self.label)

    def close(self):
        if self._database is not None:
            self._database.close()

    def __enter__(self):
        return self

    def __exit__(self, *exception):
        self.close()

    def copy_to(self, database):
        """All of it into an empty database, also while it is written."""
        try:
            self._database.backup(database)
        except sqlite3.Error as error:
            raise told(self.label, error) from None

    def ask(self, sql, *values):
        try:
            return self._database.execute(sql, values).fetchall()
        except (sqlite3.Error, OverflowError) as error:
            raise told(self.label, error) from None

    def corrupt(self, what):
        return Corrupt(f"{self.label}: {what}; `dspace log salvage` brings back what survives", self.label)

    def _check(self, values, table):
        row = Row(*values[:5])
        try:
            good = isinstance(row.payload, bytes) and checksum(row, table) == values[5]
        except (struct.error, TypeError):
            good = False
        if not good:
            raise self.corrupt(f"{table} {row.seq} is damaged")
        return row

    def rows(self, first=1, last=None, table="command"):
        """The rows first..last in their order; commands with none missing between."""
        try:
            cursor = self._database.execute(
                f"SELECT {COLUMNS} FROM {table} WHERE seq BETWEEN ? AND ? ORDER BY seq",
                (first, 2 ** 62 if last is None else last))
            expected = first
            for values in cursor:
                row = self._check(values, table)
                if table == "command" and row.seq != expected:
                    raise self.corrupt(f"commands {expected} to {row.seq - 1} are missing")
                expected = row.seq + 1
                yield row
        except (sqlite3.Error, OverflowError) as error:
            raise told(self.label, error) from None
        if table == "command" and last is not None and expected <= last:
            raise self.corrupt(f"commands {expected} to {last} are missing")

    def rows_of(self, kinds, first, last):
        """The commands first..last of some kinds (field numbers) in their order; none of any kind is missing.
        All are read and checked: a kind that is damaged must not hide one."""
        return (row for row in self.rows(first, last) if row.kind in kinds)

    def only(self, kinds, first, last):
        """The same, and no others are read: where one whose kind is damaged may be passed over."""
        sql = (f"SELECT {COLUMNS} FROM command WHERE seq BETWEEN ? AND ? AND kind IN ({', '.join('?' * len(kinds))}) "
               "ORDER BY seq")
        return (self._check(values, "command") for values in self.ask(sql, first, last, *kinds))

    @property
    def last(self):
        """The last command's number; 0 without any."""
        return self.ask("SELECT max(seq) FROM command")[0][0] or 0

    def steps(self):
        """(seq, time) of every command that set the time, in order."""
        return sorted(self.ask("SELECT seq, time FROM command INDEXED BY step WHERE kind = 13"))

    def snapshot(self, seq):
        """The last snapshot at or before a command."""
        found = self.ask(f"SELECT {COLUMNS} FROM snapshot WHERE seq <= ? ORDER BY seq DESC LIMIT 1", seq)
        if not found:
            raise self.corrupt(f"the state before command {seq} is not there")
        return self._check(found[0], "snapshot")

    @property
    def assets(self):
        """The files that its commands need (recording_assets.Asset), by path."""
        return assets_of(self)

    @property
    def lost(self):
        """Ranges (first, last) of commands that salvaging it did not bring back."""
        found = self.ask("SELECT value FROM meta WHERE key = 'lost'")
        try:
            return [tuple(map(int, each.split("-"))) for each in found[0][0].split()] if found else []
        except (ValueError, AttributeError):
            raise self.corrupt("what it says of lost commands is damaged") from None

    @property
    def begin(self):
        """The number of the snapshot that it begins with: 0, unless it was cut."""
        found = self.ask("SELECT value FROM meta WHERE key = 'begin'")
        if found and not (isinstance(found[0][0], int) and found[0][0] >= 0):
            raise self.corrupt("what it says of its beginning is damaged")
        return found[0][0] if found else 0

    def check(self):
        """Reads all of it; raises at the first damage."""
        first = self.first
        for lost, after in [*self.lost, (None, None)]:
            for _ in self.rows(first, lost and lost - 1):
                pass
            first = after and after + 1
        for _ in self.rows(0, table="snapshot"):
            pass
        numbers = part_numbers(self)
        for asset in self.assets:
            for _ in parts_of(self, asset, numbers.get(asset.id, ())) if asset.packed else ():
                pass
        said = self.ask("PRAGMA integrity_check(1)")
        if said != [("ok",)]:
            raise self.corrupt(said[0][0])

    @property
    def first(self):
        """The first command's number: 1, unless it was cut."""
        return self.ask("SELECT min(seq) FROM command")[0][0] or 1


@contextlib.contextmanager
def new_recording(path):
    """A new recording with empty tables, in a `with` statement: its open database. The file appears at the end of the
    block, complete; when the block raises there is none."""
    about, accepted = f"recording {path!r}", "a new file in a folder that may be written and has room"
    folder = os.path.dirname(os.path.abspath(path))
    if not os.path.isdir(folder):
        raise NotFound(f"{about}: there is no folder {folder!r}; accepted: a folder that is there", "recording")
    with AtomicFile(path, about, new=True, accepted=accepted) as file:
        log = file.temporary + "-wal"
        try:
            with contextlib.closing(sqlite3.connect(file.temporary)) as database:
                database.executescript("PRAGMA page_size=65536; PRAGMA cache_size=-65536;" + SCHEMA)
                with database:
                    database.execute("INSERT INTO meta VALUES('format', ?)", (FORMAT,))
                yield database
            if os.path.exists(log) and os.path.getsize(log):  # close() tells of no failure
                raise Io(f"{about}: its log cannot be written into it; accepted: {accepted}", "recording")
        except sqlite3.Error as error:
            raise Io(f"{about}: {error}; accepted: {accepted}", "recording") from None
        finally:
            for each in (log, f"{file.temporary}-shm", f"{file.temporary}-journal"):
                with contextlib.suppress(OSError):
                    os.unlink(each)


def put_rows(database, table, rows):
    """Commands or snapshots; those whose number is there already are left out."""
    database.executemany(f"INSERT OR IGNORE INTO {table} VALUES(?,?,?,?,?,?)",
                         ((*row, checksum(row, table)) for row in rows))


def write_recording(path, commands, snapshots, assets_from=None, begin=0):
    """A new recording of rows that were read, with the files of the recording `assets_from`; begin: the snapshot that
    it begins with."""
    with new_recording(path) as database:
        if assets_from is not None:
            database.execute("ATTACH ? AS other", (assets_from,))
        with database:
            if begin:
                database.execute("INSERT INTO meta VALUES('begin', ?)", (begin,))
            put_rows(database, "command", commands)
            put_rows(database, "snapshot", snapshots)
            for table in ("asset", "content") if assets_from is not None else ():
                database.execute(f"INSERT INTO {table} SELECT * FROM other.{table}")
