"""A closed recording is one file, whoever reads it meanwhile, and is read where nothing can be written."""
import os
import shutil
import tempfile

import pytest

import dspace
import dspace.playback.playback  # now: later this process may not be allowed to read it
from dspace.recording.file import RecordingFile


def record(path, meanwhile=lambda: None):
    """300 steps; `meanwhile` is called after a hundred. The last command's number."""
    with dspace.Session() as session:
        scene = session.scene()
        frame = scene.add_frame("cart")
        recording = session.record(path)
        for step in range(300):
            scene.set_poses([frame], [[step, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]])
            if step == 99:
                recording.flush()
                meanwhile()
        recording.stop()
    with RecordingFile(path) as file:
        return file.last


def steps_of(path):
    with RecordingFile(path) as file:
        return file.last, sum(1 for _ in file.rows())


def test_it_is_one_file_though_somebody_reads_it(tmp_path):
    path, readers = tmp_path / "run.dspace", []
    last = record(path, lambda: readers.append(RecordingFile(path)))
    with readers[0] as reader:
        shutil.copy(path, tmp_path / "alone.dspace")
        assert steps_of(tmp_path / "alone.dspace") == (last, last)
        assert reader.last == last  # and goes on
    assert steps_of(path) == (last, last)


def test_reading_leaves_nothing_beside_it(tmp_path):
    last = record(tmp_path / "run.dspace")
    assert os.listdir(tmp_path) == ["run.dspace"]
    with RecordingFile(tmp_path / "run.dspace") as file:
        assert sum(1 for _ in file.rows()) == last
        assert os.listdir(tmp_path) == ["run.dspace"]


@pytest.fixture
def forbidden():
    """A folder that this process may read and not write once the function beside it was called."""
    with tempfile.TemporaryDirectory(prefix="dspace-test-", dir="/tmp") as folder:  # which everybody may enter
        os.chmod(folder, 0o755)
        user = os.geteuid()

        def forbid():
            for name in os.listdir(folder):
                os.chmod(os.path.join(folder, name), 0o444)
            os.chmod(folder, 0o555)
            if user == 0:  # who may write anywhere
                try:
                    os.seteuid(65534)
                except OSError as error:  # in a user namespace without others
                    pytest.skip(f"no other user to become: {error}")
            with pytest.raises(OSError):
                open(os.path.join(folder, "new"), "wb").close()

        try:
            yield folder, forbid
        finally:
            os.seteuid(user)
            os.chmod(folder, 0o755)


@pytest.mark.parametrize("was_closed", (True, False))
def test_it_is_read_where_nothing_can_be_written(tmp_path, forbidden, was_closed):
    folder, forbid = forbidden
    path, readers = tmp_path / "run.dspace", []
    last = record(path, lambda: None if was_closed else readers.append(RecordingFile(path)))
    there = os.path.join(folder, "run.dspace")  # as it is while it is read: its header says that it may have a log
    shutil.copy(path, there)
    for reader in readers:
        reader.close()
    with open(there, "rb") as file:
        assert file.read(20)[18:] == (b"\1\1" if was_closed else b"\2\2")
    forbid()
    assert steps_of(there) == (last, last)
    with dspace.Playback(there) as run:
        run.seek(0.0)
        assert "cart" in run.session.scene().frames
