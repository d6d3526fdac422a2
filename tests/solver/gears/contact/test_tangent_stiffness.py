"""Tangent mesh stiffness: against two torques, with tip relief and with wear."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from mpi4py import MPI

from evidence.solved_run import solved_run
from evolvent.gears.gear_model import GearModel
from evolvent.gears.meshing.sector_meshes import gear_mesh
from evolvent.gears.sweep.position_search import SearchedAt, searched_at, shared_position
from evolvent.results.tables.figure_rows import friction_rows
from evolvent.results.tables.summary_rows import FrictionRow
from evolvent.run.kept_pitch import pitch_of
from tests.support.gear_cases import helical_scene, model_of, spur_scene, with_load

STEP = 1e-4
"""Of the torque."""
RELIEF = [
    f"{gear}.{key}"
    for gear in ("pinion", "wheel")
    for key in ("tip_relief_um=20", "tip_relief_start_diameter_mm=145")
]
"""From below the pitch circles, 150 mm, on."""


@pytest.fixture(scope="module", params=["spur, pinion", "spur, wheel", "helical"])
def model(request: pytest.FixtureRequest) -> GearModel:
    """He's pair with the torque on either gear, and a helical one with tip relief."""
    if request.param == "helical":
        return model_of(helical_scene("pinion.tip_relief_um=10", "contact.friction=[0.0]"))
    return model_of(spur_scene("mesh.level=quick", f"load.on={request.param.split()[1]}"))


@pytest.mark.parametrize("share", [0.1, 0.7])
def test_tangent_stiffness_is_the_difference_quotient_of_two_torques(share: float, model: GearModel) -> None:
    """Problem: a position under a torque 1e-4 smaller and larger, searched at the same place. Exact: the difference of
    torques over base radius by that of rotations times base radius, as long as no quadrature point opens or closes."""
    angle, load = share * 2.0 * np.pi / model.pair.pinion.z, model.load
    here = shared_position(model, angle, (0.0, 0.0), [0.0], None)
    place = SearchedAt(angle, here.contact.stand.beyond_nominal, here.contact.geometry.half_width)
    radius = model.pair.gears[load.on].base_radius
    low, high = (
        searched_at(with_load(model, factor * load.torque, load.on), place, [0.0]).smooth.motion[0]
        for factor in (1.0 - STEP, 1.0 + STEP)
    )
    wanted = 2.0 * STEP * load.torque / radius / (radius * float(high - low))
    assert here.stiffness == pytest.approx(wanted, rel=1e-9)
    assert searched_at(model, place, [0.0]).stiffness == pytest.approx(here.stiffness, rel=1e-9)


def row_of(*settings: str) -> FrictionRow:
    """Of He's pair at quick, four positions."""
    scene = spur_scene("mesh.level=quick", "sweep.positions=4", "contact.friction=0", *settings)
    run = solved_run(scene, pitch_of(scene), MPI.COMM_SELF, gear_mesh)
    assert run is not None
    return friction_rows(run)[0]


def test_tip_relief_does_not_lower_the_tangent_stiffness() -> None:
    """Problem: He's pair under a tenth of its load as designed, and with relief from below the pitch circles on, so
    that all of the path of contact lacks material. What bears is as stiff as before, 18.0 N/(mm·µm), and what is
    missing is no deflection: the force over the transmission error would be 0.55 N/(mm·µm)."""
    plain, relieved = row_of("load.torque_Nm=17"), row_of("load.torque_Nm=17", *RELIEF)
    assert plain.mesh_stiffness_N_per_mm_um == pytest.approx(1.03 * plain.secant_stiffness_N_per_mm_um, rel=0.01)
    assert relieved.mesh_stiffness_N_per_mm_um == pytest.approx(plain.mesh_stiffness_N_per_mm_um, rel=0.01)
    assert relieved.secant_stiffness_N_per_mm_um == pytest.approx(plain.secant_stiffness_N_per_mm_um, rel=0.02)


def test_worn_flanks_keep_their_tangent_stiffness(tmp_path: Path) -> None:
    """Problem: a pinion that has lost 5 µm everywhere. Exact: it turns on by as much and bears alike, so that its mesh
    stiffnesses, tangent and secant, are those of the unworn one."""
    chart = tmp_path / "worn.csv"
    rows = "".join(f"{diameter},5.0\n" for diameter in (120.0, 150.0, 170.0))
    chart.write_text("diameter_mm,depth_um\n" + rows, encoding="utf-8")
    new, worn = row_of(), row_of(f"pinion.flank_csv={chart}")
    assert worn.mesh_stiffness_N_per_mm_um == pytest.approx(new.mesh_stiffness_N_per_mm_um, rel=1e-3)
    assert worn.secant_stiffness_N_per_mm_um == pytest.approx(new.secant_stiffness_N_per_mm_um, rel=1e-3)


def test_tangent_stiffness_hardly_depends_on_the_load(model: GearModel) -> None:
    """A Hertz contact hardens with the logarithm of its load: under three times the torque the tangent is larger, but
    by less than half, for teeth bend more than they flatten."""
    place = shared_position(model, 0.02, (0.0, 0.0), [0.0], None)
    less = shared_position(with_load(model, 0.3 * model.load.torque, model.load.on), 0.02, (0.0, 0.0), [0.0], None)
    assert less.stiffness < place.stiffness < 1.5 * less.stiffness
