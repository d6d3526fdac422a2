"""docs/outputs.md and docs/summary.schema.json: every file, column and key of a run, from the dataclasses that are
written. What a field means stands beside it, as the text below it in its class."""

from __future__ import annotations

import json
import types
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass
from typing import Any, Union, get_args, get_origin, get_type_hints

from evidence.tables import markdown
from evolvent.dynamics.results.design_load import EXCITATION_FACTS
from evolvent.dynamics.results.histories import HISTORIES
from evolvent.dynamics.results.operation import OPERATION
from evolvent.dynamics.results.response import BRANCH, DYNAMICS, RESPONSE
from evolvent.dynamics.results.spectrum import SPECTRUM
from evolvent.dynamics.results.tables import EXCITATION, HARMONICS
from evolvent.dynamics.results.torque_map import TORQUE_MAP
from evolvent.dynamics.results.transient.beginning import TRANSIENT_START
from evolvent.dynamics.results.transient.facts import TRANSIENT_FACTS
from evolvent.dynamics.results.transient.rows import TRANSIENT, TRANSIENT_TEETH
from evolvent.results.archive.error_bar_data import FigureErrors
from evolvent.results.archive.run_cost import Timings
from evolvent.results.drawing.labels import UNITS, ending
from evolvent.results.mesh_facts import MeshFacts
from evolvent.results.shaft_forces import ShaftForces
from evolvent.results.tables.field_texts import field_texts
from evolvent.results.tables.load_table import ERROR, LOADS
from evolvent.results.tables.summary_rows import SCHEMA_VERSION, ErrorBars, FrictionRow, PositionRow, Summary, ToothRow
from evolvent.results.tables.table import Record, Table
from evolvent.run.design.checked import BEST
from evolvent.run.design.tables import DESIGN
from evolvent.run.kinds.losses import LOSSES
from evolvent.run.study.results.check_figures import CHECK
from evolvent.run.study.results.scene_record import RECORD
from evolvent.scene.skips import Skipped
from evolvent.strength.results.fatigue_facts import FATIGUE_FACTS
from evolvent.strength.results.fatigue_rows import FATIGUE, FATIGUE_DEPTH, FATIGUE_LIFE, FATIGUE_MAP, FATIGUE_SECTION
from evolvent.strength.results.gauge_table import GAUGES
from evolvent.strength.results.tables import ROOT_STRESS, STRENGTH
from evolvent.wear.results.archive import BLOCKS, VIBRATION
from evolvent.wear.results.report import WEAR, GearReport, PairReport

Schema = dict[str, Any]

