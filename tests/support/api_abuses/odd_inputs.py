"""Calls that are unusual but correct, with their exact results."""

# mypy: ignore-errors
# some arguments are of other types than those declared, on purpose

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from evolvent import (
    Body,
    BodyForce,
    Fixed,
    Freedom,
    InputError,
    Material,
    MeshData,
    Nitsche,
    Placement,
    Problem,
    Rigid,
    Step,
    Sweep,
    Traction,
    read_msh,
    sweep,
)
from evolvent_meshes.mesh.gmsh_io import write_msh
from tests.support.api_abuses.blocks import (
    LOWER,
    PRESSURE,
    PUSH,
    REST,
    ROLLS,
    UPPER,
    Exact,
    contact,
    force,
    hard,
    lower,
    pressures,
    problem,
    steel,
    upper,
)

MODULUS = 210e3 / (1.0 - 0.3**2)  # of uniaxial stress in plane strain


def pushed(**changes: Any) -> Problem:
    """The same blocks, their top moved down by `PUSH`: uniform stress MODULUS·PUSH/2 over their height of 2 mm."""
    return problem((upper(supports=(ROLLS, Fixed("top", "y", -PUSH)), loads=()), lower()), **changes)


def scaled(length: float, stress: float) -> Problem:
    """The same problem in other units."""
    material = Material(210e3 * stress, 0.3)
    press = (Traction("top", (0.0, -PRESSURE * stress)),)
    bodies = (
        upper(replace(UPPER, points=UPPER.points * length), material=material, loads=press),
        lower(replace(LOWER, points=LOWER.points * length), material=material),
    )
    return problem(bodies, (contact(reach=0.1 * length),))


def in_one_body() -> Problem:
    """Both blocks as two pieces of one body, which touches itself."""
    n = len(UPPER.points)
    both = MeshData(
        np.concatenate([UPPER.points, LOWER.points]),
        "quadrilateral",
        1,
        np.concatenate([UPPER.cells, LOWER.cells + n]),
        {
            **{f"upper {k}": v for k, v in UPPER.facets.items()},
            **{f"lower {k}": v + n for k, v in LOWER.facets.items()},
        },
        {},
    )
    supports = (
        Fixed("upper left", "x"),
        Fixed("upper top", "y", -PUSH),
        Fixed("lower left", "x"),
        Fixed("lower bottom", "y"),
    )
    return problem((Body(both, supports=supports),), (contact((0, "upper bottom"), (0, "lower top")),))


def ridden(load: float = 0.0, **changes: Any) -> Problem:
    """The upper block's top coupled and loaded, on top of the traction there."""
    rigid = Rigid("top", (Freedom("y", load=load), Freedom("rz", load=0.0)))
    return problem((upper(supports=(), rigid=rigid, **changes), lower(supports=(Fixed("bottom"),))))


def remade(**changes: Any) -> Problem:
    return problem((upper(replace(UPPER, **changes)), lower()))


def frozen(values: Any) -> Any:
    result = values.copy()
    result.setflags(write=False)
    return result


def after_failure(_: Path) -> Any:
    """A sweep whose second step is refused and whose third is right."""
    run = Sweep(problem())
    run.solve(Step(0.5))
    try:
        run.solve(Step(placements=(REST,)))
    except InputError:
        return run.solve(Step(1.0)).contacts[0].pressure
    raise AssertionError("the step with one placement was taken")


def clockwise_file(folder: Path) -> Any:
    """Least Jacobian of a square whose surface points down, read from gmsh."""
    write_msh(replace(UPPER, cells=UPPER.cells[:, ::-1].copy()), folder / "down.msh")
    back = read_msh(str(folder / "down.msh"))
    return pressures(problem((upper(back), lower())))


