"""Commands that look: what `evolvent cache` says of what is kept."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent.commands.app import main
from evolvent.fem.cache.cache import Cache


def test_cache_is_listed_beside_the_size_that_the_environment_gives(
    kept: Cache, capsys: pytest.CaptureFixture[str]
) -> None:
    """Problem: an entry of 8 kB in a cache of 1 GB, as EVOLVENT_CACHE_GB says. Exact: its name, and 1000 MB; nothing
    once it is cleared."""
    kept.kept("a flank", "inputs", np.ndarray, lambda: np.zeros(1000))
    assert main(["cache", "list"]) == 0
    listed = capsys.readouterr().out
    assert "a flank" in listed and "of at most 1000 MB in" in listed
    assert main(["cache", "clear"]) == 0
    capsys.readouterr()
    main(["cache", "list"])
    assert "a flank" not in capsys.readouterr().out
