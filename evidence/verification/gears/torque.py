"""The torque ratio of frictionless gear pairs, T_2/T_1 = z_2/z_1 at every angle: a spur and a helical pair."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import nan

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from mpi4py import MPI

from evidence.claims import Verification, analytical
from evidence.scenes import helical_pair_of_width, spur_pair
from evolvent.gears.gear_model import GearModel, prepare_model
from evolvent.gears.sweep.pitch_sweep import initial_state, sweep_pitch, uniform_pitch
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.results.drawing.style import PINION, WHEEL, note
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent_meshes.arrays import Bools, Floats

SMOOTH = "contact.friction=0.0"
WIDTH, RELIEF = 8.0, 15.0  # mm, µm: of the helical pair
LIGHT = 0.1  # of the helical pair's torque
AWAY, AT_EDGE = 1.2e-4, 2.2e-3  # bounds of |T_2 z_1/(T_1 z_2) − 1|
BEARS = "the bar is the spur pair's, which is met on deflected flanks; up to a fifth of the force lies on tip edges"
WHOLE = "by 1 %, since tip corners press along the other flank's normal: the whole torque's error is a quarter smaller"
TILTS = "the bar is the spur pair's; the normals are those before deflection, along those after it the bar is met"
BENDS = "the bar is the spur pair's; at single positions teeth store energy, over the pitch 4e-5 is missing"


@dataclass(frozen=True)
class Ratios:
    """The torque ratio over a pitch.

    degrees: (k,), pinion rotation [°].
    off:     (k,), T_2 z_1/(T_1 z_2) − 1.
    edge:    (k,), whether a tip edge bears.
    """

    degrees: Floats
    off: Floats
    edge: Bools

    @property
    def mean(self) -> float:
        """|mean of `off`|."""
        return abs(float(self.off.mean()))

    def largest(self, edge: bool) -> float:
        """|off| at the positions where a tip edge bears, or where none does; NaN without such a position."""
        here = np.abs(self.off[self.edge == edge])
        return float(here.max()) if len(here) else nan


def narrow_pair() -> Scene:
    """Yang's pair, narrower and coarse, with tip relief so that the edges bear less, under the same line load."""
    relieved = [f"{gear}.tip_relief_um={RELIEF}" for gear in ("pinion", "wheel")]
    coarse = 'mesh.level="quick"', "mesh.elements_per_contact_width=1.0"
    return helical_pair_of_width(WIDTH, SMOOTH, *relieved, *coarse)


def model_of(scene: Scene) -> GearModel:
    """Both gears, condensed on this rank alone."""
    return prepare_model(gear_problem(scene), MPI.COMM_SELF).model


def ratios(model: GearModel, positions: int) -> Ratios:
    """Solves one pitch."""
    pitch = uniform_pitch(model.pair.pinion.z, positions)
    results = [p.results[0] for p in sweep_pitch(model, pitch, [0.0], initial_state([0.0]))]
    edge = np.array([bool(result.contact.edge.any()) for result in results])
    return Ratios(np.degrees(pitch.angles), np.array([_off(result) for result in results]), edge)


def _off(result: PositionResult) -> float:
    return result.torques[1] / (result.torques[0] * result.stand.pair.ratio) - 1.0


def verify() -> Verification:
    """40 positions of the spur pair, 8 of the helical one at each of two torques and on deflected flanks."""
    spur, pair = ratios(model_of(spur_pair(SMOOTH)), 40), model_of(narrow_pair())
    helical = ratios(pair, 8)
    bent = ratios(replace(pair, deflected=True), 8)
    light = ratios(replace(pair, load=replace(pair.load, torque=LIGHT * pair.load.torque)), 8)
    conjugate = analytical("virtual work of conjugate flanks")
    energy = analytical("energy: after a pitch the teeth are as deflected as before")
    return Verification(
        "torque",
        "Torque ratio of frictionless gears",
        "Without friction the flanks press along the common tangent of the base circles, so T_2/T_1 = z_2/z_1 at every "
        "angle. He's spur pair (50/50, 170 N·m) in plane strain, and Yang's helical pair (17/60) narrowed to 8 mm, on "
        "a coarse mesh, with 15 µm of tip relief. The flanks' normals before deflection carry the force, so the ratio "
        "is off by what the pressure's centre lies beside the line of contact. That is deflection, first of all teeth "
        "that bear on a tip edge off the path of contact. Up to a fifth of the helical pair's force lies on tip edges, "
        "and it is off by more than the spur pair; under a tenth of the torque no edge bears, and it is off by less "
        "than a third of that. Searched once more on deflected flanks, as a run does whose pitch does not balance, the "
        "helical pair is within the spur pair's bars: what its pitch lacked of the energy is the tilt of the normals.",
        (
            conjugate.bound("spur, away from tip edges", spur.largest(False), AWAY),
            conjugate.bound("spur, at tip edges", spur.largest(True), AT_EDGE),
            energy.bound("spur, mean of the pitch", spur.mean, AWAY),
            energy.bound("helical, mean of the pitch", helical.mean, AWAY, TILTS),
            conjugate.bound("helical, at tip edges", helical.largest(True), AT_EDGE, BEARS),
            energy.bound("helical on deflected flanks, mean of the pitch", bent.mean, AWAY),
            conjugate.bound("helical on deflected flanks, at tip edges", bent.largest(True), AT_EDGE),
            conjugate.bound("helical, a tenth of the torque, away from tip edges", light.largest(False), AWAY, BENDS),
            analytical("zero without deflection").bound(
                "helical, error at a tenth of the torque over that at the whole",
                light.largest(False) / helical.largest(True), 0.3, WHOLE,
            ),
        ),
        lambda figure: _draw(figure, spur, helical, bent, light),
        "Exact is zero; what is left comes from deflection: teeth that bear on their tip edges before their time",
    )


def _draw(figure: Figure, spur: Ratios, helical: Ratios, bent: Ratios, light: Ratios) -> None:
    left, right = figure.subplots(1, 2, sharey=True)
    _points(left, spur, "", "o")
    _points(right, helical, "whole torque, ", "o")
    _points(right, bent, "deflected flanks, ", "^")
    _points(right, light, "a tenth, ", "s")
    for axes, bounds, name in (
        (left, (AWAY, AT_EDGE), "spur: He, 170 N·m"),
        (right, (AWAY, AT_EDGE), f"helical: Yang, {WIDTH:g} mm wide, {RELIEF:g} µm of tip relief"),
    ):
        for bound, colour in zip(bounds, (PINION, WHEEL), strict=True):
            axes.axhline(bound, color=colour, ls="--", lw=1.0)
        note(axes, f"{name} (dashed: bars)")
        axes.set(ylim=(1e-6, 3e-2), xlabel="pinion rotation [°]")
        axes.legend(loc="lower right")
    left.set_ylabel("|T₂ z₁ / (T₁ z₂) − 1|")


def _points(axes: Axes, case: Ratios, name: str, marker: str) -> None:
    """By whether a tip edge bears."""
    for edge, colour, label in ((False, PINION, "no tip edge bears"), (True, WHEEL, "a tip edge bears")):
        here = case.edge == edge
        if here.any():
            axes.semilogy(case.degrees[here], np.abs(case.off[here]), marker, ms=5, color=colour, label=name + label)
