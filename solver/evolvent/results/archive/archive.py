"""Results on disk for resuming, plotting and later studies: NumPy archives, each written atomically.

    OUT/results/gears.npz            surfaces of both sector meshes
    OUT/results/position_0003.npz    one swept position: converged results at each friction coefficient
    OUT/results/state.npz            number of complete positions, and the sweep's state after them

A file is written under a temporary name and then renamed, so that a run killed at any moment leaves complete files
only. The state is written last and removed first: all positions that it counts exist and belong to one run.
"""

from __future__ import annotations

import hashlib
import io
import json
from pathlib import Path
from typing import Any

import numpy as np

from evolvent.gears.kinematics import Stand
from evolvent.gears.sweep.friction_history import FrictionHistory
from evolvent.gears.sweep.periodic_pitch import one_pitch
from evolvent.gears.sweep.pitch_sweep import SweepState, SweptPosition
from evolvent.results.archive.gear_shapes import GearShape
from evolvent.results.archive.position_arrays import archived_result, result_arrays
from evolvent.results.archive.run_folder import RunFolder
from evolvent.scene.differences import charts, differences, essence
from evolvent.scene.scene import Scene, SceneError, derived_values, load_scene
from evolvent_meshes.errors import InputError
from evolvent_meshes.files import open_file
from evolvent_meshes.gears.pair import GearPair


class ArchiveError(InputError):
    """An archive that cannot be read or belongs to another scene."""


class Archive:
    """The results of a scene in the folder OUT. Only rank 0 writes."""

    def __init__(self, folder: Path, scene: Scene) -> None:
        self.out, self.folder, self.files = folder, folder / "results", RunFolder(folder)
        self.scene, self.fingerprint = scene, fingerprint(scene)

    def write_arrays(self, name: str, arrays: dict[str, Any]) -> None:
        """Writes OUT/results/name atomically and durably. Raises WriteError, FolderError."""
        self.files.write(f"results/{name}", arrays_bytes(arrays))

    def write_gears(self, shapes: tuple[GearShape, GearShape]) -> None:
        """Writes the surfaces of both gears. Raises WriteError, FolderError."""
        arrays: dict[str, Any] = {}
        for name, shape in zip(("pinion", "wheel"), shapes):
            arrays |= {f"{name}/points": shape.points, f"{name}/flank_nodes": shape.flank_nodes}
            arrays |= {f"{name}/facets/{group}": f for group, f in shape.facets.items()}
        self.write_arrays("gears.npz", arrays)

    def check_gears(self, shapes: tuple[GearShape, GearShape]) -> None:
        """Raises ArchiveError if the archived results were computed on other meshes than these."""
        for kept, mesh in zip(self.read_gears(), shapes):
            same = kept.points.shape == mesh.points.shape and np.allclose(kept.points, mesh.points, rtol=0.0, atol=1e-9)
            if not (same and np.array_equal(kept.flank_nodes, mesh.flank_nodes)):
                raise ArchiveError(
                    f"{self.folder}: wanted results on the meshes of this scene, found them on others, made by another "
                    "version of Evolvent or gmsh; `evolvent run ... --overwrite` computes them anew"
                )

    def read_gears(self) -> tuple[GearShape, GearShape]:
        """The surfaces of pinion and wheel. Raises ArchiveError."""
        arrays = read_arrays(self.folder / "gears.npz")
        return _shape(arrays, "pinion"), _shape(arrays, "wheel")

    def write_position(self, index: int, position: SweptPosition) -> None:
        """Writes the position with this index and the state after it. Raises WriteError, FolderError."""
        arrays: dict[str, Any] = {
            "angle": position.angle, "again": position.again, "closes": position.closes, "count": len(position.results),
        }
        for i, result in enumerate(position.results):
            arrays |= {f"{i}/{name}": value for name, value in result_arrays(result).items()}
        self.write_arrays(f"position_{index:04d}.npz", arrays)
        self.write_arrays("state.npz", self._state_arrays(index + 1, position.state))

    def read_positions(self, pair: GearPair) -> list[SweptPosition]:
        """The positions of one pitch, each as it was solved last, without states. Raises ArchiveError."""
        return one_pitch(self.read_sweep(pair))

    def read_sweep(self, pair: GearPair) -> list[SweptPosition]:
        """All positions in the order of their solution, without states. Raises ArchiveError."""
        count = int(self._state()["complete"])
        return [self._position(k, pair) for k in range(count)]

    def read_state(self, pair: GearPair) -> SweepState | None:
        """The state after all complete positions; None where the archive is empty.

        Raises ArchiveError if the archive belongs to another scene.
        """
        if not (self.folder / "state.npz").exists():
            return None
        arrays = self._state()
        histories = tuple(
            _history(arrays, f"{i}/", pair) if f"{i}/angle" in arrays else None for i in range(int(arrays["memories"]))
        )
        extra = arrays["extra"]
        return SweepState((float(extra[0]), float(extra[1])), histories)

    def _state(self) -> dict[str, Any]:
        arrays = read_arrays(self.folder / "state.npz")
        self.require_scene(arrays)
        return arrays

    def holds_scene(self) -> bool:
        """Whether the archive holds positions of this scene. Raises ArchiveError if it cannot be read."""
        path = self.folder / "state.npz"
        return path.exists() and str(read_arrays(path).get("fingerprint")) == self.fingerprint

    def require_scene(self, arrays: dict[str, Any]) -> None:
        """Raises ArchiveError unless these arrays of the archive belong to this scene."""
        if str(arrays.get("fingerprint")) != self.fingerprint:
            raise ArchiveError(
                f"{self.folder}: wanted the results of this scene, found those of {self._other_scene()}; resume with "
                "the scene and the settings that it was run with (its scene.toml), name another folder with --out, or "
                "compute anew with `evolvent run ... --overwrite`"
            )

    def _other_scene(self) -> str:
        """The scene to which the archive belongs, by its difference to this one, from OUT/scene.toml."""
        path = self.out / "scene.toml"
        try:
            difference = differences(load_scene(path), self.scene)
        except SceneError:
            return f"another one, or of another version of Evolvent ({path} cannot be read)"
        if difference:
            return f"another one: this one has {difference}"
        return f"another version of Evolvent: no key differs from {path}"

    def _state_arrays(self, complete: int, state: SweepState) -> dict[str, Any]:
        arrays: dict[str, Any] = {
            "fingerprint": self.fingerprint, "complete": complete, "extra": np.array(state.extra),
            "memories": len(state.histories),
        }
        for i, history in enumerate(state.histories):
            if history is not None:
                arrays |= {
                    f"{i}/angle": history.stand.angle, f"{i}/extra": np.array(history.stand.extra),
                    f"{i}/pinion_rows": history.rows[0], f"{i}/wheel_rows": history.rows[1],
                    f"{i}/pinion_forces": history.forces[0], f"{i}/wheel_forces": history.forces[1],
                    f"{i}/flux": history.flux,
                }
        return arrays

    def _position(self, index: int, pair: GearPair) -> SweptPosition:
        arrays = read_arrays(self.folder / f"position_{index:04d}.npz")
        try:
            results = tuple(archived_result(arrays, f"{i}/", pair) for i in range(int(arrays["count"])))
            again, closes = bool(arrays["again"]), bool(arrays["closes"])
        except KeyError as missing:
            raise ArchiveError(
                f"{self.folder}: wanted the results of this version of Evolvent, found some without {missing}; "
                "compute anew with `evolvent run ... --overwrite`"
            ) from missing
        return SweptPosition(float(arrays["angle"]), results, SweepState((0.0, 0.0), ()), again, closes)


