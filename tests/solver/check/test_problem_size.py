"""Sizes that are told before a mesh is made, against the mesh; memory against what runs took; what does not fit."""

from __future__ import annotations

import pickle
import subprocess
import sys
import textwrap
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from evolvent.check import problem_size
from evolvent.check.check_report import overview
from evolvent.check.problem_size import memory_megabytes, room_problem, sector_sizes
from evolvent.commands.app import main
from evolvent.gears.meshing.element_sizes import sector_resolutions
from evolvent.gears.meshing.sector_meshes import gear_mesh
from evolvent.gears.meshing.sector_sizes import sector_size
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene, load_scene
from evolvent_meshes.gears.member import Member
from evolvent_meshes.sector.section import section_mesh
from tests.support.checkout import ROOT
from tests.support.gear_cases import helical_scene, model_of, spur_scene, swept
from tests.support.running.processes import RunScript

MEBIBYTE = 1.048576


ONE_MESH = 'exact.parts=["two-level"]'
SHORT = "contact.friction=0.1", "sweep.positions=3"
QUICK = "mesh.level=quick", "contact.friction=0.11", ONE_MESH


def yang(*settings: str) -> Scene:
    return load_scene(ROOT / "demos/yang2022.toml", settings)


@pytest.mark.parametrize(
    ("shape", "order", "long_way"),
    [("hexahedron", 1, False), ("hexahedron", 2, False), ("hexahedron", 2, True), ("tetrahedron", 1, False)],
)
@pytest.mark.parametrize("make", [spur_scene, helical_scene])
def test_sector_size_is_that_of_the_mesh(make: Callable[..., Scene], shape: str, order: int, long_way: bool) -> None:
    """Exact: the nodes of the mesh, of its loaded flank and of its two cut faces, times the dimension; plane and in
    space, both orders and shapes, with a coarse back flank and with one as fine as the loaded one."""
    off = ['exact.parts=["coarse-body"]'] if long_way else []
    scene = make(f"mesh.order={order}", f"mesh.shape={shape}", "mesh.elements_per_contact_width=0.5", *off)
    for member, found in zip(Member, sector_sizes(scene)):
        mesh = gear_mesh(gear_problem(scene), member)
        flank, low, high = (len(np.unique(mesh.facets[name])) for name in ("flank", "cut_low", "cut_high"))
        exact = np.array([len(mesh.points), flank, low + high]) * mesh.dimension
        assert [found.dofs, found.flank, found.cuts] == exact.tolist()


@pytest.mark.parametrize("level", ["quick", "standard", "fine"])
@pytest.mark.parametrize("name", ["yang2022", "he2022", "zhang2023"])
def test_section_size_is_that_of_the_mesh(name: str, level: str) -> None:
    """Exact for the papers' pairs at every level, counted on the second-order section."""
    scene = load_scene(ROOT / f"demos/{name}.toml", [f"mesh.level={level}"])
    for gear, resolution in zip(scene.gear_pair().gears, sector_resolutions(gear_problem(scene)), strict=True):
        section, found = section_mesh(gear, resolution), sector_size(resolution, 2, plane=True)
        nodes = len(section.points), *(len(np.unique(section.edges[edge])) for edge in ("flank", "cut_low"))
        assert [found.dofs, found.flank, found.cuts] == [2 * nodes[0], 2 * nodes[1], 4 * nodes[2]]


MEASURED = [
    (yang("mesh.level=quick", ONE_MESH), 3300), (yang("mesh.level=standard", ONE_MESH), 11000),
    (yang("mesh.level=standard", *SHORT, "output.error_bars=false"), 1652), (yang("mesh.level=standard", *SHORT), 1686),
    (yang("mesh.level=fine", *SHORT, "output.error_bars=false"), 1470), (yang("mesh.level=quick"), 1595),
    *((yang(*QUICK, f"mesh.elements_per_contact_width={elements}"), megabytes)
      for elements, megabytes in ((1, 1127), (1.4, 2255), (2, 3844), (2.6, 8420), (3.2, 17063), (3.5, 22401))),
    (yang("mesh.level=quick", "exact.parts=coarse-body"), 6481),
    (spur_scene("mesh.level=quick", "exact.parts=plane"), 1917),
]


