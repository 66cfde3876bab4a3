"""The files of a run: a recording, or a program and a function of it."""
import os

from dspace.errors import Error


def file_of(run):
    """Returns the file of a run, and the function's name if the run is FILE.py:NAME, "" otherwise."""
    script, _, function = run.rpartition(":")
    return (script, function) if script.endswith(".py") and function.isidentifier() else (run, "")


def absolute(run):
    """Returns the run with an absolute path, for a process in another folder."""
    file, function = file_of(os.fspath(run))
    return os.path.abspath(file) + (f":{function}" if function else "")


def files_of(run):
    """Returns the files that a run consists of: a recording and its SQLite log, or a program and the modules and
    packages in its folder."""
    file, function = file_of(run)
    if not function:
        log = file + "-wal"
        return [file] + ([log] if os.path.exists(log) and os.path.getsize(log) else [])
    folder, found = os.path.dirname(os.path.abspath(file)), []
    for at, folders, names in os.walk(folder):
        folders[:] = sorted(each for each in folders if os.path.exists(os.path.join(at, each, "__init__.py")))
        found += [os.path.join(at, name) for name in sorted(names) if name.endswith(".py")]
    return found


def assets_of(run):
    """Returns the paths of the files that a recording's commands name."""
    file, function = file_of(run)
    if function:
        return []
    from dspace.recording.file import RecordingFile
    try:
        with RecordingFile(file) as recording:
            return sorted(asset.path for asset in recording.assets)
    except Error:  # not a recording, or damaged; opening it to draw reports the error
        return []


def states_of(paths):
    """Returns [path, size, time of the last change] of each file. Each write to a file changes them."""
    out = []
    for path in paths:
        try:
            status = os.stat(path)
            out.append([path, status.st_size, status.st_mtime_ns])
        except OSError:
            out.append([path, None, None])
    return out
