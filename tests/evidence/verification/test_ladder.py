"""The verification ladder: every rung prints the error that it measured and its tolerance, and keeps to it.

    pytest test_ladder.py -s        # or -rP: the printed lines of tests that passed

Each rung's problem and exact solution stand in its `problem`; docs/verification.md is the same as a page.
"""

from __future__ import annotations

from functools import cache

import pytest

from evidence.claims import Claim, Reference, Rung
from evidence.ladder.__main__ import write_page
from evidence.ladder.rungs import RUNGS
from evolvent.results.drawing.style import sheet

NAMES = [measure.__module__.rsplit(".", 1)[-1] for measure in RUNGS]


@cache
def rung(index: int) -> Rung:
    """Measured once for all tests."""
    return RUNGS[index]()


@pytest.mark.parametrize("index", range(len(RUNGS)), ids=NAMES)
def test_rung(index):
    """Every claim holds; one that is known to be missed still fails, so that an improvement is noticed. Its figure can
    be drawn."""
    measured = rung(index)
    measured.draw(sheet(measured.title, measured.see))
    print(f"\n{measured.title}")
    for claim in measured.claims:
        print(f"  {claim}")
    wrong = [str(claim) for claim in measured.claims if not claim.as_expected]
    assert not wrong, "\n".join(wrong)


def test_mostly_not_regression():
    """At least half of all claims are held against something that was not computed here before."""
    claims = [claim for index in range(len(RUNGS)) for claim in rung(index).claims]
    regression = sum(claim.reference is Reference.REGRESSION for claim in claims)
    print(f"{len(claims)} claims, {regression} of them only regression")
    assert 2 * regression <= len(claims)


def test_names_are_unique():
    """Two rungs of one name would write the same picture."""
    names = [rung(index).name for index in range(len(RUNGS))]
    assert len(set(names)) == len(names)


def test_page(tmp_path):
    """A rung with a claim that holds and one that is known to be missed: both stand on the page, with the reason, the
    summary counts them, and the picture is written."""
    claims = (
        Claim("p0 [MPa]", 99.0, 100.0, 2.0, Reference.ANALYTICAL, "Hertz"),
        Claim("δ [mm]", 0.9, 1.0, 0.01, Reference.EXTERNAL, "NAFEMS", "Small strain."),
    )
    shown = Rung("two_balls", "Two balls: pressed", "They touch.", claims, lambda figure: figure.subplots(), "A circle")
    text = write_page([shown], tmp_path).read_text(encoding="utf-8")
    assert "| [Two balls: pressed](#two-balls-pressed) | 2 | 1 | 1 | 1 | 1 | 0 | 0 |" in text
    assert "| p0 [MPa] | 99 | 100 | 2 | 1 | holds | analytical: Hertz |" in text
    assert "| **missed** | external: NAFEMS |" in text
    assert "Missed: Small strain." in text
    assert 1_000 < (tmp_path / "pictures" / "verification" / "two_balls.png").stat().st_size < 150_000
