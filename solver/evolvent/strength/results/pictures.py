"""Pictures of root stress and of contact fatigue, with the tables that they are drawn from."""

from __future__ import annotations

from evolvent.results.drawing.table_pictures import TablePicture
from evolvent.results.tables.table import SCENE_TITLE
from evolvent.strength.results.fatigue_facts import FATIGUE_FACTS
from evolvent.strength.results.fatigue_rows import FATIGUE_DEPTH, FATIGUE_MAP, FATIGUE_SECTION
from evolvent.strength.results.tables import ROOT_STRESS, STRENGTH

ROOT_STRESS_PICTURE = TablePicture(
    "root_stress.png", (SCENE_TITLE, ROOT_STRESS, STRENGTH),
    "evolvent.strength.results.root_stress_picture:root_stress_figure",
)
FATIGUE_PICTURE = TablePicture(
    "fatigue.png", (SCENE_TITLE, FATIGUE_FACTS, FATIGUE_MAP, FATIGUE_SECTION, FATIGUE_DEPTH),
    "evolvent.strength.results.fatigue_picture:fatigue_figure",
)
