"""The generated parts of README.md, from the tables of the benchmarks and of verification."""

from __future__ import annotations

from pathlib import Path

from evidence.benchmarks.gears.whole_runs import RunRow
from evidence.pages.promises import Measured, claim_of, measured
from evidence.tables import Column, Table, markdown

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
)
"""What README.md calls a claim, the title of its problem, and what docs/verification.md calls it."""


SPEED = Table(
    RunRow,
    (
        Column("run, 20 positions", lambda row: row.case.replace(", 20 positions", ""), words=True),
        Column("level", "level", words=True),
        Column("friction coefficients", "frictions"), Column("gears ready after", lambda row: f"{row.prepare:.0f} s"),
        Column("whole run", lambda row: f"{row.seconds:.0f} s"),
        Column("memory", lambda row: f"{row.memory_MB / 1000:.1f} GB"),
    ),
)


def speed(docs: Path) -> str:
    """What runs from the command line cost."""
    return SPEED.markdown(row for row in SPEED.read(docs / "benchmark" / "runs.csv") if not row.note)


def verification(docs: Path) -> str:
    """A choice of the claims of verification, and how many there are."""
    claims = measured(docs / "verification.md")
    lines = [(what, *_errors(claim_of(claims, problem, quantity))) for what, problem, quantity in SHOWN]
    lost = [claim for claim in claims if not claim.held]
    words = f"{len(claims) - len(lost)} of {len(claims)} claims hold, {len(lost)} are missed and say why."
    return markdown(("problem", "error", "allowed", ""), lines, right=(1, 2)) + "\n\n" + words


def _errors(claim: Measured) -> tuple[str, str, str]:
    """Error and allowed error, relative where something but zero is wanted."""
    allowed = claim.allowed / abs(claim.wanted) if claim.wanted else claim.allowed
    error = f"{claim.off:.2g}" if claim.off else "below 1e-6"  # the page has six digits
    return error, f"{allowed:.2g}", "holds" if claim.held else "**missed**"
