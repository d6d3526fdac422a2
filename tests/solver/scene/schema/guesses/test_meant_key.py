"""Words of users for keys: each names the key that it means, and no key of another quantity."""

from __future__ import annotations

from collections import Counter
from typing import Any

import pytest

from evolvent.run.study.plan.study_file import StudyFile
from evolvent.scene.scene import Scene, SceneError, scene_from_text
from evolvent.scene.schema.errors import InputProblem, key_problem, keys_of, section_of
from evolvent.scene.schema.guesses.gear_terms import GEAR_TERMS
from evolvent.scene.schema.guesses.other_terms import LIST_TERMS, OTHER_TERMS, SECTION_TERMS, STUDY_TERMS
from evolvent.scene.schema.guesses.terms import Term
from evolvent.scene.schema.guesses.units import stem_of
from tests.support.running.scene_effects import BARE

TERMS = (*GEAR_TERMS, *OTHER_TERMS)
KEYS = keys_of(Scene)
SECTIONS = {name for name, field in Scene.model_fields.items() if section_of(field)} | {
    "material.pinion", "material.wheel", "strength.gauges"}


def problem(key: str, value: Any = 1.0) -> InputProblem:
    """What is said of an unknown key."""
    found = key_problem(key, value, Scene)
    assert found is not None, f"{key} is a key"
    return found


def places(word: str, term: Term) -> list[str]:
    """Unknown dotted keys with a word, in the sections where it has this meaning."""
    section, dot, name = word.partition(".")
    if dot:
        sections = ["pinion", "wheel"] if section == "gear" else [section]
        return [key for each in sections if (key := f"{each}.{name}") not in KEYS]
    own = {key.partition(".")[0].replace("gear", "pinion") for key in term.keys if "." in key} or {"pair"}
    return [key for each in (*own, "sweep") if (key := f"{each}.{word}") not in KEYS]


def expected(term: Term, section: str) -> list[str]:
    """The keys that a message has to name."""
    gears = [section] if section in ("pinion", "wheel") else ["pinion", "wheel"]
    return [key.replace("gear.", f"{gear}.", 1) for key in term.keys
            for gear in (gears if key.startswith("gear.") else gears[:1])]


@pytest.mark.parametrize("term", TERMS, ids=lambda term: term.words.split()[0])
def test_each_word_of_the_tables_names_its_keys(term: Term) -> None:
    """Each word, in the sections of its keys and in another one: its keys, in the gear where it stands or in both; or
    that there is none, and why."""
    for word in term.words.split():
        for key in places(word, term):
            if any(each is not term and f"{key.split('.')[0]}.{word}" in each.words.split() for each in TERMS):
                continue  # the word means something else in this section
            remedy = problem(key).remedy
            wanted = expected(term, key.partition(".")[0])
            section, _, name = key.rpartition(".")
            if same := [each for each in KEYS if each.startswith(f"{section}.") and stem_of(each) == name]:
                assert remedy.startswith(f"did you mean {same[0]}?"), (key, remedy)  # the unit alone is missing
                continue
            assert not wanted or remedy.startswith(f"did you mean {' or '.join(wanted)}"), (key, remedy)
            assert term.note in remedy, (key, remedy)
            assert wanted or remedy == f"delete it: {term.note}", (key, remedy)


def test_keys_of_the_tables_are_keys() -> None:
    """Each key that a table names is one of the scene, or a section; a term without a key says why."""
    for term in (*TERMS, *SECTION_TERMS, *LIST_TERMS):
        for key in term.keys:
            assert key.replace("gear.", "pinion.", 1) in KEYS.keys() | SECTIONS, key
        assert term.keys or term.note
    for term in STUDY_TERMS:
        assert all(key in StudyFile.model_fields for key in term.keys)


def test_a_word_has_one_meaning_in_a_section() -> None:
    """No word stands in two terms, and none is a key where it is looked up."""
    for terms in (TERMS, SECTION_TERMS, STUDY_TERMS):
        counts = Counter(word for term in terms for word in term.words.split())
        assert [word for word, count in counts.items() if count > 1] == []
        assert all(word == word.lower() for word in counts)


