"""Signals that ask a process to end: one clean line, in run.log too, the state kept, and soon."""

from __future__ import annotations

import gc
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from evidence.robustness.faults import GLANCE, differs, run, started
from evolvent.run.stopping import Stopped, stoppable
from tests.support.checkout import ROOT

PLAIN = ("--set", "output.error_bars=false")


def output_of(process: subprocess.Popen[str], seconds: float) -> tuple[str, str]:
    """Stdout and stderr of a process that ends within so many seconds. Raises TimeoutExpired for one that does not, and
    kills it, or the test would wait for it."""
    try:
        return process.communicate(timeout=seconds)
    finally:
        process.kill()


def ask(out: Path, number: signal.Signals) -> subprocess.CompletedProcess[str]:
    """A run that is sent a signal once it has kept two positions."""
    with started(out, *PLAIN) as process:
        while process.poll() is None and not (out / "results" / "position_0001.npz").exists():
            time.sleep(GLANCE)
        process.send_signal(number)
        output, errors = output_of(process, 60.0)
    return subprocess.CompletedProcess(process.args, process.returncode, output, errors)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_signal_ends_a_run_that_can_be_resumed(number: signal.Signals, tmp_path: Path) -> None:
    """Status 1, one line that names the signal and how to go on, the same line in run.log, no table; resumed, the
    numbers are those of an undisturbed run within 1e-7."""
    out, whole = tmp_path / "out", tmp_path / "whole"
    done = ask(out, number)
    assert done.returncode == 1, done.stderr
    line = f"stopped by {number.name}; `evolvent run ... --resume` continues"
    said = [text for text in done.stderr.splitlines() if text.startswith("evolvent: ")]
    assert len([text for text in said if not text.startswith("evolvent: warning: ")]) == 1
    assert f"evolvent: {line}" in done.stderr
    assert "Traceback" not in done.stderr
    assert line in (out / "run.log").read_text(encoding="utf-8")
    assert not (out / "summary.json").exists()
    assert run(out, *PLAIN, "--resume").returncode == 0
    if number == signal.SIGTERM:
        assert run(whole, *PLAIN).returncode == 0
        assert differs(out, whole) < 1e-7


DEAF = """
#include <unistd.h>
void deaf(void) { (void)!write(1, "ready\\n", 6); for (;;) sleep(1); }
"""


def test_signal_ends_a_computation_outside_python(tmp_path: Path) -> None:
    """A main thread that never comes back to Python: the line is said at once, and the process ends all the same."""
    library = tmp_path / "deaf.so"
    compiler = ["gcc", "-shared", "-fPIC", "-x", "c", "-o", str(library), "-"]
    subprocess.run(compiler, input=DEAF, text=True, check=True)
    code = (
        "import ctypes, sys\nfrom evolvent.run.stopping import stoppable\n"
        "with stoppable('; go on later', lambda: print('ended', flush=True)):\n"
        f"    ctypes.CDLL({str(library)!r}).deaf()\n"
    )
    with subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=ROOT
    ) as process:
        assert process.stdout is not None and process.stdout.readline() == "ready\n"
        process.send_signal(signal.SIGTERM)
        output, errors = output_of(process, 30.0)
    assert process.returncode == 1
    assert output == "ended\n"
    assert errors == "evolvent: stopped by SIGTERM; go on later\n"


def test_signal_handlers_are_restored() -> None:
    """After the block, and after a signal in it, the process has the handlers that it had before."""
    before = [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)]
    with pytest.raises(Stopped, match="stopped by SIGHUP"), stoppable("", lambda: None):
        signal.raise_signal(signal.SIGHUP)
    assert [signal.getsignal(number) for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)] == before


class HalfBuilt:
    """A signal arrives while it is constructed; its destructor wants what the constructor did not come to set."""

    def __init__(self) -> None:
        signal.raise_signal(signal.SIGTERM)
        self.whole = True

    def __del__(self) -> None:
        assert self.whole


def test_what_a_signal_leaves_half_built_does_not_complain(monkeypatch: pytest.MonkeyPatch) -> None:
    """The destructor of a half-built object fails within the block, unheard; the hook for such failures is restored."""
    heard: list[object] = []
    hook = heard.append
    monkeypatch.setattr(sys, "unraisablehook", hook)
    with pytest.raises(Stopped), stoppable("", lambda: None):
        HalfBuilt()
    gc.collect()
    assert not heard
    assert sys.unraisablehook == hook