SECONDS = Timings, "seconds"  # named without their unit
FILES = (
    ("summary.json", "all values of the run: its scene, facts, values per friction coefficient, positions"),
    ("positions.csv", "one line per position and friction coefficient"),
    ("teeth.csv", "one line per tooth pair, position and friction coefficient"),
    ("run.log", "warnings, what was skipped, one line per position, how long everything took"),
    ("scene.toml", "the scene with all its defaults; it is a scene itself"),
    ("flank_pinion.csv", "the flank chart that the scene names, docs/scene.md; likewise flank_wheel.csv"),
    ("flank_wheel.csv", "see flank_pinion.csv"),
    ("pictures/*.png", "the pictures, docs/tutorial.md"),
    ("pictures/animation.gif", "the pair turning through a pitch, coloured by the pressure"),
    ("fields/contact.pvd", "open this one in ParaView: the positions of the pitch, over the pinion's angle in degrees"),
    ("fields/flanks_*.vtp", "the loaded flanks at each position, with the arrays below"),
    ("fields/gears_*.vtp", "the teeth around them, without arrays"),
    ("fields/deformed.pvd", "with `output.deformation`: open this one in ParaView for what is inside the teeth"),
    ("fields/deformed_*.vtu", "the sectors that carry load, undeformed where they stand, with the arrays below"),
    ("results/*.npz", "what `--resume` and `evolvent plot` go on from; no interface, its form may change at any time"),
    ("results/cost.json", "command, wall time and memory so far, to which a resumed call adds its own"),
    ("results/evolvent-files.jsonl", "what runs have written here, with a checksum: only that is ever removed again"),
    (".evolvent.lock", "there while a run goes on: one run per folder"),
    ("wear.csv", "a wear study: one line per block of cycles"),
    ("wear.json", "a wear study: the values at each report"),
    (
        "worn_*",
        "a wear study: the pair after so many cycles, a folder with its tables, its scene, both flanks as "
        "charts and `results/`; pictures once `evolvent plot` draws them, no run.log, no fields",
    ),
    ("load_*", "`evolvent loads`: the run under one torque, a folder with all of the above"),
    ("loads.csv", "`evolvent loads`: one line per load and friction coefficient"),
    ("losses.csv", "`evolvent losses`: one line per torque and friction coefficient"),
    ("design.csv", "`evolvent design`: one line per variant, [flank_design.md](flank_design.md)"),
    ("design_best.csv", "likewise: one line per torque of the best variants and of the scene as it stands"),
    ("design_band.csv", "likewise: variants within the tolerances of the best one, with the columns of design.csv"),
    ("best.toml", "likewise: the scene with the best variant"),
    ("excitation.csv", "excitation under each torque: `evolvent excitation`, `dynamics`, `run` at an operating speed"),
    ("excitation.json", "`evolvent excitation` and `dynamics`: what it is of, and the load that a relief fits"),
    ("harmonics.csv", "likewise: a line per quantity, torque and mesh harmonic"),
    ("response.csv", "`evolvent dynamics`: a line per speed, running up and down"),
    ("branch.csv", "`evolvent dynamics`: a line per steady state along the branch"),
    ("spectrum.csv", "`evolvent dynamics`: a line per speed and order"),
    ("histories.csv", "motions over time at chosen speeds, or at the operating speed of `run`"),
    ("torque_map.csv", "`evolvent dynamics`: a line per torque and speed of the map"),
    ("dynamics.json", "`evolvent dynamics`: what the vibration is computed from, and its jumps"),
    ("operation.json", "`evolvent run` at an operating speed: the vibration under whose force contact was computed"),
    ("transient.csv", "`evolvent transient`: a line per speed, friction coefficient and position of the mesh period"),
    ("transient_teeth.csv", "`evolvent transient`: a line per speed, coefficient and rotation of a tooth"),
    ("transient_start.csv", "`evolvent transient`, from rest: a line per speed, coefficient and position since then"),
    ("transient.json", "`evolvent transient`: figures of each speed and coefficient"),
    ("pictures/field_of_action.gif", "`evolvent transient`: contact lines with their pressure over a mesh period"),
    ("vibration.csv", "a wear study at an operating speed: the vibration after each block"),
    ("strength.csv", "`evolvent strength`: a line per gear and way to find its root stress"),
    ("root_stress.csv", "`evolvent strength`: a line per gear, friction coefficient and rotation of a tooth"),
    ("gauges.csv", "`evolvent strength` with `strength.gauges`: a line per strain gauge, coefficient and rotation"),
    ("fatigue.csv", "`evolvent fatigue`: where each criterion is largest, a line per gear, coefficient and place"),
    ("fatigue_life.csv", "likewise: lives at several friction coefficients over that at the first"),
    ("fatigue_map.csv", "likewise: each criterion over the flank"),
    ("fatigue_depth.csv", "likewise: each criterion below the most loaded point away from the pitch line"),
    ("fatigue_section.csv", "likewise: Dang Van's criterion below all points at mid-face"),
    ("fatigue.json", "`evolvent fatigue`: what these figures rest on"),
    ("study.csv", "`evolvent study`: parameters and figures of each scene, [studies.md](studies.md)"),
    ("study.json", "`evolvent study`: what its table is of"),
    ("scenes/*", "`evolvent study`: a folder per scene, with what the command of the computation leaves"),
    ("study_scene.json", "in these: what became of the scene; written last"),
    ("check.json", "a study that checks: figures of a scene before it is computed"),
    ("check.txt", "likewise: what `evolvent check` prints"),
    ("pictures/loads.png", "`evolvent loads`: transmission error, largest pressure and mesh stiffness over the torque"),
)
ARRAYS = (
    ("gear", "0 on the pinion, 1 on the wheel"),
    ("tooth", "the tooth pair, as in teeth.csv"),
    ("roll_distance_mm", "distance from the pitch point along the path of contact, negative towards the pinion's root"),
    ("pressure_MPa (mu=...)", "contact pressure, NaN where a tip's edge bears; on the wheel the pinion's"),
    ("edge_pressure_MPa (mu=...)", "pressure where a tip's edge bears, where it is singular; 0 elsewhere"),
    ("kink_pressure_MPa (mu=...)", "pressure where the contact covers the start of a linear relief; 0 elsewhere"),
    ("traction_MPa (mu=...)", "what the wheel presses on the pinion with, a vector; 0 on the wheel"),
    ("slip_mm_per_rad (mu=...)", "sliding of the pinion over the wheel, a vector; 0 on the wheel"),
    ("sticks (mu=...)", "1 where the flanks stick, 0 where they slide or do not touch"),
)
DEFORMED = (
    ("displacement_mm", "of the nodes, a vector, at the first friction coefficient: Warp By Vector bends the teeth"),
    ("stress_MPa", "in the cells, at their centres: nine components, in space"),
    (
        "von_mises_MPa",
        "in the cells, at their centres; not for strength: fillets are coarse, and flanks in levels show their coarse "
        "body; root stresses are those of `evolvent strength`",
    ),
    ("gear", "of a cell: 0 the pinion's, 1 the wheel's"),
    ("tooth", "of a cell: the tooth pair, as in teeth.csv"),
)
FORCES = (
    "Mean over the pitch, and largest less smallest value; friction included. The forces act on the gear, bearings "
    "react with the opposite. x is the line of centres, from pinion to wheel, z the axis; seen from +z the pinion "
    "turns counter-clockwise where it drives; y = z × x. Without friction they are those of the textbooks: tangential "
    "T/r_w, radial that times tan α_wt, axial that times tan β_w; where a relieved flank or a tip's edge bears its "
    "normal is tilted, and the radial force is one or two per cent larger in the mean. These forces have no error bar: "
    "hold runs with more positions and finer meshes against each other."
)
SECTIONS: tuple[tuple[str, type, str] | tuple[Table[Any] | Record[Any], str], ...] = (
    ("`summary.json`", Summary, "Python's `json` or any other reader; a number that does not exist is `null`."),
    ("`mesh`", MeshFacts, ""),
    ("`skipped`, each entry", Skipped, ""),
    ("`timings_s`", Timings, ""),
    ("`estimated_error`", ErrorBars, ""),
    ("`frictions`, each entry", FrictionRow, ""),
    ("`frictions`, `forces_on_pinion` and `forces_on_wheel` of an entry", ShaftForces, FORCES),
    ("`frictions`, `estimated_error` and `spacing_error` of an entry", FigureErrors, ""),
    ("`positions`, each entry; the columns of `positions.csv`", PositionRow, ""),
    ("`teeth` of a position; `teeth.csv` has pinion_angle_deg and friction before them", ToothRow, ""),
    (LOADS, "Of `evolvent loads`."),
    (DESIGN, "Of `evolvent design`, in the order of computation."),
    (BEST, "Of `evolvent design`; the best variant first."),
    (LOSSES, "Of `evolvent losses`; the lightest torque first."),
    (EXCITATION, "Without friction; the lightest torque first."),
    (EXCITATION_FACTS, ""),
    (HARMONICS, "Fewer than half the positions, at most five."),
    (RESPONSE, "Of `evolvent dynamics`: running up, then running down, at ascending speeds."),
    (BRANCH, "Of `evolvent dynamics`: all steady states from the lowest speed to the highest."),
    (SPECTRUM, "Of `evolvent dynamics`: running up, then running down, at ascending speeds."),
    (HISTORIES, "At the speeds of `dynamics.histories_rpm`, or at the operating one."),
    (TORQUE_MAP, "Of `evolvent dynamics` with `dynamics.map_percents`; the lightest torque first."),
    (DYNAMICS, ""),
    (OPERATION, "Of `evolvent run`, where `dynamics.operating_rpm` is given."),
    (TRANSIENT, "Of `evolvent transient`, at ascending rotations."),
    (TRANSIENT_TEETH, "Of `evolvent transient`, at ascending rotations of a tooth."),
    (TRANSIENT_START, "Of `evolvent transient` with `transient.start = \"rest\"`, over time."),
    (TRANSIENT_FACTS, "Of `evolvent transient`."),
    (STRENGTH, "Of `evolvent strength`: the pinion first, formulas before finite elements."),
    (ROOT_STRESS, "Of `evolvent strength`, at ascending rotations."),
    (GAUGES, "Of `evolvent strength` with `strength.gauges`, at ascending rotations."),
    (FATIGUE, "Of `evolvent fatigue`: the pinion first."),
    (FATIGUE_LIFE, "Of `evolvent fatigue` with more than one friction coefficient."),
    (FATIGUE_MAP, "Of `evolvent fatigue`, from the root of the pinion on."),
    (FATIGUE_DEPTH, "Of `evolvent fatigue`, from the surface down."),
    (FATIGUE_SECTION, "Of `evolvent fatigue`, from the root of the pinion on."),
    (FATIGUE_FACTS, "Of `evolvent fatigue`."),
    (RECORD, "Of each scene of `evolvent study`."),
    (CHECK, "Of each scene of `evolvent study` with `compute = \"check\"`."),
    (BLOCKS, ""),
    (VIBRATION, "Of wear, where `dynamics.operating_rpm` is given."),
    (WEAR, ""),
    ("`wear.json`, `reports`, each entry", PairReport, ""),
    ("`wear.json`, `pinion` and `wheel` of a report", GearReport, ""),
)
"""Title, dataclass and words of a part; or table and words."""
INTRODUCTION = f"""
What a run leaves in its folder, `--out`. Units stand in the names: `_um` is µm, `_Nm` is N·m. Numbers in CSV files have
nine digits, and `nan` where there is none. A text that a spreadsheet would compute, as it begins with =, +, - or @,
stands behind an apostrophe; a text that begins with an apostrophe has two. Other programs should read `summary.json`
and the CSV files.

`summary.json` follows the [JSON schema](summary.schema.json) of `schema_version` {SCHEMA_VERSION}. New keys may come
without a new version; where a key goes or means something else the version is one more, and CHANGELOG.md says so.
"""


