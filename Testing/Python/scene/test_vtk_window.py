"""Viewports beside a window of VTK's own on X11, which draws by GLX, in one thread."""
import contextlib
import os
import subprocess
import sys

import pytest

from needs import needs_program

CODE = """
import sys
import vtkmodules.vtkRenderingOpenGL2
from vtkmodules.vtkRenderingCore import vtkRenderer, vtkRenderWindow, vtkWindowToImageFilter
from vtkmodules.util.numpy_support import vtk_to_numpy
import dspace

def red(values):
    return bool((values[..., 0] > 100).any())

with dspace.Session() as session:
    scene = session.scene()
    scene.add_box((1, 1, 1), color="red", lit=False)
    scene.add_camera(eye=(3, 3, 3), target=(0, 0, 0))
    window, renderer, view = None, None, None
    for turn in sys.argv[1]:
        if turn == "d":
            view = view or scene.add_viewport((60, 40))
            print("dspace", red(view.image()), view.pick(30, 20) is not None)
            continue
        if window is None:
            renderer, window = vtkRenderer(), vtkRenderWindow()
            window.AddRenderer(renderer)
            window.SetSize(60, 40)
            scene.to_vtk(renderer)
            renderer.ResetCamera()
        window.Render()
        pixels = vtkWindowToImageFilter()
        pixels.SetInput(window)
        pixels.Update()
        data = vtk_to_numpy(pixels.GetOutput().GetPointData().GetScalars())
        print("window", window.GetClassName(), red(data))
"""


@contextlib.contextmanager
def display():
    """An X server of its own; its DISPLAY."""
    reading, writing = os.pipe()
    server = subprocess.Popen(["Xvfb", "-displayfd", str(writing), "-screen", "0", "640x480x24", "-nolisten", "tcp"],
                              pass_fds=[writing], stderr=subprocess.DEVNULL)
    os.close(writing)
    try:
        with os.fdopen(reading) as number:
            yield ":" + number.readline().strip()
    finally:
        server.terminate()
        server.wait()


@pytest.mark.parametrize("turns", ["dwdw", "wdwd"])
def test_viewports_and_a_window_take_turns(turns):
    needs_program("Xvfb", "xvfb")
    with display() as name:
        done = subprocess.run([sys.executable, "-c", CODE, turns], env={**os.environ, "DISPLAY": name},
                              capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    expected = {"d": "dspace True True", "w": "window vtkXOpenGLRenderWindow True"}
    assert done.stdout.split("\n")[:-1] == [expected[turn] for turn in turns]
