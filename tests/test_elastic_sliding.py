"""The elastic part of the sliding on gear flanks, against pairs of material points followed between two solutions."""

from __future__ import annotations

import numpy as np
import pytest
from gear_cases import model_of, spur_scene
from mpi4py import MPI

from meshes.data import Floats
from solver.gear_contact import GearContact
from solver.gear_model import GearModel
from solver.gear_position import SharedPosition, shared_position
from solver.gear_sweep import uniform_pitch
from solver.kinematics import Stand
from wear.gears import GearWear
from wear.law import Archard

POSITIONS, TURN = 60, 1e-3  # rad: the ripple of rolling over elements, as long as this, is not meant
RELIEF = tuple(f"{gear}.tip_relief_{key}" for gear in ("pinion", "wheel") for key in ("um=30", "form=parabolic"))


def stand_of(model: GearModel, found: SharedPosition) -> Stand:
    """Where the gears stand in the solution."""
    return found.contact.stand.turned(model.load.on, float(found.smooth.motion[0]))


def apart(model: GearModel, here: GearContact, found: SharedPosition) -> Floats:
    """(q, d) from the wheel's to the pinion's material points that the contact `here` pairs, in another solution."""
    stand, d, places = stand_of(model, found), here.d, []
    for gear, body in enumerate(model.bodies):
        rows, teeth = here.rows(gear)
        then = found.contact.rows(gear)[0]
        u = body.chain.apply(then, found.contact.pushed(gear, found.smooth.force), rows) @ stand.rotation(gear, d).T
        own = []
        for each, part in zip(here.teeth, teeth):
            pairing, field = each.pairing, np.zeros((len(body.flank.points), d))
            field[each.touched(gear)] = u[part]
            facets, xi = (pairing.facet1, pairing.xi1) if gear == 0 else (pairing.facet2, pairing.xi2)
            X = body.flank.positions(facets, xi[:, None])[:, 0] @ stand.rotation(gear, d, each.tooth).T
            own.append(stand.centre(gear, d) + X + body.flank.hat_matrix(facets, xi) @ field)
        places.append(np.concatenate(own))
    return np.asarray(places[0] - places[1])


@pytest.mark.parametrize(("wheel", "tolerance"), [(206, 0.02), (3, 0.06)])
def test_material_points_followed(wheel: int, tolerance: float) -> None:
    """A steel pinion on a wheel of steel or of plastic, without friction. Two states TURN before and after a position
    say how its pairs of material points slide over one another, and at each tooth the pressure's mean of that is
    (1 + 1/u) ξ + e, within 2 % of the largest |e| with steel (0.06 mm/rad, where the load passes from tooth to tooth;
    the pinion's flank rolls by 27 mm/rad at the pitch point), within 6 % with plastic (0.6 mm/rad)."""
    scene = spur_scene("mesh.level=standard", *RELIEF, f"material.wheel.E_GPa={wheel}", "load.torque_Nm=60")
    model = model_of(scene)
    gears = GearWear(model, uniform_pitch(model.pair.pinion.z, POSITIONS, 0), 0.0, Archard(1e-10, 1e-10), MPI.COMM_SELF)
    state = gears.evaluate(gears.begin)
    found, wanted = [], []
    for k in range(0, POSITIONS, 8):
        angle = gears.pitch.angles[k]
        here = state.shared[k].contact
        sides = [shared_position(model, angle + turn, here.stand.extra, [0.0], None) for turn in (-TURN, TURN)]
        moved = (apart(model, here, sides[1]) - apart(model, here, sides[0])) / (2.0 * TURN)
        pressed = state.shared[k].smooth.traction[:, 0] > 0.0
        α, contact = model.pair.operating_pressure_angle, state.positions[k].contact
        sliding = moved[pressed] @ [-np.cos(α), np.sin(α)] - (1.0 + 1.0 / model.pair.ratio) * contact.ξ
        for tooth in np.unique(contact.tooth):
            own = (contact.tooth == tooth) & ~contact.edge
            if not own.any():
                continue
            force = (contact.weights * contact.pressure)[own]
            found.append(float(force @ contact.elastic[own] / force.sum()))
            wanted.append(float(force @ sliding[own] / force.sum()))
    np.testing.assert_allclose(found, wanted, atol=tolerance * np.abs(wanted).max())
