"""Whether two installations of Evolvent find the same numbers, say one with dolfinx 0.5 and one with dolfinx 0.9.

    python -m tests.agreement compute A             # with the one installation: small problems, solved into A
    python -m tests.agreement compute B             # with the other one
    python -m tests.agreement compare A B           # status 1 where a result differs by more than 1e-6
    python -m tests.agreement compare A B --tolerance 1e-12

`compare` also takes two folders of `evolvent run`. A figure of summary.json (torque, transmission error, pressure,
tooth force, contact length, ...) is compared with itself, an array of a NumPy archive (tractions, weights, flank
displacements, meshes, ...) with its own largest entry, and whatever is no floating-point number has to be equal. Left
out is what is no result: the clock, versions, and what rounding leaves over (residuals, iterations).
"""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from demos.hertz_cylinder import Slip, cylinder_on_block
from demos.hertz_sphere import ball_on_block
from demos.two_blocks import variants
from evolvent import Solution, solve
from evolvent.fem.backend import dolfinx_compat
from evolvent.results.archive.store import ArchiveError, arrays_bytes, read_arrays
from evolvent.run.kinds.run import Run
from evolvent_meshes.files import write_bytes
from tests.support.computing.quiet import quietly
from tests.support.gear_cases import helical_scene, spur_scene

TOLERANCE = 1e-6
NO_RESULTS = {
    "scene", "versions", "skipped", "ranks", "timings_s", "peak_memory_MB", "seconds", "iterations",
    "newton_iterations", "residual", "balance_error",
    "forces_on_pinion", "forces_on_wheel",  # small differences of nodal forces, which are compared themselves
}


@dataclass(frozen=True)
class Difference:
    """The largest difference of a quantity, relative (inf: other shape, other kind, not equal), and where it is."""

    size: float
    quantity: str
    where: str


def solve_all(out: Path) -> None:
    """Solves a spur and a helical pair with friction, patch tests of all cells, a cylinder and a ball on a block."""
    dolfinx_compat.silence_logs()
    quietly(Run.of(spur_scene("contact.friction=[0.0, 0.3]")), out / "spur")
    quietly(Run.of(helical_scene("mesh.order=2")), out / "helical")
    for patch in variants(quick=False):
        name = f"{patch.shape}_{patch.order}_on_{patch.first}_friction_{patch.friction:g}"
        keep(out / "blocks" / f"{name}.npz", solve(patch.problem()))
    keep(out / "hertz" / "cylinder.npz", solve(cylinder_on_block(4, ratio=1.37, friction=0.2)))
    # not in rings: where edges of both bodies coincide, rounding decides how facets are cut, felt at 1e-5
    keep(out / "hertz" / "ball.npz", solve(ball_on_block(2, friction=0.2, rings=False)))
    for name, profile in zip(("pressed", "pushed"), Slip().profiles(4)):
        write_bytes(out / "hertz" / f"{name}.npz", arrays_bytes({"pressure": profile.pressure, "shear": profile.shear}))


