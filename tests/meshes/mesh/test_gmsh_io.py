"""gmsh files to arrays and back: node order, groups, leftovers and clear errors."""

import signal
from pathlib import Path

import gmsh
import numpy as np
import pytest

from evolvent_meshes.mesh.gmsh_io import from_gmsh, gmsh_model, read_msh, write_msh
from evolvent_meshes.mesh.mesh_data import MeshData, MeshError
from evolvent_meshes.mesh.soundness import check_mesh
from evolvent_meshes.shapes.blocks import box, rectangle
from tests.support.meshes.overlapping_groups import write_overlapping
from tests.support.running.fresh_process import python

BLOCKS = [
    rectangle(2, 1, 4, 3, order=2),
    rectangle(2, 1, 4, 3, order=1, shape="triangle"),
    box((1, 2, 3), (2, 3, 2), order=2),
    box((1, 2, 3), (2, 3, 2), order=2, shape="tetrahedron"),
]


@pytest.mark.parametrize("mesh", BLOCKS, ids=lambda m: f"{m.shape}{m.order}")
def test_written_mesh_is_read_back_to_the_last_bit(mesh: MeshData, tmp_path: Path) -> None:
    """A mesh written to a file and read again is the same: points to the last bit, cells, groups."""
    write_msh(mesh, tmp_path / "mesh.msh")
    back = read_msh(tmp_path / "mesh.msh")
    assert (back.shape, back.order) == (mesh.shape, mesh.order)
    np.testing.assert_array_equal(back.points, mesh.points)
    np.testing.assert_array_equal(back.cells, mesh.cells)
    assert set(back.facets) == set(mesh.facets)
    for name, facets in mesh.facets.items():
        assert {tuple(f) for f in back.facets[name].tolist()} == {tuple(f) for f in facets.tolist()}
    np.testing.assert_array_equal(back.volumes["body"], mesh.volumes["body"])


def test_overlapping_groups_are_written_and_read(tmp_path: Path) -> None:
    """Cells and facets that are in two groups are in both after writing and reading, and cells are not doubled."""
    base = rectangle(2, 1, 4, 1, order=1)
    facets = {**base.facets, "outside": np.concatenate(list(base.facets.values()))}
    mesh = MeshData(base.points, base.shape, 1, base.cells, facets, {"all": np.arange(4), "half": np.array([1, 3])})
    write_msh(mesh, tmp_path / "mesh.msh")
    back = read_msh(tmp_path / "mesh.msh")
    middles = back.points[back.cells[back.volumes["half"]]].mean(axis=1)
    assert len(back.cells) == 4
    assert sorted(middles[:, 0]) == pytest.approx([0.75, 1.75])
    assert len(back.facets["outside"]) == 10
    assert len(back.facets["top"]) == 4


@pytest.mark.parametrize("version", [4.1, 2.2])
@pytest.mark.parametrize("order", [1, 2])
def test_elements_of_two_groups_are_read_once(version: float, order: int, tmp_path: Path) -> None:
    """Problem: MSH 2.2 writes an element once for each physical group of its entity; sides were read twice, and then
    refused. A surface is in two groups, two of its sides as well. Exact: an area of 50 in each group of cells, lengths
    of 10 and 30, in either version; no element twice."""
    write_overlapping(tmp_path / "mesh.msh", version, order)
    mesh = read_msh(tmp_path / "mesh.msh")
    check_mesh(mesh, "overlap")
    x, y = np.moveaxis(mesh.points[mesh.cells[:, :3], :2], -1, 0)
    areas = 0.5 * np.abs((x[:, 1] - x[:, 0]) * (y[:, 2] - y[:, 0]) - (x[:, 2] - x[:, 0]) * (y[:, 1] - y[:, 0]))
    assert {name: areas[cells].sum() for name, cells in mesh.volumes.items()} == pytest.approx(
        {"body": 50.0, "steel": 50.0}, rel=1e-12
    )
    for name, length in (("top", 10.0), ("boundary", 30.0)):
        ends = mesh.points[mesh.facets[name][:, :2]]
        assert np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1).sum() == pytest.approx(length, rel=1e-12)
        assert len(np.unique(np.sort(mesh.facets[name], axis=1), axis=0)) == len(mesh.facets[name])


