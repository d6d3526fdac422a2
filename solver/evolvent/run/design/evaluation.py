"""Figures of variants: each is computed once, by one of the ranks, and stored.

    OUT/results/design.npz   variants that were computed, with their figures
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from evolvent.fem.parallel.ranks import together
from evolvent.gears.sweep.parallel_sweep import division
from evolvent.results.archive.archive import fingerprint
from evolvent.results.archive.store import ArchiveError, Arrays, Store
from evolvent.run.call import Call
from evolvent.run.design.design_space import DesignSpace
from evolvent.run.design.variant_mesh import FIGURES, VariantMesh
from evolvent.run.progress import VARIANTS
from evolvent_meshes.arrays import Floats

KEPT = "results/design.npz"
"""Name of the file with the variants."""
AT_ONCE = 8
"""Variants that a rank computes before they are stored."""


@dataclass(frozen=True, eq=False)
class Variants:
    """n variants in the order of their computation."""

    values: Floats
    """(n, k) values of the keys."""
    figures: Floats
    """(n, m, f) figures under each torque, see `VariantMesh`; NaN where there are none."""
    reasons: tuple[str, ...]
    """(n,) why a variant has no figures; empty where it has."""

    def of(self, values: Floats) -> Variants:
        """The variants with values (p, k), in this order. Raises KeyError for one that is not known."""
        places = {row.tobytes(): number for number, row in enumerate(self.values)}
        own = [places[row.tobytes()] for row in values]
        return Variants(values, self.figures[own], tuple(self.reasons[number] for number in own))

    def and_(self, more: Variants) -> Variants:
        """All of these, then more."""
        return Variants(
            np.concatenate([self.values, more.values]), np.concatenate([self.figures, more.figures]),
            (*self.reasons, *more.reasons),
        )


class Evaluation:
    """Computes variants that are not known yet. All ranks have the same.

    call: with the folder in which they are stored.
    store: of the design.
    mesh: returns the condensed gears; called once a variant is not known.
    known: variants of an earlier call.
    """

    def __init__(self, call: Call, store: Store, mesh: Callable[[], VariantMesh], known: Variants) -> None:
        self._call, self._store, self._mesh, self._known = call, store, mesh, known
        self._asked: dict[bytes, Floats] = {}
        self.expected = 0
        """Number of variants that are expected in all, for the display of progress."""

    @property
    def asked(self) -> Variants:
        """All variants that were asked for, in this order."""
        return self._known.of(np.array(list(self._asked.values())))

    def of(self, values: Floats) -> Variants:
        """The variants with values (p, k), computed where they are not known. Collective. Raises WriteError,
        MeshError."""
        self._asked |= {row.tobytes(): row for row in values if row.tobytes() not in self._asked}
        known = {row.tobytes() for row in self._known.values}
        missing = list({row.tobytes(): row for row in values if row.tobytes() not in known}.values())
        if missing:
            self._mesh()  # has stages of its own
            self._call.progress.stage(VARIANTS, max(self.expected, len(known) + len(missing)), len(known))
        size = AT_ONCE * self._call.comm.size
        for first in range(0, len(missing), size):
            self._compute(np.array(missing[first : first + size]))
        return self._known.of(values)

    def _compute(self, values: Floats) -> None:
        comm, mesh = self._call.comm, self._mesh()
        own = values[division(len(values), comm.size)[comm.rank]]
        found = together(comm, lambda: [mesh.figures(row) for row in own])
        every = [each for part in comm.allgather(found) for each in part]
        figures, reasons = np.array([each[0] for each in every]), tuple(each[1] for each in every)
        self._known = self._known.and_(Variants(values, figures, reasons))
        self._call.on_first(lambda: self._store.write(KEPT, arrays_of(self._known)))
        self._call.progress.reach(len(self._known.values))


def arrays_of(variants: Variants) -> Arrays:
    """Variants as arrays."""
    return {"values": variants.values, "figures": variants.figures, "reasons": np.array(variants.reasons)}


def no_variants(keys: int, torques: int) -> Variants:
    """No variants as yet, of so many keys under so many torques."""
    return Variants(np.zeros((0, keys)), np.zeros((0, torques, FIGURES)), ())


def kept_variants(store: Store, keys: int, torques: int) -> Variants:
    """Variants that an earlier call has stored. On rank 0 alone. keys, torques: their numbers. Raises ArchiveError
    where they are those of another scene."""
    path = store.folder.out / KEPT

    def decoded(arrays: Arrays) -> Variants:
        values, figures, reasons = arrays["values"], arrays["figures"], arrays["reasons"]
        count = len(values)
        if values.shape[1:] != (keys,) or figures.shape != (count, torques, FIGURES) or len(reasons) != count:
            raise ArchiveError(
                f"{path}: wanted variants with their figures, found other arrays; move or remove it, then call again"
            )
        return Variants(values, figures, tuple(map(str, reasons)))

    return store.read(KEPT, decoded) or no_variants(keys, torques)


def design_store(call: Call, space: DesignSpace, torques: tuple[float, ...]) -> Store:
    """Store of a design's variants, which depend on the gears, the torques, the keys that vary and the friction of a
    loss; neither on other targets and limits nor on the search."""
    bare = space.scene.changed("contact", friction=(space.friction,))
    bare = bare.model_copy(update={"dynamics": None, "design": None, "wear": None})
    identity = hashlib.sha256(f"{fingerprint(bare)} {torques} {space.keys}".encode()).hexdigest()
    return Store(call.folder, identity, another)


def another(path: Path) -> str:
    """Message on variants of another scene."""
    return (
        f"{path}: wanted variants of this scene, found those of other gears, torques, positions or keys that vary, or "
        "with another friction coefficient of the loss; --resume goes on with the scene that it was called with "
        "(targets, limits and samples may differ, all but loss_percent), --out names another folder, --overwrite "
        "computes anew"
    )
