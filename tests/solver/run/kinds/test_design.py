"""`evolvent design` on He's spur pair in plane strain: the best relief, edges, tolerances, and what is said."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from evolvent.commands.app import main
from evolvent.results.archive.store import ArchiveError
from evolvent.results.drawing.style import png_of
from evolvent.run.design.checked import BEST, BestRow
from evolvent.run.design.design_lines import design_lines
from evolvent.run.design.figures import design_figure
from evolvent.run.design.tables import ALLOWED, BAND, DESIGN, EDGES, VariantRow
from evolvent.run.kinds.design import Design
from evolvent.run.kinds.excitation import Excitation
from evolvent.run.kinds.losses import LOSSES, Losses
from evolvent.scene.scene import SceneError, load_scene
from tests.support.checkout import ROOT
from tests.support.computing.quiet import quietly
from tests.support.gear_cases import QUIET, spur_scene

LONG = (
    *QUIET, "mesh.level=quick", "pinion.tip_relief_um=0", "wheel.tip_relief_um=0",
    "pinion.tip_relief_start_diameter_mm=150.756", "wheel.tip_relief_start_diameter_mm=150.756",
)
"""A linear relief from the end of single contact on."""


def designed(folder: Path, *settings: str, percents: tuple[float, ...] = (100.0,)) -> list[VariantRow]:
    quietly(Design.of(spur_scene(*LONG, *settings), percents), folder)
    return DESIGN.read(folder)


@pytest.fixture(scope="module")
def long_relief(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("long")
    designed(folder, 'design.vary=[["both.tip_relief_um",4.4,7.6,0.2]]', "sweep.positions=20", "design.verified=2")
    return folder


def test_long_relief_for_its_load(long_relief: Path) -> None:
    """Harris' relief of He's pair: 5.2 µm at 170 N·m (tests/solver/dynamics/excitation/test_harris_map.py), within 5 %
    on a lattice of 0.2 µm. Edges bear a little there, so that its contact was resolved."""
    best = [row for row in BEST.read(long_relief) if row.rank == 1]
    variants = DESIGN.read(long_relief)
    assert variants[best[0].variant].values["pinion.tip_relief_um"] == pytest.approx(5.2, rel=0.05)
    assert variants[best[0].variant].status == EDGES
    assert np.isnan(best[0].transmission_error_peak_to_peak_um) and best[0].resolved_peak_to_peak_um < 0.4


def test_best_one_without_edges_stands_beside(long_relief: Path) -> None:
    """The last rank has the smallest error of all allowed variants; resolved, it is as in line contact within 2 % or
    0.03 µm."""
    rows, variants = BEST.read(long_relief), DESIGN.read(long_relief)
    last = max(rows, key=lambda row: row.rank)
    allowed = [row.transmission_error_peak_to_peak_um for row in variants if row.status == ALLOWED]
    assert last.transmission_error_peak_to_peak_um == pytest.approx(min(allowed), rel=1e-9)
    off = abs(last.resolved_peak_to_peak_um - last.transmission_error_peak_to_peak_um)
    assert off < max(0.02 * last.resolved_peak_to_peak_um, 0.03)


def test_best_scene_is_ready_to_be_computed(long_relief: Path) -> None:
    """best.toml has the modifications of the best variant, and all else of the scene but what varies."""
    best = load_scene(long_relief / "best.toml")
    (row,) = (each for each in BEST.read(long_relief) if each.rank == 1)
    values = DESIGN.read(long_relief)[row.variant].values
    assert best.pinion.tip_relief_um == pytest.approx(values["pinion.tip_relief_um"])
    assert best.wheel.tip_relief_start_diameter_mm == 150.756 and best.design is None and best.mesh.level == "quick"


def test_resolved_figures_are_those_of_an_excitation(long_relief: Path, tmp_path: Path) -> None:
    """`evolvent excitation` of best.toml has the resolved transmission error and stiffness."""
    quietly(Excitation.of(load_scene(long_relief / "best.toml", QUIET), (100.0,)), tmp_path)
    (row,) = (each for each in BEST.read(long_relief) if each.rank == 1)
    lines = (tmp_path / "harmonics.csv").read_text(encoding="utf-8").splitlines()
    cells = [dict(zip(lines[0].split(","), line.split(","))) for line in lines[1:]]
    error = next(each for each in cells if each["quantity"] == "transmission_error_um")
    assert row.resolved_peak_to_peak_um == pytest.approx(float(error["peak_to_peak"]), rel=1e-6)
    assert error["harmonic"] == "1"
    assert row.resolved_first_harmonic_um == pytest.approx(float(error["amplitude"]), rel=1e-6)


def test_resumed_with_other_limits(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """No variant is computed again for other targets and limits; the scene with which it goes on replaces the first."""
    vary = 'design.vary=[["both.tip_relief_um",20.0,30.0,5.0]]', "sweep.positions=4", "design.verified=0"
    designed(tmp_path, *vary)
    monkeypatch.setattr("evolvent.run.design.variant_mesh.VariantMesh.figures", lambda *_: pytest.fail("again"))
    limited = Design.of(spur_scene(*LONG, *vary, 'design.limits=[["largest_pressure_MPa",100.0]]'), (100.0,))
    warnings = quietly(limited, tmp_path, resume=True)
    assert not any(row.status == ALLOWED for row in DESIGN.read(tmp_path))
    assert any("No variant is allowed" in sentence for sentence in warnings)
    assert not (tmp_path / "best.toml").exists() and len(list(design_lines(tmp_path))) == 1


def test_resumed_with_more_samples(tmp_path: Path) -> None:
    """Another number of samples has other variants in another order: those that are known stay, and so do the best
    one's positions, whatever its number is now."""
    settings = (
        'design.vary=[["pinion.tip_relief_um",20.0,40.0,1.0],["wheel.tip_relief_um",20.0,40.0,1.0]]',
        "sweep.positions=4", "design.verified=0", 'design.search="sobol"', "design.samples={}",
    )
    few, more = ([each.format(count) for each in settings] for count in (4, 8))
    designed(tmp_path, *few)
    quietly(Design.of(spur_scene(*LONG, *more), (100.0,)), tmp_path, resume=True)
    assert len(DESIGN.read(tmp_path)) > 5


