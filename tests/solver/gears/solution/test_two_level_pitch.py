"""Gears whose flanks have levels of their own, from the public API: what is refused, and a position with friction.

Yang's pair, 1.4 mm wide.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from evolvent.gears import GearOptions, GearPair, GearProblem, MeshSettings, condense, solve_single_position
from evolvent.wear.gears.meshed_pair import MeshedPair
from evolvent_meshes.input_checks import InputError
from tests.support.paper_pairs import yang


def narrow(mesh: MeshSettings, options: GearOptions = GearOptions()) -> GearProblem:  # noqa: B008  frozen
    pinion, wheel = (replace(gear, face_width=1.4) for gear in yang().gears)
    wheel = replace(wheel, bore_diameter=126.0)  # a disc 2 mm thick would bend under the axial force
    return GearProblem(GearPair(pinion, wheel, yang().centre_distance), 4e3, mesh=mesh, options=options)


def test_cells_and_options_without_levels_are_refused() -> None:
    """Each message says what was wanted and what to leave out."""
    with pytest.raises(InputError, match="two_level: wanted hexahedra of order 2, found tetrahedron, order 2"):
        MeshSettings("quick", shape="tetrahedron", two_level=True)
    with pytest.raises(InputError, match="two_level: wanted without whole_gears and fine_body"):
        narrow(MeshSettings("quick", two_level=True), GearOptions(whole_gears=True))


@pytest.mark.evidence
def test_two_levels_and_one_give_the_same_position() -> None:
    """At μ = 0.2 with 1.5 elements across the contact, against a mesh of one level with other cells: the transmission
    error within 0.2 %, both torques within 0.1 %; balanced as `certify` wants it. Wear refuses such gears."""
    gears = condense(narrow(MeshSettings("quick", 1.5, two_level=True)))
    found = solve_single_position(gears, 0.0, 0.2)
    wanted = solve_single_position(condense(narrow(MeshSettings("quick", 1.5))), 0.0, 0.2)
    assert len(gears.bodies[0].flank.points) > 500
    assert found.transmission_error == pytest.approx(wanted.transmission_error, rel=2e-3)
    assert np.array(found.torques) == pytest.approx(np.array(wanted.torques), rel=1e-3)
    with pytest.raises(InputError, match="flanks are those of their meshes, found flanks with levels"):
        MeshedPair.of(gears)
