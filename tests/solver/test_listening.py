"""Ports: a process alone opens none, ranks on one machine none beyond loopback. The commands are those of the command
line's registry, each with the first example of its help: a command that is added is watched, too."""

from __future__ import annotations

import os
import re
import shlex
import shutil
import socket
import subprocess
import sys
from pathlib import Path

import pytest

from evidence.processes import MPI_AS_ROOT
from evolvent.commands.app import app
from tests.support.checkout import PYTHONPATH, ROOT
from tests.support.run_parts import store
from tests.support.running.listening import listening, started_mpi, watched
from tests.support.running.page_commands import FEWER
from tests.support.running.processes import one_at_a_time
from tests.support.running.samples import sampled
from tests.support.synthetic_run import synthetic_run

COMMANDS = {str(each.name or each.callback.__name__): str(each.epilog) for each in app.registered_commands
            if each.callback is not None}
"""Name -> the end of its help, with examples."""
RUN_AND_STUDY_FIRST = sampled(sorted(COMMANDS, key=lambda name: name not in ("run", "study")), every=2)
PROCESSES = {"study": 3}
"""Command -> how many processes start MPI, where it is not one: watched until all have."""


def example(command: str) -> list[str]:
    """The words behind `evolvent` of the first example of a command's help, with settings that make it short."""
    found = re.search(rf"^ *(?:mpirun.* )?evolvent ({command}\b.*)$", COMMANDS[command], re.MULTILINE)
    assert found is not None, f"wanted an example in the help of `evolvent {command}`"
    return [*shlex.split(found[1]), *(word for setting in FEWER.get(command, ()) for word in ("--set", setting))]


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Where the examples find what they name."""
    (tmp_path / "demos").symlink_to(ROOT / "demos")
    store(synthetic_run(), tmp_path / "out/yang2022")
    (tmp_path / "out/yang2022/summary.json").touch()
    lines = "".join(f"{km},{1 + 0.5 * km}\n" for km in range(1, 9))
    (tmp_path / "record.csv").write_text(f"sliding_distance_km,depth_um\n{lines}")
    return tmp_path


def variables(**more: str) -> dict[str, str]:
    """No setting of MPI's but these."""
    return {"PYTHONPATH": PYTHONPATH, "OMP_NUM_THREADS": "1", "MPLBACKEND": "Agg", **more}


@pytest.fixture(autouse=True)
def _no_settings_of_mpi(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in list(os.environ):
        if name.startswith(("OMPI_MCA_", "PMIX_MCA_", "PRTE_MCA_")):
            monkeypatch.delenv(name)


@pytest.mark.slow
@pytest.mark.parametrize("command", RUN_AND_STUDY_FIRST)
def test_command_listens_on_no_network(command: str, folder: Path) -> None:
    """From its start until a second after MPI's, or to its end: neither the process nor one that it starts listens
    beyond loopback."""
    words = [sys.executable, "-m", "evolvent", *example(command)]
    if command == "run":
        shutil.rmtree(folder / "out")  # what `plot` draws, which no run has written
    found, said = watched(words, folder, variables(), lambda pid: started_mpi(pid) >= PROCESSES.get(command, 1))
    assert found == set(), said


README = (ROOT / "README.md").read_text(encoding="utf-8")


def documented() -> dict[str, str]:
    """The variables of README.md for ranks on one machine."""
    (line,) = re.findall(r"^export (OMPI_MCA_btl=.*)$", README, re.MULTILINE)
    return dict(word.split("=", 1) for word in line.split())


@pytest.mark.mpi
@pytest.mark.slow
def test_ranks_on_one_machine_listen_on_no_network(folder: Path) -> None:
    """With README.md's variables neither rank listens beyond loopback. `mpirun` itself keeps one port open, of each
    version of IP, as the page says; a release of Open MPI that does not lets this test be made stricter."""
    ranks = ["mpirun", "-n", "2", sys.executable, "-m", "evolvent", *example("run")]
    shutil.rmtree(folder / "out")
    settings = variables(**MPI_AS_ROOT, **documented())
    with one_at_a_time(2):
        found, said = watched(ranks, folder, settings, lambda pid: started_mpi(pid) == 2)
    assert {name for name, _ in found} <= {"mpirun", "prterun"}, said
    assert len(found) <= 2
    assert {address.split(":")[0] for _, address in found} <= {8 * "0", 32 * "0"}


@pytest.mark.mpi
def test_mpirun_in_a_network_of_its_own(tmp_path: Path) -> None:
    """README.md's way to have nothing reachable: `mpirun` and two ranks, of this user, see loopback alone, and reach
    each other."""
    (command,) = re.findall(r"`(unshare .*?)evolvent run \.\.\.'`", README, re.DOTALL)
    probe = "import os; from mpi4py import MPI; networks = open('/proc/net/dev').read().count(':')\n"
    probe += "print(MPI.COMM_WORLD.gather((os.getuid(), networks)) or '', end='')"
    (tmp_path / "probe.py").write_text(probe)
    if subprocess.run(["unshare", "--map-current-user", "--net", "--keep-caps", "true"], check=False).returncode:
        pytest.skip("no user namespaces here")
    with one_at_a_time(2):
        done = subprocess.run(
            ["sh", "-c", f"{' '.join(command.split())} {sys.executable} {tmp_path}/probe.py'"], capture_output=True,
            env={**os.environ, **variables(**MPI_AS_ROOT)}, text=True, timeout=120, check=False,
        )
    assert done.stdout == f"[{(os.getuid(), 1)}, {(os.getuid(), 1)}]", done.stderr


def test_a_port_is_seen(tmp_path: Path) -> None:
    """Of two ports the one on all interfaces is found, in a process that a process has started, and not the one on
    loopback."""
    program = "import socket, time\nopen_ = [socket.create_server((host, 0)) for host in ('', '127.0.0.1')]\n"
    program += "print(open_[0].getsockname()[1], flush=True)\ntime.sleep(1)"
    words = ["sh", "-c", f'{sys.executable} -c "{program}"; true']
    found, said = watched(words, tmp_path, variables(), lambda _: False)
    ((_, address),) = found
    assert address == f"00000000:{int(said):04X}"


def test_this_process_listens_nowhere() -> None:
    """A program of one's own, here these tests, which have imported the solver: MPI has started, no port is open."""
    from mpi4py import MPI

    assert MPI.Is_initialized() and "OMPI_MCA_btl" not in os.environ
    with socket.create_server(("", 0)) as own:
        port = own.getsockname()[1]
        assert {address for _, address in listening(os.getpid())} == {f"00000000:{port:04X}"}
