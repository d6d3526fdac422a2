"""Estimated size of [dynamics] and [transient]: motions, natural modes, time steps, and processor time of the speeds.
"""

from __future__ import annotations

import math

from evolvent.dynamics.mode_count import expected_modes
from evolvent.dynamics.oscillator.mesh_speed import MeshSpeed
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene
from evolvent.scene.schema.dynamics import DynamicsSection, TransientSection
from evolvent.scene.schema.errors import InputProblem, shown

RANGE = 1.0 / 6.0, 1.6
"""Speeds over the natural one that are swept by default, and over which steady states are followed in any case."""
BRANCH_POINTS = 800
"""Steady states along the branch, on a logarithmic axis of the speed."""
MOTION, NATURAL_PERIOD = 5e-3, 5e-4
"""Processor time [s] of a motion, and of each natural period in its mesh period: to a factor of three of He's pair at
speeds from 10 to 60,000 r/min, at damping ratios of 0.03 and more."""
MOST_MODES = 3000
"""Natural modes of a gear: those of He's pinion up to 100 kHz, a hundred, take 10 s of processor time."""
SWEEPS = 4
"""Sweeps over all speeds with error bars: one of the pair, three on other excitations."""
RESOLVED = 0.25
"""Frequency up to which natural modes are computed over that of time steps."""
STEPS = 1, 1, 4
"""Time steps of a motion, of the motion on coarser gears and of that in shorter steps, over those of the motion."""


def speeds_time(natural: float, section: DynamicsSection, error_bars: bool) -> float:
    """Processor time of the vibration at all speeds, roughly [s]. natural: speed by ISO 6336-1 [r/min]."""
    low, high = section.speed_rpm or (RANGE[0] * natural, RANGE[1] * natural)
    begin, end = min(low, RANGE[0] * natural), max(high, RANGE[1] * natural)
    along = BRANCH_POINTS * (natural / begin - natural / end) / math.log(end / begin)
    motions = 2 * (section.speeds + len(section.histories_rpm))
    at_speeds = motions * natural * math.log(high / low) / (high - low)
    return (SWEEPS if error_bars else 1) * (NATURAL_PERIOD * (along + at_speeds) + MOTION * motions)


def shown_time(seconds: float) -> str:
    """A time in seconds, minutes or hours, to one digit."""
    for unit, size in (("h", 3600.0), ("min", 60.0)):
        if seconds >= size:
            return f"{float(f'{seconds / size:.1g}'):g} {unit}"
    return f"{max(float(f'{seconds:.1g}'), 1.0):g} s"


def natural_modes(scene: Scene, section: TransientSection) -> tuple[float, ...]:
    """Number of natural modes of pinion and wheel; to a third where all modes up to a frequency are wanted."""
    problem, density = gear_problem(scene), (scene.dynamics or DynamicsSection()).density
    if section.modes_per_harmonic is not None:
        return tuple(float(section.modes_per_harmonic * gear.z) for gear in problem.pair.gears)
    fastest = MeshSpeed(max(section.speeds_rpm), problem.pair.pinion.z)
    highest = RESOLVED * fastest.mesh_frequency * scene.sweep.positions
    elastic = ((each.youngs_modulus, each.poissons_ratio) for each in problem.materials)
    return tuple(
        max(expected_modes(gear, each, density, highest, problem.is_plane), gear.z)
        for gear, each in zip(problem.pair.gears, elastic)
    )


def too_many_modes(scene: Scene, section: TransientSection) -> InputProblem | None:
    """Problem of a transient that would compute natural modes for hours; None where it would not."""
    if section.modes_per_harmonic is not None or max(modes := natural_modes(scene, section)) <= MOST_MODES:
        return None
    found = f"{shown(section.speeds_rpm)} in {scene.sweep.positions} positions: about {max(modes):,.0f} modes of a gear"
    allowed = f"speeds and sweep.positions whose time steps resolve at most {MOST_MODES:,} natural modes of a gear"
    remedy = "lower one of both, or say how many with transient.modes_per_harmonic"
    return InputProblem("transient.speeds_rpm", found, allowed, remedy)


def most_time_steps(section: TransientSection, motions: int, positions: int, error_bars: bool) -> int:
    """Number of undivided time steps of all motions if none becomes steady before its last mesh period."""
    return sum(STEPS[: 3 if error_bars else 1]) * motions * section.mesh_periods * positions
