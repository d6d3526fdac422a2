"""Compilation of forms: silent, with a full disk, without a compiler; the logging of an application is unchanged.

Each test is a process of its own with an empty cache, for what is imported or compiled once is so for good.
"""

from __future__ import annotations

import errno
import logging
import os
from pathlib import Path

import pytest

from evolvent.fem.backend.dolfinx_compat import versions
from evolvent.fem.backend.form_compiler import CompileError, compiling, form_directory, logging_kept
from tests.support.running.fresh_process import FORM, python


def test_compilation_is_silent(tmp_path: Path) -> None:
    """The integral of 1 over half a unit square is compiled in an empty cache: nothing on either stream, and the root
    logger as it was."""
    after = "import logging; root = logging.getLogger(); assert (root.handlers, root.level) == ([], 30), root.handlers"
    done = python(FORM + after, XDG_CACHE_HOME=str(tmp_path))
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert list(tmp_path.glob("evolvent/dolfinx-*/*.so"))


@pytest.mark.parametrize("first", ["", "import dolfinx\n", "import evolvent.contact.solution.solver\n"])
@pytest.mark.parametrize("before", [True, False])
def test_logging_of_an_application_is_unchanged(before: bool, first: str, tmp_path: Path) -> None:
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


def test_warnings_captured_by_an_application_stay_captured(tmp_path: Path) -> None:
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


@pytest.mark.skipif(os.geteuid() != 0, reason="only root can mount")
@pytest.mark.parametrize("size", ["8k", "40k", "80k"])
def test_compilation_on_a_full_disk(size: str, tmp_path: Path) -> None:
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


def test_missing_compiler_is_named(tmp_path: Path) -> None:
    """A compiler that cannot be found is named, and where it comes from."""
    done = python(FORM, XDG_CACHE_HOME=str(tmp_path), CC="no-such-compiler")
    assert done.returncode == 1
    assert "no-such-compiler" in done.stderr.splitlines()[-1] and "packages/install" in done.stderr.splitlines()[-1]


@pytest.mark.parametrize(
    ("name", "options", "words"),
    [
        ("CFLAGS", "-O2 -nonsense=3", "unrecognized command-line option"),
        ("LDFLAGS", "-lnothing", "cannot find -lnothing"),
    ],
)
def test_options_that_the_compiler_refuses_are_named(name: str, options: str, words: str, tmp_path: Path) -> None:
    """There is a compiler, but not for these options: the variable, its value, the compiler's words, and no advice to
    install one."""
    done = python(FORM, XDG_CACHE_HOME=str(tmp_path), **{name: options})
    last = done.stderr.splitlines()[-1]
    assert done.returncode == 1
    assert f"{name}={options!r}" in last and words in last and f"unset {name}" in last
    assert "install" not in last


def test_an_error_elsewhere_is_not_blamed_on_the_cache_folder(tmp_path: Path) -> None:
    """A file that may not be read while a form is compiled, in another folder: its own error, without a cause that is
    none; in the cache folder: no right to write."""
    version = versions()["dolfinx"]
    directory = form_directory(version)
    for path, wanted in ((tmp_path / "other.json", PermissionError), (directory / "form.c", CompileError)):
        with pytest.raises(wanted) as caught, compiling(version):
            raise PermissionError(errno.EACCES, "Permission denied", str(path))
        assert ("no right to write" in str(caught.value)) == (wanted is CompileError)
