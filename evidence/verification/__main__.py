"""`python -m evidence.verification [NAME ...] [--out DIR]`: solves the verification problems.

Without names: all of them, into DIR/verification.md with their figures. With names (hertz_line, torque, ...): only
these problems, whose claims are printed, and whose figures and parts of DIR/verification.md, where there is one, are
written anew. DIR is docs, the committed pages, by default.
"""

from __future__ import annotations

import difflib
from pathlib import Path
from typing import Annotated

import typer

from evidence.claims import Verification
from evidence.verification.page import PICTURES, draw, write_page, write_parts
from evidence.verification.problems import PROBLEMS
from evolvent.fem.backend import dolfinx_compat

Names = Annotated[
    list[str] | None,
    typer.Argument(
        metavar="NAME", help=f"Problems to solve, by default all: {', '.join(PROBLEMS)}.", show_default=False
    ),
]
Out = Annotated[
    Path,
    typer.Option(
        metavar="DIR",
        help="Where verification.md and the figures go. With names only their parts of a page that is there are "
        "written. The default is the folder of the committed pages: take another one, such as out/verification, to "
        "leave them alone.",
    ),
]


def main(names: Names = None, out: Out = Path("docs")) -> None:
    """Solve the verification problems and hold them against what is known.

    Exit status: 0 all claims as expected, 1 one is not, 2 the name of no problem.
    """
    dolfinx_compat.silence_logs()
    if unknown := [name for name in names or () if name not in PROBLEMS]:
        typer.echo(unknown_names(unknown), err=True)
        raise typer.Exit(2)
    problems = [PROBLEMS[name]() for name in names or PROBLEMS]
    where = str(_shown(problems, out) if names else write_page(problems, out))
    claims = [claim for problem in problems for claim in problem.claims]
    wrong = [str(claim) for claim in claims if not claim.as_expected]
    typer.echo(f"{where}: {len(claims)} claims, {len(wrong)} not as expected")
    if wrong:
        typer.echo("\n".join(wrong), err=True)
        raise typer.Exit(1)


def unknown_names(unknown: list[str]) -> str:
    """The message on names of no problem."""
    near = [match for name in unknown for match in difflib.get_close_matches(name, PROBLEMS, n=1)]
    meant = f"; did you mean {' '.join(near)}?" if near else ""
    return f"wanted names of problems ({', '.join(PROBLEMS)}), found {', '.join(unknown)}{meant}"


def _shown(problems: list[Verification], out: Path) -> Path:
    """Prints the claims, writes the parts of the page, or the figures alone. Gives back where they are."""
    for problem in problems:
        typer.echo("\n".join((problem.title, *(f"  {claim}" for claim in problem.claims))))
    if (out / "verification.md").exists():
        return write_parts(problems, out, list(PROBLEMS))
    for problem in problems:
        draw(problem, out / PICTURES / f"{problem.name}.png")
    return out / PICTURES


if __name__ == "__main__":
    typer.run(main)
