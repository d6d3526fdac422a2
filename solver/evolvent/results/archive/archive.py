"""Results on disk for resuming, plotting and later studies: NumPy archives, each written atomically.

    OUT/results/gears.npz            surfaces of both sector meshes
    OUT/results/position_0003.npz    one swept position: converged results at each friction coefficient
    OUT/results/state.npz            number of complete positions, and the sweep's state after them

A file is written under a temporary name and then renamed, so that a run killed at any moment leaves complete files
only. The state is written last and removed first: all positions that it counts exist and belong to one run.
"""

from __future__ import annotations

import hashlib
import json
from pathlib import Path

import numpy as np

from evolvent.gears.kinematics import PairRotation
from evolvent.gears.sweep.friction_history import FrictionHistory
from evolvent.gears.sweep.periodic_pitch import one_pitch
from evolvent.gears.sweep.pitch_sweep import SweepState, SweptPosition
from evolvent.results.archive.gear_shapes import GearShape
from evolvent.results.archive.position_arrays import archived_result, result_arrays
from evolvent.results.archive.run_folder import RunFolder
from evolvent.results.archive.store import ArchiveError, Arrays, Store, read_as
from evolvent.scene.differences import differences, identity
from evolvent.scene.scene import Scene, SceneError, kept_scene
from evolvent_meshes.gears.pair import GearPair

STATE = "results/state.npz"


class Archive:
    """The results of a scene in the folder OUT. Only rank 0 writes. command: the one that a message names."""

    def __init__(self, folder: Path, scene: Scene, command: str = "run") -> None:
        self.command = command
        self.out, self.folder, self.files = folder, folder / "results", RunFolder(folder)
        self.scene = scene
        self.store = Store(self.files, fingerprint(scene), self._another, "fingerprint")

    def write_gears(self, shapes: tuple[GearShape, GearShape]) -> None:
        """Writes the surfaces of both gears. Raises WriteError, FolderError."""
        arrays: Arrays = {}
        for name, shape in zip(("pinion", "wheel"), shapes):
            arrays |= {f"{name}/points": shape.points, f"{name}/flank_nodes": shape.flank_nodes}
            arrays |= {f"{name}/facets/{group}": f for group, f in shape.facets.items()}
        self.store.write("results/gears.npz", arrays)

    def check_gears(self, shapes: tuple[GearShape, GearShape]) -> None:
        """Raises ArchiveError if the archived results were computed on other meshes than these."""
        for kept, mesh in zip(self.read_gears(), shapes):
            same = kept.points.shape == mesh.points.shape and np.allclose(kept.points, mesh.points, rtol=0.0, atol=1e-9)
            if not (same and np.array_equal(kept.flank_nodes, mesh.flank_nodes)):
                raise ArchiveError(
                    f"{self.folder}: wanted results on the meshes of this scene, found them on others, made by another "
                    "version of Evolvent or gmsh; --overwrite computes them anew"
                )

    def read_gears(self) -> tuple[GearShape, GearShape]:
        """The surfaces of pinion and wheel. Raises ArchiveError."""
        return read_as(self.folder / "gears.npz", lambda arrays: (_shape(arrays, "pinion"), _shape(arrays, "wheel")))

    def write_position(self, index: int, position: SweptPosition) -> None:
        """Writes the position with this index and the state after it. Raises WriteError, FolderError."""
        arrays: Arrays = {
            "angle": position.angle, "again": position.again, "closes": position.closes, "count": len(position.results),
        }
        for i, result in enumerate(position.results):
            arrays |= {f"{i}/{name}": value for name, value in result_arrays(result).items()}
        self.store.write(f"results/position_{index:04d}.npz", arrays)
        self.store.write(STATE, _state_arrays(index + 1, position.state))

    def read_positions(self, pair: GearPair) -> list[SweptPosition]:
        """The positions of one pitch, each as it was solved last, without states. Raises ArchiveError."""
        return one_pitch(self.read_sweep(pair))

    def read_sweep(self, pair: GearPair) -> list[SweptPosition]:
        """All positions in the order of their solution, without states. Raises ArchiveError."""
        count = self.store.read(STATE, lambda arrays: int(arrays["complete"]))
        return [self._position(k, pair) for k in range(count or 0)]

    def read_state(self, pair: GearPair) -> SweepState | None:
        """The state after all complete positions; None where the archive is empty.

        Raises ArchiveError if the archive belongs to another scene.
        """
        return self.store.read(STATE, lambda arrays: _state(arrays, pair))

    def holds_scene(self) -> bool:
        """Whether the archive holds positions of this scene. Raises ArchiveError if it cannot be read."""
        return self.store.holds(STATE)

    def _another(self, path: Path) -> str:
        """Message on a file that belongs to another scene."""
        return (
            f"{self.folder}: wanted the results of this scene, found those of {self._other_scene()}; resume with the "
            "scene and the settings that it was run with (its scene.toml), name another folder with --out, or compute "
            f"anew with `evolvent {self.command} ... --overwrite`"
        )

    def _other_scene(self) -> str:
        """The scene to which the archive belongs, by its difference to this one, from OUT/scene.toml."""
        path = self.out / "scene.toml"
        try:
            difference = differences(kept_scene(path), self.scene)
        except SceneError:
            return f"another one, or of another version of Evolvent ({path} cannot be read)"
        if difference:
            return f"another one: this one has {difference}"
        return f"another version of Evolvent: no key differs from {path}"

    def _position(self, index: int, pair: GearPair) -> SweptPosition:
        return read_as(self.folder / f"position_{index:04d}.npz", lambda arrays: _position(arrays, pair))


