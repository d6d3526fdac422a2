"""The search for good variants: all of them, an even sample, or an evolution towards each target."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
from scipy.optimize import differential_evolution

from evolvent.run.design.design_space import DesignSpace
from evolvent.run.design.evaluation import Evaluation
from evolvent.run.design.ranking import Ranking
from evolvent.scene.schema.design import Figure
from evolvent_meshes.arrays import Floats, Ints

PER_VARIABLE, LEAST_POPULATION = 8, 16
"""Members of a generation per modification that varies, and at least."""
GENERATIONS = 6
"""Least number of generations: populations are smaller where few samples are allowed."""

Costs = Callable[[Ints], Floats]
"""Function of points (n, v) of the lattice: their costs (n,)."""


def search(space: DesignSpace, evaluation: Evaluation, is_resolved: bool) -> None:
    """Computes the variants of a design that its section asks for. Collective. is_resolved: as of `Ranking`. Raises as
    `Evaluation.of`."""
    section = space.section
    if section.size <= section.samples:
        evaluation.of(space.variants(space.lattice()))
    elif section.search == "sobol":
        evaluation.of(space.variants(space.sobol(section.samples)))
    else:
        for target in section.targets:
            costs = partial(_costs, space, evaluation, is_resolved, target)
            _towards(space, costs, section.samples // len(section.targets))


def _costs(space: DesignSpace, evaluation: Evaluation, is_resolved: bool, target: Figure, points: Ints) -> Floats:
    """Costs (n,) of points (n, v) of the lattice."""
    return Ranking(space.section, evaluation.of(space.variants(points)).figures, is_resolved).cost(target)


def _towards(space: DesignSpace, costs: Costs, samples: int) -> None:
    """Differential evolution (SciPy's) on the lattice, which starts from an even sample, and from its best point on to
    ever better neighbours until there is none."""
    axes = len(space.counts)
    size = max(5, min(max(PER_VARIABLE * axes, LEAST_POPULATION), samples // GENERATIONS))
    start = space.sobol(size)
    start = start if len(start) >= 5 else space.lattice()[:5]  # SciPy wants five at least
    found = differential_evolution(
        lambda columns: costs(columns.T.round().astype(int)), [(0, count - 1) for count in space.counts],
        init=start.astype(float), integrality=[True] * axes, maxiter=max(1, samples // len(start) - 1), seed=0,
        polish=False, vectorized=True, updating="deferred",
    )
    _downhill(space, costs, found.x.round().astype(int))


def _downhill(space: DesignSpace, costs: Costs, point: Ints) -> None:
    """From a point to the best of its neighbours along the axes, until none is better."""
    steps = np.concatenate([np.eye(len(point), dtype=int), -np.eye(len(point), dtype=int)])
    while True:
        near = np.array([each for each in point + steps if ((each >= 0) & (each < space.counts)).all()])
        values = costs(np.concatenate([point[None], near]))
        best = int(values.argmin())
        if best == 0:
            return
        point = near[best - 1]
