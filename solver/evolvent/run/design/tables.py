"""Table of a design: all variants that were computed."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from evolvent.results.tables.table import Table
from evolvent.run.design.evaluation import Variants
from evolvent.run.design.ranking import Ranking
from evolvent.scene.schema.design import FIGURES, DesignSection

ALLOWED, FRONT, BEYOND, EDGES, FAILED = "allowed", "front", "beyond limits", "edges bear", "failed"
"""Status of a variant."""


@dataclass(frozen=True)
class VariantRow:
    """A line of design.csv: a variant, in line contact."""

    variant: int
    """Number of the variant, in the order of computation; 0 is the scene as it stands."""
    values: dict[str, float]
    """Values of the keys that vary or deviate: a column each, by the name of the key."""
    transmission_error_peak_to_peak_um: float
    """Peak-to-peak transmission error, the largest under all torques; NaN where edges of tips bear under one."""
    face_load_factor: float
    """Face load factor K_Hβ (ISO 6336-1:2006, 7.2.2), the largest under all torques; NaN in the plane."""
    largest_pressure_MPa: float
    """Largest of Hertz' p_0 under all torques, away from edges of tips and from starts of linear reliefs."""
    loss_percent: float
    """Friction loss over the input of the pitch, the largest under all torques; NaN where it is neither a target nor
    has a limit."""
    transmission_error_first_harmonic_um: float
    """Amplitude of the first mesh harmonic of the transmission error, the largest under all torques; NaN where edges of
    tips bear under one."""
    on_edges_percent: float
    """Largest part of the load that edges of tips bear. Above 1 % the contact is no line contact, and the variant has
    no figures."""
    status: str
    """allowed; front: allowed, and no other variant beats it in all targets; beyond limits: a figure exceeds its limit;
    edges bear: edges of tips bear under a torque; failed: it cannot be computed."""
    reason: str
    """Why it cannot be computed; empty where it can."""


DESIGN, BAND = Table("design.csv", VariantRow), Table("design_band.csv", VariantRow)


def variant_rows(section: DesignSection, keys: Sequence[str], variants: Variants) -> Iterator[VariantRow]:
    """All variants. keys: (k,) whose values they have."""
    ranking = Ranking(section, variants.figures)
    edges, allowed, front = ranking.bears_on_edges, ranking.is_allowed, ranking.front
    figures = np.column_stack([ranking.largest(name) for name in FIGURES])
    figures[edges] = math.nan
    for number, (values, found) in enumerate(zip(variants.values, figures)):
        status = FAILED if variants.reasons[number] else EDGES if edges[number] else BEYOND
        if allowed[number]:
            status = FRONT if front[number] and len(section.targets) > 1 else ALLOWED
        peak_to_peak, factor, pressure, loss, harmonic = map(float, found)
        yield VariantRow(
            number, dict(zip(keys, map(float, values))), peak_to_peak, factor, pressure, loss, harmonic,
            100.0 * float(ranking.on_edges[number]), status, variants.reasons[number],
        )