@pytest.mark.parametrize(("scene", "mebibytes"), MEASURED)
def test_memory_estimate_of_measured_runs(scene: Scene, mebibytes: float) -> None:
    """Within 20 % of what runs on one rank took (docs/benchmark.md), from 1 GB on."""
    assert memory_megabytes(scene) == pytest.approx(MEBIBYTE * mebibytes, rel=0.2)


def test_memory_estimate_of_small_runs() -> None:
    """A plane run took 157 MB, with whole gears 630: told within a factor of two, so that small machines are let."""
    quick = spur_scene("mesh.level=quick")
    assert 150 < memory_megabytes(quick) < 330
    assert 600 < memory_megabytes(spur_scene("mesh.level=quick", "exact.parts=one-sector")) < 1300


def test_memory_estimate_of_several_ranks() -> None:
    """Two ranks eliminate both gears at once; a third one only runs."""
    one, two, three = (memory_megabytes(yang("mesh.level=standard", ONE_MESH), ranks) for ranks in (1, 2, 3))
    assert 1.6 * one < two < 2.0 * one
    assert three - two == pytest.approx(problem_size.MEGABYTES_BASE[3])


def test_memory_estimate_of_the_demos() -> None:
    """The papers' pairs at quick and standard want less than 24 GB, also on two ranks, and at fine in levels; Yang's on
    one fine mesh does not."""
    for name in ("yang2022", "he2022", "zhang2023"):
        for level in ("quick", "standard"):
            assert memory_megabytes(load_scene(ROOT / f"demos/{name}.toml", [f"mesh.level={level}"]), 2) < 24e3
    assert memory_megabytes(yang("mesh.level=fine"), 2) < 8e3
    assert memory_megabytes(yang("mesh.level=fine", ONE_MESH)) > 60e3


@pytest.fixture
def machine(monkeypatch: pytest.MonkeyPatch) -> Callable[[float], None]:
    """machine(megabytes): gives the machine so much memory."""
    return lambda megabytes: monkeypatch.setattr(problem_size, "machine_megabytes", lambda: megabytes)


TETRAHEDRA, ELEMENTS = "mesh.shape=tetrahedron", "mesh.elements_per_contact_width"


@pytest.mark.parametrize(
    ("settings", "megabytes", "key", "remedy"),
    [
        ([TETRAHEDRA, "mesh.level=fine"], 25e3, "mesh.level", "take --level standard (12 GB)"),
        ([TETRAHEDRA, "mesh.level=fine"], 8e3, "mesh.level", "take --level quick (3.26 GB)"),
        ([TETRAHEDRA, "mesh.level=standard"], 2e3, "mesh.level", "quick --set mesh.elements_per_contact_width=1.3"),
        ([TETRAHEDRA, "mesh.elements_per_contact_width=12"], 25e3, ELEMENTS, "per_contact_width=3."),
        (["mesh.level=fine", "load.torque_Nm=12", SHORT[0]], 5e3, "mesh.level", "take --level standard ("),
        (["mesh.level=fine", ONE_MESH], 25e3, "mesh.level", "take two-level out of exact.parts (--exact)"),
        (
            ["mesh.level=quick", "exact.parts=one-sector"], 8e3, "mesh.level",
            "take one-sector out of exact.parts (--exact)",
        ),
        (["load.torque_Nm=1e-4"], 25e3, "mesh.level", "is too narrow. From about 0.8192 N·m on --level quick does"),
    ],
)
def test_remedy_names_the_finest_mesh_that_fits(
    settings: list[str], megabytes: float, key: str, remedy: str, machine: Callable[[float], None]
) -> None:
    """The finest level that fits, else a number of elements; where that is a setting, it does fit."""
    machine(megabytes)
    problem = room_problem(yang(*settings), memory_megabytes)
    assert problem is not None and problem.key == key
    assert remedy in problem.remedy and "--force" in problem.remedy
    assert f"{megabytes / 1e3:.3g} GB" in problem.allowed


