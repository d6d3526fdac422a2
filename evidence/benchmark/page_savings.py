"""What is left out and what it saves, and whether error bars hold: parts of the benchmark's page."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from evidence.benchmark import bars, skips, spur
from evidence.report import table

SPUR_BAR = 20.0


def skip_section(rows: Sequence[skips.SkipRow]) -> list[str]:
    """Time and memory with and without every skip."""
    if not rows:
        return []
    head = ("skip", "scene", "s", "without s", "times", "MB", "without MB", "times", "difference", "tolerance")
    lines = [
        [
            r.skip, r.scene.removeprefix("demos/"), f"{r.seconds:.3g}", f"{r.long_seconds:.3g}",
            f"**{r.long_seconds / r.seconds:.2f}**", f"{r.memory_MB:.0f}", f"{r.long_memory_MB:.0f}",
            f"{r.long_memory_MB / r.memory_MB:.2f}", f"{r.difference:.1e}", f"{r.tolerance:.0e}",
        ]
        for r in rows
    ]  # fmt: skip
    beyond = [r.skip for r in rows if not r.difference <= r.tolerance]
    said = f"Beyond their tolerance: {', '.join(beyond)}." if beyond else "All differences are within the tolerances."
    words = "Whole runs at level quick (wall time, pictures and error bars off), with a skip and with `--no-skip`. "
    return ["## What a scene does not need", words + said, table(head, lines, right=range(2, 10))]


def spur_section(rows: Sequence[spur.SpurRow]) -> list[str]:
    """2D against 3D."""
    if not rows:
        return []
    head = ("2D elements", "body", "s", "MB", "error %", "3D elements", "layers", "s", "MB", "error %", "3D over 2D")
    lines = [
        [
            f"{r.elements:g}", "finer" if r.fine_body else "as is", f"{r.seconds:.3g}", f"{r.memory_MB:.0f}",
            f"{100 * r.error:.2f}", f"{r.volume_elements:g}", str(r.layers), f"{r.volume_seconds:.3g}",
            f"{r.volume_memory_MB:.0f}", f"{100 * r.volume_error:.2f}", f"**{r.volume_seconds / r.seconds:.1f}**",
        ]
        for r in rows
    ]  # fmt: skip
    least = min(r.volume_seconds / r.seconds for r in rows)
    verdict = "met" if least >= SPUR_BAR else f"MISSED, {least:.1f} at the least"
    words = (
        "He's spur pair, 20 positions without friction, in 2D and on the smallest 3D mesh whose error in the "
        f"transmission error is no larger; CPU seconds. Wanted: at least {SPUR_BAR:g} times: {verdict}."
    )
    return ["## A spur pair in 2D and in 3D", words, table(head, lines, right=range(11))]


def bars_section(rows: Sequence[bars.BarRow]) -> list[str]:
    """How often the error bars hold."""
    if not rows:
        return []
    words = (
        "He's pair and a narrow helical pair at several meshes of both orders and shapes, against meshes several times "
        "finer: the error bar "
        f"holds the true error of **{sum(r.inside for r in rows)} of {len(rows)}** figures. Wanted: 90 %. "
        "Pressures are those between the tip-edge zones of the mesh that is judged. "
        "*Decided*: where the reference is good enough to tell."
    )
    return ["## Error bars", words, _hits(rows)]


def spacing_section(rows: Sequence[bars.BarRow]) -> list[str]:
    """How often their part holds that comes from the spacing of positions."""
    if not rows:
        return []
    cases = [*dict.fromkeys(r.case for r in rows)]
    words = (
        "The part of the error bars that comes from the spacing of positions (`spacing_error` in summary.json), of "
        f"{len({case.rsplit(', ', 1)[0] for case in cases})} pairs at {_counts(cases)} positions a pitch against many "
        f"more on the same mesh, with and without friction: it holds the true error of "
        f"**{sum(r.inside for r in rows)} of {len(rows)}** figures and is {_times(rows):.1f} times as large in the "
        "median. Wanted: 90 %, and below 5 times. *Decided*: where the bar of the many positions is small enough "
        "to tell."
    )
    return ["## The spacing of positions", words, _hits(rows)]


def _counts(cases: Sequence[str]) -> str:
    counts = sorted({int(case.split()[-2]) for case in cases})
    return ", ".join(map(str, counts[:-1])) + f" and {counts[-1]}"


def _times(rows: Sequence[bars.BarRow]) -> float:
    """The median of bar over true error, where there is one."""
    return float(np.median([r.bar / r.error for r in rows if r.error > 0.0]))


def _hits(rows: Sequence[bars.BarRow]) -> str:
    """A line a figure."""
    lines = []
    for figure in dict.fromkeys(r.figure for r in rows):
        own = [r for r in rows if r.figure == figure]
        lines.append([figure, str(len(own)), str(sum(r.inside for r in own)), f"{100 * bars.hit_rate(own):.0f}",
                      f"{_times(own):.1f}", str(sum(r.inside for r in own if r.decided)),
                      str(sum(r.decided for r in own))])  # fmt: skip
    head = ("figure", "cases", "inside", "%", "times the error, median", "inside, decided", "decided")
    return table(head, lines, right=range(1, 7))
