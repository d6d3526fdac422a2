"""Condensed gears with other flank modifications, from Python: in line contact these are not in the meshes."""

from __future__ import annotations

from dataclasses import replace

from evolvent.gears.gear_model import GearModel
from evolvent.gears.meshing.sector_meshes import unmodified
from evolvent.gears.solution.solver import check_condensed
from evolvent_meshes.gears.pair import GearPair
from evolvent_meshes.input_checks import Words, instance, refuse


def with_modifications(gears: GearModel, pair: GearPair) -> GearModel:
    """The condensed gears with the flank modifications and the misalignment of another pair; nothing is condensed.

    gears: condensed at mesh level "line".
    pair: differs from theirs in modifications and misalignment alone. Where the gears were condensed in the plane,
        neither varies over the face.

    Raises InputError.

    Examples:
        >>> from dataclasses import replace
        >>> import numpy as np
        >>> from evolvent.dynamics import mesh_excitation
        >>> from evolvent.gears import (
        ...     GearPair, GearParameters, GearProblem, MeshSettings, Modifications, condense, with_modifications
        ... )
        >>> rack = dict(normal_module=3.0, normal_pressure_angle_deg=20.0, face_width=20.0)
        >>> gear = GearParameters.from_rack(z=30, bore_diameter=40.0, **rack)
        >>> pair = GearPair(gear, gear, centre_distance=90.0)
        >>> gears = condense(GearProblem(pair, torque=100e3, mesh=MeshSettings("line")))
        >>> for relief in (20.0, 40.0):
        ...     form = dict(tip_relief_um=relief, tip_relief_start_diameter=93.0, tip_relief_parabolic=True)
        ...     relieved = replace(gear, modifications=Modifications(**form))
        ...     variant = with_modifications(gears, GearPair(relieved, relieved, centre_distance=90.0))
        ...     error = mesh_excitation(variant, [100e3]).transmission_error
        ...     print(f"{relief:.0f} µm: {1e3 * np.ptp(error):.1f} µm peak to peak")
        20 µm: 2.7 µm peak to peak
        40 µm: 2.5 µm peak to peak
    """
    check_condensed(gears)
    instance("pair", pair, GearPair, "write GearPair(pinion, wheel, centre_distance=...)")
    if not gears.is_line:
        remedy = 'condense them with MeshSettings("line"), or condense each pair by itself'
        refuse("gears", 'gears of mesh level "line"', Words("gears whose contact is resolved"), remedy)
    if _plain(pair) != _plain(gears.pair):
        refuse(
            "pair", "the condensed gears with other modifications or misalignment", Words("other gears"),
            "condense these",
        )
    if gears.bodies[0].d == 2 and (pair.misalignment_um or any(_over_face(pair))):
        refuse(
            "pair", "flanks that are alike over the face, of gears condensed in the plane", Words("others"),
            "condense the gears with a modification over the face, or with GearOptions(in_space=True)",
        )
    return replace(gears, pair=pair)


def _plain(pair: GearPair) -> GearPair:
    """The pair without modifications and misalignment."""
    return replace(pair, pinion=unmodified(pair.pinion), wheel=unmodified(pair.wheel), misalignment_um=0.0)


def _over_face(pair: GearPair) -> list[bool]:
    return [gear.modifications.varies_over_the_face for gear in pair.gears]
