"""Error bars: that they hold the true errors, shrink with the mesh, come back from disk, and never cost a run."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mpi4py import MPI

from evidence.benchmarks.accuracy.error_bars import FIGURES, BarRow, hit_rate, measure_bars, spur_problem
from evidence.solved_run import solved_run
from evolvent.contact.newton.snes import NotConverged
from evolvent.gears.gear_model import Mesher
from evolvent.gears.meshing.companion_meshes import coarser, companion_mesh
from evolvent.gears.meshing.sector_meshes import gear_mesh
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.results.archive.archive import Archive
from evolvent.results.archive.error_bar_data import (
    METHOD,
    NOT_ESTIMATED,
    EstimatedErrors,
    FigureErrors,
    plus_minus,
    read_error_bars,
    write_error_bars,
)
from evolvent.results.engagement import engagement
from evolvent.results.error_bars.estimation import Companion, errors_between, estimated_errors
from evolvent.results.position_figures import transmission_error_um
from evolvent.results.run_data import RunData, SolvedPosition, read_run
from evolvent.run.kept_pitch import pitch_of
from evolvent.run.kinds.run import Run
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent_meshes.gears.member import Member
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.mesh.splitting import halved
from evolvent_meshes.sector.section import SectorResolution
from tests.support.computing.quiet import prepared_without, quietly
from tests.support.gear_cases import spur_scene
from tests.support.running.processes import BROKEN_RUN, RunScript
from tests.support.synthetic_run import synthetic_run

SHORT = ("mesh.level=quick", "contact.friction=[0.0, 0.2]", "sweep.positions=4",
         "output.error_bars=true")
"""He's pair, a second or so."""
PLANE_FIGURES = tuple(name for name in FIGURES if name != "face_load_factor")
"""Figures of a pair in plane strain that are not known beforehand."""
OUTPUT = ("output.pictures=false", "output.animation=false", "output.fields=false")


@pytest.fixture(scope="module")
def rows() -> list[BarRow]:
    return measure_bars(spur_problem(widths=(1.7, 3.0, 6.0), positions=4, frictions=(0.0, 0.2)))


@pytest.mark.evidence
@pytest.mark.slow
def test_nine_in_ten_error_bars_hold_the_true_error(rows: list[BarRow]) -> None:
    """Problem: He's spur pair on 12 meshes (1.7, 3 and 6 elements across the contact, quadrilaterals and triangles,
    orders 1 and 2), μ = 0 and 0.2. Exact: 48 second-order elements across, within a few per cent of the bars. Nine in
    ten bars hold the true error, of all figures together and of each."""
    assert len(rows) == 12 * (2 * len(PLANE_FIGURES) - 1)
    assert np.mean([row.reference_error <= 0.1 * row.bar for row in rows]) > 0.9  # the reference can tell
    assert hit_rate(rows) >= 0.9
    for figure in PLANE_FIGURES:
        assert hit_rate([row for row in rows if row.figure == figure]) >= 0.9, figure


@pytest.mark.evidence
@pytest.mark.slow
def test_error_bars_are_not_far_too_wide(rows: list[BarRow]) -> None:
    """A bar that is always far too wide would hold everything: of second-order meshes, with 3 and 6 elements across,
    no bar is above 6 % of its figure, and in the median one is at most 6 times the true error."""
    good = [row for row in rows if "order=2" in row.case and "width=1.7" not in row.case]
    assert max(row.bar / row.value for row in good) < 0.06
    assert np.median([row.bar / row.error for row in good]) < 6.0


