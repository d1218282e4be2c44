"""OBJ: floats come back exactly and in their order."""

import os

import numpy as np
import pytest
import trimesh

from toongeo.io import Scene, SceneMesh, read_image, read_obj, write_obj


def test_round_trip(tmp_path, scene):
    path = tmp_path / "Gesicht ü.obj"
    write_obj(path, scene)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["Gesicht ü.mtl", "Gesicht ü.obj", "Gesicht ü_texture.png"]
    got = read_obj(path)
    np.testing.assert_array_equal(got.vertices, np.concatenate([mesh.vertices for mesh in scene.meshes]))
    np.testing.assert_array_equal(got.uv, np.concatenate([m.uv for m in scene.meshes if m.uv is not None]))
    assert got.objects == tuple(mesh.name for mesh in scene.meshes)
    vertex = uv = 0
    for k, mesh in enumerate(scene.meshes):
        own = got.face_object == k
        np.testing.assert_array_equal(got.faces[own] - vertex, mesh.faces)
        np.testing.assert_array_equal(got.uv_faces[own], -1 if mesh.uv is None else mesh.uv_faces + uv)
        vertex += len(mesh.vertices)
        uv += 0 if mesh.uv is None else len(mesh.uv)
    np.testing.assert_array_equal(read_image(tmp_path / "Gesicht ü_texture.png"), scene.meshes[0].texture)


def test_a_name_cannot_write_lines_of_its_own(tmp_path, scene):
    write_obj(tmp_path / "a\nv 0 0 0\u2028.obj", scene)
    assert {p.name for p in tmp_path.iterdir()} == {"a\nv 0 0 0\u2028.obj", "a_v 0 0 0_.mtl", "a_v 0 0 0__texture.png"}
    assert "mtllib a_v 0 0 0_.mtl" in (tmp_path / "a\nv 0 0 0\u2028.obj").read_text().split("\n")
    got = read_obj(tmp_path / "a\nv 0 0 0\u2028.obj")
    assert len(got.vertices) == sum(len(mesh.vertices) for mesh in scene.meshes)


def test_material_library(tmp_path, scene):
    other = np.zeros((4, 4, 3), np.uint8)
    first, *_, last = scene.meshes
    meshes = (
        first,
        last,
        SceneMesh("my\n mesh", last.vertices, last.faces, last.uv, last.uv_faces, texture=other),
    )
    write_obj(tmp_path / "a.obj", Scene(meshes))
    mtl = (tmp_path / "a.mtl").read_text().splitlines()
    assert [line for line in mtl if line.startswith("map_Kd")] == [
        "map_Kd a_texture.png",
        "map_Kd a_texture.png",
        "map_Kd a_texture_1.png",
    ]
    obj = (tmp_path / "a.obj").read_text().splitlines()
    assert "mtllib a.mtl" in obj and "o my_mesh" in obj
    used = {line.split()[1] for line in obj if line.startswith("usemtl")}
    assert used == {line.split()[1] for line in mtl if line.startswith("newmtl")}


def test_trimesh_reads_the_same_surface(tmp_path, scene):
    mesh = scene.meshes[0]
    write_obj(tmp_path / "a.obj", Scene((mesh,)))
    loaded = trimesh.load(tmp_path / "a.obj", force="mesh")
    corners = loaded.vertices[loaded.faces]
    np.testing.assert_allclose(
        np.sort(corners.reshape(-1, 9), axis=0), np.sort(mesh.vertices[mesh.faces].reshape(-1, 9), axis=0)
    )
    assert loaded.visual.material.image.size == (16, 16)


def test_forms_of_faces(tmp_path):
    text = """# comment
    v 0 0 0 1 0.5 0.5
    v 1 0 0\nv 1 1 0\nv 0 1 0
    vt 0 0\nvt 1 0 0\nvn 0 0 1
    f 1 2 3
    g second group
    f -4/1/1 -3/2/1 -2//1 -1
    f 1//1 2//1 \\
      3//1
    o third
    v 5 5 5
    f 5/2 1/1 2/2 3/1 4/1\n"""
    (tmp_path / "a.obj").write_text(text.replace("\n    ", "\n"))
    got = read_obj(tmp_path / "a.obj")
    np.testing.assert_array_equal(got.faces, [[0, 1, 2, -1, -1], [0, 1, 2, 3, -1], [0, 1, 2, -1, -1], [4, 0, 1, 2, 3]])
    np.testing.assert_array_equal(got.uv_faces[[1, 3]], [[0, 1, -1, -1, -1], [1, 0, 1, 0, 0]])
    assert got.objects == ("", "second group", "third")
    np.testing.assert_array_equal(got.face_object, [0, 1, 1, 2])
    faces, uv_faces, polygon = got.triangles()
    np.testing.assert_array_equal(faces, [[0, 1, 2], [0, 1, 2], [0, 2, 3], [0, 1, 2], [4, 0, 1], [4, 1, 2], [4, 2, 3]])
    np.testing.assert_array_equal(uv_faces[4:], [[1, 0, 1], [1, 1, 0], [1, 0, 0]])
    np.testing.assert_array_equal(polygon, [0, 1, 1, 2, 3, 3, 3])


