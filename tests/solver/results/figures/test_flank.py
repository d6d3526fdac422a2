"""Maps of the pressure on the flank, its envelope over the engagement, and their colour scale."""

from __future__ import annotations

import io
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.collections import QuadMesh
from matplotlib.colors import to_rgb
from PIL import Image

from evidence.pages.tutorial import small
from evolvent.gears.pressure.contact_slices import on_tip_edge
from evolvent.gears.pressure.relief_starts import relief_starts
from evolvent.results.drawing.style import ABOVE, OVER, png, styled
from evolvent.results.engagement import largest_peak
from evolvent.results.figures.flank import envelope, pressure_map, pressure_top
from evolvent.results.run_data import RunData, SolvedPosition
from evolvent.results.tables.figure_rows import friction_rows
from evolvent_meshes.arrays import Floats
from tests.support.synthetic_run import steep_run, synthetic_run


@pytest.fixture(scope="module")
def run() -> RunData:
    return synthetic_run("contact.friction=[0.0, 0.1, 0.2]")


def test_scale_reaches_the_headline() -> None:
    """Problem: the largest pressure of a spur pair is where a tip-edge zone begins, between two positions, and in none
    of their slices. Exact: the colours of 01 and 02 reach it, to a hundred MPa."""
    run = steep_run()
    headline, slices = friction_rows(run)[0].max_pressure_MPa, [each[0].cut.peak for each in run.positions]
    assert largest_peak(run, 0).at_zone_end and headline > 100.0 + np.nanmax(np.concatenate(slices))
    assert headline <= pressure_top(run, 0) < headline + 100.0


def test_envelope_is_hertz_over_the_path(run: RunData) -> None:
    """Exact: with nearly even load the envelope falls from root to tip as the relative radius grows, p0 ∝ R^(−1/2)."""
    ξ = np.linspace(-4.0, 5.0, 40)
    _, peak = envelope(run, 0, ξ)
    mean = np.nanmean(peak, axis=1)
    radius = run.pair.relative_curvature_radius(ξ)
    np.testing.assert_allclose(mean * np.sqrt(radius) / np.mean(mean * np.sqrt(radius)), 1.0, atol=0.03)


def maps_of(run: RunData) -> list[tuple[Floats, Floats, Floats]]:
    """(z, ξ, drawn pressures) of the maps of 02; the envelope first."""
    with styled():
        meshes = [ax.collections[0] for ax in pressure_map(run).axes[:4]]
    found = []
    for mesh in meshes:
        assert isinstance(mesh, QuadMesh)
        place = np.asarray(mesh._coordinates)
        pressures = np.ma.filled(mesh.get_array(), np.nan).ravel()
        flat = len(pressures) != place[..., 0].size  # one value a cell, not a corner
        if flat:
            place = 0.25 * (place[1:, 1:] + place[:-1, 1:] + place[1:, :-1] + place[:-1, :-1])
        found.append((place[0, :, 0], place[:, 0, 1], pressures.reshape(place.shape[:2])))
    return found


def test_scale_holds_all_between_the_tip_edges(run: RunData) -> None:
    """Problem: the nodes' pressures are half as high again as the fitted peaks, as at a kink of the flank. Exact: also
    then nothing that a map shows between the tip-edge zones is above the scale; what is above has the colour that the
    scale names, also in the tutorial's pictures with their palette."""
    raised = tuple(
        tuple(replace(each, result=replace(each.result, traction=1.5 * each.result.traction)) for each in position)
        for position in run.positions
    )
    kinked = replace(run, positions=raised)
    low, high = kinked.inner_path
    top = pressure_top(kinked, 0)
    for _, ξ, pressures in maps_of(kinked)[1:]:
        rows = (low < ξ) & (ξ < high)
        assert 0.5 * top < pressures[rows].max() <= top
    red, green, blue = to_rgb(OVER)
    assert blue > 1.5 * max(red, green) and ABOVE.startswith("blue")
    with styled(), Image.open(io.BytesIO(png(pressure_map(run)))) as picture:
        colours = np.asarray(small(picture).convert("RGB")).reshape(-1, 3).astype(float)
    assert np.abs(colours - 255.0 * np.array(to_rgb(OVER))).max(axis=1).min() < 4.0
    assert (colours[0] == 255.0).all()


def test_pressures_over_relief_starts_are_left_out_of_the_scale() -> None:
    """Problem: a spur pair with linear tip reliefs has ten times the pressure at nodes whose contact covers the start
    of one. Exact: the scale of the maps ends where it ends without, and the envelope is blank there."""
    relief = ("pinion.tip_relief_um=20", "wheel.tip_relief_um=20")
    run = synthetic_run("sweep.positions=8", *relief, file="demos/he2022.toml")

    def sharp(solved: SolvedPosition) -> SolvedPosition:
        result, cut = solved.result, solved.cut
        over = np.isin(result.tooth, cut.tooth[cut.kink])
        return replace(solved, result=replace(result, traction=np.where(over[:, None], 10.0, 1.0) * result.traction))

    sharpened = replace(run, positions=tuple((sharp(solved),) for (solved,) in run.positions))
    assert pressure_top(sharpened, 0) == pressure_top(run, 0)
    starts = np.array([start.roll_distance for start in relief_starts(run.pair)])
    assert len(starts) == 2 and any(solved.cut.kink.any() for (solved,) in run.positions)
    finer = synthetic_run("sweep.positions=40", *relief, file="demos/he2022.toml")
    assert np.isnan(envelope(finer, 0, starts)[1]).all() and np.isfinite(envelope(finer, 0, np.zeros(1))[1]).all()


def test_tip_edges_do_not_swamp_the_scale(run: RunData) -> None:
    """Problem: in layers that bear on a tip edge the singular pressure, ten times the rest, reaches past the end of the
    edge's zone. Exact: the scale ends where it ends without."""
    solved = run.positions[0][0]
    result, low = solved.result, run.inner_path[0]
    bears = np.zeros(len(result.node), dtype=bool)
    for tooth in np.unique(result.tooth):
        bears |= (result.tooth == tooth) & on_tip_edge(solved.cut, int(tooth), run.flank.z[result.node])
    singular = replace(result, traction=np.where(bears[:, None], 10.0, 1.0) * result.traction)
    ξ = run.flank.roll_length[result.node] - run.pair.pitch_point_roll_lengths[0]
    assert singular.pressure[bears & (ξ > low)].max() > 2.0 * pressure_top(run, 0)
    first = (replace(solved, result=singular), *run.positions[0][1:])
    assert pressure_top(replace(run, positions=(first, *run.positions[1:])), 0) == pressure_top(run, 0)


def test_envelope_has_straight_rims(run: RunData) -> None:
    """Exact: the map of the envelope goes from rim to rim of the face and lies between the tip-edge zones; where it is
    known begins and ends on lines without steps, within a tenth of a millimetre."""
    z, ξ, pressures = maps_of(run)[0]
    assert np.ptp(z) == pytest.approx(run.pair.face_width, rel=0.01)
    low, high = run.inner_path
    known = np.isfinite(pressures)
    assert known.mean() > 0.9 and low - 0.05 < ξ.min() and ξ.max() < high + 0.05
    step = np.ptp(ξ) / len(ξ)
    for rows in (known, known[::-1]):
        assert np.abs(np.diff(rows.argmax(axis=0))).max() * step < 0.1
