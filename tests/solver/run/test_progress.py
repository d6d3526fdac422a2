"""What a run shows of itself: its stages on a terminal and in a pipe, and where everything is in the end."""

from __future__ import annotations

import io
import json
import os
import pty
import re
import subprocess
import sys
from pathlib import Path

import pytest
from rich.console import Console

from evolvent.commands.app import main
from evolvent.run.output import whereabouts
from evolvent.run.progress import Progress
from tests.support.checkout import ROOT
from tests.support.gear_cases import spur_scene
from tests.support.running.processes import RunScript

STAGES = ("meshing", "condensing", "positions", "error bars", "tables and pictures")


def shown(progress: Progress) -> list[str]:
    """The bars as a terminal would show them now: description and counts, those that are complete with a tick."""
    stream = io.StringIO()
    Console(file=stream, width=120, force_terminal=False).print(progress._bars.make_tasks_table(progress._bars.tasks))
    return [
        " ".join(re.sub(r"[━╸╺\s]+|\d:\d\d:\d\d|-:--:--", " ", line).split()) for line in stream.getvalue().splitlines()
    ]


def terminal() -> Console:
    return Console(file=io.StringIO(), force_terminal=True, width=120)


def test_stage_that_continues_is_not_shown_complete() -> None:
    """Two positions were thought of, a third one follows: with two solved the bar shows 2 of 3, never 2 of 2; a stage
    that cannot be counted is complete when the next one begins."""
    with Progress(console=terminal()) as progress:
        progress.stage("condensing")
        assert "✓" not in shown(progress)[0]
        progress.stage("positions", 2)
        assert shown(progress)[0].startswith("✓ condensing")
        progress.advance(more=True)
        progress.advance(more=True)
        assert "2/3" in shown(progress)[1] and "✓" not in shown(progress)[1]
        progress.advance(more=False)
        progress.stage("error bars")
        assert "3/3" in shown(progress)[1] and "✓" in shown(progress)[1]
        assert "✓" not in shown(progress)[2]


def test_resumed_positions_count_as_done() -> None:
    """Three of four are there already: one more completes the stage."""
    with Progress(console=terminal()) as progress:
        progress.stage("positions", 4, done=3)
        assert "3/4" in shown(progress)[0]
        progress.advance()
        assert "4/4" in shown(progress)[0]


def test_progress_without_a_terminal_prints_lines() -> None:
    """A line a stage, and one for each tenth of its count; no control characters."""
    stream = io.StringIO()
    with Progress(console=Console(file=stream)) as progress:
        progress.stage("condensing")
        progress.stage("cycles", 1000)
        for done in (10, 20, 250, 1000):
            progress.reach(done)
    words = [line.split("s  ", 1)[1] for line in stream.getvalue().splitlines()]
    assert words == ["condensing", "cycles: 0 of 1000", "cycles: 250 of 1000", "cycles: 1000 of 1000"]
    assert re.fullmatch(r"[ -~\n]*", stream.getvalue())


def test_note_is_a_line_beside_the_stages() -> None:
    """On a terminal or not: once, the stages stay."""
    for is_terminal in (True, False):
        stream = io.StringIO()
        with Progress(console=Console(file=stream, force_terminal=is_terminal, width=100)) as progress:
            progress.stage("positions", 2)
            progress.note("nothing [is] left")
        assert stream.getvalue().count("nothing [is] left") == 1 and "positions" in stream.getvalue()


def test_hidden_progress_prints_nothing() -> None:
    """--quiet and ranks other than 0, on a terminal or not."""
    for is_terminal in (True, False):
        stream = io.StringIO()
        with Progress(hidden=True, console=Console(file=stream, force_terminal=is_terminal)) as progress:
            progress.stage("positions", 2)
            progress.note("nothing is left")
            progress.advance()
        assert stream.getvalue() == ""


