"""The command line: exit statuses, messages on stderr, nothing written for bad input, no hang under mpirun."""

from __future__ import annotations

import os
import subprocess
import sys
import textwrap
import tomllib
from pathlib import Path

import pytest

import evolvent
from evolvent.commands.app import main
from evolvent.scene.schema.output import SKIP_NAMES
from evolvent_meshes.mesh.gmsh_io import read_msh
from evolvent_meshes.mesh.quality import scaled_jacobians
from tests.support.checkout import PYTHONPATH, ROOT
from tests.support.malformed.scenes import MALFORMED
from tests.support.running.processes import one_at_a_time
from tests.support.scene_texts import HE

COMMANDS = ("run", "check", "mesh", "plot", "info")
FAILING = """
    import sys
    from evolvent.run import compute
    def computed(what, out, options):
        from mpi4py import MPI
        {body}
    compute.compute = computed
    from evolvent.commands.app import main
    sys.exit(main(["run", {scene!r}, "--out", {out!r}]))
"""
STUCK = "from evolvent.contact.newton.snes import NotConverged; raise NotConverged({!r})"


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    """He's spur pair in a file of its own."""
    path = tmp_path / "he.toml"
    path.write_text(HE, encoding="utf-8")
    return path


def run_with(body: str, scene: Path, ranks: int = 1) -> subprocess.CompletedProcess[str]:
    """`evolvent run` in a process of its own, with the body of `compute` replaced; `body` is one line."""
    code = textwrap.dedent(FAILING).format(body=body, scene=str(scene), out=str(scene.parent / "out"))
    mpirun = ["mpirun", "--oversubscribe", "-n", str(ranks)] if ranks > 1 else []
    root = {f"{name}_ALLOW_RUN_AS_ROOT{tail}": "1" for name in ("OMPI", "PRTE") for tail in ("", "_CONFIRM")}
    environment = {**os.environ, **root, "OMP_NUM_THREADS": "1", "PYTHONPATH": PYTHONPATH}
    command = [*mpirun, sys.executable, "-c", code]
    with one_at_a_time(ranks):
        return subprocess.run(command, capture_output=True, text=True, timeout=120, env=environment, cwd=scene.parent)


