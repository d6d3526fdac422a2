"""A mesh as arrays: cells turned over, types of its arrays."""

from __future__ import annotations

import numpy as np
import pytest

from evolvent_meshes.mesh.mesh_data import MeshData, MeshError
from evolvent_meshes.mesh.quality import least_determinants
from evolvent_meshes.mesh.soundness import check_mesh
from evolvent_meshes.shapes.blocks import box, rectangle


@pytest.mark.parametrize("shape", ["triangle", "quadrilateral"])
@pytest.mark.parametrize("order", [1, 2])
def test_turned_over_cells_have_the_opposite_sense(shape: str, order: int) -> None:
    """A plane mesh turned over has the opposite sense everywhere, and turned over twice it is itself; an order that is
    not the cells' mirror image would fold them."""
    mesh = rectangle(1.0, 1.0, 4, 4, order, shape)
    turned = mesh.turned_over()
    assert np.allclose(least_determinants(turned), -1.0)
    assert np.allclose(least_determinants(mesh), 1.0)
    assert np.array_equal(turned.turned_over().cells, mesh.cells)
    with pytest.raises(MeshError, match=r"the other way round; use MeshData.turned_over\(\)"):
        check_mesh(turned, "block")


def test_turning_over_a_mesh_in_space_is_refused() -> None:
    """Hexahedra have no clockwise numbering that could be reversed."""
    with pytest.raises(MeshError, match="wanted a 2D mesh, found hexahedrons"):
        box((1.0, 1.0, 1.0), (1, 1, 1)).turned_over()


def test_arrays_are_converted_to_the_types_of_the_solver() -> None:
    """float32 points and int32 cells and facets of one triangle become float64 and int64; anything else is kept for
    `check_mesh` to refuse."""
    points, cells = np.eye(3, dtype=np.float32) * [1, 1, 0], np.array([[0, 1, 2]], dtype=np.int32)
    single, sides = points.astype(np.float32), {"side": cells[:, :2]}
    mesh = MeshData(single, "triangle", 1, cells, sides, {})  # type: ignore[arg-type]
    assert (mesh.points.dtype, mesh.cells.dtype, mesh.facets["side"].dtype) == (np.float64, np.int64, np.int64)
    assert MeshData([[0.0]], "triangle", 1, cells, {}, {}).points == [[0.0]]  # type: ignore[arg-type]
