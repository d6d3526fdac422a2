"""Positions of an excitation on disk. A call that was stopped resumes from them, and for other speeds, dampers or
inertias no contact is solved again.

    OUT/results/excitation.npz          on the meshes of the scene
    OUT/results/excitation_coarse.npz   on those of the companion that gives the error bars
    OUT/results/excitation_PART.npz     of one of several scenes of a computation; excitation_coarse_PART.npz
    OUT/results/excitation*_deflected.npz   the same on deflected flanks, where a pitch does not balance otherwise
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from evolvent.dynamics.excitation.loaded_mesh import COLUMNS, LINE_COLUMNS
from evolvent.results.archive.archive import fingerprint
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.archive.store import ArchiveError, Arrays, Store
from evolvent.run.dynamics.scene_torques import SceneTorques
from evolvent_meshes.arrays import Floats

KEPT = "results/excitation.npz", "results/excitation*.npz"
"""Name of the file that is there first, and pattern of all of them."""
DEFLECTED = ".npz", "_deflected.npz"
"""End of the names of these files, and its replacement for positions on deflected flanks."""


@dataclass(frozen=True)
class KeptPositions:
    """Archived positions of an excitation on one kind of meshes. Only rank 0 reads and writes them."""

    store: Store
    """Files of the call, with the identity of the gears, their torques and positions (`identity`)."""
    name: str
    """Name of the file below OUT."""

    @property
    def deflected(self) -> KeptPositions:
        """Positions of these gears and torques on deflected flanks."""
        return replace(self, name=self.name.replace(*DEFLECTED))

    def read(self) -> dict[int, Floats]:
        """Number of a position -> figures under each torque (`Figures`); none where there is no file. Raises
        ArchiveError where it is that of other gears, torques or positions."""
        return self.store.read(self.name, self._figures) or {}

    def _figures(self, arrays: Arrays) -> dict[int, Floats]:
        """Figures of the positions in archived arrays, by the number of the position. Raises ArchiveError where the
        arrays hold others."""
        numbers, figures = arrays.get("numbers", np.zeros(0)), arrays.get("figures", np.zeros(0))
        columns = figures.shape[-1] if figures.ndim == 3 else 0
        fits = numbers.shape == figures.shape[:1] and (columns == COLUMNS or columns >= LINE_COLUMNS)
        if numbers.dtype.kind != "i" or figures.dtype.kind != "f" or not fits:
            raise ArchiveError(
                f"{self.store.folder.out / self.name}: wanted numbers of positions with their figures, found other "
                "arrays; move or remove it, then call again"
            )
        return {int(number): each for number, each in zip(numbers, figures)}

    def write(self, found: Mapping[int, Floats]) -> None:
        """Archives positions, as `read` returns them. Raises WriteError, FolderError."""
        numbers = sorted(found)
        self.store.write(self.name, {"numbers": numbers, "figures": np.array([found[i] for i in numbers])})


def kept_positions(loads: SceneTorques, folder: RunFolder, part: str = "") -> KeptPositions:
    """Positions in a folder. part: of the results, see `Archive`."""
    return KeptPositions(Store(folder, identity(loads), another), file_name(part))


def file_name(part: str) -> str:
    """Name of the file with the positions of a part of the results, see `Archive`."""
    return "_".join(["results/excitation", *filter(None, part.split("_"))]) + ".npz"


def another(path: Path) -> str:
    """Message on archived positions of another scene."""
    return (
        f"{path}: wanted positions of this scene, found those of other gears, meshes, torques or positions (what "
        "follows on the excitation may differ); --resume goes on with the scene and the torques that it was called "
        "with, --out names another folder, --overwrite computes anew"
    )


def identity(loads: SceneTorques) -> str:
    """SHA-256 of all that the excitation of gears under some torques depends on: neither friction nor the use of the
    excitation."""
    bare = loads.scene.changed("contact", friction=(0.0,)).model_copy(update={"dynamics": None})
    return hashlib.sha256(f"{fingerprint(bare)} {loads.torques}".encode()).hexdigest()
