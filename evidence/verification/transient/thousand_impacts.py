"""A bar bounces between two rigid walls a thousand times: what becomes of its energy."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from evidence.claims import Claim, Verification, analytical
from evidence.fits import order_of
from evidence.verification.transient.bar_on_wall import LENGTH, PASSAGE, SPEED, thrown
from evidence.verification.transient.bouncing_bar import GAP, LEAST, Bounces, Setting, bounced
from evolvent.results.drawing.style import FAINT, PINION, TEETH, WHEEL, note
from evolvent_meshes.arrays import Floats

IMPACTS, SHORT, PHASES = 1000, 25, 8
DEFAULT, NO_MODES, WITH_MODES = 0.8, Setting(0, 10, 0.8), Setting(4, 20, 0.8)
CONSERVING = Setting(0, 4, None), Setting(4, 10, None)
RADII, STEPS = (0.0, DEFAULT, 1.0), (10, 20, 40)
COLOURS = (PINION, WHEEL, TEETH[0])
BAR = 1e-6
GAINS = "within a time step a blow may begin anywhere, and it gains or loses by that; it loses in the mean"
PROBLEM = """
A steel bar of {length:g} × 1 mm, ν = 0, bounces between two rigid walls, {gap:g} µm away on both sides, with
{speed:g} m/s at the start. There is neither friction nor damping, and nothing drives it: its energy should stay.

With `conserving` it does, to what the steps are solved to: {conserving}.

By the method of Wood, Bossak and Zienkiewicz a blow gains or loses energy. Without natural modes the bar is a mass with
the static stiffness of its ends; after {impacts} impacts {left:.3g} % of its energy is left ({setting}). With modes
impacts leave it vibrating, since a few modes do not bring the whole wave back, and what vibrates with few time steps a
period is taken out: with {with_modes} {left_with:.2g} % is left after {impacts_with} impacts (below {least:g} % it is
not followed).

