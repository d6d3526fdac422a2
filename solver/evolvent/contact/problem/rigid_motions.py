"""The rigid motions of a body in one step."""

from __future__ import annotations

import numpy as np

from evolvent.contact.problem.definition import Step
from evolvent.fem.body import Assembled, RigidMotions


def motions_at(step: Step, index: int, assembled: Assembled) -> RigidMotions:
    """The rigid motions of body `index` with their loads and prescribed amplitudes in a step."""
    motions, rigid = assembled.motions, assembled.body.rigid
    names = [f.direction for f in rigid.freedoms] if rigid else []
    load, value = step.load * motions.load, step.load * motions.value
    for freedom in (f for i, f in step.freedoms if i == index):
        k = names.index(freedom.direction)
        carried = step.load * float(motions.shapes[:, :, k].ravel() @ assembled.load)
        load[k] = np.nan if freedom.load is None else freedom.load + carried
        value[k] = np.nan if freedom.displacement is None else freedom.displacement
    return RigidMotions(motions.shapes, load, value)
