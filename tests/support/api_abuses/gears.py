"""Gear data, problems, condensed gears and wear of gears that cannot be used."""

# mypy: ignore-errors
# the arguments are of the wrong types on purpose

from __future__ import annotations

from functools import cache

import numpy as np

from evolvent.gears import (
    FlankChart,
    GearModel,
    GearPair,
    GearParameters,
    GearProblem,
    GeometryError,
    Material,
    MeshSettings,
    Modifications,
    Support,
    Web,
    condense,
    solve_pitch,
    solve_pitches,
    solve_single_position,
)
from evolvent.wear import Archard, wear_study, wearing_pair
from tests.support.api_abuses.blocks import NAN, Refused

STEEL = Material(210e3, 0.3)
RACK = {"z": 50, "normal_module": 3.0, "normal_pressure_angle_deg": 20.0, "face_width": 20.0, "bore_diameter": 70.0}


def gear(**changes):
    """He's gear, with other data where given."""
    return GearParameters.from_rack(**{**RACK, **changes})


def problem(**changes):
    """He's pair with first-order cells, the quickest one."""
    pair = GearPair(gear(), gear(), 150.0)
    return GearProblem(**{"pair": pair, "torque": 170e3, "mesh": MeshSettings("quick", order=1), **changes})


def chart(start=130.0, depth=0.01):
    """A flank that lacks the depth [mm] from a diameter [mm] to its tip."""
    return FlankChart(np.linspace(start, 156.0, 5), np.zeros(1), np.full((5, 1), depth))


@cache
def condensed() -> GearModel:
    """Its condensed gears."""
    return condense(problem())


@cache
def wearing():
    """Its wearing pair."""
    return wearing_pair(problem(), Archard(1e-10, 1e-10), positions=2)


GEARS = (
    [
        Refused(f"{key} = {value!r}", lambda _, key=key, value=value: gear(**{key: value}), words, GeometryError)
        for key, value, words in (
            ("z", "21", ("z: found '21', allowed a whole number from 5 on",)),
            ("z", -55, ("z: found -55, allowed a whole number from 5 on", "internal gears are not supported")),
            ("z", 21.5, ("z: found 21.5",)),
            ("z", True, ("z: found True",)),
            ("normal_module", "3", ("normal_module: found '3', allowed a number", "without quotes")),
            ("normal_pressure_angle_deg", 90.0, ("found 90, allowed 5 to 45 degrees",)),
            ("normal_pressure_angle_deg", None, ("normal_pressure_angle_deg: found None",)),
            ("helix_angle_deg", NAN, ("helix_angle_deg: found nan",)),
            ("profile_shift", "0.2", ("profile_shift: found '0.2'",)),
            ("face_width", "20", ("face_width: found '20'",)),
            ("bore_diameter", [70.0], ("bore_diameter: found \\[70.0\\]",)),
            ("hand", "left", ("hand: found left, allowed \\+1 \\(right\\) or -1 \\(left\\)",)),
            ("rack_tip_radius_coefficient", "0.38", ("rack_tip_radius_coefficient: found '0.38'",)),
            ("tooth_thickness_allowance_um", "-50", ("tooth_thickness_allowance_um: found '-50'",)),
            ("tooth_thickness_allowance_um", 50.0, ("found 50, allowed -900 to 0 µm", "negative")),
            ("tip_rounding_um", "200", ("tip_rounding_um: found '200'",)),
            ("tip_chamfer_um", NAN, ("tip_chamfer_um: found nan",)),
            ("protuberance_um", None, ("protuberance_um: found None",)),
            ("support", 8.0, ("support: found 8.0, allowed Support", "Write Support")),
            ("support", Support("8"), ("support_width: found '8'",)),
            ("support", Support(8.0, NAN), ("support_offset: found nan",)),
            ("web", 8.0, ("web: found 8.0, allowed Web", "Write Web")),
            ("web", Web("8", 6.0), ("web_thickness: found '8'",)),
            ("web", Web(8.0, 6.0, "90"), ("hub_diameter: found '90'",)),
            ("web", Web(8.0, 6.0, 90.0, NAN), ("web_offset: found nan",)),
            ("modifications", 5.0, ("modifications: found 5.0, allowed Modifications",)),
            ("modifications", Modifications("5"), ("tip_relief_um: found '5'",)),
            ("modifications", Modifications(5.0, "151"), ("tip_relief_start_diameter: found '151'",)),
        )
    ]
    + [
        Refused("gears by name", lambda _: GearPair("a", "b", 150.0), ("pinion: found 'a'", "Write"), GeometryError),
        Refused("distance as text", lambda _: GearPair(gear(), gear(), "150"), ("found '150'",), GeometryError),
        Refused("no chart", lambda f: FlankChart.read(str(f / "x.csv")), ("x.csv: found No such file",)),
        Refused("number for a chart", lambda _: FlankChart.read(5), ("wanted a str or a PathLike, found 5",)),
        Refused(
            "chart out of order",
            lambda _: FlankChart(np.array([150.0, 145.0]), np.zeros(1), np.zeros((2, 1))),
            ("diameters: wanted ascending ones", "sort"),
        ),
        Refused(
            "chart the wrong way round",
            lambda _: FlankChart(np.array([145.0, 150.0, 155.0]), np.zeros(1), np.zeros((1, 3))),
            ("depth: wanted finite numbers of shape \\(3, 1\\)", "a row a diameter"),
        ),
        Refused("chart of one diameter", lambda _: FlankChart([145.0], [0.0], [[0.0]]), ("two diameters",)),
    ]
)