def test_error_bars_shrink_with_the_mesh() -> None:
    """He's pair at standard, and with every element halved in its own grading. Bars of transmission error and secant
    shrink to a quarter at least (p >= 2), those of pressures, loss and tangent, which jumps where a quadrature point
    opens or closes, to two thirds at least."""
    scene = spur_scene("mesh.level=standard", "contact.friction=[0.2]", "sweep.positions=4")
    coarse, own, fine = (solved(scene, mesh) for mesh in (companion_mesh, gear_mesh, finer_mesh))
    (wide,), (narrow,) = errors_between(own, coarse), errors_between(fine, own)
    assert narrow.face_load_factor == wide.face_load_factor == 0.0
    ratio = {name: getattr(narrow, name) / getattr(wide, name) for name in PLANE_FIGURES}
    assert max(ratio.values()) < 2.0 / 3.0, ratio
    assert ratio["transmission_error_peak_to_peak_um"] < 0.25 and ratio["secant_stiffness_N_per_mm_um"] < 0.25, ratio


def finer_mesh(problem: GearProblem, member: Member) -> MeshData:
    def twice(own: SectorResolution) -> SectorResolution:
        upper, middle, lower = own.layer_depths
        return replace(
            own,
            layer_depths=(0.5 * upper, 0.5 * middle, 0.5 * lower),
            profile_elements=2 * own.profile_elements,
            neck_elements=2 * own.neck_elements,
            fillet_elements=2 * own.fillet_elements,
            back_elements=2 * own.back_elements,
            core_elements=2 * own.core_elements,
            rim_elements=2 * own.rim_elements,
        )

    return gear_mesh(problem, member, adapted=twice)


def solved(scene: Scene, mesh: Mesher) -> RunData:
    run = solved_run(scene, pitch_of(scene), MPI.COMM_SELF, mesh)
    assert run is not None
    return run


def test_hertz_pressures_have_no_error() -> None:
    """Problem: a made-up run of the Yang pair whose slices carry Hertz's pressure exactly, with itself as companion.
    Exact: no error in transmission error, stiffness and loss; in the pressures only that of sampling the ellipse."""
    run = synthetic_run("contact.friction=[0.0, 0.1]")
    for errors in errors_between(run, run):
        assert errors.transmission_error_peak_to_peak_um == errors.mesh_stiffness_N_per_mm_um == 0.0
        assert errors.loss_percent == 0.0 and errors.face_load_factor < 1e-12
        assert errors.max_pressure_MPa < 0.02 * 1500.0


def test_wider_tip_edge_zones_of_the_companion_make_no_error() -> None:
    """Problem: the same, but the companion sees the tip edges from half a millimetre further away, as larger cells do,
    and has no fitted peak there. Exact: its loads are the same, so there is no error still; the peak at the end of its
    own zone is 4 % lower."""
    run = synthetic_run("contact.friction=[0.0, 0.1]")
    low, high = run.inner_path

    def blind(solved: SolvedPosition) -> SolvedPosition:
        edge = (solved.cut.roll_distance < low + 0.5) | (solved.cut.roll_distance > high - 0.5)
        return replace(solved, cut=replace(solved.cut, edge=edge, peak=np.where(edge, np.nan, solved.cut.peak)))

    companion = replace(run, positions=tuple(tuple(blind(solved) for solved in each) for each in run.positions))
    assert companion.inner_path[0] > low + 0.4
    peaks = [np.nanmax(engagement(each, 0).max_pressure) for each in (run, companion)]
    assert peaks[1] < 0.97 * peaks[0]
    for errors in errors_between(run, companion):
        assert errors.max_pressure_MPa < 0.02 * 1500.0
        assert errors.mean_pressure_MPa < 0.02 * 1500.0


def test_companion_without_contact_gives_no_error_bars() -> None:
    """A companion in which nothing touches has no figures: no bars, and the reason, but no exception."""
    run = synthetic_run("contact.friction=[0.0, 0.1]")
    bare = tuple(tuple(replace(solved, teeth=()) for solved in each) for each in run.positions)
    found = estimated_errors(run, Companion(replace(run, positions=bare), "", 0.0))
    assert found.figures == () and "cannot be compared" in found.missing


