"""Dynamics of gear pairs: excitation by the mesh, vibration over the speed, oscillators on a mesh of one's own.

The names below are the Python API, described in docs/dynamics.md. Each is imported when it is first used.
"""

from typing import TYPE_CHECKING

from evolvent_meshes.lazy_names import lazy_names

if TYPE_CHECKING:
    from evolvent.dynamics.excitation.force_surface import MeshExcitation as MeshExcitation
    from evolvent.dynamics.excitation.force_surface import NoForceSurface as NoForceSurface
    from evolvent.dynamics.modes.static_shapes import with_elastic_bodies as with_elastic_bodies
    from evolvent.dynamics.oscillator.mesh_law import Jammed as Jammed
    from evolvent.dynamics.oscillator.steady_state import NoSteadyState as NoSteadyState
    from evolvent.dynamics.pair_model import DriveSettings as DriveSettings
    from evolvent.dynamics.pair_model import TooSoftBodies as TooSoftBodies
    from evolvent.dynamics.pair_model import geometric_backlash as geometric_backlash
    from evolvent.dynamics.solution.given_mesh import GivenMeshVibration as GivenMeshVibration
    from evolvent.dynamics.solution.given_mesh import given_mesh_vibration as given_mesh_vibration
    from evolvent.dynamics.solution.mesh_excitation import GearExcitation as GearExcitation
    from evolvent.dynamics.solution.mesh_excitation import mesh_excitation as mesh_excitation
    from evolvent.dynamics.solution.vibration import PairVibration as PairVibration
    from evolvent.dynamics.solution.vibration import natural_speed as natural_speed
    from evolvent.dynamics.solution.vibration import vibration as vibration
    from evolvent.gears.problem.gear_inertia import polar_moment as polar_moment
    from evolvent.gears.problem.iso_dynamic_factor import Accuracy as Accuracy
else:
    __all__, __getattr__, __dir__ = lazy_names(__name__)
