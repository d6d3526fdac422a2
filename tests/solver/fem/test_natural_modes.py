"""Natural modes of held and of floating bodies, with and without a rigid coupling."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import eigh

from evolvent import Body, Fixed, Freedom, Material, Rigid
from evolvent.fem.body import Assembled, assemble
from evolvent.fem.condensation.schur_complement import Factor
from evolvent.fem.mean_axes import MeanAxes
from evolvent.fem.natural_modes import NaturalModes, natural_modes
from evolvent_meshes.shapes.blocks import rectangle

BAR = Material(210e3, 0.0)
LENGTH, SPEED = 20.0, float(np.sqrt(210e3 / 7.85e-9))  # mm; of sound in a bar [mm/s]


def modes(assembled: Assembled, count: int) -> tuple[NaturalModes, MeanAxes]:
    free = assembled.free
    K = assembled.stiffness[free][:, free].tocsr()
    axes = MeanAxes.of(assembled)
    return natural_modes(K, axes, Factor(K).solve, count), axes


@pytest.mark.parametrize(("held", "ends"), [((), 0.0), ((Fixed("top"),), 0.5)])
def test_frequencies_of_a_bar(held: tuple[Fixed, ...], ends: float) -> None:
    """Lengthwise vibration of a bar of length L with ν = 0: ω = π n c/L of a free one, π (n − ½) c/L of one held at an
    end, within 2e-4 for the first four on 20 cells of order 2; no rigid motion is among them."""
    body = Body(rectangle(1.0, LENGTH, 1, 20), BAR, supports=(Fixed("left", "x"), Fixed("right", "x"), *held))
    found, _ = modes(assemble(body), 4)
    exact = np.pi * (np.arange(1, 5) - ends) * SPEED / LENGTH
    assert found.frequencies == pytest.approx(exact, rel=2e-4)
    assert found.frequencies[:2] == pytest.approx(exact[:2], rel=1e-5)


@pytest.mark.parametrize("count", [5, 10_000])
@pytest.mark.parametrize("coupled", [False, True])
def test_modes_are_those_of_the_whole_eigenproblem(coupled: bool, count: int) -> None:
    """A plate that floats, or whose rigid top slides freely along y: the dense eigenproblem of all degrees of freedom,
    rigid motions included, has the same frequencies to 1e-8, after its zeros. All modes, and a few by Lanczos."""
    rigid = Rigid("top", (Freedom("y", load=0.0),)) if coupled else None
    assembled = assemble(Body(rectangle(4.0, 3.0, 4, 3), rigid=rigid))
    found, axes = modes(assembled, count)
    if coupled:
        kept = np.eye(assembled.stiffness.shape[0])[:, assembled.free]
        basis = np.hstack([kept, axes.motions])
    else:
        basis = np.eye(assembled.stiffness.shape[0])
    values = eigh(basis.T @ (assembled.stiffness @ basis), basis.T @ (axes.mass @ basis), eigvals_only=True)
    exact = np.sqrt(values[1 if coupled else 3 :])
    assert len(found.frequencies) == min(count, len(exact))
    assert found.frequencies == pytest.approx(exact[: len(found.frequencies)], rel=1e-8)


def test_modes_are_orthogonal_in_mean_axes() -> None:
    """wᵀ M̂ w is the identity, and the shapes ŵ have no inertia in common with the free rigid motions: 1e-10."""
    assembled = assemble(Body(rectangle(4.0, 3.0, 4, 3)))
    found, axes = modes(assembled, 6)
    w = found.shapes
    assert w.T @ axes.times(w) == pytest.approx(np.eye(6), abs=1e-9)
    scale = np.sqrt(np.diag(axes.rigid_mass))
    assert np.abs(axes.motions.T @ (axes.mass @ axes.shape(w))).max() < 1e-10 * scale.max()


def test_no_modes() -> None:
    """None asked for: none, of the right shape."""
    assembled = assemble(Body(rectangle(4.0, 3.0, 2, 2), supports=(Fixed("bottom"),)))
    found, _ = modes(assembled, 0)
    assert found.frequencies.shape == (0,)
    assert found.shapes.shape == (len(assembled.free), 0)
