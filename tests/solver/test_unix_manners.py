"""The command line among other programs of Unix: its output's reader leaves, it is interrupted at once, its words are
no UTF-8, its disk is full."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path
from subprocess import PIPE
from typing import IO

import pytest

from evolvent.commands.app import main
from evolvent.commands.exit import Exit, flushed
from tests.support.checkout import PYTHONPATH, ROOT
from tests.support.running.fresh_process import NOWHERE
from tests.support.scene_texts import HE

EVOLVENT = (sys.executable, "-m", "evolvent")


Done = subprocess.CompletedProcess[str]


def ran(
    *words: str | bytes, stdout: int | IO[bytes] = PIPE, stderr: int | IO[bytes] = PIPE, **variables: str
) -> Done:
    """A program run in the checkout, with some variables; its output has a buffer, as a user's."""
    fixed = {"PYTHONPATH": PYTHONPATH, "OMP_NUM_THREADS": "1", "PYTHONUNBUFFERED": ""}
    environment = {**os.environ, **fixed, **variables}
    return subprocess.run(
        words, cwd=ROOT, env=environment, stdout=stdout, stderr=stderr, text=True, timeout=300, check=False
    )


def unread(*words: str, errors: bool = False) -> Done:
    """A command whose output nobody reads, from the first byte on; with `errors` its standard error neither."""
    reader, writer = os.pipe()
    os.close(reader)
    try:
        return ran(*EVOLVENT, *words, stdout=writer, stderr=writer if errors else PIPE)
    finally:
        os.close(writer)


@pytest.mark.parametrize(
    ("words", "errors"),
    [
        (("--help",), False),
        (("--version",), False),
        (("check", "demos/he2022.toml"), False),
        (("info",), False),
        (("check", "nowhere.toml"), True),
        (("walk",), True),
    ],
)
def test_output_that_nobody_reads(words: tuple[str, ...], errors: bool) -> None:
    """As after `| head`: the status of a program that SIGPIPE ends, and not a word."""
    done = unread(*words, errors=errors)
    assert done.returncode == 128 + signal.SIGPIPE
    assert not done.stderr


def test_run_that_nobody_reads(tmp_path: Path) -> None:
    """The first warning of a run meets a closed pipe: it ends quietly, and its log says why."""
    settings = ("--set=sweep.positions=2", "--set=output.error_bars=false", "--set=output.pictures=false")
    out = tmp_path / "out"
    done = unread("run", "demos/he2022.toml", "--level=quick", "--out", str(out), *settings, errors=True)
    assert done.returncode == 128 + signal.SIGPIPE
    assert "failed: [Errno 32] Broken pipe" in (out / "run.log").read_text(encoding="utf-8")


@pytest.mark.parametrize("words", [("check", "demos/he2022.toml"), ("--version",)], ids=" ".join)
def test_output_that_cannot_be_written(words: tuple[str, ...]) -> None:
    """A full disk behind the standard output: one line, status 1."""
    with open("/dev/full", "wb") as full:
        done = ran(*EVOLVENT, *words, stdout=full)
    assert (done.returncode, done.stderr) == (1, "evolvent: [Errno 28] No space left on device\n")


def test_printed_text_that_was_not_flushed() -> None:
    """A library's line that is written at the program's end only: the status says that it was not, without a complaint
    of Python's; a status of its own stays where all is written."""
    program = "import sys; from evolvent.commands.exit import flushed; print('line'); sys.exit(flushed(0))"
    with open("/dev/full", "wb") as full:
        done = ran(sys.executable, "-c", program, stdout=full)
    assert (done.returncode, done.stderr) == (1, "")
    assert flushed(Exit.BAD_INPUT) == Exit.BAD_INPUT


SLOW_IMPORT = """
import os, signal, sys
{first}
class Slow:
    def find_spec(self, name, path=None, target=None):
        if name == {at!r}:
            try:
                signal.raise_signal(signal.SIGINT)
            except BaseException:
                raise ImportError("numpy.core.multiarray failed to import")
sys.meta_path.insert(0, Slow())
sys.argv[0] = "evolvent"
from evolvent.__main__ import main
sys.exit(main())
"""


