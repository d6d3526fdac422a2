"""docs/verification.md: every verification problem with its claims and its figure."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Sequence
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
    sections = map(_section, problems)
    return write(out / "verification.md", [head, INTRODUCTION, _summary(problems), *sections])


def draw(problem: Verification, path: Path) -> None:
    """Writes a problem's figure. Raises OSError."""
    with styled():
        figure = sheet(problem.title, problem.caption)
        problem.draw(figure)
        picture(figure, path)


def _summary(problems: Sequence[Verification]) -> str:
    """A row a problem, with a link to it, and the sums."""
    rows = [[f"[{each.title}](#{_anchor(each.title)})", *_counts(each.claims)] for each in problems]
    rows.append(["all", *_counts([claim for each in problems for claim in each.claims])])
    kinds = [kind.value for kind in Reference]
    return markdown(("problem", "claims", "hold", "missed", *kinds), rows, right=range(1, 4 + len(kinds)))


def _counts(claims: Sequence[Claim]) -> list[str]:
    holding = sum(claim.holds for claim in claims)
    kinds = [sum(claim.reference is kind for claim in claims) for kind in Reference]
    return [str(number) for number in (len(claims), holding, len(claims) - holding, *kinds)]


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
    ))  # fmt: skip


def _filled(paragraphs: Iterable[str]) -> list[str]:
    return [textwrap.fill(" ".join(paragraph.split()), 120) for paragraph in paragraphs]