def keep(path: Path, solution: Solution) -> None:
    """Writes the contact and the displacements of a solution.

    The points themselves are not kept: what a user reads are forces, tractions and displacements.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    contact = solution.contacts[0]
    arrays: dict[str, Any] = {"force": contact.force, "point_traction": contact.traction}
    for i in range(len(solution.condensed)):
        arrays |= {f"{i}/displacement": solution.displacement(i), f"{i}/nodal_forces": solution.nodal_forces[i]}
    write_bytes(path, arrays_bytes(arrays))


def results(folder: Path) -> dict[tuple[str, str], NDArray[Any]]:
    """(file, name) -> value of all results below a folder."""
    found: dict[tuple[str, str], NDArray[Any]] = {}
    for path in sorted(folder.rglob("*.npz")):
        found |= {(str(path.relative_to(folder)), name): value for name, value in read_arrays(path).items()}
    for path in sorted(folder.rglob("summary.json")):
        table = json.loads(path.read_text(encoding="utf-8"))
        found |= {(str(path.relative_to(folder)), name): np.asarray(value) for name, value in leaves(table)}
    return {(file, name): value for (file, name), value in found.items() if not NO_RESULTS & set(name.split("/"))}


def leaves(tree: Any, name: str = "") -> Iterator[tuple[str, Any]]:
    """Path and value of all that a JSON document holds; null, which stands for NaN, becomes it."""
    if isinstance(tree, (dict, list)):
        for key, value in tree.items() if isinstance(tree, dict) else enumerate(tree):
            yield from leaves(value, f"{name}/{key}" if name else str(key))
    else:
        yield name, float("nan") if tree is None else tree


def difference(one: NDArray[Any], other: NDArray[Any]) -> float:
    """Largest |one − other| over the largest entry of both; infinite where they cannot be compared."""
    if one.shape != other.shape or one.dtype.kind != other.dtype.kind:
        return np.inf
    if one.dtype.kind != "f":
        return 0.0 if np.array_equal(one, other) else np.inf
    if not np.array_equal(np.isfinite(one), np.isfinite(other)):
        return np.inf
    change, largest = np.nan_to_num(np.abs(one - other)), np.nan_to_num(np.maximum(np.abs(one), np.abs(other)))
    return float(change.max(initial=0.0) / largest.max(initial=0.0)) if change.any() else 0.0


def quantity(name: str) -> str:
    """A name without the numbers that say which position, friction coefficient, tooth or body it is of."""
    return "/".join(part for part in name.split("/") if not part.isdigit())


def differences(one: Path, other: Path) -> list[Difference]:
    """The largest difference of every quantity, in descending order. Raises ValueError, ArchiveError."""
    left, right = results(one), results(other)
    for folder, values in ((one, left), (other, right)):
        if not values:
            raise ValueError(f"{folder}: wanted summary.json or NumPy archives below it, found none; compute it first")
    worst: dict[str, Difference] = {}
    for key in sorted(left.keys() | right.keys()):
        size = difference(left[key], right[key]) if key in left and key in right else np.inf
        found = Difference(size, quantity(key[1]), " ".join(key))
        worst[found.quantity] = max(worst.get(found.quantity, found), found, key=lambda d: d.size)
    return sorted(worst.values(), key=lambda d: -d.size)


def compare(one: Path, other: Path, tolerance: float) -> int:
    """Prints the largest difference of every quantity; the exit status."""
    found = differences(one, other)
    for d in found:
        if d.size > 0.0:
            print(f"{d.size:9.1e}  {d.quantity:<45}  {d.where}")
    print(f"{sum(d.size == 0.0 for d in found)} further quantities are equal to the last bit")
    wrong = [d for d in found if not d.size <= tolerance]
    if not wrong:
        print(f"{one} and {other} agree: the largest relative difference is {found[0].size:.1e}")
        return 0
    print(
        f"{one} and {other} disagree: wanted relative differences of at most {tolerance:g}, found more in "
        f"{', '.join(d.quantity for d in wrong)} (inf: missing, of another shape, or not equal)",
        file=sys.stderr,
    )
    return 1


def main(arguments: list[str]) -> int:
    """The command line; returns the exit status."""
    parser = argparse.ArgumentParser(description="Whether two installations find the same numbers.")
    commands = parser.add_subparsers(dest="command", required=True)
    commands.add_parser("compute", help="solve small problems").add_argument("out", type=Path)
    both = commands.add_parser("compare", help="compare two folders")
    both.add_argument("one", type=Path)
    both.add_argument("other", type=Path)
    both.add_argument("--tolerance", type=float, default=TOLERANCE, help="largest relative difference let pass")
    given = parser.parse_args(arguments)
    if given.command == "compute":
        solve_all(given.out)
        return 0
    try:
        return compare(given.one, given.other, given.tolerance)
    except (ValueError, ArchiveError) as error:
        parser.error(str(error))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
