"""The words for a rigid motion that no contact resists."""

from __future__ import annotations

import numpy as np

from evolvent import Body, Fixed
from evolvent.contact.step.free_motion import free_motion
from evolvent.fem.body import RigidMotions
from evolvent.fem.rigid_modes import rigid_modes
from evolvent_meshes.shapes.blocks import rectangle

BLOCK = rectangle(2.0, 1.0, 2, 1, 1)
POINTS = BLOCK.points[:, :2] - BLOCK.points[:, :2].mean(axis=0)
BODIES = (Body(BLOCK, supports=(Fixed("bottom"),), name="held"), Body(BLOCK, name="loose"))
NAN = float("nan")


def motions(turn: float = 0.0) -> tuple[RigidMotions, RigidMotions]:
    """None of the first body; x, y and rz of the second one, its translations mixed by an angle [rad]."""
    mix = np.array([[np.cos(turn), -np.sin(turn), 0.0], [np.sin(turn), np.cos(turn), 0.0], [0.0, 0.0, 1.0]])
    shapes = rigid_modes(POINTS)
    none = RigidMotions(shapes[:, :, :0], np.zeros(0), np.zeros(0))
    return none, RigidMotions(shapes @ mix, np.zeros(3), np.full(3, NAN))


def test_the_body_and_its_axis_are_named() -> None:
    """A flat contact with normal y resists y and rz: x is free, whatever motions the body's are mixed from. One that
    resists x and y leaves a turn, without an axis; one that resists all leaves nothing to say."""
    across, height = POINTS.T
    flat = np.column_stack([np.zeros(len(across)), np.ones(len(across)), across])
    assert free_motion(BODIES, motions(), flat) == "body 1 ('loose') is free to move in x: add Fixed or Rigid"
    turned = np.column_stack([np.full(len(across), np.sin(0.3)), np.full(len(across), np.cos(0.3)), across])
    assert "in x" in free_motion(BODIES, motions(0.3), turned)
    pinned = np.array([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    assert free_motion(BODIES, motions(), pinned) == "body 1 ('loose') is free to move: add Fixed or Rigid"
    assert free_motion(BODIES, motions(), np.column_stack([height, flat[:, 1:]])) == ""
    assert free_motion(BODIES, motions(), np.zeros((4, 0))) == ""