def _disc(order: int = 2, recombine: bool = False, name: str = "disc", arc: str = "arc") -> None:
    """A quarter disc in the current model; its centre is a control point, and a corner of the mesh only if meshed."""
    geo = gmsh.model.geo
    centre, right, top = geo.addPoint(0, 0, 0), geo.addPoint(1, 0, 0), geo.addPoint(0, 1, 0)
    inner_right, inner_top = geo.addPoint(0.5, 0, 0), geo.addPoint(0, 0.5, 0)
    rim, hole = geo.addCircleArc(right, centre, top), geo.addCircleArc(inner_right, centre, inner_top)
    sides = geo.addLine(top, inner_top), geo.addLine(inner_right, right)
    surface = geo.addPlaneSurface([geo.addCurveLoop([rim, sides[0], -hole, sides[1]])])
    geo.synchronize()
    gmsh.model.addPhysicalGroup(2, [surface], name=name)
    gmsh.model.addPhysicalGroup(1, [rim], name=arc)
    gmsh.option.setNumber("Mesh.MeshSizeMax", 0.3)
    if recombine:
        gmsh.model.mesh.setRecombine(2, surface)
    gmsh.model.mesh.generate(2)
    gmsh.model.mesh.setOrder(order)


def test_control_points_of_curves_are_no_nodes() -> None:
    """A ring quarter built around a circle centre: no node at the centre, no gaps in the numbers, rim on the circle."""
    with gmsh_model("ring"):
        _disc()
        mesh = from_gmsh()
    assert (mesh.shape, mesh.order, mesh.dimension) == ("triangle", 2, 2)
    np.testing.assert_array_equal(np.unique(mesh.cells), np.arange(len(mesh.points)))
    assert np.hypot(*mesh.points[:, :2].T).min() > 0.49
    np.testing.assert_allclose(np.hypot(*mesh.points[mesh.facets["arc"], :2].T), 1.0, atol=1e-12)


def test_gmsh_session_of_the_caller_is_unchanged() -> None:
    """Reading a file inside a user's gmsh session neither ends it nor changes its model."""
    gmsh.initialize(["gmsh"], readConfigFiles=False, interruptible=False)
    signal.signal(signal.SIGPIPE, signal.SIG_IGN)  # as Python has it: other tests write to closed pipes
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.model.add("mine")
        gmsh.model.geo.addPoint(1, 2, 3)
        gmsh.model.geo.synchronize()
        with gmsh_model("theirs"):
            _disc()
        assert gmsh.isInitialized()
        assert gmsh.model.getCurrent() == "mine"
        assert len(gmsh.model.getEntities(0)) == 1
    finally:
        gmsh.finalize()


def test_model_without_physical_groups_is_refused() -> None:
    """A model with a mesh and no physical group says that one is wanted."""
    with gmsh_model("bare"):
        _disc()
        gmsh.model.removePhysicalGroups()
        with pytest.raises(MeshError, match="named physical volume"):
            from_gmsh()


def test_group_without_a_name_is_refused() -> None:
    """Physical groups without a name are refused."""
    with gmsh_model("unnamed"):
        _disc(arc="")
        with pytest.raises(MeshError, match="a name for every group"):
            from_gmsh()


def test_third_order_cells_are_refused() -> None:
    """Third-order cells are refused by their name."""
    with gmsh_model("third"):
        _disc(order=3)
        with pytest.raises(MeshError, match=r"order 1 or 2.*Triangle 10"):
            from_gmsh()


def test_serendipity_cells_are_refused() -> None:
    """Eight-node quadrilaterals are refused with the option that avoids them."""
    with gmsh_model("serendipity"):
        gmsh.option.setNumber("Mesh.SecondOrderIncomplete", 1)
        _disc(recombine=True)
        gmsh.option.setNumber("Mesh.SecondOrderIncomplete", 0)
        with pytest.raises(MeshError, match="SecondOrderIncomplete = 0"):
            from_gmsh()


