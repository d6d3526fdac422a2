"""Shared by all tests: quiet libraries, scripts on a number of MPI ranks, and the order of files among workers."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from tests.support.running import processes

if TYPE_CHECKING:
    from evolvent.fem.cache.cache import Cache


@pytest.fixture(scope="session", autouse=True)
def _quiet() -> None:
    from evolvent.fem.backend import (
        dolfinx_compat,  # starts MPI: pytest itself must not, or its workers take themselves for ranks
    )

    dolfinx_compat.silence_logs()


@pytest.fixture(scope="session", autouse=True)
def _nothing_kept() -> Iterator[None]:
    """Each test condenses what it asks for, whatever this user's cache holds."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("EVOLVENT_CACHE_GB", "0")
        yield


@pytest.fixture
def kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Cache:
    """An empty cache of 1 GB in a folder of the test, also of programs that it starts. Compiled forms stay where they
    are in this process."""
    from evolvent.fem.cache import cache  # starts MPI, see above

    folder = tmp_path / "evolvent" / cache.FOLDER
    folder.mkdir(parents=True)
    monkeypatch.setattr(cache, "cache_directory", lambda name: folder)
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setenv(cache.SIZE, "1")
    return cache.Cache.of_environment()


@pytest.fixture(autouse=True)
def _may_start_mpirun(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Tests marked `mpi` alone."""
    if request.node.get_closest_marker("mpi"):
        monkeypatch.setenv(processes.MARKED, "1")


@pytest.fixture(scope="session")
def run_script() -> processes.RunScript:
    """See processes.run_script."""
    return processes.run_script


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Where workers share the tests."""
    if hasattr(config, "workerinput"):
        from tests.support.running.schedule import durations, longest_files_first

        longest_files_first(items, config.rootpath, durations())


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> object:
    """For `--dist loadfile`."""
    if config.getoption("dist") != "loadfile":
        return None
    from tests.support.running.schedule import CollectedOrder

    return CollectedOrder(config, log)
