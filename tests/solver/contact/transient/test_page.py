"""The programs of docs/transient.md."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

from tests.support.checkout import ROOT


def test_programs_of_the_page_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As they stand, in an empty folder. The bar is in contact for 2L/c = 7.73 µs within 3 %, and leaves with the 1 m/s
    that it came with within 3 %, in equal steps and in adaptive ones, whose blow begins with short ones; the state is
    there."""
    text = (ROOT / "docs/transient.md").read_text(encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {}
    for program in re.findall(r"```python\n(.*?)```", text, re.DOTALL):
        exec(compile(program, "transient.md", "exec"), names)
    pressed, lengths = names["pressed"], names["lengths"]
    assert pressed[-1] - pressed[0] + names["step"] == pytest.approx(7.73e-6, rel=0.03)
    for moment in (names["moments"][-1], names["last"]):
        assert abs(moment.velocities[0][0]) == pytest.approx(1000.0, rel=0.03)
    assert min(lengths) < 0.1 * 2e-6 and names["last"].time == pytest.approx(1e-5)
    assert [path.name for path in tmp_path.iterdir()] == ["bar.npz"]
