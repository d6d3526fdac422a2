"""A transient that goes on from a file is the one that was not interrupted; files of others are left alone."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import islice
from pathlib import Path

import numpy as np
import pytest

from evolvent import (
    Body,
    Contact,
    Fixed,
    Freedom,
    InitialState,
    InputError,
    MotionState,
    Problem,
    Rigid,
    Step,
    Traction,
    Transient,
    TransientSettings,
)
from evolvent.contact.transient import saved_state
from evolvent_meshes.arrays import Floats
from evolvent_meshes.shapes.blocks import rectangle
from tests.support.running.processes import RunScript, on_ranks

END, SLID = 4e-6, 1e-9  # s, mm
EQUAL = TransientSettings(2e-7, modes=3)
ADAPTIVE = TransientSettings(4e-7, modes=3, tolerance=0.02)

GOING_ON = r"""
import sys
from pathlib import Path
import numpy as np
from evolvent import Transient
from tests.solver.contact.transient.test_saved_state import EQUAL, difference, figures, loads, shaken

found = figures(Transient.resume(Path(sys.argv[1]), shaken(), EQUAL).solve(loads))
with np.load(sys.argv[2]) as wanted:
    sys.stdout.write(f"{max(difference(found[name], wanted[name]) for name in found)!r}\n")
"""


def shaken(friction: float = 0.3) -> Problem:
    """A block, pressed by a traction and drawn to the side by its lid, on one that is held."""
    lid = Rigid("top", (Freedom("y", load=-300.0), Freedom("x", load=60.0)))
    upper = Body(rectangle(2.0, 2.0, 2, 2, origin=(0.5, 1.0)), loads=(Traction("left", (5.0, 0.0)),), rigid=lid,
                 name="slider")
    base = Body(rectangle(3.0, 1.0, 3, 1), supports=(Fixed("bottom"),), name="base")
    return Problem((upper, base), (Contact((0, "bottom"), (1, "top"), friction=friction),))


def loads(time: float) -> Step:
    """It presses and drags in turn, so that points slide to and fro."""
    share = float(np.sin(2e6 * time))
    return Step(1.0, freedoms=((0, Freedom("y", load=-300.0)), (0, Freedom("x", load=150.0 * share))))


def begun(settings: TransientSettings) -> Transient:
    return Transient(shaken(), settings, InitialState(Step()))


def figures(moment: MotionState) -> dict[str, Floats]:
    """All that a moment says: an array of each unit."""
    contact, solution = moment.solution.contacts[0], moment.solution
    lengths = [contact.slip.ravel(), *solution.motions, *(solution.displacement(i).ravel() for i in range(2))]
    return {
        "s": np.array([moment.time, moment.length]), "1": np.array([moment.error]),
        "N mm": np.array([moment.work, moment.energy.total]), "MPa": contact.traction,
        "mm": np.concatenate(lengths), "mm/s": np.concatenate(moment.velocities),
    }


def difference(one: Floats, other: Floats) -> float:
    """Largest difference of two arrays over the largest entry."""
    return float(np.abs(one - other).max(initial=0.0) / max(np.abs(other).max(initial=0.0), 1e-300))


def same(one: dict[str, Floats], other: dict[str, Floats]) -> bool:
    """Whether two moments are equal in every bit."""
    return all(np.array_equal(one[name], other[name]) for name in one)


@pytest.mark.parametrize("settings", [EQUAL, ADAPTIVE])
def test_a_run_goes_on_bit_for_bit(settings: TransientSettings, tmp_path: Path) -> None:
    """Saved after six steps and taken up by a new `Transient`: every figure of every moment that follows, in which
    points slide and stick, is that of the run that went on, exactly. Without the deformed surfaces, from which slip is
    measured, they would differ."""
    run = begun(settings)
    *_, last = islice(run.run_until(END, loads), 6)
    path = run.save(tmp_path / "state.npz")
    moments = list(run.run_until(END, loads))
    slid = [np.linalg.norm(moment.solution.contacts[0].slip, axis=1) > SLID for moment in moments]
    assert any(each.any() and not each.all() for each in slid)
    going_on = [figures(moment) for moment in moments]
    again = Transient.resume(path, shaken(), settings)
    assert again.time == last.time
    taken_up = [figures(moment) for moment in again.run_until(END, loads)]
    assert len(going_on) == len(taken_up)
    assert all(same(a, b) for a, b in zip(going_on, taken_up))
    forgetful = Transient.resume(path, shaken(), settings)
    assert forgetful._reached is not None
    forgetful._reached = replace(forgetful._reached, deformed=None)
    assert not same(figures(next(iter(forgetful.run_until(END, loads)))), going_on[0])


@pytest.mark.parametrize("size", on_ranks(1, 2))
def test_another_program_goes_on(size: int, saved: Path, tmp_path: Path, run_script: RunScript) -> None:
    """On one rank, and on two that do the same: the next moment is that of this program, to 1e-8 of the largest
    figure of each unit. Another process condenses the bodies again, and its sums round differently (docs/checks.md)."""
    wanted = figures(Transient.resume(saved, shaken(), EQUAL).solve(loads))
    np.savez(tmp_path / "wanted.npz", **wanted)
    done = run_script("-c", GOING_ON, str(saved), str(tmp_path / "wanted.npz"), ranks=size)
    assert done.returncode == 0, done.stderr
    found = [float(line) for line in done.stdout.split()]
    assert len(found) == size and max(found) < 1e-8


def test_lengths_of_steps_may_change(tmp_path: Path) -> None:
    """Equal steps to begin with, then adaptive ones, then equal ones of another length."""
    run = begun(EQUAL)
    run.solve(loads)
    path = run.save(tmp_path / "state")
    adaptive = Transient.resume(path, shaken(), ADAPTIVE)
    adaptive.solve(loads)
    adaptive.save(path)
    assert Transient.resume(path, shaken(), replace(EQUAL, time_step=1e-7)).solve(loads).length == 1e-7


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A state of the block."""
    run = begun(EQUAL)
    run.solve(loads)
    return run.save(tmp_path_factory.mktemp("kept") / "state.npz")