def test_spur_pair_with_deviations_over_the_face_is_in_space(tmp_path: Path) -> None:
    """Problem: a misalignment within the tolerances; coarse and narrow, for algebra alone. Right: line contact and
    resolved contact are both in space, a warning says so, and best.toml repeats it. K_Hβ is a figure then, and is
    refused as a target in the plane."""
    narrow = "pinion.face_width_mm=4", "wheel.face_width_mm=4", "load.torque_Nm=34", "mesh.order=1", "sweep.positions=3"
    vary = 'design.vary=[["both.tip_relief_um",8.0,10.0,2.0]]', 'design.limits=[["face_load_factor",9.0]]'
    over_face = 'design.tolerances=[["pair.misalignment_um",2.0]]', "design.verified=1"
    warnings = quietly(Design.of(spur_scene(*LONG, *narrow, *vary, *over_face), (100.0,)), tmp_path)
    assert any(sentence.startswith("In space, as pair.misalignment_um") for sentence in warnings)
    assert load_scene(tmp_path / "best.toml").exact.parts == ("plane",)
    (row,) = (each for each in BEST.read(tmp_path) if each.rank == 1)
    assert 1.0 <= row.face_load_factor < row.band_highest_face_load_factor
    assert len(BAND.read(tmp_path)) > 30
    with pytest.raises(SceneError, match="face_load_factor of gears in the plane"):
        quietly(Design.of(spur_scene(*LONG, *vary), (100.0,)), tmp_path / "plane")


