"""The search on made-up figures: an error that is the distance from a point of the lattice."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import cast

import numpy as np
import pytest

from evolvent.run.design.design_space import DesignSpace
from evolvent.run.design.evaluation import Evaluation, Variants
from evolvent.run.design.search import search
from evolvent.run.design.variant_mesh import FIGURES
from evolvent_meshes.arrays import Floats
from tests.support.gear_cases import spur_scene

VARY = '[["pinion.tip_relief_um",0.0,40.0,1.0],["wheel.tip_relief_um",0.0,40.0,1.0]]'
LEAST = np.array([23.0, 11.0])


@dataclass
class Distances:
    """In place of an evaluation: a bowl with a ripple, whose least value is at `LEAST`; it has no other minimum, as its
    slope of 0.1 is more than the 0.09 of the ripple."""

    asked: set[tuple[float, ...]] = field(default_factory=set)

    def of(self, values: Floats) -> Variants:
        self.asked |= {tuple(row) for row in values.tolist()}
        off = np.abs(values - LEAST).sum(axis=1)
        error = 1.0 + 0.1 * off + 0.09 * np.sin(off) ** 2
        return Variants(values, np.stack([error, *[0.0 * off] * (FIGURES - 1)], axis=-1)[:, None], ("",) * len(off))


def searched(*settings: str) -> set[tuple[float, ...]]:
    scene = spur_scene(f"design.vary={VARY}", *settings)
    assert scene.design is not None
    distances = Distances()
    search(DesignSpace(scene, scene.design), cast("Evaluation", distances), False)
    return distances.asked


def test_all_where_they_are_no_more_than_the_samples() -> None:
    """41 × 41 = 1681 variants."""
    assert len(searched("design.samples=1681")) == 1681


def test_an_even_sample() -> None:
    """Sobol points: 60, repetitions left out; each quarter of the square has some."""
    found = np.array(sorted(searched("design.samples=60", 'design.search="sobol"')))
    assert 50 <= len(found) <= 60
    assert {tuple(row) for row in (found > 20.0).tolist()} == {(a, b) for a in (False, True) for b in (False, True)}


@pytest.mark.parametrize("samples", [60, 200])
def test_an_evolution_finds_the_least_value(samples: int) -> None:
    """With few samples by the neighbours, whatever SciPy's evolution ends at; not many more than asked for."""
    found = searched(f"design.samples={samples}")
    assert tuple(LEAST.tolist()) in found and len(found) < samples + 150
