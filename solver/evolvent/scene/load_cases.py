"""The list of loads of a scene, and the scene under each of them.

A list is given as load cases or as parts of the torque in percent. Percents become load cases here, so that all that
computes a list knows these alone.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from evolvent.scene.gear_problem import gear_problem
from evolvent.scene.scene import Scene, SceneError, scene_from_values
from evolvent.scene.schema.errors import InputProblem, shown


@dataclass(frozen=True)
class LoadCase:
    """A load of a list."""

    name: str
    """Name in tables: that of a [[load_case]], or the part of the scene's torque, as "50 %"."""
    label: str
    """Name as a part of the name of a folder, different for each load of a list."""
    torque_Nm: float
    """Torque on the gear that the scene names."""
    misalignment_um: float
    """Opening of the flanks over the face width."""
    speed_rpm: float | None = None
    """Speed of the pinion; None where it is not given."""
    share_of_life: float | None = None
    """Share of the life; None where it is not given."""


def with_list(scene: Scene, percents: Sequence[float] = (), default: Sequence[float] = (100.0,)) -> Scene:
    """The scene with a list of loads: parts of its torque that are given [%], its own list, or parts by default. Raises
    SceneError for parts that are given beside load cases."""
    if not scene.load_case:
        return scene.changed("load", percents=tuple(percents or scene.load.percents or default))
    if percents:
        found = f"{shown(list(percents))} beside the sections [[load_case]] of the scene"
        remedy = "leave --percent out, or delete the load cases"
        raise SceneError([InputProblem("--percent", found, "one list of loads", remedy)])
    return scene


def load_cases(scene: Scene) -> tuple[LoadCase, ...]:
    """The loads that a scene lists, the lightest first; none where it lists none."""
    own = scene.pair.misalignment_um
    given = [
        LoadCase(
            each.name, each.name, each.torque_Nm, own if each.misalignment_um is None else each.misalignment_um,
            each.speed_rpm, each.share_of_life,
        ) for each in scene.load_case
    ]
    return tuple(sorted(given or parts_of_torque(scene, scene.load.percents), key=lambda case: case.torque_Nm))


def misalignment_refusal(cases: Sequence[LoadCase]) -> InputProblem | None:
    """Problem of loads of different misalignment, which have no mesh in common; None where they have one."""
    misalignments = dict.fromkeys(case.misalignment_um for case in cases)
    if len(misalignments) == 1:
        return None
    found, allowed = shown(list(misalignments)), "one misalignment for all loads of a mesh"
    remedy = "take a scene for each misalignment, or `evolvent loads` or `losses`, which take all of them"
    return InputProblem("load_case.misalignment_um", found, allowed, remedy)


def parts_of_torque(scene: Scene, percents: Sequence[float]) -> list[LoadCase]:
    """Loads that are parts of a scene's torque [%]."""
    return [
        LoadCase(f"{shown(each)} %", _label(each), scene.load.torque_Nm * each / 100.0, scene.pair.misalignment_um)
        for each in percents
    ]


def _label(percent: float) -> str:
    """Part of the name of a folder, different for each percentage."""
    whole, point, decimals = str(float(percent)).partition(".")
    return f"{whole:0>3}{point}{decimals}_percent"


def under_cases(scene: Scene) -> dict[LoadCase, Scene]:
    """Each load that a scene lists, the lightest first -> the scene under it, without the list, on meshes that serve
    all of them: in space where one of them is misaligned. Raises SceneError where one of them is refused."""
    cases = load_cases(scene)
    served = cases[0].torque_Nm, cases[-1].torque_Nm
    bare = scene.changed("load", percents=()).model_copy(update={"load_case": ()})
    under = {
        case: under_torque(bare.changed("pair", misalignment_um=case.misalignment_um), case.torque_Nm, served)
        for case in cases
    }
    plane = [gear_problem(each).is_plane for each in under.values()]
    if all(plane):
        return under
    return {case: _in_space(each) if flat else each for flat, (case, each) in zip(plane, under.items())}


def _in_space(scene: Scene) -> Scene:
    """The scene in space, though it could be solved in the plane."""
    return scene.changed("exact", parts=(*scene.exact.parts, "plane"))


def in_space_sentence(scene: Scene, under: Iterable[Scene]) -> Iterator[str]:
    """A sentence on loads that are in space because others are misaligned, if any is. under: scene under each load."""
    if any("plane" in each.exact.parts for each in under) and "plane" not in scene.exact.parts:
        yield (
            "In space under all loads, as the pair is misaligned under some: the transmission error of a spur pair "
            "differs from that in the plane by some per cent."
        )


def under_torque(scene: Scene, torque: float, mesh_torques: tuple[float, float] | None = None) -> Scene:
    """The scene under another torque [N·m], on meshes for a range of torques [N·m] or for this one alone. Raises
    SceneError, which says what part of the scene's own torque is refused."""
    values = scene.model_dump(exclude_none=True)
    load = {name: value for name, value in values["load"].items() if name != "mesh_torques_Nm"}
    served = {} if mesh_torques is None else {"mesh_torques_Nm": mesh_torques}
    try:
        return scene_from_values({**values, "load": {**load, "torque_Nm": torque, **served}})
    except SceneError as error:
        own = scene.load.torque_Nm
        part = f"{shown(own)}, at {100.0 * torque / own:.6g} % of it "
        raise SceneError([
            replace(each, found=part + each.found) if each.key == "load.torque_Nm" else each for each in error.problems
        ]) from error
