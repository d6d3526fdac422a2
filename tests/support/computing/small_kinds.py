"""Every computation of a small scene: He's spur pair in plane strain, four positions on coarse meshes.

`python -m tests.support.computing.small_kinds OUT` computes all of them into folders below OUT, on all ranks.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from evolvent.run.computation import Computation
from evolvent.run.kinds.all import KINDS, Kind
from tests.support.computing.quiet import quietly
from tests.support.gear_cases import spur_scene

SMALL = (
    "mesh.level=quick", "sweep.positions=4", "contact.friction=[0.1]", "output.error_bars=true",
    "output.animation=false", "output.fields=false",
)
MORE: Mapping[str, tuple[str, ...]] = {
    "wear": ("wear.cycles=1e5", "wear.pinion_mm2_per_N=1e-12", "wear.wheel_mm2_per_N=1e-12"),
    "design": (
        'design.vary=[["both.tip_relief_um",4.0,24.0,10.0]]', 'design.tolerances=[["pinion.tip_relief_um",2.0]]',
        'design.limits=[["loss_percent",5.0]]',
    ),
    "dynamics": ("dynamics.speeds=3", "dynamics.torque_percents=[50,100]", "dynamics.backlash_um=50"),
    "transient": ("transient.speeds_rpm=[1000,2000]", "transient.mesh_periods=3"),
}
"""Keys that a computation wants beside `SMALL`."""


def small(kind: Kind, *settings: str) -> Computation[Any]:
    """A computation of the small scene."""
    return kind.load().of(spur_scene(*SMALL, *MORE.get(kind.name, ()), *settings), (50.0, 100.0))


if __name__ == "__main__":
    for each in KINDS:
        quietly(small(each), Path(sys.argv[1]) / each.name)