def test_any_mixture_of_forms_is_read_as_written(tmp_path, rng):
    lines, faces, uv_faces, owners, objects = [], [], [], [], []
    n = t = 0
    vertices, uv = rng.normal(size=(400, 3)), rng.random((300, 2))
    while n < 400 or t < 300:
        kind = rng.choice(["v", "vt", "f", "o", "#"])
        if kind == "v" and n < 400:
            lines.append("v " + " ".join(map(repr, vertices[n].tolist())) + ["", " 0.5 0.5 0.5", " # a dot"][n % 3])
            n += 1
        elif kind == "vt" and t < 300:
            lines.append("vt\t" + " ".join(map(repr, uv[t].tolist())) + " 0" * (t % 2))
            t += 1
        elif kind == "o":
            objects = objects or ([""] if faces else [])
            objects.append(f"part {len(objects)}")
            lines.append(("g " if n % 2 else " o  ") + objects[-1])
        elif kind == "f" and n and t:
            corners = [(int(rng.integers(n)), int(rng.integers(t)), rng.integers(6)) for _ in range(rng.integers(3, 7))]
            forms = ["{0}/{2}", "{1}/{3}/1", "{0}//1", "{1}", "{0}/", "{0}/{3}"]
            words = [forms[form].format(i + 1, i - n, j + 1, j - t) for i, j, form in corners]
            lines.append("f " + " ".join(words))
            faces.append([i for i, _, _ in corners])
            uv_faces.append([j if form in (0, 1, 5) else -1 for _, j, form in corners])
            owners.append(max(len(objects) - 1, 0))
        else:
            lines.append("# f 1 2")
    (tmp_path / "a.obj").write_text("\n".join(lines))
    got = read_obj(tmp_path / "a.obj")
    np.testing.assert_array_equal(got.vertices, vertices)
    np.testing.assert_array_equal(got.uv, uv)
    width = max(map(len, faces))
    np.testing.assert_array_equal(got.faces, [face + [-1] * (width - len(face)) for face in faces])
    np.testing.assert_array_equal(got.uv_faces, [face + [-1] * (width - len(face)) for face in uv_faces])
    assert got.objects == tuple(objects)
    np.testing.assert_array_equal(got.face_object, owners)


def test_fans_keep_the_area_of_convex_polygons(tmp_path, rng):
    lines, area = [], 0.0
    for corners in (3, 4, 5, 8):
        angles = np.sort(rng.uniform(0, 2 * np.pi, corners))
        points = np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
        x, y = points[:, 0], points[:, 1]
        area += 0.5 * np.sum(x * np.roll(y, -1) - y * np.roll(x, -1))  # shoelace
        lines += [f"v {a!r} {b!r} {c!r}" for a, b, c in points.tolist()]
        lines.append("f " + " ".join(str(k - corners) for k in range(corners)))
    (tmp_path / "a.obj").write_text("\n".join(lines))
    got = read_obj(tmp_path / "a.obj")
    a, b, c = (got.vertices[got.triangles()[0][:, k]] for k in range(3))
    np.testing.assert_allclose(np.cross(b - a, c - a)[:, 2].sum() / 2, area, rtol=1e-12)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("v 1 2\nf 1 1 1", "line 1 of .*a.obj is 'v 1 2': expected 3 finite numbers"),
        ("v 1 2 x", "line 1 .*could not convert"),
        ("v 1 2 nan", "line 1 .*expected 3 finite"),
        ("vt 1", "line 1 .*expected 2 finite"),
        ("v 0 0 0\nf 1 1", "line 2 .*at least 3 corners, got 2"),
        ("v 0 0 0\nf 1 1 2", "line 2 .*index 2 is out of range, 1 elements"),
        ("v 0 0 0\nf 1 1 0", "line 2 .*index 0 is out of range"),
        ("v 0 0 0\nf 1 1 -2", "line 2 .*index -2 is out of range"),
        ("v 0 0 0\nf 1/1 1/1 1/1", "line 2 .*index 1 is out of range, 0 elements"),
        ("v 0 0 0\nf a b c", "line 2 .*invalid literal"),
        ("v 0 0 0\nvt 0 0\nf 1 1 1\nf 1/1 1/1 1/x", "line 4 .*invalid literal.* 'x'"),
        ("v 0 0 0\nf 1 1 1\nf 1 1 1\nf 1 1 7", "line 4 .*index 7 is out of range, 1 elements"),
        ("v 0 0 0\nf 1 1 -2\nv 0 0 0", "line 2 .*index -2 is out of range"),
        ("v 0 0 0\nf 1 1 " + 30 * "9", "line 2 .*index 9+ is out of range, 1 elements"),
        ("v 0 0 0\nf 1 1 " + 400 * "9", "line 2 .*int too large"),
        ("v 0 0 0\nvt 0 0\nf 1 1 1\nf 1/1 /1 1/1", "line 4 .*invalid literal"),
        ("v 0 0 0\nv 1 1 inf\nf 1 1 1", "line 2 .*expected 3 finite"),
        ("", "expected an OBJ with faces, got none in .*a.obj"),
        ("v 0 0 0\n", "expected an OBJ with faces, got none in .*a.obj"),
    ],
)
def test_wrong_files(tmp_path, text, message):
    (tmp_path / "a.obj").write_text(text)
    with pytest.raises(ValueError, match=message):
        read_obj(tmp_path / "a.obj")


