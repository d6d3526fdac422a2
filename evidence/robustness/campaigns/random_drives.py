"""Random gear pairs that vibrate, one per seed: excitation, inertia, damping and backlash over two decades and more.

Excitations are drawn, not computed, so that there are hundreds of them: tooth pairs with relief that come into contact
one after the other and stiffen, mesh stiffnesses of several harmonics or of steps, unloaded errors of harmonics. Their
way to the oscillator is that of `evolvent dynamics`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from evidence.robustness.campaigns.random_scenes import Draw, random_scene
from evolvent.dynamics.excitation.force_surface import MeshExcitation, paper_law
from evolvent.dynamics.excitation.loaded_mesh import LoadedMesh
from evolvent.dynamics.oscillator.mesh_law import stepped_side
from evolvent.dynamics.oscillator.mesh_speed import speeds_to_periods
from evolvent.dynamics.oscillator.torsional_model import TorsionalModel
from evolvent.dynamics.pair_model import Drive, DriveSettings, drive
from evolvent.gears.problem.gear_inertia import equivalent_mass, polar_moment
from evolvent_meshes.arrays import Floats
from evolvent_meshes.gears.pair import GearPair

PERCENTS = np.array([5.0, 15.0, 30.0, 50.0, 75.0, 100.0, 150.0, 200.0])
"""Torques of a force surface, those of a scene by default."""
FROM, TO = 1.0 / 6.0, 1.6
"""Speeds over the natural one, likewise."""
PAIR_STIFFNESS = 14e3
"""Of a tooth pair of steel, per mm of face width [N/mm²]: ISO 6336-1:2019, clause 9.3.1."""
DENSITY = 7.85e-9
"""[t/mm³]."""
MARGIN = 0.05
"""By which a spline through errors may fall below them, over their swing."""
OUTSIDE = 30.0
"""Gap of a tooth pair a base pitch away from its engagement, in static deflections."""


@dataclass(frozen=True, eq=False)
class RandomDrive:
    """What a seed is."""

    drive: Drive
    """The pair that vibrates."""
    periods: Floats
    """Mesh periods (n,) of the speeds [s], descending."""
    kind: str
    """Of its excitation, and the model of its mesh force."""
    damping_ratio: float
    """Of the mesh."""
    backlash: float
    """Over the static deflection."""


@dataclass(frozen=True, eq=False)
class _ToothPairs:
    """Springs k h(s − g) in parallel, at n phases; h(x) = x (x/deflection)^power where x is above 0."""

    stiffness: Floats
    """k (n, p) [N/mm]."""
    gaps: Floats
    """g (n, p) [mm]."""
    power: float
    deflection: float
    """At which the stiffness is k (1 + power) [mm]."""

    def bears(self, i: int, s: float) -> tuple[float, float]:
        """Force [N] and stiffness [N/mm] at phase i."""
        x = np.maximum(s - self.gaps[i], 0.0)
        stiffer = self.stiffness[i] * (x / self.deflection) ** self.power
        return float(stiffer @ x), float((1.0 + self.power) * stiffer @ (x > 0.0))

    def under(self, force: float, i: int) -> tuple[float, float]:
        """Displacement [mm] and stiffness [N/mm] at phase i."""
        first, reach = float(self.gaps[i].min()), self.deflection
        while self.bears(i, first + reach)[0] < force:
            reach *= 2.0
        s = brentq(lambda at: self.bears(i, at)[0] - force, first, first + reach, xtol=1e-15, rtol=1e-14)
        return s, self.bears(i, s)[1]


def random_drive(seed: int) -> RandomDrive:
    """The pair of a seed."""
    draw, scene = Draw(np.random.default_rng([seed, 2])), random_scene(seed, plane=True)
    pair, phases = scene.gear_pair(), np.arange(positions := draw.one_of(20, 20, 40)) / positions
    load = 1e3 * scene.load.torque_Nm / pair.pinion.base_radius
    stiffness = PAIR_STIFFNESS * pair.pinion.face_width * draw.decades(0.2, 5.0)
    kind = draw.one_of("tooth pairs", "tooth pairs", "harmonics", "steps")
    springs = {"tooth pairs": _tooth_pairs, "harmonics": _harmonics, "steps": _steps}[kind](
        draw, phases, stiffness, load / stiffness
    )
    excitation = _excitation(springs, load, phases, _waves(draw, phases, draw.decades(0.01, 1.0)) * load / stiffness)
    settings = _settings(draw, pair, excitation)
    mesh = draw.one_of(settings.mesh, settings.mesh, settings.mesh, "sudden steps")
    nominal = float(excitation.loaded.forces[int(np.argmax(PERCENTS == 100.0))])
    found = drive(pair, excitation, nominal, settings)
    if mesh == "sudden steps":
        found = _suddenly(draw, pair, found, settings)
    speeds = np.linspace(FROM, TO, draw.whole(60, 100)) * found.natural_speed
    deflection = load / found.mean_stiffness
    return RandomDrive(
        found, speeds_to_periods(speeds, found.teeth), f"{kind}, {mesh}", settings.damping_ratio,
        settings.backlash / deflection,
    )


def _tooth_pairs(draw: Draw, phases: Floats, stiffness: float, deflection: float) -> _ToothPairs:
    """In contact one after the other, with relief at both ends of their engagement."""
    ratio, amount, form = draw.uniform(1.05, 2.9), deflection * draw.decades(0.02, 3.0), draw.one_of(1.0, 2.0)
    length = 0.5 * (ratio - 1.0) * draw.uniform(0.2, 1.2)
    along = phases[:, None] + np.arange(-1, math.ceil(ratio) + 1)  # base pitches from the beginning of engagement
    outside = np.maximum(-along, 0.0) + np.maximum(along - ratio, 0.0)
    within = np.clip(np.maximum(length - along, along - ratio + length) / length, 0.0, 1.0)
    gaps = amount * within**form + OUTSIDE * deflection * (outside + outside**2)
    bent = 1.0 - draw.uniform(0.0, 0.5) * (2.0 * along / ratio - 1.0) ** 2
    return _ToothPairs(stiffness * np.maximum(bent, 0.1), gaps, draw.uniform(0.0, 0.2), deflection)


def _harmonics(draw: Draw, phases: Floats, stiffness: float, deflection: float) -> _ToothPairs:
    """One spring, of several mesh harmonics."""
    wave = 1.0 + _waves(draw, phases, draw.decades(0.005, 0.5))
    return _ToothPairs(
        stiffness * wave[:, None], np.zeros((len(phases), 1)), draw.one_of(0.0, draw.uniform(0.0, 0.3)), deflection
    )


def _steps(draw: Draw, phases: Floats, stiffness: float, deflection: float) -> _ToothPairs:
    """One spring of two levels, smoothed over less than a tenth of the pitch."""
    share, width, swing = draw.uniform(0.1, 0.9), draw.decades(0.003, 0.1), draw.decades(0.005, 0.5)
    level = np.tanh((0.5 * share - np.abs(phases - 0.5)) / width)
    return _ToothPairs(
        stiffness * (1.0 + swing * level)[:, None], np.zeros((len(phases), 1)), draw.one_of(0.0, 0.1), deflection
    )


def _waves(draw: Draw, phases: Floats, size: float) -> Floats:
    """(n,) of mean 0 and largest value `size`, of up to six harmonics that become smaller."""
    falling, values = draw.uniform(0.3, 2.0), np.zeros(len(phases))
    for order in range(1, draw.whole(1, 6) + 1):
        amplitude = draw.uniform(0.3, 1.0) / order**falling
        values = values + amplitude * np.cos(2.0 * np.pi * (order * phases - draw.uniform(0.0, 1.0)))
    return np.asarray(size * values / np.abs(values).max())


def _excitation(springs: _ToothPairs, load: float, phases: Floats, error: Floats) -> MeshExcitation:
    """Of these springs on flanks with an error (n,) [mm] of their own, of which the highest flank is where it is
    designed: so that teeth do not jam."""
    error = error - error.min() + MARGIN * np.ptp(error)
    forces = load * PERCENTS / 100.0
    both = np.array([[springs.under(float(force), i) for force in forces] for i in range(len(phases))])
    loaded = LoadedMesh(2.0 * np.pi * phases, forces, 1.0, both[..., 0] + error[:, None], both[..., 1])
    return MeshExcitation(springs.gaps.min(axis=1) + error, loaded)


def _settings(draw: Draw, pair: GearPair, excitation: MeshExcitation) -> DriveSettings:
    """Inertia, damping, backlash, and what gives way in series."""
    number = int(np.argmax(PERCENTS == 100.0))
    mean, load = float(excitation.loaded.stiffness[:, number].mean()), float(excitation.loaded.forces[number])
    pinion, wheel = (polar_moment(gear, DENSITY) * draw.decades(0.1, 10.0) for gear in pair.gears)
    return DriveSettings(
        (pinion, wheel), draw.decades(2e-3, 0.5), draw.one_of(1.0, 1.0, 1.0, 1.0, 0.0) * draw.decades(0.03, 30.0)
        * load / mean, draw.often(0.3), draw.one_of(0.0, draw.decades(1e-3, 0.3)),
        mean * draw.decades(0.1, 10.0) if draw.often(0.3) else math.inf,
        draw.one_of("force_surface", "force_surface", "tangent", "secant"),
    )


def _suddenly(draw: Draw, pair: GearPair, smooth: Drive, settings: DriveSettings) -> Drive:
    """The same drive on a stiffness of two to four levels, without an error."""
    model, count = smooth.model, draw.whole(2, 4)
    phases = np.concatenate([[0.0], np.sort(draw.rng.uniform(0.05, 0.95, count - 1)), [1.0]])
    levels = 1.0 + draw.decades(0.02, 0.6) * draw.rng.uniform(-1.0, 1.0, count)
    side = stepped_side(phases, smooth.mean_stiffness * levels / (levels @ np.diff(phases)))
    stepped = TorsionalModel(
        equivalent_mass(pair, settings.inertias), model.load, paper_law(side, settings.backlash), model.damping,
        model.damping_in_separation, model.ground_damping,
    )
    rest = smooth.moving_stiffness, smooth.equivalent_mass, smooth.body_frequency
    return Drive(stepped, smooth.mean_stiffness, smooth.teeth, settings, *rest)
