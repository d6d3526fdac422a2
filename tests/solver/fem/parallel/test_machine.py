"""The memory that a run may use: the machine's, or the smallest limit of its control groups."""

from __future__ import annotations

from pathlib import Path

from evolvent.fem.parallel.machine import machine_megabytes


def test_smallest_limit_of_the_control_groups_counts(tmp_path: Path) -> None:
    """The smallest limit of the process's groups and of those above, of both versions; "max" and no files: none."""
    physical = machine_megabytes(tmp_path)
    assert physical > 100.0
    own, groups = tmp_path / "proc/self", tmp_path / "sys/fs/cgroup"
    own.mkdir(parents=True)

    def limit(name: str, text: str) -> None:
        (groups / name).parent.mkdir(parents=True, exist_ok=True)
        (groups / name).write_text(text)

    (own / "cgroup").write_text("4:memory:/docker/a1\n1:cpu:/docker/a1\n0::/user/me\n")
    limit("user/me/memory.max", "max\n")
    limit("memory/memory.limit_in_bytes", "9223372036854771712\n")
    assert machine_megabytes(tmp_path) == physical
    limit("user/memory.max", "64000000\n")
    assert machine_megabytes(tmp_path) == 64.0
    limit("memory/docker/a1/memory.limit_in_bytes", "32000000\n")
    assert machine_megabytes(tmp_path) == 32.0
