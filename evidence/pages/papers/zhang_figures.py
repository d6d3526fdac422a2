"""`python -m evidence.pages.papers.zhang_figures --out DIR`: computes and keeps the figures of docs/zhang2023.md.

The demo over torque and rack tip radius, the gears in space, the studies over addendum and pressure angle, and finer
fillets. Runs that an earlier call has ended are read again. `python -m evidence.pages` then writes the page.
"""

from __future__ import annotations

import math
import sys
import tomllib
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise

from scipy.optimize import brentq

from evidence.checkout import DEMOS, DOCS, ROOT
from evidence.pages.papers.kept_runs.kept import Named
from evidence.pages.papers.kept_runs.runs import Row, Runs, keep_figures, read
from evidence.processes import Cost, module_run
from evolvent.scene.scene import load_scene, scene_from_values
from evolvent.strength.standard.root_stress import RootLoad, boundary_stresses
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair

KEPT = "zhang2023/figures.csv"
COMMAND = "python -m evidence.pages.papers.zhang_figures --out DIR"
SCENE = DEMOS / "zhang2023.toml"
PLANE = "pinion.face_width_mm=25"
PAPER = {"pinion": 490.6, "wheel": 487.01}
"""MPa, at 500 N·m."""
RADII = 15, 20, 25, 30
"""Of the rack's tip, in hundredths of a module."""
REFINEMENTS = 1, 2, 4, 8
DEDENDUM = 1.60
"""As in these studies."""
SHORTENING = 0.0094
"""Δy of the paper's Table 1."""


@dataclass(frozen=True)
class ZhangRuns(Runs):
    """The runs of Zhang's pair."""

    def strength(self, name: str, *settings: str) -> tuple[list[Row], Cost]:
        """strength.csv of Zhang's pair."""
        set_to = [f"--set={each}" for each in ("output.pictures=false", *settings)]
        words = module_run("evolvent", "strength", SCENE, "--quiet", "--overwrite", *set_to)
        folder, cost = self.ended(name, "strength.csv", *words)
        return read(folder / "strength.csv"), cost

    def study(self, name: str) -> list[Row]:
        """study.csv of a study of demos/studies."""
        words = module_run("evolvent", "study", DEMOS / "studies" / f"{name}.toml", "--quiet", "--workers", 1)
        return read(self.ended(name, "study.csv", *words)[0] / "study.csv")


def figures(runs: ZhangRuns) -> Named:
    """(name, value) of each figure. Raises RunFailed."""
    yield from _contact_ratio(load_scene(SCENE).gear_pair())
    folder, _ = runs.ended("demo", "table.csv", sys.executable, ROOT / "demos/zhang2023.py")
    rows = read(folder / "table.csv")
    yield from _demo(rows)
    yield from _reasons(rows)
    yield from _in_space(runs)
    yield from _bores(runs)
    yield from _root_mesh(runs)
    yield from _studies(runs)


def _contact_ratio(pair: GearPair) -> Named:
    """At the scene, and the common addendum coefficient at which it is 2."""

    def ratio(addendum: float) -> float:
        module = pair.pinion.normal_module
        tips = (gear.reference_diameter + 2.0 * module * (addendum + gear.profile_shift - SHORTENING)
                for gear in pair.gears)
        pinion, wheel = (replace(gear, tip_diameter=tip) for gear, tip in zip(pair.gears, tips))
        return replace(pair, pinion=pinion, wheel=wheel).transverse_contact_ratio

    yield "contact_ratio", pair.transverse_contact_ratio
    yield "addendum_of_ratio_2", float(brentq(lambda addendum: ratio(addendum) - 2.0, 1.15, 1.25))


def _demo(rows: list[Row]) -> Named:
    """Each gear, rack tip radius and friction at 500 N·m beside the paper; formulas over finite elements by torque."""
    for row in rows:
        torque, radius, still = float(row["torque_Nm"]), float(row["rack_tip_radius_modules"]), row["friction"] == "0.0"
        head = f"{row['gear']}_{torque:.0f}_{100 * radius:.0f}_{'still' if still else 'sliding'}"
        for name in ("tension_MPa", "tension_MPa_error", "tension_rotation_deg", "tension_angle_deg",
                     "compression_MPa", "compression_MPa_error", "at_b_MPa", "equal_shares_b_MPa"):
            yield f"{head}_{name}", float(row[name])
        yield f"{head}_b_over_percent", 100.0 * (float(row["equal_shares_b_MPa"]) / float(row["tension_MPa"]) - 1.0)
        if torque == 500.0:
            yield f"{head}_off_percent", 100.0 * (float(row["tension_MPa"]) / PAPER[row["gear"]] - 1.0)


