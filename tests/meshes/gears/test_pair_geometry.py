"""Derived quantities against the printed figures of the three papers, and every rule of validation."""

import math
from dataclasses import replace

import numpy as np
import pytest

from evolvent_meshes.gears.gear import GearParameters
from evolvent_meshes.gears.pair import GearPair
from tests.support.paper_pairs import he, yang, zhang


def figures(pair: GearPair) -> dict[str, float]:
    """Every figure of the reference table, by its symbol."""
    result: dict[str, float] = {
        "alpha_t": math.degrees(pair.pinion.transverse_pressure_angle),
        "alpha_wt": math.degrees(pair.working_pressure_angle),
        "p_bt": pair.pinion.transverse_base_pitch,
        "eps_alpha": pair.transverse_contact_ratio,
        "eps_beta": pair.overlap_ratio,
        "eps_gamma": pair.total_contact_ratio,
        "beta_b": math.degrees(pair.pinion.base_helix_angle),
        "engagement": math.degrees(pair.engagement_angle),
    }
    for i, gear in enumerate(pair.gears):
        result |= {
            f"d{i + 1}": gear.reference_diameter,
            f"r_b{i + 1}": gear.base_radius,
            f"s_an{i + 1}": gear.normal_thickness(gear.tip_diameter),
            f"s_at{i + 1}": gear.transverse_thickness(gear.tip_diameter),
            f"d_Nf{i + 1}": pair.active_start_diameters[i],
            f"d_w{i + 1}": pair.working_pitch_diameters[i],
            f"h_f{i + 1}": gear.dedendum_coefficient,
            f"h_a{i + 1}": pair.addendum_coefficients[i],
        }
    return result


# printed figures, symbol and value; "~": one unit of the last digit is allowed
YANG = (
    "d1 40.818 d2 144.063 r_b1 19.1994 r_b2 67.7626 alpha_t 19.8241 alpha_wt 20.7598 p_bt 7.0961 eps_alpha 1.7740 "
    "eps_beta 1.2419 eps_gamma 3.0159 s_an1 0.693 s_an2 1.346~ d_Nf1 38.540 d_Nf2 140.607 beta_b 27.5402 d_w1 41.065 "
    "d_w2 144.935 h_f1 1.60 h_f2 1.60 h_a1 1.30 h_a2 1.35 engagement 63.9"
)
HE = (
    "d1 150 d2 150 r_b1 70.4769 r_b2 70.4769 alpha_t 20 alpha_wt 20 p_bt 8.8564 eps_alpha 1.7547 s_an1 2.326 "
    "s_an2 2.326 d_Nf1 145.420 d_Nf2 145.420"
)
ZHANG = (
    "d1 75.9 d2 105.8 r_b1 36.0926 r_b2 50.3109 alpha_t 18 alpha_wt 19.2136 p_bt 6.8720 eps_alpha 2.1413 s_an1 1.081 "
    "s_an2 1.290 d_Nf1 73.098 d_Nf2 102.452 h_f1 1.57 h_f2 1.50 h_a1 1.25 h_a2 1.32"
)


@pytest.mark.parametrize(
    ("pair", "printed"), [(yang(), YANG), (he(), HE), (zhang(), ZHANG)], ids=["Yang", "He", "Zhang"]
)
def test_every_printed_figure_to_the_last_digit(pair: GearPair, printed: str) -> None:
    """Problem: the data of a paper. Solution: the figures of reference-numbers, section C, to their last digit.

    The table's working pressure angles follow from the profile shifts (no backlash), not from the rounded centre
    distance, which would give 20.7597 and 19.2132 degrees: the figures are taken at the tight centre distance, 0.07 and
    0.19 µm off the printed one. One exception: the wheel's tip thickness of Yang is 1.34549, printed 1.346.
    """
    assert pair.tight_centre_distance == pytest.approx(pair.centre_distance, abs=2e-4)
    computed = figures(replace(pair, centre_distance=pair.tight_centre_distance))
    words = printed.split()
    for symbol, text in zip(words[::2], words[1::2], strict=True):
        digits = len(text.rstrip("~").partition(".")[2])
        if text.endswith("~"):
            assert abs(computed[symbol] - float(text[:-1])) < 10.0**-digits, symbol
        else:
            assert f"{computed[symbol]:.{digits}f}" == text, symbol


def test_contact_ratio_of_the_larger_tip_circle() -> None:
    """He prints a contact ratio of 1.77, which belongs to a tip diameter of 156.06 mm, not of 156."""
    assert f"{he(156.06).transverse_contact_ratio:.2f}" == "1.77"


def test_contact_line_length_over_a_pitch() -> None:
    """Yang: 31.18 to 34.65 mm, mean 33.81 mm = ε_α b / cos β_b exactly; a spur pair: b times 1 or 2 lines."""
    pair = yang()
    lengths = [pair.contact_line_length(phi) for phi in np.linspace(0.0, 2.0 * math.pi / 17, 4001)[:-1]]
    exact = pair.transverse_contact_ratio * pair.face_width / math.cos(pair.pinion.base_helix_angle)
    assert f"{min(lengths):.2f} {max(lengths):.2f} {np.mean(lengths):.2f}" == "31.18 34.65 33.81"
    assert np.mean(lengths) == pytest.approx(exact, rel=1e-6)
    assert {he().contact_line_length(phi) for phi in np.linspace(0.0, 0.125, 50)} == {20.0, 40.0}


