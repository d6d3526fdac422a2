"""Row of the table of a pitch from Python."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class PitchRow:
    """A position of a pitch."""

    pinion_angle_deg: float
    """Rotation of the pinion; 0: tooth pair 0 touches at the pitch point, in the mid-face section."""
    friction: float
    """Friction coefficient μ."""
    torque_pinion_Nm: float
    """Input torque of the pinion."""
    torque_gear_Nm: float
    """Output torque of the wheel."""
    transmission_error_um: float
    """Transmission error r_b1 φ_1 − r_b2 φ_2: lag of the wheel behind the pinion along the line of action."""
    mesh_stiffness_N_per_um: float
    """Tangent stiffness of the whole face along the line of action, without friction."""
    max_pressure_MPa: float
    """Largest fitted peak pressure between the tip-edge zones; NaN where there is none."""
    tip_edge: bool
    """Whether a tooth bears on a tip edge, where the pressure is singular."""
