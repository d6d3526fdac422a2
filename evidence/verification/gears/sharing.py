"""He's spur pair: how long a tooth carries load, and how much of it, against Pedrero's model of load sharing."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from mpi4py import MPI

from evidence.claims import Claim, Verification, analytical, external
from evidence.scenes import spur_pair
from evolvent.gears.gear_model import GearModel, prepare_model
from evolvent.gears.sweep.pitch_sweep import initial_state, sweep_pitch, uniform_pitch
from evolvent.gears.sweep.position_search import shared_position
from evolvent.results.drawing.style import FAINT, INK, PINION, TEETH, WHEEL
from evolvent.scene.gear_problem import gear_problem
from evolvent_meshes.arrays import Bools, Floats
from evolvent_meshes.gears.pair import GearPair

POSITIONS = 40  # a pitch
LIGHT = 1e-3  # of the torque: nearly rigid flanks
RESOLUTION = np.radians(0.002)  # of the ends of the engagement
PAPER = 13.824  # °, whole engagement, He et al. 2022


@dataclass(frozen=True)
class Shares:
    """The load of one tooth pair on its way through the mesh.

    roll:  (n,), base pitches from the pitch point.
    share: (n,), of the load.
    total: (k,), sum of all tooth forces over that of the torque, at positions where no tip edge bears.
    """

    roll: Floats
    share: Floats
    total: Floats


def shares(model: GearModel) -> Shares:
    """A pitch of positions, the teeth put one behind the other."""
    pair, pitch = model.pair, uniform_pitch(model.pair.pinion.z, POSITIONS)
    wanted, rows, totals = model.load.torque / pair.pinion.base_radius, [], []
    for position in sweep_pitch(model, pitch, [0.0], initial_state([0.0])):
        c = position.results[0].contact
        forces = {int(t): float(np.sum((c.pressure * c.weights)[c.tooth == t])) for t in np.unique(c.tooth)}
        total = sum(forces.values())
        if not c.edge.any():
            totals.append(total / wanted)
        rows += [(position.angle * pair.pinion.z / (2.0 * np.pi) + t, f / total) for t, f in forces.items()]
    roll, share = np.array(sorted(rows)).T
    return Shares(roll, share, np.array(totals))


def pedrero(roll: Floats, pair: GearPair) -> Floats:
    """Share of one pair at `roll` base pitches from the pitch point (Pedrero et al. 2010):

    v = cos[b_0(ξ − ξ_m)] along the path of contact, b_0 = [½(1 + ε_α/2)² − 1]^(−½), zero beyond its ends; share
    v(ξ)/Σ_j v(ξ + j). Stiffness of the teeth alone, rigid before and after the path of contact.
    """
    ε = pair.transverse_contact_ratio
    start, end = (x / pair.pinion.transverse_base_pitch for x in pair.path_of_contact)
    factor = (0.5 * (1.0 + 0.5 * ε) ** 2 - 1.0) ** -0.5

    def stiffness(ξ: Floats) -> Floats:
        inside = (ξ > start - 1e-12) & (ξ < end + 1e-12)
        return np.where(inside, np.cos(factor * (ξ - 0.5 * (start + end))), 0.0)

    whole = sum(stiffness(roll + j) for j in (-2, -1, 0, 1, 2))
    return np.asarray(stiffness(roll) / np.maximum(whole, 1e-300))


def engagement_degrees(model: GearModel) -> float:
    """Pinion rotation [°] over which a tooth pair carries load, found by bisection of its first and last contact."""
    pitch, start, end = _turns(model.pair)
    enters = _change(model, start - 0.2 * pitch, start + 0.1 * pitch)
    leaves = _change(model, end - 0.1 * pitch, end + 0.2 * pitch)
    return float(np.degrees(leaves - enters))


def _turns(pair: GearPair) -> tuple[float, float, float]:
    """Pinion rotations [rad]: of a pitch, and of the ends of the path of contact."""
    start, end = pair.path_of_contact
    return 2.0 * np.pi / pair.pinion.z, start / pair.pinion.base_radius, end / pair.pinion.base_radius


def _change(model: GearModel, low: float, high: float) -> float:
    """Rotation from a tooth pair's pitch point at which it begins or ceases to carry load [rad]."""
    early = _carries(model, low)
    if _carries(model, high) == early:
        raise ValueError(f"engagement: wanted contact to change between {low:.4f} and {high:.4f} rad; widen the range")
    while high - low > RESOLUTION:
        middle = 0.5 * (low + high)
        low, high = (middle, high) if _carries(model, middle) == early else (low, middle)
    return 0.5 * (low + high)


def _carries(model: GearModel, rotation: float) -> bool:
    """Whether a tooth pair carries load at this rotation from its pitch point [rad]; solved within the first pitch."""
    pitch = 2.0 * np.pi / model.pair.pinion.z
    tooth = int(np.floor(rotation / pitch))
    position = shared_position(model, rotation - tooth * pitch, (0.0, 0.0), (0.0,), None)
    pressed = position.smooth.traction[:, 0] > 0.0
    return bool(np.any(pressed & (position.contact.geometry.point_tooth == tooth)))