def test_tip_alteration_of_zhang() -> None:
    """Zhang: k = (a − a_0)/m − (x_1 + x_2) = −0.0094 at the printed centre distance."""
    assert f"{zhang().tip_alteration_coefficient:.4f}" == "-0.0094"


def test_tips_are_not_made_longer_at_a_larger_centre_distance() -> None:
    """He's pair 0.3 mm apart, a tenth of a module: k = 0, not +0.1, and the racks' addenda are the 1 of their gears."""
    pair = replace(he(), centre_distance=150.3)
    assert pair.tip_alteration_coefficient == 0.0
    assert pair.addendum_coefficients == pytest.approx((1.0, 1.0))


def zhang_with(addendum: float, angle_deg: float = 18.0) -> GearPair:
    """Zhang's pair with a common rack addendum and another pressure angle, d_a = d + 2(h_aP* + x + k)m, tight mesh."""

    def gear(z: int, shift: float, alteration: float) -> GearParameters:
        return GearParameters.from_rack(
            z=z,
            normal_module=2.3,
            normal_pressure_angle_deg=angle_deg,
            addendum_coefficient=addendum,
            dedendum_coefficient=1.57,
            rack_tip_radius_coefficient=0.2,
            tip_shortening_coefficient=-alteration,
            face_width=25.0,
            bore_diameter=40.0,
            profile_shift=shift,
        )

    # a large distance first: the tight one and with it k follow from the shifts alone
    loose = GearPair(gear(33, 0.300, 0.0), gear(46, -0.008, 0.0), 92.0)
    alteration = replace(loose, centre_distance=loose.tight_centre_distance).tip_alteration_coefficient
    gears = gear(33, 0.300, alteration), gear(46, -0.008, alteration)
    return GearPair(*gears, loose.tight_centre_distance)


def test_zhang_contact_ratio_of_common_addendum() -> None:
    """Contact ratio 2 at a common h_aP* = 1.1905; with h_aP* = 1.25 it is 2.036 at 19 and 1.988 at 20 degrees."""
    assert zhang_with(1.1905).transverse_contact_ratio == pytest.approx(2.0, abs=1e-4)
    assert [f"{zhang_with(1.25, angle).transverse_contact_ratio:.3f}" for angle in (19.0, 20.0)] == ["2.036", "1.988"]


def test_curvature_radii_of_he_at_the_ends_of_single_contact() -> None:
    """He: single contact ends at radii 74.635 and 75.378 mm; at the pitch point both ρ are r sin α = 25.652 mm.

    The radii follow by construction: one base pitch before the end and after the start of the path of contact.
    """
    pair = he()
    start, end = pair.path_of_contact
    pitch = pair.pinion.transverse_base_pitch
    rho, mate = pair.curvature_radii([end - pitch, start + pitch, 0.0])
    radii = np.hypot(pair.pinion.base_radius, rho)
    assert [f"{r:.3f}" for r in radii[:2]] == ["74.635", "75.378"]
    assert rho[2] == pytest.approx(75.0 * math.sin(math.radians(20.0)))
    np.testing.assert_allclose(rho + mate, 150.0 * math.sin(math.radians(20.0)))
    assert pair.relative_curvature_radius(0.0) == pytest.approx(rho[2] / 2.0)


def test_specific_sliding_is_sliding_over_rolling() -> None:
    """ζ_1 v_1 = v_s = −ζ_2 v_2 with v_s = (1 + 1/u) ξ, v_1 = ρ_1, v_2 = ρ_2/u per radian of the pinion."""
    for pair in (he(), yang(), zhang()):
        ξ = np.linspace(*pair.path_of_contact, 9)
        (ρ_1, ρ_2), (ζ_1, ζ_2) = pair.curvature_radii(ξ), pair.specific_sliding(ξ)
        slip = (1.0 + 1.0 / pair.ratio) * ξ
        np.testing.assert_allclose(ζ_1 * ρ_1, slip, atol=1e-12)
        np.testing.assert_allclose(ζ_2 * ρ_2 / pair.ratio, -slip, atol=1e-12)


def test_normal_curvature_and_roll_distance_of_a_helical_pair() -> None:
    """Radii across the contact line are ρ / cos β_b; ξ at z is that of the section turned by z tan β/(d/2)."""
    pair = yang()
    transverse, normal = pair.curvature_radii(1.5), pair.normal_curvature_radii(1.5)
    np.testing.assert_allclose(np.array(transverse) / np.array(normal), math.cos(math.radians(27.5402198)), rtol=1e-9)
    turn = 3.0 * math.tan(math.radians(29.0)) / (pair.pinion.reference_diameter / 2.0)
    assert pair.roll_distance(0.1, 2, 3.0) == pytest.approx(pair.roll_distance(0.1 + turn + 4 * math.pi / 17))


def test_backlash_grows_with_the_centre_distance() -> None:
    """He at a = 150 mm has no backlash; at a + Δa the normal backlash is 2 Δa sin α_wt to first order."""
    pair = replace(he(), centre_distance=150.05)
    assert he().circumferential_backlash == pytest.approx(0.0, abs=1e-12)
    assert pair.normal_backlash == pytest.approx(0.1 * math.sin(math.radians(20.0)), rel=2e-3)
