"""What gear pairs cost: the sections on pitches, sizes, skips, 2D against 3D, wear and vibration."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from evidence.benchmarks.gears.earlier import EarlierPitchRow, EarlierRow
from evidence.benchmarks.gears.pitch_precision import PitchRow
from evidence.benchmarks.gears.plane_and_solid import SpurRow
from evidence.benchmarks.gears.profile import ProfileRow
from evidence.benchmarks.gears.scaling import RatioRow, SizeRow, exponent
from evidence.benchmarks.gears.skips import SkipRow
from evidence.benchmarks.gears.wear import BLOCKS, WearCostRow, WearPrecisionRow
from evidence.benchmarks.gears.whole_runs import RANKS, RunRow
from evidence.benchmarks.motion.motion_row import MotionRow
from evidence.benchmarks.pages import figures
from evidence.benchmarks.pages.section import PageSection, verdict
from evidence.tables import Column, Table

LEVELS_BAR = 1.2
SPUR_BAR = 20.0
WEAR_BAR = 5.0
PITCHES = """Wall seconds of the whole process without meshing: for a run of one position, for the pitch, and for one
position with an empty cache of compiled forms (*cold*). Error: of the pitch's mean transmission error, against the
overkill pitch. *Elements* are those across the contact width; the body keeps what its level has, and with order 1 the
error of that remains. Flanks in *levels* are finer than their body ([two_level.md](two_level.md)): dofs are then those
of one fine mesh with the same cells in contact."""
TRANSIENT = """CPU seconds of one process with one thread, without the start of Python, pictures and error bars. A time
step over a position without inertia: all steps from statics to a motion that repeats with the mesh, searches of the
first mesh period among them, over a pitch at one friction coefficient that is swept until friction repeats. Yang's pair
at level quick, all in all: meshing, condensing, statics, natural modes, and time steps until its motion repeats."""


def _power_laws(rows: Sequence[SizeRow]) -> list[str]:
    solved = [row for row in rows if not row.note]
    if len(solved) < 2:
        return []
    dofs = figures.column(solved, "dofs")
    names = {"memory_MB": "memory", "condense": "condensing", "position": "one more position"}
    laws = [f"{text} ~ dofs^{exponent(dofs, figures.column(solved, name)):.2f}" for name, text in names.items()]
    return ["; ".join(laws) + "."]


def _levels_said(rows: Sequence[SizeRow]) -> list[str]:
    return [
        "The same with levels on the flanks; dofs are those of one fine mesh of both sectors that has the same cells "
        "in contact. The two positions of such a pitch are half a pitch apart, so that each takes more searches and "
        f"iterations than neighbours do. Wanted of condensing: at most dofs^{LEVELS_BAR:g}."
    ]


def _profile_said(rows: Sequence[ProfileRow]) -> list[str]:
    return [
        f"A pitch of {rows[0].positions} positions at one friction coefficient, {rows[0].dofs:,} dofs, by Python's "
        "profiler, which slows small functions down."
    ]


def _levels_profile_said(rows: Sequence[ProfileRow]) -> list[str]:
    return [
        f"The same at standard on flanks in levels, {rows[0].positions} positions, some of them twice, as the friction "
        "history closes:"
    ]


def _skips_said(rows: Sequence[SkipRow]) -> list[str]:
    beyond = [row.skip for row in rows if not row.difference <= row.tolerance]
    said = f"Beyond their tolerance: {', '.join(beyond)}." if beyond else "All differences are within the tolerances."
    return [
        f"Whole runs at level quick (wall time, pictures and error bars off), with a skip and with `--exact`. {said}"
    ]


def least_ratio(rows: Sequence[SpurRow]) -> float:
    """Least ratio of the seconds in 3D over those in 2D."""
    return min(row.volume_seconds / row.seconds for row in rows)


def _spur_said(rows: Sequence[SpurRow]) -> list[str]:
    least = least_ratio(rows)
    met = "met" if least >= SPUR_BAR else f"MISSED, {least:.1f} at the least"
    return [
        "He's spur pair, 20 positions without friction, in 2D and on the smallest 3D mesh whose error in the "
        f"transmission error is no larger; CPU seconds. Wanted: at least {SPUR_BAR:g} times: {met}."
    ]


def _runs_said(rows: Sequence[RunRow]) -> list[str]:
    return [
        f"`evolvent run` on {RANKS} ranks, from the scene file to its last output: wall seconds, memory of all "
        "ranks at once, iterations of Newton's method a position. *Plain*: without error bars, pictures and fields. "
        "Degrees of freedom are those of one sector of both gears, and of the finest flanks where they have levels. "
        "The scenes are in `evidence/benchmarks/gears/whole_runs.py`."
    ]


def _earlier_said(rows: Sequence[EarlierRow]) -> list[str]:
    commits = {row.commit for row in rows}, {row.own_commit for row in rows}
    before, now = (", ".join(sorted(names)) for names in commits)
    return [
        f"Commits {before} (*before*) and {now} (*now*), one run after the other on {RANKS} ranks "
        "(`python -m evidence.benchmarks.gears.earlier CHECKOUT`): wall seconds of the whole process, memory of all "
        "ranks at once. *Now* with an empty cache of condensed gears, *again* with the filled one. *Off*: the "
        "peak-to-peak transmission error before, less that now. Rows were measured on machines of different speed: "
        "only seconds of one row compare."
    ]


def _earlier_pitches_said(rows: Sequence[EarlierPitchRow]) -> list[str]:
    return [
        f"Yang's pair on flanks in levels, {rows[0].positions} positions on one rank, without a cache of condensed "
        f"gears: commits {rows[0].commit} and {rows[0].own_commit} (the same command with `--pitches`). Wall seconds "
        "without meshing; errors of the mean transmission error against one mesh, whose own error is that of the "
        "overkill pitch below."
    ]


def _wear_said(rows: Sequence[WearCostRow]) -> list[str]:
    whole, bare = (
        "met" if all(ratio <= WEAR_BAR for ratio in ratios) else "missed"
        for ratios in ([row.whole for row in rows], [row.bare for row in rows])
    )
    return [
        f"A study of {BLOCKS} implicit blocks over one sweep of the unworn pair, without friction, CPU seconds; "
        f"*whole* with preparing both gears, on either side, *bare* without. Wanted at most {WEAR_BAR:g} times: whole "
        f"{whole}, bare {bare}."
    ]


PITCH_TABLE = Table(
    PitchRow,
    (
        Column("cells", "shape", words=True), Column("order", "order"), Column("ranks", "ranks"),
        Column("flanks", "flanks", words=True), Column("elements", "elements", "g"), Column("dofs", "dofs", ","),
        Column("one position s", "one", ".3g"),
        Column("cold s", "cold", ".3g"), Column("pitch s", "pitch", ".3g"), Column("MB", "memory_MB", ".0f"),
        Column("error %", "error", "+.2%"), Column("overkill's own %", "reference_error", ".2%"),
    ),
)
RATIO_TABLE = Table(
    RatioRow,
    (
        Column("ratio of", "what", words=True), Column("dofs", "dofs", ","), Column("s", "above", ".3g"),
        Column("over s", "below", ".3g"), Column("found", lambda row: f"**{row.ratio:.2f}**"),
        Column("bar", lambda row: f"at {'least' if row.is_least else 'most'} {row.bar:g}"), Column("aim", "aim", "g"),
        Column("bar is", lambda row: verdict(row.met), words=True),
    ),
)
SIZE_TABLE = Table(
    SizeRow,
    (
        Column("elements across 2b", "elements", "g"), Column("dofs", "dofs", ","),
        Column("assemble s", "assemble", ".3g"), Column("condense s", "condense", ".3g"),
        Column("s a position", "position", ".3g"), Column("Newton", "iterations", ".0f"),
        Column("MB", "memory_MB", ".0f"),
    ),
)
PROFILE_TABLE = Table(
    ProfileRow,
    (
        Column("part", "part", words=True), Column("s", "seconds", ".3g"), Column("%", "share", ".1%"),
        Column("calls", "calls"),
    ),
)
SKIP_TABLE = Table(
    SkipRow,
    (
        Column("skip", "skip", words=True), Column("scene", lambda row: row.scene.removeprefix("demos/"), words=True),
        Column("s", "seconds", ".3g"), Column("without s", "long_seconds", ".3g"),
        Column("times", lambda row: f"**{row.long_seconds / row.seconds:.2f}**"), Column("MB", "memory_MB", ".0f"),
        Column("without MB", "long_memory_MB", ".0f"),
        Column("times", lambda row: row.long_memory_MB / row.memory_MB, ".2f"),
        Column("difference", "difference", ".1e"), Column("tolerance", "tolerance", ".0e"),
    ),
)
SPUR_TABLE = Table(
    SpurRow,
    (
        Column("2D elements", "elements", "g"), Column("body", lambda row: "finer" if row.fine_body else "as is"),
        Column("s", "seconds", ".3g"), Column("MB", "memory_MB", ".0f"), Column("error %", "error", ".2%"),
        Column("3D elements", "volume_elements", "g"), Column("layers", "layers"),
        Column("s", "volume_seconds", ".3g"), Column("MB", "volume_memory_MB", ".0f"),
        Column("error %", "volume_error", ".2%"),
        Column("3D over 2D", lambda row: f"**{row.volume_seconds / row.seconds:.1f}**"),
    ),
)
RUN_TABLE = Table(
    RunRow,
    (
        Column("run", "case", words=True), Column("level", "level", words=True), Column("coefficients", "frictions"),
        Column("dofs", lambda row: row.dofs + row.flank_dofs, ","), Column("prepare s", "prepare", ".3g"),
        Column("positions s", "positions", ".3g"), Column("error bars s", "error_bars", ".3g"),
        Column("output s", "output", ".3g"), Column("all s", "seconds", ".0f"), Column("bar", "seconds_bar", ".0f"),
        Column("MB", "memory_MB", ".0f"), Column("bar", "memory_bar_MB", ".0f"), Column("Newton", "iterations", ".1f"),
        Column("bar", "iterations_bar", ".0f"),
        Column("", lambda row: verdict(row.met) if row.has_bar and not row.note else "", words=True),
    ),
)
EARLIER_TABLE = Table(EarlierRow, (
    Column("run", "case", words=True), Column("level", "level", words=True), Column("coefficients", "frictions"),
    Column("before s", "earlier_seconds", ".0f"), Column("MB", "earlier_MB", ".0f"),
    Column("now s", "empty_seconds", ".0f"), Column("MB", "empty_MB", ".0f"), Column("bar", "memory_bar_MB", ".0f"),
    Column("times", lambda row: f"**{row.ratio:.1f}**"), Column("bar", "least_ratio", "g"),
    Column("again s", "filled_seconds", ".0f"), Column("times", lambda row: f"**{row.filled_ratio:.1f}**"),
    Column("bar", "least_filled_ratio", "g"), Column("peak to peak µm", "peak_to_peak_um", ".3f"),
    Column("off µm", "peak_to_peak_off_um", "+.3f"),
    Column("", lambda row: verdict(row.met), words=True),
))
EARLIER_PITCH_TABLE = Table(EarlierPitchRow, (
    Column("elements across 2b", "elements", "g"), Column("before s", "earlier_seconds", ".0f"),
    Column("MB", "earlier_MB", ".0f"), Column("error %", "earlier_error", "+.2%"), Column("now s", "seconds", ".0f"),
    Column("MB", "memory_MB", ".0f"), Column("error %", "error", "+.2%"),
    Column("times", lambda row: f"**{row.earlier_seconds / row.seconds:.1f}**"),
))
WEAR_COST_TABLE = Table(
    WearCostRow,
    (
        Column("pair", "case", words=True), Column("dofs", "dofs", ","), Column("prepare s", "prepare", ".3g"),
        Column("sweep s", "sweep", ".3g"), Column(f"{BLOCKS} blocks s", "study", ".3g"),
        Column("whole", lambda row: f"**{row.whole:.2f}**"), Column("bare", "bare", ".2f"),
    ),
)
WEAR_TABLE = Table(
    WearPrecisionRow,
    (
        Column("blocks", "method", words=True), Column("tolerance", "tolerance", "g"), Column("made", "blocks"),
        Column("refused", "refused"), Column("s", "seconds", ".3g"), Column("error of the depths %", "error", ".2%"),
        Column("of the volume %", "volume_error", "+.2%"),
    ),
)
MOTION_TABLE = Table(
    MotionRow,
    (
        Column("what", "what", words=True), Column("s", "seconds", ".3g"), Column("over s", "below", ".3g"),
        Column("found", lambda row: f"**{row.found:.3g}**"), Column("bar", lambda row: f"at most {row.bar:g}"),
        Column("bar is", lambda row: verdict(row.met), words=True),
    ),
)
COSTS: tuple[PageSection[Any], ...] = (
    PageSection("Whole runs", "runs", RUN_TABLE, words=_runs_said),
    PageSection("", "beside", RATIO_TABLE),
    PageSection("", "earlier", EARLIER_TABLE, words=_earlier_said),
    PageSection(
        "", "earlier_pitches", EARLIER_PITCH_TABLE, figure=figures.earlier_pitches, words=_earlier_pitches_said,
        caption="A pitch before and now",
    ),
    PageSection(
        "A position and a pitch, against the error", "pitches", PITCH_TABLE, figure=figures.pitches, caption="A pitch",
        words=lambda _: [PITCHES],
    ),
    PageSection("A pitch", "ratios", RATIO_TABLE),
    PageSection("Size", "sizes", SIZE_TABLE, figure=figures.sizes, caption="Cost over size", after=_power_laws),
    PageSection(
        "", "level_sizes", SIZE_TABLE, figure=figures.level_sizes, caption="Cost over size, with levels",
        words=_levels_said, after=_power_laws,
    ),
    PageSection("Where the time goes", "profile", PROFILE_TABLE, words=_profile_said),
    PageSection("", "profile_levels", PROFILE_TABLE, words=_levels_profile_said),
    PageSection("What a scene does not need", "skips", SKIP_TABLE, words=_skips_said),
    PageSection("A spur pair in 2D and in 3D", "spur", SPUR_TABLE, words=_spur_said),
)
WEAR: tuple[PageSection[Any], ...] = (
    PageSection("Wear", "wear_cost", WEAR_COST_TABLE, words=_wear_said),
    PageSection("", "wear", WEAR_TABLE, figure=figures.wear, caption="Run time against error of wear"),
)
MOTION: tuple[PageSection[Any], ...] = (
    PageSection(
        "Excitation and vibration", "dynamics", MOTION_TABLE,
        words=lambda _: ["CPU seconds without the start of Python, without error bars."],
    ),
    PageSection("Transient contact", "transient", MOTION_TABLE, words=lambda _: [TRANSIENT]),
)
