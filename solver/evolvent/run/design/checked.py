"""The best variants of a design: with error bars, beside the resolved contact, and within their tolerances."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from evolvent.gears.line.line_gears import MOST_ON_EDGES
from evolvent.results.archive.run_cost import Timings
from evolvent.results.tables.table import Table
from evolvent.run.design.evaluation import Variants
from evolvent.run.design.ranking import COLUMN
from evolvent.run.design.solved_variant import NOT_SOLVED, SolvedVariant
from evolvent.run.design.variant_mesh import ON_EDGES
from evolvent.scene.schema.design import FIGURES, DesignSection, Figure
from evolvent_meshes.arrays import Floats


@dataclass(frozen=True)
class BestRow:
    """A line of design_best.csv: the scene as it stands or one of the best variants, under a torque."""

    rank: int
    """1: the best variant, 2: the next one, ...; 0: the scene as it stands, where it is not one of them."""
    variant: int
    """Number of the variant, as in design.csv; 0 is the scene as it stands."""
    case: str
    """Names of the load cases with this torque, or its part of the scene's torque."""
    torque_Nm: float
    """Torque on the gear that load.on names."""
    transmission_error_peak_to_peak_um: float
    """Peak-to-peak transmission error in line contact; NaN where edges of tips bear under this torque or a lighter one.
    """
    transmission_error_peak_to_peak_um_error: float
    """Estimated error of it; NaN where it is not known."""
    tangent_stiffness_mean_N_per_um: float
    """Mean tangent stiffness of the mesh in line contact."""
    tangent_stiffness_mean_N_per_um_error: float
    """Estimated error of it."""
    face_load_factor: float
    """Face load factor K_Hβ (ISO 6336-1:2006, 7.2.2); NaN in the plane."""
    face_load_factor_error: float
    """Estimated error of it."""
    largest_pressure_MPa: float
    """Largest of Hertz' p_0, away from edges of tips and from starts of linear reliefs."""
    largest_pressure_MPa_error: float
    """Estimated error of it."""
    loss_percent: float
    """Friction loss over the input of the pitch in line contact, as of `evolvent losses`; NaN where it is neither a
    target nor has a limit, and where edges of tips bear under this torque."""
    loss_percent_error: float
    """Estimated error of it."""
    transmission_error_first_harmonic_um: float
    """Amplitude of the first mesh harmonic of the transmission error in line contact; NaN where the peak-to-peak value
    is."""
    transmission_error_first_harmonic_um_error: float
    """Estimated error of it."""
    resolved_peak_to_peak_um: float
    """Peak-to-peak transmission error with the contact resolved; NaN where it was not asked for."""
    resolved_peak_to_peak_um_error: float
    """Estimated error of it."""
    resolved_stiffness_mean_N_per_um: float
    """Mean tangent stiffness of the mesh with the contact resolved."""
    resolved_stiffness_mean_N_per_um_error: float
    """Estimated error of it."""
    resolved_loss_percent: float
    """Friction loss with the contact resolved; NaN where it was not asked for."""
    resolved_loss_percent_error: float
    """Estimated error of it."""
    resolved_first_harmonic_um: float
    """Amplitude of the first mesh harmonic of the transmission error with the contact resolved; NaN where it was not
    asked for."""
    resolved_first_harmonic_um_error: float
    """Estimated error of it."""
    band_left_out: int
    """Number of variants within its tolerances of which edges of tips bear, or that cannot be computed: the band is
    without them."""
    band_lowest_peak_to_peak_um: float
    """Least peak-to-peak transmission error of variants within its tolerances; NaN of the scene as it stands."""
    band_highest_peak_to_peak_um: float
    """Largest one of them."""
    band_lowest_face_load_factor: float
    """Least K_Hβ of variants within its tolerances."""
    band_highest_face_load_factor: float
    """Largest one of them."""
    band_lowest_pressure_MPa: float
    """Least p_0 of them."""
    band_highest_pressure_MPa: float
    """Largest one of them."""
    band_lowest_loss_percent: float
    """Least friction loss of them; NaN where it is neither a target nor has a limit."""
    band_highest_loss_percent: float
    """Largest one of them."""
    band_lowest_first_harmonic_um: float
    """Least amplitude of the first mesh harmonic of them."""
    band_highest_first_harmonic_um: float
    """Largest one of them."""