def test_remedy_names_the_number_of_elements_that_fits(machine: Callable[[float], None]) -> None:
    """The number of elements that is named fits, a tenth more does not."""
    machine(2e3)
    problem = room_problem(yang("mesh.level=quick", TETRAHEDRA), memory_megabytes)
    assert problem is not None
    count = float(problem.remedy.split("elements_per_contact_width=")[1].split()[0])
    needed = [memory_megabytes(yang("mesh.level=quick", TETRAHEDRA, f"mesh.elements_per_contact_width={n}"))
              for n in (count, count + 0.1)]
    assert needed[0] <= 2e3 < needed[1]


def test_memory_of_results_is_counted(machine: Callable[[float], None]) -> None:
    """1000 positions of three pitches at 50 coefficients are 150,000 results, too many for any machine of this size;
    the estimate for one in 2D is no less than its arrays, and no more than 2.5 times."""
    machine(24e3)
    coefficients = [k / 100 for k in range(50)]
    many = yang("sweep.positions=1000", f"contact.friction={coefficients}", "exact.parts=one-pitch")
    problem = room_problem(many, memory_megabytes)
    assert problem is not None and problem.key == "sweep.positions" and "200,000 results" in problem.found
    assert problem.found.endswith("in all")
    scene = spur_scene("mesh.level=quick", "contact.friction=0.3", "sweep.positions=2")
    result = swept(model_of(scene), np.array([1.0]), [0.3])[0].results[0]
    told = problem_size.results_megabytes(scene) / 2
    assert 1e-6 * len(pickle.dumps(result)) < told < 2.5e-6 * len(pickle.dumps(result))


def test_remedy_names_one_rank_where_two_do_not_fit(machine: Callable[[float], None]) -> None:
    machine(15e3)
    problem = room_problem(yang("mesh.level=standard", ONE_MESH), memory_megabytes, 2)
    assert problem is not None and problem.remedy.startswith("run on one rank")


def test_remedy_of_a_load_list_counts_its_lightest_load_too(machine: Callable[[float], None]) -> None:
    """On flanks in levels each torque has as many as it needs, the lightest one most: the torque that is named fits
    alone on the meshes of the list, too."""
    machine(25e3)
    one = "mesh.level=standard", "contact.friction=0.1"
    problem = room_problem(yang(*one, "load.torque_Nm=0.25", "load.mesh_torques_Nm=[0.25, 250]"), memory_megabytes)
    assert problem is not None and "--percent" in problem.remedy
    lightest = float(problem.remedy.split("about ")[1].split()[0])
    for torque in (lightest, 250):
        served = yang(*one, f"load.torque_Nm={torque}", f"load.mesh_torques_Nm=[{lightest}, 250]")
        assert memory_megabytes(served) <= 25e3


def test_remedy_of_a_load_list_names_the_lightest_load_that_fits(machine: Callable[[float], None]) -> None:
    """A list from 0.25 to 250 N·m on one mesh a sector: loads below some torque are to be left out; a list from that
    torque on fits, one from half of it does not."""
    machine(10e3)
    listed = ["mesh.level=quick", ONE_MESH, "load.torque_Nm=250"]
    problem = room_problem(yang(*listed, "load.mesh_torques_Nm=[0.25, 250]"), memory_megabytes)
    assert problem is not None and "--percent" in problem.remedy
    lightest = float(problem.remedy.split("about ")[1].split()[0])
    wanted = [memory_megabytes(yang(*listed, f"load.mesh_torques_Nm=[{least}, 250]")) for least in
              (lightest, 0.5 * lightest)]
    assert wanted[0] <= 10e3 < wanted[1]