def test_places(tmp_path, scene):
    with pytest.raises(FileNotFoundError):
        read_obj(tmp_path / "none.obj")
    with pytest.raises(ValueError, match=r"path: expected a name that ends in \.obj, got .*a\.txt"):
        write_obj(tmp_path / "a.txt", scene)
    (tmp_path / "a_texture.png").mkdir()
    with pytest.raises(OSError, match=r"cannot write .*a_texture\.png: "):
        write_obj(tmp_path / "a.obj", scene)
    assert [path.name for path in tmp_path.iterdir()] == ["a_texture.png"]


def test_what_editors_leave_in_a_file(tmp_path):
    """A byte order mark, comments behind numbers, and texture coordinates after the faces that use them."""
    path = tmp_path / "a.obj"
    faces = "f 1/1 2/2 3/3 # skin\nvt 0 0#\nvt 1 0\nvt 0 1 # end\n"
    path.write_text("\ufeffv 0 0 0 # a corner\nv 1 0 0\nv 0 1 0\n" + faces, encoding="utf-8")
    data = read_obj(path)
    np.testing.assert_array_equal(data.vertices, [[0, 0, 0], [1, 0, 0], [0, 1, 0]])
    np.testing.assert_array_equal(data.faces, [[0, 1, 2]])
    np.testing.assert_array_equal(data.uv[data.uv_faces[0]], [[0, 0], [1, 0], [0, 1]])


def test_one_huge_polygon_among_many_takes_no_memory(tmp_path):
    path = tmp_path / "a.obj"
    path.write_text("v 0 0 0\n" + "f 1 1 1\n" * 20_000 + "f" + " 1" * 5_000 + "\n")
    with pytest.raises(ValueError, match="line 20002 .*a polygon of 5000 corners among 20001 polygons"):
        read_obj(path)


def test_one_large_polygon_among_many_small_ones_takes_no_table_of_both(tmp_path):
    head = "v 0 0 0\nv 1 0 0\nv 0 1 0\n"
    (tmp_path / "a.obj").write_text(head + "f " + "1 2 3 " * 2000 + "\n" + "f 1 2 3\n" * 1000)
    with pytest.raises(ValueError, match="line 4 of .*a polygon of 6000 corners among 1001 polygons"):
        read_obj(tmp_path / "a.obj")
    (tmp_path / "b.obj").write_text(head + "f " + "1 2 3 " * 2000 + "\n" + "f 1 2 3\n" * 600)
    assert len(read_obj(tmp_path / "b.obj").triangles()[0]) == 5998 + 600


def test_pipes_and_large_files_are_refused(tmp_path, monkeypatch):
    os.mkfifo(tmp_path / "a.obj")
    with pytest.raises(ValueError, match=r"path: expected a file, but .*a\.obj is a device or a pipe"):
        read_obj(tmp_path / "a.obj")
    monkeypatch.setattr("toongeo.io.readers.read_obj._MOST_MB", 0)
    (tmp_path / "b.obj").write_text("v 0 0 0\n")
    with pytest.raises(ValueError, match=r"path: expected a file of at most 0 MB, but .*b\.obj is larger"):
        read_obj(tmp_path / "b.obj")


@pytest.mark.parametrize("encoding", ["utf-16", "utf-8-sig"])
@pytest.mark.parametrize("end", ["\r", "\r\n"])
def test_encodings_and_ends_of_lines(tmp_path, encoding, end):
    text = "v 0 0 0\nv 1 0 \\\n0\nv 0 1 0\nf 1 2 3\n"
    (tmp_path / "a.obj").write_bytes(text.replace("\n", end).encode(encoding))
    assert read_obj(tmp_path / "a.obj").vertices.tolist() == [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
