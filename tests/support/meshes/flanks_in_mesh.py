"""Flanks of Yang's pair in mesh, with their cells, without a solution."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

from evolvent.fem.surface import Surface, surface_of
from evolvent.gears.contact.contact_line import ContactLine
from evolvent.gears.kinematics import PairRotation
from evolvent.gears.two_level.flank_cells import FlankCells
from evolvent.gears.two_level.flank_lattice import FlankLattice
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.modifications.modifications import Modifications
from evolvent_meshes.sector.section import SectorResolution
from evolvent_meshes.sector.sector import sector_mesh
from tests.support.meshes.sector_cases import gear_and_start
from tests.support.paper_pairs import yang

ANGLE = 0.02
TEETH = (-1, 0, 1)
"""Tooth pairs of Yang's gears at this angle: one whose line enters, one across the flanks, one whose line leaves."""


@cache
def flanks() -> tuple[tuple[Surface, Surface], tuple[FlankCells, FlankCells]]:
    """Flanks of pinion and wheel in their own frames, and their cells."""
    pair, names = yang(), ("yang pinion", "yang wheel")
    resolution = SectorResolution(profile_elements=36, face_elements=24)
    gears = [(gear, replace(resolution, flank_start_diameter=start)) for gear, start in map(gear_and_start, names)]
    pinion, wheel = (surface_of(sector_mesh(*each), "flank") for each in gears)
    first, second = (
        FlankCells.of(FlankLattice.of(surface.points), surface, gear.base_radius)
        for surface, gear in zip((pinion, wheel), pair.gears)
    )
    return (pinion, wheel), (first, second)


def line(tooth: int) -> ContactLine:
    """The contact line of a tooth pair."""
    return ContactLine(flanks()[1], PairRotation(yang(), ANGLE), tooth)


def modified(pinion: Modifications) -> ContactLine:
    """The contact line across the flanks with modifications of the pinion."""
    return replace(line(0), stand=PairRotation(yang(pinion), ANGLE))


def crowned(crowning_um: float) -> ContactLine:
    """The contact line across the flanks with a lead crowning of the pinion."""
    return modified(Modifications(lead_crowning_um=crowning_um))


@cache
def placed(tooth: int) -> tuple[Surface, Surface]:
    """The flanks of a tooth pair in the common frame."""
    stand = line(tooth).stand
    first, second = (
        flank.moved(stand.rotation(gear, 3, tooth), stand.centre(gear, 3)) for gear, flank in zip(Member, flanks()[0])
    )
    return first, second