HEARD = "signal.signal(signal.SIGINT, signal.default_int_handler)"
"""These tests may run where SIGINT is ignored."""


@pytest.mark.parametrize("at", ["evolvent.commands.app", "typer", "numpy"])
def test_interrupted_before_it_began(at: str) -> None:
    """SIGINT while modules are imported, of which one turns every exception into another: one line, status 130. No
    command has been looked at by then."""
    program = SLOW_IMPORT.format(at=at, first=HEARD)
    done = ran(sys.executable, "-c", program, "run", "demos/he2022.toml", "--out", NOWHERE)
    assert (done.returncode, done.stdout) == (130, "")
    assert done.stderr == "evolvent: stopped by SIGINT before it began\n"


def test_interrupt_that_is_ignored_stays_so() -> None:
    """In the background of a script, or under nohup, SIGINT is ignored: the command is not stopped by it."""
    ignoring = ("sh", "-c", "trap '' INT; exec \"$@\"", "sh")
    done = ran(*ignoring, sys.executable, "-c", SLOW_IMPORT.format(at="typer", first=""), "--version")
    assert (done.returncode, done.stderr) == (0, "")


def test_the_installed_program_is_the_interruptible_one() -> None:
    """`evolvent` of the package's list of programs."""
    assert 'evolvent = "evolvent.__main__:main"' in (ROOT / "pyproject.toml").read_text(encoding="utf-8")


LATIN = b"gr\xf6\xdfe"


@pytest.mark.parametrize("command", ["check", "mesh", "run"])
def test_names_that_are_no_utf8(command: str, tmp_path: Path) -> None:
    """A folder named in Latin-1, as the place of the scene and of what is written."""
    folder = os.path.join(os.fsencode(tmp_path), LATIN)
    os.mkdir(folder)
    scene = os.path.join(folder, b"s.toml")
    with open(scene, "w", encoding="utf-8") as stream:
        stream.write(HE)
    cheap = [b"--level", b"quick", b"--set=sweep.positions=2", b"--set=output.error_bars=false"]
    words = {
        "check": [scene, b"--out", os.path.join(folder, b"form.png")],
        "mesh": [scene, b"--out", os.path.join(folder, b"m.msh"), b"--level", b"quick"],
        "run": [scene, b"--out", os.path.join(folder, b"out"), b"--set=output.pictures=false", *cheap],
    }[command]
    done = ran(*EVOLVENT, command, *words)
    assert done.returncode == 0, done.stderr
    assert "Traceback" not in done.stderr


def test_check_needs_no_mpi() -> None:
    """`check` in a process of its own starts no MPI, so that a temporary folder that cannot be written is none of its
    business; a command that computes says so in one line, with status 2."""
    started = "import sys; from evolvent.commands.app import main; main(sys.argv[1:])"
    program = f"{started}; assert 'mpi4py.MPI' not in sys.modules"
    for start in ((sys.executable, "-c", program), EVOLVENT):
        done = ran(*start, "check", "demos/he2022.toml", TMPDIR=NOWHERE)
        assert (done.returncode, done.stderr) == (0, "")
    done = ran(*EVOLVENT, "run", "demos/he2022.toml", "--out", NOWHERE, TMPDIR=NOWHERE)
    assert done.returncode == 2 and len(done.stderr.splitlines()) == 1
    assert done.stderr.startswith(f"evolvent: TMPDIR: found {NOWHERE}, where MPI cannot keep its files")


def test_command_line_in_this_process(capsys: pytest.CaptureFixture[str]) -> None:
    """`main` may be called by a program, whose handlers of signals stay as they are."""
    before = signal.getsignal(signal.SIGINT)
    assert main(["--version"]) == Exit.DONE
    assert signal.getsignal(signal.SIGINT) is before
    assert capsys.readouterr().out
