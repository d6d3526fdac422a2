"""What a solution finds at one contact."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from evolvent.contact.problem.definition import Contact, Side
from evolvent.contact.problem.step_pairing import Meeting
from evolvent.contact.step.contact_width import Width, width_of
from evolvent.contact.step.peak_scatter import peak_scatter
from evolvent_meshes.arrays import Floats, Ints


@dataclass(frozen=True)
class ContactResult:
    """One contact of a solution, at the q quadrature points at which its two surfaces face each other.

    points: (q, d) their positions as the bodies are placed, on the surface that carries the pressure.
    normals: (q, d) outwards from the first body.
    weights: (q,) [mm²; mm in 2D].
    pressure: (q,) λ [MPa].
    traction: (q, d) λn + τ in the common frame [MPa], what the first body presses on the second with.
    slip: (q, d) [mm] of the first body over the second since the step before, in the first step since rest; zero where
        the points stick.
    carrier: (body, group) of the surface that carries the pressure: the contact's first, but the softer body's where
        the first one is STIFFER times as stiff (pressure_carrier.py).
    meeting: the pairs of points.
    """

    points: Floats
    normals: Floats
    weights: Floats
    pressure: Floats
    traction: Floats
    slip: Floats
    carrier: Side
    meeting: Meeting = field(repr=False)

    @property
    def force(self) -> Floats:
        """Resultant (d,) on the second body [N; N/mm in 2D]."""
        return self.weights @ self.traction

    @property
    def facets(self) -> Ints:
        """(q,) facets of the carrier's surface."""
        return self.meeting.pairing.facet1

    @property
    def local(self) -> Floats:
        """(q, d−1) reference points on these facets."""
        return self.meeting.pairing.xi1

    @cached_property
    def width(self) -> Width:
        """Width [mm] and cell size of the contact's patch with the fewest cells across, see contact_width.py."""
        return width_of(self.meeting, self.pressure)

    @property
    def cells_across(self) -> float:
        """How many of its longest cells the contact is wide, at its least resolved patch; 0 where nothing presses.
        Below two its pressure may be off by half."""
        return self.width.cells

    @cached_property
    def peak_scatter(self) -> float:
        """How far the largest pressure lies from a smooth course of the pressures around it, over itself; see
        peak_scatter.py. Above 0.05 it is not to be trusted."""
        return peak_scatter(self.meeting, self.pressure)

    @staticmethod
    def of(
        contact: Contact, sides: tuple[Side, Side], meeting: Meeting, traction: Floats, slid: Floats
    ) -> ContactResult:
        """From local tractions (q, d) on the surface that carries the pressure, the first of `sides`, and its slip
        (q, d−1) over the other one."""
        op, sign = meeting.operator, 1.0 if sides[0] == contact.first else -1.0
        normals = op.common(np.eye(op.d)[:1].repeat(len(traction), axis=0))
        slip = op.common(np.hstack([np.zeros((len(slid), 1)), slid]))
        pressed = sign * op.common(traction)
        return ContactResult(
            op.points, sign * normals, op.weights, traction[:, 0], pressed, sign * slip, sides[0], meeting
        )
