"""How positions and friction coefficients are divided among ranks; that ranks agree where the pinion drives is in
test_run.py."""

from __future__ import annotations

import json
from itertools import pairwise
from typing import cast

import pytest
from mpi4py import MPI

from evidence.robustness.campaigns.random_scenes import random_scene
from evolvent.contact.newton.snes import NotConverged
from evolvent.contact.search.pairing import SearchError
from evolvent.fem.parallel.cores import Cores
from evolvent.gears.gear_model import GearModel
from evolvent.gears.sweep import parallel_sweep
from evolvent.gears.sweep.parallel_sweep import division
from evolvent.gears.sweep.pitch_sweep import Pitch, initial_state
from evolvent.gears.sweep.position_search import SharedPosition, shared_position
from tests.support.gear_cases import model_of, spur_scene
from tests.support.running.processes import RunScript

OVERLAPS = 277  # the seed of a plane pair whose next tooth pair touches outside the window
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
FAILING = """
from mpi4py import MPI
from evolvent.gears.solution.certified_pitch import certified_pitch
from evolvent.gears.sweep import parallel_sweep
from evolvent.gears.sweep.pitch_sweep import uniform_pitch
from tests.support.gear_cases import helical_scene, model_of
gears, searched, prepared = model_of(helical_scene()), parallel_sweep.shared_position, []
def failing(*given, **named):
    prepared.append(given[1])
    if len(prepared) == 2:
        raise ArithmeticError("the second position, as the test wants")
    return searched(*given, **named)
parallel_sweep.shared_position = failing
try:
    certified_pitch(gears, uniform_pitch(gears.pair.pinion.z, 4), [0.3], MPI.COMM_WORLD)
except Exception as error:
    print(f"rank {MPI.COMM_WORLD.rank}: {error}")
"""
LEVELS = """
import json, sys
from dataclasses import replace
from mpi4py import MPI
from evolvent.gears import GearPair, GearProblem, MeshSettings, condense
from evolvent.gears.sweep.parallel_sweep import sweep_on_ranks
from evolvent.gears.sweep.pitch_sweep import initial_state, uniform_pitch
from tests.support.paper_pairs import yang
pinion, wheel = (replace(gear, face_width=1.4) for gear in yang().gears)
pair = GearPair(pinion, replace(wheel, bore_diameter=126.0), yang().centre_distance)
gears = condense(GearProblem(pair, 4e3, mesh=MeshSettings("quick", 1.5, two_level=True)))
found = []
for frictions in ([0.2], [0.1, 0.2]):
    for comm in (MPI.COMM_SELF, MPI.COMM_WORLD):
        found.append([])
        for position in sweep_on_ranks(gears, uniform_pitch(pinion.z, 4), frictions, initial_state(frictions), comm):
            for each in position.results:
                found[-1] += [each.stand.angle, each.transmission_error, each.friction_loss]
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

    def failing(*_: object, **__: object) -> None:
        raise raised("as the test wants")

    for name in ("shared_position", "without_overlaps"):
        monkeypatch.setattr(parallel_sweep, name, failing)
    sweep, state = ranked_sweep(cast(GearModel, None)), initial_state([0.1])
    raised: type[Exception] = error
    assert sweep._prepared(range(1), state) is None
    raised = SearchError  # that of the whole flanks
    assert sweep._accepted(cast(SharedPosition, None)) is None
    raised = ArithmeticError
    with pytest.raises(ArithmeticError):
        sweep._prepared(range(1), state)
    with pytest.raises(ArithmeticError):
        sweep._accepted(cast(SharedPosition, None))


def ranked_sweep(model: GearModel) -> parallel_sweep._RankedSweep:
    """Sweep of one position on one rank."""
    return parallel_sweep._RankedSweep(
        model, Pitch((0.0,)), [0.1], {}, MPI.COMM_SELF, Cores(MPI.COMM_SELF), broadcasts=()
    )


def test_contact_outside_a_prepared_window_is_searched_anew() -> None:
    """Problem: plane pairs prepared without a look outside the window; of one the next pair's tip edge overlaps there
    by 70 µm. Exact: that one is not accepted; the other, at its nominal load, is, with the same state."""
    for model, is_accepted in ((model_of(random_scene(OVERLAPS)), False), (model_of(spur_scene()), True)):
        prepared = shared_position(model, 0.0, (0.0, 0.0), [0.0], None, overlaps=False)
        accepted = ranked_sweep(model)._accepted(prepared)
        assert (accepted is not None) == is_accepted
        if accepted is not None:
            assert accepted.smooth is prepared.smooth and accepted.system is prepared.system


@pytest.mark.mpi
def test_ranks_agree_where_the_wheel_drives(run_script: RunScript) -> None:
    """Problem: a helical pair that its wheel drives, at one friction coefficient, for which one rank prepares positions
    for the other, and at three, which they divide. Exact: transmission errors and friction powers of one rank, 1e-7;
    friction takes power at each position."""
    found = []
    for ranks in (1, 2, 3):
        done = run_script("-c", WHEEL_DRIVES, ranks=ranks)
        assert done.returncode == 0, done.stderr
        found.append(json.loads(done.stdout))
    for each in found[1:]:
        assert each == pytest.approx(found[0], rel=1e-7, abs=1e-7)
    assert len(found[0]) == 2 * 3 * 4 and min(found[0][1:6:2]) > 0.0


@pytest.mark.mpi
def test_all_ranks_learn_of_an_error_in_the_background(run_script: RunScript) -> None:
    """Problem: rank 1 fails while it prepares the second position in the background. Exact: both ranks end with an
    error, that of rank 1 with its message, and none waits for the other."""
    done = run_script("-c", FAILING, ranks=2)
    assert done.returncode == 0, done.stderr
    assert "rank 1: the second position, as the test wants" in done.stdout
    assert "rank 0: " in done.stdout


@pytest.mark.evidence
@pytest.mark.slow
@pytest.mark.mpi
def test_ranks_agree_on_flanks_in_levels(run_script: RunScript) -> None:
    """Problem: 1.4 mm of Yang's pair, whose compliance is applied without a matrix, at one friction coefficient, for
    which rank 1 prepares positions in the background, and at two, for which each rank prepares every second one.
    Exact: angles, transmission errors and friction powers of a rank by itself, 1e-7."""
    done = run_script("-c", LEVELS, ranks=2)
    assert done.returncode == 0, done.stderr
    wanted, found, wanted_of_two, found_of_two = json.loads(done.stdout)
    assert found == pytest.approx(wanted, rel=1e-7, abs=1e-7)
    assert found_of_two == pytest.approx(wanted_of_two, rel=1e-7, abs=1e-7)
    assert len(set(wanted[::3])) == 4 and len(wanted_of_two) == 2 * len(wanted)
