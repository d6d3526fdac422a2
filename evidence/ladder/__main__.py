"""python -m evidence.ladder [--out docs]: measures all rungs, writes verification.md and its figures."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from pathlib import Path

import typer

from evidence.claims import Claim, Reference, Rung
from evidence.ladder.rungs import RUNGS
from evidence.report import header, picture, table, write
from evolvent.fem.backend import dolfinx_compat
from evolvent.results.drawing.style import sheet, styled

PICTURES = "pictures/verification"
INTRODUCTION = """
Problems with a known answer, from the simplest to the hardest. Every figure states what it is held against: an
**analytical** answer, an **external** one (published by others), an **overkill** solution of the same problem on a much
finer mesh, or **regression** only (nothing but an earlier result). The tolerance is what the method should reach. A bar
that is **missed** says why, and its test fails on the day it is met. `test_ladder.py` asserts all of it.
"""


def main(out: Path = Path("docs")) -> None:
    """Writes OUT/verification.md. Exits with 1 where a claim is not as expected."""
    dolfinx_compat.silence_logs()
    rungs = [measure() for measure in RUNGS]
    page = write_page(rungs, out)
    claims = [claim for rung in rungs for claim in rung.claims]
    wrong = [str(claim) for claim in claims if not claim.as_expected]
    typer.echo(f"{page}: {len(claims)} claims, {len(wrong)} not as expected")
    if wrong:
        typer.echo("\n".join(wrong), err=True)
        raise typer.Exit(1)


def write_page(rungs: Sequence[Rung], out: Path) -> Path:
    """out/verification.md and a picture per rung in out/pictures/verification. Gives the page's path."""
    with styled():
        for rung in rungs:
            _draw(rung, out / PICTURES / f"{rung.name}.png")
    head = header("Verification", "make verification")
    return write(out / "verification.md", [head, INTRODUCTION, _summary(rungs), *(_section(rung) for rung in rungs)])


def _draw(rung: Rung, path: Path) -> None:
    figure = sheet(rung.title, rung.see)
    rung.draw(figure)
    picture(figure, path)


def _summary(rungs: Sequence[Rung]) -> str:
    """A row per rung, with a link to it, and the sums."""
    rows = [[f"[{rung.title}](#{_anchor(rung.title)})", *_counts(rung.claims)] for rung in rungs]
    rows.append(["all", *_counts(tuple(claim for rung in rungs for claim in rung.claims))])
    kinds = [kind.value for kind in Reference]
    return table(("rung", "claims", "hold", "missed", *kinds), rows, right=range(1, 4 + len(kinds)))


def _counts(claims: tuple[Claim, ...]) -> list[str]:
    holding = sum(claim.holds for claim in claims)
    kinds = [sum(claim.reference is kind for claim in claims) for kind in Reference]
    return [str(number) for number in (len(claims), holding, len(claims) - holding, *kinds)]


def _anchor(title: str) -> str:
    """As GitHub makes it of a heading."""
    kept = "".join(c for c in title.lower() if c.isalnum() or c in " -_")
    return kept.replace(" ", "-")


def _section(rung: Rung) -> str:
    head = ("quantity", "found", "wanted", "tolerance", "error", "", "held against")
    rows = [_row(claim) for claim in rung.claims]
    missed = [f"Missed: {reason}" for reason in dict.fromkeys(claim.missed for claim in rung.claims) if reason]
    parts = (
        f"## {rung.title}",
        textwrap.fill(" ".join(rung.problem.split()), 120),
        table(head, rows, right=range(1, 5)),
        *(textwrap.fill(reason, 120) for reason in missed),
        f"![{rung.title}]({PICTURES}/{rung.name}.png)",
    )
    return "\n\n".join(parts)


def _row(claim: Claim) -> list[str]:
    wanted = f"{'at least ' if claim.one_sided else ''}{claim.wanted:.6g}"
    verdict = claim.verdict if claim.verdict == "holds" else f"**{claim.verdict}**"
    against = f"{claim.reference.value}: {claim.source}"
    return [
        claim.quantity,
        f"{claim.found:.6g}",
        wanted,
        f"{claim.tolerance:.2g}",
        f"{claim.error:.2g}",
        verdict,
        against,
    ]


if __name__ == "__main__":
    typer.run(main)
