"""DspaceQt as a program: OpenGL that is too old, settings that are damaged, two programs on one recording, options."""
import json
import os
import pathlib
import subprocess
import sys

import pytest

import dspace
from needs import lacks, needs_program

SOURCES = pathlib.Path(__file__).resolve().parents[3]
DISPLAY = SOURCES / "Testing" / "Tools" / "with_display"


def find_program():
    """bin/DspaceQt of the build tree that the package is in."""
    for folder in pathlib.Path(os.path.abspath(dspace.__file__)).parents:
        if (folder / "bin" / "DspaceQt").exists():
            return folder / "bin" / "DspaceQt"
    return lacks("qt6-base-dev")


def start(*arguments, home, timeout=120, **environment):
    """Runs DspaceQt on a display of its own, with settings in a folder of its own."""
    return subprocess.run([str(DISPLAY), str(find_program()), *map(str, arguments)], capture_output=True, text=True,
                          timeout=timeout, env={**os.environ, "HOME": str(home), "XDG_CONFIG_HOME": str(home / "config"),
                                                "XDG_DATA_HOME": str(home / "data"), **environment})


def settings_of(home):
    return home / "config" / "Dspace" / "DspaceQt" / "settings.json"


def test_opengl_that_is_too_old_is_said_with_the_remedy(tmp_path):
    # The dialog waits for the user: it is seen by its text on the screen's window, and by the terminal.
    script = tmp_path / "ask"
    script.write_text("""#!/bin/sh
"$1" --empty >"$2" 2>&1 &
program=$!
for i in $(seq 100); do
  window=$(xdotool search --onlyvisible --pid $program 2>/dev/null | head -1)
  [ -n "$window" ] && break
  sleep 0.2
done
xdotool getwindowname "$window" >>"$2"
xdotool key --window "$window" Escape
for i in $(seq 50); do kill -0 $program 2>/dev/null || break; sleep 0.1; done
kill $program 2>/dev/null && echo "the dialog stayed" >>"$2"
wait $program
echo "code $?" >>"$2"
""")
    script.chmod(0o755)
    needs_program("xdotool", "xdotool")
    said = tmp_path / "said"
    subprocess.run([str(DISPLAY), str(script), str(find_program()), str(said)], timeout=120, check=True,
                   env={**os.environ, "HOME": str(tmp_path), "XDG_CONFIG_HOME": str(tmp_path),
                        "MESA_GL_VERSION_OVERRIDE": "4.1"})
    text = said.read_text()
    assert "4.5 or later" in text and "LIBGL_ALWAYS_SOFTWARE" in text, text
    assert "DspaceQt\n" in text and "stayed" not in text and "code 1" in text, text
    # Nobody would close it while pictures are made.
    done = subprocess.run([str(DISPLAY), str(find_program()), "--screenshot", str(tmp_path / "x.png"), "--empty"], timeout=60,
                          capture_output=True, text=True, env={**os.environ, "HOME": str(tmp_path), "XDG_CONFIG_HOME": str(tmp_path),
                                                               "MESA_GL_VERSION_OVERRIDE": "4.1"})
    assert done.returncode == 1 and "4.5 or later" in done.stderr and not (tmp_path / "x.png").exists()


def test_damaged_settings_give_defaults_and_a_picture(tmp_path):
    settings = settings_of(tmp_path)
    settings.parent.mkdir(parents=True)
    for text in ('{"version": 1, "sha', "\0" * 100, json.dumps({"version": 1, "sha256": "0", "settings": {"preferences": 1}})):
        settings.write_text(text)
        done = start("--empty", "--screenshot", tmp_path / "window.png", home=tmp_path)
        assert done.returncode == 0, done.stderr
        assert (tmp_path / "window.png").stat().st_size > 1000
        assert settings.read_text() == text  # a picture saves no settings


def test_two_programs_show_one_recording_that_grows(tmp_path):
    path = tmp_path / "run.dspace"
    with dspace.Session() as session:
        with session.record(path):
            scene = session.scene()
            scene.add_box((1, 1, 1))
            scene.add_viewport((64, 48), scene.add_camera(eye=(3, 3, 3), target=(0, 0, 0)), name="recorded")
            for i in range(1, 6):
                scene.time = float(i)
            # While it is written, two programs at once.
            programs = [subprocess.Popen([str(DISPLAY), str(find_program()), "--screenshot", str(tmp_path / f"{i}.png"),
                                          str(path)], stderr=subprocess.PIPE, text=True,
                                         env={**os.environ, "HOME": str(tmp_path / str(i))}) for i in range(2)]
            for i in range(6, 60):
                scene.time = float(i)
            for program in programs:
                _, said = program.communicate(timeout=180)
                assert program.returncode == 0, said
    assert (tmp_path / "0.png").stat().st_size > 1000 and (tmp_path / "1.png").stat().st_size > 1000
    with dspace.Playback(path) as playback:
        assert playback.times[-1] == 59.0  # nothing of it was lost


def test_a_layout_that_is_not_there_is_said(tmp_path):
    done = start("--empty", "--layout", "nothing", "--screenshot", tmp_path / "window.png", home=tmp_path)
    assert done.returncode == 1
    assert "there is no such layout" in done.stderr


if __name__ == "__main__":
    sys.exit(pytest.main([__file__]))