def test_resumed_finished_run_says_that_nothing_is_left(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """--resume of a finished run: a line on stderr and in the log; none where its error bars are still computed."""
    said = "complete: nothing to compute, tables and pictures are written again"
    off = "sweep.positions=2", "output.pictures=false", "output.animation=false", "output.fields=false"
    command = ["run", "demos/he2022.toml", "--out", str(tmp_path), "--level", "quick"]
    command += [word for setting in off for word in ("--set", setting)]
    assert main([*command, "--set", "output.error_bars=false"]) == 0
    for expected in (False, True):  # the first one computes error bars
        before = (tmp_path / "run.log").read_text(encoding="utf-8")
        capsys.readouterr()
        assert main([*command, "--resume"]) == 0
        log = (tmp_path / "run.log").read_text(encoding="utf-8")
        assert log.removeprefix(before).count(said) == capsys.readouterr().err.count(said) == expected


def test_run_in_a_pipe_prints_its_stages(run_script: RunScript, tmp_path: Path) -> None:
    """He's pair at two positions: every stage once and in order on stderr, plainly; on stdout the figures, and last
    a line that names tables, pictures and figures that are there. With --quiet nothing but warnings."""
    out = tmp_path / "out"
    scene = "demos/he2022.toml", "--level", "quick", "--set", "sweep.positions=2", "--set", "output.animation=false"
    done = run_script("solver/evolvent/__main__.py", "run", *scene, "--out", str(out))
    assert done.returncode == 0, done.stderr
    lines = done.stderr.split("\n")
    plain = [line for line in lines if not line.startswith("evolvent: warning: ")]  # these have Greek letters
    assert all(re.fullmatch(r"[ -~]*", line) for line in plain) and all(line.isprintable() for line in lines)
    begun = [
        stage
        for line in done.stderr.splitlines()
        for stage in STAGES
        if line.endswith(f"s  {stage}") or ("0 of" in line and stage in line)
    ]
    assert begun == list(STAGES)
    figures, line = done.stdout.splitlines()
    assert re.match(r"μ = 0: largest pressure \d+ ± \d+ MPa, transmission error [\d.]+ ± [\d.]+ µm", figures)
    named = [Path(word.rstrip(",;")) for word in line.split() if str(out) in word]
    assert {path.relative_to(out).parts[0] for path in named} >= {"summary.json", "positions.csv", "pictures"}
    assert all(path.exists() for path in named)
    again = run_script(
        "solver/evolvent/__main__.py",
        "run",
        *scene,
        "--set",
        "output.pictures=false",
        "--quiet",
        "--out",
        str(tmp_path / "quiet"),
    )
    assert (again.returncode, again.stdout) == (0, "")
    assert all(line.startswith("evolvent: warning: ") for line in again.stderr.splitlines())


def test_run_on_a_terminal_completes_its_stages(tmp_path: Path) -> None:
    """The same on a terminal: when it ends all stages stand there with a tick, then the line of where everything is."""
    leader, follower = pty.openpty()
    command = [sys.executable, "-m", "evolvent", "run", "demos/he2022.toml", "--level", "quick", "--out", str(tmp_path)]
    command += ["--set", "sweep.positions=2", "--set", "output.pictures=false", "--set", "output.animation=false"]
    wanted = {**os.environ, "TERM": "xterm", "OMP_NUM_THREADS": "1", "COLUMNS": "100"}
    process = subprocess.Popen(command, cwd=ROOT, stdout=follower, stderr=follower, env=wanted)
    os.close(follower)
    seen = b""
    while True:
        try:
            part = os.read(leader, 65536)
        except OSError:  # the other end is closed
            break
        if not part:
            break
        seen += part
    os.close(leader)
    assert process.wait(timeout=60) == 0
    text = re.sub(r"\x1b\[[0-9;?]*[A-Za-z]", "", seen.decode())
    assert [line for line in text.splitlines() if line.strip()][-1].startswith("done: figures")
    assert [name for name in STAGES if f"✓ {name}" in text] == list(STAGES)


@pytest.mark.parametrize("bars", [None, {"loss_percent": 0.1}])
def test_last_line_says_whether_figures_have_error_bars(bars: dict[str, float] | None, tmp_path: Path) -> None:
    """Problem: `output.error_bars = false`, or a companion that failed. Exact: error bars are named only where the
    summary has them."""
    (tmp_path / "summary.json").write_text(json.dumps({"frictions": [{"estimated_error": bars}]}))
    said = whereabouts(tmp_path, spur_scene("output.error_bars=false"))
    assert said == f"done: figures{' with error bars' if bars else ''} in {tmp_path}/summary.json"


def test_last_line_names_existing_requested_files(tmp_path: Path) -> None:
    """Of a run without pictures and fields neither is named; those of an earlier part of it are not, where the scene
    asks for none now."""
    asked, unasked = (spur_scene(f"output.pictures={on}", "output.animation=false", f"output.fields={on}")
                      for on in ("true", "false"))
    (tmp_path / "summary.json").write_text(json.dumps({"frictions": [{"estimated_error": {"loss_percent": 0.1}}]}))
    (tmp_path / "teeth.csv").write_text("")
    wanted = f"done: figures with error bars in {tmp_path}/summary.json; tables in {tmp_path}/teeth.csv"
    assert whereabouts(tmp_path, asked) == wanted
    for name in ("pictures/01_loaded_pair.png", "fields/contact.pvd"):
        (tmp_path / name).parent.mkdir()
        (tmp_path / name).write_text("")
    assert whereabouts(tmp_path, unasked) == wanted
    assert "pictures in" in whereabouts(tmp_path, asked) and "fields for ParaView in" in whereabouts(tmp_path, asked)
