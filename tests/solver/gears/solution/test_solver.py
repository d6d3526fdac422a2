"""Gear pairs from Python: the same figures as a run of the same scene, errors, the figures of docs/gears_api.md."""

from __future__ import annotations

import json
import re
import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mpi4py import MPI

from evidence.solved_run import solved_run
from evolvent.gears import (
    CoarseContactWarning,
    ExtendedChartWarning,
    FlankChart,
    GearOptions,
    GearProblem,
    MeshSettings,
    condense,
    solve_pitch,
    solve_pitches,
    solve_single_position,
)
from evolvent.gears.gear_model import GearModel
from evolvent.gears.meshing.sector_meshes import gear_mesh
from evolvent.gears.solution import certified_pitch, solver
from evolvent.gears.solution.certificates import PitchImbalance, certify_pitch
from evolvent.results.archive.archive import Archive
from evolvent.results.mesh_facts import cells_across
from evolvent.results.tables.figure_rows import friction_rows, position_rows
from evolvent.run.kept_pitch import pitch_of
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene, load_scene
from evolvent.wear import Archard, wear_study, wearing_pair
from evolvent_meshes.errors import InputError
from tests.support.checkout import ROOT
from tests.support.gear_cases import QUIET, helical_scene, spur_scene
from tests.support.gears_api_curve import he_problem
from tests.support.running.processes import RunScript, on_ranks

POSITIONS, FRICTIONS = 4, (0.0, 0.1)


@pytest.fixture(scope="module")
def gears() -> GearModel:
    """He's spur pair, condensed on this rank."""
    return condense(he_problem(), MPI.COMM_SELF)


@pytest.mark.parametrize("ranks", on_ranks(1, 2))
def test_curve_of_the_api_equals_that_of_a_run(run_script: RunScript, tmp_path: Path, ranks: int) -> None:
    """Problem: He's pair at level quick, four positions, without friction and at μ = 0.1, once by `evolvent run` and
    once by the API, on as many ranks. Exact: the same transmission errors, to 1e-9, to which Newton's method
    repeats in two processes (docs/checks.md); and no module of scenes is imported."""
    settings = [*QUIET, f"sweep.positions={POSITIONS}", f"contact.friction={list(FRICTIONS)}", "mesh.level='quick'"]
    words = [word for setting in settings for word in ("--set", setting)]
    out = tmp_path / "run"
    done = run_script("-m", "evolvent", "run", "demos/he2022.toml", "--out", str(out), "--quiet", *words, ranks=ranks)
    assert done.returncode == 0, done.stderr[-3000:]
    scene = load_scene(ROOT / "demos/he2022.toml", settings)
    positions = Archive(out, scene).read_positions(scene.gear_pair())
    expected = [[position.results[i].transmission_error for position in positions] for i in range(len(FRICTIONS))]
    done = run_script("tests/support/gears_api_curve.py", str(POSITIONS), *map(str, FRICTIONS), ranks=ranks)
    assert done.returncode == 0, done.stderr[-3000:]
    found: dict[str, Any] = json.loads(done.stdout)
    np.testing.assert_allclose(found["curves"], expected, rtol=1e-9, atol=0.0)
    assert found["scenes"] == []


def test_figures_of_the_page_are_those_of_its_program() -> None:
    """The first program in docs/gears_api.md, a whole calculation, has at most 20 lines and gives the figures that the
    page states below it."""
    text = (ROOT / "docs/gears_api.md").read_text(encoding="utf-8")
    program = re.findall(r"```python\n(.*?)```", text, re.DOTALL)[0]
    assert len(program.splitlines()) <= 20
    names: dict[str, Any] = {}
    exec(compile(program, "gears_api.md", "exec"), names)
    stated = re.search(r"It prints ([\d.]+) µm and ([\d.]+) %", text)
    assert stated is not None
    pitch = names["pitch"]
    assert stated.groups() == (
        f"{1e3 * pitch.transmission_error_peak_to_peak:.2f}", f"{100 * pitch.loss_ratio:.2f}",
    )


def test_pitch_figures_are_those_of_the_whole_gears(gears: GearModel) -> None:
    """Problem: a plane pair, solved per mm of face width. Exact: the torque on the pinion is that of the problem, and
    input less output is the friction work."""
    pitch = solve_pitch(gears, friction=0.1, positions=POSITIONS, comm=MPI.COMM_SELF)
    np.testing.assert_allclose(pitch.torques[:, 0], 170e3, rtol=1e-9)
    lost = 1.0 - pitch.torques[:, 1].sum() / pitch.torques[:, 0].sum()  # 50/50: both turn alike
    assert lost == pytest.approx(pitch.loss_ratio, rel=1e-3)
    np.testing.assert_allclose(pitch.angles, 2.0 * np.pi / 50 / POSITIONS * np.arange(POSITIONS), rtol=1e-12)
    assert pitch.transmission_error_peak_to_peak == pytest.approx(np.ptp(pitch.transmission_error))
    assert not pitch.deflected


