"""Block stepping on equations with a known solution."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.contact.newton.snes import NotConverged
from evolvent.wear import block_stepping
from evolvent.wear.block_stepping import (
    STABLE_SHARE,
    BlockSettings,
    CycleEvaluation,
    WearModel,
    WearStopped,
    initial_wear_state,
    next_block,
)
from evolvent.wear.mesh_motion import MeshInverted
from evolvent_meshes.arrays import Floats

END = 20.0


class Softening:
    """dh/dN = 1/(1 + h) with h = √(1 + 2N) − 1, at two nodes, the second with half the rate and depth scale."""

    def __init__(self) -> None:
        self.calls = 0

    def evaluate(self, depth: Floats, previous: CycleEvaluation | None = None) -> CycleEvaluation:
        """The rate."""
        self.calls += 1
        return CycleEvaluation(1.0 / (1.0 + depth * (1.0, 2.0)) * (1.0, 0.5), np.ones(2), 1.0, np.inf)

    def implicit_block(
        self, depth: Floats, start: CycleEvaluation, length: float
    ) -> tuple[Floats, CycleEvaluation]:
        """The rate r at the end, r (1 + h + ΔN r) = 1."""
        self.calls += 1
        b = 1.0 + depth * (1.0, 2.0)
        end = CycleEvaluation((np.sqrt(b**2 + 4.0 * length) - b) / (2.0 * length) * (1.0, 0.5), np.ones(2), 1.0, np.inf)
        return length * end.rate, end

    def accept(self, depth: Floats, end: CycleEvaluation) -> CycleEvaluation:
        """No mesh follows."""
        return end


class Failing(Softening):
    """The same, but blocks longer than `longest` cycles do not converge."""

    def __init__(self, longest: float) -> None:
        super().__init__()
        self.longest = longest

    def implicit_block(
        self, depth: Floats, start: CycleEvaluation, length: float
    ) -> tuple[Floats, CycleEvaluation]:
        if length > self.longest:
            raise NotConverged("too long")
        return super().implicit_block(depth, start, length)


class Inverting(Softening):
    """The same, but the mesh cannot follow by more than `deepest` at a time, or by more than `last` in all."""

    def __init__(self, deepest: float, last: float) -> None:
        super().__init__()
        self.deepest, self.last, self.known = deepest, last, 0.0

    def accept(self, depth: Floats, end: CycleEvaluation) -> CycleEvaluation:
        """The meshes follow every block."""
        if depth[0] - self.known > self.deepest or depth[0] > self.last:
            raise MeshInverted("cells turned over")
        self.known = depth[0]
        return end


class Rippling(Softening):
    """dh_k/dN = 1 − (h_k − mean): ripples decay to 1/e in a cycle."""

    def evaluate(self, depth: Floats, previous: CycleEvaluation | None = None) -> CycleEvaluation:
        """The rate, which is nowhere negative."""
        return CycleEvaluation(np.maximum(1.0 - (depth - depth.mean()), 0.0), np.ones(2), np.inf, 1.0)


def worn(model: WearModel[CycleEvaluation], settings: BlockSettings) -> tuple[Floats, list[float]]:
    """Final depths and the lengths of all blocks."""
    state, lengths = initial_wear_state(model, np.zeros(2), settings), list[float]()
    while state.cycles < END * (1.0 - 1e-12):
        block = next_block(model, state, END, settings)
        state = block.state
        lengths.append(block.length)
    return state.depth, lengths


@pytest.mark.parametrize("implicit", [False, True])
def test_halving_the_tolerance_halves_the_error(implicit: bool) -> None:
    """Problem: `Softening` to 20 cycles at three tolerances. Exact: h(20) = √41 − 1. The error is below the tolerance,
    and at half the tolerance at most about half as large; the blocks add up to 20 cycles."""
    exact, errors = np.sqrt(1.0 + 2.0 * END) - 1.0, []
    for tolerance in (0.04, 0.02, 0.01):
        depth, lengths = worn(Softening(), BlockSettings(0.01, tolerance, implicit))
        assert sum(lengths) == pytest.approx(END, rel=1e-12)
        assert depth[1] == pytest.approx(0.5 * depth[0], rel=1e-12)
        errors.append(abs(depth[0] / exact - 1.0))
    assert errors[0] < 0.04
    assert errors[1] < 0.55 * errors[0] and errors[2] < 0.55 * errors[1]


def test_explicit_block_costs_one_evaluation() -> None:
    """Explicit blocks cost one evaluation each, rejected ones included, and one more at the start."""
    study = Softening()
    _, lengths = worn(study, BlockSettings(0.1, 0.05, implicit=False))
    state = initial_wear_state(again := Softening(), np.zeros(2), BlockSettings(0.1, 0.05, implicit=False))
    refused = 0
    while state.cycles < END * (1.0 - 1e-12):
        block = next_block(again, state, END, BlockSettings(0.1, 0.05, implicit=False))
        state, refused = block.state, refused + block.refused
    assert study.calls == 1 + len(lengths) + refused


def test_rejected_block_is_shortened_from_the_same_state() -> None:
    """Problem: blocks above 0.3 cycles do not converge. Exact: shorter ones from the same state reach h(20) within 5
    %."""
    settings = BlockSettings(1.0, 0.5)
    depth, lengths = worn(Failing(0.3), settings)
    assert max(lengths) <= 0.3
    assert depth[0] == pytest.approx(np.sqrt(1.0 + 2.0 * END) - 1.0, rel=0.05)


def test_no_accepted_block_stops_the_study() -> None:
    """Problem: no block converges. Exact: WearStopped names the cycles and the reason, and the state is unchanged."""
    settings, study = BlockSettings(1.0), Failing(0.0)
    state = initial_wear_state(study, np.full(2, 0.3), settings)
    with pytest.raises(WearStopped, match=r"after 0 cycles.*too long.*last good state is kept"):
        next_block(study, state, END, settings)
    assert (state.depth == 0.3).all()


def test_mesh_inversion_shortens_the_block() -> None:
    """Problem: meshes follow by at most 0.5 mm at a time: shorter blocks reach the exact end within 10 %. By at most 3
    mm in all: the study stops near there with the reason, after a bounded number of evaluations."""
    settings = BlockSettings(5.0, 0.5)
    depth, lengths = worn(Inverting(0.5, np.inf), settings)
    assert len(lengths) > 10
    assert depth[0] == pytest.approx(np.sqrt(1.0 + 2.0 * END) - 1.0, rel=0.1)
    study = Inverting(0.5, 3.0)
    with pytest.raises(WearStopped, match=r"cells turned over.*last good state is kept"):
        worn(study, settings)
    assert 2.9 < study.known <= 3.0
    assert study.calls < 100


@pytest.mark.parametrize(("share", "grows"), [(STABLE_SHARE, False), (1.3 * STABLE_SHARE, True)])
def test_explicit_blocks_are_stable(share: float, grows: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    """Problem: a ripple of 1e-3 on a depth of some cycles, in blocks of the largest length. Exact: at the stability
    limit it decays; in blocks a third longer it grows."""
    monkeypatch.setattr(block_stepping, "STABLE_SHARE", share)
    study, settings = Rippling(), BlockSettings(END, implicit=False)
    state = initial_wear_state(study, np.array([0.0, 1e-3]), settings)
    for _ in range(30):
        state = next_block(study, state, np.inf, settings).state
    ripple = np.ptp(state.depth)
    assert ripple > 5e-3 if grows else ripple < 1e-6


def test_deformation_limits_a_block() -> None:
    """Problem: at most a tenth of the deformation, 1 mm, a block, at a rate of 1 mm per cycle. Exact: 0.1 cycles."""
    settings = BlockSettings(5.0, 1.0, implicit=False, deformation_share=0.1)
    study = Softening()
    state = initial_wear_state(study, np.zeros(2), settings)
    assert next_block(study, state, END, settings).length == pytest.approx(0.1)


@pytest.mark.parametrize(("first", "tolerance"), [(0.0, 0.05), (1.0, -1.0), (float("nan"), 0.05)])
def test_bad_block_settings_are_refused(first: float, tolerance: float) -> None:
    """Lengths and tolerances that are not above zero are refused by name."""
    with pytest.raises(ValueError, match=r"wanted .* above zero, found"):
        BlockSettings(first, tolerance)
