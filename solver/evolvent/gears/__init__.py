"""Gear pairs: condensed gears, positions, the periodic pitch with friction, and the curves that it gives.

The names below are the Python API, described in docs/gears_api.md. Each is imported when it is first used.
"""

from typing import TYPE_CHECKING

from evolvent_meshes.lazy_names import lazy_names

if TYPE_CHECKING:
    from evolvent.contact.newton.snes import NotConverged as NotConverged
    from evolvent.contact.search.pairing import SearchError as SearchError
    from evolvent.contact.step.contact_width import CoarseContactWarning as CoarseContactWarning
    from evolvent.fem.material import STEEL as STEEL
    from evolvent.fem.material import Material as Material
    from evolvent.gears.contact.contact_points import ContactPoints as ContactPoints
    from evolvent.gears.gear_model import GearModel as GearModel
    from evolvent.gears.line.line_result import EdgeContact as EdgeContact
    from evolvent.gears.line.line_result import TooWide as TooWide
    from evolvent.gears.meshing.modifications import TooMuchRelief as TooMuchRelief
    from evolvent.gears.pressure.line_peaks import LinePeak as LinePeak
    from evolvent.gears.pressure.pitch_pressure import PitchPressure as PitchPressure
    from evolvent.gears.problem.flank_deviations import FlankChart as FlankChart
    from evolvent.gears.problem.gear_problem import GearOptions as GearOptions
    from evolvent.gears.problem.gear_problem import GearProblem as GearProblem
    from evolvent.gears.problem.gear_problem import MeshSettings as MeshSettings
    from evolvent.gears.problem.hertz_estimate import HertzEstimate as HertzEstimate
    from evolvent.gears.solution.certificates import BalanceError as BalanceError
    from evolvent.gears.solution.other_flanks import with_modifications as with_modifications
    from evolvent.gears.solution.solver import ExtendedChartWarning as ExtendedChartWarning
    from evolvent.gears.solution.solver import condense as condense
    from evolvent.gears.solution.solver import solve_single_position as solve_single_position
    from evolvent.gears.sweep.position_result import PositionResult as PositionResult
    from evolvent.results.solution.pitch import PitchSolution as PitchSolution
    from evolvent.results.solution.pitch import solve_pitch as solve_pitch
    from evolvent.results.solution.pitch import solve_pitches as solve_pitches
    from evolvent_meshes.gears.errors import GeometryError as GeometryError
    from evolvent_meshes.gears.form.support import Support as Support
    from evolvent_meshes.gears.form.web import Web as Web
    from evolvent_meshes.gears.gear import GearParameters as GearParameters
    from evolvent_meshes.gears.gear_geometry import GearGeometry as GearGeometry
    from evolvent_meshes.gears.member import Member as Member
    from evolvent_meshes.gears.modifications.modifications import Modifications as Modifications
    from evolvent_meshes.gears.pair import GearPair as GearPair
    from evolvent_meshes.gears.pair_geometry import PairGeometry as PairGeometry
else:
    __all__, __getattr__, __dir__ = lazy_names(__name__)
