"""Pictures of excitation, vibration and transient contact, with the tables that they are drawn from."""

from __future__ import annotations

from evolvent.dynamics.results.design_load import EXCITATION_FACTS
from evolvent.dynamics.results.histories import HISTORIES
from evolvent.dynamics.results.operation import OPERATION
from evolvent.dynamics.results.response import BRANCH, DYNAMICS, RESPONSE
from evolvent.dynamics.results.spectrum import SPECTRUM
from evolvent.dynamics.results.tables import EXCITATION, HARMONICS
from evolvent.dynamics.results.torque_map import TORQUE_MAP
from evolvent.dynamics.results.transient.beginning import TRANSIENT_START
from evolvent.dynamics.results.transient.facts import TRANSIENT_FACTS
from evolvent.dynamics.results.transient.rows import TRANSIENT, TRANSIENT_TEETH
from evolvent.results.drawing.table_pictures import TablePicture
from evolvent.results.tables.table import SCENE_TITLE, SceneValue

FIGURES = "evolvent.dynamics.figures"
EXCITATION_PICTURE = TablePicture(
    "excitation.png", (EXCITATION_FACTS, EXCITATION, HARMONICS), f"{FIGURES}.excitation:excitation_figure"
)
VIBRATION_PICTURES = (
    TablePicture("vibration.png", (DYNAMICS, RESPONSE, BRANCH), f"{FIGURES}.response:response_figure"),
    TablePicture("waterfall.png", (DYNAMICS, SPECTRUM), f"{FIGURES}.waterfall:waterfall_figure"),
    TablePicture("histories.png", (DYNAMICS, HISTORIES), f"{FIGURES}.histories:histories_figure"),
    TablePicture("torque_map.png", (TORQUE_MAP,), f"{FIGURES}.torque_map:torque_map_figure"),
)
OPERATION_PICTURE = TablePicture(
    "30_mesh_force.png",
    (OPERATION, HISTORIES, EXCITATION, SceneValue("scene.toml", "dynamics.series_stiffness_N_per_um")),
    f"{FIGURES}.operation:operation_figure",
)
TRANSIENT_PICTURES = (
    TablePicture(
        "transient.png", (SCENE_TITLE, TRANSIENT, TRANSIENT_TEETH, TRANSIENT_FACTS),
        f"{FIGURES}.transient:transient_figure",
    ),
    TablePicture(
        "transient_start.png", (SCENE_TITLE, TRANSIENT_START), f"{FIGURES}.transient_start:start_figure"
    ),
)
