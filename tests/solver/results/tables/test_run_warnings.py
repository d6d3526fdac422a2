"""What is said before a number is trusted: few cells across the contact, bad cells, tip edges, missing error bars."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest
from mpi4py import MPI

from evidence.solved_run import solved_run
from evolvent.commands.app import Exit, main
from evolvent.gears.meshing.sector_meshes import gear_mesh
from evolvent.results.archive.error_bar_data import EstimatedErrors, FigureErrors
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.mesh_facts import MeshFacts, cells_across
from evolvent.results.run_data import RunData, SolvedPosition
from evolvent.results.tables.figure_rows import friction_rows
from evolvent.results.tables.run_warnings import warnings_of
from evolvent.results.tables.tables import summary, write_tables
from evolvent.run.kept_pitch import pitch_of
from evolvent.scene.plain_text import brief
from evolvent.scene.schema.dynamics import DynamicsSection
from tests.support.gear_cases import spur_scene
from tests.support.run_parts import FACTS, GOOD
from tests.support.synthetic_run import synthetic_run

BARS = EstimatedErrors((FigureErrors(1.0, 1.0, 0.1, 0.1, 0.1, 0.1, 0.01),), "", "")


@pytest.fixture(scope="module")
def quiet() -> RunData:
    """A made-up run that no tip edge bears in, at positions near enough to follow it."""
    run = replace(synthetic_run("contact.friction=0.1", "sweep.positions=24"), errors=BARS)

    def inside(solved: SolvedPosition) -> SolvedPosition:
        bare = tuple(replace(tooth, edge_pressure=0.0) for tooth in solved.teeth)
        return replace(solved, teeth=bare)

    return replace(run, positions=tuple(tuple(inside(solved) for solved in each) for each in run.positions))


def test_good_run_has_no_warning(quiet: RunData) -> None:
    """Three elements across, good cells, no edge, error bars: no warning."""
    assert warnings_of(quiet, GOOD) == ()


def test_load_of_a_vibration_is_said(quiet: RunData) -> None:
    """The mesh force at a speed is named as the load; a vibration that no load comes from is not."""
    for section, count in ((DynamicsSection(operating_rpm=2000.0), 1), (DynamicsSection(), 0)):
        sentences = warnings_of(replace(quiet, scene=quiet.scene.model_copy(update={"dynamics": section})), GOOD)
        assert len(sentences) == count
        assert all("mesh force of the vibration at 2000 r/min, running up" in sentence for sentence in sentences)


@pytest.mark.parametrize(
    ("mesh", "said"),
    [
        (MeshFacts(0.3, 1.7, 1.2), "The contact is 1.7 elements wide (median; 1.2 in its narrowest tenth); below 2"),
        (MeshFacts(0.3, 2.1, 0.9), "The contact is 2.1 elements wide (median; 0.9 in its narrowest tenth); below 2"),
        (MeshFacts(0.3, float("nan"), float("nan")), "elements wide"),
        (MeshFacts(2.8e-4, 3.1, 2.0), "The smallest scaled Jacobian of a cell is 0.0003, below 0.05"),
    ],
)
def test_coarse_or_distorted_mesh_is_warned_of(mesh: MeshFacts, said: str, quiet: RunData) -> None:
    """Each fact about the mesh has its one sentence, with the number."""
    (sentence,) = warnings_of(quiet, mesh)
    assert said in sentence


def test_tip_edges_and_missing_error_bars_are_warned_of(quiet: RunData) -> None:
    """A pair whose tip edges bear at all 24 positions, and whose largest pressure stands where their zone begins: both
    are said; so is a companion that failed, but not one that was not asked for."""
    run = synthetic_run("contact.friction=0.1", "sweep.positions=24")
    bears, zone, bars = warnings_of(run, GOOD)
    assert "Tip-edge contact at 24 of 24 positions" in bears and "relieve the tips" in bears
    assert f"ξ = −{-run.inner_path[0]:.2f} mm" in zone
    assert "There are no error bars" in bars
    failed = replace(quiet, errors=EstimatedErrors(missing="It rained."))
    assert warnings_of(failed, GOOD) == ("There are no error bars. It rained.",)
    without = failed.scene.model_copy(update={"output": failed.scene.output.model_copy(update={"error_bars": False})})
    assert warnings_of(replace(failed, scene=without), GOOD) == ()


def test_warning_of_a_coarse_mesh_agrees_with_the_error_bar(quiet: RunData) -> None:
    """1.7 elements across and a bar of 4.6 % of the largest pressure: the sentence says what the bar is of, with its
    number, and what it is not of."""
    peak = friction_rows(quiet)[0].max_pressure_MPa
    bars = EstimatedErrors((FigureErrors(0.046 * peak, 1.0, *[1e-3] * 5),), "", "")
    (said,) = warnings_of(replace(quiet, errors=bars), MeshFacts(0.3, 1.7, 1.2))
    assert "pressures of single positions may be off by 15 %" in said
    assert "the largest one is known within its error bar, 4.6 %, but not where it occurs" in said


def test_figures_with_large_error_bars_are_warned_of(quiet: RunData) -> None:
    """A bar of 1.1 times the largest pressure, of 0.4 times the mean one: the first is said not to be known, with both
    numbers; the second is not mentioned."""
    row = friction_rows(quiet)[0]
    bars = FigureErrors(1.1 * row.max_pressure_MPa, 0.4 * row.mean_pressure_MPa, *[1e-3] * 5)
    (said,) = warnings_of(replace(quiet, errors=EstimatedErrors((bars,), "", "")), GOOD)
    known = f"largest pressure {brief(row.max_pressure_MPa)} ±"
    assert said.startswith(f"Not known, since the error bar exceeds half of the value: {known}")
    assert "mean" not in said


def test_warnings_are_in_the_summary(quiet: RunData, tmp_path: Path) -> None:
    """summary.json has the same sentences."""
    write_tables(RunFolder(tmp_path), summary(quiet, replace(FACTS, mesh=MeshFacts(0.3, 1.2, 0.8))))
    found = json.loads((tmp_path / "summary.json").read_text(encoding="utf-8"))["warnings"]
    assert found == list(warnings_of(quiet, MeshFacts(0.3, 1.2, 0.8))) and "1.2 elements" in found[0]


@pytest.mark.parametrize("order", [1, 2])
def test_cells_across_the_contact_are_elements_of_any_order(order: int) -> None:
    """Problem: He's pair with two elements across the Hertz width of a single pair, meshed by cells of either order.
    The load is shared by two pairs about the ends of the path, where the contact is 0.7 as wide: 1.3 to 2.2 elements,
    of either order; counted by halves of second-order cells those of order 1 would be half as many."""
    scene = spur_scene("mesh.elements_per_contact_width=2", f"mesh.order={order}", "sweep.positions=4")
    run = solved_run(scene, pitch_of(scene), MPI.COMM_SELF, gear_mesh)
    assert run is not None
    assert 1.3 < cells_across(run) < 2.4


def test_mesh_command_warns_of_distorted_cells(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """`evolvent mesh` of first-order triangles: their quality with two digits, and the warning; none for hexahedra."""
    for shape, warned in (("tetrahedron", True), ("hexahedron", False)):
        out = tmp_path / f"{shape}.msh"
        scene = ["demos/he2022.toml", "--level", "quick", "--set", f"mesh.shape={shape}", "--set", "mesh.order=1"]
        assert main(["mesh", *scene, "--out", str(out)]) == Exit.DONE
        said = capsys.readouterr()
        assert ("below 0.05" in said.err) == warned
        assert "Jacobian 0.017" in said.out or not warned
