"""Evolvent's solver: frictional contact of elastic bodies, and of gear pairs, with dolfinx and PETSc.

The names below are the Python API of contact problems, described in docs/own_problem.md; the packages `evolvent.gears`,
`evolvent.dynamics`, `evolvent.strength`, `evolvent.fatigue` and `evolvent.wear` have those of gear pairs. Each is
imported when it is first used.
"""

from importlib import metadata
from typing import TYPE_CHECKING

from evolvent.fem.parallel.mpi_start import start_alone_quietly
from evolvent_meshes.lazy_names import lazy_names

if TYPE_CHECKING:
    from evolvent import dynamics as dynamics
    from evolvent import fatigue as fatigue
    from evolvent import gears as gears
    from evolvent import strength as strength
    from evolvent import wear as wear
    from evolvent.contact import hertz as hertz
    from evolvent.contact.newton.snes import NotConverged as NotConverged
    from evolvent.contact.problem.condensed_body import CondensedBody as CondensedBody
    from evolvent.contact.problem.condensed_body import condense_bodies as condense_bodies
    from evolvent.contact.problem.definition import Contact as Contact
    from evolvent.contact.problem.definition import Nitsche as Nitsche
    from evolvent.contact.problem.definition import Placement as Placement
    from evolvent.contact.problem.definition import Problem as Problem
    from evolvent.contact.problem.definition import Side as Side
    from evolvent.contact.problem.definition import Step as Step
    from evolvent.contact.problem.poisson_limit import NearlyIncompressibleWarning as NearlyIncompressibleWarning
    from evolvent.contact.search.pairing import SearchError as SearchError
    from evolvent.contact.solution.paraview import write_paraview as write_paraview
    from evolvent.contact.solution.reactions import Reaction as Reaction
    from evolvent.contact.solution.reactions import reactions as reactions
    from evolvent.contact.solution.solver import Sweep as Sweep
    from evolvent.contact.solution.solver import solve as solve
    from evolvent.contact.solution.solver import sweep as sweep
    from evolvent.contact.step.contact_result import ContactResult as ContactResult
    from evolvent.contact.step.contact_width import CoarseContactWarning as CoarseContactWarning
    from evolvent.contact.step.displaced_search import PairingNotSettled as PairingNotSettled
    from evolvent.contact.step.peak_scatter import ScatteredPressureWarning as ScatteredPressureWarning
    from evolvent.contact.step.small_strain import SmallStrainExceeded as SmallStrainExceeded
    from evolvent.contact.step.step_solution import Solution as Solution
    from evolvent.contact.step.step_system import StepSystem as StepSystem
    from evolvent.contact.transient.energy import EnergyGrowth as EnergyGrowth
    from evolvent.contact.transient.energy import EnergyNotKept as EnergyNotKept
    from evolvent.contact.transient.settings import InitialState as InitialState
    from evolvent.contact.transient.settings import TransientSettings as TransientSettings
    from evolvent.contact.transient.solver import CoarseTimeStepWarning as CoarseTimeStepWarning
    from evolvent.contact.transient.solver import Moment as Moment
    from evolvent.contact.transient.solver import MotionState as MotionState
    from evolvent.contact.transient.solver import Transient as Transient
    from evolvent.fem.backend.dolfinx_mesh import mesh_from_dolfinx as mesh_from_dolfinx
    from evolvent.fem.body import Body as Body
    from evolvent.fem.body import BodyForce as BodyForce
    from evolvent.fem.body import Fixed as Fixed
    from evolvent.fem.body import Freedom as Freedom
    from evolvent.fem.body import Rigid as Rigid
    from evolvent.fem.body import Traction as Traction
    from evolvent.fem.material import STEEL as STEEL
    from evolvent.fem.material import Material as Material
    from evolvent.fem.stress import cell_stress as cell_stress
    from evolvent.fem.stress import von_mises as von_mises
    from evolvent_meshes.errors import EvolventError as EvolventError
    from evolvent_meshes.errors import InputError as InputError
    from evolvent_meshes.errors import ResultError as ResultError
    from evolvent_meshes.mesh.gmsh_io import read_msh as read_msh
    from evolvent_meshes.mesh.mesh_data import MeshData as MeshData
    from evolvent_meshes.mesh.mesh_data import MeshError as MeshError
else:
    __all__, __getattr__, __dir__ = lazy_names(__name__)

start_alone_quietly()

try:
    __version__ = metadata.version("evolvent")
except metadata.PackageNotFoundError:  # a checkout that was not installed
    __version__ = "unknown"
