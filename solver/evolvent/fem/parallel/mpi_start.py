"""How MPI starts: a process alone opens no port, and says in one line where MPI finds no temporary folder; SIGHUP stays
a signal that ends the process.

Open MPI's defaults are those of a cluster: a process that no mpirun has launched starts a daemon (Open MPI 4), and both
listen on all interfaces, though they have nobody to talk to. The settings against that are for processes alone; ranks
have mpirun's. They hold while MPI starts: programs that this one starts, mpirun among them, do not inherit them.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from importlib.abc import MetaPathFinder
from importlib.machinery import ExtensionFileLoader, ModuleSpec, PathFinder
from types import MappingProxyType, ModuleType
from typing import TYPE_CHECKING

from evolvent_meshes.errors import InputError

if TYPE_CHECKING:
    from mpi4py import MPI

LAUNCHERS = ("OMPI_COMM_WORLD_SIZE", "PMIX_RANK", "PMIX_NAMESPACE", "PMI_RANK", "PMI_SIZE", "PMI_FD")
"""Environment variables of which a rank has one: mpirun of Open MPI and MPICH, srun."""
ALONE = MappingProxyType(
    {
        "OMPI_MCA_ess_singleton_isolated": "1",  # no daemon (4)
        "OMPI_MCA_pml": "ob1",  # no network library
        "OMPI_MCA_btl": "self",  # nor sockets below it
        "PMIX_MCA_ptl_tcp_if_include": "lo",  # where a daemon would listen (5)
    }
)
"""Settings of a process without others; the user's own come first."""
ANY = MappingProxyType({"UCX_DEBUG_SIGNO": "0"})
"""Settings of every process. UCX, which Open MPI 5 loads, takes SIGHUP for "write a trace" otherwise, and a closed
terminal ends nothing (github.com/openucx/ucx, issue 10742)."""
TEMPORARY = ("TMPDIR", "TEMP", "TMP")
"""Environment variables that name the temporary folder, the first that is set."""
MODULE = "mpi4py.MPI"


def launched() -> bool:
    """Whether mpirun or a batch system has started this process as a rank."""
    return any(name in os.environ for name in LAUNCHERS)


def world() -> MPI.Comm:
    """Communicator of all ranks. Starts MPI where it has not been started; raises InputError as the import of
    mpi4py.MPI."""
    from mpi4py import MPI

    return MPI.COMM_WORLD


def is_first() -> bool:
    """Whether this is rank 0, or a process alone, for which MPI is not started."""
    return not launched() or world().rank == 0


def start_alone_quietly() -> None:
    """Lets the import of mpi4py.MPI, which starts MPI, do so with the settings `ANY`, and `ALONE` where no mpirun has
    started this process, whichever module imports it first. Where MPI has been started nothing changes."""
    if not any(isinstance(finder, _Finder) for finder in sys.meta_path):
        sys.meta_path.insert(0, _Finder())


class _Finder(MetaPathFinder):
    """Finds mpi4py.MPI as Python does, with a loader of ours."""

    def find_spec(
        self, fullname: str, path: Sequence[str] | None, target: ModuleType | None = None
    ) -> ModuleSpec | None:
        spec = PathFinder.find_spec(fullname, path) if fullname == MODULE else None
        if spec is None or spec.origin is None:
            return None
        spec.loader = _Loader(fullname, spec.origin)
        return spec


class _Loader(ExtensionFileLoader):
    """Loads mpi4py.MPI with the settings of this process. Raises InputError as `_require_temporary_folder`."""

    def create_module(self, spec: ModuleSpec) -> ModuleType:
        with _set(ANY):  # read by UCX when the library is loaded
            return super().create_module(spec)

    def exec_module(self, module: ModuleType) -> None:
        if launched():
            super().exec_module(module)
            return
        _require_temporary_folder()
        with _set(ALONE):
            super().exec_module(module)


@contextmanager
def _set(variables: Mapping[str, str]) -> Iterator[None]:
    """Context with environment variables, but for those that the user has set; and with a home, without which Open MPI
    5 does not start."""
    wanted = {**variables, "HOME": _home()}
    added = {name: value for name, value in wanted.items() if name not in os.environ}
    os.environ.update(added)
    try:
        yield
    finally:
        for name in added:
            os.environ.pop(name, None)


def _home() -> str:
    """The user's home by the system's list, / where it has none."""
    home = os.path.expanduser("~")
    return home if os.path.isabs(home) else "/"


def _require_temporary_folder() -> None:
    """MPI keeps a folder below the temporary one. Raises InputError where none can be made there: MPI itself ends the
    process with forty lines."""
    import tempfile  # here: an import of `evolvent` alone does not wait for it

    name = next((name for name in TEMPORARY if os.environ.get(name)), "TMPDIR")
    folder = os.environ.get(name) or "/tmp"
    try:
        with tempfile.TemporaryDirectory(prefix="evolvent-", dir=folder):
            pass
    except OSError as error:
        raise InputError(
            f"{name}: found {folder}, where MPI cannot keep its files ({error.strerror}); allowed: a folder that this "
            f"user may write to; remedy: export {name}=/tmp, or name another one"
        ) from error
