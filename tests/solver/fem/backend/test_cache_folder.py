"""Where compiled forms and matplotlib's list of fonts are kept, for users with and without a home."""

from __future__ import annotations

import os
import stat
from pathlib import Path

import pytest

from tests.support.running.fresh_process import FORM, NOWHERE, python


def left_in(folder: Path) -> list[Path]:
    """But for Open MPI's own, which version 5 does not remove."""
    return [path for path in folder.iterdir() if not path.name.startswith("ompi.")]


def test_forms_are_kept_without_a_writable_home(tmp_path: Path) -> None:
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
def test_cache_folder_of_another_user_is_not_used(how: str, tmp_path: Path) -> None:
    """The folder below the temporary one may be written by others, is a link, or belongs to another user, who could
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


def test_no_writable_cache_folder_is_an_error() -> None:
    """Neither a home nor a temporary folder can be written: what was wanted and what to do, in one line."""
    program = "import tempfile; tempfile.tempdir = '/proc/nowhere'\n" + FORM
    done = python(program, XDG_CACHE_HOME="", HOME=NOWHERE)
    assert done.returncode == 1
    last = done.stderr.splitlines()[-1]
    assert "CacheError: /proc/nowhere: wanted a folder for compiled forms" in last and "XDG_CACHE_HOME" in last


def test_font_list_is_kept_without_a_writable_home(tmp_path: Path) -> None:
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
