"""Archard wear of any contact problem and of gear pairs: worn depths, mesh motion, blocks of cycles.

The names below are the Python API, described in docs/wear.md; `evolvent.wear.results` has a study's files and pictures.
Each is imported when it is first used.
"""

from typing import TYPE_CHECKING

from evolvent_meshes.lazy_names import lazy_names

if TYPE_CHECKING:
    from evolvent.wear.archard import Archard as Archard
    from evolvent.wear.archard import StepsTooLong as StepsTooLong
    from evolvent.wear.archard import VolumeLost as VolumeLost
    from evolvent.wear.block_stepping import Block as Block
    from evolvent.wear.block_stepping import BlockSettings as BlockSettings
    from evolvent.wear.block_stepping import WearState as WearState
    from evolvent.wear.block_stepping import WearStopped as WearStopped
    from evolvent.wear.body_study import CycleState as CycleState
    from evolvent.wear.body_study import WearStudy as WearStudy
    from evolvent.wear.cycle import Cycle as Cycle
    from evolvent.wear.cycle import SlidingContact as SlidingContact
    from evolvent.wear.gears.gear_study import StudyCheckpoint as StudyCheckpoint
    from evolvent.wear.gears.gear_study import StudyState as StudyState
    from evolvent.wear.gears.gear_study import checkpoint_of as checkpoint_of
    from evolvent.wear.gears.gear_study import study_states as study_states
    from evolvent.wear.gears.gear_wear import GearWear as GearWear
    from evolvent.wear.gears.gear_wear import PitchState as PitchState
    from evolvent.wear.gears.meshed_pair import GearMeshMotion as GearMeshMotion
    from evolvent.wear.gears.solver import wear_study as wear_study
    from evolvent.wear.gears.solver import wearing_pair as wearing_pair
    from evolvent.wear.mesh_motion import MeshInverted as MeshInverted
    from evolvent.wear.mesh_motion import MeshVolumeLost as MeshVolumeLost
    from evolvent.wear.pin_on_disc import Coefficient as Coefficient
    from evolvent.wear.pin_on_disc import PinOnDisc as PinOnDisc
    from evolvent.wear.pin_on_disc import Record as Record
    from evolvent.wear.pin_on_disc import coefficient as coefficient
    from evolvent.wear.sliding_track import Track as Track
    from evolvent.wear.sliding_track import Travel as Travel
    from evolvent.wear.worn_geometry import MeshMotion as MeshMotion
else:
    __all__, __getattr__, __dir__ = lazy_names(__name__)
