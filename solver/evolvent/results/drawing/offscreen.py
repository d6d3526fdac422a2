"""Off-screen rendering on machines without a display: pyvista needs an OpenGL window.

VTK's wheels (Debian 12) provide a window without an X server (EGL). The VTK package of Debian 13 renders through X only
and gets a virtual X server while it renders. An existing display is not used, so that pictures do not depend on it.
"""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager

from vtkmodules import vtkRenderingOpenGL2

SCREEN = "1920x1440x24"
"""Width, height [pixels] and colour depth [bits] of the virtual screen."""


@contextmanager
def off_screen() -> Iterator[None]:
    """Context in which pyvista can render. Raises RuntimeError where it cannot, with the remedy."""
    if hasattr(vtkRenderingOpenGL2, "vtkEGLRenderWindow"):
        with _environment("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow"):
            yield
    else:
        with _virtual_server() as display, _environment("DISPLAY", display):
            yield


@contextmanager
def _environment(name: str, value: str) -> Iterator[None]:
    """Context with this value of an environment variable."""
    before = os.environ.get(name)
    os.environ[name] = value
    try:
        yield
    finally:
        if before is None:
            del os.environ[name]
        else:
            os.environ[name] = before


@contextmanager
def _virtual_server() -> Iterator[str]:
    """Context with a virtual X server; yields its display, such as ":1".

    The server must not reset when its last window closes (`-noreset`): VTK aborts the process if it requests the next
    window during a reset.
    """
    if shutil.which("Xvfb") is None:
        raise RuntimeError("pictures: wanted the virtual X server Xvfb, found none; install it: apt-get install xvfb")
    read, write = os.pipe()
    command = ["Xvfb", "-displayfd", str(write), "-screen", "0", SCREEN, "-nolisten", "tcp", "-noreset"]
    try:
        server = subprocess.Popen(command, pass_fds=[write], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    finally:
        os.close(write)
    try:
        with open(read) as answer:
            number = answer.readline().strip()  # empty if the server failed to start
        if not number:
            raise RuntimeError("pictures: Xvfb did not start; run `Xvfb :99` to see why")
        yield f":{number}"
    finally:
        server.terminate()
        server.wait()
