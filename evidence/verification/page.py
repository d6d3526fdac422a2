"""docs/verification.md: every verification problem with its claims and its figure."""

from __future__ import annotations

import re
import textwrap
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path

from evidence.claims import Claim, Reference, Verification
from evidence.report import header, picture, write
from evidence.tables import Column, Table, markdown
from evolvent.results.drawing.style import sheet, styled

PICTURES = "pictures/verification"
INTRODUCTION = """
Problems with a known answer, from the simplest to the hardest. Every figure states what it is held against: an
**analytical** answer, an **external** one (published by others), an **overkill** solution of the same problem on a much
finer mesh, or **regression** only (nothing but an earlier result). The tolerance is what the method should reach. A bar
that is **missed** says why, and its test fails on the day it is met.
`tests/evidence/verification/test_problems.py` asserts all of it.
"""
CLAIMS = Table(
    Claim,
    (
        Column("quantity", "quantity", words=True),
        Column("found", "found", ".6g"),
        Column("wanted", lambda claim: f"{'at least ' if claim.one_sided else ''}{claim.wanted:.6g}"),
        Column("tolerance", "tolerance", ".2g"),
        Column("error", "error", ".2g"),
        Column("", lambda claim: claim.verdict if claim.verdict == "holds" else f"**{claim.verdict}**", words=True),
        Column("held against", lambda claim: f"{claim.reference.value}: {claim.source}", words=True),
    ),
)


def write_page(problems: Sequence[Verification], out: Path) -> Path:
    """out/verification.md, and a figure a problem in out/pictures/verification. Gives the page's path."""
    for problem in problems:
        draw(problem, out / PICTURES / f"{problem.name}.png")
    head = header("Verification", "make verification")
    parts = [Part.of(problem) for problem in problems]
    return write(out / "verification.md", [head, INTRODUCTION, _summary(parts), *(part.section for part in parts)])


def write_parts(problems: Sequence[Verification], out: Path, order: Sequence[str]) -> Path:
    """Some problems' parts and figures of out/verification.md anew; the others stay as they are. Gives the page's path.

    order: names of all problems in the order of the page. Raises OSError.
    """
    for problem in problems:
        draw(problem, out / PICTURES / f"{problem.name}.png")
    path = out / "verification.md"
    head, *sections = re.split(r"^(?=## )", path.read_text(encoding="utf-8"), flags=re.MULTILINE)
    rows = [line.strip("| ").split(" | ") for line in head.splitlines() if line.startswith("| [")]
    kept = [Part.read(section, row) for section, row in zip(sections, rows, strict=True)]
    named = {part.name: part for part in (*kept, *map(Part.of, problems))}
    parts = [named[name] for name in order if name in named]
    return write(path, [head[: head.index("| problem ")], _summary(parts), *(part.section for part in parts)])


@dataclass(frozen=True)
class Part:
    """A problem on the page."""

    name: str
    title: str
    counts: tuple[int, ...]
    """Numbers of claims, of those that hold, of misses, and of each kind of reference."""
    section: str
    """Its heading, text, claims and figure."""

    @staticmethod
    def of(problem: Verification) -> Part:
        return Part(problem.name, problem.title, _counts(problem.claims), _section(problem))

    @staticmethod
    def read(section: str, row: Sequence[str]) -> Part:
        """Of a page that was written before. row: of its summary."""
        name = re.findall(rf"\({PICTURES}/(\w+)\.png\)", section)[-1]
        title = section.splitlines()[0].removeprefix("## ")
        return Part(name, title, tuple(int(cell) for cell in row[1:]), section)


def draw(problem: Verification, path: Path) -> None:
    """Writes a problem's figure. Raises OSError."""
    with styled():
        figure = sheet(problem.title, problem.caption)
        problem.draw(figure)
        picture(figure, path)


def _summary(parts: Sequence[Part]) -> str:
    """A row a problem, with a link to it, and the sums."""
    rows = [[f"[{part.title}](#{_anchor(part.title)})", *map(str, part.counts)] for part in parts]
    rows.append(["all", *(str(sum(column)) for column in zip(*(part.counts for part in parts)))])
    kinds = [kind.value for kind in Reference]
    return markdown(("problem", "claims", "hold", "missed", *kinds), rows, right=range(1, 4 + len(kinds)))


def _counts(claims: Sequence[Claim]) -> tuple[int, ...]:
    holding = sum(claim.holds for claim in claims)
    kinds = [sum(claim.reference is kind for claim in claims) for kind in Reference]
    return (len(claims), holding, len(claims) - holding, *kinds)


def _anchor(title: str) -> str:
    """As GitHub makes it of a heading."""
    return "".join(c for c in title.lower() if c.isalnum() or c in " -_").replace(" ", "-")


def _section(problem: Verification) -> str:
    reasons = dict.fromkeys(claim.missed for claim in problem.claims if claim.missed)
    return "\n\n".join((
        f"## {problem.title}",
        *_filled([problem.statement]),
        CLAIMS.markdown(problem.claims),
        *_filled(f"Missed: {reason}" for reason in reasons),
        f"![{problem.title}]({PICTURES}/{problem.name}.png)",
    ))


def _filled(paragraphs: Iterable[str]) -> list[str]:
    return [textwrap.fill(" ".join(paragraph.split()), 120) for paragraph in paragraphs]