@pytest.mark.parametrize(
    "scene", [spur_scene("mesh.level=quick", "sweep.positions=8"), helical_scene()], ids=("spur", "helical")
)
def test_pressures_of_the_api_are_those_of_a_run(scene: Scene) -> None:
    """Problem: a spur and a helical pair at their friction coefficients, solved as a run does and by the API. Exact:
    the pressures that positions.csv and summary.json print, of each position and of the whole engagement; where tip
    edges bear; the elements across the contact."""
    run = solved_run(scene, pitch_of(scene), MPI.COMM_SELF, gear_mesh)
    assert run is not None
    pitches = solve_pitches(
        condense(gear_problem(scene), MPI.COMM_SELF), run.frictions, len(run.positions), MPI.COMM_SELF
    )
    printed = np.reshape([row.max_pressure_MPa for row in position_rows(run)], (-1, len(pitches)))
    np.testing.assert_allclose([pitch.max_pressure for pitch in pitches], printed.T, rtol=1e-9)
    edges = np.reshape([row.tip_edge for row in position_rows(run)], (-1, len(pitches)))
    np.testing.assert_array_equal([pitch.tip_edge for pitch in pitches], edges.T)
    for pitch, row in zip(pitches, friction_rows(run)):
        assert pitch.peak.pressure == pytest.approx(row.max_pressure_MPa, rel=1e-9)
        assert pitch.peak.at_zone_end == row.max_pressure_at_zone_end
        own = replace(run, positions=tuple((each[run.frictions.index(row.friction)],) for each in run.positions))
        assert pitch.cells_across == pytest.approx(cells_across(own), rel=1e-9)
        radius = run.pair.pinion.base_radius
        assert pitch.peak.roll_distance / radius == pytest.approx(np.radians(row.max_pressure_angle_deg), abs=0.05)


def test_contact_of_few_elements_is_warned_of_once(gears: GearModel) -> None:
    """Problem: He's pair at level quick, with 1.7 elements across the Hertz width of a single pair, at two
    coefficients. Exact: one CoarseContactWarning, at the line of the call; none from two elements on."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        pitches = solve_pitches(gears, FRICTIONS, 2, MPI.COMM_SELF)
    (found,) = (each for each in caught if issubclass(each.category, CoarseContactWarning))
    assert found.filename == __file__ and max(pitch.cells_across for pitch in pitches) < 2.0
    assert f"found {min(pitch.cells_across for pitch in pitches):.2f} (median)" in str(found.message)
    finer = condense(changed(mesh=MeshSettings("quick", elements_per_contact_width=3.0, order=1)), MPI.COMM_SELF)
    with warnings.catch_warnings():
        warnings.simplefilter("error", CoarseContactWarning)
        assert solve_pitch(finer, 0.0, 2, MPI.COMM_SELF).cells_across > 2.0


def test_extended_chart_is_warned_of() -> None:
    """Problem: a profile 1 µm low over 80 % of the face, and over the whole face. Right: `condense` warns of the first
    one at the line of its call, once for the pinion; not of the second."""
    flat, d = np.full((2, 2), 1e-3), np.array([140.0, 156.0])
    for half, count in ((8.0, 1), (10.0, 0)):
        chart = FlankChart(d, np.array([-half, half]), flat)
        charted = changed(mesh=MeshSettings("quick", order=1), flanks=(chart, None))
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            assert condense(charted, MPI.COMM_SELF).width_factor == 20.0  # still plane
        found = [each for each in caught if issubclass(each.category, ExtendedChartWarning)]
        assert len(found) == count and all(each.filename == __file__ for each in found)
        assert all("flanks, pinion: heights z = -8 to 8 mm cover 80 %" in str(each.message) for each in found)


def test_single_position_without_friction_is_that_of_the_pitch(gears: GearModel) -> None:
    """Without friction there is no history. Exact: the position alone has the pitch's transmission error."""
    pitch = solve_pitch(gears, 0.0, POSITIONS, MPI.COMM_SELF)
    alone = solve_single_position(gears, float(pitch.angles[2]))
    assert alone.transmission_error == pytest.approx(pitch.transmission_error[2], rel=1e-9)


