"""The figures that a study can name, and those that it gathers by default, for each computation."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields

from evolvent.dynamics.results.curves import LOADED, SECANT, TANGENT
from evolvent.dynamics.results.design_load import EXCITATION_FACTS
from evolvent.dynamics.results.response import DYNAMICS, RESPONSE
from evolvent.dynamics.results.tables import HARMONICS
from evolvent.dynamics.results.transient.facts import TRANSIENT_FACTS
from evolvent.dynamics.results.transient.rows import TRANSIENT
from evolvent.results.archive.error_bar_data import FigureErrors
from evolvent.run.study.plan.study_file import StudyFile
from evolvent.run.study.results.check_figures import CHECK, CheckFigures
from evolvent.run.study.results.gathering import ERROR, Figure
from evolvent.run.study.results.study_table import OWN
from evolvent.scene.schema.errors import InputProblem, SceneError
from evolvent.scene.schema.guesses.nearest_key import nearest_key
from evolvent.strength.fatigue.criterion import (
    BELOW,
    CONTACT_PRESSURE,
    DANG_VAN,
    MAXIMUM_SHEAR,
    SURFACE,
    VON_MISES,
    Criterion,
)
from evolvent.strength.results.fatigue_rows import FATIGUE
from evolvent.strength.results.tables import COMPRESSION, STANDARD, STRENGTH, TENSION
from evolvent_meshes.gears.member import Member

SUMMARY, WEAR = "summary.json", "wear.json"


def _of_check() -> list[Figure]:
    return [Figure(each.name, CHECK.name, each.name) for each in fields(CheckFigures)]


def _of_run() -> list[Figure]:
    names = [each.name for each in fields(FigureErrors)]
    own = [Figure(name, SUMMARY, name, "frictions", error=f"estimated_error.{name}") for name in names]
    return [*own, *(Figure(name, SUMMARY, name, "frictions") for name in ("kink_pressure_MPa", "balance_error"))]


def _of_losses() -> list[Figure]:
    names = "loss_percent", "loss_at_1000_rpm_W"
    return [Figure(f"largest_{name}", "losses.csv", name, statistic="max", error=f"{name}{ERROR}") for name in names]


OF_LINE_CONTACT = "face_load_factor", "largest_pressure_MPa"
"""Figures of an excitation in line contact alone."""


def _of_excitation() -> list[Figure]:
    def of(name: str, quantity: str, column: str) -> Figure:
        where: dict[str, str | int | float] = {"quantity": quantity, "harmonic": 1}
        return Figure(name, HARMONICS.name, column, where=where, error=f"{column}{ERROR}")

    return [
        of("transmission_error_peak_to_peak_um", LOADED, "peak_to_peak"),
        of("transmission_error_mean_um", LOADED, "mean"),
        of("transmission_error_harmonic_1_um", LOADED, "amplitude"),
        of("tangent_stiffness_mean_N_per_um", TANGENT, "mean"),
        of("tangent_stiffness_peak_to_peak_N_per_um", TANGENT, "peak_to_peak"),
        of("secant_stiffness_mean_N_per_um", SECANT, "mean"),
        *(Figure(name, EXCITATION_FACTS.name, name, error=f"{name}{ERROR}") for name in OF_LINE_CONTACT),
    ]


def _of_dynamics() -> list[Figure]:
    def over_speed(name: str, column: str) -> Figure:
        return Figure(name, RESPONSE.name, column, statistic="max")

    return [
        over_speed("largest_dynamic_factor", "dynamic_factor"),
        over_speed("largest_equivalent_amplitude_um", "equivalent_amplitude_um"),
        over_speed("largest_separated_share", "separated_share"),
        *(
            Figure(name, DYNAMICS.name, name, error=f"{name}{ERROR}")
            for name in ("natural_speed_rpm", "mean_stiffness_N_per_um")
        ),
    ]


def _of_strength() -> list[Figure]:
    def of(gear: str, name: str, method: str, error: str = "") -> Figure:
        where: Mapping[str, str | int | float] = {"gear": gear, "method": method}
        return Figure(f"{gear}_{name}_MPa", STRENGTH.name, "stress_MPa", where=where, error=error)

    found = []
    for gear in (member.label for member in Member):
        found += [
            of(gear, "tension", TENSION, f"stress_MPa{ERROR}"),
            of(gear, "compression", COMPRESSION, f"stress_MPa{ERROR}"),
            of(gear, "ISO_2006", f"{STANDARD}2006"),
            of(gear, "ISO_2019", f"{STANDARD}2019"),
            of(gear, "equal_shares_b", "equal shares, outer point of double contact (b)"),
            of(gear, "Pedrero", "Pedrero's shares, largest over the path"),
        ]
    return found


def _of_transient() -> list[Figure]:
    def over_cases(name: str, file: str, column: str) -> Figure:
        return Figure(name, file, column, statistic="max", error=f"{column}{ERROR}")

    return [
        over_cases("largest_mesh_force_N", TRANSIENT.name, "mesh_force_N"),
        over_cases("transmission_error_peak_to_peak_um", TRANSIENT_FACTS.name, "peak_to_peak_um"),
        over_cases("largest_pressure_MPa", TRANSIENT_FACTS.name, "max_pressure_MPa"),
        Figure("steady", TRANSIENT_FACTS.name, "steady", statistic="min"),
    ]


def _of_fatigue() -> list[Figure]:
    def of(gear: str, name: str, criterion: Criterion, place: str) -> Figure:
        where: dict[str, str | int | float] = {"gear": gear, "criterion": criterion.name, "place": place}
        return Figure(f"{gear}_{name}_MPa", FATIGUE.name, "value", where=where, error=f"value{ERROR}")

    shown = (("contact_pressure", CONTACT_PRESSURE, SURFACE), ("maximum_shear", MAXIMUM_SHEAR, BELOW),
             ("von_mises", VON_MISES, BELOW), ("dang_van", DANG_VAN, BELOW))
    return [of(member.label, *each) for member in Member for each in shown]


def _of_wear() -> list[Figure]:
    found = []
    for gear in (member.label for member in Member):
        for name in ("deepest_um", "volume_mm3"):
            found.append(Figure(f"{gear}_{name}", WEAR, f"{gear}.{name}", "reports", statistic="last"))
    for name in ("max_pressure_MPa", "transmission_error_peak_to_peak_um", "mesh_stiffness_N_per_mm_um"):
        found.append(Figure(f"worn_{name}", WEAR, name, "reports", statistic="last"))
    return found + _of_run()


CATALOGUE: Mapping[str, list[Figure]] = {
    "check": _of_check(), "run": _of_run(), "losses": _of_losses(), "excitation": _of_excitation(),
    "dynamics": _of_dynamics(), "transient": _of_transient(), "strength": _of_strength(), "fatigue": _of_fatigue(),
    "wear": _of_wear(),
}
"""Computation -> named figures that its scenes have; others have those of [[figure]] alone."""
DEFAULTS: Mapping[str, tuple[str, ...]] = {
    "check": ("transverse_contact_ratio", "total_contact_ratio", "pitch_point_pressure_MPa", "pinion_tip_thickness_mm",
              "wheel_tip_thickness_mm"),
    "run": ("transmission_error_peak_to_peak_um", "max_pressure_MPa", "mesh_stiffness_N_per_mm_um", "loss_percent",
            "face_load_factor"),
    "losses": ("largest_loss_percent",),
    "excitation": ("transmission_error_peak_to_peak_um", "tangent_stiffness_mean_N_per_um"),
    "dynamics": ("largest_dynamic_factor", "largest_equivalent_amplitude_um", "natural_speed_rpm"),
    "strength": tuple(f"{gear}_{name}_MPa" for gear in ("pinion", "wheel") for name in ("tension", "compression",
                                                                                      "ISO_2006", "ISO_2019")),
    "transient": ("largest_mesh_force_N", "transmission_error_peak_to_peak_um", "largest_pressure_MPa", "steady"),
    "fatigue": tuple(f"{gear}_{name}_MPa" for gear in ("pinion", "wheel") for name in ("contact_pressure", "dang_van")),
    "wear": ("pinion_deepest_um", "wheel_deepest_um", "worn_max_pressure_MPa",
             "worn_transmission_error_peak_to_peak_um"),
}
"""Computation -> names of the figures that are gathered where a study names none."""


def gathered_figures(study: StudyFile, source: str) -> list[Figure]:
    """The figures of a study's table: those that it names, or those of its computation by default, and its own.

    source: path of the study file. Raises SceneError where a name is unknown or stands for two.
    """
    own = [Figure(**each.model_dump()) for each in study.figure]
    _require_own_columns(own, study, source)
    every = [*CATALOGUE.get(study.compute, []), *own]
    known = {each.name: each for each in every}
    names = study.figures or (*DEFAULTS.get(study.compute, ()), *(each.name for each in own))
    for name in names:
        if name not in known:
            meant = nearest_key(name, known)
            allowed = f'figures of "{study.compute}" (docs/studies.md), or names of [[figure]]'
            remedy = f"did you mean {meant}?" if meant else f"take some of {', '.join(known)}"
            raise SceneError([InputProblem("figures", f"{name!r}, an unknown figure", allowed, remedy)], source)
        if list(names).count(name) > 1 or [each.name for each in every].count(name) > 1:
            remedy = "name each figure once, and other figures otherwise"
            raise SceneError([InputProblem("figures", f"{name!r} twice", "different names", remedy)], source)
    return [known[name] for name in names]


def _require_own_columns(own: Sequence[Figure], study: StudyFile, source: str) -> None:
    """Raises SceneError where a [[figure]] has the name of another column of the table."""
    parameters = [key for keys in study.parts().values() for key in keys]
    errors = [f"{each.name}{ERROR}" for each in CATALOGUE.get(study.compute, []) if each.error]
    for number, figure in enumerate(own):
        if figure.name in (*OWN, *parameters, *errors):
            allowed = f"a name of its own: the table has {', '.join(OWN)}, parameters and error bars"
            problem = InputProblem(f"figure[{number}].name", f"{figure.name!r}, another column of the table", allowed,
                                   "name the figure otherwise")
            raise SceneError([problem], source)
