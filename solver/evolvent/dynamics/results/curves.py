"""Curves of an excitation over the pitch, in the units of its tables, with error bars.

The errors of the mesh are estimated as those of a run (`results.error_bars.estimation`): from the same positions under
the same torques on elements of twice the size. Peak-to-peak values and harmonics do not depend on the mean: of them,
curves are compared without it. Figures of the whole pitch have the error of sampling it, too; so has the unloaded
transmission error, which has no other. Where a tooth pair has just come into contact or has not quite, the tangent
stiffness of a position is known only to belong to one of both states.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np

from evolvent.dynamics.excitation.force_surface import MeshExcitation
from evolvent.dynamics.excitation.harmonics import COUNT, mesh_harmonics
from evolvent.results.error_bars.compared import SHARING, STIFFNESS, Compared, Curve, Reduction
from evolvent.results.error_bars.line_parts import ERROR_LEAST, ERROR_VARIES, SECANT_OFF, TANGENT_OFF
from evolvent.results.error_bars.position_spacing import (
    JUMP,
    KINK,
    every_other,
    missed_peaks,
    pitch_bends,
    shares,
    thinned_mean,
)
from evolvent_meshes.arrays import Floats, Ints

UNLOADED, LOADED = "unloaded_transmission_error_um", "transmission_error_um"
TANGENT, SECANT = "tangent_stiffness_N_per_um", "secant_stiffness_N_per_um"
QUANTITIES: dict[str, Callable[[MeshExcitation], Floats]] = {
    LOADED: lambda excitation: 1e3 * excitation.loaded.errors,
    TANGENT: lambda excitation: 1e-3 * excitation.loaded.stiffness,
    SECANT: lambda excitation: 1e-3 * excitation.secant,
}
"""Column of excitation.csv -> its values (n, m) at n positions under m torques."""
BENDS = {UNLOADED: KINK, LOADED: KINK, TANGENT: JUMP, SECANT: KINK}
"""Error of a step's mean over the bend of the step, see `position_spacing`: the tangent stiffness jumps where a tooth
pair comes into contact, the others have kinks there."""
LINE_OFF = {LOADED: 2e-3, TANGENT: TANGENT_OFF, SECANT: SECANT_OFF}
LINE_VARIES = {LOADED: ERROR_VARIES, TANGENT: 2e-2, SECANT: 6e-3}
LINE_LEAST = {LOADED: ERROR_LEAST, TANGENT: 2e-3, SECANT: 1e-3}
"""Parts by which values of a line contact are off beside the error of its meshes; by which peak-to-peak values and
amplitudes are; and the least error of these, over the mean value. Nine in ten deviations from resolved contacts are
smaller (docs/line_contact.md)."""
NARROW = 1.0
"""Elements across the contact width below which the errors of the mesh are larger than by its rate. The contact's own
deflection goes with the logarithm of its width, and that of a contact narrower than an element with the element's
size: each halving of the elements then takes off the same, and log2(element over width) times that is left. He's pair,
order 2, transmission error: nine in ten errors are below 1.5, 1.0, 0.6, 0.4 times the difference to elements of twice
the size at 0.27, 0.38, 0.6 and 0.85 elements across the width."""


@dataclass(frozen=True, eq=False)
class CoarseExcitation:
    """Excitation on the meshes of a coarse companion, with elements of twice the size."""

    excitation: MeshExcitation | None
    """Excitation at the same positions under the same torques; None where it was not asked for or could not be
    solved."""
    order: int = 2
    """Polynomial order of the finite elements."""
    elements: tuple[float, ...] = ()
    """(m,) elements of the finer meshes across the contact width, under each torque; empty where the width is large
    enough."""
    failure: str = ""
    """Sentence on why the excitation could not be solved; empty where it could."""


NO_COMPANION = CoarseExcitation(None)
"""Companion of an excitation without error bars."""


@dataclass(frozen=True, eq=False)
class PitchCurve:
    """A quantity under one torque, at n equidistant positions of a pitch."""

    quantity: str
    """Name of the quantity, as in excitation.csv."""
    values: Floats
    """(n,) values in the unit of the quantity."""
    coarse: Floats | None
    """(n,) values on elements of twice the size; None where they are not known."""
    order: int
    """Polynomial order of the finite elements."""
    elements: float = math.inf
    """Finite elements across the contact width."""
    in_line_contact: bool = False
    """Whether the contact is a line contact, which is off by more than its meshes."""

    @property
    def bars(self) -> Floats:
        """Errors (n,) of the mesh at each position; NaN where they are not known."""
        if self.coarse is None:
            return np.full(len(self.values), np.nan)
        return self._compared(STIFFNESS).of_each(np.abs(self.values)) + self._model(LINE_OFF) * np.abs(self.values)

    def mesh_error(self, figure: Reduction) -> float:
        """Error of a figure by the mesh; NaN where it is not known."""
        if self.coarse is None:
            return float("nan")
        return self._compared(STIFFNESS).of_figure(figure) + self._model(LINE_OFF) * abs(figure(self.values))

    def varying_error(self, figure: Reduction) -> float:
        """Error by the mesh of a figure that does not depend on the mean of the curve; NaN where it is not known."""
        if self.coarse is None:
            return float("nan")
        least = self._model(LINE_LEAST) * float(np.mean(np.abs(self.values)))
        off = max(least, self._model(LINE_VARIES) * abs(figure(self.values)))
        return self._compared(SHARING).of_varying(figure) + off

    def _model(self, off: Mapping[str, float]) -> float:
        """Part by which a line contact is off. off: by the quantity."""
        return off[self.quantity] if self.in_line_contact else 0.0

    @property
    def _halvings(self) -> float:
        """Number of halvings after which the elements would be as small as the contact is wide."""
        return max(0.0, -math.log2(self.elements / NARROW))

    def _compared(self, factors: Mapping[int, float]) -> Compared:
        """The curve beside that of the companion, which is known. factors: by the order of the cells."""
        assert self.coarse is not None
        place, factor = np.arange(len(self.values), dtype=float), max(factors[self.order], self._halvings)
        return Compared(Curve(place, self.values), Curve(place, self.coarse), factor)

    @cached_property
    def mean_error(self) -> float:
        """Error of the mean over the pitch, by the mesh and by the spacing of positions."""
        return self.mesh_error(lambda values: float(np.mean(values))) + max(thinned_mean(self.values), self._bent)

    @cached_property
    def peak_to_peak_error(self) -> float:
        """Error of the peak-to-peak value, by the mesh and by the spacing of positions."""
        size = float(np.ptp(self.values))
        halves = [abs(float(np.ptp(self.values[kept])) - size) for kept in self._halves]
        return self.varying_error(lambda values: float(np.ptp(values))) + max(
            float(np.mean(halves)), missed_peaks(self.values)
        )

    @property
    def harmonics(self) -> tuple[Floats, Floats]:
        """Amplitudes and phases [rad] of the mesh harmonics (`mesh_harmonics`): as many as the positions hold, at most
        `COUNT`."""
        return mesh_harmonics(self.values, self._count)

    @cached_property
    def amplitude_errors(self) -> Floats:
        """Errors of the amplitudes of the mesh harmonics, by the mesh and by the spacing of positions."""
        amplitudes = self.harmonics[0]
        mesh = [self.varying_error(partial(_amplitude, r)) for r in range(1, self._count + 1)]
        halves = [np.abs(_thinned_amplitudes(self.values, kept, self._count) - amplitudes) for kept in self._halves]
        return np.array(mesh) + np.maximum(np.mean(halves, axis=0), 2.0 * self._bent)

    @property
    def _count(self) -> int:
        return min(COUNT, (len(self.values) - 1) // 2)

    @property
    def _bent(self) -> float:
        """Error of the mean by jumps or kinks at unknown places between the positions."""
        return BENDS[self.quantity] * pitch_bends(self.values)

    @property
    def _halves(self) -> list[Ints]:
        """Every other position, from the first and from the second on."""
        return [every_other(len(self.values), first) for first in (0, 1)]


def unloaded_curve(excitation: MeshExcitation) -> PitchCurve:
    """The unloaded transmission error, which is exact at its positions."""
    values = 1e3 * excitation.unloaded_error
    return PitchCurve(UNLOADED, values, values, NO_COMPANION.order)


def pitch_curves(excitation: MeshExcitation, companion: CoarseExcitation) -> Iterator[dict[str, PitchCurve]]:
    """The curves of all `QUANTITIES` by their names, of each torque, the lightest first."""
    coarse, order = companion.excitation, companion.order
    whole = {name: values(excitation) for name, values in QUANTITIES.items()}
    known = {name: None if coarse is None else values(coarse) for name, values in QUANTITIES.items()}
    count = len(excitation.loaded.forces)
    line = excitation.loaded.line is not None
    for j, elements in enumerate(companion.elements or (math.inf,) * count):
        others = {name: None if values is None else values[:, j] for name, values in known.items()}
        yield {
            name: PitchCurve(name, values[:, j], others[name], order, elements, line) for name, values in whole.items()
        }


def _amplitude(harmonic: int, values: Floats) -> float:
    """Amplitude of one mesh harmonic of values (n,) over the pitch."""
    return float(mesh_harmonics(values, harmonic)[0][-1])


def _thinned_amplitudes(values: Floats, kept: Ints, count: int) -> Floats:
    """Amplitudes (count,) from the positions that are kept (k,), by the trapezoidal rule."""
    turn = np.exp(-2j * np.pi * np.outer(np.arange(1, count + 1), kept) / len(values))
    return np.asarray(2.0 * np.abs(turn @ (shares(kept, len(values)) * values[kept])))
