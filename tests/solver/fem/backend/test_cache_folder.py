"""Where compiled forms and matplotlib's list of fonts are kept, for users with and without a home."""

from __future__ import annotations

import os
import pickle
import shutil
import stat
import subprocess
from pathlib import Path

import pytest

from evolvent.fem.backend.cache_folder import foreign_access
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


def give_away(path: Path, how: str) -> None:
    """Lets other users have access to a file or folder: by its mode, or its owner. Only root can give one away."""
    if how == "mode":
        path.chmod(path.stat().st_mode | 0o022)
    elif os.geteuid() == 0:
        os.chown(path, 65534, 65534)
    else:
        pytest.skip("only root can give a file away")


EVIL = """
#include <fcntl.h>
__attribute__((constructor)) static void planted(void) {{ creat("{marker}", 0600); }}
"""


@pytest.fixture(scope="module")
def compiled_forms(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A cache in which the forms of FORM are compiled."""
    cache = tmp_path_factory.mktemp("compiled")
    assert python(FORM, XDG_CACHE_HOME=str(cache)).returncode == 0
    return cache


@pytest.mark.parametrize(
    ("place", "how"),
    [(place, how) for place in ("folder", "above", "file") for how in ("owner", "mode")],
)
def test_planted_forms_are_not_loaded(place: str, how: str, compiled_forms: Path, tmp_path: Path) -> None:
    """Libraries under the names of our forms in $XDG_CACHE_HOME, where another user owns or may write to the folder,
    one above it, or a library: their code does not run, one line says why, and the result is right."""
    cache, marker = tmp_path / "cache", tmp_path / "marker"
    shutil.copytree(compiled_forms, cache)
    libraries = sorted(cache.rglob("*.so"))
    assert libraries
    for library in libraries:
        command = ["gcc", "-shared", "-fPIC", "-x", "c", "-o", str(library), "-"]
        subprocess.run(command, input=EVIL.format(marker=marker), text=True, check=True)
    (folder,) = cache.glob("evolvent/dolfinx-*")
    folder.chmod(0o755)
    give_away({"folder": folder, "above": cache, "file": libraries[0]}[place], how)
    done = python(FORM, XDG_CACHE_HOME=str(cache), TMPDIR=str(tmp_path))
    assert (done.returncode, done.stdout) == (0, ""), done.stderr
    assert not marker.exists()
    assert len(done.stderr.splitlines()) == 1
    assert f"{folder}: wanted a folder that only this user may write to, found " in done.stderr
    assert ("belongs to user 65534" if how == "owner" else "other users may write to") in done.stderr


def test_own_cache_runs_what_is_in_it(compiled_forms: Path, tmp_path: Path) -> None:
    """The same libraries in a folder of this user's are loaded: without that the test above would show nothing."""
    cache, marker = tmp_path / "cache", tmp_path / "marker"
    shutil.copytree(compiled_forms, cache)
    for library in cache.rglob("*.so"):
        command = ["gcc", "-shared", "-fPIC", "-x", "c", "-o", str(library), "-"]
        subprocess.run(command, input=EVIL.format(marker=marker), text=True, check=True)
    python(FORM, XDG_CACHE_HOME=str(cache))
    assert marker.exists()


def test_files_of_a_folder_that_others_cannot_search_may_have_any_mode(tmp_path: Path) -> None:
    """With umask 002 the compiler makes libraries that the user's group may write to; in a folder of mode 0700 nobody
    reaches them."""
    folder = tmp_path / "forms"
    folder.mkdir(mode=0o700)
    (folder / "form.so").touch()
    (folder / "form.so").chmod(0o775)
    assert foreign_access(folder) == ""
    folder.chmod(0o755)
    assert foreign_access(folder) == "form.so in it, which other users may write to"


KEPT = """
from evolvent.dynamics.oscillator.compiled import compiled
import sys; sys.path.insert(0, {folder!r})
from summed import summed
print(compiled(summed)(3.0))
"""


@pytest.mark.parametrize("how", ["private", "mode", "owner"])
def test_planted_numba_code_is_not_loaded(how: str, tmp_path: Path) -> None:
    """Numba keeps its code in our cache folder, not in ~/.cache/numba; an index there that starts a program when it is
    read is read from a folder of this user's alone."""
    (tmp_path / "summed.py").write_text("def summed(x):\n    return x + 1.0\n")
    program, cache, marker = KEPT.format(folder=str(tmp_path)), tmp_path / "cache", tmp_path / "marker"
    variables = {"XDG_CACHE_HOME": str(cache), "TMPDIR": str(tmp_path), "NUMBA_CACHE_DIR": ""}
    assert python(program, **variables).stdout == "4.0\n"
    indices = sorted(cache.glob("evolvent/numba-*/**/*.nbi"))
    assert indices
    for index in indices:
        index.write_bytes(pickle.dumps(Planted(str(marker))))
    (folder,) = cache.glob("evolvent/numba-*")
    if how != "private":
        give_away(folder, how)
    done = python(program, **variables)
    assert marker.exists() == (how == "private")
    if how != "private":
        assert done.stdout == "4.0\n" and f"{folder}: wanted a folder that only this user may write to" in done.stderr


class Planted:
    """Makes a folder when it is unpickled."""

    def __init__(self, marker: str) -> None:
        self.marker = marker

    def __reduce__(self) -> tuple[object, tuple[str]]:
        return os.mkdir, (self.marker,)


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
