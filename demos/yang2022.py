"""The helical pair of Yang et al. 2022 by the Python API: friction and the load about the pitch point.

    python demos/yang2022.py [--quick] [--out DIR]

The scene is demos/yang2022.toml; --quick takes a coarse mesh, two friction coefficients and four positions, to see
that everything works. The demo asserts that friction raises the load before the pitch point relative to that after it,
at constant pinion torque.
"""

from __future__ import annotations

import argparse
from pathlib import Path

import numpy as np
from mpi4py import MPI

from evolvent.gears.pressure.contact_slices import Slices
from evolvent.results.run_data import RunData, read_run
from evolvent.run.call import Options
from evolvent.run.compute import compute
from evolvent.run.kinds.run import Run
from evolvent.scene.scene import load_scene

SMALL = (
    'mesh.level="quick"', "mesh.elements_per_contact_width=0.7", "contact.friction=[0.07, 0.30]", "sweep.positions=4",
    "output.animation=false",
)


def main(out: Path, quick: bool = False) -> None:
    """Computes the pair into `out` and checks the trend."""
    scene = load_scene(Path(__file__).with_name("yang2022.toml"), SMALL if quick else ())
    compute(Run.of(scene), out, Options(resume=True, quiet=quick))
    if MPI.COMM_WORLD.rank == 0:
        before, after = friction_effect(read_run(out))
        print(f"sum of normal forces, lowest to highest μ: {before:+.1%} before the pitch point, {after:+.1%} after it")
        assert before > after, "friction must raise the load before the pitch point relative to that after it"


def friction_effect(run: RunData) -> tuple[float, float]:
    """Relative change of the sum of normal forces from lowest to highest μ, before and after the pitch point."""
    loads = []
    for index in (0, -1):
        cut = Slices.joined([each[index].cut for each in run.positions])
        ξ, force = cut.roll_distance, cut.line_load * cut.width
        loads.append([np.sum(force[side]) for side in (ξ < 0.0, ξ > 0.0)])
    change = np.array(loads[1]) / np.array(loads[0]) - 1.0
    return float(change[0]), float(change[1])


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--out", type=Path, default=Path("out/yang2022"))
    arguments = parser.parse_args()
    main(arguments.out, arguments.quick)