TURN = np.array([[0.8, -0.6], [0.6, 0.8]])
AWAY = Placement(TURN.tolist(), [1e5, -1e5])
ROWS = [
    Exact(
        "lists for tuples",
        lambda _: pressures(Problem([upper(), lower()], [contact([0, "bottom"], [1, "top"])])),
        PRESSURE,
    ),
    Exact(
        "numpy's numbers",
        lambda _: pressures(
            problem(contacts=(contact((np.int64(0), "bottom"), friction=np.float64(0.1)),)), Step(np.float32(0.5))
        ),
        PRESSURE / 2,
    ),
    Exact("single precision points", lambda _: pressures(remade(points=UPPER.points.astype(np.float32))), PRESSURE),
    Exact("32-bit cells", lambda _: pressures(remade(cells=UPPER.cells.astype(np.int32))), PRESSURE),
    Exact("unsigned cells", lambda _: pressures(remade(cells=UPPER.cells.astype(np.uint64))), PRESSURE),
    Exact("columns first", lambda _: pressures(remade(points=np.asfortranarray(UPPER.points))), PRESSURE),
    Exact(
        "arrays that cannot be written",
        lambda _: pressures(remade(points=frozen(UPPER.points), cells=frozen(UPPER.cells))),
        PRESSURE,
    ),
    Exact(
        "plane at another height",
        lambda _: pressures(remade(points=UPPER.points + np.array([0.0, 0.0, 7.0]))),
        PRESSURE,
    ),
    Exact("swapped surfaces", lambda _: pressures(problem(contacts=(contact((1, "top"), (0, "bottom")),))), PRESSURE),
    Exact(
        "swapped bodies",
        lambda _: pressures(problem((lower(), upper()), (contact((1, "bottom"), (0, "top")),))),
        PRESSURE,
    ),
    Exact("force on the second body", lambda _: force(problem()), [0.0, -2.0 * PRESSURE]),
    Exact(
        "force on the second body, swapped",
        lambda _: force(problem(contacts=(contact((1, "top"), (0, "bottom")),))),
        [0.0, 2.0 * PRESSURE],
    ),
    Exact("no load", lambda _: pressures(problem(), Step(0.0)), 0.0),
    Exact("a thousandth of a millionth of the load", lambda _: pressures(problem(), Step(1e-9)), PRESSURE * 1e-9),
    Exact("metres and pascals", lambda _: pressures(scaled(1e-3, 1e6)), PRESSURE * 1e6),
    Exact("nanometres", lambda _: pressures(scaled(1e-6, 1.0)), PRESSURE),
    Exact("kilometres", lambda _: pressures(scaled(1e6, 1.0)), PRESSURE),
    Exact(
        "a thousand times softer",
        lambda _: pressures(
            problem((upper(material=steel(youngs_modulus=210.0e3)), lower(material=steel(youngs_modulus=210e6))))
        ),
        PRESSURE,
    ),
    Exact(
        "a thousand times stiffer",
        lambda _: pressures(problem((upper(material=steel(youngs_modulus=210e6)), lower()))),
        PRESSURE,
    ),
    Exact(
        "nearly incompressible",
        lambda _: pressures(problem((upper(material=steel(poissons_ratio=0.4999)), lower()))),
        PRESSURE,
        1e-6,
    ),
    Exact("auxetic", lambda _: pressures(problem((upper(material=steel(poissons_ratio=-0.9)), lower()))), PRESSURE),
    Exact("skew variant", lambda _: pressures(problem(nitsche=Nitsche(theta=-1.0))), PRESSURE),
    Exact("incomplete variant", lambda _: pressures(problem(nitsche=Nitsche(theta=0.0))), PRESSURE),
    Exact("a γ fifty times its limit", lambda _: pressures(problem(nitsche=Nitsche(safety=50.0))), PRESSURE),
    Exact("friction that holds everything", lambda _: pressures(problem(contacts=(contact(friction=1e6),))), PRESSURE),
    Exact("far from the origin, turned", lambda _: pressures(problem(), Step(placements=(AWAY, AWAY))), PRESSURE, 1e-6),
    Exact(
        "the same mesh twice",
        lambda _: pressures(
            problem((upper(LOWER), lower())), Step(placements=(Placement(np.eye(2), (0.0, 1.0)), REST))
        ),
        PRESSURE,
    ),
    Exact("no steps", lambda _: len(list(sweep(problem(), []))), 0),
    Exact(
        "steps from a generator",
        lambda _: [s.contacts[0].force[1] for s in sweep(problem(), (Step(x) for x in (0.5, 1.0)))],
        [-PRESSURE, -2 * PRESSURE],
    ),
    Exact(
        "two loads on one face",
        lambda _: pressures(
            problem((upper(loads=(Traction("top", (0.0, -40.0)), Traction("top", (0.0, -60.0)))), lower()))
        ),
        PRESSURE,
    ),
    Exact("a face moved", lambda _: pressures(pushed()), MODULUS * PUSH / 2.0),
    Exact("a face moved half of the way", lambda _: pressures(pushed(), Step(0.5)), MODULUS * PUSH / 4.0),
    Exact("a face moved away", lambda _: pressures(pushed(), Step(-1.0)), 0.0),
    Exact("a body against itself", lambda _: pressures(in_one_body()), MODULUS * PUSH / 2.0),
    Exact("a body held everywhere", lambda _: pressures(hard(contact((1, "top"), (0, "bottom")))), MODULUS * PUSH),
    Exact(
        "weight carried by the ground",
        lambda _: force(problem((upper(loads=(BodyForce((0.0, -3.0)),)), lower(loads=(BodyForce((0.0, -5.0)),))))),
        [0.0, -3.0 * 2.0],
    ),
    Exact(
        "friction just holds",
        lambda _: force(
            problem((upper(supports=(), loads=(Traction("top", (10.0, -100.0)),)), lower()), (contact(friction=0.3),))
        ),
        [20.0, -200.0],
    ),
    Exact("traction on a rigid face", lambda _: force(ridden())[1], -2.0 * PRESSURE),
    Exact("traction on a rigid face, with a load", lambda _: force(ridden(-50.0))[1], -2.0 * PRESSURE - 50.0),
    Exact(
        "a step's own load beside the factor",
        lambda _: force(ridden(-50.0), Step(0.5, freedoms=((0, Freedom("y", -80.0)),)))[1],
        -PRESSURE - 80.0,
    ),
    Exact("on after a refused step", after_failure, PRESSURE),
    Exact("a surface that points down", clockwise_file, PRESSURE),
]
