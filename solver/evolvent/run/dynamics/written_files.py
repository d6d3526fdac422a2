"""Names of what `evolvent excitation` and `evolvent dynamics` write below OUT."""

from __future__ import annotations

from evolvent.dynamics.results.design_load import EXCITATION_FACTS
from evolvent.dynamics.results.histories import HISTORIES
from evolvent.dynamics.results.response import BRANCH, DYNAMICS, RESPONSE
from evolvent.dynamics.results.spectrum import SPECTRUM
from evolvent.dynamics.results.tables import EXCITATION, HARMONICS
from evolvent.dynamics.results.torque_map import TORQUE_MAP

EXCITATION_PICTURE, VIBRATION_PICTURE, WATERFALL = "excitation.png", "vibration.png", "waterfall.png"
PORTRAITS, MAP_PICTURE = "histories.png", "torque_map.png"
PICTURES = EXCITATION_PICTURE, VIBRATION_PICTURE, WATERFALL, PORTRAITS, MAP_PICTURE
OF_EXCITATION = EXCITATION, HARMONICS, EXCITATION_FACTS, f"pictures/{EXCITATION_PICTURE}"
OF_DYNAMICS = (
    EXCITATION, HARMONICS, EXCITATION_FACTS, RESPONSE, BRANCH, DYNAMICS, SPECTRUM, HISTORIES, TORQUE_MAP,
    *(f"pictures/{name}" for name in PICTURES),
)
"""What `evolvent dynamics` writes; an excitation that is computed anew removes it, as it belongs to another one."""
