"""Errors of root stress, and how often its error bars hold them: largest tension and compression of both gears' roots,
and the stress at every rotation, on many meshes and fillets.

The reference of a problem is one mesh for all its cases, cells halved, at twice the positions, those of the cases among
them. Its own error is estimated by the same mesh before the cells were halved for the last time.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from evidence.benchmarks.accuracy.error_bars import SCENES, BarProblem, mesh_cases, spur_problem
from evidence.calls import temporary_call
from evidence.checkout import DEMOS
from evolvent.gears.gear_model import Mesher
from evolvent.gears.meshing.root_meshes import RootMesh, finer_roots, with_back_root
from evolvent.gears.meshing.sector_meshes import gear_mesh
from evolvent.gears.problem.gear_problem import GearProblem
from evolvent.results.error_bars.compared import Curve
from evolvent.run.kept_pitch import Meshes
from evolvent.run.strength.pitch_roots import PitchRoots, one_sector, pitch_roots
from evolvent.scene.scene import Scene, load_scene, scene_from_text
from evolvent.strength.results.root_curves import compression_curve, curve_errors, tension_curve
from evolvent.strength.root_passage import GearRoots
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.member import Member
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.mesh.splitting import halved

FILLETS = 1, 2, 4
"""Elements around a fillet over those of a run; `evolvent strength` has twice as many."""
OUTLINE = 4
"""Elements around a fillet of a reference over those of a run, before its cells are halved."""
FINER = 2
"""Positions of the reference over those of the cases."""
CURVES: dict[str, Callable[[GearRoots], Curve]] = {"tension": tension_curve, "compression": compression_curve}


@dataclass(frozen=True)
class RootProblem:
    """A scene, the meshes on which its error bars are tried, and its reference."""

    bars: BarProblem
    fillets: tuple[int, ...]
    """See `FILLETS`."""


@dataclass(frozen=True)
class RootBarRow:
    """Stress of one side of a gear's root on one mesh, at one friction coefficient."""

    pair: str
    mesh: str
    """Order, shape and elements across the contact width."""
    fillet: int
    """Elements around a fillet over those of a run."""
    friction: float
    gear: str
    side: str
    """"tension" or "compression"."""
    value_MPa: float
    """Its largest amount."""
    bar_MPa: float
    error_MPa: float
    reference_error_MPa: float
    """By how much the reference itself may be off."""
    positions: int
    """Rotations with more than a tenth of that."""
    positions_inside: int
    """Of them, those whose bar holds the true error."""
    positions_decided: int
    """Those of which the reference is good enough to tell."""
    positions_decided_inside: int

    @property
    def inside(self) -> bool:
        """Whether the bar holds the true error."""
        return self.error_MPa <= self.bar_MPa

    @property
    def decided(self) -> bool:
        """Whether the reference is good enough to tell."""
        return abs(self.error_MPa - self.bar_MPa) > self.reference_error_MPa


def problems(small: bool) -> Iterator[RootProblem]:
    """He's and Zhang's pair in plane strain, and a narrow helical one. small: a few meshes of the first."""
    widths, frictions = (1.7, 3.0, 6.0), (0.0, 0.1)
    he = spur_problem(widths[:1] if small else widths, 6 if small else 20, frictions)
    yield RootProblem(he, FILLETS[:2] if small else FILLETS)
    if small:
        return
    settings = "pinion.face_width_mm=25", "contact.friction=[0.0, 0.1]"
    zhang = load_scene(DEMOS / "zhang2023.toml", settings)
    yield RootProblem(replace(he, name="high contact ratio", scene=zhang), FILLETS)
    narrow = load_scene(SCENES / "narrow_helical.toml")
    yield RootProblem(BarProblem("helical", narrow, mesh_cases((1.2, 1.7)), ("level=quick",), 1, False), (2,))


def measure_bars(problem: RootProblem) -> Iterator[RootBarRow]:
    """Four rows a case, fillet and friction coefficient."""
    reference = _with_positions(problem.bars.with_mesh(problem.bars.reference))
    best, second = (_roots(reference, _reference(problem.bars.halvings - last)) for last in (0, 1))
    for case in problem.bars.cases:
        scene = problem.bars.with_mesh(case)
        name = ", ".join(setting.split("=")[1] for setting in case)
        for fillet in problem.fillets:
            own = _roots(scene, RootMesh(fillet))
            coarse = _roots(scene, RootMesh(fillet, coarse=True), own.angles)
            for index, friction in enumerate(scene.contact.friction):
                for member in Member:
                    four = [each.roots[index][member] for each in (own, coarse, best, second)]
                    for side in CURVES:
                        head = problem.bars.name, name, fillet, friction, member.label, side
                        yield _row(head, scene.mesh.order, *four)


def _row(
    head: tuple[str, str, int, float, str, str], order: int, own: GearRoots, coarse: GearRoots, best: GearRoots,
    second: GearRoots,
) -> RootBarRow:
    curve = CURVES[head[-1]]
    bars = curve_errors(curve, own, coarse, order)
    tried, exact, nearly = curve(own), curve(best), curve(second)
    peak, most, other = (float(np.abs(each.values).max()) for each in (tried, exact, nearly))
    at, nearly_at = _at(tried, exact), _at(tried, nearly)
    counted = np.abs(at) > 0.1 * most  # not where the reference has no value
    error, doubt, bar = (each[counted] for each in (np.abs(tried.values - at), np.abs(at - nearly_at), bars.values))
    inside, decided = error <= bar, np.abs(error - bar) > doubt
    counts = len(error), int(inside.sum()), int(decided.sum()), int((inside & decided).sum())
    return RootBarRow(*head, peak, bars.peak, abs(peak - most), abs(most - other), *counts)


def _at(tried: Curve, exact: Curve) -> Floats:
    """Values of a reference at the rotations that were tried; NaN at those that are not among its own."""
    _, mine, its = np.intersect1d(np.round(tried.angle, 9), np.round(exact.angle, 9), return_indices=True)
    values = np.full(len(tried.angle), np.nan)
    values[mine] = exact.values[its]
    return values


def _with_positions(scene: Scene) -> Scene:
    """The scene at `FINER` times its positions."""
    return scene_from_text(scene.resolved_toml(), [f"sweep.positions={FINER * scene.sweep.positions}"])


def _roots(scene: Scene, mesh: Mesher, angles: Sequence[float] | None = None) -> PitchRoots:
    """At each friction coefficient, on this rank alone. angles: see `pitch_roots`."""
    with temporary_call() as call:
        return pitch_roots(call, scene, Meshes(mesh, problem=one_sector), angles)


def _reference(halvings: int) -> Mesher:
    """Cells halved of a mesh with so many elements around its fillets that their outline is exact."""

    def mesh(problem: GearProblem, member: Member) -> MeshData:
        fine = gear_mesh(problem, member, partial(finer_roots, times=OUTLINE))
        for _ in range(halvings):
            fine = halved(fine)
        return with_back_root(fine)

    return mesh
