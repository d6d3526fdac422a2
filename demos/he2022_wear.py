"""Quasi-static wear of He et al.'s spur pair, compared with the paper and with line-contact formulas (Figs 17 to 21).

    python demos/he2022_wear.py [--quick] [--out DIR] [--scene FILE.toml] [--set KEY=VALUE ...]

170 N·m on the pinion, K/H = 1.3832e-10 mm²/N on both gears, no friction in the contact solution, 1.6 million mesh
cycles: the scene demos/he2022.toml with a [wear] section, as `evolvent run` computes it. Both gears have 50 teeth, so
both flanks wear alike. At the pitch point the flanks roll, but the contact is 0.26 mm wide and slides a little at its
edges: 4 % of the depth at the root. Without tip relief the tip edge bears before and after the path of contact. The
pressure at an edge is singular and so is its wear; all figures are of the flank between the edge margins, 0.1 m_n along
the profile from either end of the path of contact.

Another scene wears by the same law at its first friction coefficient, until about 10 µm are worn off, unless it has a
[wear] section of its own. The figures of the passage are drawn for plane pairs, the checks are made for He's pair.
"""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated

import numpy as np
import typer
from mpi4py import MPI

from evolvent.fem.backend import dolfinx_compat
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.drawing.picture_files import draw
from evolvent.results.engagement import engagement
from evolvent.run.call import Options
from evolvent.run.compute import compute
from evolvent.run.kinds.wear import Wear
from evolvent.scene.scene import GEARS, Scene, load_scene
from evolvent.scene.schema.errors import SceneError
from evolvent.wear.results.mesh_passage import (
    ContactProfile,
    DepthProfile,
    PointPassage,
    chart_grid,
    pitch_point_depth,
    radius_at,
)
from evolvent.wear.results.passage_figures import UM, pictures
from evolvent.wear.results.report import WornRun, read_worn
from evolvent_meshes.gears.member import Member

SCENE = Path(__file__).resolve().with_name("he2022.toml")
COEFFICIENT = 1.3832e-10  # mm²/N: 2.446 µm per km at 17.684 MPa
CYCLES, DEPTH = 1.6e6, 0.01  # of He's pair; mm of another one
POINT = 77.0  # mm, the paper's point A
FINE = 'mesh.level="fine"', "sweep.positions=40", "output.animation=false"
QUICK = (
    'mesh.level="quick"', "sweep.positions=20", "output.animation=false", "output.fields=false",
    "output.error_bars=false",
)


@dataclass(frozen=True)
class Compared:
    """A computed figure and its reference.

    name, unit: of the figure.
    found: computed value.
    source: of the reference.
    wanted: reference value.
    within: largest relative difference.
    """

    name: str
    unit: str
    found: float
    source: str
    wanted: float
    within: float = np.inf

    def __str__(self) -> str:
        return f"{self.name}: {self.found:.4g}{self.unit and ' '}{self.unit}; {self.source}: {self.wanted:.4g}"

    def check(self) -> None:
        """Raises AssertionError."""
        assert abs(self.found / self.wanted - 1.0) <= self.within, f"{self}, wanted within {self.within:.2g}"


def worn_scene(file: Path, quick: bool, settings: list[str]) -> Scene:
    """The scene with a [wear] section and one friction coefficient. Raises SceneError."""
    given = load_scene(file)
    how = [f"contact.friction={given.contact.friction[0]}", *(QUICK if quick else FINE if file == SCENE else ())]
    if given.wear is None:
        deepest = max(given.hertz_estimate().wear_per_cycle(COEFFICIENT, COEFFICIENT))
        cycles = CYCLES if file == SCENE else float(f"{DEPTH / deepest:.1g}")
        how += [f"wear.cycles={cycles:.6g}", *(f"wear.{name}_mm2_per_N={COEFFICIENT}" for name in GEARS)]
    return load_scene(file, [*how, *settings])


def compared(study: WornRun, point: PointPassage, coarse: bool) -> list[Compared]:
    """Figures of the first mesh passage of a plane pair whose pinion wears, and the volume worn off in all."""
    pair, last, wear = study.pairs[0], study.pairs[-1], study.scene.wear
    assert wear is not None
    K, r = wear.pinion_mm2_per_N, point.radius
    depths, contacts = DepthProfile.of(pair, Member.PINION, K), ContactProfile.of(pair.run, Member.PINION)
    at_point, line = (UM * float(np.interp(r, depths.radius, values)) for values in (depths.computed, depths.line))
    pitch = pair.run.pair.working_pitch_diameters[0] / 2.0
    lowest = UM * float(np.interp(pitch, depths.radius, depths.computed))
    ridge = UM * pitch_point_depth(pair.run, Member.PINION, K)
    away = np.abs(depths.radius - pitch) > 0.1 * study.scene.pair.normal_module_mm
    product = float(np.median(depths.peak_times_sliding[away] / depths.computed[away]))
    peak, hertz, sliding, single_point = (
        float(np.interp(r, contacts.radius, values))
        for values in (contacts.peak, contacts.hertz, contacts.sliding, contacts.single_point)
    )
    hertz_lasts = float(np.ptp(point.rotation[point.hertz > 0.0]))
    volume = pair.run.width * float(chart_grid(last, Member.PINION).areas @ last.worn[0].depth.T.ravel())
    local = 0.15 if coarse else 0.02  # accuracy of the width and peak pressure of a single contact
    million, here = "µm per million mesh cycles", f"r = {r:.4g} mm"
    return [
        Compared(f"depth at {here}", million, at_point, "line contact, own load", line, 0.05),
        Compared("depth at the pitch point", million, lowest, "passing Hertz pressure", ridge, 0.1),
        Compared("Eq. 24 over the depth, median", "", product, "4/π", 4.0 / np.pi, 0.02),
        Compared(f"stress at {here}", "MPa", peak, "Hertz, own load", hertz, local),
        Compared(f"sliding at {here}", "µm", 1e3 * sliding, "2b|ζ|", 1e3 * single_point, local),
        Compared(f"contact at {here} lasts", "°", np.degrees(point.lasts), "Hertz", np.degrees(hertz_lasts), local),
        Compared("worn volume of a pinion tooth", "mm³", volume, "(K/H)∫∫p|v_s| dA dt", last.volumes[0], 1e-6),
    ]