def test_angles_of_single_positions_are_those_whose_teeth_are_searched(gears: GearModel) -> None:
    """Exact: a position repeats after a pitch, so at both ends of the allowed angles, which are further apart than a
    pitch, the transmission error is that of a pitch later or earlier; beyond them all teeth that touch, and their
    neighbours, are not searched. 5.0 is taken for degrees."""
    first, last = solver.searched_angles(gears)
    pitch = 2.0 * np.pi / gears.pair.pinion.z
    assert first < 0.0 and last > pitch
    for angle, there in ((first + 1e-9, first + 1e-9 + pitch), (last - 1e-9, last - 1e-9 - pitch)):
        errors = [solve_single_position(gears, each).transmission_error for each in (angle, there)]
        assert errors[0] == pytest.approx(errors[1], rel=1e-6)
    for angle, beyond in ((first, first - 1e-6), (last, last + 1e-6)):
        touching = gears.pair.teeth_in_contact(beyond)
        assert {touching[0] - 1, touching[-1] + 1} - set(gears.teeth), angle
    for wrong in (5.0, first - 1e-6, last + 1e-6):
        with pytest.raises(InputError, match=r"wanted a rotation \[rad\] within one engagement, .* is it in degrees\?"):
            solve_single_position(gears, wrong, 0.1)


def test_pitch_out_of_balance_is_solved_on_deflected_flanks(gears: GearModel, monkeypatch: pytest.MonkeyPatch) -> None:
    """Problem: the certificate refuses the first pitch. Exact: the pitch of the same gears on deflected flanks; and
    where that is refused too, the error."""
    calls = []

    def refuse_the_first(positions: Any) -> None:
        calls.append(1)
        if len(calls) == 1:
            raise PitchImbalance("out of balance")
        certify_pitch(positions)

    expected = solve_pitch(replace(gears, deflected=True), 0.0, 2, MPI.COMM_SELF)
    monkeypatch.setattr(certified_pitch, "certify_pitch", refuse_the_first)
    found = solve_pitch(gears, 0.0, 2, MPI.COMM_SELF)
    assert found.deflected and len(calls) == 2
    assert found.transmission_error == pytest.approx(expected.transmission_error, rel=1e-9)
    calls.clear()
    with pytest.raises(PitchImbalance):
        solve_pitch(replace(gears, deflected=True), 0.0, 2, MPI.COMM_SELF)


def changed(**values: Any) -> GearProblem:
    """He's problem with other values."""
    return replace(he_problem(), **values)


WRONG = {
    "no torque": (lambda: changed(torque=0.0), "torque: wanted a finite number > 0"),
    "torque that bends the teeth": (lambda: condense(changed(torque=1e8)), "as strains must stay small"),
    "torque without a contact": (lambda: condense(changed(torque=1e-6)), "wanted a contact with a half-width"),
    "third gear": (lambda: changed(torque_on=2), "torque_on: wanted"),
    "unknown level": (lambda: MeshSettings("rough"), "mesh level: wanted 'line' or 'quick' or 'standard' or 'fine'"),  # type: ignore[arg-type]
    "order 3": (lambda: MeshSettings(order=3), "mesh order: wanted 1 or 2"),  # type: ignore[arg-type]
    "no elements": (lambda: MeshSettings(elements_per_contact_width=0.0), "elements_per_contact_width: wanted"),
}


@pytest.mark.parametrize("name", WRONG)
def test_a_problem_that_does_not_fit_is_refused(name: str) -> None:
    """InputError with what was wanted."""
    make, words = WRONG[name]
    with pytest.raises(InputError, match=re.escape(words)):
        make()


def test_wrong_arguments_are_refused(gears: GearModel) -> None:
    """Friction outside 0 to 1 or given twice, a single position, wear on deflected flanks, reports out of order."""
    for frictions in ((-0.1,), (1.5,), (0.1, 0.1), ()):
        with pytest.raises(InputError, match="friction"):
            solve_pitches(gears, frictions, 2, MPI.COMM_SELF)
    for solve in (lambda μ: solve_pitch(gears, μ, 2), lambda μ: solve_single_position(gears, 0.0, μ)):
        with pytest.raises(InputError, match="friction: wanted a number from 0 to 1"):
            solve([0.1])
    with pytest.raises(InputError, match="positions: wanted a whole number from 2 on, found 1"):
        solve_pitch(gears, 0.0, 1, MPI.COMM_SELF)
    with pytest.raises(InputError, match="angle: wanted"):
        solve_single_position(gears, np.nan)
    deflected = changed(options=GearOptions(deflected_flanks=True))
    with pytest.raises(InputError, match="wear of gears: wanted one pitch on flanks before deflection"):
        wearing_pair(deflected, Archard(1e-10, 1e-10), comm=MPI.COMM_SELF)
    wearing = wearing_pair(he_problem(), Archard(1e-10, 1e-10), positions=2, comm=MPI.COMM_SELF)
    for reports in ((), (0.0,), (2.0, 1.0), (np.inf,)):
        with pytest.raises(InputError, match="reports: wanted"):
            next(wear_study(wearing, reports))
