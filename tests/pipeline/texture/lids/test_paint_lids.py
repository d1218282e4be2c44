import dataclasses

import cv2
import numpy as np
import pytest

from toongeo.model.anatomy.lid_rings import lid_rings
from toongeo.pipeline.texture.bake_texture import _atlas_fragments, bake_texture
from toongeo.pipeline.texture.lids.lash_line import drawn_lashes, spike_count, stroked
from toongeo.pipeline.texture.lids.lid_membrane import lid_membrane, lid_ring
from toongeo.pipeline.texture.lids.lid_zones import lid_zone, skin_edges
from toongeo.pipeline.texture.lids.paint_lids import paint_lids
from toongeo.pipeline.texture.vertex_colours import vertex_colours

SKIN, INK = np.array([220.0, 180.0, 150.0]), 20.0


@pytest.fixture(scope="module")
def face(aligned):
    return aligned("moustache_man")


@pytest.fixture(scope="module")
def rig(transferred):
    return transferred("moustache_man")


@pytest.fixture(scope="module")
def edges(model):
    return skin_edges(model)


@pytest.fixture(scope="module")
def plain(cartoon):
    """A picture of bare skin."""
    return np.full_like(cartoon("moustache_man")[0], SKIN.astype(np.uint8))


def test_a_lid_is_what_the_blink_spreads(model, rig, edges):
    zone = lid_zone(model, rig, "left", edges)
    assert (zone[lid_rings(model, "left").upper] == 1).all() and zone.max() == 1 and zone.min() == 0
    for name in ("brow_left", "socket_left", "eye_right", "cheek_left", "nose"):
        assert zone[model.region(name) & ~model.region("eye_left")].max() == 0
    assert 0 < (zone > 0).sum() < 0.6 * model.region("eye_left").sum()
    mirrored = lid_zone(model, rig, "right", edges)[model.mirror]
    assert np.abs(mirrored - zone).mean() < 0.01


def test_no_lid_without_a_blink(model, rig, edges):
    still = [name.startswith("mouth") for name in rig.names]
    names = tuple(np.array(rig.names)[still])
    mute = dataclasses.replace(rig, names=names, deltas=rig.deltas[still])
    assert lid_zone(model, mute, "left", edges) is None


def test_the_membrane_knows_the_ring_alone(model, rig, edges):
    """Soot on the lid and on its edge, and lines in the ring, do not reach it; a ring of one colour gives that."""
    zone = lid_zone(model, rig, "left", edges)
    near, ring = lid_ring(model, "left", zone, edges)
    closed = rig.neutral + rig.deltas[rig.names.index("eyeBlinkLeft")]
    colours = np.tile(SKIN, (len(zone), 1))
    clean = lid_membrane(model, "left", zone, edges, colours, closed)
    ratio = clean[near] / SKIN
    np.testing.assert_allclose(ratio, np.repeat(ratio[:, :1], 3, 1), atol=1e-6)
    assert ratio.min() > 0.7 and ratio.max() < 1.09
    sooty = colours.copy()
    sooty[near & ~ring] = INK
    np.testing.assert_allclose(lid_membrane(model, "left", zone, edges, sooty, closed)[near], clean[near], atol=1e-6)
    lined = sooty.copy()
    lined[np.flatnonzero(ring)[::5]] = INK
    assert np.abs(lid_membrane(model, "left", zone, edges, lined, closed)[near & ~ring] - clean[near & ~ring]).max() < 4
    np.testing.assert_array_equal(clean[~near], colours[~near])


def test_a_lid_shades_from_one_side_of_the_ring_to_the_other(model, rig, edges):
    """A membrane has no extreme inside: between a darker and a lighter end everything lies between."""
    zone = lid_zone(model, rig, "left", edges)
    near, ring = lid_ring(model, "left", zone, edges)
    colours = SKIN + np.clip(model.mean[:, :1] - model.mean[near, 0].mean(), -15, 15) / 5
    out = lid_membrane(model, "left", 0 * zone, edges, colours, model.mean)  # without a zone there is no shade
    assert (out[near] >= colours[ring].min(0) - 1e-3).all() and (out[near] <= colours[ring].max(0) + 1e-3).all()


def test_lashes_are_as_dark_and_thick_as_they_are_drawn(face, plain):
    face = dataclasses.replace(face, camera=face.camera.scaled(4))
    plain = cv2.resize(plain, None, fx=4, fy=4)
    rings = lid_rings(face.model, "left")
    edge = face.project(face.vertices[rings.upper[1]])
    width = np.linalg.norm(edge[-1] - edge[0])
    skin = np.tile(SKIN, (len(face.vertices), 1))
    lines = []
    for thickness in (0.04, 0.1):
        img = plain.copy()
        path = [np.rint(edge * 16).astype(np.int32)]
        cv2.polylines(img, path, False, (INK,) * 3, round(thickness * width), cv2.LINE_AA, 4)
        lines.append(drawn_lashes(img, face, "left", skin))
    thin, thick = lines
    middle = slice(3, -3)
    assert np.abs(thick.colours[middle] - INK).max() < 15 and (thick.cover[middle] > 0.99).all()
    assert thin.width < thick.width
    none = drawn_lashes(plain, face, "left", skin)
    assert (none.cover < 0.6).all() and np.allclose(none.colours, 0.62 * SKIN, atol=2)


