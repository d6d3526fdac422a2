"""Every key of a scene has an effect, or is refused: no key is accepted and then passed over."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from evolvent.commands.app import main
from evolvent.scene.scene import Scene, SceneError, load_scene, scene_from_text
from evolvent.scene.schema.dependence import dependents, effectless_keys
from evolvent.scene.schema.errors import keys_of
from tests.support.checkout import ROOT
from tests.support.running.scene_effects import BARE, CHARTS, bare_scene, follows_the_same, other_value, setting
from tests.support.scene_texts import DEMOS

NEEDS = {each.key: each for each in dependents(Scene)}
HANDED_ON = {
    "wear.report_at_cycles": "evolvent.wear.gears: when worn pairs are written",
    "wear.tolerance": "evolvent.wear.gears: lengths of blocks",
    "wear.blocks": "evolvent.wear.gears: how a block is computed",
    "wear.first_block_cycles": "evolvent.wear.gears: length of the first block",
    "wear.refresh_um": "evolvent.wear.gears: when meshes follow",
    "transient.start": "evolvent.run.dynamics.transient: initial state",
    "transient.steady_change": "evolvent.run.dynamics.transient: when a motion counts as steady",
    "transient.mode_damping_ratio": "evolvent.run.dynamics.transient: matrix of damping",
    "transient.modes_per_harmonic": "evolvent.run.dynamics.transient: number of modes",
    "transient.spectral_radius": "evolvent.run.dynamics.transient: coefficients of the time scheme",
    "wheel.hand": "the opposite of pinion.hand; another one is refused",
}
"""Keys that nothing before the computation depends on, and the room that is handed their values as they are, or another
reason."""
DEVIATIONS = ["dynamics.base_pitch_deviation_um=6", "dynamics.profile_deviation_um=6"]
LOAD_CASE = [setting("load_case.name", '"a"')]
BESIDE = {
    **{key: LOAD_CASE for key in keys_of(Scene) if key.startswith("load_case.")},
    "pinion.protuberance_um": ["wheel.addendum_coefficient=0.75"],
    "wheel.protuberance_um": ["pinion.addendum_coefficient=0.75"],
    "dynamics.base_pitch_deviation_um": ["dynamics.profile_deviation_um=6"],
    "dynamics.profile_deviation_um": ["dynamics.base_pitch_deviation_um=6"],
    "dynamics.tolerance_class": ["pinion.tip_relief_um=12", "wheel.tip_relief_um=12", *DEVIATIONS],
    "dynamics.flank_surface": DEVIATIONS,
    "dynamics.contact_endurance_MPa": DEVIATIONS,
    "strength.tolerance_class": ["pinion.addendum_coefficient=1.3", "wheel.addendum_coefficient=1.3",
                                 "pinion.dedendum_coefficient=1.55", "wheel.dedendum_coefficient=1.55",
                                 "pinion.teeth=50", "wheel.teeth=60", "pair.centre_distance_mm=165.1"],
}
"""Key -> settings beside which it counts: room for the fillets of a protuberance, both deviations without which there
is no K_v, teeth with tip relief, a contact ratio above 2.05. Tolerance classes are data of gears, and may stand where
the standard does not ask for them."""


REFUSED_BELOW = {"pinion.support_offset_mm", "wheel.support_offset_mm"}
"""Dependent keys that the gears of the Python API refuse, too."""


@pytest.fixture(autouse=True)
def charts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The charts that `flank_csv` names, in the current folder."""
    for name, text in CHARTS.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    monkeypatch.chdir(tmp_path)


def other(key: str) -> str:
    return setting(key, other_value(key))


def mains_of(key: str) -> list[str]:
    """Settings of a key's main key, and of that one's."""
    dependent = NEEDS.get(key)
    if dependent is None or dependent.holding is not None:
        return []
    return [*mains_of(dependent.mains[0]), other(dependent.mains[0])]


@pytest.mark.parametrize("key", [key for key in keys_of(Scene) if key not in HANDED_ON])
def test_every_key_has_an_effect(key: str) -> None:
    """In a scene that has nothing else that is optional, or just the main key that the schema declares, another value
    changes the gears, the models of vibration, root stress and fatigue, the output, or what `check` says."""
    beside = [*BESIDE.get(key, []), *mains_of(key)]
    assert not follows_the_same(scene_from_text(BARE, [*beside, other(key)]), *beside)


