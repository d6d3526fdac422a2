"""`python -m evidence.benchmarks.accuracy.face_load [--out docs]`: K_Hβ of a misaligned spur pair from finite elements,
beside Method C of ISO 6336-1:2006, clause 7, and what separates the two.

Writes OUT/benchmark/face_load.csv, from which `make pages` makes a table of docs/evidence.md. Minutes.
"""

from __future__ import annotations

import argparse
import math
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from mpi4py import MPI

from evidence.checkout import DOCS
from evidence.solved_run import solved_run
from evidence.tables import Column, Table, write_rows
from evolvent.gears.meshing.sector_meshes import gear_mesh
from evolvent.gears.problem.iso_stiffness import mesh_stiffness, single_stiffness
from evolvent.results.face_load import face_load
from evolvent.results.run_data import RunData
from evolvent.results.tables.figure_rows import friction_rows
from evolvent.run.kept_pitch import pitch_of
from evolvent.scene.scene import Scene, scene_from_text

SCENE = """
[pair]
normal_module_mm = 4.0
misalignment_um = 0.0

[pinion]
teeth = 25
face_width_mm = 30.0

[wheel]
teeth = 40
face_width_mm = 30.0

[load]
torque_Nm = 400.0

[mesh]
level = "quick"

[sweep]
positions = 8
"""
MISALIGNMENT, SMALL = 20.0, 2.0
"""[µm]: of the comparison; so small that the load is linear in it, for the stiffness against tilting."""
TILTING = 0.85
"""c_γβ/c_γα of the standard."""
FILE = Path("benchmark/face_load.csv")


@dataclass(frozen=True)
class Way:
    """A way to find K_Hβ."""

    name: str
    """In words."""
    stiffness: float
    """That it has for the tilted flanks [N/(mm µm)]; NaN for finite elements under the whole misalignment."""
    factor: float
    """K_Hβ."""


TABLE = Table(
    Way,
    (Column("way", "name", words=True), Column("stiffness against tilting [N/(mm µm)]", "stiffness", ".1f"),
     Column("K_Hβ", "factor", ".2f")),
)


def method_c(misalignment: float, stiffness: float, line_load: float) -> float:
    """K_Hβ of a load that is linear over the face: F_βy [µm] on springs c_γβ [N/(mm µm)] under the mean F_m/b [N/mm].

    Flanks are not run in (y_β = 0).
    """
    tilt = misalignment * stiffness / (2.0 * line_load)
    return 1.0 + tilt if tilt < 1.0 else 2.0 * math.sqrt(tilt)


def ways() -> Iterator[Way]:
    """From the standard to finite elements."""
    aligned, tilted, slightly = (_run(misalignment) for misalignment in (0.0, MISALIGNMENT, SMALL))
    pair, torque = aligned.pair, 1e3 * aligned.scene.load.torque_Nm
    at_reference, at_base = (2.0 * torque / d / pair.face_width for d in (
        pair.pinion.reference_diameter, pair.pinion.base_diameter,
    ))
    standard = TILTING * mesh_stiffness(single_stiffness(pair, at_reference), pair.transverse_contact_ratio)
    yield Way("ISO 6336-1, Method C", standard, method_c(MISALIGNMENT, standard, at_reference))
    uniform = friction_rows(aligned)[0].mesh_stiffness_N_per_mm_um
    name = "the same formula, mean mesh stiffness of finite elements under an even load"
    yield Way(name, uniform, method_c(MISALIGNMENT, uniform, at_base))
    against = (face_load(slightly, 0).factor() - 1.0) * 2.0 * at_base / SMALL
    name = f"the same formula, stiffness of finite elements against a tilt of {SMALL:g} µm"
    yield Way(name, against, method_c(MISALIGNMENT, against, at_base))
    load = face_load(tilted, 0)
    single = [load.factor(np.array([k])) for k in range(len(load.mean))]
    yield Way("finite elements, at the position with the lowest factor", math.nan, min(single))
    yield Way("finite elements, at the position with the highest factor", math.nan, max(single))
    yield Way("finite elements, of the mean load over the mesh cycle: `face_load_factor`", math.nan, load.factor())


def _run(misalignment: float) -> RunData:
    scene: Scene = scene_from_text(SCENE, [f"pair.misalignment_um={misalignment}"])
    found = solved_run(scene, pitch_of(scene), MPI.COMM_SELF, gear_mesh)
    assert found is not None
    return found


def table(docs: Path) -> str:
    """What was measured."""
    return TABLE.markdown(TABLE.read(docs / FILE))


def main() -> None:
    """Measures and keeps the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--out", type=Path, default=DOCS)
    path = parser.parse_args().out / FILE
    path.parent.mkdir(parents=True, exist_ok=True)
    write_rows(path, list(ways()))
    print(TABLE.markdown(TABLE.read(path)))


if __name__ == "__main__":
    main()