def test_mixed_cell_shapes_are_refused() -> None:
    """A triangulated and a recombined surface together are refused."""
    with gmsh_model("mixed"):
        for k in range(2):
            gmsh.model.occ.addRectangle(2 * k, 0, 0, 1, 1)
        gmsh.model.occ.synchronize()
        gmsh.model.addPhysicalGroup(2, [1, 2], name="both")
        gmsh.model.mesh.setRecombine(2, 2)
        gmsh.model.mesh.generate(2)
        with pytest.raises(MeshError, match="one cell shape"):
            from_gmsh()


def test_surfaces_without_a_named_volume_are_refused() -> None:
    """A box whose faces are named and whose volume is not: the faces are no plane mesh."""
    with gmsh_model("shell"):
        gmsh.model.occ.addBox(0, 0, 0, 1, 1, 1)
        gmsh.model.occ.synchronize()
        gmsh.model.addPhysicalGroup(2, [1, 6], name="faces")
        gmsh.model.mesh.generate(3)
        with pytest.raises(MeshError, match="plane z = 0"):
            from_gmsh()


def test_facets_away_from_the_cells_are_refused() -> None:
    """A facet group on a surface outside the named bodies is refused by its name."""
    with gmsh_model("away"):
        for k in range(2):
            gmsh.model.occ.addRectangle(2 * k, 0, 0, 1, 1)
        gmsh.model.occ.synchronize()
        gmsh.model.addPhysicalGroup(2, [1], name="body")
        gmsh.model.addPhysicalGroup(1, [6], name="elsewhere")
        gmsh.model.mesh.generate(2)
        with pytest.raises(MeshError, match="'elsewhere'"):
            from_gmsh()


def test_files_without_a_mesh_are_refused(tmp_path: Path) -> None:
    """A missing file and a file that is no mesh."""
    with pytest.raises(FileNotFoundError, match=r"none\.msh"):
        read_msh(tmp_path / "none.msh")
    (tmp_path / "bad.msh").write_text("no mesh at all")
    with pytest.raises(MeshError, match="MSH format"):
        read_msh(tmp_path / "bad.msh")


def test_writing_cells_in_no_group_is_refused(tmp_path: Path) -> None:
    """gmsh would leave these cells out of the file."""
    base = rectangle(2, 1, 4, 1)
    mesh = MeshData(base.points, base.shape, 2, base.cells, base.facets, {"half": np.array([0, 1])})
    with pytest.raises(MeshError, match="2 of 4 cells"):
        write_msh(mesh, tmp_path / "mesh.msh")


def test_commands_beside_a_mesh_are_not_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """gmsh merges a file NAME.opt with the mesh NAME, and takes whatever is no mesh for a script: both can run shell
    commands. Neither is run by read_msh, and the mesh beside the .opt file is read."""
    monkeypatch.chdir(tmp_path)
    write_msh(BLOCKS[0], tmp_path / "mesh.msh")
    (tmp_path / "mesh.msh.opt").write_text('SystemCall "touch by_options";')
    assert len(read_msh(tmp_path / "mesh.msh").cells) == 12
    (tmp_path / "script.msh").write_text('SystemCall "touch by_script";')
    with pytest.raises(MeshError, match="MSH format"):
        read_msh(tmp_path / "script.msh")
    assert not list(tmp_path.glob("by_*"))


CLOSED_PIPE = """
import os
from evolvent_meshes.mesh.gmsh_io import gmsh_model
with gmsh_model("mesh"):
    pass
reader, writer = os.pipe()
os.close(reader)
try:
    os.write(writer, b"x")
except BrokenPipeError:
    print("an error")
"""


def test_closed_pipes_stay_errors() -> None:
    """After a mesh by gmsh, which resets the signal, a pipe that nobody reads is an error as before, which a program
    can handle: not the end of the process without a word."""
    done = python(CLOSED_PIPE)
    assert (done.returncode, done.stdout) == (0, "an error\n"), done.stderr
