"""Transmission error of the spur pair of He et al. 2022 over an angular pitch, with and without friction, from Python.

    python demos/transmission_error.py [--quick] [--out DIR]

No scene file: gears, torque, friction and mesh level are given as Python objects, and the curve is a NumPy array. Two
figures are checked: the stiffness of a single tooth pair against the 14 N/(mm µm) of ISO 6336-1, and the power that is
lost between the shafts against the work of friction.
"""

from __future__ import annotations

import csv
from pathlib import Path

import matplotlib
import numpy as np
import typer
from mpi4py import MPI

from evolvent.gears import GearPair, GearParameters, GearProblem, MeshSettings, PitchSolution, condense, solve_pitches

FACE_WIDTH = 20.0  # mm
TORQUE, FRICTIONS = 170e3, (0.0, 0.1)  # N·mm on the pinion
ISO_STIFFNESS = 14.0  # c' of a steel tooth pair [N/(mm µm)], ISO 6336-1
STIFFNESS_BOUND, LOSS_BOUND = 0.15, 1e-3  # relative; of the input power


def solved(mesh: MeshSettings, positions: int) -> tuple[PitchSolution, ...]:
    """The whole calculation: a pitch at each friction coefficient."""
    gear = GearParameters.from_rack(
        z=50,
        normal_module=3.0,  # mm
        normal_pressure_angle_deg=20.0,
        face_width=FACE_WIDTH,
        bore_diameter=70.0,
    )
    pair = GearPair(pinion=gear, wheel=gear, centre_distance=150.0)
    gears = condense(GearProblem(pair, TORQUE, mesh=mesh))
    return solve_pitches(gears, FRICTIONS, positions)


def main(out: Path = Path("out/transmission_error"), quick: bool = False) -> None:
    """Solve, print the curve, write table.csv and transmission_error.png. Raises AssertionError outside a bound."""
    smooth, rough = solved(MeshSettings("quick" if quick else "standard"), positions=8 if quick else 40)
    curves = [np.degrees(smooth.angles), 1e3 * smooth.transmission_error, 1e3 * rough.transmission_error]
    table = [("rotation [°]", *(f"μ = {μ:g} [µm]" for μ in FRICTIONS))]
    table += [tuple(f"{value:.4f}" for value in row) for row in zip(*curves)]
    if MPI.COMM_WORLD.rank == 0:
        out.mkdir(parents=True, exist_ok=True)
        with open(out / "table.csv", "w", newline="", encoding="utf-8") as file:
            csv.writer(file).writerows(table)
        print("\n".join(f"{row[0]:<14}" + "".join(f"{cell:>16}" for cell in row[1:]) for row in table))
        draw(out / "transmission_error.png", smooth, rough)
    check(smooth, rough)


def check(smooth: PitchSolution, rough: PitchSolution) -> None:
    """Raises AssertionError where a figure is outside its bound."""
    stiffness = smooth.mesh_stiffness.min() / FACE_WIDTH / 1e3
    assert abs(stiffness / ISO_STIFFNESS - 1.0) < STIFFNESS_BOUND, (
        f"single tooth pair: wanted {ISO_STIFFNESS} N/(mm µm) within {STIFFNESS_BOUND:.0%}, found {stiffness:.2f}"
    )
    for pitch in (smooth, rough):
        power_in, power_out = pitch.torques[:, 0].sum(), pitch.torques[:, 1].sum()  # both gears turn alike, 50/50
        difference = abs((power_in - power_out) / power_in - pitch.loss_ratio)
        assert difference < LOSS_BOUND, (
            f"μ = {pitch.friction}: wanted lost power within {LOSS_BOUND} of friction work, found {difference:.1e} off"
        )


def draw(path: Path, *pitches: PitchSolution) -> None:
    """The curves."""
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axis = plt.subplots(figsize=(8.0, 4.5), layout="constrained")
    for pitch in pitches:
        label = f"μ = {pitch.friction:g}: {1e3 * pitch.transmission_error_peak_to_peak:.2f} µm peak to peak"
        axis.plot(np.degrees(pitch.angles), 1e3 * pitch.transmission_error, marker=".", label=label)
    axis.set(xlabel="pinion rotation [°]", ylabel="transmission error [µm]")
    axis.set_title(f"Spur pair of He et al. 2022 under {TORQUE / 1e3:g} N·m: loaded transmission error over a pitch")
    axis.grid(alpha=0.4)
    axis.legend()
    figure.savefig(path, dpi=150)
    plt.close(figure)


if __name__ == "__main__":
    typer.run(main)