def test_refusals(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """Without [design], and without a list of torques that are all possible."""
    with pytest.raises(SceneError, match=r"design: found nothing"):
        quietly(Design.of(spur_scene(*QUIET)), tmp_path)
    assert main(["design", str(ROOT / "demos/he2022.toml"), "--out", str(tmp_path / "out")]) == 2
    assert "write for example design.vary" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_loss_of_the_best_ones_is_that_of_losses(tmp_path: Path) -> None:
    """Problem: reliefs of 20 and 30 µm, of which the second has the smaller loss. In line contact and resolved,
    with its error bar, it is what `evolvent losses` of best.toml writes, within the numbers of both tables."""
    loss = 'design.vary=[["both.tip_relief_um",20.0,30.0,10.0]]', 'design.targets=["loss_percent"]', "sweep.positions=8"
    bars = "contact.friction=0.1", "output.error_bars=true"
    variants = designed(tmp_path / "design", *loss, *bars)
    row = next(each for each in BEST.read(tmp_path / "design") if each.rank == 1)
    assert row.variant == 2 and variants[2].loss_percent == pytest.approx(row.loss_percent, rel=1e-8)
    for level, value, error in (
        ("line", row.loss_percent, row.loss_percent_error),
        ("quick", row.resolved_loss_percent, row.resolved_loss_percent_error),
    ):
        best = load_scene(tmp_path / "design/best.toml", [f"mesh={{level='{level}'}}"])
        quietly(Losses.of(best, (100.0,)), tmp_path / level)
        (own,) = LOSSES.read(tmp_path / level)
        assert (value, error) == pytest.approx((own.loss_percent, own.loss_percent_error), rel=1e-6)
    assert row.resolved_loss_percent == pytest.approx(row.loss_percent, rel=0.01)
    assert any(f"loss {row.loss_percent:.3f}" in line for line in design_lines(tmp_path / "design"))


def test_loss_is_unknown_where_edges_bear(tmp_path: Path) -> None:
    """Edges of tips with a relief of 1 µm bear under the whole torque, not under 5 %: the scene as it stands has a loss
    in line contact there alone; that of the resolved contact is known throughout."""
    loss = 'design.vary=[["both.tip_relief_um",20.0,30.0,10.0]]', 'design.limits=[["loss_percent",2.0]]'
    little = "pinion.tip_relief_um=1", "wheel.tip_relief_um=1", "sweep.positions=8", "contact.friction=0.1"
    designed(tmp_path, *loss, *little, percents=(5.0, 100.0))
    light, heavy = (row for row in BEST.read(tmp_path) if row.variant == 0)
    assert 0.0 < light.loss_percent < 2.0 and np.isnan(heavy.loss_percent)
    assert light.resolved_loss_percent == pytest.approx(light.loss_percent, rel=0.05)
    assert 0.0 < heavy.resolved_loss_percent < 2.0


@pytest.mark.parametrize("friction", ["0", "[0.05,0.1]"])
def test_loss_wants_one_friction_coefficient(friction: str, tmp_path: Path) -> None:
    """Neither none nor a list; without the loss as a target or limit friction does not matter."""
    vary = 'design.vary=[["both.tip_relief_um",20.0,30.0,10.0]]', f"contact.friction={friction}"
    for asked in ('design.targets=["loss_percent"]', 'design.limits=[["loss_percent",0.7]]'):
        with pytest.raises(SceneError, match=r"contact\.friction: found .*; allowed: one coefficient above 0"):
            quietly(Design.of(spur_scene(*LONG, *vary, asked), (100.0,)), tmp_path)
    Design.of(spur_scene(*LONG, *vary), (100.0,)).check()


def test_friction_is_part_of_what_is_resumed_with_a_loss(tmp_path: Path) -> None:
    """Another coefficient is refused where there is a loss, and is of no effect where there is none."""
    vary = 'design.vary=[["both.tip_relief_um",20.0,30.0,10.0]]', "sweep.positions=4", "design.verified=0"
    loss = 'design.targets=["loss_percent"]'
    designed(tmp_path / "with", *vary, loss, "contact.friction=0.1")
    other = Design.of(spur_scene(*LONG, *vary, loss, "contact.friction=0.05"), (100.0,))
    with pytest.raises(ArchiveError, match="friction coefficient of the loss"):
        quietly(other, tmp_path / "with", resume=True)
    designed(tmp_path / "without", *vary, "contact.friction=0.1")
    quietly(Design.of(spur_scene(*LONG, *vary, "contact.friction=0.05"), (100.0,)), tmp_path / "without", resume=True)


def test_each_of_the_best_has_its_band(tmp_path: Path) -> None:
    """The band of each variant reaches from below its own transmission error and loss to above them, that of the best
    one is what design_band.csv has; the scene as it stands, which has no rank, has none."""
    varying = 'design.vary=[["both.tip_relief_um",20.0,30.0,10.0]]', 'design.tolerances=[["wheel.tip_relief_um",2.0]]'
    more = 'design.limits=[["loss_percent",0.7]]', "contact.friction=0.1", "sweep.positions=4", "design.verified=2"
    designed(tmp_path, *varying, *more, "mesh={level='line'}")
    *ranked, stands = BEST.read(tmp_path)
    assert [row.rank for row in (*ranked, stands)] == [1, 2, 0]
    for row in ranked:
        low, high = row.band_lowest_peak_to_peak_um, row.band_highest_peak_to_peak_um
        assert low <= row.transmission_error_peak_to_peak_um * (1.0 + 1e-8) and low < high
        assert row.band_lowest_loss_percent < row.loss_percent < row.band_highest_loss_percent
    within = [row.loss_percent for row in BAND.read(tmp_path)]
    assert (min(within), max(within)) == (ranked[0].band_lowest_loss_percent, ranked[0].band_highest_loss_percent)
    assert np.isnan(stands.band_lowest_peak_to_peak_um) and stands.band_left_out == 0


@pytest.mark.parametrize("keys", [1, 2, 3])
def test_picture_of_so_many_keys(keys: int) -> None:
    """A curve, a map, a cloud; with edges that bear, and with no best one."""
    names = ("pinion.tip_relief_um", "wheel.tip_relief_um", "pinion.lead_crowning_um")[:keys]
    grid = np.stack(np.meshgrid(*([np.arange(4.0)] * keys)), axis=-1).reshape(-1, keys)
    variants = [
        VariantRow(
            n, dict(zip(names, row)), 1.0 + row.sum(), 1.0, 900.0, 0.5, 0.4, 0.0, ALLOWED if n % 3 else EDGES, ""
        )
        for n, row in enumerate(np.concatenate([grid[:1], grid]))
    ]
    nan = float("nan")
    rows = [
        BestRow(rank, number, "", torque, 1.0, 0.1, 300.0, 1.0, 1.1, 0.01, 900.0, 9.0, 0.5, 0.01, 0.4, 0.01, 1.1,
                0.1, 300.0, 1.0, 0.5, 0.01, 0.4, 0.01, 0, *[nan] * 10)
        for rank, number in ((1, 2), (0, 0)) for torque in (100.0, 200.0)
    ]
    for best, target in (
        (rows, "transmission_error_peak_to_peak_um"), (rows, "loss_percent"), (rows, "face_load_factor"),
        (rows, "transmission_error_first_harmonic_um"),
        ([row for row in rows if row.rank == 0], "loss_percent"),
    ):
        section = {"targets": [target], "limits": [["face_load_factor", 1.3]]}
        assert png_of(design_figure, "a pair", section, variants, best)[:4] == b"\x89PNG"
