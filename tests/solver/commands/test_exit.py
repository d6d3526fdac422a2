"""How errors leave the program: the error itself carries the exit status, nothing is looked up by name."""

from __future__ import annotations

import importlib
import pkgutil
from collections.abc import Iterator

import pytest
import typer

import evolvent
import evolvent_meshes
from evolvent.commands.app import main
from evolvent.commands.exit import reported
from evolvent.contact.newton.snes import NotConverged
from evolvent.contact.search.pairing import SearchError
from evolvent.fem.backend.form_compiler import CompileError
from evolvent.fem.condensation.mumps import NotPositiveDefinite, OutOfMemory
from evolvent.gears.solution.certificates import BalanceError, PitchImbalance
from evolvent_meshes.errors import EvolventError, InputError, ResultError
from evolvent_meshes.mesh.mesh_data import MeshError

PACKAGES = (evolvent, evolvent_meshes)
NOT_REPORTED = {
    "evolvent.run.stopping.Stopped", "evolvent_meshes.files.NoFile", "evolvent.fem.cache.value_files.DamagedFile",
}
"""A signal, which is a KeyboardInterrupt, an OSError that every reader turns into an error of its own, and a
file of the cache that is damaged, which is made again."""
STATUSES = {
    NotConverged: 3, SearchError: 3, BalanceError: 3, PitchImbalance: 3, MeshError: 2, NotPositiveDefinite: 2,
    OutOfMemory: 1, CompileError: 1,
}


def exceptions() -> Iterator[type[BaseException]]:
    """Every exception class that a module of the packages defines."""
    for package in PACKAGES:
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            if module.name.endswith("__main__"):
                continue
            for value in vars(importlib.import_module(module.name)).values():
                if isinstance(value, type) and issubclass(value, BaseException) and value.__module__ == module.name:
                    yield value


def test_every_error_of_the_packages_carries_an_exit_status() -> None:
    """Each derives from EvolventError: 2 if it is an InputError, 3 if a ResultError, 1 otherwise."""
    errors = [error for error in exceptions() if not issubclass(error, Warning)]
    assert {NotConverged, SearchError, NotPositiveDefinite, OutOfMemory, CompileError} <= set(errors)
    with_status = {error for error in errors if issubclass(error, EvolventError)}
    without_status = set(errors) - with_status
    assert {f"{error.__module__}.{error.__qualname__}" for error in without_status} == NOT_REPORTED
    for error in with_status:
        expected = 2 if issubclass(error, InputError) else 3 if issubclass(error, ResultError) else 1
        assert error.exit_status == expected


@pytest.mark.parametrize(("kind", "status"), STATUSES.items())
def test_error_leaves_with_its_status(
    kind: type[EvolventError], status: int, capsys: pytest.CaptureFixture[str]
) -> None:
    """One line on stderr without a traceback, and the status of the class."""
    with pytest.raises(typer.Exit) as caught, reported():
        raise kind("the reason")
    assert caught.value.exit_code == status
    assert capsys.readouterr().err == "evolvent: the reason\n"


def test_status_of_a_new_error_is_that_of_its_class(capsys: pytest.CaptureFixture[str]) -> None:
    """A class that the command line cannot know is reported like all others."""

    class Unheard(ResultError):
        pass

    with pytest.raises(typer.Exit) as caught, reported():
        raise Unheard("of something new")
    assert caught.value.exit_code == 3
    assert capsys.readouterr().err == "evolvent: of something new\n"


def test_bug_leaves_with_its_traceback(capsys: pytest.CaptureFixture[str]) -> None:
    """What is no EvolventError is a bug: status 1, its traceback and its class."""
    with pytest.raises(typer.Exit) as caught, reported():
        raise TypeError("a bug")
    message = capsys.readouterr().err
    assert caught.value.exit_code == 1
    assert 'raise TypeError("a bug")' in message and message.endswith("TypeError: a bug\n")


def test_empty_command_line_prints_the_help(capsys: pytest.CaptureFixture[str]) -> None:
    """`evolvent` alone: status 2 and the help as it is, not a message on a wrong argument."""
    assert main([]) == 2
    captured = capsys.readouterr()
    assert "Examples:" in captured.err + captured.out
    assert "remedy" not in captured.err + captured.out
