"""The call of a computation: one object for what belongs to it, instead of its parts handed on one by one."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from dataclasses import FrozenInstanceError
from pathlib import Path

import pytest
from mpi4py import MPI

from evolvent.results.archive.run_cost import Cost, Timings, write_cost
from evolvent.results.archive.run_folder import RunFolder
from evolvent.run.call import Options, opened_call
from tests.support.checkout import ROOT
from tests.support.gear_cases import spur_scene

PARTS = {"comm", "log", "progress", "earlier", "begun"}
SPENT = Cost(Timings(mesh=1.0, positions=2.0, total=3.0), 100.0, "run")


def functions() -> Iterator[tuple[str, ast.FunctionDef]]:
    """Every function of the room `run`, with its file; not what a call is made of."""
    for path in sorted((ROOT / "solver/evolvent/run").glob("*.py")):
        if path.name not in ("call.py", "run_log.py"):
            tree = ast.parse(path.read_text(encoding="utf-8"))
            yield from ((path.name, node) for node in ast.walk(tree) if isinstance(node, ast.FunctionDef))


def test_stages_take_the_call_instead_of_its_parts() -> None:
    """No function takes two parts of a call: whoever needs several takes the call."""
    taken = {f"{file}: {node.name}": PARTS & {each.arg for each in node.args.args} for file, node in functions()}
    assert len(taken) > 50
    assert {name: parts for name, parts in taken.items() if len(parts) > 1} == {}


def test_only_the_run_log_uses_the_logger() -> None:
    """In the room `run` all lines go through the log of the call; the standard logger is used by the log, and by the
    handler of signals, which has no call."""
    files = (ROOT / "solver/evolvent/run").glob("*.py")
    named = sorted(path.name for path in files if "getLogger" in path.read_text(encoding="utf-8"))
    assert named == ["run_log.py", "stopping.py"]


@pytest.mark.parametrize("resume", [True, False])
def test_earlier_cost_is_that_of_the_resumed_run(resume: bool, tmp_path: Path) -> None:
    """A resumed run adds to the archived cost, a new one begins at zero."""
    folder = RunFolder(tmp_path)
    write_cost(folder, SPENT)
    with opened_call("run", (), folder, MPI.COMM_SELF, Options(resume=resume, quiet=True)) as run:
        now = run.cost(Timings(positions=1.0, total=1.0), 50.0)
    assert run.earlier == (SPENT if resume else Cost())
    assert now == (Cost(Timings(mesh=1.0, positions=3.0, total=4.0), 100.0, "run") if resume
                   else Cost(Timings(positions=1.0, total=1.0), 50.0, "run"))


def test_call_is_frozen_and_names_its_archive(tmp_path: Path) -> None:
    """The archive of a scene lies in the folder of the run; no stage can exchange a part of the call."""
    with opened_call("run", (), RunFolder(tmp_path), MPI.COMM_SELF, Options(resume=False, quiet=True)) as run:
        assert run.archive(spur_scene()).out == tmp_path
        assert run.on_first(lambda: 3) == 3 and run.memory_MB() > 1.0
        with pytest.raises(FrozenInstanceError):
            run.options = Options()  # type: ignore[misc]


def test_failed_run_logs_its_reason(tmp_path: Path) -> None:
    """An error inside a call is the last line of run.log, which is opened for it."""

    def fail() -> None:
        with opened_call("run", (), RunFolder(tmp_path), MPI.COMM_SELF, Options(resume=False, quiet=True)) as run:
            run.log.info("begun")
            raise ZeroDivisionError("by zero")

    with pytest.raises(ZeroDivisionError):
        fail()
    lines = (tmp_path / "run.log").read_text(encoding="utf-8").splitlines()
    assert [line.split("  ", 1)[1] for line in lines] == ["begun", "failed: by zero"]
