"""Values that are not allowed: what was meant, or all that is allowed."""

from __future__ import annotations

import pytest

from evolvent.scene.scene import Scene, SceneError, scene_from_text
from evolvent.scene.schema.errors import keys_of
from evolvent.scene.schema.guesses.value_words import VALUE_WORDS
from tests.support.running.scene_effects import BARE


def remedy(setting: str) -> str:
    """The remedy for a setting that is refused."""
    with pytest.raises(SceneError) as caught:
        scene_from_text(BARE, [setting])
    [problem] = caught.value.problems
    return problem.remedy


@pytest.mark.parametrize(
    ("setting", "written"),
    [
        ("load.on=driven", '"wheel"'), ("load.on=driver", '"pinion"'), ("mesh.level=coarse", '"quick"'),
        ("mesh.shape=hexa", '"hexahedron"'), ("mesh.shape=C3D10", '"tetrahedron"'), ("pinion.hand='LH'", '"left"'),
        ("pinion.tip_relief_form=quadratic", '"parabolic"'), ("dynamics.mesh=non-linear", '"force_surface"'),
        ("dynamics.flank_surface=soft", '"through_hardened"'), ("dynamics.flank_surface='case hardened'", '"hardened"'),
        ("transient.start=impact", '"rest"'), ("output.fields=yes", "true"), ("output.fields=Off", "false"),
        ("mesh.level=standart", '"standard"'), ("mesh.shape=hexaedron", '"hexahedron"'),
        ("exact.parts=pictres", '"pictures"'),
    ],
)
def test_the_value_that_was_meant_is_written(setting: str, written: str) -> None:
    """A word that other programs have for a value, or its name misspelled: the value, as the scene writes it."""
    assert remedy(setting) == f"write {written}"


@pytest.mark.parametrize("setting", ["load.on=sun", "mesh.shape=prism", "wear.blocks=adaptive", "pinion.hand=up"])
def test_other_words_have_all_that_is_allowed(setting: str) -> None:
    """Nothing was meant that is known: the remedy names every value, whatever commas stand between them."""
    words = keys_of(Scene)[setting.partition("=")[0]].json_schema_extra
    assert isinstance(words, dict) and "or" in str(words["allowed"])
    assert remedy(setting) in (f"give {words['allowed']}", words["remedy"])


def test_a_linear_mesh_is_explained() -> None:
    """ "linear" is two of the three values of dynamics.mesh: the remedy says which."""
    assert '"tangent" or "secant" for a force linear' in remedy("dynamics.mesh=linear")


def test_remedies_are_whole() -> None:
    """The default remedy is all that is allowed, not cut at a comma."""
    for key, field in keys_of(Scene).items():
        words = field.json_schema_extra
        assert isinstance(words, dict)
        if str(words["remedy"]).startswith("give ") and str(words["allowed"]).startswith(str(words["remedy"])[5:]):
            assert words["remedy"] == f"give {words['allowed']}", key


def test_a_value_word_has_one_meaning() -> None:
    """No word stands for two values."""
    words = [word for group, _ in VALUE_WORDS for word in group.split()]
    assert len(words) == len(set(words)) and all(word == word.lower() for word in words)


def test_limits_of_lists_are_named() -> None:
    """A list with a largest length: what is allowed names it."""
    limited = [
        (key, str(words["allowed"]), limit)
        for key, field in keys_of(Scene).items() if isinstance(words := field.json_schema_extra, dict)
        for limit in (getattr(part, "max_length", None) for part in field.metadata) if limit
    ]
    assert {"strength.gauges.gear", "contact.friction", "wear.report_at_cycles"} <= {key for key, _, _ in limited}
    assert [key for key, allowed, limit in limited if str(limit) not in allowed and key != "pinion.flank_csv"] in (
        [], ["wheel.flank_csv"],
    )


@pytest.mark.parametrize(
    ("percents", "wanted"),
    [
        ("[50.0, 100.0, 100.0]", "give 100 once"), ("[50.0, 200.0]", "add 100, the torque itself"),
        ("[0.0, 100.0]", "leave out 0, which is not above 0 up to 1000"), ("[100.0, 2000.0]", "leave out 2000"),
    ],
)
def test_remedies_on_percents_are_not_done_already(percents: str, wanted: str) -> None:
    """100 that is there already is not to be added."""
    assert remedy(f"dynamics.torque_percents={percents}").startswith(wanted)
    assert remedy("dynamics.map_percents=[50.0, 50.0]") == "give 50 once, or delete the key for no map"
    assert remedy("dynamics.map_percents=[50.0, 300.0]") == "add 300 to torque_percents"
