"""Every verification demo at its small size, as a user runs it: serially and on two ranks. It checks its own bounds."""

from __future__ import annotations

import pytest

DEMOS = ("two_blocks", "hertz_cylinder", "hertz_sphere")


@pytest.mark.parametrize("ranks", [1, 2])
@pytest.mark.parametrize("demo", DEMOS)
def test_demo(run_script, tmp_path, demo, ranks):
    """Status 0, a table and a picture; the table is printed once, whatever the number of ranks."""
    done = run_script(f"demos/{demo}.py", "--quick", "--out", str(tmp_path), ranks=ranks)
    assert done.returncode == 0, done.stderr[-3000:]
    assert (tmp_path / f"{demo}.png").stat().st_size > 20_000
    table = (tmp_path / "table.csv").read_text().splitlines()
    head = table[0].split(",")[0].strip('"')
    assert len(table) > 3
    assert sum(line.startswith(head) for line in done.stdout.splitlines()) == 1
