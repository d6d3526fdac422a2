"""Names of the files that `evolvent excitation` and `evolvent dynamics` write below OUT."""

from __future__ import annotations

from evolvent.dynamics.figures.all import EXCITATION_PICTURE, VIBRATION_PICTURES
from evolvent.dynamics.results.design_load import EXCITATION_FACTS
from evolvent.dynamics.results.histories import HISTORIES
from evolvent.dynamics.results.response import BRANCH, DYNAMICS, RESPONSE
from evolvent.dynamics.results.spectrum import SPECTRUM
from evolvent.dynamics.results.tables import EXCITATION, HARMONICS
from evolvent.dynamics.results.torque_map import TORQUE_MAP

OF_EXCITATION = EXCITATION.name, HARMONICS.name, EXCITATION_FACTS.name, f"pictures/{EXCITATION_PICTURE.name}"
OF_DYNAMICS = (
    *OF_EXCITATION, *(table.name for table in (RESPONSE, BRANCH, DYNAMICS, SPECTRUM, HISTORIES, TORQUE_MAP)),
    *(f"pictures/{picture.name}" for picture in VIBRATION_PICTURES),
)
"""Files that `evolvent dynamics` writes. An excitation that is computed anew removes them, as they belong to another
one."""
