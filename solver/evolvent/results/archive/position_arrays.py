"""The result of a position as arrays of an archive, and back."""

from __future__ import annotations

from dataclasses import fields
from typing import Any

import numpy as np

from evolvent.gears.contact.contact_points import ContactPoints
from evolvent.gears.kinematics import PairRotation
from evolvent.gears.sweep.position_result import PositionResult
from evolvent_meshes.gears.member import Member
from evolvent_meshes.gears.pair import GearPair

CONTACT_KEYS = {"roll_distance": "ξ"}
"""Field of ContactPoints -> its name in archives, where they differ."""
DRIVING = "driving"
"""Field of PositionResult with the gear that drives, of which archives have the index."""


def result_arrays(result: PositionResult) -> dict[str, Any]:
    """Arrays of a position's result by their names in the archive."""
    arrays = {f.name: getattr(result, f.name) for f in fields(PositionResult) if f.name not in ("stand", "contact")}
    arrays |= {_contact_key(f.name): getattr(result.contact, f.name) for f in fields(ContactPoints)}
    return arrays | {"angle": result.stand.angle, "extra": np.array(result.stand.beyond_nominal)}


def archived_result(arrays: dict[str, Any], start: str, pair: GearPair) -> PositionResult:
    """Result of a position from the arrays whose names begin with `start`; in archives of earlier versions the pinion
    drives. Raises KeyError where one is missing."""
    kept = {key[len(start) :]: value for key, value in arrays.items() if key.startswith(start)}
    stand = PairRotation(pair, float(kept.pop("angle")), (float(kept["extra"][0]), float(kept.pop("extra")[1])))
    contact = ContactPoints(**{f.name: kept.pop(_contact_key(f.name)) for f in fields(ContactPoints)})
    kept["torques"] = (float(kept["torques"][0]), float(kept["torques"][1]))
    scalars = {name: value.item() for name, value in kept.items() if isinstance(value, np.ndarray) and value.ndim == 0}
    driving = Member(int(kept.get(DRIVING, Member.PINION)))
    values = kept | scalars | {"stand": stand, "contact": contact, DRIVING: driving}
    return PositionResult(**{f.name: values[f.name] for f in fields(PositionResult)})


def _contact_key(field: str) -> str:
    """Key in the archive of a field of ContactPoints."""
    return f"contact/{CONTACT_KEYS.get(field, field)}"
