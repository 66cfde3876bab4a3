"""Makes the pieces of a batch in several processes."""
import importlib
import json
import os
import signal
import subprocess
import sys
import tempfile
import time as clock

from dspace.errors import Error, Io


def worker(kind, script, run, folder, numbers):
    """Starts a process that makes pieces of a Kind of batch, by the batch's text in the file `script`, into a folder; see
    main()."""
    output = tempfile.TemporaryFile()  # a file: the process would block on a pipe that is not read
    process = subprocess.Popen(
        [sys.executable, "-c", "from dspace.batches.processes import main; main()", kind.module, script, run,
         folder, str(os.getpid())],
        stdin=subprocess.PIPE, stdout=subprocess.DEVNULL, stderr=output,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))})
    process.output = output
    try:  # through a pipe: the list may be too long for an argument
        process.stdin.write(json.dumps(numbers).encode())
        process.stdin.close()
    except BrokenPipeError:  # it has ended; finish() reports why
        pass
    return process


def main():
    """Entry point of a worker process: python -c "..." MODULE SCRIPT RUN FOLDER PARENT. It reads the numbers of the pieces from
    the standard input as JSON."""
    module, script, run, folder, parent = sys.argv[1:]
    numbers = json.load(sys.stdin)

    def tell(left):
        if os.getppid() != int(parent):  # the parent has ended
            os.kill(os.getpid(), signal.SIGTERM)

    try:
        with open(script, encoding="utf-8") as file:
            words = file.read()
        importlib.import_module(module).draw_pieces(words, run, numbers, folder, tell)
    except (Error, OSError) as error:
        sys.exit(f"{error}")


def finish(process):
    """Waits for a worker. Raises dspace.Io with its last line of output if it failed."""
    process.wait()
    process.output.seek(0)
    message = process.output.read().decode(errors="replace").strip()
    process.output.close()
    if process.returncode != 0:
        words = message.splitlines()[-1] if message else "no message"
        raise Io(f"a process that drew pictures ended with {process.returncode}: {words}")


def share(run, missing, jobs, folder, tell):
    """Shares the pieces `missing` of a Folder among processes. Each makes consecutive pieces, because a run only moves
    forward."""
    edges = [len(missing) * k // jobs for k in range(jobs + 1)]
    processes = []
    try:
        for a, b in zip(edges, edges[1:]):
            processes.append(worker(folder.kind, folder.path(folder.kind.script), run, folder.folder, missing[a:b]))
        left = set(missing)
        while any(process.poll() is None for process in processes):
            if any(process.poll() for process in processes):
                break  # one has failed
            there = set(os.listdir(folder.folder))
            left = {number for number in left if folder.kind.last(number) not in there}
            tell(len(left))
            clock.sleep(0.2)
        for process in sorted(processes, key=lambda each: not each.poll()):  # those that failed first
            finish(process)
    finally:
        for process in processes:
            if process.poll() is None:
                process.kill()
                process.wait()
    tell(0)