def fingerprint(scene: Scene) -> str:
    """SHA-256 of all that the results depend on: the scene's values without its title and output section, and the
    contents, not the paths, of its flank charts."""
    return hashlib.sha256(json.dumps(identity(scene)).encode()).hexdigest()


def _shape(arrays: Arrays, name: str) -> GearShape:
    start = f"{name}/facets/"
    facets = {key[len(start) :]: value for key, value in arrays.items() if key.startswith(start)}
    return GearShape(arrays[f"{name}/points"], facets, arrays[f"{name}/flank_nodes"])


def _position(arrays: Arrays, pair: GearPair) -> SweptPosition:
    """A swept position, without the state of the sweep after it."""
    results = tuple(archived_result(arrays, f"{i}/", pair) for i in range(int(arrays["count"])))
    state, again, closes = SweepState((0.0, 0.0), ()), bool(arrays["again"]), bool(arrays["closes"])
    return SweptPosition(float(arrays["angle"]), results, state, again, closes)


def _state_arrays(complete: int, state: SweepState) -> Arrays:
    arrays: Arrays = {"complete": complete, "extra": np.array(state.beyond_nominal), "memories": len(state.histories)}
    for i, history in enumerate(state.histories):
        if history is not None:
            arrays |= {
                f"{i}/angle": history.stand.angle, f"{i}/extra": np.array(history.stand.beyond_nominal),
                f"{i}/pinion_rows": history.rows[0], f"{i}/wheel_rows": history.rows[1],
                f"{i}/pinion_forces": history.forces[0], f"{i}/wheel_forces": history.forces[1],
                f"{i}/flux": history.flux,
            }
    return arrays


def _state(arrays: Arrays, pair: GearPair) -> SweepState:
    histories = tuple(
        _history(arrays, f"{i}/", pair) if f"{i}/angle" in arrays else None for i in range(int(arrays["memories"]))
    )
    extra = arrays["extra"]
    return SweepState((float(extra[0]), float(extra[1])), histories)


def _history(arrays: Arrays, start: str, pair: GearPair) -> FrictionHistory:
    extra = arrays[start + "extra"]
    stand = PairRotation(pair, float(arrays[start + "angle"]), (float(extra[0]), float(extra[1])))
    rows = arrays[start + "pinion_rows"], arrays[start + "wheel_rows"]
    forces = arrays[start + "pinion_forces"], arrays[start + "wheel_forces"]
    return FrictionHistory(stand, rows, forces, arrays[start + "flux"])
