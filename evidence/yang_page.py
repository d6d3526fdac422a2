"""What docs/yang2022.md and other pages say of the helical pair of Yang et al. 2022, from the figures that
evidence/yang.py kept."""

from __future__ import annotations

from pathlib import Path

from evidence.report import table
from evidence.yang import kept
from evolvent.results.archive.error_bar_data import plus_minus

Figures = dict[str, float]


def beside_hertz(docs: Path, level: str) -> str:
    """How far the peaks at mid-face stand from Hertz for their own line load."""
    f = kept(docs, level)
    return (
        f"{f['over_hertz_median_percent']:+.1f} % in the median, nine in ten within "
        f"{f['off_hertz_nine_in_ten_percent']:.1f} %, at most {f['off_hertz_largest_percent']:.0f} % off, "
        f"at ξ = {f['off_hertz_largest_xi_mm']:.1f} mm"
    )


def accuracy(docs: Path) -> str:
    """A sentence on both levels."""
    return (
        "Peak pressures at mid-face of Yang's helical pair, beside Hertz for their own line load: level `quick`, which "
        f"is for looking, {beside_hertz(docs, 'quick')}; level `standard` {beside_hertz(docs, 'standard')}."
    )


def levels(docs: Path) -> str:
    """What to expect of each level."""
    return table(
        ("level", "elements across 2b_H", "peak pressure beside Hertz for its own line load"),
        [
            ("quick", "1.7", f"{beside_hertz(docs, 'quick')} ([Yang's pair](yang2022.md), mid-face)"),
            ("standard", "3", f"{beside_hertz(docs, 'standard')} (the same)"),
            ("fine", "6", "1 % (measured on the spur pair)"),
        ],
    )


def points(docs: Path) -> str:
    """The paper's statements beside what was found at level standard."""
    f = kept(docs, "standard")
    rows = [*_known(f), *_over_the_engagement(f), *_over_friction(f), *_pair(f)]
    return table(("Paper", "What it says", "Here", "Picture"), rows)


def _known(f: Figures) -> list[tuple[str, str, str, str]]:
    return [
        ("Table 1", "the gears", "reproduced by `evolvent check` to the last digit", "–"),
        (
            "Eq. 4, Table 4",
            "Hertz estimate 1788 MPa at 250 N·m",
            "literal Eq. 4: 2390.6 MPa with the printed K factors, 1619.4 without; Hertz at the pitch point 1579 MPa "
            "(mean line length) to 1645 MPa (shortest)",
            "10_hertz",
        ),
        (
            "–",
            "–",
            f"computed at point B on the pitch line: {f['point_B_MPa']:.0f} MPa (μ = {f['low_friction']:.2f}); median "
            f"near the pitch line {f['near_pitch_line_median_MPa']:.0f} MPa",
            "10_hertz",
        ),
    ]


def _over_the_engagement(f: Figures) -> list[tuple[str, str, str, str]]:
    largest = plus_minus(f["largest_MPa"], f["low_largest_bar_MPa"], 0)
    return [
        (
            "Figs 8, 9",
            "stress first rises, then falls over the engagement, asymmetric",
            f"largest {largest} MPa at {f['largest_deg']:+.1f}° (μ = {f['low_friction']:.2f}), ξ = "
            f"{f['largest_xi_mm']:.2f} mm; {f['at_pitch_point_MPa']:.0f} MPa where the tooth passes the pitch point, "
            f"{f['near_tip_least_MPa']:.0f} to {f['near_tip_largest_MPa']:.0f} MPa near the tip, from +22° to "
            f"{f['last_deg']:+.0f}°",
            "03, 04",
        ),
        (
            "Figs 8, 9",
            "before a critical angle friction raises the stress a little, after it lowers it more",
            f"μ {f['low_friction']:.2f} → {f['high_friction']:.2f}, nine in ten positions: "
            f"{f['change_before_low_percent']:+.1f} to {f['change_before_high_percent']:+.1f} % before the pitch "
            f"point, {f['change_after_high_percent']:+.1f} to {f['change_after_low_percent']:+.1f} % after it",
            "03, 04",
        ),
        (
            "Figs 8, 9",
            "the curves cross; at another angle for each tooth",
            f"crossing at {f['crossing_deg']:+.1f}° of the tooth's rotation: the highest stress then lies on the part "
            "of the line that passes the pitch point last",
            "03",
        ),
    ]


def _over_friction(f: Figures) -> list[tuple[str, str, str, str]]:
    def all_teeth(name: str) -> str:
        return ", ".join(f"tooth {k} {f[f'tooth_{k}_{name}_change_percent']:+.1f} %" for k in (1, 2, 3))

    changes = ", ".join(f"{f[f'point_{p}_change_MPa']:.1f}" for p in "ABCD")
    shares = ", ".join(f"{f[f'point_{p}_change_percent']:.1f}" for p in "ABCD")
    return [
        (
            "Fig. 10",
            "tooth 1 falls with μ, teeth 2 and 3 rise slightly",
            f"maximum over the pitch: {all_teeth('largest')}; average: {all_teeth('average')}",
            "05",
        ),
        (
            "Fig. 12",
            "stress varies along the contact line",
            "tooth 2 falls from its root end to its tip end, tooth 3 is higher; see the picture",
            "06",
        ),
        (
            "Fig. 13, Table 5",
            "change with μ at A, B, C, D: 595.7, 11.65, 758.35, 1134.24 MPa (62, 1, 33, 42 %)",
            f"{changes} MPa ({shares} %): C and D, which are alike here, above A above B as in the paper, a tenth of "
            "its size",
            "07",
        ),
    ]


def _pair(f: Figures) -> list[tuple[str, str, str, str]]:
    error, efficiency = (
        [
            f"{plus_minus(f[f'{side}_{name}'], f[f'{side}_{bar}'], 2)} {unit} at μ = {f[f'{side}_friction']:.2f}"
            for side in ("low", "high")
        ]
        for name, bar, unit in (
            ("transmission_error_um", "transmission_error_bar_um", "µm"),
            ("efficiency_percent", "efficiency_bar_percent", "%"),
        )
    )
    return [
        (
            "Fig. 14",
            "pitting below the pitch line, towards the pinion's root",
            f"the largest pressure away from tip edges, {f['largest_MPa']:.0f} MPa, lies at ξ = "
            f"{f['largest_xi_mm']:.2f} mm, below the pitch line",
            "01, 02",
        ),
        (
            "–",
            "–",
            f"load sharing: {f['low_fewest_teeth']:.0f} to {f['low_most_teeth']:.0f} teeth, a tooth carries at most "
            f"{f['low_largest_share_percent']:.0f} %",
            "08",
        ),
        ("–", "–", f"transmission error, peak to peak: {', '.join(error)}", "09"),
        ("–", "–", f"efficiency of the mesh: {', '.join(efficiency)}", "11"),
    ]
