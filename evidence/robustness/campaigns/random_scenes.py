"""Random scenes that pass validation, one per seed, small enough to be solved in seconds.

Every quantity of a gear pair is drawn, most over decades: the load by what matters, the Hertz half-width over the
radius of curvature. Draws that the scene's own checks refuse (undercut, pointed teeth, interference, ...) are drawn
again, as are those whose mesh would be large.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from evolvent.check.problem_size import sector_sizes
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene, SceneError, scene_from_values

Table = dict[str, Any]

DRAWS = 20_000
LARGEST = {True: (9_000, 600), False: (60_000, 3_100)}
"""Degrees of freedom of a sector and rows of its dense part that are allowed, by whether the scene is plane."""
THINNEST = 0.03
"""Face width of a helical gear over its diameter."""
QUIET = {"pictures": False, "animation": False, "fields": False, "error_bars": False}


@dataclass(frozen=True)
class Draw:
    """The random numbers of one scene."""

    rng: np.random.Generator

    def uniform(self, low: float, high: float, digits: int = 4) -> float:
        return round(float(self.rng.uniform(low, high)), digits)

    def decades(self, low: float, high: float) -> float:
        """Uniform in the logarithm, to four figures."""
        return float(f"{np.exp(self.rng.uniform(np.log(low), np.log(high))):.4g}")

    def whole(self, low: int, high: int) -> int:
        return int(self.rng.integers(low, high + 1))

    def often(self, share: float) -> bool:
        return bool(self.rng.random() < share)

    def one_of(self, *choices: Any) -> Any:
        return choices[int(self.rng.integers(len(choices)))]


def random_scene(seed: int, plane: bool | None = None) -> Scene:
    """The scene of a seed. plane: only scenes that are (True) or are not (False) solved in 2D.

    Raises RuntimeError if no draw is valid and small.
    """
    draw = Draw(np.random.default_rng(seed))
    plane = draw.often(0.6) if plane is None else plane
    helical, order = not plane and draw.often(0.6), draw.one_of(2, 2, 1) if plane else draw.one_of(2, 1, 1, 1)
    for _ in range(DRAWS):
        try:
            scene = _loaded(_values(draw, plane, helical, order), draw)
        except SceneError:
            continue
        if _is_small(scene) and _is_stout(scene):
            return scene
    raise RuntimeError(f"seed {seed}: wanted a valid small scene, found none in {DRAWS} draws; use another seed")


def _values(draw: Draw, plane: bool, helical: bool, order: int) -> Table:
    """A scene's tables, with a torque that only stands in for the real one."""
    module = draw.decades(0.1, 40.0)
    helix = draw.uniform(3.0, 38.0, 2) if helical else 0.0
    widths = (0.5, 20.0) if plane else (0.4, 3.0)
    width = draw.decades(max(0.1, widths[0] * module), min(1000.0, widths[1] * module))
    teeth = draw.whole(9, 60)
    values: Table = {
        "pair": {
            "normal_module_mm": module,
            "normal_pressure_angle_deg": draw.one_of(20.0, draw.uniform(14.0, 28.0, 2)),
            "helix_angle_deg": helix,
        },
        "pinion": {"teeth": teeth, "face_width_mm": width, **_gear(draw, module, plane)},
        "wheel": {"teeth": min(300, round(teeth * draw.decades(0.5, 6.0))), **_gear(draw, module, plane)},
        "material": _materials(draw),
        "mesh": _mesh(draw, plane, order),
        "contact": {"friction": _frictions(draw)},
        "load": {"torque_Nm": 1e-3 * module**3, "on": draw.one_of("pinion", "wheel")},
        "sweep": {"positions": draw.one_of(6, 12, 20, 40)},
        "output": QUIET,
        "title": "random scene",
    }
    values["wheel"]["face_width_mm"] = width
    if not plane and draw.often(0.5):
        values["wheel"]["face_width_mm"] = round(width * draw.uniform(0.8, 1.25), 4)
    if helix:
        values["pinion"]["hand"] = draw.one_of("right", "left")
    if not plane and (helix == 0.0 or draw.often(0.5)):
        values["pair"]["misalignment_um"] = round(1e3 * module * draw.uniform(-4e-3, 4e-3, 6), 4)
    return values


def _gear(draw: Draw, module: float, plane: bool) -> Table:
    """What one gear may have of its own."""
    gear: Table = {}
    if draw.often(0.6):
        gear["profile_shift"] = draw.uniform(-0.4, 0.8, 3)
    if draw.often(0.3):
        gear["addendum_coefficient"] = draw.uniform(0.7, 1.3, 3)
        gear["dedendum_coefficient"] = round(gear["addendum_coefficient"] + draw.uniform(0.2, 0.4, 3), 3)
    if draw.often(0.4):
        gear["tip_relief_um"] = round(1e3 * module * draw.decades(1e-4, 1e-2), 4)
        gear["tip_relief_form"] = draw.one_of("linear", "parabolic")
    if not plane and draw.often(0.5):
        gear["lead_crowning_um"] = round(1e3 * module * draw.decades(1e-4, 6e-3), 4)
    return gear


def _materials(draw: Draw) -> Table:
    """Steel on steel, or two materials from plastic to hard metal."""
    if draw.often(0.5):
        return {}
    pair = [{"E_GPa": draw.decades(1.0, 600.0), "nu": draw.uniform(0.0, 0.49, 3)} for _ in range(2)]
    return {"pinion": pair[0], "wheel": pair[1]}


def _mesh(draw: Draw, plane: bool, order: int) -> Table:
    return {
        "level": "quick",
        "elements_per_contact_width": draw.uniform(0.7, 3.0, 2) if plane else draw.uniform(0.5, 1.3, 2),
        "shape": draw.one_of("hexahedron", "hexahedron", "tetrahedron"),
        "order": order,
    }


def _frictions(draw: Draw) -> list[float]:
    """One to three coefficients, often none, now and then very large."""
    values = [draw.one_of(0.0, 0.0, draw.uniform(0.01, 0.3, 3), draw.uniform(0.01, 0.3, 3), draw.uniform(0.3, 1.0, 2))]
    values += [draw.uniform(0.0, 0.4, 3) for _ in range(draw.one_of(0, 0, 0, 1, 2))]
    return list(dict.fromkeys(values))


def _loaded(values: Table, draw: Draw) -> Scene:
    """With a torque at which the Hertz half-width is 0.2 to 10 % of the radius of curvature. Raises SceneError."""
    wanted = draw.decades(2e-3, 0.1)
    estimate = scene_from_values(values).hertz_estimate()
    narrowness = float(estimate.half_width(0.0)) / float(estimate.pair.relative_curvature_radius(0.0))
    torque = values["load"]["torque_Nm"] * (wanted / narrowness) ** 2
    return scene_from_values({**values, "load": {**values["load"], "torque_Nm": float(f"{torque:.4g}")}})


def _is_stout(scene: Scene) -> bool:
    """Not a helical gear that is a thin disc: that bends sideways under its axial force, far beyond small strain."""
    diameters = [gear.tip_diameter for gear in scene.gear_pair().gears]
    return scene.pair.helix_angle_deg == 0.0 or scene.pinion.face_width_mm >= THINNEST * max(diameters)


def _is_small(scene: Scene) -> bool:
    dofs, rows = LARGEST[gear_problem(scene).is_plane]
    return all(size.dofs <= dofs and size.flank + size.cuts <= rows for size in sector_sizes(scene))
