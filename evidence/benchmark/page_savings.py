"""What is left out and what it saves, and whether error bars hold: parts of the benchmark's page, and their rows."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from evidence.benchmark import bars, skips, spur
from evidence.report import table

SPUR_BAR = 20.0


@dataclass(frozen=True)
class SkipLine:
    """A scene with a skip and without: wall seconds, memory [MB], largest relative difference of the answers."""

    skip: str
    scene: str
    settings: str
    seconds: float
    long_seconds: float
    memory_MB: float
    long_memory_MB: float
    difference: float
    tolerance: float


@dataclass(frozen=True)
class SpurLine:
    """A 2D mesh and the cheapest 3D mesh that is as right: CPU seconds, memory, error of the transmission error."""

    elements: float
    fine_body: int
    seconds: float
    memory_MB: float
    error: float
    volume_elements: float
    layers: int
    volume_seconds: float
    volume_memory_MB: float
    volume_error: float


def skip_lines(cases: Sequence[skips.Case] = skips.CASES) -> Iterator[SkipLine]:
    """One a skip. Raises CalledProcessError."""
    for row in skips.rows(cases):
        yield SkipLine(
            row.case.skip, row.case.scene, " ".join(row.case.settings), row.short.seconds, row.long.seconds,
            row.short.memory_MB, row.long.memory_MB, row.differences.largest, row.tolerance,
        )  # fmt: skip


def spur_lines() -> Iterator[SpurLine]:
    """One a 2D mesh; not a number where no 3D mesh of the list is as right."""
    nan = float("nan")
    for row in spur.rows():
        plane, own = row.plane, row.plane_solved
        head = (plane.elements, int(plane.fine_body), own.seconds, own.memory_MB, row.plane_error)
        if row.volume is None or row.volume_solved is None:
            yield SpurLine(*head, nan, 0, nan, nan, nan)
        else:
            other = row.volume_solved
            yield SpurLine(
                *head, row.volume.elements, row.volume.layers, other.seconds, other.memory_MB, row.volume_error
            )


def skip_section(rows: Sequence[SkipLine]) -> list[str]:
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


def spur_section(rows: Sequence[SpurLine]) -> list[str]:
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
    words = (
        "He's spur pair, 20 positions without friction, in 2D and on the smallest 3D mesh whose error in the "
        f"transmission error is no larger; CPU seconds. Wanted: at least {SPUR_BAR:g} times."
    )
    return ["## A spur pair in 2D and in 3D", words, table(head, lines, right=range(11))]


def bars_section(rows: Sequence[bars.BarRow]) -> list[str]:
    """How often the error bars hold."""
    if not rows:
        return []
    figures = [*dict.fromkeys(r.figure for r in rows)]
    lines = []
    for figure in figures:
        own = [r for r in rows if r.figure == figure]
        lines.append([figure, str(len(own)), str(sum(r.inside for r in own)), f"{100 * bars.hit_rate(own):.0f}",
                      str(sum(r.inside for r in own if r.decided)), str(sum(r.decided for r in own))])  # fmt: skip
    words = (
        f"He's pair at several meshes of both orders and shapes, against a mesh several times finer: the error bar "
        f"holds the true error in **{100 * bars.hit_rate(rows):.0f} %** of {len(rows)} figures. Wanted: 90 %. "
        "*Decided*: where the reference is good enough to tell."
    )
    head = ("figure", "cases", "inside", "%", "inside, decided", "decided")
    return ["## Error bars", words, table(head, lines, right=range(1, 6))]
