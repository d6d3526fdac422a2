"""Input that a transient cannot use: refused by name, with what to do."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import pytest

from evolvent import (
    Body,
    Contact,
    Fixed,
    Freedom,
    InitialState,
    InputError,
    Nitsche,
    Problem,
    Rigid,
    Step,
    Transient,
    TransientSettings,
)
from evolvent_meshes.shapes.blocks import rectangle

H = TransientSettings(1e-6, modes=2)


def blocks(nitsche: Nitsche = Nitsche(), *supports: Fixed) -> Problem:  # noqa: B008  frozen
    """A block under a lid that moves along y, above one that is held below."""
    lid = Rigid("top", (Freedom("y", load=-10.0),))
    upper = Body(rectangle(1.0, 1.0, 1, 1, origin=(0.0, 1.01)), rigid=lid)
    lower = Body(rectangle(1.0, 1.0, 1, 1), supports=supports or (Fixed("bottom"),))
    return Problem((upper, lower), (Contact((0, "bottom"), (1, "top"), reach=0.5),), nitsche)


@pytest.mark.parametrize(
    ("values", "named"),
    [
        ({"time_step": 0.0}, "time_step"),
        ({"time_step": float("nan")}, "time_step"),
        ({"time_step": 1e-6, "modes": -1}, "modes"),
        ({"time_step": 1e-6, "modes": 2.5}, "modes"),
        ({"time_step": 1e-6, "damping_ratio": 1.5}, "damping_ratio"),
        ({"time_step": 1e-6, "spectral_radius": -0.1}, "spectral_radius"),
    ],
)
def test_settings_out_of_range(values: dict[str, Any], named: str) -> None:
    """Each by its name."""
    with pytest.raises(InputError, match=named):
        TransientSettings(**values)


@pytest.mark.parametrize(
    "velocities", [{0: (1.0,)}, {0: (1.0, float("inf"))}, {"upper": (1.0, 0.0)}, [(0, (1.0, 0.0))], {0: "fast"}]
)
def test_velocities_that_are_none(velocities: Any) -> None:
    """Too few components, infinite ones, a body's name, a list, a word."""
    with pytest.raises(InputError, match="velocit"):
        InitialState(velocities=velocities)


@pytest.mark.parametrize(
    ("velocities", "named"),
    [({2: (0.0, 1.0)}, "body indices below 2"), ({0: (0.0, 1.0, 0.0)}, "2 components"),
     ({0: (1.0, -1.0)}, r"body 0: wanted one along its free rigid motions, y, found \(1\.0, -1\.0\); give its Rigid"),
     ({1: (0.0, 1.0)}, r"body 1: wanted none, as the body is held, found \(0\.0, 1\.0\)")],
)
def test_velocities_that_do_not_fit_the_problem(velocities: dict[int, tuple[float, ...]], named: str) -> None:
    """No such body; three components in 2D; along a motion that the lid has not; of a body that is held."""
    with pytest.raises(InputError, match=named):
        Transient(blocks(), H, InitialState(velocities=velocities))


def test_a_velocity_along_a_prescribed_motion() -> None:
    """The lid moves along y as prescribed, so that the body cannot begin with a speed of its own."""
    lid = Rigid("top", (Freedom("y", displacement=-0.1), Freedom("x", load=0.0)))
    upper, lower = blocks().bodies
    problem = Problem((replace(upper, rigid=lid), lower), blocks().contacts)
    with pytest.raises(InputError, match="free rigid motions, x, found"):
        Transient(problem, H, InitialState(velocities={0: (0.0, -1.0)}))


def test_a_velocity_along_a_support() -> None:
    """A body without a lid that is held along x flies along y alone."""
    upper, lower = blocks().bodies
    floating = replace(upper, rigid=None, supports=(Fixed("left", "x"),))
    problem = Problem((floating, lower), blocks().contacts)
    with pytest.raises(InputError, match="free rigid motions, y, found"):
        Transient(problem, H, InitialState(velocities={0: (1.0, -1.0)}))
    moment = Transient(problem, H, InitialState(velocities={0: (0.0, -1.0)})).solve()
    assert abs(moment.velocities[0]) == pytest.approx([1.0], rel=1e-12)


def test_velocities_are_those_of_the_first_moment() -> None:
    """A block thrown along both axes that its lid leaves free, which are named in another order than the components,
    and no force: after a step it has the same speeds, to 1e-12, and does not turn."""
    lid = Rigid("top", (Freedom("rz", load=0.0), Freedom("y", load=0.0), Freedom("x", load=0.0)))
    upper, lower = blocks().bodies
    problem = Problem((replace(upper, rigid=lid), lower), blocks().contacts)
    moment = Transient(problem, H, InitialState(velocities={0: (3.0, -5.0)})).solve()
    assert moment.velocities[0] == pytest.approx([0.0, -5.0, 3.0], rel=1e-12, abs=1e-9)


def test_problems_that_have_no_transient() -> None:
    """Skew-symmetric Nitsche; a support that is displaced; no problem at all; no settings."""
    with pytest.raises(InputError, match="theta"):
        Transient(blocks(Nitsche(theta=-1.0)), H)
    with pytest.raises(InputError, match="supports at rest"):
        Transient(blocks(Nitsche(), Fixed("bottom", "x"), Fixed("bottom", "y", 0.1)), H)
    for wrong in ((None, H), (blocks(), 1e-6), (blocks(), H, "rest")):
        with pytest.raises(InputError):
            Transient(*wrong)  # type: ignore[arg-type]


def test_a_step_that_prescribes_what_was_loaded() -> None:
    """A freedom stays loaded or prescribed; and a failed step leaves the transient as it was."""
    run = Transient(blocks(), H)
    run.solve()
    with pytest.raises(InputError, match="prescribed"):
        run.solve(Step(freedoms=((0, Freedom("y", displacement=0.1)),)))
    assert run.time == pytest.approx(1e-6)
    assert run.solve().time == pytest.approx(2e-6)


def test_free_fall() -> None:
    """The lid's 10 N/mm on a block of 1 mm²: after 50 steps without contact its speed is F t/m and its way F t²/2m, to
    1e-9."""
    moments = list(Transient(blocks(), TransientSettings(1e-7, 0)).run(20))
    t, acceleration = 20 * 1e-7, -10.0 / 7.85e-9
    assert moments[-1].velocities[0][0] == pytest.approx(acceleration * t, rel=1e-9)
    assert moments[-1].solution.motions[0][0] == pytest.approx(0.5 * acceleration * t**2, rel=1e-9)
    assert moments[-1].energy.kinetic == pytest.approx(moments[-1].work, rel=1e-6)
