"""What `evolvent design` prints of made-up tables: the most robust of the best variants, and the loss."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from evolvent.results.archive.run_folder import RunFolder
from evolvent.run.design.checked import BEST, BestRow
from evolvent.run.design.design_lines import design_lines
from evolvent.run.design.tables import ALLOWED, DESIGN, VariantRow

NAN = float("nan")
BARE = BestRow(1, 1, "", 100.0, 1.0, 0.1, 300.0, 1.0, NAN, NAN, 900.0, 9.0, NAN, NAN, 0.4, 0.02, NAN, NAN, NAN, NAN,
               NAN, NAN, NAN, NAN, 0, 0.9, 1.5, NAN, NAN, 890.0, 910.0, NAN, NAN, 0.3, 0.6)
"""The best variant: a transmission error of 1 µm, up to 1.5 µm within its tolerances."""


def told(folder: Path, *rows: BestRow, target: str = "transmission_error_peak_to_peak_um") -> list[str]:
    """Lines on these rows. The scene as it stands is variant 0."""
    values = {"pinion.tip_relief_um": 0.0}
    variants = [VariantRow(n, values, 1.0, NAN, 900.0, NAN, 0.4, 0.0, ALLOWED, "") for n in range(3)]
    files = RunFolder(folder)
    files.write_text("scene.toml", f'[design]\ntargets = ["{target}"]\nlimits = []\n')
    DESIGN.write(files, variants)
    BEST.write(files, [*rows, replace(BARE, rank=0, variant=0)])
    return list(design_lines(folder))


@pytest.mark.parametrize(("highest", "left_out", "said"), [(1.2, 0, True), (1.6, 0, False), (1.2, 3, False)])
def test_variant_that_is_better_within_tolerances(highest: float, left_out: int, said: bool, tmp_path: Path) -> None:
    """1.2 µm of the second variant are less than 1.5 µm of the best one; of three others edges bear, so that its band
    is not known."""
    second = replace(BARE, rank=2, variant=2, band_highest_peak_to_peak_um=highest, band_left_out=left_out)
    lines = [line for line in told(tmp_path, BARE, second) if line.startswith("within tolerances variant")]
    assert lines == [
        "within tolerances variant 2, of rank 2, is better: transmission error peak to peak [µm] up to 1.2, of the "
        "best one up to 1.5"
    ] * said


def test_best_one_whose_band_is_not_known(tmp_path: Path) -> None:
    """Edges of tips bear within its tolerances: the second one is said to be better."""
    second = replace(BARE, rank=2, variant=2)
    (line,) = (line for line in told(tmp_path, replace(BARE, band_left_out=1), second) if "of rank 2" in line)
    assert line.endswith("up to 1.5, of the best one not known, as edges of tips bear")


def test_first_harmonic_is_told_where_it_is_asked_for(tmp_path: Path) -> None:
    """As a target; else it is in the table alone."""
    asked = told(tmp_path / "asked", BARE, target="transmission_error_first_harmonic_um")[2]
    assert "first harmonic 0.400 ± 0.020 µm" in asked and "harmonic" not in told(tmp_path / "not", BARE)[2]


def test_loss_stands_behind_its_torque(tmp_path: Path) -> None:
    """With its error bar, resolved, and within tolerances, for which it is the target, too."""
    loss = replace(BARE, loss_percent=0.63, loss_percent_error=0.01, resolved_loss_percent=0.64,
                   resolved_loss_percent_error=0.02, band_lowest_loss_percent=0.62, band_highest_loss_percent=0.66)
    second = replace(loss, rank=2, variant=2, band_highest_loss_percent=0.65)
    lines = told(tmp_path, loss, second, target="loss_percent")
    assert lines[2].endswith("of rank 2, is better: loss [%] up to 0.65, of the best one up to 0.66")
    assert "loss 0.630 ± 0.010 %; loss resolved 0.640 ± 0.020 %" in lines[3] and "loss 0.620 to 0.660 %" in lines[3]
