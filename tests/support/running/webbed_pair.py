"""A narrow helical pair whose wheel has a web, and a script that prints its transmission errors on any number of ranks.

    webbed_pair.py POSITIONS FRICTION ...
"""

from __future__ import annotations

import json
import sys

from mpi4py import MPI

from evolvent.gears import condense, solve_pitches
from evolvent.scene.gear_problem import gear_problem
from tests.support.gear_cases import helical_scene

WEB = (
    "wheel.rim_thickness_mm=4", "wheel.web_thickness_mm=3", "wheel.web_offset_mm=0.5", "wheel.hub_diameter_mm=52",
)
"""Of `helical_scene`, whose wheel has a face of 8 mm, a root circle of 69.1 mm and a bore of 44 mm."""


def main(positions: int, frictions: list[float]) -> None:
    """The first rank prints JSON: transmission errors [mm] at each friction coefficient."""
    pitches = solve_pitches(condense(gear_problem(helical_scene(*WEB))), frictions, positions)
    if MPI.COMM_WORLD.rank == 0:
        print(json.dumps([pitch.transmission_error.tolist() for pitch in pitches]))


if __name__ == "__main__":
    main(int(sys.argv[1]), [float(word) for word in sys.argv[2:]])
