"""Recordings made row by row, with checksums worked out from Documentation/Recording.md and not from what Dspace reads
them with. The tables are those that Dspace makes."""
import contextlib
import functools
import hashlib
import os
import sqlite3
import struct
import tempfile
from typing import NamedTuple

import dspace
from dspace.recording.file import Asset, Row

PART = 4 << 20  # bytes of a file in one row


class Content(NamedTuple):
    """`size` bytes of a packed file from byte `place` on; where `data` is shorter it is zlib's."""

    id: int
    asset: int
    place: int
    size: int
    data: bytes


@functools.lru_cache(maxsize=None)
def schema():
    """The statements that make a recording's tables, of a recording of nothing."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "empty.dspace")
        with dspace.Session() as session:
            session.record(path).stop()
        with contextlib.closing(sqlite3.connect(path)) as database:
            return [sql for sql, in database.execute("SELECT sql FROM sqlite_master WHERE sql IS NOT NULL")]


def create_recording(path):
    """A recording with empty tables: its open database."""
    database = sqlite3.connect(path)
    database.execute("PRAGMA page_size=65536")
    with database:
        for sql in schema():
            database.execute(sql)
        database.execute("INSERT INTO meta VALUES('format', 1)")
    return database


def checksum(row, table):
    head = (b"S" if table == "snapshot" else b"C") + struct.pack("<Qddi", row.seq, row.time, row.wall, row.kind)
    return hashlib.sha256(head + row.payload).digest()[:16]


def checksum_of_asset(asset):
    texts = [asset.state.encode(), os.fsencode(asset.path), asset.sha256]
    head = struct.pack("<cqq?QQQ", b"A", asset.id, asset.size, asset.packed, *map(len, texts))
    return hashlib.sha256(head + b"".join(texts)).digest()[:16]


def checksum_of_content(content):
    head = struct.pack("<cqqqq", b"P", content.id, content.asset, content.place, content.size)
    return hashlib.sha256(head + content.data).digest()[:16]


def put_rows(database, table, rows):
    """Commands or snapshots (Row)."""
    database.executemany(f"INSERT INTO {table} VALUES(?,?,?,?,?,?)", ((*row, checksum(row, table)) for row in rows))


def put_assets(database, assets):
    database.executemany("INSERT INTO asset VALUES(?,?,?,?,?,?,?)",
                         ((*each, checksum_of_asset(each)) for each in assets))


def put_contents(database, contents):
    database.executemany("INSERT INTO content VALUES(?,?,?,?,?,?)",
                         ((*each, checksum_of_content(each)) for each in contents))


def write_recording(path, commands, snapshots):
    """A recording of these Rows."""
    with contextlib.closing(create_recording(path)) as database, database:
        put_rows(database, "command", commands)
        put_rows(database, "snapshot", snapshots)


def write_packed(path, folder, commands):
    """Writes a recording of commands with the files of a folder, which need not be what Dspace would pack."""
    write_recording(str(path), [], [])
    with sqlite3.connect(path) as database:
        put_rows(database, "snapshot", [Row(0, 0.0, 0.0, 0, b"")])
        put_rows(database, "command", [Row(i + 1, 0.0, 0.0, command.ListFields()[-1][0].number,
                                           command.SerializeToString()) for i, command in enumerate(commands)])
        for number, file in enumerate(sorted(folder.iterdir()), 1):
            data = file.read_bytes()
            asset = Asset(number, str(file), "read", len(data), hashlib.sha256(data).digest(), True)
            put_assets(database, [asset])
            put_contents(database, [Content(number, number, 0, len(data), data)])


def rows_in(path):
    """Commands and snapshots of a sound recording by number, each checked; without the reader."""
    found = {"command": {}, "snapshot": {}}
    with contextlib.closing(sqlite3.connect(path)) as database:
        for table, rows in found.items():
            for *values, proof in database.execute(f"SELECT seq, time, wall, kind, payload, checksum FROM {table}"):
                row = Row(*values)
                assert checksum(row, table) == proof
                rows[row.seq] = row
    return found["command"], found["snapshot"]


def salvaged_rows(path):
    """Commands and snapshots that `dspace log salvage` recovers, by number; none where nothing survives."""
    from dspace.recording.file import carry_out
    out = f"{path}.salvaged"
    try:
        carry_out("Salvage", os.fsencode(path), os.fsencode(out), 0)  # 0: the default limit
    except dspace.Corrupt as error:
        assert "nothing in it can be recovered" in str(error) and not os.path.exists(out)
        return {}, {}
    try:
        return rows_in(out)
    finally:
        os.unlink(out)


def gaps(seqs, last):
    """Ranges of 1..last that are not among the sorted numbers `seqs`."""
    found, expected = [], 1
    for seq in seqs:
        if seq > expected:
            found.append((expected, seq - 1))
        expected = seq + 1
    if last >= expected:
        found.append((expected, last))
    return found


__all__ = ["Asset", "Content", "PART", "Row", "checksum", "create_recording", "gaps", "put_assets", "put_contents",
           "put_rows", "rows_in", "salvaged_rows", "write_recording"]
