"""Picture of a load list, and the tables that it is drawn from."""

from __future__ import annotations

from evolvent.results.drawing.table_pictures import TablePicture
from evolvent.results.tables.load_table import LoadRuns

LOADS_PICTURE = TablePicture("loads.png", (LoadRuns(),), "evolvent.results.figures.load_list:loads_picture")
