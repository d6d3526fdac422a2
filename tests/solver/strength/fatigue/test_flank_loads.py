"""What loads the flanks, from a synthetic run: Hertz pressure of an even line load on the nominal contact lines."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from evolvent.contact.hertz import line_half_width
from evolvent.fem.material import contact_modulus
from evolvent.gears.pressure.line_peaks import has_peak
from evolvent.results.run_data import RunData
from evolvent.strength.fatigue.fitted_tractions import shear_differences
from evolvent.strength.fatigue.flank_loads import FlankLoads, LoadedPosition
from tests.support.synthetic_run import synthetic_run

FILES = ["demos/yang2022.toml", "demos/he2022.toml"]


def loaded(run: RunData, index: int) -> list[LoadedPosition]:
    return [
        LoadedPosition(k, each[index].result, each[index].cut, run.flank.z) for k, each in enumerate(run.positions)
    ]


@pytest.mark.parametrize("file", FILES)
def test_slices_between_the_tip_edge_zones(file: str) -> None:
    """Each slice that has a peak, and lies between the zones by its roll distance, is a point: half-widths and peaks
    make its line load, F = π/2 p0 b; half-widths are Hertz' within 5 % in the median; no point lies on a tip edge."""
    run = synthetic_run(file=file)
    positions = loaded(run, 0)
    parts = [each.loads(run.inner_path) for each in positions]
    found = FlankLoads.joined(parts)
    assert 0 < len(found.peak) < sum(int(has_peak(each.cut).sum()) for each in positions) + 1
    assert (found.roll_distance > run.inner_path[0]).all() and (found.roll_distance < run.inner_path[1]).all()
    modulus = contact_modulus(*run.scene.materials())
    for each, part in zip(positions, parts):
        at = {(int(t), round(float(z), 6)): k for k, (t, z) in enumerate(zip(each.cut.tooth, each.cut.z))}
        own = [at[int(key[1]), round(float(z), 6)] for key, z in zip(part.place, part.height)]
        load = each.cut.line_load[own]
        assert 0.5 * np.pi * part.peak * part.half_width == pytest.approx(load, rel=1e-12)
        exact = line_half_width(load, each.cut.radius[own], modulus)
        assert np.median(part.half_width / exact) == pytest.approx(1.0, abs=0.05)


def test_sliding_contact_has_the_friction_coefficient() -> None:
    """All points slide: the tangential force is μ times the normal one, at each coefficient; less in slices that the
    pitch line crosses, where sliding reverses."""
    run = synthetic_run(file=FILES[0])
    for index, friction in enumerate(run.frictions):
        found = FlankLoads.joined([each.loads(run.inner_path) for each in loaded(run, index)])
        crossed = np.abs(found.roll_distance) < 0.3
        assert found.friction[~crossed] == pytest.approx(np.full(int((~crossed).sum()), friction), rel=1e-6)
        assert (found.friction[crossed] <= friction * (1.0 + 1e-9)).all() and found.friction.min() < friction / 2.0


def test_the_same_points_at_all_coefficients() -> None:
    """Points are known by position, tooth and layer, each of them once."""
    run = synthetic_run(file=FILES[0])
    one, other = (
        FlankLoads.joined([each.loads(run.inner_path) for each in loaded(run, index)]).place for index in (0, -1)
    )
    assert len(np.unique(one, axis=0)) == len(one)
    assert np.array_equal(one, other)


def test_fitted_half_ellipses_stand_for_hertz_pressure() -> None:
    """Hertz pressure at the quadrature points: the largest shear stress below it is that of the fitted half-ellipse, to
    1e-3. With the pressure moved to the contact's middle, under the same fit, it is larger by more than 5 %."""
    run = synthetic_run(file=FILES[1])
    positions = loaded(run, 0)
    assert np.abs(shear_differences(positions, run.inner_path, 0.3)).max() < 1e-3
    moved = []
    for each in positions:
        contact = each.result.contact
        inwards = contact.traction * np.exp(-((contact.across / 0.1) ** 2))[:, None]
        moved.append(replace(each, result=replace(each.result, contact=replace(contact, traction=inwards))))
    assert shear_differences(moved, run.inner_path, 0.3).min() > 0.05
