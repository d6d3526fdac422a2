"""Which variants are best: the smallest target within the limits; of several targets, those that no other one beats."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from evolvent.gears.line.line_gears import MOST_ON_EDGES
from evolvent.run.design.variant_mesh import FACE_LOAD, FIRST_HARMONIC, LOST, ON_EDGES, PEAK_TO_PEAK, PRESSURE
from evolvent.scene.schema.design import FIGURES, DesignSection, Figure
from evolvent_meshes.arrays import Bools, Floats, Ints

COLUMN = dict(zip(FIGURES, (PEAK_TO_PEAK, FACE_LOAD, PRESSURE, LOST, FIRST_HARMONIC)))
"""Name of a figure -> its column."""
COMPETING = 0.2
"""Largest part of the load that edges of tips may bear of a variant that competes, where its contact is resolved before
it is called the best. With 12 % the peak-to-peak transmission error of He's pair with a long relief is 1 % off, and the
least one over the relief lies where tips just bear."""
SAME = 1e-3
"""Relative difference below which two figures are equal: they are known to some per mille."""
BEYOND_LIMITS, ON_EDGE, WITHOUT = 1e6, 2e6, 3e6
"""Costs of variants, beyond every figure: that exceed a limit, whose edges of tips bear, and that have no figures. What
they have too much is added, so that a search is led back."""


@dataclass(frozen=True, eq=False)
class Ranking:
    """Figures of n variants, as the section [design] judges them."""

    section: DesignSection
    """Targets and limits."""
    figures: Floats
    """(n, m, f) figures under each torque, see `VariantMesh`."""
    is_resolved: bool = False
    """Whether the contact of the best variants will be resolved."""

    @property
    def most_on_edges(self) -> float:
        """Largest part of the load that edges of tips may bear of a variant that competes: `COMPETING` where a resolved
        contact will have its targets and limits, which are no other than the transmission error."""
        return COMPETING if self.is_resolved and self.section.asked == {FIGURES[0]} else MOST_ON_EDGES

    def largest(self, name: Figure) -> Floats:
        """(n,) a figure's largest value under all torques; NaN where one is missing."""
        return np.asarray(self.figures[..., COLUMN[name]].max(axis=1))

    @property
    def on_edges(self) -> Floats:
        """(n,) largest part of the load that edges of tips bear."""
        return np.asarray(self.figures[..., ON_EDGES].max(axis=1))

    @property
    def bears_on_edges(self) -> Bools:
        """(n,) whether edges of tips bear, so that the variant is no line contact."""
        return np.asarray(self.on_edges > MOST_ON_EDGES)

    @property
    def excess(self) -> Floats:
        """(n,) largest ratio of a figure and its limit, less 1; −∞ without limits, ∞ where such a figure is missing."""
        ratios = [self.largest(limit.figure) / limit.most - 1.0 for limit in self.section.limits]
        if not ratios:
            return np.full(len(self.figures), -math.inf)
        return np.nan_to_num(np.max(ratios, axis=0), nan=math.inf)

    @property
    def is_allowed(self) -> Bools:
        """(n,) whether a variant competes: it has figures, within the limits."""
        known = np.isfinite([self.largest(name) for name in self.section.targets]).all(axis=0)
        return np.asarray(known & (self.on_edges <= self.most_on_edges) & (self.excess <= 0.0))

    def cost(self, target: Figure) -> Floats:
        """(n,) what a search makes small: the target, beyond all of its values where a variant is not allowed."""
        value, excess = self.largest(target), self.excess
        cost = np.where(excess > 0.0, BEYOND_LIMITS * (1.0 + np.tanh(np.maximum(excess, 0.0)) / 2.0), value)
        cost = np.where(self.on_edges > self.most_on_edges, ON_EDGE * (1.0 + self.on_edges / 4.0), cost)
        return np.where(np.isfinite(cost) & (excess < math.inf), cost, WITHOUT)

    @property
    def front(self) -> Bools:
        """(n,) whether a variant is allowed and no other one is better in one target and no worse in the others."""
        allowed = np.flatnonzero(self.is_allowed)
        values = np.column_stack([self.largest(name)[allowed] for name in self.section.targets])
        found = np.zeros(len(self.figures), dtype=bool)
        for number, row in zip(allowed, values):
            beaten = (values <= (1.0 + SAME) * row).all(axis=1) & (values < (1.0 - SAME) * row).any(axis=1)
            found[number] = not beaten.any()
        return found

    def best(self, count: int) -> Ints:
        """Indices of the best variants, at most `count`: with one target those with its smallest values; with several
        of the front, the best of each target in turn. Of equal ones the transmission error decides."""
        targets = self.section.targets
        among = np.flatnonzero(self.front if len(targets) > 1 else self.is_allowed)
        orders = [among[np.lexsort([self.largest(FIGURES[0])[among], self._steps(name)[among]])] for name in targets]
        return np.array(_in_turn(orders)[:count], dtype=int)

    def _steps(self, name: Figure) -> Floats:
        """(n,) a figure in steps of `SAME`, by which equal ones have the same rank."""
        return np.asarray(np.round(np.log(np.maximum(self.largest(name), 1e-12)) / SAME))

    def like(self, best: int, error: float) -> Ints:
        """Indices of other variants that are allowed and whose first target is within an error of that of the best."""
        value = self.largest(self.section.targets[0])
        near = self.is_allowed & (np.abs(value - value[best]) <= error)
        near[best] = False
        return np.flatnonzero(near)

    def left_out(self, value: float) -> Ints:
        """Indices of variants that do not compete as edges bear too much, though line contact estimates a smaller
        transmission error than this [µm] for them."""
        return np.flatnonzero((self.on_edges > self.most_on_edges) & (self.largest(FIGURES[0]) < value))

    @property
    def checked(self) -> list[int]:
        """Indices of the best variants that are looked at closely: as many as the section asks for, and the best one of
        which no edges bear."""
        best = self.best(max(1, self.section.verified))
        without = replace(self, is_resolved=False).best(1)
        return list(dict.fromkeys([*map(int, best), *map(int, without)]))


def _in_turn(orders: Sequence[Ints]) -> list[int]:
    """The first of each order, then the second of each, each index once."""
    return list(dict.fromkeys(int(number) for row in zip(*orders) for number in row))
