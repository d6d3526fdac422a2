"""`evolvent check --contact`: figures of the pitch in line contact."""

from __future__ import annotations

import re

import numpy as np
import pytest

from evolvent.check.contact_rows import contact_table
from evolvent.dynamics.excitation.loaded_mesh import loaded_mesh
from tests.support.gear_cases import model_of, spur_scene

RELIEVED = tuple(
    f"{gear}.{key}" for gear in ("pinion", "wheel") for key in ("tip_relief_um=20", 'tip_relief_form="parabolic"')
)


def figure(text: str, name: str) -> float:
    return figures(text, name)[0]


def figures(text: str, name: str) -> list[float]:
    """Value and error of a row; the value alone where it has none."""
    found = re.search(rf"^  {name}.*?  +([\d.]+(?: +[\d.]+)?)$", text, re.MULTILINE)
    assert found is not None
    return [float(each) for each in found[1].split()]


def test_figures_are_those_of_an_excitation() -> None:
    """Exact: transmission error and stiffness of `evolvent excitation --level line` at the same 60 positions; no K_Hβ
    in the plane; the scene's own level and order are without effect."""
    text = contact_table(spur_scene(*RELIEVED, "mesh.order=1", 'exact.parts=["window"]'))
    angles = 2.0 * np.pi / 50.0 * np.arange(60) / 60
    mesh = loaded_mesh(model_of(spur_scene(*RELIEVED, "mesh.level=line")), [170e3], angles)
    assert figure(text, "transmission error, mean") == pytest.approx(1e3 * mesh.errors.mean(), abs=6e-3)
    assert figure(text, "transmission error, peak to peak") == pytest.approx(1e3 * np.ptp(mesh.errors), abs=6e-3)
    assert figure(text, "tangent mesh stiffness, mean") == pytest.approx(1e-3 * mesh.stiffness.mean(), abs=0.06)
    assert "face load factor" not in text
    pressure, error = figures(text, "Hertzian pressure away from edges, kinks")
    assert 500.0 < pressure < 2000.0 and 0.02 * pressure - 1.0 < error < 0.1 * pressure
    assert all(0.0 < figures(text, f"transmission error, {name}")[1] < 0.5 for name in ("mean", "peak to peak"))


def test_edges_leave_no_figures() -> None:
    """Problem: He's pair without relief. The part of the load on edges is there, the figures are not."""
    text = contact_table(spur_scene("sweep.positions=8"))
    assert figure(text, "load on edges of tips, at most") > 1.0
    assert "transmission error" not in text and "tip_relief_um" in text
