"""He's spur pair by the Python API, without a scene; run by tests, on one rank or several.

    gears_api_curve.py POSITIONS FRICTION ...

The first rank prints JSON: transmission errors [mm] at each friction coefficient, and which modules of scenes were
imported.
"""

from __future__ import annotations

import json
import sys

from mpi4py import MPI

from evolvent.gears import GearPair, GearParameters, GearProblem, MeshSettings, condense, solve_pitches


def he_problem() -> GearProblem:
    """The pair of demos/he2022.toml at level quick, under 170 N·m."""
    gear = GearParameters.from_rack(
        z=50, normal_module=3.0, normal_pressure_angle_deg=20.0, face_width=20.0, bore_diameter=70.0,
    )
    return GearProblem(GearPair(gear, gear, 150.0), torque=170e3, mesh=MeshSettings("quick"))


def main(positions: int, frictions: list[float]) -> None:
    """Prints the curves."""
    pitches = solve_pitches(condense(he_problem()), frictions, positions)
    curves = [pitch.transmission_error.tolist() for pitch in pitches]
    scenes = sorted(name for name in sys.modules if name.startswith(("evolvent.scene", "pydantic")))
    if MPI.COMM_WORLD.rank == 0:
        print(json.dumps({"curves": curves, "scenes": scenes}))


if __name__ == "__main__":
    main(int(sys.argv[1]), [float(word) for word in sys.argv[2:]])
