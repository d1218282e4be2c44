"""A trimesh.Trimesh in place of V, with None for F, is its arrays: bit for bit."""

import numpy as np
import pytest
import trimesh

from toongeo.caricature.caricature_surface import caricature_surface
from toongeo.geometry import (
    DeformationTransfer,
    LaplacianAligner,
    cotangent_laplacian,
    deformation_transfer,
    laplacian_align,
    nonrigid_register,
    self_intersections,
    vertex_normals,
)

TARGETS = np.array([[2.0, 0, 0], [0, -2.0, 0.5]])
DEFORM = np.array([1.0, 1.5, 0.7])
GEMS = [0, 100, 200, 300]
CALLS = {
    "laplacian_align": lambda V, F: laplacian_align(V(), F, [3, 200], TARGETS),
    "laplacian_align, a target missing": lambda V, F: laplacian_align(V(), F, [3, 200], [TARGETS[0], [np.nan] * 3]),
    "LaplacianAligner": lambda V, F: LaplacianAligner(V(), F, [3, 200], laplacian="cotangent").align(TARGETS),
    "deformation_transfer": lambda V, F: deformation_transfer(V(), V(DEFORM), F, V(2)),
    "DeformationTransfer": lambda V, F: DeformationTransfer(V(), F, V(2)).transfer(V(DEFORM)),
    "nonrigid_register": lambda V, F: nonrigid_register(V(), F, V(2), F, GEMS, GEMS, iterations=1).vertices,
    "caricature_surface": lambda V, F: caricature_surface(V(), F, 0.2),
    "cotangent_laplacian": lambda V, F: cotangent_laplacian(V(), F).toarray(),
    "vertex_normals": lambda V, F: vertex_normals(V(), F),
    "self_intersections": lambda V, F: self_intersections(V(), F),
}


@pytest.fixture
def mesh(bumpy):
    V, F = bumpy
    return trimesh.Trimesh(V, F, process=False)


@pytest.mark.parametrize("call", CALLS.values(), ids=CALLS)
def test_a_trimesh_is_its_arrays(bumpy, call):
    V, F = bumpy
    before = V.copy()
    expected = call(lambda scale=1.0: V * scale, F)
    got = call(lambda scale=1.0: trimesh.Trimesh(V * scale, F, process=False), None)
    np.testing.assert_array_equal(got, expected)
    np.testing.assert_array_equal(V, before)


def test_arrays_and_meshes_may_be_mixed(bumpy, mesh):
    V, F = bumpy
    expected = deformation_transfer(V, DEFORM * V, F, 2 * V)
    np.testing.assert_array_equal(deformation_transfer(mesh, DEFORM * V, None, 2 * V), expected)
    target = trimesh.Trimesh(2 * V, F, process=False)
    np.testing.assert_array_equal(deformation_transfer(V, DEFORM * V, F, target), expected)


def test_several_deformations_stay_arrays(bumpy, mesh):
    V, F = bumpy
    shapes = np.stack([V, DEFORM * V])
    found = deformation_transfer(mesh, shapes, None, mesh)
    np.testing.assert_array_equal(found, deformation_transfer(V, shapes, F, V))


@pytest.mark.parametrize("call", CALLS.values(), ids=CALLS)
def test_two_sets_of_triangles_or_none_are_refused(bumpy, mesh, call):
    V, F = bumpy
    with pytest.raises(ValueError, match=r"F(_source)?: expected None, since V\w* is a Trimesh"):
        call(lambda scale=1.0: mesh, F)
    with pytest.raises(
        ValueError, match=r"F(_source)?: expected triangles, or a trimesh.Trimesh as V\w*, got None and"
    ):
        call(lambda scale=1.0: V * scale, None)


def test_a_scene_is_no_mesh(mesh):
    with pytest.raises(ValueError, match=r"F: expected triangles, or a trimesh\.Trimesh as V, got None and Scene"):
        vertex_normals(trimesh.Scene(mesh), None)


@pytest.mark.parametrize("place", ["V_deformed", "V_target"])
def test_meshes_of_other_triangles_are_refused(bumpy, mesh, place):
    V, F = bumpy
    meshes = {"V_deformed": mesh, "V_target": mesh, place: trimesh.Trimesh(V, F[::-1], process=False)}
    with pytest.raises(ValueError, match=rf"{place}: expected a Trimesh with the {len(F)} triangles of V_source, got"):
        deformation_transfer(mesh, meshes["V_deformed"], None, meshes["V_target"])


def test_an_inner_nan_of_a_mesh_is_named(bumpy):
    V, F = bumpy
    mesh = trimesh.Trimesh(V.copy(), F, process=False)
    mesh.vertices[5, 1] = np.nan
    with pytest.raises(ValueError, match=r"V: expected finite coordinates, got 1 rows that are not, the first V\[5\]"):
        laplacian_align(mesh, None, [0], [[0, 0, 0]])