REPORTED = {
    "pinion.addendum_modification": "did you mean pinion.profile_shift (",
    "pinion.addendum_modification_coefficient": "did you mean pinion.profile_shift (",
    "pinion.pitch_diameter_mm": "delete it: d = z m_n/cos β follows from teeth",
    "pinion.tip_relief_length_mm": "did you mean pinion.tip_relief_start_diameter_mm (",
    "pinion.root_relief_length_mm": "did you mean pinion.root_relief_end_diameter_mm (",
    "pinion.axial_offset_mm": "delete it: an axial offset of the gears is not supported",
    "pair.axial_offset_mm": "delete it: an axial offset of the gears is not supported",
    "pair.gear_ratio": "delete it: the ratio follows from pinion.teeth and wheel.teeth",
    "pair.ratio": "delete it: the ratio follows from",
    "pair.inclination_um": "did you mean pair.misalignment_um (",
    "pair.clearance_mm": "did you mean pinion.dedendum_coefficient or wheel.dedendum_coefficient (",
    "pair.diametral_pitch": "did you mean pair.normal_module_mm (25.4/P_nd",
    "gear.teeth": "did you mean wheel?",
    "material.gear.E_GPa": "did you mean material.wheel?",
    "rack.teeth": "delete it: a rack as a gear is not supported",
    "wear.coefficient": "did you mean wear.pinion_mm2_per_N or wear.wheel_mm2_per_N (",
    "mesh.size_mm": "did you mean mesh.elements_per_contact_width (",
    "load.force_N": "did you mean load.torque_Nm (T = F_t d/2",
    "dynamics.damping": "did you mean dynamics.damping_ratio (",
    "transient.rpm": "did you mean transient.speeds_rpm (",
    "transient.damping": "did you mean transient.mode_damping_ratio (",
    "transient.damping_ratio": "did you mean dynamics.damping_ratio?",
    "load.speed_rpm": "did you mean dynamics.operating_rpm or transient.speeds_rpm (",
    "load.n1": "did you mean dynamics.operating_rpm or transient.speeds_rpm (",
    "load.rpm": "did you mean dynamics.operating_rpm or transient.speeds_rpm (",
    "dynamics.speeds_rpm": "did you mean dynamics.speed_rpm or dynamics.operating_rpm or transient.speeds_rpm (",
    "pinion.Ra_um": "delete it: roughness is not supported",
    "wheel.Rz": "delete it: roughness is not supported",
    "pinion.Ca": "did you mean pinion.tip_relief_um?",
    "pinion.Calpha_um": "did you mean pinion.profile_crowning_um?",
    "pinion.LCa_mm": "did you mean pinion.tip_relief_start_diameter_mm (",
    "pinion.dCa": "did you mean pinion.tip_relief_start_diameter_mm (",
    "pinion.end_relief_I_um": "did you mean pinion.end_relief_um?",
    "pinion.hfP_star": "did you mean pinion.dedendum_coefficient (",
    "pinion.rho_fP_star": "did you mean pinion.rack_tip_radius_mm (",
    "wheel.dNf": "delete it: the active profile follows from",
    "wheel.dNa": "delete it: the active profile follows from",
    "pair.jbn": "delete it: backlash follows from",
    "pair.sum_x": "delete it: the sum of the profile shifts follows from",
    "pair.fsh": "did you mean pair.misalignment_um (",
    "pinion.E_sns": "did you mean pinion.tooth_thickness_allowance_um (",
    "pinion.E": "did you mean material.E_GPa (of one gear in [material.pinion]",
    "pair.Q": "did you mean strength.tolerance_class or dynamics.tolerance_class (",
    "load.T_nom": "did you mean load.torque_Nm (",
    "dynamics.pinion_inertia_kgm2": "did you mean dynamics.pinion_inertia_kg_m2?",
    "pinion.material": "delete it: there is no list of materials: give material.E_GPa and material.nu",
    "teeth": "did you mean pinion.teeth or wheel.teeth?",
    "torque_Nm": "did you mean load.torque_Nm",
}


