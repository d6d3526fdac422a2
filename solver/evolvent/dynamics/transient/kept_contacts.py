"""Store of searched contacts, at the positions of a mesh period and at the ends of time steps between them.

The gap of a position is linear in ψ near where it was searched. Searches are made at whole multiples of twice
`search_window`'s reach, so that a pair that vibrates needs one or a few for each position.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from evolvent.contact.newton.equilibrium import Equilibrium
from evolvent.contact.newton.snes import NotConverged
from evolvent.dynamics.transient.moving_pair import MovingPair
from evolvent.dynamics.transient.pair_step import SearchedContact
from evolvent.gears.contact.pair_contact import facing_flanks
from evolvent.gears.kinematics import PairRotation

REACH = 1e-3
"""Largest displacement of the flanks from where they were searched [modules], up to which a search is used."""
BEYOND = 1.5
"""Factor on `REACH` up to which a search is used where the next one would send the solution back to it."""
WIDER = 1.5
"""Half-width of search windows over that in statics: vibration widens contacts."""
RIM = 1.5
"""Factor by which a search window is widened where contact reaches its rim. Each step begins with the first window
again, so that results do not depend on what was solved before."""
ROUNDS = 8


Key = tuple[float, int, float]
"""Key of a searched contact: position, counted at the finest spacing that shares the store; multiple of the search
spacing in ψ; half-width of the window."""


@dataclass
class ContactStore:
    """Store of searched and solved contacts with limited memory."""

    most: float = np.inf
    """Largest memory of the stored contacts [bytes]. The first ones are stored: as each mesh period needs all of them
    in turn, dropping the oldest would keep none that is needed next."""
    kept: dict[Key, SearchedContact] = field(default_factory=dict, repr=False)
    """Stored contacts, within the memory limit."""
    _sizes: dict[Key, int] = field(default_factory=dict, repr=False)
    """Memory of each stored contact [bytes]."""
    _latest: dict[Key, SearchedContact] = field(default_factory=dict, repr=False)
    """Last contact, if it exceeded the memory limit: a time step may ask for it twice. It comes on top of that
    limit."""

    def find(self, key: Key) -> SearchedContact | None:
        """Stored contact of a key; None where it has to be searched."""
        return self.kept.get(key) or self._latest.get(key)

    def keep(self, key: Key, at: SearchedContact) -> None:
        """Stores a contact once it is solved, where memory allows. It counts with its compliance, unless flanks were
        separated in all its solutions. Quantities that results derive from it later, a few per cent, are counted when
        it is solved again."""
        self._latest.clear()
        self._sizes[key] = at.counted_bytes if key in self.kept else at.bytes_now
        self.kept[key] = at
        if sum(self._sizes.values()) > self.most:
            del self.kept[key], self._sizes[key]
            self._latest[key] = at


@dataclass(frozen=True)
class KeptContacts:
    """Searched contacts of one pair, for any number of transients with the same number of components."""

    pair: MovingPair
    """Gear pair with its inertia."""
    positions: int
    """Number n of positions of a mesh period. Position 3.5 is midway between 3 and 4, n is 0 a pitch later."""
    components: int
    """Components k of contact forces: 1 without friction, else the dimension of space."""
    store: ContactStore = field(default_factory=ContactStore, repr=False)
    """Store of the searched contacts."""
    apart: int = 1
    """Spacing of the positions over the finest spacing that shares the store."""

    def thinned(self, apart: int) -> KeptContacts:
        """Contacts of each `apart`-th position, from the first one on. Those that were searched for all positions are
        not searched again. apart: a power of two, so that angles are the same to the last digit, and a divisor of the
        number of positions."""
        return replace(self, positions=self.positions // apart, apart=apart * self.apart)

    @property
    def step_angle(self) -> float:
        """Pinion rotation from one position to the next [rad]."""
        return 2.0 * np.pi / self.pair.model.pair.pinion.z / self.positions

    def solved(
        self, phase: float, predicted: float, solve: Callable[[SearchedContact], Equilibrium]
    ) -> tuple[SearchedContact, Equilibrium]:
        """The solution of a position, on the contact searched near to it. predicted: ψ [rad].

        Raises NotConverged, SearchError.
        """
        multiple, half_width = round(predicted / self._spacing), WIDER * self.pair.model.half_width
        for _ in range(ROUNDS):
            key = self.apart * phase, multiple, half_width
            at = self.store.find(key) or self._searched(phase, multiple, half_width)
            try:
                found = solve(at)
            finally:  # a step that is not solved is taken again in half, and in other periods
                self.store.keep(key, at)
            shift = float(found.motion[0]) / self._spacing
            if at.contact.geometry.reaches_rim(found.traction[:, 0] > 0.0):
                half_width *= RIM
            elif abs(shift) > 0.5 * BEYOND:
                multiple += round(shift)
            elif at.overlap_outside(self.pair, found):
                half_width = np.inf
            else:
                return at, found
        raise NotConverged(
            f"pinion at {np.degrees(phase * self.step_angle):.3f}°: wanted flanks searched where they come to, found "
            f"them {self._spacing * self.pair.lever * 1e3:.2f} µm away, or in contact where they were not searched, "
            f"after {ROUNDS} searches; take more positions"
        )

    def _searched(self, phase: float, multiple: int, half_width: float) -> SearchedContact:
        model, angle, ψ = self.pair.model, phase * self.step_angle, multiple * self._spacing
        stand = PairRotation(model.pair, angle, self.pair.drive.rotations(ψ))
        contact = facing_flanks(
            model.bodies, stand, list(model.teeth), half_width,
            apart="the pair may be thrown apart further than the search looks: give it more damping or another speed",
            remedy="lower the torque, or give more damping",
        )
        return SearchedContact.of(self.pair, contact, ψ, self.components)

    @property
    def _spacing(self) -> float:
        """Rotation ψ between two searches [rad]."""
        return 2.0 * REACH * self.pair.model.pair.pinion.normal_module / self.pair.lever
