"""Meshes of files and of other libraries."""

import numpy as np
import pytest

import supple


def test_files(tmp_path):
    mesh = supple.make_torus(8, 6)
    for extension in ("obj", "off", "ply", "stl"):
        path = tmp_path / f"torus.{extension}"
        supple.save_mesh(mesh, path)
        again = supple.load_mesh(path)
        assert again.name == "torus" and len(again.triangles) == len(mesh.triangles)
        if extension != "stl":
            np.testing.assert_array_equal(again.positions, mesh.positions)
        assert supple.Scene().add(str(path)).name == "torus"
    (tmp_path / "bad.obj").write_text("v 0 0 0\nf 1 2 3\n")
    with pytest.raises(supple.Error, match="bad.obj:2"):
        supple.load_mesh(tmp_path / "bad.obj")
    with pytest.raises(supple.Error, match="foo.gltf"):
        supple.Scene().add("foo.gltf")
    with pytest.raises(supple.Error, match="foo"):
        supple.save_mesh(mesh, tmp_path / "mesh.foo")


def test_models_and_topology():
    assert supple.model_names() == ["pawn", "fish", "rabbit", "human", "bike"]
    rabbit = supple.make_model("rabbit")
    facts = supple.compute_topology(rabbit)
    assert (
        facts["closed"] and facts["vertices"] == len(rabbit.positions) and supple.fault_of_solid(rabbit) == ""
    )
    cloth = supple.make_cloth(2, 2)
    assert "open at 8 edges" in supple.fault_of_solid(cloth) and supple.compute_topology(cloth)[
        "surface"
    ].startswith("open")
    two = supple.Mesh(
        np.concatenate([cloth.positions, np.asarray(cloth.positions) + 5]),
        np.concatenate([cloth.triangles, np.asarray(cloth.triangles) + 9]),
    )
    parts = supple.split_into_parts(two)
    assert [len(part.mesh.triangles) for part in parts] == [8, 8] and parts[1].vertices.tolist() == list(
        range(9, 18)
    )
    soup = supple.Mesh(
        np.asarray(cloth.positions)[np.asarray(cloth.triangles)].reshape(-1, 3), np.arange(24).reshape(-1, 3)
    )
    assert supple.is_open_at_seams(
        supple.Mesh(
            np.asarray(rabbit.positions)[np.asarray(rabbit.triangles)].reshape(-1, 3),
            np.arange(3 * len(rabbit.triangles)).reshape(-1, 3),
        )
    )
    assert len(np.unique(supple.welded(soup).triangles)) == 9
    assert len(np.unique(supple.vertices_at_same_position(soup.positions))) == 9
    with pytest.raises(supple.Error, match="rabbit"):
        supple.make_model("horse")
    for wrong in ((), (3, 0), (0, 3)):
        with pytest.raises((supple.Error, TypeError)):
            supple.make_torus(*wrong)


def test_meshes_of_trimesh_and_meshio(tmp_path):
    trimesh = pytest.importorskip("trimesh")
    meshio = pytest.importorskip("meshio")
    box = trimesh.creation.box()
    assert supple.Scene().add(box, solid=True).triangle_count == 12
    mesh = meshio.Mesh(
        np.asarray(box.vertices), [("triangle", np.asarray(box.faces)), ("line", np.array([[0, 7]]))]
    )
    assert supple.Scene().add(mesh).triangle_count == 12
    meshio.write(tmp_path / "box.vtk", mesh)
    assert supple.Scene().add(tmp_path / "box.vtk").triangle_count == 12
    for cells in (
        [("quad", np.array([[0, 1, 2, 3]]))],
        [("triangle", np.array([[0, 1, 2]])), ("quad", np.array([[0, 1, 2, 3]]))],
    ):
        with pytest.raises(supple.Error, match="quad"):
            supple.Scene().add(meshio.Mesh(np.asarray(box.vertices), cells))


class Tensor:
    """The shape of a mesh of Open3D."""

    def __init__(self, box):
        self.vertices, self.triangles = list(map(list, box.positions)), list(map(list, box.triangles))


def test_meshes_by_their_members():
    box = supple.make_box()
    assert supple.Scene().add(Tensor(box)).triangle_count == 12
    assert supple.Scene().add((box.positions, box.triangles)).triangle_count == 12
    with pytest.raises(supple.Error, match="object is not a mesh"):
        supple.Scene().add(object())


def test_edges_and_points():
    rod = supple.Mesh([[0, 0, 0], [1, 0, 0], [5, 0, 0]], edges=[[0, 1]], points=[2], name="rod")
    scene = supple.Scene(contacts="proximity")
    scene.add(rod, margin=0.1)
    scene.add([[0.5, 0.1, 0]], (), points=[0], margin=0.05)
    assert scene.detect().proximity["distance"].tolist() == [pytest.approx(0.1)]
    with pytest.raises(supple.Error):
        supple.Mesh([[0, 0, 0]], edges=[[0, 0]])


def test_paths_and_meshes_that_change_places(tmp_path):
    box = supple.make_box()
    with pytest.raises(TypeError, match=r"save_mesh: the second argument, the path, is <supple.Mesh 'box'"):
        supple.save_mesh(tmp_path / "box.obj", box)
    with pytest.raises(TypeError, match="load_mesh: the path is <supple.Mesh"):
        supple.load_mesh(box)
    with pytest.raises(TypeError, match="open: the path is 3"):
        supple.open(3)
    scene = supple.Scene()
    scene.add(box)
    with pytest.raises(TypeError, match="record: the first argument, the path, is <supple.Scene"):
        supple.record(scene, tmp_path / "run.h5")
    supple.save_mesh(box, tmp_path / "box.obj")
    supple.save_mesh(str(tmp_path / "box.obj"), tmp_path / "box.ply")  # a path is a mesh, too
    assert len(supple.load_mesh(tmp_path / "box.ply").triangles) == 12
