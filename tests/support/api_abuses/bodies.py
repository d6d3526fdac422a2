"""Materials, supports, loads and rigid couplings that are wrong."""

# mypy: ignore-errors
# the arguments are of the wrong types on purpose

from __future__ import annotations

import numpy as np

from evolvent import Body, BodyForce, Fixed, Freedom, Material, MeshError, Rigid, Traction, solve
from tests.support.api_abuses.blocks import CUBE, INF, NAN, TALL, UPPER, Refused, group, lower, problem, upper

MATERIALS = (
    [
        Refused(f"E = {E!r}", lambda _, E=E: Material(E, 0.3), ("youngs_modulus: wanted a finite number > 0",))
        for E in (0.0, -210e3, 1e-300, 1e300, NAN, INF, "210e3", None, True, [210e3], np.array([210e3]), 1j)
    ]
    + [
        Refused(f"ν = {ν!r}", lambda _, ν=ν: Material(210e3, ν), ("poissons_ratio: wanted −1 < ν < 0.5",))
        for ν in (0.5, 0.49999999, 0.7, -1.0, NAN, "0.3", None, False)
    ]
    + [
        Refused("text for a material", lambda _: upper(material="steel"), ("upper: wanted a Material, found 'steel'",)),
        Refused("a modulus for a material", lambda _: upper(material=210e3), ("wanted a Material, found 210000.0",)),
    ]
)

SUPPORTS = (
    [
        Refused(f"directions {letters!r}", lambda _, letters=letters: Fixed("top", letters), ('out of "xyz"', "write"))
        for letters in ("", "q", "xyzw", "xx", "X", "x,y", None, 0, ("x",))
    ]
    + [
        Refused(f"support of {name!r}", lambda _, name=name: Fixed(name), ("support: wanted a name", "facet group"))
        for name in (None, 3, "", ("top",))
    ]
    + [
        Refused(f"displaced by {u!r}", lambda _, u=u: Fixed("top", "y", u), ("wanted a finite displacement",))
        for u in (NAN, INF, "0.1", None, True)
    ]
    + [
        Refused("displaced in no direction", lambda _: Fixed("top", displacement=0.1), ("one direction",)),
        Refused("displaced in two directions", lambda _: Fixed("top", "xy", 0.1), ("one direction", "found 'xy'")),
        Refused("z in 2D", lambda _: upper(supports=(Fixed("top", "z"),)), ('out of "xy", as the body is 2D',)),
        Refused("x and z in 2D", lambda _: upper(supports=(Fixed("top", "xz"),)), ('out of "xy"', "found 'xz'")),
        Refused(
            "unknown group held",
            lambda _: upper(supports=(Fixed("floor"),)),
            ("bottom, left, right, top, found 'floor'",),
            MeshError,
        ),
        Refused(
            "empty group held",
            lambda _: upper(group(UPPER, "none", np.empty((0, 2))), supports=(Fixed("none"),)),
            ("empty",),
            MeshError,
        ),
        Refused(
            "support between cells",
            lambda _: Body(group(TALL, "far", [[0, 8]]), supports=(Fixed("far"),)),
            ("'far': wanted facets of the mesh's cells",),
            MeshError,
        ),
        Refused(
            "support without a comma", lambda _: upper(supports=(Fixed("left", "x"))), ("a tuple of Fixed", "write")
        ),
        Refused("names for supports", lambda _: upper(supports=("left",)), ("found 'left' in it",)),
        Refused("text for supports", lambda _: upper(supports="left"), ("a tuple of Fixed, found 'left'",)),
        Refused("None for supports", lambda _: upper(supports=None), ("a tuple of Fixed, found None",)),
        Refused(
            "load among the supports", lambda _: upper(supports=(Traction("top", (0.0, 1.0)),)), ("found a Traction",)
        ),
        Refused(
            "supports that contradict",
            lambda _: upper(supports=(Fixed("top", "y", 0.1), Fixed("top", "y", 0.2))),
            ("one displacement along y", "0.2 mm and 0.1 mm"),
        ),
        Refused(
            "contradiction at a corner",
            lambda _: upper(supports=(Fixed("left", "y"), Fixed("top", "y", 0.1))),
            ("0.1 mm and 0 mm", "shared nodes"),
        ),
        Refused(
            "coupling moved by a support",
            lambda _: upper(supports=(Fixed("top", "y", 0.1),), rigid=Rigid("top"), loads=()),
            ("a rigid coupling",),
        ),
    ]
)