@pytest.mark.parametrize("case", MALFORMED)
def test_bad_scene_is_status_2_and_writes_nothing(
    case: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """run: status 2, the message once on stderr and nothing on stdout, no output directory."""
    text, overrides, key, found, remedy = MALFORMED[case]
    path, out = tmp_path / "scene.toml", tmp_path / "out"
    path.write_text(text, encoding="utf-8")
    settings = [argument for override in overrides for argument in ("--set", override)]
    assert main(["run", str(path), "--out", str(out), *settings]) == 2
    captured = capsys.readouterr()
    lines = [line for line in captured.err.splitlines() if f" {key}: found " in line]
    assert len(lines) == 1, captured.err
    assert found in lines[0]
    assert remedy in lines[0]
    assert captured.out == ""
    assert list(tmp_path.iterdir()) == [path]


def test_each_of_several_errors_names_the_program(scene: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Two errors: two lines, both with the program's name."""
    assert main(["check", str(scene), "--set", "load.torque_Nm=0", "--set", "mesh.order=3"]) == 2
    lines = capsys.readouterr().err.splitlines()
    assert len(lines) == 2 and all(line.startswith(f"evolvent: {scene}: ") for line in lines)


@pytest.mark.parametrize("command", ["check", "mesh"])
def test_other_commands_validate_too(command: str, scene: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """check and mesh: status 2 and the same message."""
    out = ["--out", str(scene.parent / "a.msh")] if command == "mesh" else []
    assert main([command, str(scene), "--set", "load.torque_Nm=0", *out]) == 2
    assert "load.torque_Nm: found 0; allowed: " in capsys.readouterr().err
    assert list(scene.parent.iterdir()) == [scene]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["run"], "SCENE.toml"),
        (["run", "scene.toml"], "--out"),
        (["walk"], "walk"),
        (["check", "nowhere.toml"], "nowhere.toml: scene file: found No such file"),
        (["check", "{scene}", "--level", "ultra"], 'mesh.level: found "ultra"'),
        (["mesh", "{scene}", "--out", "mesh.stl"], "allowed: a name that ends in .msh"),
        (["run", "{scene}", "--out", "{scene}"], "allowed: a directory"),
        (["plot", "nowhere"], "nowhere: found no such directory"),
        (["plot", "{folder}"], "no results in it"),
        (["study", "{scene}", "--out", "o", "--resume"], "leave it out: the same command goes on with the scenes that"),
        (["mesh", "{scene}", "--out", "o", "--resume"], "leave it out: the command has nothing to go on from"),
    ],
)
def test_wrong_command_lines_are_status_2(
    arguments: list[str], message: str, scene: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    """Status 2 and a message on stderr."""
    assert main([argument.format(scene=scene, folder=scene.parent) for argument in arguments]) == 2
    assert message in capsys.readouterr().err


def test_help_has_examples(capsys: pytest.CaptureFixture[str]) -> None:
    """--help of the program and of every command: status 0 and an example that starts with `evolvent`."""
    for command in ([], *([name] for name in COMMANDS)):
        assert main([*command, "--help"]) == 0
        assert f"\n    evolvent {command[0] if command else 'check'}" in capsys.readouterr().out


def test_help_of_run_names_defaults_and_statuses(capsys: pytest.CaptureFixture[str]) -> None:
    """Default level, every name of a skip, what --resume needs, when --overwrite removes, the exit statuses."""
    assert main(["run", "--help"]) == 0
    text = " ".join(capsys.readouterr().out.split()).replace("- ", "-")  # lines may end at a hyphen
    parts = "which is standard", "the same scene and --set", "once the gears are condensed", "Exit status: 0 done,"
    assert all(part in text for part in (*parts, *SKIP_NAMES))


def test_check_prints_gear_data_and_cost(scene: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Status 0; gear data, estimates, dofs, memory and what is skipped."""
    assert main(["check", str(scene), "--level", "quick"]) == 0
    text = capsys.readouterr().out
    for part in ("transverse contact ratio", "1.7547", "587.7", "degrees of freedom", "memory", "2D plane strain"):
        assert part in text


def test_info_prints_versions(capsys: pytest.CaptureFixture[str]) -> None:
    """Status 0; dolfinx, PETSc and gmsh are named."""
    assert main(["info"]) == 0
    text = capsys.readouterr().out
    assert all(name in text for name in ("python", "dolfinx", "petsc", "gmsh"))


@pytest.mark.parametrize("order", [1, 2])
@pytest.mark.parametrize("shape", ["hexahedron", "tetrahedron"])
def test_mesh_writes_a_gmsh_file(shape: str, order: int, scene: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Both sectors of He's plane pair with their groups; the flanks of tooth pair 0 touch at (75, 0)."""
    out = scene.parent / "new" / "pair.msh"
    settings = ["--set", f"mesh.shape={shape}", "--set", f"mesh.order={order}", "--level", "quick"]
    assert main(["mesh", str(scene), "--out", str(out), *settings]) == 0
    assert "smallest scaled Jacobian" in capsys.readouterr().out
    mesh = read_msh(out)
    assert (mesh.shape, mesh.order) == ({"hexahedron": "quadrilateral", "tetrahedron": "triangle"}[shape], order)
    assert {"pinion_flank", "wheel_flank", "pinion_bore"} <= set(mesh.facets)
    assert scaled_jacobians(mesh).min() > 0
    for name in ("pinion_flank", "wheel_flank"):
        nodes = mesh.points[mesh.facets[name].ravel()]
        assert ((nodes - [75.0, 0.0, 0.0]) ** 2).sum(axis=1).min() < 0.1**2


@pytest.mark.parametrize(
    ("body", "status", "message"),
    [
        ("pass", 0, ""),
        (STUCK.format("stuck at 3 deg"), 3, "evolvent: stuck at 3 deg"),
        ("from evolvent_meshes.mesh.mesh_data import MeshError; raise MeshError('bad cell')", 2, "evolvent: bad cell"),
        ("raise OSError(28, 'No space left on device')", 1, "No space left on device"),
        ("raise ZeroDivisionError('by zero')", 1, "ZeroDivisionError: by zero"),
        ("import signal; signal.raise_signal(signal.SIGINT)", 1, "stopped by SIGINT; `evolvent run ... --resume`"),
    ],
)
def test_failures_of_run_have_their_exit_status(body: str, status: int, message: str, scene: Path) -> None:
    """0 done, 2 bad input, 3 not converged, 1 anything else; the message is on stderr."""
    done = run_with(body, scene)
    assert done.returncode == status, done.stderr
    assert message in done.stderr


@pytest.mark.mpi
def test_failing_rank_ends_the_command_on_all_ranks(scene: Path) -> None:
    """Rank 1 fails while rank 0 waits for it in a collective call: its message, its status, no hang."""
    body = "assert MPI.COMM_WORLD.rank == 0, 'rank 1 broke'; MPI.COMM_WORLD.Barrier()"
    done = run_with(body, scene, ranks=2)
    assert done.returncode == 1
    assert "rank 1 of 2" in done.stderr
    assert "rank 1 broke" in done.stderr


@pytest.mark.mpi
def test_ranks_that_fail_alike_print_one_message(scene: Path) -> None:
    """All ranks raise NotConverged: one message, status 3."""
    done = run_with(STUCK.format("stuck"), scene, ranks=2)
    assert done.returncode == 3
    assert done.stderr.count("stuck") == 1


@pytest.mark.mpi
def test_bad_scene_under_mpirun_is_reported_once(scene: Path) -> None:
    """Status 2, and the message once."""
    scene.write_text(HE.replace("torque_Nm = 170.0", "torque_Nm = -1"), encoding="utf-8")
    done = run_with("pass", scene, ranks=2)
    assert done.returncode == 2
    assert done.stderr.count("load.torque_Nm: found -1") == 1


def test_version_is_that_of_the_package(capsys: pytest.CaptureFixture[str]) -> None:
    """--version: status 0 and the version of pyproject.toml, which is `evolvent.__version__` too."""
    pyproject = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    assert main(["--version"]) == 0
    assert capsys.readouterr().out == f"evolvent {evolvent.__version__}\n"
    assert evolvent.__version__ == pyproject["project"]["version"]
