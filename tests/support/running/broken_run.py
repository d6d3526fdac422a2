"""`evolvent run` with an injected fault: broken_run.py FAULT SCENE.toml --out DIR [...]; a script that tests run.

FAULT:
    ok              none
    levels          none; flanks have levels of their own, however small the mesh
    levels-N        the same, and killed before the N-th file is renamed
    count           none; prints how many gears this rank has condensed and how many positions it has searched
    kill-mesh       killed when the second gear is meshed
    kill-before-N   killed before the N-th file of the archive is renamed
    kill-after-N    killed after the N-th file of the archive
    kill-half-N     killed when half of the N-th file is written
    full-N          no space for the N-th file
    raise-R-N       rank R fails in its N-th turn; the first turn has one position, later ones two
    killrank-R-N    rank R is killed in its N-th turn
    nan-N           the compliance of the flanks is NaN from the N-th position on
    unbalanced      a position fails its balance certificate
    leaking         a pitch fails its balance certificate
    strict          a pitch fails its balance certificate, but not on deflected flanks
    strict-N        the same, and killed before the N-th file is renamed
"""

from __future__ import annotations

import errno
import os
import signal
import sys
from collections.abc import Callable
from dataclasses import replace
from itertools import count
from types import ModuleType
from typing import TYPE_CHECKING

import numpy as np
from mpi4py import MPI

from evolvent.commands.app import main
from evolvent.contact.newton.contact_equations import CondensedSystem
from evolvent.gears import meshed_sector
from evolvent.gears.contact.pair_contact import GearContact
from evolvent.gears.meshing import levelled_meshes
from evolvent.gears.solution import certificates
from evolvent.gears.sweep import parallel_sweep, pitch_sweep
from evolvent.results.archive.store import Store
from evolvent_meshes import files
from tests.support.running.patches import calling_first, with_result

if TYPE_CHECKING:
    from _typeshed import FileDescriptorLike


def kill() -> None:
    """Ends the process like `kill -9`, the out-of-memory killer or a power cut."""
    os.kill(os.getpid(), signal.SIGKILL)


def before_call(module: ModuleType | type, name: str, action: Callable[[int], None]) -> None:
    """Calls action(n) before the n-th call of a function of a module, n = 1, 2, ..."""
    numbers = count(1)
    setattr(module, name, calling_first(getattr(module, name), lambda *_, **__: action(next(numbers))))


def kill_when(wanted: int) -> Callable[[int], None]:
    return lambda number: kill() if number == wanted else None


def at_archive_file(wanted: int, strike: Callable[[], None]) -> None:
    """Calls `strike` before the archive writes its file number `wanted`."""
    before_call(Store, "write", lambda number: strike() if number == wanted else None)


def kill_before_renaming() -> None:
    before_call(files.os, "replace", lambda _: kill())


def kill_half_written() -> None:
    """Truncates the file to its half when it is flushed, after its line in the manifest; then kills."""
    numbers = count(1)

    def halved(fd: FileDescriptorLike) -> None:
        if next(numbers) == 2:
            descriptor = fd if isinstance(fd, int) else fd.fileno()
            os.ftruncate(descriptor, os.fstat(descriptor).st_size // 2)
            kill()

    files.os.fsync = calling_first(os.fsync, halved)


def disk_full() -> None:
    """No space for the file, but for its line in the manifest."""
    def full(number: int) -> None:
        if number == 2:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    before_call(files.os, "fsync", full)


def failing_rank(rank: int, wanted: int) -> Callable[[int], None]:
    def action(number: int) -> None:
        if MPI.COMM_WORLD.rank == rank and number == wanted:
            raise ArithmeticError(f"rank {rank} broke")

    return action


def killed_rank(rank: int, wanted: int) -> Callable[[int], None]:
    return lambda number: kill() if MPI.COMM_WORLD.rank == rank and number == wanted else None


def no_number(wanted: int) -> None:
    """The compliance of the flanks is NaN from position number `wanted` on."""
    system, numbers = GearContact.system, count(1)
    at: list[int] = []
    before_call(pitch_sweep, "shared_position", lambda _: at.append(next(numbers)))

    def without_number(condensed: CondensedSystem) -> CondensedSystem:
        return replace(condensed, jump=condensed.jump * np.nan) if at[-1] >= wanted else condensed

    setattr(GearContact, "system", with_result(system, without_number))  # noqa: B010


def break_it(how: str) -> None:
    kind, *numbers = how.split("-")
    if how == "kill-mesh":
        before_call(levelled_meshes, "gear_mesh", kill_when(2))
    elif kind == "kill":
        when, wanted = numbers[0], int(numbers[1])
        if when == "before":
            at_archive_file(wanted, kill_before_renaming)
        elif when == "after":
            at_archive_file(wanted + 1, kill)
        else:
            at_archive_file(wanted, kill_half_written)
    elif kind == "full":
        at_archive_file(int(numbers[0]), disk_full)
    elif kind == "raise":
        before_call(parallel_sweep._RankedSweep, "_solved", failing_rank(int(numbers[0]), int(numbers[1])))
    elif kind == "levels":
        levelled_meshes.MOST_DOFS = 0
        if numbers:
            at_archive_file(int(numbers[0]), kill_before_renaming)
    elif kind == "killrank":
        before_call(parallel_sweep._RankedSweep, "_solved", killed_rank(int(numbers[0]), int(numbers[1])))
    elif kind == "nan":
        no_number(int(numbers[0]))
    elif how == "unbalanced":
        certificates.STORED_LIMIT = 1e-9
    elif how == "leaking":
        certificates.BALANCE_LIMIT = 1e-9
    elif kind == "strict":
        certificates.BALANCE_LIMIT = 2e-3
        if numbers:
            at_archive_file(int(numbers[0]), kill_before_renaming)


if __name__ == "__main__":
    how = sys.argv[1]
    condensed: list[int] = []
    searched: list[int] = []
    if how == "count":
        before_call(meshed_sector, "condensed_gear", condensed.append)
        for module in (pitch_sweep, parallel_sweep):
            before_call(module, "shared_position", searched.append)
    break_it(how)
    status = main(["run", *sys.argv[2:]])
    if how == "count":
        print(f"rank {MPI.COMM_WORLD.rank}: condensed {len(condensed)}, searched {len(searched)}", flush=True)
    sys.exit(status)
