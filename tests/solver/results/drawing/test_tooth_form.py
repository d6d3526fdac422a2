"""The picture of tooth forms: its curves lie where the gears do."""

from __future__ import annotations

import io
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from evolvent.commands.app import main
from evolvent.results.drawing.tooth_form import key_diameters, tooth_form_figure
from evolvent.scene.scene import scene_from_text
from evolvent_meshes.gears.member import Member
from tests.support.scene_texts import HE

FORM = (
    "pinion.tooth_thickness_allowance_um=-120", "pinion.tip_rounding_um=400", "wheel.tip_chamfer_um=300",
)


def test_outline_reaches_from_root_to_tip() -> None:
    """He's pinion with a rounding: the thick line reaches from d_f/2 to d_a/2, its two sides mirror each other; the
    dashed flank of full thickness lies 120 µm·cos/2 outside in x at the reference circle, within 2 µm."""
    pair = scene_from_text(HE, FORM).gear_pair()
    axes = tooth_form_figure("He", pair).axes[0]
    outline, right = (np.column_stack(axes.lines[i].get_data()) for i in (0, 1))
    radius = np.hypot(*outline.T)
    assert (2 * radius.min(), 2 * radius.max()) == pytest.approx((pair.pinion.root_diameter, 156.0), abs=1e-9)
    np.testing.assert_allclose(outline, outline[::-1] * [-1.0, 1.0], atol=1e-12)
    thin = pair.pinion.transverse_thickness(150.0) / 2.0
    x = float(np.interp(75.0, np.hypot(*right.T), right[:, 0]))
    assert x - thin == pytest.approx(0.06, abs=2e-3)


def test_key_diameters_are_those_that_differ() -> None:
    """From the tip down; the tip form diameter only where tips are not sharp."""
    rounded, sharp = scene_from_text(HE, FORM).gear_pair(), scene_from_text(HE).gear_pair()
    assert list(key_diameters(rounded, Member.WHEEL))[:2] == ["d_a", "d_Fa"]
    assert "d_Fa" not in key_diameters(sharp, Member.PINION)
    values = list(key_diameters(sharp, Member.PINION).values())
    assert values == sorted(values, reverse=True)


def test_check_draws_it_and_writes_over_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """`check --out` writes a PNG; a second call leaves it alone with status 2, --overwrite draws it again."""
    scene, out = tmp_path / "he.toml", tmp_path / "form.png"
    scene.write_text(HE, encoding="utf-8")
    command = ["check", str(scene), "--out", str(out)]
    assert main(command) == 0
    assert str(out) in capsys.readouterr().out
    assert Image.open(io.BytesIO(out.read_bytes())).size[0] > 1000
    out.write_text("mine", encoding="utf-8")
    assert main(command) == 2
    assert (out.read_text(encoding="utf-8"), "--overwrite" in capsys.readouterr().err) == ("mine", True)
    assert main([*command, "--overwrite"]) == 0
    assert out.stat().st_size > 1000
    assert main([*command[:3], str(tmp_path / "form.jpg")]) == 2
