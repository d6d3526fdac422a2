"""Parts of the computation that a scene does not need: a registry of skips, each with name, sentence and tolerance.

A skip is automatic where it applies. `--exact NAME` (the key exact.parts) computes the part without it; the answer
stays the same within the skip's tolerance. The registry is for what `check`, the log and summary.json say; code that
computes is given options (gear_problem.py, `wanted_output`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace

from evolvent.gears.meshing.flank_levels import LONGEST
from evolvent.gears.meshing.levelled_meshes import has_long_cells, is_large, is_two_level
from evolvent.gears.meshing.sector_sizes import levelled_sizes, one_mesh_sizes
from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.line_level import LINE, RESOLVED_PARTS
from evolvent.scene.scene import Scene
from evolvent.scene.schema.bodies import MeshSection
from evolvent.scene.schema.output import ExactSection, OutputSection, SkipName

ROUND_OFF = 1e-8
"""Tolerance where only the order of sums and the remainder of Newton's method (residual 1e-10) differ."""
REPEATED = 1e-10
"""Tolerance where nothing is computed differently: two runs differ by rounding, as their arrays lie elsewhere in
memory (6e-12 was seen)."""


@dataclass(frozen=True)
class Skip:
    """A part of the computation that may be left out."""

    name: SkipName
    """Name of the skip, as in docs/scene.md."""
    applies: Callable[[Scene], bool]
    """Whether a scene allows the skip."""
    sentence: Callable[[Scene], str]
    """Sentence on the part that is left out, for `check`, the log and summary.json."""
    tolerance: float
    """Largest difference from the result without the skip: of transmission error, peak pressure, torques and lost share
    of the input power, each over its largest value in the pitch."""


@dataclass(frozen=True)
class Skipped:
    """A skip that was made, as in summary.json."""

    name: SkipName
    """Name of the skip, as in docs/scene.md."""
    sentence: str
    """Sentence on the part that is left out, with values of this scene."""


def _always(_: Scene) -> bool:
    return True


def _resolves(scene: Scene) -> bool:
    return scene.mesh.level != LINE


def _pitch_sentence(scene: Scene) -> str:
    pair = scene.gear_pair()
    pitch, whole = 360 / pair.pinion.z, math.degrees(pair.engagement_angle)
    return f"One pitch is solved, {pitch:.2f}° of pinion rotation instead of the {whole:.2f}° of a whole engagement."


def _sector_sentence(scene: Scene) -> str:
    count = " + ".join(str(gear.teeth) for gear in (scene.pinion, scene.wheel))
    return f"One sector of a gear is meshed and factored; it stands for all {count} teeth."


def _teeth_sentence(scene: Scene) -> str:
    return f"Teeth that cannot touch: {len(gear_problem(scene).touching_teeth)} pairs can, and their neighbours."


def _would_have_levels(scene: Scene) -> bool:
    """Whether the flanks have levels of their own where the scene leaves it to the size of the mesh."""
    problem = gear_problem(scene)
    return is_two_level(replace(problem, mesh=replace(problem.mesh, two_level=None)))


def _levels_sentence(scene: Scene) -> str:
    problem = gear_problem(scene)
    one = sum(size.dofs for size in one_mesh_sizes(problem))
    coarse = sum(size.sector.dofs for size in levelled_sizes(problem))
    return (
        f"One fine mesh of each sector: fine cells are condensed in patches of the loaded flank only, on sectors of "
        f"{coarse:,} instead of {one:,} degrees of freedom."
    )


def one_mesh_reason(scene: Scene) -> str:
    """A sentence on a large mesh whose flanks have no levels of their own although the scene leaves that open; else
    empty."""
    problem = gear_problem(scene)
    if "two-level" in scene.exact.parts or problem.is_plane or not is_large(problem):
        return ""
    if scene.wear is not None:
        return "Flanks that wear have no levels of their own (two-level): each sector is one fine mesh."
    if has_long_cells(problem):
        return (
            f"Flank cells over {LONGEST:g} times as long as high before the last division: each sector is one fine "
            "mesh, without levels of its flank (two-level)."
        )
    return ""


def _reuse_sentence(scene: Scene) -> str:
    count = len(scene.contact.friction)
    return f"The stiffness is factored once per gear and reused for all {count} friction coefficients."


def _picture_sentence(scene: Scene) -> str:
    names = [name for name in ("pictures", "animation") if not getattr(scene.output, name)]
    return f"No {' and '.join(names)}, as the section [output] asks."


def _fields_sentence(scene: Scene) -> str:
    if _resolves(scene):
        return "Fields for ParaView, because output.fields is false."
    return "Fields for ParaView and the animation, which need the pressure across the contact."


