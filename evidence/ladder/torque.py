"""The torque ratio of frictionless gear pairs, T_2/T_1 = z_2/z_1 at every angle: a spur and a helical pair."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from mpi4py import MPI

from evidence.claims import Claim, Reference, Rung
from meshes.data import Floats
from solver.gear_model import prepare_model
from solver.gear_position import PositionResult
from solver.gear_sweep import initial_state, sweep_pitch, uniform_pitch
from solver.plots_style import INK, PINION, WHEEL, note
from solver.scene import Scene, load_scene

DEMOS = Path(__file__).resolve().parents[2] / "demos"
QUIET = ("output.pictures=false", "output.animation=false", "output.fields=false", "contact.friction=0.0")
WIDTH, RELIEF = 8.0, 15.0  # mm, µm: of the helical pair
AWAY, AT_EDGE, HELICAL = 1.2e-4, 2.2e-3, 2.2e-3  # bounds of |T_2 z_1/(T_1 z_2) − 1|
SOURCE = "virtual work of conjugate flanks"


@dataclass(frozen=True)
class Ratios:
    """A pitch: pinion rotation (k,) [°], T_2 z_1/(T_1 z_2) − 1 (k,), whether a tip edge bears (k,) bool."""

    degrees: Floats
    off: Floats
    edge: np.ndarray

    def largest(self, edge: bool) -> float:
        """|off| at the positions where a tip edge bears, or where none does; NaN without such a position."""
        here = np.abs(self.off[self.edge == edge])
        return float(here.max()) if len(here) else float("nan")


def spur_scene() -> Scene:
    """He's pair, plane strain."""
    return load_scene(DEMOS / "he2022.toml", QUIET)


def helical_scene() -> Scene:
    """Yang's pair, narrower and coarse, with tip relief so that the edges bear less, under the same line load."""
    changes = [f"{gear}.face_width_mm={WIDTH}" for gear in ("pinion", "wheel")]
    changes += [f"{gear}.tip_relief_um={RELIEF}" for gear in ("pinion", "wheel")]
    coarse = ['mesh.level="quick"', "mesh.elements_per_contact_width=1.0", f"load.torque_Nm={250.0 * WIDTH / 16.9}"]
    return load_scene(DEMOS / "yang2022.toml", [*QUIET, *changes, *coarse])


def ratios(scene: Scene, positions: int) -> Ratios:
    """Solves one pitch."""
    model = prepare_model(scene, MPI.COMM_SELF).model
    pitch = uniform_pitch(model.pair.pinion.z, positions, 0)
    results = [p.results[0] for p in sweep_pitch(model, pitch, [0.0], initial_state([0.0]))]
    edge = np.array([bool(result.contact.edge.any()) for result in results])
    return Ratios(np.degrees(pitch.angles), np.array([_off(result) for result in results]), edge)


def _off(result: PositionResult) -> float:
    return result.torques[1] / (result.torques[0] * result.stand.pair.ratio) - 1.0


def measure() -> Rung:
    """40 positions of the spur pair, 8 of the helical one."""
    spur, helical = ratios(spur_scene(), 40), ratios(helical_scene(), 8)
    return Rung(
        "torque",
        "Torque ratio of frictionless gears",
        "Without friction the flanks press along the common tangent of the base circles, so T_2/T_1 = z_2/z_1 at every "
        "angle. He's spur pair (50/50, 170 N·m) in plane strain, and Yang's helical pair (17/60) narrowed to 8 mm, on "
        "a coarse mesh, with 15 µm of tip relief. The pinion's normals carry the force, so the pinion's torque is "
        "exact; the wheel's is off by what the pressure's centre lies beside the line of contact: where a tip edge "
        "bears, and where the relief ends conjugacy.",
        (
            Claim.bound("spur, away from tip edges", spur.largest(False), AWAY, Reference.ANALYTICAL, SOURCE),
            Claim.bound("spur, at tip edges", spur.largest(True), AT_EDGE, Reference.ANALYTICAL, SOURCE),
            Claim.bound("helical", float(np.abs(helical.off).max()), HELICAL, Reference.ANALYTICAL, SOURCE),
        ),
        lambda figure: _draw(figure, spur, helical),
    )


def _draw(figure: Figure, spur: Ratios, helical: Ratios) -> None:
    for axes, case, name, bound in zip(
        figure.subplots(1, 2, sharey=True), (spur, helical), ("spur, He", "helical, Yang, 8 mm wide"), (AWAY, HELICAL)
    ):
        _panel(axes, case, name, bound)
    figure.axes[0].set_ylabel("|T_2 z_1/(T_1 z_2) − 1|")


def _panel(axes: Axes, case: Ratios, name: str, bound: float) -> None:
    error = np.maximum(np.abs(case.off), 1e-9)
    for edge, colour, label in ((False, PINION, "no tip edge in contact"), (True, WHEEL, "a tip edge bears")):
        here = case.edge == edge
        axes.semilogy(case.degrees[here], error[here], "o", ms=5, color=colour, label=label)
    axes.axhline(bound, color=PINION, ls="--", lw=1.0)
    axes.axhline(AT_EDGE, color=WHEEL, ls="--", lw=1.0)
    note(axes, name)
    axes.set(ylim=(1e-7, 1e-2), xlabel="pinion rotation [°]")
    axes.tick_params(labelcolor=INK)
    axes.legend(loc="lower right")