def test_a_stroke_stays_at_the_edge_of_the_lid(face, rig, plain):
    model = face.model
    rings = lid_rings(model, "left")
    line = drawn_lashes(plain, face, "left", np.tile(SKIN, (len(face.vertices), 1)))
    line = dataclasses.replace(line, colours=np.full_like(line.colours, INK), cover=np.ones_like(line.cover))
    texture = np.full((512, 512, 3), 200.0, np.float32)
    painted = stroked(texture, model, rig.neutral, "left", line)
    assert (texture == 200).all()
    at = vertex_colours(model, painted)
    middle = rings.upper[1:, 5:-5]
    assert at[middle].mean() < 130 and (np.abs(at[rings.lower[:, 8:-8]] - 200) < 2).all()
    off = model.region("skin") & ~model.region("eye_left")
    assert np.abs(at[off] - 200).max() < 1


def test_only_lids_are_painted(face, rig, plain):
    model = face.model
    texture = np.full((256, 256, 3), 120, np.uint8)
    painted = paint_lids(texture, _atlas_fragments(model, 256), plain, face, rig)
    changed = np.abs(vertex_colours(model, painted) - 120).max(1) > 1
    assert changed[model.region("eyelid_upper_left")].any() and changed[model.region("eyelid_upper_right")].any()
    around = model.region("eye_left") | model.region("eye_right")
    assert not changed[model.region("skin") & ~around].any()
    np.testing.assert_array_equal(texture, 120)


def test_streaks_over_an_eye_are_gone_when_it_closes(face, rig, cartoon):
    """The drawn lashes, thick and black, are no longer on the lid but for the line at its edge."""
    model, img = face.model, cartoon("moustache_man")[0]
    texture = np.tile(SKIN, (256, 256, 1)).astype(np.uint8)
    atlas = _atlas_fragments(model, 256)
    edges = skin_edges(model)
    zone = lid_zone(model, rig, "left", edges)
    sooty = texture.copy()
    lid = atlas.mask & (zone[model.faces] > 0.9).all(1)[atlas.face_ids]
    sooty[lid] = 10
    painted = vertex_colours(model, paint_lids(sooty, atlas, img, face, rig))
    rims = np.isin(np.arange(len(zone)), lid_rings(model, "left").vertices)
    inner = (zone > 0.9) & ~(edges @ (edges @ (edges @ rims.astype(float))) > 0)
    assert inner.sum() > 20
    assert np.median(painted[inner].mean(1)) > 0.8 * SKIN.mean()


def spiked(picture, face, side, count):
    """The picture with strokes standing on an upper lid."""
    out, edge = picture.copy(), face.project(face.vertices[lid_rings(face.model, side).upper[1]])
    width = np.linalg.norm(edge[-1] - edge[0])
    for foot in edge[np.linspace(3, len(edge) - 4, count).round().astype(int)]:
        ends = np.rint([foot, foot - [0, 0.2 * width]]).astype(int).tolist()
        cv2.line(out, *ends, (20, 20, 20), 1)
    return out


def test_spikes_of_lashes_are_counted(face, plain):
    skin = np.tile(SKIN, (len(face.vertices), 1))
    assert spike_count(plain, face, "left", skin) == 0
    assert spike_count(spiked(plain, face, "left", 3), face, "left", skin) == 3
    assert spike_count(spiked(plain, face, "left", 8), face, "left", skin) == 8
    assert spike_count(spiked(plain, face, "left", 8), face, "right", skin) == 0


def test_lashes_drawn_one_by_one_stay_above_the_eye(face, rig, cartoon, edges):
    img, _ = cartoon("moustache_man")
    texture = bake_texture(img, face, size=512)
    painted = paint_lids(texture, _atlas_fragments(face.model, 512), img, face, rig)
    without = paint_lids(texture, _atlas_fragments(face.model, 512), np.full_like(img, 200), face, rig)
    kept = []
    for side in ("left", "right"):
        zone, strip = (lid_zone(face.model, rig, side, edges, limits) for limits in ((1.3, 2.2), (2.2, 3.5)))
        above = (zone > 0.3) & (strip < 0.3) & ~np.isin(np.arange(len(zone)), lid_rings(face.model, side).vertices)
        dark = [(vertex_colours(face.model, image).mean(1) < 120)[above].sum() for image in (texture, painted, without)]
        assert dark[0] > 10
        kept.append([dark[1] / dark[0], dark[2] / dark[0]])
    kept = np.mean(kept, axis=0)
    assert kept[0] > 0.7 and kept[1] < kept[0] - 0.2