def unit(name: str, kind: type | None = None) -> str:
    """What a name's ending says."""
    if kind in SECONDS or name in SECONDS:
        return "s"
    figure = name.removesuffix(ERROR)  # an error bar has the unit of its figure
    return UNITS.get(ending(figure), "")


def sections() -> Iterator[tuple[str, type, str]]:
    """Title, dataclass and words of each part."""
    for section in SECTIONS:
        if len(section) == 3:
            yield section
        else:
            table, words = section
            entries = isinstance(table, Table) and table.name.endswith(".json")
            yield f"`{table.name}`" + (", each entry" if entries else ""), table.row, words


def page() -> list[str]:
    """The parts of docs/outputs.md."""
    parts = ["# What a run leaves", "<!-- Written by `make pages`: do not edit. -->", INTRODUCTION]
    parts += ["## Files", markdown(("file", "what it is"), [(f"`{name}`", what) for name, what in FILES])]
    for title, kind, words in sections():
        rows = [(f"`{name}`", unit(name, kind), text) for name, text in field_texts(kind).items()]
        parts += [f"## {title}", *([words] if words else []), markdown(("name", "unit", "meaning"), rows)]
    for files, arrays in (("flanks_*.vtp", ARRAYS), ("deformed_*.vtu", DEFORMED)):
        rows = [(f"`{name}`", unit(name.split()[0]), text) for name, text in arrays]
        parts += [f"## Arrays in `fields/{files}`", markdown(("name", "unit", "meaning"), rows)]
    return parts


