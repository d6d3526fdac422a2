"""Random wear studies, one per seed: gear pairs with [wear], and bodies of the public API, small enough for seconds.

K/H is drawn over decades, up to values that no material has, and the number of cycles so that a drawn depth is reached:
on gears up to what a scene may ask for, on other bodies up to more than there is. Blocks of all lengths, the first one
often the whole study.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from evidence.robustness.campaigns.random_scenes import Draw, Table, random_scene
from evolvent import Contact, Placement, Problem, Step
from evolvent.contact.hertz import contact_modulus
from evolvent.fem.body import Body, Fixed, Freedom, Rigid
from evolvent.fem.material import Material
from evolvent.gears.problem.flank_deviations import DEEPEST
from evolvent.scene.scene import Scene, scene_from_values
from evolvent.wear.archard import Archard
from evolvent.wear.block_stepping import BlockSettings
from evolvent.wear.cycle import Cycle, Travel
from evolvent.wear.worn_geometry import MeshMotion
from evolvent_meshes.mesh.mesh_data import MeshData
from evolvent_meshes.shapes.blocks import box, cylinder_2d, graded_rectangle, rectangle
from evolvent_meshes.shapes.variants import with_part

GEARS = 0.4  # of the seeds
PLANE = 0.9  # of the gear pairs: others take longer
SMALLEST, LARGEST = 1e-13, 1e-6  # K/H [mm²/N] of gears
ABSURD = 1e3  # mm²/N: bodies vanish within 1 µm of sliding
MISTAKE = 1e6  # times the body's size: what a study asks for whose K/H is in m²/N
RADIUS, POISSON = 5.0, 0.3  # mm
STROKE = 0.2  # of the contact's half-width


@dataclass(frozen=True)
class BodyStudy:
    """A study of the public API.

    cycles: of the study.
    size:   what can be worn off: a radius or a height [mm].
    wanted: depth over `size` that the cycles are to reach.
    """

    kind: str
    problem: Problem
    law: Archard
    cycle: Cycle
    refresh: MeshMotion
    settings: BlockSettings
    cycles: float
    size: float
    wanted: float


@dataclass(frozen=True)
class Shape:
    """Two bodies in contact, the upper one first.

    groups:     that touch.
    held:       that are moved and held.
    load:       [N; N/mm].
    half_width: of the contact [mm].
    volume:     that is worn off at the wanted depth [mm³; mm²].
    size:       what can be worn off [mm].
    """

    kind: str
    meshes: tuple[MeshData, MeshData]
    groups: tuple[str, str]
    held: tuple[str, str]
    load: float
    half_width: float
    volume: float
    size: float


def random_study(seed: int) -> Scene | BodyStudy:
    """The study of a seed."""
    draw = Draw(np.random.default_rng([seed, 2]))
    return _gears(draw, seed) if draw.often(GEARS) else _bodies(draw)


def _gears(draw: Draw, seed: int) -> Scene:
    """A random scene whose flanks wear, as deep as a scene may ask for at most."""
    plane = draw.often(PLANE)
    scene = random_scene(seed, plane)
    values: Table = scene.model_dump(mode="json", exclude_none=True)
    values["contact"]["friction"] = [draw.one_of(0.0, 0.0, draw.uniform(0.01, 0.3, 3))]
    values["sweep"]["positions"] = draw.whole(4, 6)
    if not plane:
        values["mesh"] |= {"order": 1, "elements_per_contact_width": 0.5}
    pinion, wheel = _coefficients(draw, SMALLEST, LARGEST)
    estimate = scene.hertz_estimate().wear_per_cycle(pinion, wheel)
    depth = draw.decades(1e-3 * DEEPEST, 0.99 * DEEPEST) * scene.pair.normal_module_mm
    cycles = depth / max(estimate)
    values["wear"] = {
        "cycles": cycles, "pinion_mm2_per_N": pinion, "wheel_mm2_per_N": wheel, "report_at_cycles": [],
        "blocks": draw.one_of("implicit", "implicit", "explicit"), "tolerance": draw.decades(0.01, 0.5),
        "first_block_cycles": max(1.0, cycles * _first(draw)),
    }
    return scene_from_values(values)


def _coefficients(draw: Draw, low: float, high: float) -> tuple[float, float]:
    """K/H of two surfaces, one of them often 0."""
    first, second = draw.decades(low, high), draw.decades(low, high)
    return draw.one_of((first, 0.0), (0.0, second), (first, second), (first, first))


def _first(draw: Draw) -> float:
    """Length of the first block over that of the study."""
    return draw.one_of(1.0, draw.decades(1e-3, 1.0), draw.decades(1e-3, 1.0))


def _bodies(draw: Draw) -> BodyStudy:
    """A cylinder or a block on a block, which travels under it or goes to and fro."""
    material = Material(draw.decades(2e3, 2e7), POISSON)
    wanted = draw.one_of(draw.decades(1e-4, 0.1), draw.decades(0.1, 3.0), draw.decades(3.0, MISTAKE))
    order, friction = draw.one_of(1, 2), draw.one_of(0.0, 0.0, draw.uniform(0.01, 0.4, 3))
    shape = draw.one_of(_cylinder, _cylinder, _blocks, _boxes)(draw, material, wanted, order)
    travels = draw.often(0.6)
    first, second = _coefficients(draw, SMALLEST, ABSURD)
    if travels:  # what travels would wear on its whole track
        first, second = (first or second), 0.0
    stroke = STROKE * shape.half_width
    slid = 1.0 if travels else 4.0 * stroke
    cycles = shape.volume / ((first + second) * shape.load * slid)
    settings = BlockSettings(
        cycles * _first(draw), draw.decades(0.01, 0.5), travels and draw.often(0.7),
        draw.one_of(np.inf, draw.decades(0.05, 3.0)),
    )
    depth = draw.one_of(np.inf, draw.decades(0.05, 1.0) * wanted * shape.size)
    refresh = MeshMotion(depth, draw.one_of("harmonic", "elastic"))
    cycle = _travelling(shape, friction) if travels else _to_and_fro(shape, stroke)
    problem = _problem(shape, material, friction)
    return BodyStudy(
        shape.kind, problem, Archard(first, second), cycle, refresh, settings, cycles, shape.size, wanted
    )


def _problem(shape: Shape, material: Material, friction: float) -> Problem:
    """The upper body, whose top comes straight down, on the lower one, whose bottom is held."""
    (upper, lower), (top, bottom) = shape.meshes, shape.held
    down = Rigid(top, (Freedom("xyz"[upper.dimension - 1], load=-shape.load),))
    bodies = Body(upper, material, rigid=down, name="upper"), Body(lower, material, (Fixed(bottom),), name="lower")
    return Problem(bodies, (Contact((0, shape.groups[0]), (1, shape.groups[1]), friction),))


def _cylinder(draw: Draw, material: Material, wanted: float, order: int) -> Shape:
    """A half cylinder on a slab. The cells are made for the contact at first, or for the worn one."""
    modulus = contact_modulus(material.youngs_modulus, POISSON, material.youngs_modulus, POISSON)
    a, depth = RADIUS * draw.decades(3e-3, 0.06), wanted * RADIUS
    worn = np.sqrt(2.0 * RADIUS * depth)
    fine = min(1.3 * max(a, worn), 0.6 * RADIUS)
    size = fine / draw.whole(6, 12)  # few over a contact that is narrow at first
    upper = cylinder_2d(RADIUS, size, fine, order, contact=fine)
    lower = graded_rectangle(4.0 * fine, 2.0 * fine, 0.8 * size, 1.5 * fine, order)
    load = 0.25 * np.pi * modulus * a**2 / RADIUS
    groups, held = ("arc", "near"), ("top", "bottom")
    meshes = upper, with_part(lower, "top", "near", 1.5 * fine)
    return Shape("cylinder on slab", meshes, groups, held, load, a, 4.0 / 3.0 * worn * depth, RADIUS)


def _blocks(draw: Draw, material: Material, wanted: float, order: int) -> Shape:
    """A block of 2 × 1 mm on one of 4 × 2 mm."""
    shape = draw.one_of("quadrilateral", "triangle")
    upper = rectangle(2.0, 1.0, draw.whole(4, 12), draw.whole(3, 6), order, shape, (-1.0, 0.0))
    lower = rectangle(4.0, 2.0, draw.whole(8, 24), draw.whole(4, 8), order, shape, (-2.0, -2.0))
    load = 2.0 * material.youngs_modulus * draw.decades(1e-4, 1e-2)
    return Shape("block on block", (upper, lower), ("bottom", "top"), ("top", "bottom"), load, 1.0, 2.0 * wanted, 1.0)


def _boxes(draw: Draw, material: Material, wanted: float, order: int) -> Shape:
    """The same in 3D: 2 × 2 × 1 mm on 3 × 3 × 1 mm, of few cells."""
    shape = draw.one_of("hexahedron", "tetrahedron")
    n = draw.whole(3, 5) if order == 1 else 2
    upper = box((2.0, 2.0, 1.0), (n, n, n), order, shape, (-1.0, -1.0, 0.0))
    lower = box((3.0, 3.0, 1.0), (n + 1, n + 1, n), order, shape, (-1.5, -1.5, -1.0))
    load = 4.0 * material.youngs_modulus * draw.decades(1e-4, 1e-2)
    return Shape("box on box", (upper, lower), ("bottom", "top"), ("top", "bottom"), load, 1.0, 4.0 * wanted, 1.0)


def _travelling(shape: Shape, friction: float) -> Cycle:
    """1 mm of travel of the lower body; with friction it is dragged along before, until all slides."""
    travel = (Travel(1, translation=(1.0, 0.0, 0.0)),)
    steps = (Step(), *_moved(shape, 0.2 * STROKE)) if friction else (Step(),)
    return Cycle(steps, travel)


def _to_and_fro(shape: Shape, stroke: float) -> Cycle:
    """The lower body goes to one side, to the other, and back [mm]."""
    return Cycle((Step(), *_moved(shape, stroke, 0.0, -stroke, 0.0)))


def _moved(shape: Shape, *places: float) -> tuple[Step, ...]:
    d = shape.meshes[0].dimension
    return tuple(
        Step(placements=(Placement.at_rest(d), Placement(np.eye(d), np.eye(d)[0] * x))) for x in places
    )
