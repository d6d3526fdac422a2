"""Slices of contacts that lie beside the nominal contact line, as those of loaded teeth do: Hertz where they lie."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from evolvent.contact.hertz import line_half_width, line_peak_pressure
from evolvent.fem.material import contact_modulus
from evolvent.gears.pressure.contact_slices import Slices, slices
from evolvent.gears.sweep.position_result import PositionResult
from evolvent.results.run_data import RunData, flank_facets
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.gears.pair import GearPair
from tests.support.synthetic_run import synthetic_run

SCENES = ["demos/yang2022.toml", "demos/he2022.toml"]
LONGER = (1.05, 0.98)
"""Curvature radii of the displaced contacts on (pinion, wheel), over those on the contact line."""


def involute_arc(base: float, start: Floats, end: Floats) -> Floats:
    """Lengths (n,) [mm] of an involute between two radii of curvature (n,) [mm], by a polygon of its points."""
    t = np.linspace(start / base, end / base, 20001)
    points = base * np.exp(1j * t) * (1.0 - 1j * t)
    sign = np.sign(end - start)
    return np.asarray(sign * np.abs(np.diff(points, axis=0)).sum(axis=0))


def displaced(pair: GearPair, result: PositionResult, cut: Slices) -> PositionResult:
    """The position with the contact of each slice `LONGER` times as far along its involutes' roll as on the line."""
    c = result.contact
    arcs = [
        involute_arc(gear.base_radius, on_line, longer * on_line)
        for gear, on_line, longer in zip(pair.gears, pair.curvature_radii(cut.roll_distance), LONGER)
    ]
    pinion, wheel = (arc[slice_of(result, cut)] for arc in arcs)
    return replace(result, contact=replace(c, across=c.across + pinion, opposite=c.opposite + wheel))


def slice_of(result: PositionResult, cut: Slices) -> Ints:
    """(q,) the slice of each contact point: the nearest of its tooth."""
    c = result.contact
    return np.argmin(np.abs(c.z[:, None] - cut.z) + 1e3 * (c.tooth[:, None] != cut.tooth), axis=1)


def again(run: RunData, result: PositionResult) -> Slices:
    """The slices of a position of a run."""
    return slices(result, flank_facets(run.pair, run.shapes, run.scene.mesh.order), run.scene.materials())


@pytest.mark.parametrize("file", SCENES)
def test_hertz_is_that_of_the_curvature_where_the_contact_lies(file: str) -> None:
    """Problem: contacts that lie where the pinion's involute is curved 5 % less and the wheel's 2 % more than on the
    nominal contact line, by arcs that a polygon measures. Exact: Hertz for these radii; on tip edges, and where the
    contact lies on the line, for those on the line."""
    run = synthetic_run(file=file)
    pair, modulus = run.pair, contact_modulus(*run.scene.materials())
    for position in run.positions:
        cut = position[0].cut
        found = again(run, displaced(pair, position[0].result, cut))
        ρ = pair.normal_curvature_radii(cut.roll_distance)
        longer = np.where(cut.edge, 1.0, np.array(LONGER)[:, None]) * ρ
        exact = 1.0 / (1.0 / longer).sum(axis=0)
        np.testing.assert_allclose(found.radius, exact, rtol=1e-6)
        np.testing.assert_allclose(found.hertz, line_peak_pressure(cut.line_load, exact, modulus), rtol=1e-6)
        np.testing.assert_allclose(cut.radius, 1.0 / (1.0 / np.array(ρ)).sum(axis=0), rtol=1e-9)
        assert not cut.edge.all() and np.array_equal(found.edge, cut.edge)


@pytest.mark.parametrize("file", SCENES)
def test_slices_of_a_hertzian_ridge(file: str) -> None:
    """Problem: Hertz' pressure on the nominal contact lines under an even line load. Exact: force, peak, largest
    pressure and half-width of each slice; nothing of a displaced one's load, and of Hertz on the nominal line, depends
    on where it lies."""
    run = synthetic_run(file=file)
    modulus = contact_modulus(*run.scene.materials())
    result, cut = run.positions[0][0].result, run.positions[0][0].cut
    c = result.contact
    force = np.sum(cut.line_load * cut.width) / np.cos(run.pair.pinion.base_helix_angle)
    assert force == pytest.approx(float(c.pressure @ c.weights))
    whole = ~cut.edge
    exact = line_half_width(cut.line_load, cut.radius, modulus)[whole]
    np.testing.assert_allclose(cut.half_width[whole], exact, rtol=2e-3)
    np.testing.assert_allclose(cut.peak[whole], cut.hertz[whole], rtol=2e-3)
    assert np.isnan(cut.peak[cut.edge]).all() and np.isnan(cut.half_width[cut.edge]).all()
    assert cut.largest.tolist() == [c.pressure[slice_of(result, cut) == k].max() for k in range(len(cut.z))]
    moved = again(run, displaced(run.pair, result, cut))
    np.testing.assert_allclose(moved.line_load, cut.line_load, rtol=1e-12)
    np.testing.assert_allclose(moved.on_nominal_lines(run.pair).hertz, cut.hertz, rtol=1e-9)


def test_no_contact_has_no_slices() -> None:
    """A position without contact points."""
    run = synthetic_run(file=SCENES[0])
    result = run.positions[0][0].result
    nothing = np.zeros(0, dtype=int)
    c = result.contact
    bare = replace(result, contact=type(c)(*(getattr(c, name)[nothing] for name in c.__dataclass_fields__)))
    cut = again(run, bare)
    assert all(len(getattr(cut, name)) == 0 for name in cut.__dataclass_fields__)
