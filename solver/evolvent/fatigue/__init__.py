"""Contact fatigue: criteria below a contact of given loads, and of the flanks of a solved pitch.

The names below are the Python API, described in docs/fatigue.md. Each is imported when it is first used.
"""

from typing import TYPE_CHECKING

from evolvent_meshes.lazy_names import lazy_names

if TYPE_CHECKING:
    from evolvent.strength.fatigue.criteria import dang_van as dang_van
    from evolvent.strength.fatigue.criteria import fatemi_socie as fatemi_socie
    from evolvent.strength.fatigue.criteria import largest_shear as largest_shear
    from evolvent.strength.fatigue.criteria import orthogonal_shear_range as orthogonal_shear_range
    from evolvent.strength.fatigue.criteria import von_mises as von_mises
    from evolvent.strength.fatigue.half_plane import HertzTractions as HertzTractions
    from evolvent.strength.fatigue.half_plane import LineForces as LineForces
    from evolvent.strength.fatigue.half_plane import plane_strain as plane_strain
    from evolvent.strength.fatigue.half_space import PointForces as PointForces
    from evolvent.strength.solution.flank_fatigue import ContactFatigue as ContactFatigue
    from evolvent.strength.solution.flank_fatigue import FatigueSettings as FatigueSettings
    from evolvent.strength.solution.flank_fatigue import PitchFatigue as PitchFatigue
    from evolvent.strength.solution.flank_fatigue import contact_fatigue as contact_fatigue
    from evolvent.strength.solution.flank_fatigue import passing_stress as passing_stress
    from evolvent.strength.solution.flank_fatigue import pitch_fatigue as pitch_fatigue
else:
    __all__, __getattr__, __dir__ = lazy_names(__name__)
