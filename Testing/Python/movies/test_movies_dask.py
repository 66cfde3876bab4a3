"""Movies that the workers of a Dask scheduler share: nobody waits for ever, and nothing piles up."""
import contextlib
import os
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import dspace
from dspace._core import dask_client
from dspace.batches import dask_workers
from dspace._core.png import png
from dspace.movies.folder import FRAME
from movies_support import SIZE, files, flight, run  # noqa: F401  (run: a fixture)
from needs import needs_module

distributed = needs_module("distributed", "python3-distributed")
ASKED = []  # (run, numbers): what workers were asked for, in this process
GATE = threading.Event()


@pytest.fixture(autouse=True)
def begun():
    ASKED.clear()
    GATE.clear()
    yield
    GATE.set()  # threads that wait end


@contextlib.contextmanager
def cluster_of(workers, folder):
    with distributed.LocalCluster(n_workers=workers, threads_per_worker=1, processes=False, protocol="tcp://",
                                  dashboard_address=None, local_directory=str(folder / "workers")) as cluster:
        yield cluster


def shades(words, run, numbers, expected, module):
    """In the place of dask_workers.pictures: at once, and without OpenGL."""
    ASKED.append((run, numbers))
    return [(number, [(FRAME % number, png(np.full((*SIZE[::-1], 3), number, np.uint8)))]) for number in numbers]


def waits(words, run, numbers, expected, module):
    ASKED.append((run, numbers))
    GATE.wait(60)
    return []


def failing(words, run, numbers, expected, module):
    raise RuntimeError("the card is gone")


def test_without_a_worker_it_ends(run, tmp_path, monkeypatch):
    monkeypatch.setattr(dask_client, "PATIENCE", 1.0)
    with cluster_of(0, tmp_path) as cluster:
        with pytest.raises(dspace.Io, match="it has had no worker for 1 s.*accepted: one with a worker"):
            flight().make(run, tmp_path / "pictures", scheduler=cluster.scheduler_address)


def test_when_the_last_worker_goes_it_ends(run, tmp_path, monkeypatch):
    monkeypatch.setattr(dask_client, "PATIENCE", 1.0)
    monkeypatch.setattr(dask_workers, "pictures", waits)
    with cluster_of(1, tmp_path) as cluster:
        def leave():
            while not ASKED and not GATE.is_set():
                time.sleep(0.01)
            cluster.scale(0)

        thread = threading.Thread(target=leave)
        thread.start()
        try:
            with pytest.raises(dspace.Io, match="no worker"):
                flight().make(run, tmp_path / "pictures", scheduler=cluster.scheduler_address)
        finally:
            GATE.set()
            thread.join()


def test_when_the_scheduler_goes_it_ends(run, tmp_path, monkeypatch):
    """A process that is killed: nobody says that it is gone."""
    monkeypatch.setattr(dask_client, "PATIENCE", 2.0)
    monkeypatch.setattr(dask_workers, "pictures", waits)
    script = ("import asyncio, distributed\n"
              "async def main():\n"
              "    async with distributed.Scheduler(host='127.0.0.1', port=0, dashboard=False) as scheduler:\n"
              "        async with distributed.Worker(scheduler.address, nthreads=1, dashboard=False,\n"
              "                                      local_directory='workers'):\n"
              "            print(scheduler.address, flush=True)\n"
              "            await asyncio.sleep(120)\n"
              "asyncio.run(main())\n")
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([os.path.dirname(__file__), *filter(None, sys.path)])}
    process = subprocess.Popen([sys.executable, "-W", "ignore", "-c", script], stdout=subprocess.PIPE,
                               stderr=subprocess.DEVNULL, text=True, cwd=tmp_path, env=environment)
    try:
        address = process.stdout.readline().strip()
        finished = dask_client.finished

        def killed(*arguments):
            process.kill()
            yield from finished(*arguments)

        monkeypatch.setattr(dask_client, "finished", killed)
        with pytest.raises(dspace.Io, match="it has had no worker for 2 s, or has stopped"):
            flight().make(run, tmp_path / "pictures", scheduler=address)
    finally:
        process.kill()
        process.wait()
        process.stdout.close()


def test_a_worker_that_comes_late_draws(run, tmp_path, monkeypatch):
    monkeypatch.setattr(dask_workers, "pictures", shades)
    with cluster_of(0, tmp_path) as cluster:
        timer = threading.Timer(0.5, cluster.scale, (1,))
        timer.start()
        assert flight().make(run, tmp_path / "pictures", scheduler=cluster.scheduler_address) == 12
        timer.join()


def test_workers_keep_no_picture_that_is_written(run, tmp_path, monkeypatch):
    monkeypatch.setattr(dask_workers, "pictures", shades)
    monkeypatch.setattr(dask_workers, "_AT_ONCE", 2)
    told, kept = [], []

    def progress(done, total, seconds, drawn):
        told.append(done)
        if done < total or not drawn:
            return
        end = time.monotonic() + 20  # the scheduler hears of it in time
        while True:
            held = [task for task in cluster.scheduler.tasks.values() if task.state == "memory"]
            if len(held) <= 1 or time.monotonic() > end:
                break
            time.sleep(0.05)
        kept.append(len(held))

    with cluster_of(2, tmp_path) as cluster:
        flight().make(run, tmp_path / "pictures", scheduler=cluster.scheduler_address, progress=progress)
    assert told == list(range(0, 13, 2)) and len(ASKED) == 6
    assert kept and kept[0] <= 1  # of six: the one that is being written
    assert files(tmp_path / "pictures", 12) == [png(np.full((*SIZE[::-1], 3), n, np.uint8)) for n in range(12)]


def test_workers_are_told_where_the_run_is(run, tmp_path, monkeypatch):
    monkeypatch.setattr(dask_workers, "pictures", shades)
    monkeypatch.chdir(os.path.dirname(run))
    with cluster_of(1, tmp_path) as cluster:
        flight().make("run.py:run", "pictures", scheduler=cluster.scheduler_address)
    assert {asked for asked, _ in ASKED} == {run} and os.path.isabs(run)


def test_what_dask_says_is_an_error_of_ours(run, tmp_path, monkeypatch):
    monkeypatch.setattr(dask_workers, "pictures", failing)
    with cluster_of(1, tmp_path) as cluster:
        with pytest.raises(dspace.Io, match="RuntimeError: the card is gone"):
            flight().make(run, tmp_path / "pictures", scheduler=cluster.scheduler_address)


def test_the_whole_of_a_run_is_compared(tmp_path):
    """Also what is in the middle of a large file, in a recording's log, and in a module beside a program."""
    path = tmp_path / "run.dspace"
    data = bytearray(5 << 20)
    path.write_bytes(data)
    found = [dask_workers.fingerprint(str(path))]
    data[len(data) // 2] ^= 1
    path.write_bytes(data)
    found.append(dask_workers.fingerprint(str(path)))
    (tmp_path / "run.dspace-wal").write_bytes(b"more")
    found.append(dask_workers.fingerprint(str(path)))
    (tmp_path / "run.py").write_text("1\n")
    found.append(dask_workers.fingerprint(f"{tmp_path}/run.py:run"))
    (tmp_path / "model.py").write_text("2\n")
    found.append(dask_workers.fingerprint(f"{tmp_path}/run.py:run"))
    assert len(set(found)) == 5
    assert dask_workers.fingerprint(f"{tmp_path}/run.py:run") == found[-1]
