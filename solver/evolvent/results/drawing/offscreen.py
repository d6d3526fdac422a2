"""A place to draw on a machine without a screen: pyvista's off-screen pictures need an OpenGL window from somewhere.

VTK's wheels (Debian 12) bring one that needs no X server (EGL); Debian 13's own VTK draws through X only and gets a
virtual server for the time it draws. A screen that happens to be there is not used: pictures must not depend on it.
"""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager

from vtkmodules import vtkRenderingOpenGL2

SCREEN = "1920x1440x24"


@contextmanager
def off_screen() -> Iterator[None]:
    """pyvista's plotters work inside this block. Raises RuntimeError with the remedy where they cannot."""
    if hasattr(vtkRenderingOpenGL2, "vtkEGLRenderWindow"):
        with _environment("VTK_DEFAULT_OPENGL_WINDOW", "vtkEGLRenderWindow"):
            yield
    else:
        with _virtual_server() as display, _environment("DISPLAY", display):
            yield


@contextmanager
def _environment(name: str, value: str) -> Iterator[None]:
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
    """An X server without a screen; gives its display, for instance ":1".

    It must not start anew when a picture is done and no window is left (`-noreset`): VTK, asking for the next window
    meanwhile, would abort the process.
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
            number = answer.readline().strip()  # empty when the server ends without having started
        if not number:
            raise RuntimeError("pictures: Xvfb did not start; run `Xvfb :99` to see why")
        yield f":{number}"
    finally:
        server.terminate()
        server.wait()