def verify() -> Verification:
    """One pitch at the whole torque; the engagement at the whole and at a thousandth of it."""
    model = prepare_model(gear_problem(spur_pair()), MPI.COMM_SELF).model
    light = replace(model, load=replace(model.load, torque=LIGHT * model.load.torque))
    computed = shares(model)
    angles = engagement_degrees(model), engagement_degrees(light)
    return Verification(
        "sharing",
        "Contact ratio and load sharing of a spur pair",
        "He's pair (50/50 teeth, 170 N·m, no friction, plane strain). A tooth carries load over 12.63° of pinion "
        "rotation if the teeth are rigid, over more because the others give way: 13.824° in He et al. (finite "
        "elements). Within the path of contact two pairs share the load by their stiffness; Pedrero's formula has the "
        "teeth's bending, shear and compression, but neither the gear body (bore and rim), nor the load on the contact "
        "stiffness, nor contact outside the rigid path, so its share jumps at the ends where the computed one goes on "
        "to zero.",
        tuple(_claims(model.pair, computed, angles)),
        lambda figure: _draw(figure, model.pair, computed, angles),
        "Deflection lengthens the engagement; in double contact the shares differ from the formula's by 0.04 at most",
    )


def _claims(pair: GearPair, computed: Shares, angles: tuple[float, float]) -> list[Claim]:
    rigid, loaded, light = np.degrees(pair.engagement_angle), *angles
    alone = np.abs(computed.roll) < 1.0 - 0.5 * loaded / np.degrees(2.0 * np.pi / pair.pinion.z)
    total, lone = (float(np.abs(values - 1.0).max()) for values in (computed.total, computed.share[alone]))
    paper = external("He et al. 2022, finite elements; their bore is not printed")
    tangents = analytical("involute normals are tangents of the base circle")
    stiffness = external("Pedrero et al. 2010; tooth stiffness only")
    return [
        paper.relative("engagement of a tooth, 170 N·m [°]", loaded, PAPER, 0.01),
        analytical("ε_α 360°/z_1 of rigid teeth").relative(
            "engagement of a tooth, 0.17 N·m [°]", light, float(rigid), 0.01
        ),
        tangents.bound("sum of tooth forces over T_1/r_b1 away from tip edges, off by", total, 2e-4),
        analytical("one pair carries all").bound("share of a pair that is alone, off by", lone, 1e-12),
        stiffness.bound("share in double contact, rms off Pedrero's", deviation(pair, computed), 0.05),
    ]


def _double(pair: GearPair, roll: Floats) -> Bools:
    """Where two pairs are on the rigid path of contact."""
    half = 0.5 * pair.transverse_contact_ratio
    return np.asarray((np.abs(roll) < half) & (np.abs(roll) > 1.0 - half))


def deviation(pair: GearPair, computed: Shares) -> float:
    """Root mean square difference of the shares in double contact [-]."""
    here = _double(pair, computed.roll)
    return float(np.sqrt(np.mean((computed.share - pedrero(computed.roll, pair))[here] ** 2)))


def _draw(figure: Figure, pair: GearPair, computed: Shares, angles: tuple[float, float]) -> None:
    top, bottom = figure.subplots(2, 1, height_ratios=(2.6, 1), sharex=True)
    _shares(top, pair, computed, angles[0])
    _deviation(bottom, pair, computed)


def _shares(axes: Axes, pair: GearPair, computed: Shares, degrees: float) -> None:
    half = 0.5 * pair.transverse_contact_ratio
    roll = np.linspace(-1.05, 1.05, 2101)
    axes.plot(roll, pedrero(roll, pair), color=INK, lw=1.3, label="Pedrero, rigid path of contact")
    ratio = degrees * pair.pinion.z / 360.0
    whole = np.concatenate([[-0.5 * ratio], computed.roll, [0.5 * ratio]])
    axes.plot(whole, np.pad(computed.share, 1), "o-", ms=3.2, lw=0.8, color=PINION, label="computed")
    for x, name in zip((-half, half - 1.0, 0.0, 1.0 - half, half), "ABCDE", strict=True):
        axes.axvline(x, color=FAINT, lw=0.8, ls="--")
        axes.text(x, 1.09, name, ha="center", color=INK)
    axes.annotate("", (-0.5 * ratio, 0.06), (0.5 * ratio, 0.06), arrowprops={"arrowstyle": "<->", "color": WHEEL})
    axes.text(0.0, 0.09, f"carries load over {degrees:.2f}°: contact ratio {ratio:.3f} (rigid {2 * half:.3f})",
              ha="center", color=WHEEL)
    axes.set(ylim=(0.0, 1.18), ylabel="share of the load")
    axes.legend(loc="center", bbox_to_anchor=(0.27, 0.82))


def _deviation(axes: Axes, pair: GearPair, computed: Shares) -> None:
    """In double contact, where both have two pairs."""
    axes.axhline(0.0, color=FAINT, lw=0.8)
    off = np.where(_double(pair, computed.roll), computed.share - pedrero(computed.roll, pair), np.nan)
    axes.plot(computed.roll, off, "o-", ms=3.0, lw=0.8, color=TEETH[0])
    axes.set(xlim=(-1.05, 1.05), ylim=(-0.06, 0.06), xlabel="roll distance from the pitch point, in base pitches",
             ylabel="off Pedrero's")