LOADS = [
    Refused(
        f"traction {vector!r}",
        lambda _, vector=vector: Traction("top", vector),
        ("two finite components", "one number a direction"),
    )
    for vector in (
        (1.0,),
        (),
        (1.0, 2.0, 3.0, 4.0),
        (NAN, 0.0),
        (0.0, INF),
        -100.0,
        "down",
        None,
        ("0", "-1"),
        ((0.0, 1.0),),
        np.eye(2),
    )
] + [
    Refused(
        "three components in 2D",
        lambda _: upper(loads=(Traction("top", (0.0, 0.0, -1.0)),)),
        ("traction on 'top': wanted 2 components", "2D"),
    ),
    Refused(
        "two components in 3D", lambda _: Body(CUBE, loads=(Traction("top", (0.0, -1.0)),)), ("wanted 3 components",)
    ),
    Refused(
        "three-dimensional weight in 2D",
        lambda _: upper(loads=(BodyForce((0.0, 0.0, -1.0)),)),
        ("body force: wanted 2 components",),
    ),
    Refused("traction beyond all forces", lambda _: Traction("top", (0.0, 1e300)), ("numbers up to 1e\\+30", "unit")),
    Refused("weight as a number", lambda _: BodyForce(7.7e-5), ("two finite components \\[N/mm³\\]",)),
    Refused("weight not a number", lambda _: BodyForce((0.0, NAN)), ("two finite components",)),
    Refused("traction on nothing", lambda _: Traction("", (0.0, 1.0)), ("wanted a name",)),
    Refused(
        "traction on an unknown group",
        lambda _: upper(loads=(Traction("roof", (0.0, 1.0)),)),
        ("found 'roof'",),
        MeshError,
    ),
    Refused(
        "traction inside",
        lambda _: Body(group(TALL, "cut", [[1, 4]]), loads=(Traction("cut", (0.0, 1.0)),)),
        ("'cut'", "found 2 behind"),
        MeshError,
    ),
    Refused(
        "traction across cells",
        lambda _: Body(group(TALL, "far", [[0, 8]]), loads=(Traction("far", (0.0, 1.0)),)),
        ("'far'", "found 1 of no cell, the first has the nodes \\[0, 8\\]"),
        MeshError,
    ),
    Refused(
        "facet loaded twice",
        lambda _: upper(group(UPPER, "top", UPPER.facets["top"][[0, 0]])),
        ("each facet once",),
        MeshError,
    ),
    Refused(
        "load without a comma",
        lambda _: upper(loads=Traction("top", (0.0, 1.0))),
        ("a tuple of Traction or BodyForce",),
    ),
    Refused("support among the loads", lambda _: upper(loads=(Fixed("top"),)), ("found a Fixed",)),
    Refused("vector among the loads", lambda _: upper(loads=((0.0, -1.0),)), ("found \\(0.0, -1.0\\) in it",)),
]

COUPLINGS = (
    [
        Refused(
            f"freedom {name!r}", lambda _, name=name: Freedom(name, load=1.0), ("one of the rigid motions x, y, z",)
        )
        for name in ("w", "", "xy", "X", None, 1, ["x"])
    ]
    + [
        Refused(f"freedom loaded by {load!r}", lambda _, load=load: Freedom("x", load=load), ("finite load",))
        for load in (NAN, INF, -INF, "1", True, [1.0])
    ]
    + [
        Refused("freedom loaded beyond all forces", lambda _: Freedom("y", load=-1e308), ("numbers up to 1e\\+30",)),
        Refused("freedom moved by NaN", lambda _: Freedom("x", displacement=NAN), ("finite load or displacement",)),
        Refused("freedom without a value", lambda _: Freedom("x"), ("either a load or a displacement, found neither",)),
        Refused("freedom with two values", lambda _: Freedom("x", 1.0, 1.0), ("found both",)),
        Refused(
            "z in 2D is no freedom",
            lambda _: upper(rigid=Rigid("top", (Freedom("z", 1.0),))),
            ("rigid motion of x, y, rz",),
        ),
        Refused("rx in 2D is no freedom", lambda _: upper(rigid=Rigid("top", (Freedom("rx", 1.0),))), ("found 'rx'",)),
        Refused(
            "freedom twice",
            lambda _: Rigid("top", (Freedom("y", 1.0), Freedom("y", displacement=1.0))),
            ("each freedom once",),
        ),
        Refused("freedom without a comma", lambda _: Rigid("top", (Freedom("y", 1.0))), ("a tuple of Freedom",)),
        Refused("names for freedoms", lambda _: Rigid("top", ("y",)), ("found 'y' in it",)),
        Refused("text for freedoms", lambda _: Rigid("top", "y"), ("a tuple of Freedom, found 'y'",)),
        Refused("coupling of no group", lambda _: Rigid(None), ("rigid coupling: wanted a name, found None",)),
        Refused("coupling of an unknown group", lambda _: upper(rigid=Rigid("lid")), ("found 'lid'",), MeshError),
        Refused("centre not a number", lambda _: Rigid("top", centre=(0.0, NAN, 0.0)), ("a centre of two or three",)),
        Refused("centre as a number", lambda _: Rigid("top", centre=1.0), ("a centre of two or three",)),
        Refused("plane centre in 3D", lambda _: Body(CUBE, rigid=Rigid("top", centre=(0.0, 1.0))), ("centre of 3",)),
        Refused("name for a coupling", lambda _: upper(rigid="top"), ("rigid: wanted a Rigid, found 'top'",)),
        Refused(
            "coupling that a support holds",
            lambda _: solve(
                problem((Body(UPPER, supports=(Fixed("left"),), rigid=Rigid("top", (Freedom("y", 1.0),))), lower()))
            ),
            ("supports that allow the freedoms y", "Fixed\\(group"),
        ),
        Refused("number for a body's name", lambda _: upper(name=5), ("body: wanted a name, found 5",)),
        Refused("no name for a body", lambda _: upper(name=""), ("wanted a name",)),
    ]
)


ROWS = [*MATERIALS, *SUPPORTS, *LOADS, *COUPLINGS]
