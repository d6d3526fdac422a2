"""Pictures on a machine without a screen."""

from __future__ import annotations

import os
import shutil
import socket
import struct
import subprocess
import sys
import time

import pytest

from evolvent.results.drawing import offscreen
from evolvent.results.drawing.offscreen import off_screen

PROGRAM = """
from evolvent.results.drawing.offscreen import off_screen
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


def test_two_pictures_without_a_display_print_nothing() -> None:
    """An unlit red sphere on white is red in the middle and white in the corner; the next, blue; nothing on stderr."""
    bare = {name: value for name, value in os.environ.items() if name not in ("DISPLAY", "WAYLAND_DISPLAY")}
    run = subprocess.run(
        [sys.executable, "-c", PROGRAM], env=bare, capture_output=True, text=True, timeout=120, check=False
    )
    assert run.returncode == 0, run.stderr
    assert run.stdout.splitlines() == ["(100, 120) 255 0 0 255 255 255", "(100, 120) 0 0 255 255 255 255"]
    assert run.stderr == ""


@pytest.mark.skipif(shutil.which("Xvfb") is None, reason="no virtual X server is installed")
def test_virtual_server_keeps_running_without_windows(monkeypatch: pytest.MonkeyPatch) -> None:
    """Problem: a VTK that draws through X only; a program that connects, names an atom and leaves, then another one.
    Exact: the atom is still known. A server that starts anew when nobody is connected has forgotten it; VTK, which asks
    for its next window meanwhile, aborts the process."""
    monkeypatch.delattr(offscreen.vtkRenderingOpenGL2, "vtkEGLRenderWindow", raising=False)
    with off_screen():
        path = f"/tmp/.X11-unix/X{os.environ['DISPLAY'].removeprefix(':')}"
        assert _atom(path, only_if_exists=False) > 0
        time.sleep(1.0)  # a server that starts anew takes less
        assert _atom(path, only_if_exists=True) > 0


def _atom(path: str, only_if_exists: bool) -> int:
    """The number of the atom EVOLVENT at an X server, 0 where there is none (X Window System Protocol, InternAtom)."""
    name = b"EVOLVENT"
    with socket.socket(socket.AF_UNIX, socket.SOCK_STREAM) as server, server.makefile("rb") as answer:
        server.connect(path)
        server.sendall(struct.pack("<BxHHHHxx", ord("l"), 11, 0, 0, 0))
        accepted, words = struct.unpack("<B5xH", answer.read(8))
        assert accepted == 1
        answer.read(4 * words)
        server.sendall(struct.pack("<BBHHxx", 16, only_if_exists, 2 + len(name) // 4, len(name)) + name)
        return int(struct.unpack("<8xI20x", answer.read(32))[0])
