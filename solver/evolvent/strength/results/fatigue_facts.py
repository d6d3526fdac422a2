"""What the figures of contact fatigue rest on."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import asdict, dataclass

import numpy as np

from evolvent.results.tables.tables import without_nan
from evolvent.strength.fatigue.fitted_tractions import shear_differences
from evolvent.strength.fatigue.flank_loads import LoadedPosition

FATIGUE_FACTS = "fatigue.json"


@dataclass(frozen=True)
class FatigueFacts:
    """An entry of fatigue.json: a friction coefficient."""

    friction: float
    """μ."""
    points: int
    """Points of each flank at which criteria are evaluated: slices of the contact at all positions."""
    left_out_percent: float
    """Slices under load that are left out, as they lie on a tip edge or in its zone, where pressure is singular."""
    largest_pressure_MPa: float
    """Of these points."""
    largest_pressure_MPa_error: float
    """Error bar of a run's largest pressure; null without a coarse companion (`output.error_bars`)."""
    fitted_shear_median_percent: float
    """Pressures enter as fitted half-ellipses. Largest shear stress below a slice under the pressures and friction as
    solved over that under the half-ellipse: the median difference."""
    fitted_shear_most_percent: float
    """Nine in ten of these differences are at most so large."""


def fatigue_facts(
    friction: float, positions: Sequence[LoadedPosition], inner: tuple[float, float], poisson: float, error: float
) -> FatigueFacts:
    """At one friction coefficient. inner: see `RunData.inner_path`; error: of the largest pressure [MPa]."""
    loaded = sum(int((each.cut.line_load > 0.0).sum()) for each in positions)
    peaks = np.concatenate([each.loads(inner).peak for each in positions])
    differences = 100.0 * shear_differences(positions, inner, poisson)
    known = len(differences) > 0
    return FatigueFacts(
        friction, len(peaks), 100.0 * (1.0 - len(peaks) / loaded) if loaded else 0.0,
        float(peaks.max()) if known else np.nan, error,
        float(np.median(differences)) if known else np.nan,
        float(np.quantile(np.abs(differences), 0.9)) if known else np.nan,
    )  # fmt: skip


def facts_text(facts: Sequence[FatigueFacts]) -> str:
    """Content of fatigue.json."""
    return json.dumps(without_nan([asdict(each) for each in facts]), ensure_ascii=False, indent=1) + "\n"