def fingerprint(scene: Scene) -> str:
    """SHA-256 of all that the results depend on: the scene's values without its title and output section, and the
    contents, not the paths, of its flank charts."""
    bare = essence(scene)
    values = json.dumps([bare.model_dump(mode="json"), derived_values(bare), *charts(scene)])
    return hashlib.sha256(values.encode()).hexdigest()


def arrays_bytes(arrays: dict[str, Any]) -> memoryview:
    """The content of a NumPy archive (.npz) with these arrays."""
    content = io.BytesIO()
    np.savez(content, **{name.replace("/", "|"): value for name, value in arrays.items()})
    return content.getbuffer()


def read_arrays(path: Path) -> dict[str, Any]:
    """The arrays of an archive written from `arrays_bytes`. Raises ArchiveError."""
    try:
        with open_file(path) as file, np.load(file, allow_pickle=False) as archive:
            return {name.replace("|", "/"): archive[name] for name in archive.files}
    except Exception as error:  # NumPy and zipfile raise whatever the bytes of another file lead them to
        remedy = "move or remove it, then compute" if path.exists() else "compute"
        raise ArchiveError(
            f"{path}: wanted a results file, found none that can be read ({error}); {remedy} anew with `evolvent run "
            "... --overwrite`"
        ) from error


def _shape(arrays: dict[str, Any], name: str) -> GearShape:
    start = f"{name}/facets/"
    facets = {key[len(start) :]: value for key, value in arrays.items() if key.startswith(start)}
    return GearShape(arrays[f"{name}/points"], facets, arrays[f"{name}/flank_nodes"])


def _history(arrays: dict[str, Any], start: str, pair: GearPair) -> FrictionHistory:
    extra = arrays[start + "extra"]
    stand = Stand(pair, float(arrays[start + "angle"]), (float(extra[0]), float(extra[1])))
    rows = arrays[start + "pinion_rows"], arrays[start + "wheel_rows"]
    forces = arrays[start + "pinion_forces"], arrays[start + "wheel_forces"]
    return FrictionHistory(stand, rows, forces, arrays[start + "flux"])
