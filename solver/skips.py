"""What a scene does not need, each as one sentence for `check`, the log and summary.json."""

from __future__ import annotations

import math

from solver.scene import Scene


def is_plane(scene: Scene) -> bool:
    """True if every transverse section is the same: a spur pair of one face width without lead variation."""
    gears = scene.pinion, scene.wheel
    varies = scene.pair.helix_angle_deg, scene.pair.misalignment_um, *(gear.lead_crowning_um for gear in gears)
    return not any(varies) and gears[0].face_width_mm == gears[1].face_width_mm


def touching_teeth(scene: Scene) -> range:
    """The tooth pairs that can touch while the pinion turns from 0 by one pitch, rigid flanks."""
    pair = scene.gear_pair()
    last = pair.teeth_in_contact(0.0)
    first = pair.teeth_in_contact(2 * math.pi / pair.pinion.z)
    return range(first[0], last[-1] + 1)


def skipped(scene: Scene) -> list[str]:
    """One sentence for each skip that applies to the scene."""
    pair, teeth = scene.gear_pair(), len(touching_teeth(scene))
    pitch, whole = 360 / pair.pinion.z, math.degrees(pair.engagement_angle)
    sentences = [
        f"One pitch is solved, {pitch:.2f}° of pinion rotation instead of the {whole:.2f}° of a whole engagement.",
        f"One sector of a gear is meshed and factored; it stands for all {pair.pinion.z} + {pair.wheel.z} teeth, "
        f"of which {teeth} pairs can touch.",
        "Only the loaded flanks are refined and searched for contact, and these only near their contact lines.",
    ]
    if is_plane(scene):
        sentences.append("The third dimension: a spur pair without lead variation is solved in 2D plane strain.")
    if 0.0 in scene.contact.friction:
        sentences.append("Friction terms and warm-up positions where μ = 0; the system is symmetric.")
    if len(scene.contact.friction) > 1:
        count = len(scene.contact.friction)
        sentences.append(f"The stiffness is factored once a gear and reused for all {count} friction coefficients.")
    if not scene.output.fields:
        sentences.append("Fields for ParaView, because output.fields is false.")
    if not (scene.output.pictures and scene.output.animation):
        names = [name for name in ("pictures", "animation") if not getattr(scene.output, name)]
        sentences.append(f"No {' and '.join(names)}, as the section [output] asks.")
    return sentences
