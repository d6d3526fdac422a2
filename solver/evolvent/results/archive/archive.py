"""Results on disk for resuming, plotting and later studies: NumPy archives, each written atomically.

    OUT/results/gears.npz            surfaces of both sector meshes
    OUT/results/position_0003.npz    one swept position: converged results at each friction coefficient, and the state
                                     of the sweep after it
    OUT/results/state.npz            number of complete positions, and the state after the last of them
    OUT/results/coarse_*.npz         the same of the coarse companion that gives the error bars

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

STATE, IN_POSITION = "state.npz", "state/"
SAME_ANGLE = 1e-8
"""Largest difference between rotations [rad] that are taken for the same."""
COARSE = "coarse_"
"""Beginning of the names of files of the coarse companion."""


class Archive:
    """The results of a scene in the folder OUT. Only rank 0 writes.

    command: the one that a message names.
    part: beginning of the names of files: empty for the results that are reported, or `COARSE`.
    """

    def __init__(self, folder: Path, scene: Scene, command: str = "run", part: str = "") -> None:
        self.command, self.part = command, part
        self.out, self.folder, self.files = folder, folder / "results", RunFolder(folder)
        self.scene = scene
        self.store = Store(self.files, fingerprint(scene), self._another, "fingerprint")

    def write_gears(self, shapes: tuple[GearShape, GearShape]) -> None:
        """Writes the surfaces of both gears. Raises WriteError, FolderError."""
        arrays: Arrays = {}
        for name, shape in zip(("pinion", "wheel"), shapes):
            arrays |= {f"{name}/points": shape.points, f"{name}/flank_nodes": shape.flank_nodes}
            arrays |= {f"{name}/facets/{group}": f for group, f in shape.facets.items()}
        self.store.write(self.name_of("gears.npz"), arrays)

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
        path = self.out / self.name_of("gears.npz")
        return read_as(path, lambda arrays: (_shape(arrays, "pinion"), _shape(arrays, "wheel")))

    def write_position(self, index: int, position: SweptPosition) -> None:
        """Writes the position with this index and the state after it. Raises WriteError, FolderError."""
        self.store.write(self.name_of(f"position_{index:04d}.npz"), _position_arrays(position))
        self.store.write(self.name_of(STATE), {"complete": index + 1, **state_arrays(position.state, "")})

    def read_positions(self, pair: GearPair) -> list[SweptPosition]:
        """The positions of one pitch, each as it was solved last. Raises ArchiveError."""
        return one_pitch(self.read_sweep(pair))

    def read_sweep(self, pair: GearPair) -> list[SweptPosition]:
        """All positions in the order of their solution. Raises ArchiveError."""
        count = self.store.read(self.name_of(STATE), lambda arrays: int(arrays["complete"]))
        return [self._position(k, pair) for k in range(count or 0)]

    def read_state(self, pair: GearPair) -> SweepState | None:
        """The state after all complete positions; None where the archive is empty.

        Raises ArchiveError if the archive belongs to another scene.
        """
        return self.store.read(self.name_of(STATE), lambda arrays: sweep_state(arrays, "", pair))

    def write_between(self, position: SweptPosition) -> None:
        """Writes a position that lies between those of the pitch. Raises WriteError, FolderError."""
        self.store.write(self.name_of(f"angle_{position.angle:.15g}.npz"), _position_arrays(position))

    def read_between(self, angle: float, pair: GearPair) -> SweptPosition | None:
        """The position of `write_between` at a pinion rotation [rad], to `SAME_ANGLE`; None where there is none. Raises
        ArchiveError where it belongs to another scene."""
        pattern = Path(self.name_of("angle_*.npz"))
        for path in sorted(self.folder.glob(pattern.name)):
            if abs(float(path.stem.rpartition("_")[2]) - angle) < SAME_ANGLE:
                return self.store.read(self.name_of(path.name.removeprefix(self.part)), lambda a: _position(a, pair))
        return None

    def holds_scene(self) -> bool:
        """Whether the archive holds positions of this scene. Raises ArchiveError if it cannot be read."""
        return self.store.holds(self.name_of(STATE))

    def name_of(self, file: str) -> str:
        """Name below OUT of a file of this part of the results."""
        return f"results/{self.part}{file}"

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
        return read_as(self.out / self.name_of(f"position_{index:04d}.npz"), lambda arrays: _position(arrays, pair))


def fingerprint(scene: Scene) -> str:
    """SHA-256 of all that the results depend on: the scene's values without its title and output section, and the
    contents, not the paths, of its flank charts."""
    return hashlib.sha256(json.dumps(identity(scene)).encode()).hexdigest()


def _shape(arrays: Arrays, name: str) -> GearShape:
    start = f"{name}/facets/"
    facets = {key[len(start) :]: value for key, value in arrays.items() if key.startswith(start)}
    return GearShape(arrays[f"{name}/points"], facets, arrays[f"{name}/flank_nodes"])


def _position_arrays(position: SweptPosition) -> Arrays:
    """A swept position as arrays, with the state after it."""
    arrays: Arrays = {
        "angle": position.angle, "again": position.again, "closes": position.closes, "count": len(position.results),
    }
    for i, result in enumerate(position.results):
        arrays |= {f"{i}/{name}": value for name, value in result_arrays(result).items()}
    return arrays | state_arrays(position.state, IN_POSITION)


def _position(arrays: Arrays, pair: GearPair) -> SweptPosition:
    """A swept position from its arrays; archives of earlier versions have no state in it."""
    results = tuple(archived_result(arrays, f"{i}/", pair) for i in range(int(arrays["count"])))
    has_state = f"{IN_POSITION}memories" in arrays
    state = sweep_state(arrays, IN_POSITION, pair) if has_state else SweepState((0.0, 0.0), ())
    return SweptPosition(float(arrays["angle"]), results, state, bool(arrays["again"]), bool(arrays["closes"]))


def state_arrays(state: SweepState, start: str) -> Arrays:
    """The state of a sweep as arrays whose names begin with `start`."""
    arrays: Arrays = {f"{start}extra": np.array(state.beyond_nominal), f"{start}memories": len(state.histories)}
    for i, history in enumerate(state.histories):
        if history is not None:
            named = {
                "angle": history.stand.angle, "extra": np.array(history.stand.beyond_nominal),
                "pinion_rows": history.rows[0], "wheel_rows": history.rows[1],
                "pinion_forces": history.forces[0], "wheel_forces": history.forces[1], "flux": history.flux,
            }
            arrays |= {f"{start}{i}/{name}": value for name, value in named.items()}
    return arrays


def sweep_state(arrays: Arrays, start: str, pair: GearPair) -> SweepState:
    """The state of a sweep from `state_arrays`. Raises KeyError where one is missing."""
    histories = tuple(
        _history(arrays, f"{start}{i}/", pair) if f"{start}{i}/angle" in arrays else None
        for i in range(int(arrays[f"{start}memories"]))
    )
    extra = arrays[f"{start}extra"]
    return SweepState((float(extra[0]), float(extra[1])), histories)


def _history(arrays: Arrays, start: str, pair: GearPair) -> FrictionHistory:
    extra = arrays[start + "extra"]
    stand = PairRotation(pair, float(arrays[start + "angle"]), (float(extra[0]), float(extra[1])))
    rows = arrays[start + "pinion_rows"], arrays[start + "wheel_rows"]
    forces = arrays[start + "pinion_forces"], arrays[start + "wheel_forces"]
    return FrictionHistory(stand, rows, forces, arrays[start + "flux"])