SKIPS: tuple[Skip, ...] = (
    Skip(
        "plane",
        lambda scene: gear_problem(scene).has_equal_sections,
        lambda _: "The third dimension: a spur pair without lead variation is solved in 2D plane strain.",
        # plane strain is the limit of a wide gear. The ends of a real face are free: there the teeth are softer by up
        # to ν² = 9 %, over a length of about a tooth's thickness
        tolerance=0.05,
    ),
    Skip(
        "friction-terms",
        lambda scene: 0.0 in scene.contact.friction,
        lambda _: "Friction terms where μ = 0: normal components only, no friction history.",
        tolerance=ROUND_OFF,  # the same equations, the tangential ones decoupled
    ),
    # with friction what closing a pitch leaves of where it began: of the peak-to-peak transmission error, of the error
    # itself that is less (Yang's pair 1e-4); without friction 1e-7
    Skip("one-pitch", _always, _pitch_sentence, tolerance=1e-2),
    Skip("one-sector", _always, _sector_sentence, tolerance=ROUND_OFF),  # the ring's coupling is compressed to 1e-10
    Skip(
        "far-teeth",
        _always,
        _teeth_sentence,
        tolerance=ROUND_OFF,
    ),
    Skip(
        "window",
        _resolves,
        lambda _: "The search is kept to a moving window about each contact line.",
        # the projection of the wheel's displacement is cut off at the window's rim, which is felt within an element or
        # two. He's pair: pressure 6e-4 at quick, 3e-4 at standard, 6e-6 at fine; a fiftieth of it in the other figures;
        # 2e-2 on a helical mesh of half an element across the contact, whose pressure is worth nothing anyway
        tolerance=1e-3,
    ),
    Skip(
        "deflected-flanks",
        lambda scene: scene.wear is None and _resolves(scene),  # flanks that wear are followed before deflection
        lambda _: "A second search, on deflected flanks; a pitch that loses energy without it is solved again.",
        # of scenes that balance. He's pair: transmission error 3e-4, at ten times its load 1.3e-3; pressure 3e-3 at
        # quick, 1e-3 at fine, up to 1e-2 on two elements across the contact. Yang's helical pair, unmodified, bears on
        # its tip edges at every position: transmission error 4e-3; pressure beside these edges 4e-2 at quick, 2.5e-2
        # at standard, where its error bar is 5e-2; torque ratio 6e-4, loss 1e-4
        tolerance=5e-2,
    ),
    Skip(
        "coarse-body",
        _always,
        lambda _: "Only the loaded flanks are refined; back flanks, fillets, core and rim of the teeth stay coarse.",
        # what the teeth's bending is wrong by on the coarse body: He's pair 0.3 % at quick, 0.4 at standard, 0.7 at
        # fine, where thinner layers meet the same coarse columns; the back flank alone 0.01 %
        tolerance=1e-2,
    ),
    Skip(
        "two-level",
        lambda scene: scene.wear is None and _would_have_levels(scene),
        _levels_sentence,
        # both ways resolve the contact equally, on different meshes: what differs is their discretisation error. Yang's
        # pair at standard, μ = 0.3: transmission error 9e-4, torques 2e-4, loss 1.3e-3; the largest pressure between
        # its tip-edge zones 0.14, at single positions 0.30: on shorter elements the zones are shorter, and the pressure
        # rises towards the edge. The pair bears on its tip edges at every position
        tolerance=0.35,
    ),
    Skip(
        "reuse", lambda scene: len(scene.contact.friction) > 1 and _resolves(scene), _reuse_sentence,
        tolerance=ROUND_OFF,
    ),
    Skip(
        "error-bars",
        lambda scene: not scene.output.error_bars,
        lambda _: "Error bars and the coarse companion that they come from, because output.error_bars is false.",
        tolerance=REPEATED,
    ),
    Skip(
        "fields",
        lambda scene: not (scene.output.fields and _resolves(scene)),
        _fields_sentence,
        tolerance=REPEATED,
    ),
    Skip(
        "pictures",
        lambda scene: not (scene.output.pictures and scene.output.animation),
        _picture_sentence,
        tolerance=REPEATED,
    ),
)
OF_OUTPUT: tuple[SkipName, ...] = ("error-bars", "fields", "pictures")
"""Skips of output, on which results do not depend."""


def skip_named(name: SkipName) -> Skip:
    """The skip of this name."""
    return next(skip for skip in SKIPS if skip.name == name)


def skips(scene: Scene, name: SkipName) -> bool:
    """Whether a skip is made: it applies and is not switched off."""
    return name not in scene.exact.parts and skip_named(name).applies(scene)


def skipped(scene: Scene) -> list[Skipped]:
    """The skips that a scene makes, each with its sentence."""
    return [Skipped(skip.name, skip.sentence(scene)) for skip in SKIPS if skips(scene, skip.name)]


def switched_off(scene: Scene) -> list[SkipName]:
    """The skips that apply but are switched off."""
    return [skip.name for skip in SKIPS if skip.name in scene.exact.parts and skip.applies(scene)]


def with_deflected_flanks(scene: Scene) -> Scene:
    """The scene with deflected flanks, by which the files of a run show that they were needed. Unchanged where it has
    them already or where they do not apply."""
    if not skips(scene, "deflected-flanks"):
        return scene
    exact = ExactSection(parts=(*scene.exact.parts, "deflected-flanks"))
    return scene.model_copy(update={"exact": exact})


def line_scene(scene: Scene, *parts: SkipName) -> Scene:
    """The scene in line contact, whatever its own level. parts: computed in full beside those that the scene names and
    a line contact has."""
    own = tuple(name for name in scene.exact.parts if name not in RESOLVED_PARTS)
    exact = ExactSection(parts=(*own, *(name for name in parts if name not in own)))
    return scene.model_copy(update={"mesh": MeshSection(level=LINE), "exact": exact})


def wanted_output(scene: Scene) -> OutputSection:
    """Section [output] with all that exact.parts adds: pictures, animation, fields and error bars; without animation
    and fields where no pressure across the contact is computed, in line contact."""
    exact, asked = scene.exact.parts, scene.output
    drawn = "pictures" in exact
    return OutputSection(
        pictures=asked.pictures or drawn,
        animation=(asked.animation or drawn) and _resolves(scene),
        fields=(asked.fields or "fields" in exact) and _resolves(scene),
        error_bars=asked.error_bars or "error-bars" in exact,
        deformation=asked.deformation,
    )
