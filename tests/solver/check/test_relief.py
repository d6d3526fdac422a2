"""Relief that a mesh cannot follow."""

from __future__ import annotations

from pathlib import Path

import pytest

from evolvent.commands.app import main
from tests.support.checkout import ROOT


def test_relief_that_folds_the_mesh_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    """A relief deeper than the fine layers below the flank would fold them: the key is named, not the folded cells."""
    out = tmp_path / "pair.msh"
    settings = ["--level", "quick", "--set", "wheel.tip_relief_um=400"]
    assert main(["mesh", str(ROOT / "demos/he2022.toml"), "--out", str(out), *settings]) == 2
    said = capsys.readouterr().err
    assert "wheel.tip_relief_um: found 400" in said and "; remedy: lower it" in said
    assert not out.exists()
