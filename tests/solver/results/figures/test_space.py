"""Rendered views: colours on a flank are those of the colour bar; gears that turn are as if built anew."""

from __future__ import annotations

import io
from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
from PIL import Image, ImageSequence

from evolvent.results.drawing.offscreen import off_screen
from evolvent.results.drawing.style import PRESSURE_MAP, styled
from evolvent.results.fields.flank_field import flank_patch
from evolvent.results.figures.scene3d import contact_teeth, flank_picture, pair_pictures
from evolvent.results.figures.space import _largest, animation
from evolvent.results.tables.figure_rows import position_row
from evolvent_meshes.gears.member import Member
from tests.support.synthetic_run import synthetic_run

LEVELS = 3.0  # of 255 by which the graphics driver may round a colour
ROUNDED = 24  # of 255; single pixels at edges, since points are rounded after another turn


PAIRS = {
    "helical": ("demos/yang2022.toml", ()),
    "plane, driven by its wheel": ("demos/he2022.toml", ("load.driving=wheel",)),
    "with a tilted wheel": ("demos/yang2022.toml", ("pair.misalignment_um=300.0",)),
}


@pytest.mark.parametrize("name", PAIRS)
def test_gears_that_turn_are_as_if_built_anew(name: str) -> None:
    """Problem: positions of a pitch between which a tooth comes into contact and another one leaves it. Exact: each
    image is that of its position alone, in a plotter of its own. From one to the next the image changes by far more."""
    file, overrides = PAIRS[name]
    run = synthetic_run("contact.friction=0.1", *overrides, file=file)
    results = [each[0].result for each in run.positions]
    chosen = [results[k] for k in sorted({0, 1, len(results) // 2, len(results) - 1})]
    assert len({tuple(contact_teeth(result)) for result in chosen}) > 1
    with off_screen():
        turned = list(pair_pictures(run, chosen, 2000.0, (200, 160), close=1.0))
        anew = [image for result in chosen for image in pair_pictures(run, [result], 2000.0, (200, 160), close=1.0)]
    for k, (image, wanted) in enumerate(zip(turned, anew)):
        assert np.abs(image.astype(int) - wanted).max() <= ROUNDED
        assert k == 0 or np.abs(image.astype(int) - anew[k - 1]).max() > 3 * ROUNDED


def test_only_what_belongs_to_the_position_changes_from_frame_to_frame() -> None:
    """Problem: three positions of a pitch. Exact: view, subtitle and dots differ between any two frames; title, colour
    bar, axes and their numbers stand still, to the pixel."""
    run = synthetic_run("contact.friction=0.1")
    short = replace(run, positions=run.positions[:3])
    with styled(), off_screen(), Image.open(io.BytesIO(animation(short))) as film:
        frames = [np.asarray(each.convert("RGB")) for each in ImageSequence.Iterator(film)]
    assert len(frames) == 3
    title, subtitle, view, curve, middle, below = (
        np.s_[:34], np.s_[34:60], np.s_[75:380, 50:415], np.s_[75:380, 530:], np.s_[62:, 430:520], np.s_[400:]
    )
    for a, b in combinations(frames, 2):
        changes = (a != b).any(axis=-1)
        assert all(changes[part].any() for part in (subtitle, view, curve))
        assert not any(changes[part].any() for part in (title, middle, below))


@pytest.mark.parametrize("gear", Member)
def test_colours_are_those_of_the_bar(gear: Member) -> None:
    """Problem: the same value all over the flanks of a gear. Exact: each pixel that shows a flank, and so differs
    between two values, has the colour that the bar has at the value; at the flanks' rims pixels are mixed."""
    run = synthetic_run(file="demos/he2022.toml")
    result, patch = run.positions[0][0].result, flank_patch(run, gear, (60, 20))
    with off_screen():
        shown = {
            share: flank_picture(run, result, patch, np.full((60, 20), 1000.0 * share), 1000.0, (400, 300))
            for share in (0.25, 0.8)
        }
    flank = (shown[0.25] != shown[0.8]).any(axis=-1)
    assert flank.mean() > 0.05
    for share, image in shown.items():
        wanted = 255.0 * np.array(PRESSURE_MAP(share)[:3])
        off = np.abs(image[flank].astype(float) - wanted).max(axis=1)
        assert (off <= LEVELS).mean() > 0.9


def test_pressure_over_a_relief_start_is_named_apart() -> None:
    """A position of which one tooth presses with 900 MPa over a kink: its title says so beside the largest pressure
    elsewhere. Without kinks there is the largest pressure alone, and nothing where none is known."""
    run = synthetic_run(file="demos/he2022.toml")
    row = replace(position_row(run, run.positions[0][0]), max_pressure_MPa=226.0, kink_pressure_MPa=0.0)
    assert _largest(row) == ", at most 226 MPa at this position"
    both = replace(row, kink_pressure_MPa=900.0)
    assert _largest(both) == ", 900 MPa over the start of a linear relief, at most 226 MPa elsewhere"
    assert _largest(replace(row, max_pressure_MPa=np.nan)) == ""
