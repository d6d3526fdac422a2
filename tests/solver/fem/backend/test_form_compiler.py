"""Compiled forms: kept where they are found again, and compiled without a word; an application's logging is its own.

Each test is a process of its own with an empty cache, for what is imported or compiled once is so for good.
"""

from __future__ import annotations

import logging
import os
import stat
import subprocess
import sys
from pathlib import Path

import pytest

from evolvent.fem.backend.form_compiler import logging_kept
from tests.support.checkout import PYTHONPATH

NOWHERE = "/proc/nowhere"  # a home that nobody can write to, not even root
FORM = """
import numpy as np, ufl
from evolvent.fem.backend import dolfinx_compat
points = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
mesh = dolfinx_compat.create_mesh(points, np.array([[0, 1, 2]]), "triangle", 1)
space = dolfinx_compat.vector_space(mesh, 1)
volume = dolfinx_compat.assemble_number(1.0 * ufl.dx(domain=mesh))
assert abs(volume - 0.5) < 1e-14
"""


def python(program: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """A program of its own; an empty value takes the variable away."""
    wanted = {**os.environ, "PYTHONPATH": PYTHONPATH, "OMP_NUM_THREADS": "1", **environment}
    clean = {name: value for name, value in wanted.items() if value}
    command = [sys.executable, "-c", program]
    return subprocess.run(command, env=clean, capture_output=True, text=True, timeout=120, check=False)


def test_compiles_without_a_word(tmp_path: Path) -> None:
    """The integral of 1 over half a unit square is compiled in an empty cache: nothing on either stream, and the root
    logger as it was."""
    after = "import logging; root = logging.getLogger(); assert (root.handlers, root.level) == ([], 30), root.handlers"
    done = python(FORM + after, XDG_CACHE_HOME=str(tmp_path))
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert list(tmp_path.glob("evolvent/dolfinx-*/*.so"))


@pytest.mark.parametrize("first", ["", "import dolfinx\n", "import evolvent.contact.solution.solver\n"])
@pytest.mark.parametrize("before", [True, False])
def test_an_application_logs_as_it_likes(before: bool, first: str, tmp_path: Path) -> None:
    """An application that asks for messages from INFO on, before or after the solver is imported, gets its own before
    and after a form is compiled, and nothing of the compiler's; only where it imports dolfinx first, whose handler
    comes before its own, its basicConfig is without effect, with and without us."""
    own = "import logging; logging.basicConfig(level=logging.INFO, format='%(message)s')\n"
    one, two = "logging.getLogger('mine').info('one')\n", "\nlogging.info('two')"
    done = python((own + first if before else first + own) + one + FORM + two, XDG_CACHE_HOME=str(tmp_path))
    assert done.returncode == 0, done.stderr
    if before or "dolfinx" not in first:
        assert done.stderr.split() == ["one", "two"]
    assert "gcc" not in done.stderr + done.stdout and "build" not in done.stderr + done.stdout


@pytest.mark.parametrize("first", ["", "import ffcx\n"])
def test_warnings_are_shown(first: str, tmp_path: Path) -> None:
    """A program that has not set up any logging, and one that has imported FFCx before: its own warning and the
    solver's stand on the standard error."""
    words = """import warnings; warnings.warn('own')
from evolvent.contact.problem.user_warnings import warn_user; warn_user('ours', UserWarning)
"""
    done = python(first + FORM + words, XDG_CACHE_HOME=str(tmp_path))
    assert "UserWarning: own" in done.stderr
    assert "UserWarning: ours" in done.stderr


def test_an_application_logs_its_warnings(tmp_path: Path) -> None:
    """One that has asked for its warnings in its log has them there."""
    own = "import logging; logging.basicConfig(format='log: %(message).30s'); logging.captureWarnings(True)\n"
    done = python(own + FORM + "\nimport warnings; warnings.warn('own')", XDG_CACHE_HOME=str(tmp_path))
    assert done.stderr.startswith("log: <string>")


def test_the_root_logger_is_kept_through_failures() -> None:
    """A compilation that fails after it has exchanged the handlers, as FFCx 0.9's may: level and handlers are those of
    before."""
    root = logging.getLogger()
    level, handlers = root.level, list(root.handlers)

    @logging_kept()
    def failing() -> None:
        root.handlers = [logging.NullHandler()]
        root.setLevel(1)
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        failing()
    assert (root.level, root.handlers) == (level, handlers)


def left_in(folder: Path) -> list[Path]:
    """But for Open MPI's own, which version 5 does not remove."""
    return [path for path in folder.iterdir() if not path.name.startswith("ompi.")]


def test_home_that_cannot_be_written(tmp_path: Path) -> None:
    """A second run finds what the first one compiled, in one folder of this user's below the temporary one that nobody
    else may read or write; nothing else is left there."""
    for _ in range(2):
        done = python(FORM, XDG_CACHE_HOME="", HOME=NOWHERE, TMPDIR=str(tmp_path))
        assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
        times = {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*.so")}
    (folder,) = left_in(tmp_path)
    assert folder.name == f"evolvent-{os.geteuid()}" and stat.S_IMODE(folder.stat().st_mode) == 0o700
    assert times
    python(FORM, XDG_CACHE_HOME="", HOME=NOWHERE, TMPDIR=str(tmp_path))
    assert {path: path.stat().st_mtime_ns for path in tmp_path.rglob("*.so")} == times


@pytest.mark.parametrize("how", ["writable", "link", "owned"])
def test_a_folder_of_others_is_not_used(how: str, tmp_path: Path) -> None:
    """The folder below the temporary one may be written by others, is a link, or belongs to somebody else, who could
    leave code there: nothing is put into it or loaded from it, one line says so, what was compiled is gone at the end.
    """
    folder, other = tmp_path / f"evolvent-{os.geteuid()}", tmp_path / "other"
    other.mkdir()
    if how == "link":
        folder.symlink_to(other)
    else:
        folder.mkdir()
        folder.chmod(0o777 if how == "writable" else 0o700)
    if how == "owned":
        if os.geteuid() != 0:
            pytest.skip("only root can give a folder away")
        os.chown(folder, 65534, 65534)
    done = python(FORM, XDG_CACHE_HOME="", HOME=NOWHERE, TMPDIR=str(tmp_path))
    assert done.returncode == 0, done.stderr
    assert f"{folder}: wanted a folder that only this user may write to" in done.stderr
    assert len(done.stderr.splitlines()) == 1
    assert not list(folder.iterdir()) and not list(other.iterdir())
    assert set(left_in(tmp_path)) == {folder, other}


def test_no_place_at_all() -> None:
    """Neither a home nor a temporary folder can be written: what was wanted and what to do, in one line."""
    program = "import tempfile; tempfile.tempdir = '/proc/nowhere'\n" + FORM
    done = python(program, XDG_CACHE_HOME="", HOME=NOWHERE)
    assert done.returncode == 1
    last = done.stderr.splitlines()[-1]
    assert "CacheError: /proc/nowhere: wanted a folder for compiled forms" in last and "XDG_CACHE_HOME" in last


def test_fonts_are_listed_once(tmp_path: Path) -> None:
    """Without a home matplotlib makes a list of fonts, and a folder for it, in every process, and says so: kept beside
    the forms, without a word; a folder that the user has named stays what it is."""
    program = """from evolvent.fem.backend.cache_folder import keep_fonts; keep_fonts()
import matplotlib; print(matplotlib.get_configdir())
"""
    bare = {"XDG_CACHE_HOME": "", "XDG_CONFIG_HOME": "", "HOME": NOWHERE, "TMPDIR": str(tmp_path)}
    done = python(program, **bare, MPLCONFIGDIR="")
    assert (done.stderr, done.stdout) == ("", f"{tmp_path}/evolvent-{os.geteuid()}/matplotlib\n")
    own = tmp_path / "own"
    own.mkdir()
    assert python(program, **bare, MPLCONFIGDIR=str(own)).stdout == f"{own}\n"


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can mount")
@pytest.mark.parametrize("size", ["8k", "40k", "80k"])
def test_full_disk(size: str, tmp_path: Path) -> None:
    """No room for the source, or for the library: the error names the folder, what is left and the remedy; with room
    again the same folder serves."""
    if os.system(f"mount -t tmpfs -o size={size} tmpfs {tmp_path} 2>/dev/null") != 0:
        pytest.skip("this container may not mount")
    try:
        done = python(FORM, XDG_CACHE_HOME=str(tmp_path))
        assert done.returncode == 1
        last = done.stderr.splitlines()[-1]
        assert f"CompileError: {tmp_path}/evolvent" in last
        assert "MB left on its disk" in last and "XDG_CACHE_HOME" in last
        assert os.system(f"mount -o remount,size=10m {tmp_path}") == 0
        assert python(FORM, XDG_CACHE_HOME=str(tmp_path)).returncode == 0
        assert not list(tmp_path.rglob("*.c.~*"))
    finally:
        os.system(f"umount {tmp_path}")


def test_no_compiler(tmp_path: Path) -> None:
    """A compiler that cannot be found is named, and where it comes from."""
    done = python(FORM, XDG_CACHE_HOME=str(tmp_path), CC="no-such-compiler")
    assert done.returncode == 1
    assert "no-such-compiler" in done.stderr.splitlines()[-1] and "packages/install" in done.stderr.splitlines()[-1]