def schema() -> Schema:
    """The JSON schema of summary.json."""
    summary = _object(Summary)
    summary["properties"]["schema_version"]["const"] = SCHEMA_VERSION
    head = {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "summary.json of an Evolvent run"}
    return {**head, **summary}


def schema_text() -> str:
    """As in docs/summary.schema.json."""
    return json.dumps(schema(), ensure_ascii=False, indent=1) + "\n"


def _object(kind: type) -> Schema:
    hints, texts = get_type_hints(kind), field_texts(kind)
    properties = {f.name: {"description": texts[f.name], **_type(hints[f.name])} for f in fields(kind)}
    return {"type": "object", "properties": properties, "required": list(properties)}


def _type(hint: Any) -> Schema:
    """Of a field; a float may be null, which stands for NaN."""
    simple = {bool: "boolean", int: "integer", str: "string"}
    if hint in simple:
        return {"type": simple[hint]}
    if hint is float:
        return {"type": ["number", "null"]}
    if isinstance(hint, type) and is_dataclass(hint):
        return _object(hint)
    origin, parts = get_origin(hint), get_args(hint)
    if origin in (Union, types.UnionType):
        return {"anyOf": [{"type": "null"} if part is type(None) else _type(part) for part in parts]}
    if origin in (tuple, list, Sequence) and parts:
        return {"type": "array", "items": _type(parts[0])}
    if origin is Mapping:
        return {"type": "object", "additionalProperties": {} if parts[1] is object else _type(parts[1])}
    if origin is not None and all(isinstance(part, str) for part in parts):
        return {"enum": list(parts)}  # a Literal
    raise TypeError(f"wanted a type that JSON has, found {hint}")
