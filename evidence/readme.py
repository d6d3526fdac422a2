"""The generated parts of README.md, from the tables of the benchmark and of the ladder."""

from __future__ import annotations

from pathlib import Path

from evidence.benchmark.scaling import RatioRow, SizeRow
from evidence.benchmark.tables import read_rows
from evidence.promises import Measured, measured
from evidence.report import table

SHOWN = (
    ("non-matching meshes, uniform pressure (patch test)", "Patch test",
     "largest error of the traction / p, hexahedra of order 2"),
    ("roller on block (Hertz): peak pressure", "Hertz, line contact", "peak pressure p0 [MPa]"),
    ("the same: pressure over the contact (L2)", "Hertz, line contact", "pressure, relative error in L2"),
    ("ball on block (Hertz): peak pressure", "Hertz, point contact", "peak pressure p0 [MPa]"),
    ("the same: pressure over the contact (L2)", "Hertz, point contact", "pressure, relative error in L2"),
    ("NAFEMS' cylinder on block: peak pressure", "NAFEMS: cylinder on block",
     "peak pressure p0, no friction, normals of the block [MPa]"),
    ("the same: displacement under the load", "NAFEMS: cylinder on block",
     "displacement under the load, μ = 0, normals of the block [mm]"),
    ("partial slip (Cattaneo), Q = μP/2: traction (L2)", "Partial slip of a line contact (Cattaneo)",
     "traction, relative L2 error, Q = 0.5 μP"),
    ("tractive rolling (Carter): creep", "Tractive rolling of a line contact (Carter)", "creep"),
    ("spur pair: torque ratio away from tip edges", "Torque ratio of frictionless gears", "spur, away from tip edges"),
    ("the same, at a tip edge", "Torque ratio of frictionless gears", "spur, at tip edges"),
    ("helical pair: torque ratio, mean of the pitch", "Torque ratio of frictionless gears",
     "helical, mean of the pitch"),
    ("the same, on deflected flanks", "Torque ratio of frictionless gears",
     "helical on deflected flanks, mean of the pitch"),
    ("spur pair: load share in double contact, rms off Pedrero's", "Contact ratio and load sharing of a spur pair",
     "share in double contact, rms off Pedrero's"),
)  # fmt: skip
"""What it is called here, the rung, what the ladder's page calls it."""


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
        (f"{r.dofs:,}", f"{r.memory_MB / 1000:.1f} GB", f"{r.assemble + r.condense:.0f} s", f"{r.position:.2g} s")
        for r in sizes
    ]
    head = ("dofs of both sectors", "memory", "assemble and condense, once", "one more position")
    return f"{runs}\n\n{table(head, lines, right=range(4))}"


def verification(docs: Path) -> str:
    """A choice of the ladder's claims, and how many there are."""
    claims = measured(docs / "verification.md")
    lines = [(what, *_found(_claim(claims, rung, quantity))) for what, rung, quantity in SHOWN]
    lost = [claim for claim in claims if not claim.held]
    words = f"{len(claims) - len(lost)} of {len(claims)} claims hold, {len(lost)} are missed and say why."
    return table(("problem", "error", "allowed", ""), lines, right=(1, 2)) + "\n\n" + words


def _named(rows: dict[str, RatioRow], start: str) -> RatioRow:
    return next(row for what, row in rows.items() if what.startswith(start))


def _claim(claims: list[Measured], rung: str, quantity: str) -> Measured:
    """Raises ValueError where the ladder has no such claim."""
    for claim in claims:
        if (claim.section, claim.quantity) == (rung, quantity):
            return claim
    raise ValueError(f"docs/verification.md: wanted {quantity!r} under {rung!r}, found none; mend evidence/readme.py")


def _found(claim: Measured) -> tuple[str, str, str]:
    """Error and allowed error, relative where something but zero is wanted."""
    allowed = claim.allowed / abs(claim.wanted) if claim.wanted else claim.allowed
    found = f"{claim.off:.2g}" if claim.off else "below 1e-6"  # the page has six digits
    return found, f"{allowed:.2g}", "holds" if claim.held else "**missed**"
