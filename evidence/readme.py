"""The generated parts of README.md and of the tutorial: from the tables of the benchmark and the ladder, and from what
`evolvent check` prints."""

from __future__ import annotations

from pathlib import Path

from evidence.benchmark.scaling import RatioRow, SizeRow
from evidence.benchmark.tables import read_rows
from evidence.promises import Measured, measured
from evidence.report import table
from solver.overview import overview
from solver.scene import load_scene

SHOWN = (
    ("patch test, non-matching, hexahedra of order 2", "largest error of the traction / p, hexahedra of order 2"),
    ("roller on block (Hertz), b/h = 8: peak pressure", "peak pressure p0 [MPa]"),
    ("the same: profile of the pressure (L2)", "pressure, relative error in L2"),
    ("NAFEMS' cylinder on block: peak pressure", "peak pressure p0, no friction, normals of the block [MPa]"),
    ("the same: displacement under the load", "displacement under the load, μ = 0, normals of the block [mm]"),
    ("partial slip of a line contact (Cattaneo), Q = 0.5 μP: traction (L2)", "traction, relative L2 error, Q = 0.5 μP"),
    ("tractive rolling (Carter): creep", "creep"),
    ("spur pair: torque ratio, away from tip edges", "spur, away from tip edges"),
    ("spur pair: torque ratio, at a tip edge", "spur, at tip edges"),
    ("helical pair: torque ratio, mean of the pitch, normals before deflection", "helical, mean of the pitch"),
    ("the same, on deflected flanks", "helical on deflected flanks, mean of the pitch"),
    ("spur pair: share of the load in double contact (Pedrero)", "share in double contact, rms off Pedrero's"),
)  # fmt: skip
"""What it is called here -> what the ladder's page calls it; of several with that name the first."""


def speed(docs: Path) -> str:
    """What a run of the helical pair costs."""
    ratios = {row.what: row for row in read_rows(docs / "benchmark" / "ratios.csv", RatioRow)}
    one, seven, ranks = (
        _named(ratios, start) for start in ("a pitch of 40", "seven friction coefficients over one, 0.11", "one rank")
    )
    runs = table(
        ("a pitch of the helical pair (Yang)", "dofs", "one rank", "two ranks"),
        [
            ("`quick`, 40 positions, one friction coefficient", f"{one.dofs:,}", f"{one.above:.0f} s", ""),
            ("`quick`, 40 positions, seven coefficients", f"{seven.dofs:,}", f"{seven.above:.0f} s", ""),
            ("`standard`, 20 positions, seven coefficients", f"{ranks.dofs:,}", f"{ranks.above:.0f} s",
             f"{ranks.below:.0f} s"),
        ],
        right=(1, 2, 3),
    )  # fmt: skip
    sizes = [row for row in read_rows(docs / "benchmark" / "sizes.csv", SizeRow) if not row.note]
    lines = [
        (f"{row.dofs:,}", f"{row.memory_MB / 1000:.1f} GB", f"{row.assemble + row.condense:.0f} s", f"{row.position:.2g} s")
        for row in sizes
    ]  # fmt: skip
    head = ("dofs of both sectors", "memory", "assemble and condense, once", "one more position")
    return f"{runs}\n\n{table(head, lines, right=range(4))}"


def verification(docs: Path) -> str:
    """A choice of the ladder's claims, and how many there are."""
    claims = measured(docs / "verification.md")
    lines = [(what, *_found(_claim(claims, quantity))) for what, quantity in SHOWN]
    lost = [claim for claim in claims if not claim.held]
    words = f"{len(claims) - len(lost)} of {len(claims)} claims hold, {len(lost)} are missed and say why."
    return table(("problem", "error", "allowed", ""), lines, right=(1, 2)) + "\n\n" + words


def check(scene: Path) -> str:
    """What `evolvent check SCENE --level quick` prints, as a block of a page."""
    text = overview(load_scene(scene, ["mesh.level=quick"]))
    return "```text\n" + "\n".join(line.rstrip() for line in text.strip().splitlines()) + "\n```"


def _named(rows: dict[str, RatioRow], start: str) -> RatioRow:
    return next(row for what, row in rows.items() if what.startswith(start))


def _claim(claims: list[Measured], quantity: str) -> Measured:
    """Raises ValueError where the ladder has no such claim."""
    for claim in claims:
        if claim.quantity == quantity:
            return claim
    raise ValueError(f"docs/verification.md: wanted a claim {quantity!r}, found none; what does README.md show instead?")


def _found(claim: Measured) -> tuple[str, str, str]:
    """Error and allowed error, relative where something but zero is wanted."""
    allowed = claim.allowed / abs(claim.wanted) if claim.wanted else claim.allowed
    return f"{claim.off:.1g}", f"{allowed:.1g}", "holds" if claim.held else "**missed**"