Single blows without modes by that method, begun at {phases} places within a time step, change the energy by, in the
mean and from the largest loss to the largest gain (10, 20 and 40 time steps in 2L/c; a blow takes 0.9 of that):
{table}. At ρ_∞ = 0 none of them gained. Means far below the range are not resolved by so few places. So that the energy
never grows by more than 1e-6 is no property of this method; where it stays below that of the start, first blows have
lost more than later ones gain.
"""


def changes(steps: int, radius: float, phases: int) -> Floats:
    """Change of the energy by one blow, of itself, (phases,), for blows that begin at different parts of a time step.

    steps: time steps in 2L/c; radius: ρ_∞.
    """
    gaps = GAP + SPEED * PASSAGE / steps * np.arange(phases) / phases
    return np.array([thrown(steps, modes=0, radius=radius, gap=gap).energy[-1] - 1.0 for gap in gaps])


def verify(impacts: int = IMPACTS, short: int = SHORT, phases: int = PHASES) -> Verification:
    """Long runs that conserve energy, short ones that do not, and single blows at each setting."""
    kept = {setting: bounced(setting, impacts) for setting in CONSERVING}
    runs = {setting: bounced(setting, short) for setting in (NO_MODES, WITH_MODES)}
    blows = {(radius, steps): changes(steps, radius, phases) for radius in RADII for steps in STEPS}
    return Verification(
        "thousand_impacts",
        "Bar between two walls: energy over a thousand impacts",
        _statement(kept, runs, blows, phases),
        (*_conserved(kept, impacts), *_over_impacts(runs), *_by_a_blow(blows)),
        lambda figure: draw(figure, {**kept, **runs}, blows),
        "Steps that conserve energy keep it; by the default method a blow gains or loses",
    )


def _statement(
    kept: Mapping[Setting, Bounces], runs: Mapping[Setting, Bounces], blows: Mapping[tuple[float, int], Floats],
    phases: int,
) -> str:
    rows = []
    for radius in RADII:
        each = [blows[radius, steps] for steps in STEPS]
        values = ", ".join(f"{100 * c.mean():+.2g} ({100 * c.min():+.2g} to {100 * c.max():+.2g})" for c in each)
        rows.append(f"ρ_∞ = {radius:g}: {values} %")
    plain, moving = runs[NO_MODES], runs[WITH_MODES]
    conserving = "; ".join(
        f"{setting}: {run.impacts} impacts in {len(run.energy) - 1} steps, {run.systems:.1f} contact systems a step"
        for setting, run in kept.items()
    )
    return PROBLEM.format(
        length=LENGTH, gap=1e3 * GAP, speed=1e-3 * SPEED, conserving=conserving,
        impacts=plain.impacts, left=100.0 * plain.left, setting=NO_MODES,
        with_modes=WITH_MODES, left_with=100.0 * moving.left, impacts_with=moving.impacts,
        least=100.0 * LEAST, phases=phases, table="; ".join(rows),
    )


def _conserved(kept: Mapping[Setting, Bounces], impacts: int) -> list[Claim]:
    nothing, claims = analytical("nothing drives the bar"), []
    for setting, run in kept.items():
        claims += [
            analytical("as many as wanted").at_least(f"impacts, {setting}", run.impacts, impacts, 0.0),
            nothing.bound(f"growth of the energy over that at the start, {setting}", run.growth, BAR),
            nothing.bound(f"loss of energy, {setting}", run.loss, BAR),
        ]
    return claims


def _over_impacts(runs: Mapping[Setting, Bounces]) -> list[Claim]:
    nothing = analytical("nothing drives the bar")
    claims = [
        nothing.bound(f"growth of the energy over that at the start, {setting}", run.growth, BAR)
        for setting, run in runs.items()
    ]
    name = f"growth of the energy over that of any flight before, {NO_MODES}"
    return [*claims, nothing.bound(name, runs[NO_MODES].regained, BAR, GAINS)]


def _by_a_blow(blows: Mapping[tuple[float, int], Floats]) -> list[Claim]:
    nothing, claims = analytical("nothing drives the bar"), []
    for radius, missed in ((0.0, ""), (DEFAULT, GAINS)):
        for steps in STEPS:
            name = f"largest gain of energy by a blow, no modes, {steps} steps, ρ_∞ = {radius:g}"
            claims.append(nothing.bound(name, max(0.0, float(blows[radius, steps].max())), BAR, missed))
    gains = np.array([blows[DEFAULT, steps].max() for steps in STEPS])
    name = f"order of the largest gain in the time step, ρ_∞ = {DEFAULT:g}"
    return [*claims, analytical("first order through impacts").at_least(name, order_of(STEPS, gains), 1.0, 0.15)]


def draw(figure: Figure, runs: Mapping[Setting, Bounces], blows: Mapping[tuple[float, int], Floats]) -> None:
    """Energy over the impacts; change by a blow over its place in a time step, and its mean over the steps."""
    left, middle, right = figure.subplots(1, 3, width_ratios=(1.3, 1.0, 1.0))
    for (setting, run), colour, style in zip(runs.items(), (PINION, WHEEL) * 2, ("-", "--", ":", "-.")):
        left.plot(*run.in_flight, style, color=colour, lw=1.5, label=_drawn(str(setting)))
    left.axhline(1.0, color=FAINT, lw=1.0)
    left.set(xlabel="impacts", ylabel="energy in flight / energy at the start", xscale="log", ylim=(0.0, 1.7))
    left.legend(loc="upper right")
    _phases(middle, blows)
    _means(right, blows)


def _phases(axes: Axes, blows: Mapping[tuple[float, int], Floats]) -> None:
    axes.axhline(0.0, color=FAINT, lw=1.0)
    for steps, colour in zip(STEPS, COLOURS):
        change = blows[DEFAULT, steps]
        place = np.arange(len(change) + 1) / len(change)
        axes.plot(place, 100.0 * np.append(change, change[0]), "o-", ms=3, lw=1.0, color=colour, label=f"{steps} steps")
    axes.set(xlabel="where in a time step the blow begins", ylabel="change of the energy by a blow [%]")
    axes.set_ylim(-3.2, 2.0)
    note(axes, _drawn(f"no modes, ρ_∞ = {DEFAULT:g}"))
    axes.legend(loc="lower right")


def _means(axes: Axes, blows: Mapping[tuple[float, int], Floats]) -> None:
    steps = np.array(STEPS)
    for radius, colour in zip(RADII, COLOURS):
        lost, gained = (100.0 * np.array([f(blows[radius, each]) for each in STEPS]) for f in (_lost, np.max))
        if radius < 1.0:  # else the mean is below what so few places resolve
            axes.loglog(steps, lost, "o-", ms=5, color=colour, label=_drawn(f"mean loss, ρ_∞ = {radius:g}"))
        if gained.min() > 0.0:
            axes.loglog(steps, gained, "^:", ms=5, color=colour, label=_drawn(f"largest gain, ρ_∞ = {radius:g}"))
    axes.set_xticks(steps, [str(each) for each in steps])
    axes.set_xticks([], minor=True)
    axes.yaxis.set_major_formatter("{x:g}")
    axes.set(xlabel="time steps in 2L/c", ylabel="change of the energy by a blow [%]", ylim=(5e-5, None))
    axes.legend(loc="lower left")


def _lost(change: Floats) -> float:
    return -float(change.mean())


def _drawn(text: str) -> str:
    return text.replace("ρ_∞", "$\\rho_\\infty$")
