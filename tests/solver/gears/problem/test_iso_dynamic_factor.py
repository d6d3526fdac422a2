"""K_v of ISO 6336-1, Method B, against its formulas worked by hand, and a published example."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from evolvent.gears.problem.gear_inertia import equivalent_mass
from evolvent.gears.problem.iso_dynamic_factor import Accuracy, MethodB, coefficients, method_b, running_in, worn_relief
from evolvent_meshes.errors import InputError
from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.modifications.modifications import Modifications
from evolvent_meshes.gears.pair import GearPair
from tests.solver.gears.problem.test_iso_stiffness import example_pair, he_pair

MASS, FORCE = 0.7701e-3, 2412.0  # t, N: He's pair


def he(accuracy: Accuracy | None = None, force: float = FORCE) -> MethodB:
    return method_b(he_pair(), MASS, force, accuracy or Accuracy(0.0, 0.0))


def relieved(pinion: float, wheel: float) -> GearPair:
    """He's pair with so much tip relief [µm]."""
    gears: list[GearParameters] = [
        replace(gear, modifications=Modifications(um, gear.tip_diameter - 3.0) if um else Modifications())
        for gear, um in zip(he_pair().gears, (pinion, wheel))
    ]
    return GearPair(gears[0], gears[1], 150.0)


def test_resonance_speed() -> None:
    """n_E1 = 30/(π z_1) √(k/m_e) with k = c_γα b, the whole stiffness: the natural speed of the oscillator whose
    stiffness is the standard's. 4566 r/min for He's pair."""
    found = he()
    stiffness = 1e3 * found.mesh_stiffness * 20.0
    assert found.resonance_speed == pytest.approx(30.0 / (np.pi * 50.0) * np.sqrt(stiffness / MASS), rel=1e-12)
    assert found.resonance_speed == pytest.approx(4566.1, abs=0.1)
    assert found.line_load == pytest.approx(FORCE * np.cos(np.radians(20.0)) / 20.0, rel=1e-12)


def test_ranges_of_perfect_gears() -> None:
    """Without deviations and relief B_k = 1 alone: 1 + 0.23 N, 1.90 in the main resonance, C_v7 above 1.5, and halfway
    between at N = 1.325. With C_v7 = 0.125 sin(π (ε_γ − 2)) + 0.875."""
    found = he()
    ratio, end = found.resonance_speed, 0.125 * np.sin(np.pi * (found.total_contact_ratio - 2.0)) + 0.875
    assert found.main_resonance == (0.85, 1.15)
    for N, factor in ((0.4, 1.092), (0.85, 1.1955), (0.86, 1.9), (1.15, 1.9), (1.325, (1.9 + end) / 2.0), (2.0, end)):
        assert found.factor(N * ratio) == pytest.approx(factor, rel=1e-9)


@pytest.mark.parametrize("accuracy", [Accuracy(), Accuracy(8.0), Accuracy(profile_deviation=6.0)])
def test_no_factor_without_deviations(accuracy: Accuracy) -> None:
    """K_v of perfect gears, down to 0.77 above resonance, is none of real ones: without both f_pb and f_fα it is not
    known at any speed, stiffness and resonance speed are."""
    found = he(accuracy)
    assert not found.has_factor
    assert all(np.isnan(found.factor(N * found.resonance_speed)) for N in (0.4, 1.0, 1.3, 2.0))
    assert found.resonance_speed == he().resonance_speed and he().has_factor


def test_deviations_count_over_the_line_load() -> None:
    """f_pb = 8 µm, f_fα = 6 µm, run in by 7.5 %: B_p = c' · 7.4/w, B_f = c' · 5.55/w, with 0.32 and 0.34 below and in
    the resonance, 0.47 and 0.47 above."""
    perfect, found = he(), he(Accuracy(8.0, 6.0))
    per_um = found.single_stiffness / found.line_load
    below, above = per_um * (0.32 * 7.4 + 0.34 * 5.55), per_um * (0.47 * 7.4 + 0.47 * 5.55)
    for N, more in ((0.5, 0.5 * below), (1.0, below), (1.6, above)):
        speed = N * found.resonance_speed
        assert found.factor(speed) - perfect.factor(speed) == pytest.approx(more, rel=1e-9)


