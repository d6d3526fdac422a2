"""Positions of an excitation on disk: a call that was stopped goes on from them, and other speeds, dampers or inertias
need no contact to be solved.

    OUT/results/excitation.npz          on the meshes of the scene
    OUT/results/excitation_coarse.npz   on those of the companion that gives the error bars
    OUT/results/excitation*_deflected.npz   the same on deflected flanks, where a pitch does not balance otherwise
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from evolvent.dynamics.excitation.loaded_mesh import COLUMNS
from evolvent.results.archive.archive import ArchiveError, arrays_bytes, fingerprint, read_arrays
from evolvent.results.archive.run_folder import RunFolder
from evolvent.run.dynamics.scene_torques import SceneTorques
from evolvent_meshes.arrays import Floats

KEPT, KEPT_COARSE = "results/excitation.npz", "results/excitation_coarse.npz"
DEFLECTED = ".npz", "_deflected.npz"
"""End of these names, and what it is on deflected flanks."""
KEPT_DEFLECTED = KEPT.replace(*DEFLECTED), KEPT_COARSE.replace(*DEFLECTED)


@dataclass(frozen=True)
class KeptPositions:
    """The solved positions of one kind of meshes. Only rank 0 reads and writes them."""

    folder: RunFolder
    """Where the call writes."""
    name: str
    """Of the file below that."""
    identity: str
    """Of the gears, their torques and positions, see `identity`."""
    resume: bool
    """Whether the call goes on from those of an earlier one."""

    @property
    def deflected(self) -> KeptPositions:
        """The same gears, torques and positions on deflected flanks."""
        return replace(self, name=self.name.replace(*DEFLECTED))

    def read(self) -> dict[int, Floats]:
        """Number of a position -> (m, 4) figures under each torque (`figures_of`); none where the call begins anew, or
        there is no file. Raises ArchiveError where it is that of other gears, torques or positions."""
        path = self.folder.out / self.name
        if not self.resume or not path.exists():
            return {}
        arrays = read_arrays(path)
        if str(arrays.get("identity")) != self.identity:
            raise ArchiveError(
                f"{path}: wanted positions of this scene, found those of other gears, meshes, torques or positions "
                "(what follows on the excitation may differ); --resume goes on with the scene and the torques that it "
                "was called with, --out names another folder, --overwrite computes anew"
            )
        numbers, figures = arrays.get("numbers", np.zeros(0)), arrays.get("figures", np.zeros(0))
        fits = figures.shape == (*numbers.shape, *figures.shape[1:2], COLUMNS)
        if numbers.dtype.kind != "i" or figures.dtype.kind != "f" or not fits:
            raise ArchiveError(
                f"{path}: wanted numbers of positions with their figures, found other arrays; move or remove it, then "
                "call again"
            )
        return {int(number): each for number, each in zip(numbers, figures)}

    def write(self, found: Mapping[int, Floats]) -> None:
        """Keeps positions, see `read`. Raises WriteError, FolderError."""
        numbers = sorted(found)
        arrays = {"identity": self.identity, "numbers": numbers, "figures": np.array([found[i] for i in numbers])}
        self.folder.write(self.name, arrays_bytes(arrays))


def kept_positions(loads: SceneTorques, out: Path, resume: bool) -> tuple[KeptPositions, KeptPositions]:
    """Of the meshes of the scene and of the companion's."""
    fine, coarse = (KeptPositions(RunFolder(out), name, identity(loads), resume) for name in (KEPT, KEPT_COARSE))
    return fine, coarse


def identity(loads: SceneTorques) -> str:
    """SHA-256 of all that the excitation of gears under some torques depends on: neither friction nor what is done with
    the excitation."""
    scene = loads.scene
    smooth = scene.contact.model_copy(update={"friction": (0.0,)})
    bare = scene.model_copy(update={"dynamics": None, "contact": smooth})
    return hashlib.sha256(f"{fingerprint(bare)} {loads.torques}".encode()).hexdigest()
