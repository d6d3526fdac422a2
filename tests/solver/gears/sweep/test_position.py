"""One gear position: what it depends on, and what not."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.gears.gear_model import GearModel
from evolvent.gears.sweep import position
from evolvent.gears.sweep.position import PositionResult, shared_position, solve_position
from evolvent_meshes.gears.member import Member
from tests.support.gear_cases import helical_scene, model_of, spur_scene

ANGLE = np.radians(2.2)
STARTS = (0.0, 1e-5, -3.3e-4, 1.7e-4)  # rad of the loaded gear


def solved(model: GearModel, start: float) -> PositionResult:
    """Frictionless, the search starting from a rotation of the loaded gear."""
    extra = (start, 0.0) if model.load.on == Member.PINION else (0.0, start)
    return solve_position(model, shared_position(model, ANGLE, extra, [0.0], None), 0.0, None, 0.01)[0]


def apart(model: GearModel) -> float:
    """Largest relative difference of transmission error and largest pressure of all starts from the first."""
    first, *others = (solved(model, start) for start in STARTS)
    pairs = [(getattr(r, name), getattr(first, name)) for r in others for name in ("transmission_error",)]
    pairs += [(r.pressure.max(), first.pressure.max()) for r in others]
    return max(abs(a / b - 1.0) for a, b in pairs)


@pytest.mark.parametrize("make", [spur_scene, helical_scene])
def test_where_a_search_starts_makes_no_difference(make) -> None:  # type: ignore[no-untyped-def]
    """Starts up to 70 µm of flank apart: the same result within 1e-8, as searches are made at multiples of a small
    rotation, in the end at the one nearest to the solution."""
    assert apart(model_of(make("contact.friction=0"))) < 1e-8


def test_it_would_without_the_multiples(monkeypatch: pytest.MonkeyPatch) -> None:
    """The check above sees searches that are made wherever the last one led to."""
    monkeypatch.setattr(position, "_at_a_multiple", lambda model, stand: stand)
    assert apart(model_of(helical_scene("contact.friction=0"))) > 1e-7
