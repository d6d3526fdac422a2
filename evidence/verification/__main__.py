"""`python -m evidence.verification [NAME ...] [--out docs]`: solves the verification problems.

Without names: all of them, into OUT/verification.md with their figures. With names (hertz_line, torque, ...): only
these problems, whose claims are printed and whose figures are written.
"""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from evidence.claims import Verification
from evidence.verification.page import PICTURES, draw, write_page
from evidence.verification.problems import PROBLEMS
from evolvent.fem.backend import dolfinx_compat


def main(names: Annotated[list[str] | None, typer.Argument()] = None, out: Path = Path("docs")) -> None:
    """Exits with 1 where a claim is not as expected, with 2 for the name of no problem."""
    dolfinx_compat.silence_logs()
    if unknown := set(names or ()) - set(PROBLEMS):
        typer.echo(f"wanted names of problems ({', '.join(PROBLEMS)}), found {', '.join(sorted(unknown))}", err=True)
        raise typer.Exit(2)
    problems = [PROBLEMS[name]() for name in names or PROBLEMS]
    where = str(_shown(problems, out) if names else write_page(problems, out))
    claims = [claim for problem in problems for claim in problem.claims]
    wrong = [str(claim) for claim in claims if not claim.as_expected]
    typer.echo(f"{where}: {len(claims)} claims, {len(wrong)} not as expected")
    if wrong:
        typer.echo("\n".join(wrong), err=True)
        raise typer.Exit(1)


def _shown(problems: list[Verification], out: Path) -> Path:
    """Prints the claims, writes the figures. Gives their folder back."""
    for problem in problems:
        typer.echo("\n".join((problem.title, *(f"  {claim}" for claim in problem.claims))))
        draw(problem, out / PICTURES / f"{problem.name}.png")
    return out / PICTURES


if __name__ == "__main__":
    typer.run(main)