def check_as_printed(study: WornRun, point: PointPassage) -> None:
    """Compares with the printed values of the paper, whose point A carries less load. Raises AssertionError."""
    start = engagement(study.pairs[0].run, 0)
    whole = Compared("whole engagement", "°", np.degrees(np.ptp(start.ends)), "printed", 13.824, 0.3 / 13.824)
    slides = Compared("sliding at point A", "µm", 1e3 * point.sliding[-1], "printed", 59.0)
    print(whole, slides, Compared("contact at point A lasts", "°", np.degrees(point.lasts), "printed", 0.35), sep="\n")
    whole.check()
    reports = [pair.report().pinion for pair in study.pairs[1:]]
    deepest = np.array([report.deepest_um for report in reports])
    places = ", ".join(f"{r.deepest_um:.2f} µm at d = {r.at_diameter_mm:.1f} mm" for r in reports)
    print(f"largest depth at each report: {places}")
    first, *later = np.diff(deepest, prepend=0.0)
    growth = f"{first:.2f} µm, then {', '.join(f'{d:.2f}' for d in later)} µm"
    print(f"growth of the largest depth: {growth}; printed: it slows")
    depths = DepthProfile.of(study.pairs[0], Member.PINION, 1.0)
    pitch = study.pairs[0].run.pair.working_pitch_diameters[0] / 2.0
    radius = float(depths.radius[np.argmax(depths.computed)])
    share = float(np.interp(pitch, depths.radius, depths.computed)) / float(depths.computed.max())
    print(f"depth at the pitch point: {share:.3f} of the largest, which is at r = {radius:.2f} mm; printed: the root")
    assert share < 0.06, f"pitch point: wanted nearly no wear, found {share:.3f} of the largest"
    farthest = max(2.0 * radius, *(r.at_diameter_mm for r in reports))
    assert farthest < 2.0 * pitch, f"wanted the deepest wear at the root, found it at d = {farthest:.1f} mm"
    assert max(later) < 0.85 * first, f"wanted a maximum that grows slower after the first report, found {deepest} µm"


def write_table(study: WornRun, out: Path) -> None:
    """Writes OUT/table.csv: depths over the pinion's radius, of a million mesh cycles by solution and formulas, and at
    each report."""
    wear = study.scene.wear
    assert wear is not None
    depths, reports = DepthProfile.of(study.pairs[0], Member.PINION, wear.pinion_mm2_per_N), study.pairs[1:]
    head = ["radius_mm", "million_um", "million_line_contact_um", "million_eq_24_um"]
    formulas = [UM * values for values in (depths.computed, depths.line, depths.peak_times_sliding)]
    columns = [depths.radius, *formulas, *(pair.profile(Member.PINION)[1] for pair in reports)]
    text = io.StringIO()
    table = csv.writer(text)
    table.writerow([*head, *(f"after_{pair.cycles:.15g}_um" for pair in reports)])
    table.writerows([f"{value:.6g}" for value in row] for row in zip(*columns))
    RunFolder(out).write_text("table.csv", text.getvalue())


def main(
    out: Annotated[Path, typer.Option()] = Path("out/he2022_wear"),
    quick: bool = False,
    scene: Annotated[Path, typer.Option()] = SCENE,
    setting: Annotated[list[str] | None, typer.Option("--set")] = None,
) -> None:
    """Compute, draw, compare, check."""
    dolfinx_compat.silence_logs()
    scene = scene.resolve()
    try:
        worn = worn_scene(scene, quick, setting or [])
    except SceneError as error:
        raise typer.BadParameter(str(error)) from error
    compute(Wear.of(worn), out, Options(resume=True, quiet=quick))
    if MPI.COMM_WORLD.rank:
        return
    study = read_worn(out)
    run, wear = study.pairs[0].run, study.scene.wear
    if run.plane and wear is not None and wear.pinion_mm2_per_N > 0.0:
        middle = float(radius_at(run.pair, Member.PINION, np.asarray(0.5 * run.pair.path_of_contact[1])))
        point = PointPassage.of(run, POINT if scene == SCENE else middle)
        for failure in draw(pictures(study, point), RunFolder(out)).failures:
            print(failure)
        write_table(study, out)
        rows = compared(study, point, quick)
        print(*rows, sep="\n")
        if scene == SCENE:
            check_as_printed(study, point)
            for row in rows:
                row.check()
    print(f"pictures: {out / 'pictures'}")


if __name__ == "__main__":
    typer.run(main)
