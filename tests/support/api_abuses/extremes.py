"""Ratios of stiffness, motions, loads and reaches that are too small or too large: refused, or right."""

# mypy: ignore-errors
# some arguments are of other types than those declared, on purpose

from __future__ import annotations

from dataclasses import replace

import numpy as np

from evolvent import (
    Body,
    BodyForce,
    Fixed,
    Freedom,
    Placement,
    Problem,
    Rigid,
    SearchError,
    SmallStrainExceeded,
    Step,
    Traction,
    solve,
)
from tests.support.api_abuses.blocks import (
    PRESSURE,
    REST,
    ROLLS,
    UPPER,
    Exact,
    Refused,
    contact,
    force,
    lower,
    pressures,
    problem,
    steel,
    upper,
)


def moved(*freedoms: Freedom) -> Problem:
    """The upper block on a rigid top that is moved or loaded so."""
    rigid = Rigid("top", freedoms, centre=(1.0, 2.0))
    return problem((upper(supports=(), loads=(), rigid=rigid), lower(supports=(Fixed("bottom"),))))


def raised(gap: float, reach: float) -> Problem:
    """The upper block lifted by `gap`, loaded as before."""
    return problem(
        (upper(replace(UPPER, points=UPPER.points + np.array([0.0, gap, 0.0]))), lower()), (contact(reach=reach),)
    )


def stiffer(one: float, other: float, **sides: tuple[int, str]) -> Problem:
    """The blocks with their moduli multiplied."""
    bodies = upper(material=steel(youngs_modulus=210e3 * one)), lower(material=steel(youngs_modulus=210e3 * other))
    return problem(bodies, (contact(**sides),))


def pressed(vertical: float) -> Body:
    return upper(loads=(Traction("top", (0.0, vertical)),))


TURNED = {"first": (1, "top"), "second": (0, "bottom")}
REFUSED = [
    Refused(
        "a load beyond all strength",
        lambda _: solve(problem((pressed(-1e12), lower()))),
        ("strain of at most 0.2",),
        SmallStrainExceeded,
    ),
    Refused(
        "a modulus in GPa",
        lambda _: solve(stiffer(1e-4, 1.0)),
        ("found 4.33", "mistake in units"),
        SmallStrainExceeded,
    ),
    Refused(
        "weight in N/m³",
        lambda _: solve(problem((upper(loads=(BodyForce((0.0, -1e9)),)), lower()))),
        ("strain of at most 0.2",),
        SmallStrainExceeded,
    ),
    Refused(
        "a turn of 0.8 rad",
        lambda _: solve(moved(Freedom("rz", displacement=0.8))),
        ("turn by at most 0.1 rad", "Placement"),
        SmallStrainExceeded,
    ),
    Refused(
        "a face moved through the other body",
        lambda _: solve(problem((upper(supports=(ROLLS, Fixed("top", "y", -1.5)), loads=()), lower()))),
        ("strain of at most 0.2", "prescribe less"),
        SmallStrainExceeded,
    ),
    Refused(
        "dragged off the edge",
        lambda _: solve(moved(Freedom("y", load=-100.0), Freedom("x", displacement=5.0))),
        ("within 0.1 mm", "reach"),
        SearchError,
    ),
    Refused(
        "a reach below the gap", lambda _: solve(raised(1e-3, 1e-9)), ("within 1e-09 mm", "larger reach"), SearchError
    ),
]
EXACT = [
    *(
        Exact(f"{name} stiffer by {ratio:g}", lambda _, make=make, ratio=ratio: pressures(make(ratio)), PRESSURE, 1e-6)
        for ratio in (1e4, 1e6, 1e8)
        for name, make in (
            ("first body", lambda x: stiffer(x, 1.0)),
            ("second body", lambda x: stiffer(1.0, x)),
            ("first body, sides turned", lambda x: stiffer(x, 1.0, **TURNED)),
            ("second body, sides turned", lambda x: stiffer(1.0, x, **TURNED)),
        )
    ),
    Exact(
        "a tiny reach of surfaces that touch", lambda _: pressures(problem(contacts=(contact(reach=1e-9),))), PRESSURE
    ),
    Exact("a reach beyond both bodies", lambda _: pressures(problem(contacts=(contact(reach=1e6),))), PRESSURE),
    Exact("a gap that a load without resistance closes", lambda _: pressures(raised(0.05, 0.06)), PRESSURE),
    Exact(
        "placed in overlap",
        lambda _: pressures(problem(), Step(placements=(Placement(np.eye(2), (0.0, -0.05)), REST))),
        PRESSURE,
    ),
    Exact(
        "dragged by half of its width",
        lambda _: force(moved(Freedom("y", load=-100.0), Freedom("x", displacement=1.0))),
        [0.0, -100.0],
    ),
    Exact(
        "a face moved far away",
        lambda _: pressures(problem((upper(supports=(ROLLS, Fixed("top", "y", 50.0)), loads=()), lower()))),
        0.0,
    ),
]
