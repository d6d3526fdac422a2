"""The picture of contact fatigue, of five points along the pinion's flank under a Hertz pressure of 800 to 1500 MPa."""

from __future__ import annotations

import math

import numpy as np
import pytest
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure

from evolvent.results.drawing.style import OVER
from evolvent.strength.fatigue.criterion import DANG_VAN
from evolvent.strength.fatigue.flank_fatigue import FatigueMaterial, flank_fatigue
from evolvent.strength.fatigue.flank_loads import FlankLoads
from evolvent.strength.results.fatigue_facts import FatigueFacts
from evolvent.strength.results.fatigue_picture import fatigue_figure
from evolvent.strength.results.fatigue_tables import depth_rows, map_rows, section_rows
from evolvent.strength.results.friction_fatigue import FrictionFatigue
from tests.support.gear_cases import spur_scene
from tests.support.made_rows import made

COUNT, DEPTHS = 5, (0.0, 0.1, 0.2, 0.5, 0.8, 1.5, 3.0)
STEEL = FatigueMaterial(0.3, 80e3, None, 0.3, 0.0, 1.0)


def drawn() -> Figure:
    """In plane strain, at one friction coefficient."""
    loads = FlankLoads(
        np.zeros((2, COUNT), dtype=int), np.linspace(-3.0, 3.0, COUNT), np.zeros(COUNT),
        np.linspace(800.0, 1500.0, COUNT), np.full(COUNT, 0.1), np.full(COUNT, 0.1),
    )
    own, pair = flank_fatigue(loads, 0.1, DEPTHS, STEEL), spur_scene().gear_pair()
    found = [FrictionFatigue(0.1, (own, own), math.nan)]
    facts = [made(
        FatigueFacts, friction=0.1, largest_pressure_MPa=1500.0, largest_pressure_MPa_error=75.0,
        pinion_pitch_diameter_mm=pair.working_pitch_diameters[0],
    )]
    over, section, below = list(map_rows(pair, found)), list(section_rows(pair, found)), list(depth_rows(pair, found))
    return fatigue_figure("a pair", facts, over, section, below)


def test_every_panel_names_its_criterion() -> None:
    """Dang Van's over the flank and over the depth, on the colours beside it; those on the right in the legend."""
    over, section, below, colours = drawn().axes
    assert over.get_title().startswith(f"{DANG_VAN.words}: ") and over.get_xlabel() == f"{DANG_VAN.words} [MPa]"
    assert section.get_title().startswith(f"{DANG_VAN.words}: ")
    assert colours.get_ylabel() == f"{DANG_VAN.words} [MPa]"
    legend = below.get_legend()
    assert legend is not None and DANG_VAN.words in [text.get_text() for text in legend.get_texts()]


def test_points_near_reversal_are_hollow() -> None:
    """Problem: five points at −3 to 3 mm from the pitch point, contacts 0.1 mm wide. Exact: only the one at the pitch
    point is hollow, the section is hatched there, the foot says why, and curves have a band of ±5 %."""
    figure = drawn()
    over, section, below, _ = figure.axes
    full, hollow = over.lines[:2]
    assert len(full.get_xdata()) == COUNT and len(hollow.get_xdata()) == 1
    assert hollow.get_ydata()[0] == full.get_ydata()[COUNT // 2]
    assert [patch.get_hatch() for patch in section.patches] == ["///"]
    assert any("does not hold" in text.get_text() for text in figure.texts)
    band = over.collections[0].get_paths()[0].vertices
    assert band[:, 0].max() == pytest.approx(1.05 * max(full.get_xdata()))
    assert len(below.collections) == 3


def test_nothing_is_coloured_as_above_the_scale() -> None:
    """The scale ends at the largest value: no part of the section has the colour of what lies above it. Depths begin at
    0."""
    _, section, below, _ = drawn().axes
    colours = np.concatenate([each.get_facecolor() for each in section.collections])
    assert len(colours) > COUNT and not np.isclose(colours, to_rgba(OVER)).all(axis=1).any()
    assert below.get_ylim()[1] == 0.0
