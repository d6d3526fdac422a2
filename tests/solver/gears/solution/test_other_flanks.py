"""Condensed gears with other flank modifications, from Python."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from evolvent.dynamics.solution.mesh_excitation import mesh_excitation
from evolvent.gears.solution.other_flanks import with_modifications
from evolvent_meshes.errors import InputError
from evolvent_meshes.gears.pair import GearPair
from tests.support.gear_cases import model_of, spur_scene

RELIEVED = ("pinion.tip_relief_um=20", "wheel.tip_relief_um=20")


def pair_of(*settings: str) -> GearPair:
    return spur_scene(*settings).gear_pair()


def test_figures_are_those_of_gears_condensed_with_the_modifications() -> None:
    """He's pair, condensed without relief and with 20 µm: the same transmission error, stiffness and pressure."""
    bare = with_modifications(model_of(spur_scene("mesh.level=line")), pair_of(*RELIEVED))
    own = model_of(spur_scene("mesh.level=line", *RELIEVED))
    found, wanted = (mesh_excitation(gears, [85e3, 170e3], 4) for gears in (bare, own))
    assert found.transmission_error == pytest.approx(wanted.transmission_error, rel=1e-9)
    assert found.tangent_stiffness == pytest.approx(wanted.tangent_stiffness, rel=1e-9)
    assert found.largest_pressure == pytest.approx(wanted.largest_pressure, rel=1e-9)
    assert found.unloaded_error == pytest.approx(wanted.unloaded_error, abs=1e-12)


def test_what_differs_otherwise_is_refused() -> None:
    """Another face width, a lead crowning in the plane, gears whose contact is resolved, no pair at all."""
    line = model_of(spur_scene("mesh.level=line"))
    pair = pair_of()
    narrow = replace(pair, pinion=replace(pair.pinion, face_width=10.0), wheel=replace(pair.wheel, face_width=10.0))
    for other, said in ((narrow, "found other gears"), (pair_of("pinion.lead_crowning_um=5"), "alike over the face")):
        with pytest.raises(InputError, match=said):
            with_modifications(line, other)
    with pytest.raises(InputError, match="whose contact is resolved"):
        with_modifications(model_of(spur_scene("mesh.level=quick")), pair)
    with pytest.raises(InputError, match="GearPair"):
        with_modifications(line, "pair")  # type: ignore[arg-type]


def test_plane_gears_have_no_face_load_factor() -> None:
    """Refused, as are the pressures of a resolved contact."""
    found = mesh_excitation(model_of(spur_scene("mesh.level=line", *RELIEVED)), [170e3], 4)
    with pytest.raises(InputError, match="in the plane"):
        assert found.face_load_factor
    resolved = mesh_excitation(model_of(spur_scene("mesh.level=quick", *RELIEVED)), [170e3], 3)
    with pytest.raises(InputError, match="solve_pitch has their pressures"):
        assert np.isfinite(resolved.largest_pressure).all()
