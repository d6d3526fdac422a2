"""Malformed input to every command: what is tried, how it is judged, and a sample of all trials."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Annotated

import pytest
import typer

from evidence.robustness.malformed import command_lines
from evidence.robustness.malformed.command_lines import CommandLine, Parameter
from evidence.robustness.malformed.summary import malformed_summary
from evidence.robustness.malformed.trials import SPOILABLE, Outcome, Trial, Verdict, outcomes, trials
from evolvent.commands import app as cli
from evolvent.commands.options import ResultsFolder, SceneFile

PARALLEL = [each.name for each in cli.COMMANDS if each.parallel]
"""The commands that compute a scene."""
SAMPLED = 37
"""Of so many trials one is made here; all of them by `python -m evidence.robustness malformed`."""


def test_every_command_is_tried() -> None:
    """At least 2000 trials, all different, of every command that the program registers; of those that read a scene at
    least 200 each."""
    all_trials = list(trials())
    assert len({(each.words, each.spoilt) for each in all_trials}) == len(all_trials) >= 2000
    assert all(content not in SPOILABLE.values() for _, content in filter(None, (each.spoilt for each in all_trials)))
    counts = Counter(each.command for each in all_trials)
    assert set(counts) == set(typer.main.get_command(cli.app).commands)  # type: ignore[attr-defined]
    assert min(counts[name] for name in (*PARALLEL, "check", "mesh", "study")) >= 200


def test_a_sample_is_refused(tmp_path: Path) -> None:
    """One of 37 trials, which takes all commands in: refused with status 2 and a message, no file written."""
    sample = list(trials())[::SAMPLED]
    assert {each.command for each in sample} >= {*PARALLEL, "check", "mesh", "study"}
    failed = [found for found in outcomes(tmp_path / "tried", sample) if found.verdict is not Verdict.REFUSED]
    assert failed == []


@pytest.fixture
def added(monkeypatch: pytest.MonkeyPatch) -> typer.Typer:
    """A command line with two commands of which the first takes everything."""
    app = typer.Typer(add_completion=False)

    @app.command()
    def anything(scene: SceneFile, out: ResultsFolder) -> None:
        """Write a file, whatever the scene."""
        out.mkdir(parents=True, exist_ok=True)

    @app.command()
    def nothing() -> None: ...

    monkeypatch.setattr(command_lines, "app", app)
    monkeypatch.setattr(cli, "app", app)
    return app


def test_a_command_added_later_takes_part(added: typer.Typer, tmp_path: Path) -> None:
    """A command that reads no scene and always writes: it is tried without being named anywhere, and its acceptance of
    spoilt scenes is seen."""
    without_settings = [each for each in trials() if "=" not in each.wrong]
    found = list(outcomes(tmp_path / "tried", without_settings))
    assert {each.command for each in found} == {"anything", "nothing"}
    accepted = [each.wrong for each in found if each.verdict is Verdict.ACCEPTED]
    assert "SCENE.toml: an open text" in accepted and "no --out DIR" not in accepted


def test_a_parameter_of_a_new_kind_is_refused(added: typer.Typer) -> None:
    """A command with an option that has no malformed values: an error that names it."""

    @added.command()
    def third(radius: Annotated[str, typer.Option("--radius", metavar="MM")]) -> None: ...

    with pytest.raises(ValueError, match="'--radius MM'"):
        list(trials())


@pytest.mark.parametrize(("code", "verdict"), [
    ("raise KeyError('x')", Verdict.TRACEBACK),
    ("typer.echo('evolvent: found 1; do it', err=True); raise typer.Exit(3)", Verdict.STATUS),
    ("typer.echo('evolvent: no', err=True); raise typer.Exit(2)", Verdict.UNCLEAR),
    ("open('new', 'w').close(); typer.echo('evolvent: found 1', err=True); raise typer.Exit(2)", Verdict.WROTE),
    ("typer.echo('evolvent: x: found 1', err=True); raise typer.Exit(2)", Verdict.REFUSED),
    ("import time; time.sleep(5.0)", Verdict.HUNG),
    ("", Verdict.ACCEPTED),
])
def test_verdicts(code: str, verdict: Verdict, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Commands that end in each of the ways there are, one of which sleeps longer than is waited for."""
    app = typer.Typer(add_completion=False)
    app.command("one")(lambda: exec(code, {"typer": typer}))
    app.command("two")(lambda: None)
    monkeypatch.setattr(cli, "app", app)
    monkeypatch.setattr("evidence.robustness.malformed.trials.PATIENCE", 0.5)
    (found,) = outcomes(tmp_path / "tried", [Trial("one", "all", ("one",))])
    assert (found.command, found.wrong, found.verdict) == ("one", "all", verdict)


def test_words_of_a_command_line() -> None:
    """All that is required stands there with a sound value, but for the parameter that is wrong."""
    scene, out = Parameter("", "SCENE.toml", True, False), Parameter("--out", "DIR", True, False)
    command = CommandLine("run", (scene, out, Parameter("--force", "", False, True)))
    assert command.words() == ["run", "scene.toml", "--out=out"]
    assert command.words(out, "") == ["run", "scene.toml", "--out="]



def test_summary_counts_and_names_failures() -> None:
    """Three trials of two commands, one accepted: counted by command, the accepted one named."""
    found = [Outcome("run", "a", Verdict.REFUSED, "", 0.1), Outcome("run", "b", Verdict.ACCEPTED, "", 0.1),
             Outcome("check", "c", Verdict.REFUSED, "", 0.1)]
    text = malformed_summary(found)
    assert "| `run` | 2 | 1 |" in text and "| `check` | 1 | 1 |" in text and "**3** trials, **1** not refused" in text
    assert "- `run`, b: accepted" in text
