"""Placements and steps that cannot be used."""

# mypy: ignore-errors
# the arguments are of the wrong types on purpose

from __future__ import annotations

import numpy as np

from evolvent import (
    Freedom,
    Placement,
    Step,
    solve,
    sweep,
)
from tests.support.api_abuses.blocks import (
    INF,
    NAN,
    REST,
    Refused,
    lower,
    problem,
    upper,
)

PLACEMENTS = [
    Refused(f"rotation {name}", lambda _, R=R: Placement(R, np.zeros(2)), words)
    for name, R, words in (
        ("that enlarges", 2.0 * np.eye(2), ("a rotation", "cannot be scaled")),
        ("that mirrors", np.diag([1.0, -1.0]), ("det R = 1",)),
        ("that shears", np.array([[1.0, 0.1], [0.0, 1.0]]), ("a rotation",)),
        ("of zeros", np.zeros((2, 2)), ("a rotation",)),
        ("rounded to three digits", [[0.866, -0.5], [0.5, 0.866]], ("full precision",)),
        ("not a number", np.full((2, 2), NAN), ("finite numbers of shape",)),
        ("3 by 2", np.eye(3)[:, :2], ("shape \\(2, 2\\) or \\(3, 3\\)",)),
        ("1 by 1", [[1.0]], ("shape \\(2, 2\\)",)),
        ("as an angle", 0.1, ("shape \\(2, 2\\)",)),
        ("of text", [["1", "0"], ["0", "1"]], ("finite numbers",)),
        ("with ragged rows", [[1.0, 0.0], [0.0]], ("finite numbers",)),
        ("None", None, ("finite numbers",)),
        ("of booleans", np.eye(2, dtype=bool), ("finite numbers",)),
    )
] + [
    Refused(
        f"translation {x!r}",
        lambda _, x=x: Placement(np.eye(2), x),
        ("translation: wanted finite numbers of shape \\(2,\\)",),
    )
    for x in ((0.0, 0.0, 0.0), (0.0,), (0.0, NAN), 1.0, None, "xy")
]

STEPS = [
    Refused(f"load factor {x!r}", lambda _, x=x: Step(x), ("step, load: wanted a finite factor",))
    for x in (NAN, INF, "1", None, True, [1.0])
] + [
    Refused("load factor beyond all numbers", lambda _: Step(1e308), ("numbers up to 1e\\+30",)),
    Refused("placed beyond the universe", lambda _: Placement(np.eye(2), (1e300, 0.0)), ("numbers up to 1e\\+30",)),
    Refused(
        "one placement",
        lambda _: solve(problem(), Step(placements=(REST,))),
        ("one for each of the 2 bodies, found 1",),
    ),
    Refused("three placements", lambda _: solve(problem(), Step(placements=(REST,) * 3)), ("found 3",)),
    Refused("no placements", lambda _: solve(problem(), Step(placements=())), ("found 0",)),
    Refused(
        "placements in 3D",
        lambda _: solve(problem(), Step(placements=(Placement.at_rest(3),) * 2)),
        ("the bodies are 2D",),
    ),
    Refused("placement without a tuple", lambda _: Step(placements=REST), ("a tuple of Placement",)),
    Refused("arrays for placements", lambda _: Step(placements=(np.eye(2), np.eye(2))), ("a tuple of Placement",)),
    Refused("freedom without a body", lambda _: Step(freedoms=(Freedom("x", 1.0),)), ("found a Freedom", "write")),
    Refused("freedom of body 0.0", lambda _: Step(freedoms=((0.0, Freedom("x", 1.0)),)), ("pairs of a body's index",)),
    Refused("freedom by name", lambda _: Step(freedoms=((0, "x"),)), ("pairs of a body's index",)),
    Refused("freedom twice in a step", lambda _: Step(freedoms=((0, Freedom("x", 1.0)),) * 2), ("once",)),
    Refused(
        "freedom of no body",
        lambda _: solve(problem(), Step(freedoms=((7, Freedom("y", 1.0)),))),
        ("below 2, found 7",),
    ),
    Refused(
        "freedom of body -1",
        lambda _: solve(problem(), Step(freedoms=((-1, Freedom("y", 1.0)),))),
        ("below 2, found -1",),
    ),
    Refused(
        "freedom of a body without coupling",
        lambda _: solve(problem(), Step(freedoms=((0, Freedom("y", 1.0)),))),
        ("declare it",),
    ),
    Refused("factor for a step", lambda _: solve(problem(), 0.5), ("step: wanted a Step, found 0.5",)),
    Refused("bodies for a problem", lambda _: solve((upper(), lower())), ("wanted a Problem",)),
    Refused("step for a list of steps", lambda _: sweep(problem(), Step()), ("a list of steps", "write sweep")),
    Refused("None for steps", lambda _: sweep(problem(), None), ("a list of steps, found None",)),
    Refused("factors for steps", lambda _: list(sweep(problem(), [0.5, 1.0])), ("step: wanted a Step, found 0.5",)),
    Refused("text for steps", lambda _: sweep(problem(), "all"), ("a list of steps, found 'all'",)),
]


ROWS = [*PLACEMENTS, *STEPS]