@pytest.mark.parametrize("key", [key for key, each in NEEDS.items() if each.holding is None and key not in HANDED_ON])
def test_dependent_keys_are_refused_alone(key: str) -> None:
    """Without its main key a dependent key is refused, in one line that names both and the remedy; and rightly, for
    nothing would change."""
    bare, mains = bare_scene(), NEEDS[key].mains
    with pytest.raises(SceneError) as caught:
        scene_from_text(BARE, [other(key)])
    [problem] = caught.value.problems
    assert problem.key == key and "no effect" in problem.allowed
    assert all(main in problem.allowed and main in problem.remedy for main in mains) and "delete" in problem.remedy
    if key in REFUSED_BELOW:
        return
    section, name = key.split(".")
    given = getattr(scene_from_text(BARE, [*mains_of(key), other(key)]), section)
    changed = getattr(bare, section).model_copy(update={name: getattr(given, name)})
    assert follows_the_same(bare.model_copy(update={section: changed}))


def test_handed_on_and_conditional_keys_are_keys() -> None:
    """The two lists of exceptions name keys that there are."""
    assert HANDED_ON.keys() | BESIDE.keys() <= keys_of(Scene).keys()


def test_the_other_gear_is_named() -> None:
    """The pinion has the relief, its start stands at the wheel: the message says where it belongs. Without an amount on
    either gear it does not."""
    start = "wheel.tip_relief_start_diameter_mm=124.5"
    with pytest.raises(SceneError, match=r"the pinion has tip_relief_um: write it as pinion\.tip_relief_start"):
        scene_from_text(BARE, ["pinion.tip_relief_um=12", start])
    with pytest.raises(SceneError, match=r"remedy: give wheel\.tip_relief_um, or delete the key$"):
        scene_from_text(BARE, [start])


def test_all_dependent_keys_are_reported_together() -> None:
    """Three keys without their main keys: three lines."""
    settings = ["pinion.tip_relief_form=parabolic", "wheel.hub_diameter_mm=60", "dynamics.map_speeds=50"]
    with pytest.raises(SceneError) as caught:
        scene_from_text(BARE, settings)
    assert [each.key for each in caught.value.problems] == [text.partition("=")[0] for text in settings]


def test_keys_that_are_switched_off_are_told() -> None:
    """A study of an amount from 0 on keeps the start of the relief: accepted, as the amount is given, with a sentence.
    So is a tolerance class that only the edition asks for which is left out. With its effect there is no sentence."""
    start = "pinion.tip_relief_start_diameter_mm=64"
    off = effectless_keys(scene_from_text(BARE, ["pinion.tip_relief_um=0", start]))
    assert off == ["pinion.tip_relief_start_diameter_mm = 64 has no effect: pinion.tip_relief_um is 0."]
    assert effectless_keys(scene_from_text(BARE, ["pinion.tip_relief_um=1", start])) == []
    edition = ["strength.tolerance_class=3", "strength.editions=[2019]"]
    assert effectless_keys(scene_from_text(BARE, edition)) == [
        "strength.tolerance_class = 3 has no effect: strength.editions is [2019]."
    ]
    assert effectless_keys(scene_from_text(BARE, edition[:1])) == []


def test_commands_tell_of_keys_that_are_switched_off(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """`check` under its warnings, other commands as a warning before they compute."""
    (tmp_path / "scene.toml").write_text(BARE, encoding="utf-8")
    given = ["--set", "pinion.tip_relief_um=0", "--set", "pinion.tip_relief_start_diameter_mm=64"]
    said = "pinion.tip_relief_start_diameter_mm = 64 has no effect"
    assert main(["check", "scene.toml", *given]) == 0
    out, err = capfd.readouterr()
    assert said in out and not err
    assert main(["mesh", "scene.toml", "--out", "pair.msh", *given]) == 0
    assert f"evolvent: warning: {said}" in capfd.readouterr().err


def test_a_default_that_is_written_out_is_no_choice() -> None:
    """The scene that a run writes has every default: it is read again, with no sentence on any key."""
    for name in ("yang2022", "he2022", "he2022_dynamics"):
        again = scene_from_text(load_scene(DEMOS / f"{name}.toml").resolved_toml())
        assert effectless_keys(again) == []


def test_docs_name_the_main_keys() -> None:
    """docs/scene.md says at each dependent key what it needs."""
    docs = (ROOT / "docs" / "scene.md").read_text(encoding="utf-8")
    for key, dependent in NEEDS.items():
        row = re.search(rf"^\| `{re.escape(key)}` \|(.*)\|$", docs, re.MULTILINE)
        assert row is not None and f"; only with {dependent.wanted} |" in row[1], key
