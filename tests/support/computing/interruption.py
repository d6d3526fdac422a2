"""A computation that ends once some of its results are stored, as by a signal."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import pytest

from evolvent.results.archive.store import Store


class Interrupted(BaseException):
    """Raised in place of a signal."""


@contextmanager
def interrupted(after: int) -> Iterator[Counter[str]]:
    """Context that counts results as `stored`, and raises Interrupted once there are as many as `after`; never with 0.
    """
    counts, write = Counter[str](), Store.write

    def written(store: Store, *given: Any) -> None:
        write(store, *given)
        counts["stored"] += 1
        if counts["stored"] == after:
            raise Interrupted

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(Store, "write", written)
        yield counts