@pytest.mark.parametrize("command", ["run", "mesh"])
def test_commands_refuse_a_mesh_that_does_not_fit(
    command: str, machine: Callable[[float], None], tmp_path: Path, capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """Status 2 before a mesh is made, nothing written; --force goes on."""
    monkeypatch.setattr("evolvent.gears.meshing.levelled_meshes.sector_mesh", lambda *_: pytest.fail("a mesh was made"))
    machine(200.0)
    out = str(tmp_path / ("out" if command == "run" else "pair.msh"))
    arguments = [command, str(ROOT / "demos/yang2022.toml"), "--out", out]
    assert main(arguments) == 2
    said = capsys.readouterr().err
    assert 'mesh.level: found "standard", 179,826 degrees of freedom and 61,710 of fine flanks' in said
    assert "; remedy: " in said
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("command", ["run", "mesh"])
def test_force_computes_a_mesh_that_does_not_fit(
    command: str, machine: Callable[[float], None], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With --force the command begins what does not fit."""

    class Begun(BaseException):
        pass

    def begin(*_: object, **__: object) -> None:
        raise Begun

    machine(200.0)
    monkeypatch.setattr("evolvent.run.compute.compute", begin)
    monkeypatch.setattr("evolvent.gears.meshing.standing_pair.standing_pair", begin)
    with pytest.raises(Begun):
        main([command, str(ROOT / "demos/yang2022.toml"), "--out", str(tmp_path / "pair.msh"), "--force"])


def test_check_reports_a_mesh_that_does_not_fit(machine: Callable[[float], None]) -> None:
    machine(5e3)
    text = overview(yang("mesh.level=standard", TETRAHEDRA))
    assert "Too large for this machine" in text and "--level quick" in text
    machine(50e3)
    assert "Too large" not in overview(yang("mesh.level=standard", TETRAHEDRA))


def test_check_reports_both_meshes_of_a_flank_in_levels() -> None:
    """Coarse sectors, and the elements and degrees of freedom of the fine flanks: 60 x 42 of second order."""
    lines = [line for line in overview(yang("mesh.level=standard")).splitlines() if line.startswith("  ")]
    rows = {line.strip().split("  ")[0]: line.split()[-2:] for line in lines}
    assert rows["elements along the loaded flank"] == ["60", "60"]
    assert rows["layers over the face width"] == ["42", "42"]
    assert rows["degrees of freedom of a sector"] == ["89,913", "89,913"]
    assert rows["degrees of freedom of a flank"] == [f"{3 * 121 * 85:,}"] * 2
    assert "degrees of freedom of a flank" not in overview(yang("mesh.level=quick", ONE_MESH))


HUGE = [
    ["load.torque_Nm=1e-4"],
    ["load.torque_Nm=1e-12"],
    ["load.torque_Nm=1e-300"],
    ["load.torque_Nm=1e-6", "exact.parts=one-sector", "exact.parts=coarse-body"],
    ["mesh.elements_per_contact_width=24", "load.torque_Nm=1e-5"],
    ["pinion.teeth=1000000000"],
    ["sweep.positions=1000000000000"],
    ["wheel.face_width_mm=1000", "pinion.face_width_mm=1000", "load.torque_Nm=0.01"],
]


def test_check_takes_little_memory() -> None:
    """`evolvent check` of whatever numbers takes less than 200 MB, seen as the largest resident memory of one process
    for all of them. The time limit is a guard against a hang only."""
    code = """
    import sys
    from pathlib import Path
    from evolvent.commands.app import main
    for line in sys.stdin.read().splitlines():
        print("status", main(["check", sys.argv[1], *(part for text in line.split("|") for part in ("--set", text))]))
    print("megabytes", int(Path("/proc/self/status").read_text().split("VmHWM:")[1].split()[0]) / 1e3)
    """
    command = [sys.executable, "-c", textwrap.dedent(code), str(ROOT / "demos/yang2022.toml")]
    given = "\n".join("|".join(settings) for settings in HUGE)
    done = subprocess.run(command, input=given, capture_output=True, text=True, timeout=60, cwd=ROOT, check=True)
    statuses = [line for line in done.stdout.splitlines() if line.startswith("status")]
    assert len(statuses) == len(HUGE) and set(statuses) <= {"status 0", "status 2"}
    assert "Traceback" not in done.stderr
    assert float(done.stdout.split("megabytes")[1]) < 200


@pytest.mark.mpi
def test_two_ranks_refuse_with_one_message(run_script: RunScript) -> None:
    """Under mpirun the memory of all ranks on a machine counts; one message, status 2 on all."""
    arguments = "run", "demos/yang2022.toml", "--out", "/nowhere/out", "--set", "load.torque_Nm=1e-4"
    done = run_script("-m", "evolvent", *arguments, ranks=2)
    assert done.returncode == 2 and done.stderr.count("mesh.level: found") == 1
    assert "on 2 ranks" in done.stderr and "Traceback" not in done.stderr
