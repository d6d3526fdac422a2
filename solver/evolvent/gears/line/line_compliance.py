"""Compliance between the stations of a position, from the condensed gears: loads per length act on a half-ellipse."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from evolvent.gears.line.flank_compliance import FlankCompliance
from evolvent.gears.line.line_gap import nominal_arcs
from evolvent.gears.line.stations import Stations
from evolvent.gears.ring.ring_compliance import DirectedCompliance
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
    for member, gear in zip(Member, gears):
        P = nodal_loads(gear, stations, carried_arcs(pair, member, stations, shift), width, stations.hats)
        B += _work(gear, gear.between_nodes, stations, P, P)
    return 0.5 * (B + B.T)


def friction_compliance(
    pair: GearPair, gears: tuple[FlankCompliance, FlankCompliance], stations: Stations, shift: Floats, width: Floats,
    direction: Floats,
) -> Floats:
    """Work (m, m) [mm² per N·mm] of the normal displacements of both gears, under a unit load per length along the
    profile of one station (column), on the normal load of another one (row). It is not symmetric.

    direction: (p,) part of the tangential load that acts towards the tips of both gears, at the points of the stations.
    Gears are with `FlankCompliance.by_friction`. shift, width: as of `line_compliance`.
    """
    B, signed = np.zeros((len(stations.z), len(stations.z))), sp.csr_matrix(sp.diags(direction) @ stations.hats)
    for member, gear in zip(Member, gears):
        assert gear.by_friction is not None
        arc = carried_arcs(pair, member, stations, shift)
        normal, along = (nodal_loads(gear, stations, arc, width, hats) for hats in (stations.hats, signed))
        B += _work(gear, gear.by_friction, stations, normal, along)
    return B


def _work(
    gear: FlankCompliance, compliance: DirectedCompliance, stations: Stations, P: sp.csc_matrix, Q: sp.csc_matrix
) -> Floats:
    """Work (m, m) of the displacements of a gear under the nodal forces Q (nodes, m) of each station on the nodal
    forces P (nodes, m) of each station."""
    W = np.zeros((len(stations.z), len(stations.z)))
    teeth = [(int(tooth), np.flatnonzero(stations.tooth == tooth)) for tooth in np.unique(stations.tooth)]
    moved, loaded = P.T @ compliance.modes, Q.T @ compliance.force_modes
    for i, of in teeth:
        touched = np.unique(P[:, of].nonzero()[0])
        own, acting = (each[touched][:, of].toarray() for each in (P, Q))
        W[np.ix_(of, of)] += own.T @ compliance.own[np.ix_(touched, touched)] @ acting
        for j, on in teeth:
            W[np.ix_(of, on)] += moved[of] @ compliance.between(gear.sign * i, gear.sign * j) @ loaded[on].T
    return W


def carried_arcs(pair: GearPair, member: Member, stations: Stations, shift: Floats) -> Floats:
    """Arcs (p,) of a gear's profile [mm] at which the half-ellipses lie."""
    return nominal_arcs(pair, member, stations.roll_distance) + member.sign * shift


def nodal_loads(
    gear: FlankCompliance, stations: Stations, arc: Floats, width: Floats, hats: sp.csr_matrix
) -> sp.csc_matrix:
    """Nodal forces (nodes, m) of a unit load per length of each station. hats: (p, m) at the points."""
    θ = np.arange(1, ACROSS + 1) * np.pi / (ACROSS + 1)
    across, share = np.cos(θ), 2.0 / (ACROSS + 1) * np.sin(θ) ** 2
    places = arc[:, None] + width[:, None] * across
    shapes = gear.shapes(places.ravel(), np.repeat(stations.point_z, ACROSS))
    spread = sp.kron(sp.eye(len(arc)), share[None, :], format="csr")
    return (shapes.T @ spread.T @ hats).tocsc()
