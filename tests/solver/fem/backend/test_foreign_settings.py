"""Homes and folders in which dolfinx and FFCx find no options file that they could read, or one that is broken."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.support.checkout import PYTHONPATH
from tests.support.running.fresh_process import FORM

BROKEN = "{ not finished"
FILES = ("dolfinx/dolfinx_jit_{}.json", "ffcx/ffcx_{}.json")
HOMELESS = "import pwd\ndef unknown(number): raise KeyError(number)\npwd.getpwuid = unknown\n"


def compiled(folder: Path, program: str = FORM, **environment: str) -> subprocess.CompletedProcess[str]:
    """A program that compiles a form in an empty cache, started in a folder; an empty value takes a variable away."""
    wanted = {**os.environ, "PYTHONPATH": PYTHONPATH, "XDG_CACHE_HOME": str(folder / "cache"), "XDG_CONFIG_HOME": "",
              **environment}
    variables = {name: value for name, value in wanted.items() if value}
    command = [sys.executable, "-c", program]
    return subprocess.run(command, cwd=folder, env=variables, capture_output=True, text=True, timeout=120, check=False)


def test_home_that_is_no_folder(tmp_path: Path) -> None:
    """HOME=/dev/null, as service users have it: ~/.config below it cannot be opened, which is no reason to fail."""
    done = compiled(tmp_path, HOME="/dev/null")
    assert (done.returncode, done.stderr) == (0, "")


def test_user_without_a_home(tmp_path: Path) -> None:
    """No HOME, and a user number that the system's list has not, as in a container: dolfinx asks for a home when it is
    imported."""
    done = compiled(tmp_path, HOMELESS + FORM, HOME="")
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.parametrize("place", ["home", "folder"])
def test_broken_files_of_options(place: str, tmp_path: Path) -> None:
    """Files under all names that a version reads, in ~/.config or in the current folder, which no parser could read;
    and a setup.cfg of somebody's project that asks for another compiler."""
    home, here = tmp_path / "home", tmp_path / "here"
    for folder in (home / ".config/dolfinx", home / ".config/ffcx", here):
        folder.mkdir(parents=True)
    for kind in ("parameters", "options"):
        for name in (each.format(kind) for each in FILES):
            path = home / ".config" / name if place == "home" else here / Path(name).name
            path.write_text(BROKEN, encoding="utf-8")
    compilers = home / ".pydistutils.cfg" if place == "home" else here / "setup.cfg"
    compilers.write_text("[build_ext]\ncompiler = none\n", encoding="utf-8")
    done = compiled(here, HOME=str(home))
    assert (done.returncode, done.stderr) == (0, "")


def test_other_programs_in_this_process_read_their_files(tmp_path: Path) -> None:
    """After a form of ours is compiled, dolfinx in the same process reads the user's options for the user's own."""
    (tmp_path / "dolfinx_jit_parameters.json").write_text('{"timeout": 77}', encoding="utf-8")
    (tmp_path / "dolfinx_jit_options.json").write_text('{"timeout": 77}', encoding="utf-8")
    after = "import dolfinx.jit as jit\n"
    after += "print(getattr(jit, 'get_options', getattr(jit, 'get_parameters', None))()['timeout'])"
    done = compiled(tmp_path, FORM + after)
    assert done.stdout == "77\n", done.stderr
