"""Pictures on a machine without a screen."""

from __future__ import annotations

import os
import subprocess
import sys

PROGRAM = """
from solver.display import off_screen
import pyvista
with off_screen():
    for colour in ("red", "blue"):
        plotter = pyvista.Plotter(off_screen=True, window_size=(120, 100))
        plotter.background_color = "white"
        plotter.add_mesh(pyvista.Sphere(), color=colour, lighting=False)
        picture = plotter.screenshot(return_img=True)
        plotter.close()
        print(picture.shape[:2], *picture[50, 60, :3], *picture[2, 2, :3])
"""


def test_two_pictures_without_a_screen_and_without_a_word():
    """An unlit red sphere on white is red in the middle and white in the corner; the next, blue; nothing on stderr."""
    bare = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    run = subprocess.run(
        [sys.executable, "-c", PROGRAM], env=bare, capture_output=True, text=True, timeout=120, check=False
    )
    assert run.returncode == 0, run.stderr
    assert run.stdout.splitlines() == ["(100, 120) 255 0 0 255 255 255", "(100, 120) 0 0 255 255 255 255"]
    assert run.stderr == ""
