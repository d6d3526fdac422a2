"""The load that a relief fits, of a mesh in closed form."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from evolvent.dynamics.excitation.force_surface import MeshExcitation
from evolvent.dynamics.excitation.loaded_mesh import LoadedMesh
from evolvent.dynamics.results.curves import NO_COMPANION, CoarseExcitation
from evolvent.dynamics.results.design_load import EXCITATION_FACTS, ExcitationFacts, excitation_facts
from evolvent.results.archive.run_folder import RunFolder
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.pair import GearPair
from tests.support.gear_cases import spur_scene

RADIUS, STIFFNESS, DESIGN = 70.0, 400e3, 1730.0
COSINE = np.cos(2.0 * np.pi * np.arange(24) / 24)


def mesh(size: float = 2e-3, forces: tuple[float, ...] = (500.0, 1000.0, 1500.0, 2000.0, 2500.0)) -> MeshExcitation:
    """A deflection F (1 + a cos τ)/k on flanks with e = −b cos τ, so that the transmission error is even where
    F a/k = b: at DESIGN; its peak-to-peak value is 2 b |F/DESIGN − 1|."""
    loads = np.array(forces)
    softness = (1.0 + size * STIFFNESS / DESIGN * COSINE) / STIFFNESS
    error = -size * COSINE
    stiffness = np.repeat(1.0 / softness[:, None], len(loads), axis=1)
    loaded = LoadedMesh(
        np.arange(24.0), RADIUS * loads, RADIUS, error[:, None] + loads * softness[:, None], stiffness
    )
    return MeshExcitation(error, loaded)


def facts(excitation: MeshExcitation, companion: CoarseExcitation = NO_COMPANION) -> ExcitationFacts:
    return excitation_facts("a mesh", "quick", excitation, companion, spur_scene().gear_pair(), (206e3, 206e3))


def test_design_load_between_torques() -> None:
    """Exact: DESIGN, though no torque that was solved is nearer than 230 N to it; nothing is left there."""
    found = facts(mesh())
    assert found.design_torque_Nm == pytest.approx(1e-3 * DESIGN * RADIUS, rel=1e-5)
    assert found.design_peak_to_peak_um == pytest.approx(0.0, abs=1e-4)
    assert found.design_peak_to_peak_um_error is None and found.design_from_Nm is None
    assert found.torques_Nm == pytest.approx((35.0, 70.0, 105.0, 140.0, 175.0))


def curved(forces: tuple[float, ...]) -> MeshExcitation:
    """A deflection F/k + a √(F F_0) cos τ on flanks with e = −b cos τ: its peak-to-peak value, 2 |a √(F F_0) − b|, has
    its least at F = (b/a)²/F_0 = 4000/9 N and is curved there; b = 0.5 µm, a = 0.75 nm/N, F_0 = 1 kN."""
    loads, b, a = np.array(forces), 0.5e-3, 0.75e-6
    swing = a * np.sqrt(1000.0 * loads)
    error = -b * COSINE
    depths = loads / STIFFNESS + COSINE[:, None] * swing
    stiffness = 1.0 / (1.0 / STIFFNESS + COSINE[:, None] * swing / (2.0 * loads))
    loaded = LoadedMesh(np.arange(24.0), RADIUS * loads, RADIUS, error[:, None] + depths, stiffness)
    return MeshExcitation(error, loaded)


def test_error_of_the_design_load_holds_what_interpolation_adds() -> None:
    """Problem: torques far apart beside the least value, which lies between two of them; at each the mesh and its
    companion agree. Exact: 0 at 4000/9 N; the error, which is that of interpolation alone, holds it, and the value
    under the torque that was found."""
    for forces in ((100.0, 250.0, 900.0, 2500.0), (100.0, 300.0, 600.0, 1200.0, 2500.0)):
        excitation = curved(forces)
        found = facts(excitation, CoarseExcitation(excitation))
        assert found.design_torque_Nm is not None and found.design_peak_to_peak_um is not None
        exact = 2e3 * abs(0.75e-6 * np.sqrt(1e6 * found.design_torque_Nm / RADIUS) - 0.5e-3)
        error = found.design_peak_to_peak_um_error
        assert error is not None and abs(found.design_peak_to_peak_um - exact) < error < 1.0
        assert found.design_from_Nm is not None and found.design_to_Nm is not None
        assert found.design_from_Nm <= 1e-3 * RADIUS * 4000.0 / 9.0 <= found.design_to_Nm


def test_two_torques_have_no_design_load() -> None:
    """Between two torques nothing says how good interpolation is."""
    assert facts(mesh(forces=(1500.0, 2000.0))).design_torque_Nm is None


def test_stiffness_stands_beside_that_of_the_standard() -> None:
    """Exact: means over the pitch under 2500 N, of 20 mm of face; softness (1 + a cos τ)/k has mean stiffness
    k/√(1 − a²). He's pair has c' = 14.05 and c_γα = 22.01 N/(mm·µm) (docs/he2022.md). Gears that the formula is not
    for, shifted by −0.2 on the smaller and 0 on the larger one, have none."""
    found, share = facts(mesh()), 2e-3 * STIFFNESS / DESIGN
    mean = 1e-3 * STIFFNESS / 20.0 / np.sqrt(1.0 - share**2)
    assert found.mean_tangent_stiffness_N_per_mm_um == pytest.approx(mean, rel=1e-6)
    assert found.mean_secant_stiffness_N_per_mm_um == pytest.approx(mean, rel=1e-6)
    assert found.iso_single_stiffness_N_per_mm_um == pytest.approx(14.05, abs=0.01)
    assert found.iso_mesh_stiffness_N_per_mm_um == pytest.approx(22.01, abs=0.01)
    small, large = (
        GearParameters.from_rack(z=z, normal_module=3.0, normal_pressure_angle_deg=20.0, face_width=20.0,
                                 bore_diameter=40.0, profile_shift=x)
        for z, x in ((40, -0.2), (60, 0.0))
    )
    shifted = GearPair(small, large, 149.5)
    none = excitation_facts("a mesh", "quick", mesh(), NO_COMPANION, shifted, (206e3, 206e3))
    assert none.iso_mesh_stiffness_N_per_mm_um is None and none.iso_single_stiffness_N_per_mm_um is None


def test_range_within_the_error() -> None:
    """A companion with half as much swing again at each torque: with an error Δ of the least value the torques from
    DESIGN (1 − Δ/2b) to DESIGN (1 + Δ/2b) fit as well, to the spacing of the loads among which it is sought."""
    fine, coarse = mesh(), mesh(3e-3)
    found = facts(fine, CoarseExcitation(MeshExcitation(fine.unloaded_error, coarse.loaded)))
    error = found.design_peak_to_peak_um_error
    assert error is not None and error > 0.1
    share = error / 4.0
    for edge, exact in ((found.design_from_Nm, 1.0 - share), (found.design_to_Nm, 1.0 + share)):
        assert edge == pytest.approx(1e-3 * RADIUS * np.clip(exact * DESIGN, 500.0, 2500.0), abs=0.5)


@pytest.mark.parametrize("forces", [(500.0, 1000.0, 1500.0), (2000.0, 2500.0), (1000.0,)])
def test_no_design_load_at_an_end(forces: tuple[float, ...], tmp_path: Path) -> None:
    """Where the value still falls at the lightest or the heaviest torque there is none: null in the file."""
    EXCITATION_FACTS.write(RunFolder(tmp_path), facts(mesh(forces=forces)))
    kept = json.loads((tmp_path / "excitation.json").read_text(encoding="utf-8"))
    assert kept["design_torque_Nm"] is None and kept["title"] == "a mesh" and kept["positions"] == 24
