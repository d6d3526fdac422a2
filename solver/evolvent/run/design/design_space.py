"""The variants of a design: a lattice of flank modifications, and the scenes that have them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import product
from typing import Any

import numpy as np
from scipy.stats import qmc

from evolvent.scene.scene import Scene, derived_values
from evolvent.scene.schema.dependence import value_at
from evolvent.scene.schema.design import CORNERS, LOSS, SPREAD, DesignSection, expanded, keys_of_both
from evolvent.scene.schema.flank import LEAST
from evolvent_meshes.arrays import Floats, Ints
from evolvent_meshes.gears.modifications.modifications import SIGNED


@dataclass(frozen=True)
class DesignSpace:
    """The modifications that vary, in steps, and those that deviate in production."""

    scene: Scene
    """Scene whose modifications vary."""
    section: DesignSection
    """Section [design] of the scene."""

    @property
    def keys(self) -> tuple[str, ...]:
        """(k,) keys of the scene of which a variant has values: those that vary, then those that deviate only."""
        return tuple(dict.fromkeys([*expanded(self.section.vary), *expanded(self.section.tolerances)]))

    @property
    def counts(self) -> tuple[int, ...]:
        """(v,) number of values of each row of `vary`."""
        return tuple(row.size for row in self.section.vary)

    @property
    def friction(self) -> float:
        """Friction coefficient of the loss; 0 where no loss is asked for."""
        return self.scene.contact.friction[0] if LOSS in self.section.asked else 0.0

    @property
    def as_it_stands(self) -> Floats:
        """(k,) values of the scene, those included that follow from other keys."""
        given, derived = [value_at(self.scene, name) for name in self.keys], derived_values(self.scene)
        return np.array([derived[name] if value is None else value for name, value in zip(self.keys, given)])

    def variants(self, points: Ints) -> Floats:
        """Variants (n, k) at points (n, v) of the lattice."""
        found = np.tile(self.as_it_stands, (len(points), 1))
        for row, index in zip(self.section.vary, points.T):
            values = np.minimum(row.lowest + row.step * index, row.highest)
            for name in keys_of_both(row.key):
                found[:, self.keys.index(name)] = values
        return found

    def lattice(self) -> Ints:
        """All points (n, v), the last axis varying fastest."""
        return np.array(list(product(*map(range, self.counts))))

    def sobol(self, count: int) -> Ints:
        """Different points (n, v), n ≤ count, evenly in the lattice: of a Sobol sequence (SciPy's, scrambled)."""
        sequence = qmc.Sobol(len(self.counts), seed=0).random_base2(math.ceil(math.log2(count)))[:count]
        return np.unique((sequence * np.array(self.counts)).astype(int), axis=0)

    def deviating(self, variant: Floats) -> Floats:
        """Variants (n, k) within the tolerances of one (k,): it itself, the combinations of extreme deviations, and
        some in between (a Sobol sequence). Amounts that cannot be negative end at 0."""
        amounts = {name: row.amount for row in self.section.tolerances for name in keys_of_both(row.key)}
        if not amounts:
            return variant[None]
        count = len(amounts)
        corners = np.array(list(product((-1.0, 1.0), repeat=count)) if count <= CORNERS else [])
        ones = np.concatenate([np.eye(count), -np.eye(count)]) if count > 1 else np.zeros((0, count))
        between = 2.0 * qmc.Sobol(count, seed=0).random(SPREAD) - 1.0
        parts = np.concatenate([corners.reshape(-1, count), ones, between])
        found = np.tile(variant, (len(parts) + 1, 1))
        for name, part in zip(amounts, parts.T):
            column = found[1:, self.keys.index(name)]
            column += amounts[name] * part
            if not _may_be_negative(name):
                column[column < LEAST] = 0.0  # smaller amounts are taken for millimetres
        return found

    def scene_of(self, variant: Floats) -> Scene:
        """The scene with a variant's (k,) values, which are not checked: its gear pair raises ImpossibleGears."""
        scene = self.scene
        for section, values in self._by_section(variant):
            scene = scene.changed(section, **values)
        return scene

    def _by_section(self, variant: Floats) -> Iterator[tuple[str, dict[str, Any]]]:
        """Names of sections with new values of their keys."""
        for section in dict.fromkeys(name.partition(".")[0] for name in self.keys):
            own = {name: float(value) for name, value in zip(self.keys, variant) if name.startswith(f"{section}.")}
            yield section, {name.partition(".")[2]: value for name, value in own.items()}


def _may_be_negative(name: str) -> bool:
    return name.partition(".")[2] in SIGNED or name.startswith("pair.")
