"""Questions to a solution that have no answer, and problems without an equilibrium."""

# mypy: ignore-errors
# the arguments are of the wrong types on purpose

from __future__ import annotations

import numpy as np

from evolvent import (
    Nitsche,
    NotConverged,
    SearchError,
    Step,
    Traction,
    cell_stress,
    reactions,
    solve,
    write_paraview,
)
from tests.support.api_abuses.blocks import (
    NAN,
    UPPER,
    Refused,
    apart,
    contact,
    hard,
    lower,
    problem,
    steel,
    upper,
)

RESULTS = [
    Refused(
        "displacement of no body", lambda _: solve(problem()).displacement(2),
        ("a body of the problem, or its number from 0 to 1, found 2",),
    ),
    Refused("displacement by name", lambda _: solve(problem()).displacement("upper"), ("found 'upper'",)),
    Refused("reactions of no body", lambda _: reactions(solve(problem()), -1), ("its number from 0 to 1, found -1",)),
    Refused(
        "moments about nothing", lambda _: reactions(solve(problem()), 0, about=(NAN, 0.0)), ("about: wanted a point",)
    ),
    Refused(
        "stress of another mesh",
        lambda _: cell_stress(UPPER, steel(), np.zeros((4, 2))),
        ("\\(6, 2\\)", "displacement"),
    ),
    Refused("stress of text", lambda _: cell_stress(UPPER, steel(), "u"), ("\\(6, 2\\)",)),
    Refused("ParaView of a problem", lambda f: write_paraview(problem(), f), ("a Solution",)),
    Refused("ParaView of numbers", lambda f: write_paraview([1.0], f), ("Solutions only, found 1.0",)),
    Refused("ParaView into nothing", lambda _: write_paraview(solve(problem()), ""), ("a folder to write into",)),
    Refused(
        "ParaView into a file",
        lambda f: (f / "x").write_text("x") and write_paraview(solve(problem()), f / "x"),
        ("a folder to write into", "take another"),
    ),
]

PHYSICS = [
    Refused("too far apart", lambda _: solve(apart(5.0)), ("within 0.1 mm", "found none", "reach"), SearchError),
    Refused("overlapping by too much", lambda _: solve(apart(-0.5)), ("if they overlap by more", "apart"), SearchError),
    Refused(
        "surfaces that look away",
        lambda _: solve(problem(contacts=(contact((0, "top")),))),
        ("within 0.1 mm", "reach"),
        SearchError,
    ),
    Refused(
        "γ below its limit",
        lambda _: solve(problem(nitsche=Nitsche(safety=0.3))),
        ("upper: wanted a stiffness", "larger safety than 0.3"),
    ),
    Refused(
        "pulled apart",
        lambda _: solve(problem(), Step(-1.0)),
        ("found no node in contact", "check the sign of the load", "hold the motion"),
        NotConverged,
    ),
    Refused(
        "nothing that holds it sideways",
        lambda _: solve(problem((upper(supports=()), lower()))),
        ("found one that meets no resistance", "body 0 \\('upper'\\) is free to move in x: add Fixed or Rigid"),
        NotConverged,
    ),
    Refused(
        "nothing held at all",
        lambda _: solve(problem((upper(supports=()), lower(supports=())))),
        ("found one that meets no resistance", "body [01] \\('(upper|lower)'\\) is free to move"),
        NotConverged,
    ),
    Refused(
        "pushed by more than friction holds",
        lambda _: solve(
            problem((upper(supports=(), loads=(Traction("top", (50.0, -100.0)),)), lower()), (contact(friction=0.3),))
        ),
        ("found one that meets no resistance", "lower the load"),
        NotConverged,
    ),
    Refused(
        "a held surface that is to carry the pressure",
        lambda _: solve(hard(contact())),
        ("'bottom' of body 0: wanted a first surface that deforms", "name the other"),
    ),
]


ROWS = [*RESULTS, *PHYSICS]