def others() -> Iterator[tuple[Problem, TransientSettings, str]]:
    """Problems and settings that are not those of the state, and what is said of each."""
    same = shaken()
    longer = replace(same.bodies[1], mesh=rectangle(3.0, 1.0, 3, 2))
    yield replace(same, bodies=(same.bodies[0], longer)), EQUAL, r"another body 1 \('base'\);"
    yield shaken(friction=0.2), EQUAL, "another contact 0;"
    yield same, replace(EQUAL, modes=4), "another setting modes;"
    yield same, replace(EQUAL, damping_ratio=0.1, spectral_radius=0.5), "setting damping_ratio, setting spectral_radius"
    third = Body(rectangle(1.0, 1.0, 1, 1, origin=(1.0, 3.0)), name="lid")
    more = (*same.contacts, Contact((2, "bottom"), (0, "right")))
    yield Problem((*same.bodies, third), more), EQUAL, r"another body 2 \('lid'\), contact 1;"


@pytest.mark.parametrize(("problem", "settings", "named"), others())
def test_states_of_others_are_refused(saved: Path, problem: Problem, settings: TransientSettings, named: str) -> None:
    """By what differs: a body, a contact, settings, a body more."""
    with pytest.raises(InputError, match=named):
        Transient.resume(saved, problem, settings)


def test_a_state_of_other_modes_is_refused(saved: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Where the computed modes have the other sign: their amplitudes would be those of another motion."""
    projections = saved_state._projections
    monkeypatch.setattr(saved_state, "_projections", lambda body: -projections(body))
    with pytest.raises(InputError, match="modes of body 0"):
        Transient.resume(saved, shaken(), EQUAL)


def test_what_is_no_state(saved: Path, tmp_path: Path) -> None:
    """No file, a text, half a state, other arrays, a folder: refused by name, and not overwritten; nor is the state of
    another problem. Before the first step there is nothing to save."""
    run = begun(EQUAL)
    with pytest.raises(InputError, match="at least one step"):
        run.save(tmp_path / "state.npz")
    assert not list(tmp_path.iterdir())
    run.solve(loads)
    with pytest.raises(InputError, match=r"none\.npz"):
        Transient.resume(tmp_path / "none.npz", shaken(), EQUAL)
    (tmp_path / "text").write_text("dear diary")
    (tmp_path / "half").write_bytes(saved.read_bytes()[:1000])
    np.savez(tmp_path / "arrays.npz", time=np.zeros(3))
    np.save(tmp_path / "array.npy", np.zeros(3))
    (tmp_path / "folder").mkdir()
    for path in tmp_path.iterdir():
        with pytest.raises(InputError, match=path.name):
            Transient.resume(path, shaken(), EQUAL)
        before = path.read_bytes() if path.is_file() else b""
        with pytest.raises(InputError, match=f"{path.name}.*others are not overwritten"):
            run.save(path)
        assert (path.read_bytes() if path.is_file() else b"") == before
    kept = saved.read_bytes()
    other = Transient(shaken(friction=0.1), EQUAL)
    other.solve(loads)
    with pytest.raises(InputError, match="contact 0"):
        other.save(saved)
    assert saved.read_bytes() == kept
