"""The result of a solution at one contact."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from evolvent.contact.problem.definition import Contact, Side
from evolvent.contact.step.contact_width import ContactWidth, measure_width
from evolvent.contact.step.paired_surfaces import PairedSurfaces
from evolvent.contact.step.peak_scatter import peak_scatter
from evolvent_meshes.arrays import Floats, Ints


@dataclass(frozen=True)
class ContactResult:
    """One contact of a solution, at the q quadrature points at which its two surfaces face each other.

    points: (q, d) positions as the bodies are placed, on the surface that carries the pressure [mm].
    normals: (q, d) unit normals, outwards from the first body.
    weights: (q,) quadrature weights [mm²; mm in 2D].
    pressure: (q,) contact pressure λ [MPa].
    traction: (q, d) traction λn + τ of the first body on the second, in the common frame [MPa].
    slip: (q, d) slip of the first body over the second since the last step, or since rest [mm]; zero where points
        stick.
    carrier: (body, facet group) of the surface that carries the pressure: the contact's first, or that of the softer
        body if the first is STIFFNESS_RATIO times as stiff (pressure_carrier.py).
    paired: the two surfaces and the pairs of points.
    """

    points: Floats
    normals: Floats
    weights: Floats
    pressure: Floats
    traction: Floats
    slip: Floats
    carrier: Side
    paired: PairedSurfaces = field(repr=False)

    @property
    def force(self) -> Floats:
        """Resultant contact force on the second body, (d,) [N; N/mm in 2D]."""
        return self.weights @ self.traction

    @property
    def facets(self) -> Ints:
        """Facets of the carrier's surface on which the points lie, (q,)."""
        return self.paired.pairing.facet1

    @property
    def local(self) -> Floats:
        """Reference coordinates of the points on these facets, (q, d−1)."""
        return self.paired.pairing.xi1

    @cached_property
    def width(self) -> ContactWidth:
        """Width and cell size [mm] of the patch of contact with the fewest cells across (contact_width.py)."""
        return measure_width(self.paired, self.pressure)

    @property
    def cells_across(self) -> float:
        """Width of the contact over its longest cell, at the patch with the fewest cells; 0 where nothing presses.
        Below two the pressure may be off by half."""
        return self.width.cells

    @cached_property
    def peak_scatter(self) -> float:
        """Distance of the largest pressure from a smooth fit of the pressures around it, over itself
        (peak_scatter.py). Above 0.05 the peak is not reliable."""
        return peak_scatter(self.paired, self.pressure)

    @staticmethod
    def of(
        contact: Contact, sides: tuple[Side, Side], paired: PairedSurfaces, traction: Floats, slip: Floats
    ) -> ContactResult:
        """Result of a contact from local tractions (q, d) on the surface that carries the pressure, the first of
        `sides`, and its local tangential slip (q, d−1) over the other one."""
        op, sign = paired.operator, 1.0 if sides[0] == contact.first else -1.0
        normals = op.common(np.eye(op.d)[:1].repeat(len(traction), axis=0))
        tangential = op.common(np.hstack([np.zeros((len(slip), 1)), slip]))
        return ContactResult(
            points=op.points,
            normals=sign * normals,
            weights=op.weights,
            pressure=traction[:, 0],
            traction=sign * op.common(traction),
            slip=sign * tangential,
            carrier=sides[0],
            paired=paired,
        )