@pytest.mark.parametrize("key", REPORTED)
def test_reported_words_name_what_was_meant(key: str) -> None:
    """Words that had the hint of another quantity, or that there is no time in [transient]."""
    with pytest.raises(SceneError) as caught:
        scene_from_text(BARE.replace("[transient]\nspeeds_rpm = [1500.0]\n", ""), [f"{key}=1"])
    assert any(each.remedy.startswith(REPORTED[key]) for each in caught.value.problems), caught.value


@pytest.mark.parametrize(
    "key",
    [
        "pinion.xyzzy", "pinion.factor", "wheel.tooths_mm", "pinion.diameter_mm", "pair.number", "pair.angle_deg",
        "material.grade_of_quality", "mesh.foo", "load.torque_J", "sweep.velvet", "wear.limit", "dynamics.limit",
        "strength.tolerance", "output.colour", "pinion.relief_um", "pinion.root_mm",
        "wheel.end_um", "pinion.length_mm", "pinion.tolerance", "pair.start", "xyz",
        "transient.noise", "dynamics.velocity_of_sound_m",
    ],
)
def test_words_of_no_known_meaning_have_no_hint(key: str) -> None:
    """A word that is near to no key of its section, or to several: no key is named."""
    assert problem(key).remedy == "delete it, or see docs/scene.md"


@pytest.mark.parametrize(
    ("key", "then"),
    [
        ("load.torque_Nmm", "divide by 1000"), ("load.torque_kNm", "multiply by 1000"),
        ("load.torque_lbf_in", "multiply by 0.1129848"), ("load.torque_lbf_ft", "multiply by 1.355818"),
        ("material.E_MPa", "divide by 1000"), ("material.E_Pa", "divide by 1e9"),
        ("material.E_psi", "multiply by 6.894757e-06"),
        ("pinion.tip_relief_mm", "multiply by 1000"), ("pinion.tip_relief_in", "multiply by 25400"),
        ("pinion.face_width_in", "multiply by 25.4"), ("pinion.face_width_m", "multiply by 1000"),
        ("pair.helix_angle_rad", "multiply by 180/π"), ("transient.speeds_rad_s", "multiply by 30/π"),
        ("dynamics.density_g_cm3", "multiply by 1000"), ("dynamics.density_t_mm3", "multiply by 1e+12"),
        ("dynamics.pinion_inertia_kg_mm2", "divide by 1000000"),
        ("dynamics.series_stiffness_N_per_m", "divide by 1000000"),
        ("wear.pinion_m2_per_N", "multiply by 1000000"), ("wear.pinion_mm3_per_Nm", "divide by 1000"),
    ],
)
def test_units_are_converted(key: str, then: str) -> None:
    """The key with another unit: what makes its value one in the unit of the scene. 1 lbf·in = 0.1129848 N·m, 1 in =
    25.4 mm, 1 psi = 6894.757 Pa."""
    assert f"? Then {then}; else delete it" in problem(key).remedy


def test_keys_that_are_spelled_alike_are_told_apart() -> None:
    """Nearly the same spelling within the section counts, word by word; in another section nothing but the same name
    does."""
    assert "did you mean pinion.root_relief_um?" in problem("pinion.root_relif_um").remedy
    assert "did you mean pair.normal_module_mm?" in problem("pair.normal_modul_mm").remedy
    assert "did you mean pinion.face_width_mm?" in problem("pinion.facewidth").remedy
    assert "did you mean fatigue.yield_stress_MPa" in problem("material.yield_stress_MPa").remedy
    assert "did you mean" not in problem("mesh.face_widht_mm").remedy
    assert "did you mean dynamics.speed_rpm or" in problem("dynamics.speeds_rpm").remedy  # speeds is a number of them
    assert "did you mean load?" in problem("laod", {"torque_Nm": 1}).remedy
