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
    return excitation_facts("a mesh", "quick", excitation, companion)


def test_design_load_between_torques() -> None:
    """Exact: DESIGN, though no torque that was solved is nearer than 230 N to it; nothing is left there."""
    found = facts(mesh())
    assert found.design_torque_Nm == pytest.approx(1e-3 * DESIGN * RADIUS, rel=1e-5)
    assert found.design_peak_to_peak_um == pytest.approx(0.0, abs=1e-4)
    assert found.design_peak_to_peak_um_error is None and found.design_from_Nm is None
    assert found.torques_Nm == pytest.approx((35.0, 70.0, 105.0, 140.0, 175.0))


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
