"""Contacts, problems and settings of the method that cannot be used."""

# mypy: ignore-errors
# the arguments are of the wrong types on purpose

from __future__ import annotations

import numpy as np

from evolvent import (
    Body,
    Fixed,
    MeshError,
    Nitsche,
    Problem,
    solve,
)
from tests.support.api_abuses.blocks import (
    CUBE,
    INF,
    LOWER,
    NAN,
    TALL,
    UPPER,
    Refused,
    contact,
    group,
    lower,
    problem,
    upper,
)

ROWS = (
    [
        Refused(
            f"friction {μ!r}", lambda _, μ=μ: contact(friction=μ), ("friction: wanted a finite number >= 0", "Coulomb")
        )
        for μ in (-0.1, NAN, INF, "0.1", None, True, [0.1])
    ]
    + [
        Refused(
            f"reach {reach!r}",
            lambda _, reach=reach: contact(reach=reach),
            ("reach: wanted a finite number > 0", "leave it out"),
        )
        for reach in (0.0, -1.0, NAN, INF, "far", False)
    ]
    + [
        Refused(
            f"side {side!r}",
            lambda _, side=side: contact(side),
            ("first side: wanted a body's index and a facet group",),
        )
        for side in (
            "bottom",
            0,
            None,
            ("bottom", 0),
            (0,),
            (0, "bottom", 1),
            (0.0, "bottom"),
            (True, "bottom"),
            (0, None),
        )
    ]
    + [
        Refused("surface against itself", lambda _: contact((0, "top"), (0, "top")), ("two different surfaces",)),
        Refused(
            "body that is not there",
            lambda _: problem(contacts=(contact(second=(2, "top")),)),
            ("index below 2, found 2",),
        ),
        Refused(
            "negative body", lambda _: problem(contacts=(contact(second=(-1, "top")),)), ("index below 2, found -1",)
        ),
        Refused(
            "unknown group in contact",
            lambda _: problem(contacts=(contact(second=(1, "roof")),)),
            ("'lower'", "found 'roof'"),
            MeshError,
        ),
        Refused(
            "empty group in contact",
            lambda _: problem((upper(), lower(group(LOWER, "top", np.empty((0, 2)))))),
            ("'top', found it empty",),
            MeshError,
        ),
        Refused(
            "contact inside a body",
            lambda _: Problem((Body(group(TALL, "cut", [[1, 4]])), lower()), (contact((0, "cut")),)),
            ("'cut'", "found 2 behind"),
            MeshError,
        ),
        Refused(
            "facets twice in contact",
            lambda _: problem((upper(), lower(group(LOWER, "top", LOWER.facets["top"][[0, 0, 1]])))),
            ("each facet once",),
            MeshError,
        ),
        Refused(
            "contact around a corner",
            lambda _: solve(
                problem(
                    (
                        upper(group(UPPER, "skin", np.concatenate([UPPER.facets["bottom"], UPPER.facets["left"]]))),
                        lower(),
                    ),
                    (contact((0, "skin")),),
                )
            ),
            ("without sharp edges", "\\(0, 1\\) mm"),
            MeshError,
        ),
        Refused("body without contact", lambda _: problem((upper(), lower(), lower())), ("body 2 \\('lower'\\)",)),
        Refused("no contacts", lambda _: problem(contacts=()), ("at least one contact",)),
        Refused("no bodies", lambda _: problem((), ()), ("at least one contact",)),
        Refused("one body for bodies", lambda _: problem(upper()), ("a tuple of Body",)),
        Refused("mesh for a body", lambda _: problem((UPPER, LOWER)), ("found a MeshData",)),
        Refused("contact without a comma", lambda _: problem(contacts=(contact())), ("a tuple of Contact",)),
        Refused(
            "2D against 3D",
            lambda _: problem((upper(), Body(CUBE, supports=(Fixed("bottom"),)))),
            ("all bodies in 2D or all in 3D, found both",),
        ),
        Refused(
            "contact twice",
            lambda _: problem(contacts=(contact(), contact())),
            ("every pair of surfaces in one contact",),
        ),
        Refused(
            "contact twice, turned",
            lambda _: problem(contacts=(contact(), contact((1, "top"), (0, "bottom")))),
            ("leave out one",),
        ),
        Refused(
            "contact twice, under another name",
            lambda _: problem(
                (upper(), lower(group(LOWER, "part", LOWER.facets["top"][:1]))),
                (contact(), contact(second=(1, "part"))),
            ),
            ("every pair of surfaces",),
        ),
        Refused(
            "part against the whole",
            lambda _: Problem(
                (upper(group(UPPER, "part", UPPER.facets["top"][:1])),), (contact((0, "part"), (0, "top")),)
            ),
            ("without common facets",),
        ),
        Refused("text for nitsche", lambda _: problem(nitsche="skew"), ("wanted a Nitsche",)),
    ]
    + [
        Refused(f"safety {x!r}", lambda _, x=x: Nitsche(safety=x), ("safety: wanted a finite number > 0",))
        for x in (0.0, -2.0, NAN, INF, "2", None)
    ]
    + [
        Refused(f"theta {x!r}", lambda _, x=x: Nitsche(theta=x), ("theta: wanted −1 <= θ <= 1",))
        for x in (2.0, -1.5, NAN, "1", None)
    ]
)