def test_companion_is_compared_at_its_own_positions() -> None:
    """Problem: a made-up run of the Yang pair at six positions, and as its companion three of them. Exact: no error in
    transmission error, stiffness, loss and face load, though a cosine has three quarters of its peak-to-peak value at
    three positions; in the pressures the same fit of the ellipse to Hertz as with six. With positions between those of
    the run there are no bars, and the reason."""
    run = synthetic_run("contact.friction=[0.0, 0.1]")
    second = replace(run, positions=run.positions[::2])
    assert np.ptp([transmission_error_um(run, each[0]) for each in second.positions]) < 0.76 * np.ptp(
        [transmission_error_um(run, each[0]) for each in run.positions]
    )
    for errors, same in zip(errors_between(run, second), errors_between(run, run), strict=True):
        assert errors.transmission_error_peak_to_peak_um == errors.mesh_stiffness_N_per_mm_um == 0.0
        assert errors.loss_percent == errors.secant_stiffness_N_per_mm_um == 0.0 and errors.face_load_factor < 1e-12
        assert (errors.max_pressure_MPa, errors.mean_pressure_MPa) == (same.max_pressure_MPa, same.mean_pressure_MPa)
    between = replace(run, positions=synthetic_run("sweep.positions=7").positions[1:])
    assert "no position is common" in estimated_errors(run, Companion(between, "", 0.0)).missing


def test_companion_resolution_is_halved_in_all_directions() -> None:
    """Exact: twice the thickness, half the counts; profile elements stay a multiple of 3."""
    own = SectorResolution(profile_elements=54, face_elements=12, fillet_elements=8, back_elements=6, neck_elements=4)
    half = coarser(own)
    assert (half.profile_elements, half.face_elements, half.neck_elements) == (27, 6, 2)
    assert (half.fillet_elements, half.back_elements, half.core_elements, half.rim_elements) == (4, 3, 1, 2)
    assert half.layer_depths == pytest.approx([2.0 * depth for depth in own.layer_depths])


def test_halved_mesh_keeps_the_body() -> None:
    """Exact: four times the cells and twice the facets of each group; the old nodes are nodes still."""
    scene = spur_scene("mesh.level=quick")
    own = gear_mesh(gear_problem(scene), Member.PINION)
    fine = halved(own)
    assert len(fine.cells) == 4 * len(own.cells)
    assert {n: len(f) for n, f in fine.facets.items()} == {n: 2 * len(f) for n, f in own.facets.items()}
    places = {tuple(p) for p in np.round(fine.points, 7)}
    assert all(tuple(p) in places for p in np.round(own.points, 7))


def test_plus_minus_rounds_the_bar_up() -> None:
    """A bar is rounded up, never down; none is written where it is not known, or where the figure is exact."""
    assert plus_minus(594.87, 12.1, 0) == "595 ± 13"
    assert plus_minus(2.5799, 0.0883, 2) == "2.58 ± 0.09"
    assert plus_minus(2.5799, float("nan"), 2) == "2.58"
    assert plus_minus(100.0, 0.0, 2) == "100.00"
    assert plus_minus(0.5925, 0.0026, 1) == "0.593 ± 0.003"
    assert plus_minus(0.5925, 1e-9, 1) == "0.5925 ± 0.0001"


def test_error_bars_are_read_as_archived(tmp_path: Path) -> None:
    """What is kept is read again number by number, NaN too, but not by another scene, nor where it was estimated
    in another way; no bars leave no file, and a broken file is none."""
    archive = Archive(tmp_path, spur_scene())
    archive.folder.mkdir()
    write_error_bars(archive, EstimatedErrors(missing="It rained."))
    assert read_error_bars(archive) is None
    errors = EstimatedErrors((FigureErrors(1.0, 2.0, float("nan"), 4.0, 5.0, 0.1 + 0.2, 0.01),), METHOD, "")
    write_error_bars(archive, errors)
    assert repr(read_error_bars(archive)) == repr(errors)
    write_error_bars(archive, replace(errors, method="guessed"))
    assert read_error_bars(archive) is None
    write_error_bars(archive, errors)
    assert read_error_bars(Archive(tmp_path, spur_scene("load.torque_Nm=99"))) is None
    (archive.folder / "errors.npz").write_bytes(b"PK half")
    assert read_error_bars(archive) is None


