"""Root strength of gear pairs: stress at the roots of teeth from the contact solution, and by ISO 6336-3.

The names below are the Python API, described in docs/strength.md. Each is imported when it is first used.
"""

from typing import TYPE_CHECKING

from evolvent_meshes.lazy_names import lazy_names

if TYPE_CHECKING:
    from evolvent.strength.results.tables import RootStressRow as RootStressRow
    from evolvent.strength.results.tables import StrengthRow as StrengthRow
    from evolvent.strength.solution.root_stress import RootStress as RootStress
    from evolvent.strength.solution.root_stress import iso_6336_3 as iso_6336_3
    from evolvent.strength.solution.root_stress import root_formulas as root_formulas
    from evolvent.strength.solution.root_stress import root_stress as root_stress
    from evolvent.strength.standard.root_stress import StandardStress as StandardStress
else:
    __all__, __getattr__, __dir__ = lazy_names(__name__)
