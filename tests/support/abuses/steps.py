"""Contacts, problems, placements, steps and questions to a solution that are wrong."""

from __future__ import annotations

import numpy as np

from evolvent import (
    Body,
    Fixed,
    Freedom,
    MeshError,
    Nitsche,
    NotConverged,
    Placement,
    Problem,
    SearchError,
    Step,
    Traction,
    cell_stress,
    reactions,
    solve,
    sweep,
    write_paraview,
)
from tests.support.abuses.blocks import (
    CUBE,
    INF,
    LOWER,
    NAN,
    REST,
    TALL,
    UPPER,
    Abuse,
    apart,
    contact,
    group,
    hard,
    lower,
    problem,
    steel,
    upper,
)

CONTACTS = (
    [
        Abuse(
            f"friction {μ!r}", lambda _, μ=μ: contact(friction=μ), ("friction: wanted a finite number >= 0", "Coulomb")
        )
        for μ in (-0.1, NAN, INF, "0.1", None, True, [0.1])
    ]
    + [
        Abuse(
            f"reach {reach!r}",
            lambda _, reach=reach: contact(reach=reach),
            ("reach: wanted a finite number > 0", "leave it out"),
        )
        for reach in (0.0, -1.0, NAN, INF, "far", False)
    ]
    + [
        Abuse(
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
        Abuse("surface against itself", lambda _: contact((0, "top"), (0, "top")), ("two different surfaces",)),
        Abuse(
            "body that is not there",
            lambda _: problem(contacts=(contact(second=(2, "top")),)),
            ("index below 2, found 2",),
        ),
        Abuse(
            "negative body", lambda _: problem(contacts=(contact(second=(-1, "top")),)), ("index below 2, found -1",)
        ),
        Abuse(
            "unknown group in contact",
            lambda _: problem(contacts=(contact(second=(1, "roof")),)),
            ("'lower'", "found 'roof'"),
            MeshError,
        ),
        Abuse(
            "empty group in contact",
            lambda _: problem((upper(), lower(group(LOWER, "top", np.empty((0, 2)))))),
            ("'top', found it empty",),
            MeshError,
        ),
        Abuse(
            "contact inside a body",
            lambda _: Problem((Body(group(TALL, "cut", [[1, 4]])), lower()), (contact((0, "cut")),)),
            ("'cut'", "found 2 behind"),
            MeshError,
        ),
        Abuse(
            "facets twice in contact",
            lambda _: problem((upper(), lower(group(LOWER, "top", LOWER.facets["top"][[0, 0, 1]])))),
            ("each facet once",),
            MeshError,
        ),
        Abuse(
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
        Abuse("body without contact", lambda _: problem((upper(), lower(), lower())), ("body 2 \\('lower'\\)",)),
        Abuse("no contacts", lambda _: problem(contacts=()), ("at least one contact",)),
        Abuse("no bodies", lambda _: problem((), ()), ("at least one contact",)),
        Abuse("one body for bodies", lambda _: problem(upper()), ("a tuple of Body",)),
        Abuse("mesh for a body", lambda _: problem((UPPER, LOWER)), ("found a MeshData",)),
        Abuse("contact without a comma", lambda _: problem(contacts=(contact())), ("a tuple of Contact",)),
        Abuse(
            "2D against 3D",
            lambda _: problem((upper(), Body(CUBE, supports=(Fixed("bottom"),)))),
            ("all bodies in 2D or all in 3D, found both",),
        ),
        Abuse(
            "contact twice",
            lambda _: problem(contacts=(contact(), contact())),
            ("every pair of surfaces in one contact",),
        ),
        Abuse(
            "contact twice, turned",
            lambda _: problem(contacts=(contact(), contact((1, "top"), (0, "bottom")))),
            ("leave out one",),
        ),
        Abuse(
            "contact twice, under another name",
            lambda _: problem(
                (upper(), lower(group(LOWER, "part", LOWER.facets["top"][:1]))),
                (contact(), contact(second=(1, "part"))),
            ),
            ("every pair of surfaces",),
        ),
        Abuse(
            "part against the whole",
            lambda _: Problem(
                (upper(group(UPPER, "part", UPPER.facets["top"][:1])),), (contact((0, "part"), (0, "top")),)
            ),
            ("without common facets",),
        ),
        Abuse("text for nitsche", lambda _: problem(nitsche="skew"), ("wanted a Nitsche",)),
    ]
    + [
        Abuse(f"safety {x!r}", lambda _, x=x: Nitsche(safety=x), ("safety: wanted a finite number > 0",))
        for x in (0.0, -2.0, NAN, INF, "2", None)
    ]
    + [
        Abuse(f"theta {x!r}", lambda _, x=x: Nitsche(theta=x), ("theta: wanted −1 <= θ <= 1",))
        for x in (2.0, -1.5, NAN, "1", None)
    ]
)

PLACEMENTS = [
    Abuse(f"rotation {name}", lambda _, R=R: Placement(R, np.zeros(2)), words)
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
    Abuse(
        f"translation {x!r}",
        lambda _, x=x: Placement(np.eye(2), x),
        ("translation: wanted finite numbers of shape \\(2,\\)",),
    )
    for x in ((0.0, 0.0, 0.0), (0.0,), (0.0, NAN), 1.0, None, "xy")
]

STEPS = [
    Abuse(f"load factor {x!r}", lambda _, x=x: Step(x), ("step, load: wanted a finite factor",))
    for x in (NAN, INF, "1", None, True, [1.0])
] + [
    Abuse("load factor beyond all numbers", lambda _: Step(1e308), ("numbers up to 1e\\+30",)),
    Abuse("placed beyond the universe", lambda _: Placement(np.eye(2), (1e300, 0.0)), ("numbers up to 1e\\+30",)),
    Abuse(
        "one placement",
        lambda _: solve(problem(), Step(placements=(REST,))),
        ("one for each of the 2 bodies, found 1",),
    ),
    Abuse("three placements", lambda _: solve(problem(), Step(placements=(REST,) * 3)), ("found 3",)),
    Abuse("no placements", lambda _: solve(problem(), Step(placements=())), ("found 0",)),
    Abuse(
        "placements in 3D",
        lambda _: solve(problem(), Step(placements=(Placement.at_rest(3),) * 2)),
        ("the bodies are 2D",),
    ),
    Abuse("placement without a tuple", lambda _: Step(placements=REST), ("a tuple of Placement",)),
    Abuse("arrays for placements", lambda _: Step(placements=(np.eye(2), np.eye(2))), ("a tuple of Placement",)),
    Abuse("freedom without a body", lambda _: Step(freedoms=(Freedom("x", 1.0),)), ("found a Freedom", "write")),
    Abuse("freedom of body 0.0", lambda _: Step(freedoms=((0.0, Freedom("x", 1.0)),)), ("pairs of a body's index",)),
    Abuse("freedom by name", lambda _: Step(freedoms=((0, "x"),)), ("pairs of a body's index",)),
    Abuse("freedom twice in a step", lambda _: Step(freedoms=((0, Freedom("x", 1.0)),) * 2), ("once",)),
    Abuse(
        "freedom of no body",
        lambda _: solve(problem(), Step(freedoms=((7, Freedom("y", 1.0)),))),
        ("below 2, found 7",),
    ),
    Abuse(
        "freedom of body -1",
        lambda _: solve(problem(), Step(freedoms=((-1, Freedom("y", 1.0)),))),
        ("below 2, found -1",),
    ),
    Abuse(
        "freedom of a body without coupling",
        lambda _: solve(problem(), Step(freedoms=((0, Freedom("y", 1.0)),))),
        ("declare it",),
    ),
    Abuse("factor for a step", lambda _: solve(problem(), 0.5), ("step: wanted a Step, found 0.5",)),
    Abuse("bodies for a problem", lambda _: solve((upper(), lower())), ("wanted a Problem",)),
    Abuse("step for a list of steps", lambda _: sweep(problem(), Step()), ("a list of steps", "write sweep")),
    Abuse("None for steps", lambda _: sweep(problem(), None), ("a list of steps, found None",)),
    Abuse("factors for steps", lambda _: list(sweep(problem(), [0.5, 1.0])), ("step: wanted a Step, found 0.5",)),
    Abuse("text for steps", lambda _: sweep(problem(), "all"), ("a list of steps, found 'all'",)),
]

RESULTS = [
    Abuse("displacement of no body", lambda _: solve(problem()).displacement(2), ("a body index below 2, found 2",)),
    Abuse("displacement by name", lambda _: solve(problem()).displacement("upper"), ("found 'upper'",)),
    Abuse("reactions of no body", lambda _: reactions(solve(problem()), -1), ("a body index below 2, found -1",)),
    Abuse(
        "moments about nothing", lambda _: reactions(solve(problem()), 0, about=(NAN, 0.0)), ("about: wanted a point",)
    ),
    Abuse(
        "stress of another mesh",
        lambda _: cell_stress(UPPER, steel(), np.zeros((4, 2))),
        ("\\(6, 2\\)", "displacement"),
    ),
    Abuse("stress of text", lambda _: cell_stress(UPPER, steel(), "u"), ("\\(6, 2\\)",)),
    Abuse("ParaView of a problem", lambda f: write_paraview(problem(), f), ("a Solution",)),
    Abuse("ParaView of numbers", lambda f: write_paraview([1.0], f), ("Solutions only, found 1.0",)),
    Abuse("ParaView into nothing", lambda _: write_paraview(solve(problem()), ""), ("a folder to write into",)),
    Abuse(
        "ParaView into a file",
        lambda f: (f / "x").write_text("x") and write_paraview(solve(problem()), f / "x"),
        ("a folder to write into", "take another"),
    ),
]

PHYSICS = [
    Abuse("too far apart", lambda _: solve(apart(5.0)), ("within 0.1 mm", "found none", "reach"), SearchError),
    Abuse(
        "surfaces that look away",
        lambda _: solve(problem(contacts=(contact((0, "top")),))),
        ("within 0.1 mm", "reach"),
        SearchError,
    ),
    Abuse(
        "γ below its limit",
        lambda _: solve(problem(nitsche=Nitsche(safety=0.3))),
        ("upper: wanted a stiffness", "larger safety than 0.3"),
    ),
    Abuse(
        "pulled apart",
        lambda _: solve(problem(), Step(-1.0)),
        ("found no node in contact", "hold the motion"),
        NotConverged,
    ),
    Abuse(
        "nothing that holds it sideways",
        lambda _: solve(problem((upper(supports=()), lower()))),
        ("found one that meets no resistance", "support the body"),
        NotConverged,
    ),
    Abuse(
        "nothing held at all",
        lambda _: solve(problem((upper(supports=()), lower(supports=())))),
        ("found one that meets no resistance", "support the body"),
        NotConverged,
    ),
    Abuse(
        "pushed by more than friction holds",
        lambda _: solve(
            problem((upper(supports=(), loads=(Traction("top", (50.0, -100.0)),)), lower()), (contact(friction=0.3),))
        ),
        ("found one that meets no resistance", "lower the load"),
        NotConverged,
    ),
    Abuse(
        "a held surface that is to carry the pressure",
        lambda _: solve(hard(contact())),
        ("'bottom' of body 0: wanted a first surface that deforms", "name the other"),
    ),
]


ROWS = [*CONTACTS, *PLACEMENTS, *STEPS, *RESULTS, *PHYSICS]