def _reasons(rows: list[Row]) -> Named:
    """What torque, rack tip radius and friction change."""
    found = {(row["gear"], float(row["torque_Nm"]), round(100.0 * float(row["rack_tip_radius_modules"])),
              float(row["friction"])): float(row["tension_MPa"]) for row in rows}
    costs = [
        100.0 * (1.0 - found[gear, 500.0, wide, 0.0] / found[gear, 500.0, tight, 0.0])
        for gear in PAPER for tight, wide in pairwise(RADII)
    ]
    yield "least_cost_percent", min(costs)
    yield "largest_cost_percent", max(costs)
    for radius in RADII[:2]:
        offs = [abs(100.0 * (found[gear, 500.0, radius, 0.0] / PAPER[gear] - 1.0)) for gear in PAPER]
        yield f"largest_off_{radius}_percent", max(offs)
    for gear in PAPER:
        change = found[gear, 500.0, RADII[1], 0.05] / found[gear, 500.0, RADII[1], 0.0]
        yield f"{gear}_sliding_percent", 100.0 * (change - 1.0)
    slopes = [[stress / torque for (gear, torque, radius, μ), stress in found.items()
               if (gear, radius, μ) == (name, RADII[1], 0.0)] for name in PAPER]
    yield "out_of_proportion_percent", max(100.0 * (max(each) / min(each) - 1.0) for each in slopes)


def _bores(runs: ZhangRuns) -> Named:
    """Changes of the tension with other bores, at level quick."""
    quick = PLANE, "mesh.level=quick", "output.error_bars=false"
    usual = _tensions(runs.strength("bore_35", *quick)[0])
    for pinion, wheel in ((20, 30), (55, 80)):
        bores = f"pinion.bore_diameter_mm={pinion}", f"wheel.bore_diameter_mm={wheel}"
        tensions = _tensions(runs.strength(f"bore_{pinion}", *quick, *bores)[0])
        for gear in PAPER:
            yield f"{gear}_bore_{pinion}_percent", 100.0 * (tensions[gear] / usual[gear] - 1.0)


def _tensions(rows: list[Row]) -> dict[str, float]:
    return {row["gear"]: float(row["stress_MPa"]) for row in rows if row["method"] == "finite elements, tension"}


def _in_space(runs: ZhangRuns) -> Named:
    """Faces of 29 and 25 mm, at level standard."""
    rows, cost = runs.strength("space", "contact.friction=[0.0, 0.05]")
    for row in rows:
        if row["method"] in ("finite elements, tension", "finite elements, compression"):
            side, still = row["method"].split(", ")[1], "still" if float(row["friction"]) == 0.0 else "sliding"
            head = f"{row['gear']}_space_{still}_{side}"
            yield f"{head}_MPa", float(row["stress_MPa"])
            yield f"{head}_error_MPa", float(row["stress_MPa_error"])
            yield f"{head}_height_mm", float(row["height_mm"])
            yield f"{head}_off_percent", 100.0 * (float(row["stress_MPa"]) / PAPER[row["gear"]] - 1.0)
    yield "space_cpu_min", cost.cpu / 60.0


def _root_mesh(runs: ZhangRuns) -> Named:
    """In plane strain, over the elements around the fillets."""
    for times in REFINEMENTS:
        rows, cost = runs.strength(f"roots_{times}", PLANE, f"strength.root_refinement={times}")
        for row in rows:
            if row["method"] == "finite elements, tension":
                yield f"{row['gear']}_{times}_times_MPa", float(row["stress_MPa"])
                yield f"{row['gear']}_{times}_times_error_MPa", float(row["stress_MPa_error"])
        yield f"{times}_times_cpu_s", cost.cpu


def _studies(runs: ZhangRuns) -> Named:
    """Contact ratio, tip thickness and tension over addendum and pressure angle."""
    for row in runs.study("zhang2023_addendum"):
        addendum = float(row["pinion.addendum_coefficient"])
        pair = _designed(18.0, addendum)
        yield f"addendum_{100 * addendum:.0f}_ratio", pair.transverse_contact_ratio
        yield from _of_scene(f"addendum_{100 * addendum:.0f}", row, pair)
    for row in runs.study("zhang2023_pressure_angle"):
        if float(row["load.torque_Nm"]) == 500.0:
            angle = float(row["pair.normal_pressure_angle_deg"])
            pair = _designed(angle, 1.25)
            yield f"angle_{angle:.0f}_ratio", pair.transverse_contact_ratio
            for name, gear in zip(PAPER, pair.gears):
                yield f"angle_{angle:.0f}_{name}_tip_mm", gear.normal_thickness(gear.tip_diameter)
            yield from _of_scene(f"angle_{angle:.0f}", row, pair)


def _designed(angle: float, addendum: float) -> GearPair:
    """The pair with another pressure angle and addendum coefficient."""
    values = tomllib.loads(SCENE.read_text(encoding="utf-8"))
    values["pair"]["normal_pressure_angle_deg"] = angle
    for gear in PAPER:
        for diameter in ("tip_diameter_mm", "root_diameter_mm"):
            del values[gear][diameter]
        values[gear] |= {"addendum_coefficient": addendum, "dedendum_coefficient": DEDENDUM}
    return scene_from_values(values).gear_pair()


def _of_scene(head: str, row: Row, pair: GearPair) -> Iterator[tuple[str, float]]:
    """Of a line of study.csv, NaN where the scene failed, and by the formula with the load at the outer point of single
    or double contact."""
    for gear, member in zip(PAPER, Member):
        yield f"{head}_{gear}_MPa", float(row[f"{gear}_tension_MPa"] or math.nan)
        load = RootLoad(pair, member, 500e3)
        at = {point.name: point.stress for point in boundary_stresses(load)}
        yield f"{head}_{gear}_b_MPa", at[load.outer_point.name]


if __name__ == "__main__":
    keep_figures(__doc__, DOCS / KEPT, lambda runs: figures(ZhangRuns(runs.out)))