BEST = Table("design_best.csv", BestRow)


@dataclass(frozen=True, eq=False)
class Checked:
    """A variant whose line contact has error bars, and whose contact was resolved where that was asked for."""

    variant: int
    """Number of the variant."""
    line: SolvedVariant
    """The variant in line contact."""
    resolved: SolvedVariant = NOT_SOLVED
    """The variant with the contact resolved."""
    rank: int = 0
    """1 of the best variant; 0 of the scene as it stands where it is not one of the best."""
    band: Variants | None = None
    """b variants within its tolerances; None where it has no rank, and without tolerances."""

    @property
    def timings(self) -> Timings:
        """Wall time of all its solutions [s]."""
        return self.line.timings + self.resolved.timings

    def figure(self, name: Figure, torques: int) -> tuple[float, float]:
        """A figure's largest value under all torques, of which there are so many, and its error: of the line contact
        or, where edges bear, of the resolved one."""
        kind = dict(zip(FIGURES, ("error", "face_load", "pressure", "loss", "harmonic")))[name]
        for solved in (self.line, self.resolved):
            pairs = solved.figures(torques)[kind]
            if np.isfinite([value for value, _ in pairs]).all():
                return max(pairs)
        return math.nan, math.nan

    def rows(self, torques: Sequence[float], cases: Sequence[str]) -> Iterator[BestRow]:
        """A row for each torque [N·mm], ascending. cases: their names."""
        line, resolved = (each.figures(len(torques)) for each in (self.line, self.resolved))
        for j, (torque, case) in enumerate(zip(torques, cases)):
            yield BestRow(
                self.rank, self.variant, case, 1e-3 * torque, *line["error"][j], *line["stiffness"][j],
                *line["face_load"][j], *line["pressure"][j], *line["loss"][j], *line["harmonic"][j],
                *resolved["error"][j], *resolved["stiffness"][j], *resolved["loss"][j], *resolved["harmonic"][j],
                self._left_out(j), *self._band(j),
            )

    def _known(self, torque: int) -> Floats:
        """(b', 5) figures of variants within the tolerances, without those of which edges bear under a torque."""
        figures = np.zeros((0, ON_EDGES + 1)) if self.band is None else self.band.figures[:, torque]
        return np.asarray(figures[figures[:, ON_EDGES] <= MOST_ON_EDGES][:, [*COLUMN.values()]])

    def _left_out(self, torque: int) -> int:
        """Number of variants within the tolerances without figures under a torque."""
        return 0 if self.band is None else len(self.band.values) - len(self._known(torque))

    def _band(self, torque: int) -> Iterator[float]:
        """Least and largest of each figure within the tolerances."""
        known = self._known(torque)
        for column in known.T if len(known) else np.full((len(COLUMN), 1), math.nan):
            yield from (float(column.min()), float(column.max()))


def ranked(checked: Sequence[Checked], best: Sequence[int], section: DesignSection, torques: int) -> list[Checked]:
    """Variants with their ranks, the best one first. best: their numbers as line contact has it, which is what counts
    but for the transmission error where edges bear; the others get no rank and come last. torques: their number."""
    others = [each for each in checked if each.variant not in best]
    among = sorted((each for each in checked if each.variant in best), key=lambda each: best.index(each.variant))
    if section.targets == FIGURES[:1]:
        most = min((limit.most for limit in section.limits if limit.figure == FIGURES[0]), default=math.inf)
        sizes = {each.variant: each.figure(FIGURES[0], torques)[0] for each in among}
        among.sort(key=lambda each: (not sizes[each.variant] <= most, sizes[each.variant]))
    return [*(replace(each, rank=rank) for rank, each in enumerate(among, 1)), *others]
