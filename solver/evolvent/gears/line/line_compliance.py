"""Compliance between the stations of a position, from the condensed gears: loads per length act on a half-ellipse."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from evolvent.gears.line.flank_compliance import FlankCompliance
from evolvent.gears.line.line_gap import nominal_arcs
from evolvent.gears.line.stations import Stations
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair

ACROSS = 24
"""Points across the half-ellipse. The rule (Chebyshev's second kind) is exact for polynomials up to degree 47."""


def line_compliance(
    pair: GearPair, gears: tuple[FlankCompliance, FlankCompliance], stations: Stations, shift: Floats, width: Floats
) -> Floats:
    """Compliance B (m, m) [mm² per N·mm]: work of the normal displacements of both gears under a unit load per length
    of one station on the load of another one.

    shift: (p,) of the line at the points of the stations, towards the pinion's tip [mm of arc]. width: (p,) half-width
    of the half-ellipse there [mm].
    """
    B = np.zeros((len(stations.z), len(stations.z)))
    teeth = [(int(tooth), np.flatnonzero(stations.tooth == tooth)) for tooth in np.unique(stations.tooth)]
    for member, gear in zip(Member, gears):
        arc = nominal_arcs(pair, member, stations.roll_distance) + member.sign * shift
        P = _loads(gear, stations, arc, width)
        modes = P.T @ gear.between_nodes.modes
        for i, of in teeth:
            touched = np.unique(P[:, of].nonzero()[0])
            own = P[touched][:, of].toarray()
            B[np.ix_(of, of)] += own.T @ gear.between_nodes.own[np.ix_(touched, touched)] @ own
            for j, on in teeth:
                B[np.ix_(of, on)] += modes[of] @ gear.between_nodes.between(gear.sign * i, gear.sign * j) @ modes[on].T
    return 0.5 * (B + B.T)


def _loads(gear: FlankCompliance, stations: Stations, arc: Floats, width: Floats) -> sp.csc_matrix:
    """Nodal forces (nodes, m) of a unit load per length of each station."""
    θ = np.arange(1, ACROSS + 1) * np.pi / (ACROSS + 1)
    across, share = np.cos(θ), 2.0 / (ACROSS + 1) * np.sin(θ) ** 2
    places = arc[:, None] + width[:, None] * across
    shapes = gear.shapes(places.ravel(), np.repeat(stations.point_z, ACROSS))
    spread = sp.kron(sp.eye(len(arc)), share[None, :], format="csr")
    return (shapes.T @ spread.T @ stations.hats).tocsc()