PROBLEMS = [
    Refused(f"{key} = {value!r:.40}", lambda _, key=key, value=value: problem(**{key: value}), words)
    for key, value, words in (
        ("pair", "he", ("pair: wanted a GearPair, found 'he'; write GearPair",)),
        ("mesh", "quick", ('mesh: wanted a MeshSettings, found .quick.; write MeshSettings\\("quick"\\)',)),
        ("materials", STEEL, ("materials: wanted two of Material", "write materials=\\(pinion, wheel\\)")),
        ("materials", (STEEL,), ("wanted two of Material",)),
        ("materials", (210e3, 0.3), ("wanted two of Material, found \\(210000.0, 0.3\\)",)),
        ("flanks", "x.csv", ("flanks: wanted two of FlankChart or None, found 'x.csv'",)),
        ("flanks", ("x.csv", None), ("flanks: wanted two of FlankChart or None",)),
        ("flanks", (chart(depth=10.0), None), ("flanks, pinion: found 1e\\+04 µm", "is the column's unit right")),
        ("flanks", (None, chart(start=148.0)), ("flanks, wheel: found 148 to 156 mm; allowed: diameters over",)),
        ("options", {"in_space": True}, ("options: wanted a GearOptions", "write GearOptions")),
        ("torque", "170e3", ("torque: wanted a finite number > 0",)),
    )
]

CALLS = [
    Refused("name for a problem", lambda _: condense("x"), ("problem: wanted a GearProblem, found 'x'",)),
    Refused("pair for a problem", lambda _: condense(problem().pair), ("wanted a GearProblem, found a GearPair",)),
    Refused(
        "a pitch of a problem", lambda _: solve_pitch(problem()), ("wanted a GearModel", "write condense\\(problem\\)")
    ),
    Refused("pitches of nothing", lambda _: solve_pitches(None, (0.1,)), ("gears: wanted a GearModel, found None",)),
    Refused(
        "a position of a problem",
        lambda _: solve_single_position(problem(), 0.0),
        ("gears: wanted a GearModel, found a GearProblem", "write condense\\(problem\\)"),
    ),
    Refused("one number for coefficients", lambda _: solve_pitches(condensed(), 0.1), ("write frictions=\\(0.1,\\)",)),
    Refused("friction as text", lambda _: solve_pitch(condensed(), "0.1"), ("from 0 to 1, found '0.1'",)),
    Refused("angle as text", lambda _: solve_single_position(condensed(), "0.1"), ("angle: wanted a rotation",)),
]

WEAR = [
    Refused("wear coefficient as text", lambda _: Archard("1e-10"), ("first surface: wanted K/H of zero or more",)),
    Refused("negative wear coefficient", lambda _: Archard(1e-10, -1e-10), ("second surface: wanted K/H of zero",)),
    Refused(
        "wear of condensed gears",
        lambda _: wearing_pair(condensed(), Archard(1e-10)),
        ("problem: wanted a GearProblem, found a GearModel", "give the problem itself"),
    ),
    Refused(
        "wear by a number",
        lambda _: wearing_pair(problem(), 1e-10),
        ("law: wanted an Archard, found 1e-10", "write Archard"),
    ),
    Refused("refresh as text", lambda _: wearing_pair(problem(), Archard(), refresh="1"), ("refresh: wanted a depth",)),
    Refused("study of a problem", lambda _: wear_study(problem(), (1.0,)), ("pair: wanted a GearWear", "wearing_pair")),
    Refused(
        "one report", lambda _: wear_study(wearing(), reports=1e5), ("a sequence", "write reports=\\(100000.0,\\)")
    ),
    Refused("reports as text", lambda _: wear_study(wearing(), ("1e5",)), ("numbers of cycles, found '1e5'",)),
    Refused("a number for settings", lambda _: wear_study(wearing(), (1e5,), 1e3), ("wanted a BlockSettings",)),
]


ROWS = [*GEARS, *PROBLEMS, *CALLS, *WEAR]
