"""ParaView output of contact problems, read back by pyvista: values, positions, node order of every cell."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest
import pyvista

from evolvent import (
    Body,
    Contact,
    Fixed,
    Material,
    Placement,
    Problem,
    Solution,
    Step,
    Traction,
    cell_stress,
    sweep,
    von_mises,
    write_paraview,
)
from evolvent.contact.solution.paraview import vtu_bytes
from evolvent_meshes.files import PART, WriteError, write_bytes
from evolvent_meshes.shapes.blocks import box, rectangle
from tests.support.contact_cases import cylinder

SHAPES = [(s, o) for s in ("triangle", "quadrilateral", "tetrahedron", "hexahedron") for o in (1, 2)]
TURN = np.array([[0.8, -0.6], [0.6, 0.8]])
AWAY = Placement(TURN, np.array([3.0, 1.0]))


@pytest.mark.parametrize(("shape", "order"), SHAPES)
def test_every_cell_has_its_nodes_in_the_order_of_vtk(shape: str, order: int, tmp_path: Path) -> None:
    """Every node of the straight cells that are read back lies where VTK's own reference cell, mapped by the cell's
    corners, has it; two nodes exchanged would not."""
    plane = shape in ("triangle", "quadrilateral")
    mesh = rectangle(3.0, 2.0, 2, 2, order, shape) if plane else box((3.0, 2.0, 2.0), (2, 1, 2), order, shape)
    write_bytes(tmp_path / "m.vtu", vtu_bytes(mesh.points[:, : mesh.dimension], mesh.cells, (shape, order), {}, {}))
    grid = pyvista.read(tmp_path / "m.vtu")
    assert grid.n_cells == len(mesh.cells)
    axes = {"triangle": (1, 2), "quadrilateral": (1, 3), "tetrahedron": (1, 2, 3), "hexahedron": (1, 3, 4)}[shape]
    for number, own in enumerate(mesh.points[mesh.cells]):
        cell = grid.GetCell(number)
        found = np.array([cell.GetPoints().GetPoint(k) for k in range(cell.GetNumberOfPoints())])
        places = np.array(cell.GetParametricCoords()).reshape(-1, 3)[:, : len(axes)]
        assert np.allclose(found, own[0] + places @ (own[list(axes)] - own[0]), atol=1e-12)


def pressed() -> Problem:
    """Two blocks under 60 MPa."""
    upper, lower = rectangle(2.0, 1.0, 4, 2, origin=(0.0, 1.0)), rectangle(2.0, 1.0, 5, 2)
    roll = Fixed("left", "x")
    return Problem(
        (
            Body(upper, Material(100e3, 0.25), (roll,), (Traction("top", (0.0, -60.0)),), name="upper & left <"),
            Body(lower, Material(100e3, 0.25), (roll, Fixed("bottom", "y"))),
        ),
        (Contact((0, "bottom"), (1, "top"), reach=0.1),),
    )


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> tuple[list[Solution], pyvista.PVDReader]:
    """Both blocks at half load as they lie, then at the whole load turned away; and a reader of what was written."""
    solutions = list(sweep(pressed(), [Step(0.5), Step(1.0, (AWAY, AWAY))]))
    path = write_paraview(solutions, tmp_path_factory.mktemp("fields") / "deeper")
    assert sorted(file.name for file in path.parent.iterdir()) == [
        "body_0_0001.vtu", "body_0_0002.vtu", "body_1_0001.vtu", "body_1_0002.vtu",
        "contact_0_0001.vtu", "contact_0_0002.vtu", "series.pvd",
    ]
    return solutions, pyvista.get_reader(path)


@pytest.mark.parametrize("step", [0, 1])
def test_body_files_have_displacement_and_stress(written: tuple[list[Solution], pyvista.PVDReader], step: int) -> None:
    """Positions, displacements, stress and von Mises stress of both bodies: uniaxial in plane strain, σ_n = −p along
    the rotated height and σ_z = −νp, in ParaView's order of components."""
    solutions, reader = written
    reader.set_active_time_value(step + 1.0)
    p, R = (30.0, np.eye(2)) if step == 0 else (60.0, TURN)
    shift = np.zeros(2) if step == 0 else AWAY.translation
    s = R @ np.diag([0.0, -p]) @ R.T
    for index, block in enumerate(reader.read()[:2]):
        mesh = pressed().bodies[index].mesh
        assert np.allclose(block.points[:, :2], mesh.points[:, :2] @ R.T + shift, atol=1e-12)
        assert np.allclose(block["displacement_mm"][:, :2], solutions[step].displacement(index) @ R.T, atol=1e-15)
        assert np.allclose(block["stress_MPa"], [s[0, 0], s[1, 1], -0.25 * p, s[0, 1], 0.0, 0.0], atol=1e-8 * p)
        principal = np.array([0.0, -p, -0.25 * p])
        mises = np.sqrt(0.5 * np.sum((principal - np.roll(principal, 1)) ** 2))
        assert np.allclose(block["von_mises_MPa"], mises, rtol=1e-8)
        material = pressed().bodies[index].material
        assert np.allclose(mises, von_mises(cell_stress(mesh, material, solutions[step].displacement(index))))


def test_contact_file_has_pressure_and_traction(written: tuple[list[Solution], pyvista.PVDReader]) -> None:
    """The pressure at the nodes of the first surface, and the traction on the second body in space."""
    reader = written[1]
    reader.set_active_time_value(2.0)
    surface = reader.read()[2]
    assert np.allclose(surface["pressure_MPa"], 60.0, rtol=1e-8)
    assert np.allclose(surface["traction_MPa"][:, :2], TURN @ [0.0, -60.0], atol=1e-6)
    assert np.allclose(surface["slip_mm"], 0.0, atol=1e-9)
    assert surface.n_cells == 4


def test_nodal_averages_keep_the_contact_force(tmp_path: Path) -> None:
    """A cylinder on a block: nodal pressures times the areas of the hat functions are the force; no nodal pressure is
    negative or above the peak at the points."""
    (solution,) = sweep(cylinder(), [Step()])
    contact = solution.contacts[0]
    surface = pyvista.get_reader(write_paraview(solution, tmp_path)).read()[2]
    hats = solution.condensed[0].surfaces["arc"].weights()
    assert hats @ surface["pressure_MPa"] == pytest.approx(contact.weights @ contact.pressure, rel=1e-12)
    assert surface["pressure_MPa"].min() == 0.0
    assert 0.9 * contact.pressure.max() < surface["pressure_MPa"].max() < contact.pressure.max()


def test_series_grows_with_the_sweep(tmp_path: Path) -> None:
    """A sweep that fails at its third step leaves two steps that can be read and no partial file."""

    def steps() -> Iterator[Step]:
        yield from (Step(0.5), Step(1.0))
        raise RuntimeError("the third one fails")

    with pytest.raises(RuntimeError, match="third"):
        write_paraview(sweep(pressed(), steps()), tmp_path)
    assert pyvista.get_reader(tmp_path / "series.pvd").time_values == [1.0, 2.0]
    assert not list(tmp_path.glob(f"*{PART}*"))


def test_failed_write_leaves_no_partial_file(tmp_path: Path) -> None:
    """A folder with the name of the file: an error that names it, and no temporary file is left."""
    (tmp_path / "body_0_0001.vtu").mkdir()
    (solution,) = sweep(pressed(), [Step()])
    with pytest.raises(WriteError, match="body_0_0001"):
        write_paraview(solution, tmp_path)
    assert not list(tmp_path.glob(f"*{PART}*"))