def test_run_reports_and_archives_its_error_bars(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A run gives every figure its bar and names the method; going on with a finished run solves nothing again."""
    scene = spur_scene(*SHORT)
    quietly(Run.of(scene), tmp_path)
    found = summary(tmp_path)
    assert (
        found["estimated_error"]["missing"] is None and "twice the element size" in found["estimated_error"]["method"]
    )
    for row in found["frictions"]:
        bars = row["estimated_error"]
        assert set(bars) == set(FIGURES)
        names = [name for name in PLANE_FIGURES if name != "loss_percent" or row["friction"]]
        assert all(0.0 < bars[name] < row[name] for name in names)
        assert (row["face_load_factor"], bars["face_load_factor"]) == (1.0, 0.0)
    quietly(Run.of(scene), tmp_path, resume=True, prepare=COMPANION_FAILS)
    assert summary(tmp_path)["frictions"] == found["frictions"]


COMPANION_FAILS = prepared_without(companion_mesh, NotConverged("it rained"))


def test_run_without_companion_gives_the_reason(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where the companion does not converge the run is complete all the same, without bars and with the reason; so it
    is where none are asked for."""
    scene = spur_scene(*SHORT)
    quietly(Run.of(scene), tmp_path, prepare=COMPANION_FAILS)
    assert "it rained" in summary(tmp_path)["estimated_error"]["missing"]
    assert [row["estimated_error"] for row in summary(tmp_path)["frictions"]] == [None, None]
    without = spur_scene(*SHORT, "output.error_bars=false")
    quietly(Run.of(without), tmp_path, resume=True)
    assert summary(tmp_path)["estimated_error"]["missing"] == "Error bars were not asked for."


def test_error_bars_follow_the_output_that_the_scene_asks_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A run with bars resumed without: summary.json, whose scene asks for none, and the run as `plot` reads it have
    none. Resumed with them: the same bars, and no companion is solved for them."""
    with_bars, without = spur_scene(*SHORT, *OUTPUT), spur_scene(*SHORT, *OUTPUT, "output.error_bars=false")
    quietly(Run.of(with_bars), tmp_path)
    first = summary(tmp_path)
    assert all(row["estimated_error"] for row in first["frictions"])
    quietly(Run.of(without), tmp_path, resume=True)
    found = summary(tmp_path)
    assert found["scene"]["output"]["error_bars"] is False
    assert [row["estimated_error"] for row in found["frictions"]] == [None, None]
    assert read_run(tmp_path).errors == NOT_ESTIMATED
    quietly(Run.of(with_bars), tmp_path, resume=True, prepare=COMPANION_FAILS)
    again, bars = summary(tmp_path), [row["estimated_error"] for row in first["frictions"]]
    assert [row["estimated_error"] for row in again["frictions"]] == bars


@pytest.mark.mpi
def test_error_bars_agree_between_numbers_of_ranks(run_script: RunScript, tmp_path: Path) -> None:
    """He's pair, two friction coefficients on 1 and 2 ranks: the same bars within 1e-6 of them."""
    settings = [part for setting in (*SHORT, *OUTPUT) for part in ("--set", setting)]
    found = []
    for ranks in (1, 2):
        out = tmp_path / str(ranks)
        arguments = (BROKEN_RUN, "ok", "demos/he2022.toml", "--out", str(out), "--quiet", *settings)
        done = run_script(*arguments, ranks=ranks)
        assert done.returncode == 0, done.stderr
        found.append([row["estimated_error"] for row in summary(out)["frictions"]])
    for one, same in zip(*found, strict=True):
        assert same == pytest.approx(one, rel=1e-6, abs=1e-12)


def summary(folder: Path) -> Any:
    return json.loads((folder / "summary.json").read_text(encoding="utf-8"))
