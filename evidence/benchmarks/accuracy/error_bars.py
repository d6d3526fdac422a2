"""Error bars against true errors: figures of a spur and a helical pair on many meshes and on far finer ones.

The reference of a problem is one mesh for all its cases, cells halved, whatever the cases' own cells: the exact answer
does not depend on them. Its own error is estimated by the same mesh before the cells were halved for the last time.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import astuple, dataclass, fields, replace
from pathlib import Path

from mpi4py import MPI

from evidence.checkout import DEMOS
from evidence.solved_run import solved_run
from evolvent.gears.gear_model import Mesher
from evolvent.gears.meshing.companion_meshes import companion_mesh
from evolvent.gears.meshing.levelled_meshes import run_mesh
from evolvent.gears.meshing.sector_meshes import gear_mesh
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.gears.sweep.companion_pitch import companion_pitch
from evolvent.gears.sweep.pitch_sweep import Pitch
from evolvent.results.archive.error_bar_data import FigureErrors
from evolvent.results.error_bars.estimation import errors_between
from evolvent.results.run_data import RunData
from evolvent.results.tables.figure_rows import friction_rows
from evolvent.run.kept_pitch import pitch_of
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene, load_scene, scene_from_text
from evolvent_meshes.gears.member import Member
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.mesh.splitting import halved
from evolvent_meshes.sector.section import SectorResolution

FIGURES = tuple(field.name for field in fields(FigureErrors))
SCENES = Path(__file__).with_name("scenes")


@dataclass(frozen=True)
class BarRow:
    """A figure of one mesh and friction coefficient; all in the figure's unit."""

    case: str
    figure: str
    friction: float
    value: float
    bar: float
    error: float
    """|value − reference|."""
    reference_error: float
    """By how much the reference itself may be off."""

    @property
    def inside(self) -> bool:
        """Whether the bar holds the true error."""
        return self.error <= self.bar

    @property
    def decided(self) -> bool:
        """Whether the reference is good enough to tell."""
        return abs(self.error - self.bar) > self.reference_error


@dataclass(frozen=True)
class BarProblem:
    """A scene, the meshes on which its error bars are tried, and the mesh of its reference."""

    name: str
    scene: Scene
    cases: tuple[tuple[str, ...], ...]
    """Overrides of [mesh]."""
    reference: tuple[str, ...]
    """Overrides of [mesh], before its cells are halved."""
    halvings: int
    """How often all cells are halved."""
    fine_body: bool
    """Twice the elements in the body before."""

    def with_mesh(self, settings: Sequence[str]) -> Scene:
        """The scene with other values in [mesh]."""
        return scene_from_text(self.scene.resolved_toml(), [f"mesh.{setting}" for setting in settings])


def spur_problem(
    widths: Sequence[float] = (1.2, 1.7, 2.4, 3.0, 4.2, 6.0, 8.0),
    positions: int = 20,
    frictions: Sequence[float] = (0.0, 0.1, 0.3),
) -> BarProblem:
    """He's pair in plane strain at several numbers of elements across the contact width, of both orders,
    quadrilaterals and triangles."""
    settings = [f"contact.friction={list(frictions)}", f"sweep.positions={positions}"]
    return BarProblem("spur", load_scene(DEMOS / "he2022.toml", settings), mesh_cases(widths), ("level=fine",), 2, True)


def helical_problem(widths: Sequence[float] = (1.2, 1.7), reference: float = 1.7) -> BarProblem:
    """A narrow helical pair, hexahedra and tetrahedra of both orders. reference: elements across the contact width
    before all cells are halved once; that solution takes gigabytes and many minutes of one core."""
    finest = (f"elements_per_contact_width={reference}",)
    return BarProblem("helical", load_scene(SCENES / "narrow_helical.toml"), mesh_cases(widths), finest, 1, False)


