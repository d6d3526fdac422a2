"""How positions and friction coefficients are divided among ranks; that ranks agree where the pinion drives is in
test_run.py."""

from __future__ import annotations

import json
from itertools import pairwise
from typing import cast

import pytest
from mpi4py import MPI

from evolvent.contact.newton.snes import NotConverged
from evolvent.contact.search.pairing import SearchError
from evolvent.fem.parallel.cores import Cores
from evolvent.gears.gear_model import GearModel
from evolvent.gears.sweep import parallel_sweep
from evolvent.gears.sweep.parallel_sweep import division
from evolvent.gears.sweep.pitch_sweep import Pitch, initial_state
from tests.support.running.processes import RunScript

WHEEL_DRIVES = """
import json, sys
from dataclasses import replace
from mpi4py import MPI
from evolvent.gears.solution.certified_pitch import certified_pitch
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from evolvent_meshes.gears.member import Member
from tests.support.gear_cases import helical_scene, model_of
gears = model_of(helical_scene())
gears = replace(gears, load=replace(gears.load, driving=Member.WHEEL))
pitch, found = uniform_pitch(gears.pair.pinion.z, 3, 1, Member.WHEEL), []
for frictions in ([0.3], [0.0, 0.1, 0.3]):
    for results in certified_pitch(gears, pitch, frictions, MPI.COMM_WORLD).by_friction:
        found += [value for each in results for value in (each.transmission_error, each.friction_loss)]
if MPI.COMM_WORLD.rank == 0:
    sys.stdout.write(json.dumps(found))
"""


@pytest.mark.parametrize("count", [1, 2, 3, 7, 20])
@pytest.mark.parametrize("ranks", [1, 2, 3, 4, 9])
def test_every_coefficient_is_solved_once(count: int, ranks: int) -> None:
    """The slices follow one another from 0 to the number of coefficients, one a rank, and differ by one at most."""
    slices = division(count, ranks)
    assert len(slices) == ranks and slices[0].start == 0 and slices[-1].stop == count
    assert all(a.stop == b.start and a.start <= a.stop for a, b in pairwise(slices))
    sizes = [s.stop - s.start for s in slices]
    assert max(sizes) - min(sizes) <= 1


@pytest.mark.parametrize("error", [NotConverged, SearchError])
def test_a_position_that_cannot_be_prepared_is_left_to_each_rank(
    error: type[Exception], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Problem: a position whose search fails where a rank prepares it for all. Exact: nothing is prepared, so that each
    rank approaches it in smaller steps; another error is none of this."""

    def failing(*_: object) -> None:
        raise raised("as the test wants")

    monkeypatch.setattr(parallel_sweep, "shared_position", failing)
    comm, frictions = MPI.COMM_SELF, [0.1]
    sweep = parallel_sweep._RankedSweep(
        cast(GearModel, None), Pitch((0.0,)), frictions, {}, comm, Cores(comm), broadcasts=()
    )
    raised: type[Exception] = error
    assert sweep._prepared(range(1), initial_state(frictions)) is None
    raised = ArithmeticError
    with pytest.raises(ArithmeticError):
        sweep._prepared(range(1), initial_state(frictions))


@pytest.mark.mpi
def test_ranks_agree_where_the_wheel_drives(run_script: RunScript) -> None:
    """Problem: a helical pair that its wheel drives, at one friction coefficient, for which one rank prepares positions
    for the other, and at three, which they divide. Exact: transmission errors and friction powers of one rank, 1e-7;
    friction takes power at each position."""
    found = []
    for ranks in (1, 2):
        done = run_script("-c", WHEEL_DRIVES, ranks=ranks)
        assert done.returncode == 0, done.stderr
        found.append(json.loads(done.stdout))
    assert found[1] == pytest.approx(found[0], rel=1e-7, abs=1e-7)
    assert len(found[0]) == 2 * 3 * 4 and min(found[0][1:6:2]) > 0.0