def test_relief_counts_where_it_is_at_both_ends() -> None:
    """B_k = |1 − c' C_a/w| with the smaller relief of both gears; 1 from tolerance class 6 on; of unrelieved gears of
    known σ_Hlim with C_ay."""
    found = method_b(relieved(6.0, 4.0), MASS, FORCE, Accuracy())
    assert found.relief_term == pytest.approx(abs(1.0 - 4.0 * found.single_stiffness / found.line_load), rel=1e-12)
    assert method_b(relieved(6.0, 0.0), MASS, FORCE, Accuracy()).relief_term == 1.0
    assert method_b(relieved(6.0, 4.0), MASS, FORCE, Accuracy(tolerance_class=6)).relief_term == 1.0
    assert method_b(relieved(6.0, 4.0), MASS, FORCE, Accuracy(tolerance_class=5)).relief_term == found.relief_term
    assert he(Accuracy(endurance=1500.0)).relief == worn_relief(1500.0) == pytest.approx(1.9954, abs=1e-4)


def test_light_loads_resonate_earlier() -> None:
    """At 25 N/mm N_S = 0.5 + 0.35 √¼ = 0.675."""
    force = 25.0 * 20.0 / np.cos(np.radians(20.0))
    assert he(force=force).main_resonance[0] == pytest.approx(0.675, rel=1e-12)


def test_coefficients_of_high_contact_ratios() -> None:
    """At ε_γ = 2 the two branches of the table meet to 5 %; at 2.5 and 3 they are those of the formulas by hand."""
    below, above = np.array(coefficients(2.0)), np.array(coefficients(2.0 + 1e-9))
    assert above == pytest.approx(below, rel=0.08)
    assert coefficients(3.0) == pytest.approx((0.32, 0.57 / 2.7, 0.096 / 1.44, 0.42 / 1.56, 0.47, 0.12 / 1.26, 1.0))
    assert coefficients(1.4)[6] == 0.75 and coefficients(1.5 + 1e-9)[6] == pytest.approx(0.75, abs=1e-6)
    with pytest.raises(ValueError, match="contact ratio from 1, found"):
        coefficients(0.9)


def test_running_in() -> None:
    """Clause 8 by hand: 7.5 % up to 3 µm of hardened teeth; 27.5 % of cast iron, at most 22 µm above 5 m/s and 11 µm
    above 10 m/s; 160/σ_Hlim of through hardened ones, at most 12800/σ_Hlim and half of it, never more than the
    deviation."""
    steel = Accuracy(surface="through_hardened", endurance=640.0)
    assert running_in(20.0, Accuracy(), 50.0) == pytest.approx(1.5) and running_in(100.0, Accuracy(), 1.0) == 3.0
    assert running_in(100.0, steel, 5.0) == pytest.approx(25.0)
    assert [running_in(100.0, steel, v) for v in (8.0, 12.0)] == pytest.approx([20.0, 10.0])
    iron = Accuracy(surface="cast_iron")
    assert [running_in(100.0, iron, v) for v in (5.0, 8.0, 12.0)] == pytest.approx([27.5, 22.0, 11.0])
    assert running_in(10.0, replace(steel, endurance=120.0), 1.0) == 10.0
    with pytest.raises(ValueError, match="σ_Hlim"):
        Accuracy(surface="through_hardened")


def test_example_of_the_standard() -> None:
    """ISO/TR 6336-30:2017, example 1, at 360 r/min under 9 kN·m with 70 µm of relief: K_v = 1.003, to its last digit
    with deviations of 7 to 10 µm, which are not known here; its bodies are taken to be solid, of steel."""
    bare = example_pair()
    pinion, wheel = (replace(g, modifications=Modifications(70.0, g.tip_diameter - 8.0)) for g in bare.gears)
    pair = GearPair(pinion, wheel, 500.0)
    moments = [7850e-12 * 100.0 * np.pi / 2.0 * (gear.reference_diameter / 2.0) ** 4 for gear in pair.gears]
    mass, force = equivalent_mass(pair, (moments[0], moments[1])), 9e6 / pair.pinion.base_radius
    for deviation in (7.0, 10.0):
        found = method_b(pair, mass, force, Accuracy(deviation, deviation)).factor(360.0)
        assert found == pytest.approx(1.003, abs=5e-4)


@pytest.mark.parametrize(("wrong", "words"), [
    ({"surface": "hard"}, "surface: wanted 'hardened' or 'through_hardened' or 'cast_iron', found 'hard'"),
    ({"base_pitch_deviation": "5"}, "base_pitch_deviation: wanted None or a number from 0 on, in µm"),
    ({"tolerance_class": 13}, "tolerance_class: wanted None or 1"), ({"endurance": 1.5}, "endurance: wanted None or"),
])
def test_an_accuracy_that_cannot_be_is_refused(wrong: dict[str, Any], words: str) -> None:
    """InputError names field, value and remedy; an unknown surface would be taken for a through hardened one."""
    with pytest.raises(InputError, match=words):
        Accuracy(**wrong)