def mesh_cases(widths: Sequence[float]) -> tuple[tuple[str, ...], ...]:
    """Overrides of [mesh]: orders 2 and 1, both shapes, so many elements across the contact width."""
    return tuple(
        (f"order={order}", f"shape={shape}", f"elements_per_contact_width={width}")
        for order in (2, 1)
        for shape in ("hexahedron", "tetrahedron")
        for width in widths
    )


def measure_bars(problem: BarProblem) -> list[BarRow]:
    """One row a case, figure and friction coefficient, without those that are `known`."""
    references = [_reference(problem, problem.halvings - last) for last in (0, 1)]
    rows = []
    for case in problem.cases:
        scene = problem.with_mesh(case)
        run, coarse = solved(scene), solved_companion(scene)
        bars = [astuple(errors) for errors in errors_between(run, coarse)]
        values, exact, nearly = (figures_of(each, run.inner_path) for each in (run, *references))
        rows += bar_rows(", ".join((problem.name, *case)), run.frictions, values, bars, exact, nearly)
    return [row for row in rows if not known(row)]


def known(row: BarRow) -> bool:
    """Whether a figure needs no bar: the loss without friction, which is 0, and the face load factor in plane strain,
    which is 1."""
    return (row.figure == "loss_percent" and row.friction == 0.0) or (
        row.figure == "face_load_factor" and row.value == 1.0
    )


def hit_rate(rows: Sequence[BarRow]) -> float:
    """The share of rows whose bar holds the true error."""
    return sum(row.inside for row in rows) / len(rows)


def bar_rows(
    case: str, frictions: Sequence[float], values: Sequence[Sequence[float]], bars: Sequence[Sequence[float]],
    exact: Sequence[Sequence[float]], nearly: Sequence[Sequence[float]],
) -> list[BarRow]:
    """All figures of a case; the tables are (friction coefficients, figures)."""
    return [
        BarRow(case, figure, friction, value, bar, abs(value - best), abs(best - second))
        for friction, *tables in zip(frictions, values, bars, exact, nearly)
        for figure, value, bar, best, second in zip(FIGURES, *tables)
    ]


def solved(scene: Scene, mesh: Mesher = run_mesh, pitch: Pitch | None = None) -> RunData:
    """A run on this rank alone. mesh: of a gear's sector. pitch: the positions, None for those of the scene."""
    run = solved_run(scene, pitch or pitch_of(scene), MPI.COMM_SELF, mesh)
    assert run is not None
    return run


def solved_companion(scene: Scene) -> RunData:
    """The coarse companion of a scene's run, at the positions at which a run has it."""
    return solved(scene, companion_mesh, companion_pitch(pitch_of(scene), gear_problem(scene).is_plane))


def _reference(problem: BarProblem, halvings: int) -> RunData:
    return solved(problem.with_mesh(problem.reference), reference_mesh(problem, halvings))


def reference_mesh(problem: BarProblem, halvings: int) -> Mesher:
    """Makes the sectors of the reference."""

    def mesh(gears: GearProblem, member: Member) -> MeshData:
        fine = gear_mesh(gears, member, adapted=_finer_body) if problem.fine_body else gear_mesh(gears, member)
        for _ in range(halvings):
            fine = halved(fine)
        return fine

    return mesh


def _finer_body(resolution: SectorResolution) -> SectorResolution:
    """Twice the elements where no level refines: halved cells keep the fillet's outline, these follow it closer."""
    return replace(
        resolution,
        neck_elements=2 * resolution.neck_elements,
        fillet_elements=2 * resolution.fillet_elements,
        back_elements=2 * resolution.back_elements,
        core_elements=2 * resolution.core_elements,
        rim_elements=2 * resolution.rim_elements,
    )


def figures_of(run: RunData, inner: tuple[float, float]) -> list[list[float]]:
    """(friction coefficients, figures). inner: between which roll distances pressures are looked at, the tip-edge zones
    of the mesh that is judged, as its figures are of what lies between them."""
    return [[float(getattr(row, name)) for name in FIGURES] for row in friction_rows(run, inner)]
