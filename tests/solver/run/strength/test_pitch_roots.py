"""Root stress of a pair in space against that of its section."""

from __future__ import annotations

import numpy as np
import pytest

from evidence.calls import temporary_call
from evolvent.run.strength.pitch_roots import pitch_roots, root_meshes
from evolvent.scene.scene import load_scene
from evolvent.strength.strain_gauges import Gauge, gauge_strain
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member
from tests.support.checkout import ROOT

WIDTH = 60.0  # mm, nine times the tooth's height: the ends, which are free, are felt less than 1 % at mid-face
SETTINGS = (
    f"pinion.face_width_mm={WIDTH}", f"wheel.face_width_mm={WIDTH}", f"load.torque_Nm={20.0 * WIDTH}",
    "contact.friction=0", "mesh.level=quick", "sweep.positions=2",
)


def strains(*settings: str) -> Floats:
    """Largest of both gears, by a short gauge at mid-face where the profile is at 44°."""
    scene = load_scene(ROOT / "demos/zhang2023.toml", [*SETTINGS, *settings])
    with temporary_call() as call:
        (gears,) = pitch_roots(call, scene, root_meshes(scene)[0], []).roots
    gauges = [Gauge(member, True, np.radians(44.0), 0.0, 0.3) for member in Member]
    found = [gauge_strain(gauge, gears[gauge.member], scene.materials()[gauge.member]).max() for gauge in gauges]
    return np.array(found)


@pytest.mark.evidence
@pytest.mark.slow
def test_wide_gears_have_the_strain_of_their_section_at_mid_face() -> None:
    """Zhang's pair with faces of 60 mm under as much torque per mm: 1 %. Exact for infinite ones."""
    assert strains('exact.parts=["plane"]') == pytest.approx(strains(), rel=0.01)
