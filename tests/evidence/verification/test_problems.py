"""Every verification problem prints its errors and their tolerances, and keeps to them.

    pytest tests/evidence/verification/test_problems.py -s        # or -rP: the printed lines of tests that passed

Problem and exact solution stand in its `statement`; docs/verification.md is the same as a page.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pytest
import typer

from evidence.claims import Claim, Reference, Verification
from evidence.verification.__main__ import main
from evidence.verification.page import write_page, write_parts
from evidence.verification.problems import PROBLEMS
from evidence.verification.transient import thousand_impacts
from evolvent.results.drawing.style import sheet
from tests.support.running.samples import sampled

QUICK = "patch", "partial_slip", "sharing", "bar_on_wall"
"""One problem of each kind: contact, friction, gears, motion."""


@cache
def solved(name: str) -> Verification:
    """Solved once for all tests; a thousand impacts take minutes, twenty show the same."""
    return thousand_impacts.verify(impacts=20, short=20, phases=4) if name == "thousand_impacts" else PROBLEMS[name]()


@pytest.mark.slow
@pytest.mark.parametrize("name", sampled(sorted(PROBLEMS, key=lambda name: name not in QUICK), len(QUICK)))
def test_claims_of_the_problem_hold(name: str) -> None:
    """Every claim holds; one that is known to be missed still fails, so that it is noticed when it holds. The figure
    can be drawn."""
    problem = solved(name)
    problem.draw(sheet(problem.title, problem.caption))
    print(f"\n{problem.title}")
    for claim in problem.claims:
        print(f"  {claim}")
    wrong = [str(claim) for claim in problem.claims if not claim.as_expected]
    assert not wrong, "\n".join(wrong)


@pytest.mark.evidence
@pytest.mark.slow
def test_at_most_half_of_the_claims_are_regressions() -> None:
    """At least half of all claims are held against something that was not computed here before."""
    claims = [claim for name in PROBLEMS for claim in solved(name).claims]
    regression = sum(claim.reference is Reference.REGRESSION for claim in claims)
    print(f"{len(claims)} claims, {regression} of them only regression")
    assert 2 * regression <= len(claims)


@pytest.mark.evidence
@pytest.mark.slow
def test_problems_have_names_of_their_own() -> None:
    """The name of a problem is that of its module and of its figure."""
    assert [solved(name).name for name in PROBLEMS] == list(PROBLEMS)


def test_help_and_wrong_names_name_the_problems(capsys: pytest.CaptureFixture[str]) -> None:
    """--help lists every problem and says whose folder docs is; a misspelled name is answered with the near one."""
    app = typer.Typer()
    app.command()(main)
    assert app(["--help"], standalone_mode=False) == 0
    text = " ".join(capsys.readouterr().out.replace("│", " ").split())
    assert all(name in text for name in PROBLEMS) and "committed pages" in text
    assert app(["herz_line"], standalone_mode=False) == 2
    assert "did you mean hertz_line?" in capsys.readouterr().err


def test_page_has_claims_misses_and_figure(tmp_path: Path) -> None:
    """A problem with a claim that holds and one that is known to be missed: both are on the page, with the reason, the
    summary counts them, and the picture is written."""
    claims = (
        Claim("p0 [MPa]", 99.0, 100.0, 2.0, Reference.ANALYTICAL, "Hertz"),
        Claim("δ [mm]", 0.9, 1.0, 0.01, Reference.EXTERNAL, "NAFEMS", "Small strain."),
    )
    shown = Verification(
        "two_balls", "Two balls: pressed", "They touch.", claims, lambda figure: figure.subplots(), "A circle"
    )
    text = write_page([shown], tmp_path).read_text(encoding="utf-8")
    assert "| [Two balls: pressed](#two-balls-pressed) | 2 | 1 | 1 | 1 | 1 | 0 | 0 |" in text
    assert "| p0 [MPa] | 99 | 100 | 2 | 1 | holds | analytical: Hertz |" in text
    assert "| **missed** | external: NAFEMS |" in text
    assert "Missed: Small strain." in text
    assert 1_000 < (tmp_path / "pictures" / "verification" / "two_balls.png").stat().st_size < 150_000


def test_parts_of_the_page_are_written_alone(tmp_path: Path) -> None:
    """Of a page with two problems the second is solved again and a third is new: the page is what all three write at
    once, in the order of the problems; the part of the first is not touched."""

    def problem(name: str, found: float) -> Verification:
        claim = Claim("p0 [MPa]", found, 100.0, 2.0, Reference.ANALYTICAL, "Hertz")
        return Verification(name, f"{name}: pressed", "They touch.", (claim,), lambda figure: figure.subplots())

    names, parts, whole = ["a", "b", "c"], tmp_path / "parts", tmp_path / "whole"
    write_page([problem("a", 99.0), problem("c", 90.0)], parts)
    page = write_parts([problem("c", 101.0), problem("b", 80.0)], parts, names)
    wanted = write_page([problem("a", 99.0), problem("b", 80.0), problem("c", 101.0)], whole)
    assert page.read_text(encoding="utf-8") == wanted.read_text(encoding="utf-8")
