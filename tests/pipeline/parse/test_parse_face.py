"""The classical parser on pictures whose parts are known."""

import cv2
import numpy as np
import pytest

from tests.conftest import PORTRAITS
from toongeo import ClassicalParser, FaceLabel, FaceParse, HairMask, fit_3dmm, parse_face
from toongeo.model.ibug68 import MIRROR

FACE = [
    FaceLabel.SKIN,
    FaceLabel.NOSE,
    *(FaceLabel.BROW_LEFT, FaceLabel.BROW_RIGHT, FaceLabel.EYE_LEFT, FaceLabel.EYE_RIGHT),
    *(FaceLabel.UPPER_LIP, FaceLabel.LOWER_LIP, FaceLabel.INNER_MOUTH),
]
SWAPPED = {
    FaceLabel.BROW_LEFT: FaceLabel.BROW_RIGHT,
    FaceLabel.BROW_RIGHT: FaceLabel.BROW_LEFT,
    FaceLabel.EYE_LEFT: FaceLabel.EYE_RIGHT,
    FaceLabel.EYE_RIGHT: FaceLabel.EYE_LEFT,
}


def grey(img):
    return cv2.cvtColor(cv2.cvtColor(img, cv2.COLOR_RGB2GRAY), cv2.COLOR_GRAY2RGB)


def overlap(a, b):
    return (a & b).sum() / (a | b).sum()


@pytest.fixture(scope="module")
def parse(drawn_face):
    return parse_face(drawn_face.img, drawn_face.landmarks)


@pytest.mark.parametrize("look", [np.copy, grey])
def test_the_parts_of_a_drawn_face_are_found(drawn_face, look):
    parse = parse_face(look(drawn_face.img), drawn_face.landmarks)
    head = drawn_face.labels > 0
    assert overlap(parse.labels > 0, head) > 0.95
    assert overlap(parse.mask(FaceLabel.HAIR), drawn_face.labels == FaceLabel.HAIR) > 0.8
    assert overlap(parse.mask(FaceLabel.NECK), drawn_face.labels == FaceLabel.NECK) > 0.85
    for eye in (FaceLabel.EYE_LEFT, FaceLabel.EYE_RIGHT):
        assert overlap(parse.mask(eye), drawn_face.labels == eye) > 0.75
    assert overlap(parse.mask(FaceLabel.UPPER_LIP, FaceLabel.LOWER_LIP), drawn_face.labels == FaceLabel.UPPER_LIP) > 0.6


@pytest.mark.parametrize("look", [np.copy, grey])
def test_background_is_not_taken_for_skin(drawn_face, look):
    parse = parse_face(look(drawn_face.img), drawn_face.landmarks)
    away = cv2.erode((drawn_face.labels == 0).astype(np.uint8), np.ones((5, 5), np.uint8)) > 0
    assert not (parse.mask(*FACE) & away).any()


def test_brows_and_nose_lie_along_their_landmarks(drawn_face, parse):
    for label, points in (
        (FaceLabel.BROW_RIGHT, drawn_face.landmarks[18:21]),
        (FaceLabel.BROW_LEFT, drawn_face.landmarks[23:26]),
        (FaceLabel.NOSE, drawn_face.landmarks[[28, 29, 30]]),
    ):
        x, y = np.rint(points).astype(int).T
        assert (parse.labels[y, x] == label).all()


def test_confidence_is_low_at_borders_and_high_away_from_them(drawn_face, parse):
    skin = (parse.labels == FaceLabel.SKIN).astype(np.uint8)
    depth = cv2.distanceTransform(skin, cv2.DIST_L2, 5)
    assert parse.confidence[(depth > 0) & (depth < 1.5)].mean() + 0.2 < parse.confidence[depth > 15].mean()


def test_a_mirrored_picture_gives_mirrored_labels(drawn_face, parse):
    mirrored = drawn_face.landmarks.copy()
    mirrored[:, 0] = drawn_face.img.shape[1] - 1 - mirrored[:, 0]
    other = parse_face(np.ascontiguousarray(drawn_face.img[:, ::-1]), mirrored[MIRROR]).labels[:, ::-1]
    back = np.array([SWAPPED.get(label, label) for label in FaceLabel], np.uint8)[other]
    assert (back == parse.labels).mean() > 0.98


@pytest.mark.parametrize("factor", [0.5, 2.0])
def test_the_scale_of_the_picture_does_not_matter(drawn_face, parse, factor):
    method = cv2.INTER_AREA if factor < 1 else cv2.INTER_CUBIC
    img = cv2.resize(drawn_face.img, None, fx=factor, fy=factor, interpolation=method)
    other = parse_face(img, (drawn_face.landmarks + 0.5) * factor - 0.5).labels
    back = cv2.resize(other, parse.labels.shape[::-1], interpolation=cv2.INTER_NEAREST)
    assert (back == parse.labels).mean() > 0.97


def test_the_same_picture_gives_the_same_parse(drawn_face, parse):
    cv2.setRNGSeed(77)
    again = parse_face(drawn_face.img, drawn_face.landmarks)
    np.testing.assert_array_equal(again.labels, parse.labels)
    np.testing.assert_array_equal(again.confidence, parse.confidence)


def test_without_a_fit_the_landmarks_are_fitted(drawn_face, parse):
    given = parse_face(drawn_face.img, drawn_face.landmarks, fit_3dmm(None, drawn_face.landmarks))
    np.testing.assert_array_equal(given.labels, parse.labels)


def test_missing_landmarks_are_taken_from_the_fit(drawn_face, parse):
    some = drawn_face.landmarks.copy()
    some[[3, 20, 38, 50, 62]] = np.nan
    assert (parse_face(drawn_face.img, some).labels == parse.labels).mean() > 0.97


def test_a_head_that_fills_the_frame_is_parsed(drawn_face, parse):
    rows, columns = slice(110, 330), slice(100, 300)
    img = np.ascontiguousarray(drawn_face.img[rows, columns])
    close = parse_face(img, np.clip(drawn_face.landmarks - [100, 110], 0, [199, 219]))
    skin = drawn_face.labels[rows, columns] == FaceLabel.SKIN
    assert (close.mask(*FACE, FaceLabel.EARS) & skin).sum() > 0.9 * skin.sum()


def test_dark_outlines_belong_to_neither_side(drawn_face):
    img = drawn_face.img.copy()
    head = (drawn_face.labels > 0).astype(np.uint8)
    border, _ = cv2.findContours(head, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
    line = cv2.polylines(np.zeros_like(head), border, True, 1, 3) > 0
    img[line] = 0
    line &= np.arange(len(img))[:, None] < 200  # above the shoulders
    parse = parse_face(img, drawn_face.landmarks)
    assert not (parse.mask(*FACE) & line).sum() > 0.02 * line.sum()


@pytest.mark.parametrize("name", ["bad_guy", "beethoven", "blonde_girl_threequarter", "manga_girl", "moustache_man"])
def test_heads_of_drawings_match_hand_made_masks(cartoon, name):
    mask = cv2.imread(str(PORTRAITS / "masks" / f"{name}.png"), cv2.IMREAD_GRAYSCALE) > 0
    parse = parse_face(*cartoon(name))
    assert overlap(parse.labels > 0, mask) > 0.93
    assert (parse.mask(*FACE) & ~mask).sum() < 0.005 * parse.mask(*FACE).sum()


def test_another_parser_can_be_plugged_in(drawn_face):
    calls = []

    def parser(img, landmarks, fit=None):
        calls.append((img.shape, landmarks.shape, fit))
        return FaceParse(np.zeros(img.shape[:2], np.uint8), np.ones(img.shape[:2]))

    assert not parse_face(drawn_face.img, drawn_face.landmarks, parser=parser).labels.any()
    assert calls == [(drawn_face.img.shape, (68, 2), None)]


def test_labels_of_another_size_are_refused(drawn_face):
    def parser(img, landmarks, fit=None):
        return FaceParse(np.zeros((5, 4), np.uint8), np.ones((5, 4)))

    with pytest.raises(ValueError, match=r"parser: expected labels of shape \(400, 400\), got \(5, 4\)"):
        parse_face(drawn_face.img, drawn_face.landmarks, parser=parser)


@pytest.mark.parametrize("call", [parse_face, ClassicalParser()])
def test_bad_input_is_refused(drawn_face, call):
    with pytest.raises(ValueError, match="img: expected .* uint8 RGB, got float64"):
        call(drawn_face.img.astype(float), drawn_face.landmarks)
    with pytest.raises(ValueError, match="img: expected"):
        call(drawn_face.img[..., 0], drawn_face.landmarks)
    with pytest.raises(ValueError, match="all rows are NaN"):
        call(drawn_face.img, np.full((68, 2), np.nan))
    with pytest.raises(ValueError, match="landmarks: expected 68 points"):
        call(drawn_face.img, drawn_face.landmarks[:51])


def test_arguments_are_not_written_to(drawn_face):
    img, landmarks = drawn_face.img.copy(), drawn_face.landmarks.copy()
    parse_face(img, landmarks)
    np.testing.assert_array_equal(img, drawn_face.img)
    np.testing.assert_array_equal(landmarks, drawn_face.landmarks)


def test_labels_follow_a_given_hair_mask(drawn_face, parse):
    """All of it but outlines and features, and nothing beside it."""
    band = np.zeros(drawn_face.labels.shape, bool)
    band[60:100, 120:280] = True
    given = parse_face(drawn_face.img, drawn_face.landmarks, hair_mask=band)
    assert given.hair.trusted and not (given.mask(FaceLabel.HAIR) & ~band).any()
    assert overlap(given.mask(FaceLabel.HAIR), band) > 0.9
    np.testing.assert_array_equal(given.hair.mask, band)
    face = parse.mask(*FACE) & ~band
    assert overlap(given.mask(*FACE), face) > 0.95


def test_a_hat_gets_its_own_label(drawn_face):
    hat = np.zeros(drawn_face.labels.shape, bool)
    hat[40:90, 120:280] = True
    finder = lambda *_: HairMask(np.zeros_like(hat), False, ("a hat",), hat=hat)  # noqa: E731
    parse = ClassicalParser(hair_finder=finder)(drawn_face.img, drawn_face.landmarks)
    np.testing.assert_array_equal(parse.mask(FaceLabel.HAT), hat)
    assert not parse.hair.mask.any() and parse.hair.reasons == ("a hat",)


def test_a_mask_that_is_not_trusted_does_not_rule_the_labels(drawn_face, parse):
    """Skin and background in it are no hair; where nothing was found the cuts of head and skin tell the hair."""
    true = drawn_face.labels == FaceLabel.HAIR
    wrong = true.copy()
    wrong[:20, :60] = wrong[200:230, 190:220] = True
    for mask in (wrong, np.zeros_like(true)):
        finder = lambda *_, mask=mask: HairMask(mask, False, ("doubtful",))  # noqa: E731
        found = ClassicalParser(hair_finder=finder)(drawn_face.img, drawn_face.landmarks)
        assert overlap(found.mask(FaceLabel.HAIR), true) > 0.8
        np.testing.assert_array_equal(found.hair.mask, mask)
    trusting = ClassicalParser(hair_finder=lambda *_: HairMask(wrong, True))(drawn_face.img, drawn_face.landmarks)
    assert (trusting.labels[:20, :60] == FaceLabel.HAIR).mean() > 0.9


def test_hair_of_a_plugged_in_parser_is_that_of_its_labels(drawn_face):
    labelled = lambda img, landmarks, fit=None: FaceParse(drawn_face.labels, np.ones(img.shape[:2]))  # noqa: E731
    parse = parse_face(drawn_face.img, drawn_face.landmarks, parser=labelled)
    np.testing.assert_array_equal(parse.hair.mask, drawn_face.labels == FaceLabel.HAIR)
    assert parse.hair.trusted
    bald = lambda img, landmarks, fit=None: FaceParse(np.zeros(img.shape[:2], np.uint8), np.ones(img.shape[:2]))  # noqa: E731
    assert parse_face(drawn_face.img, drawn_face.landmarks, parser=bald).hair.reasons


def test_a_given_mask_wins_over_a_plugged_in_parser(drawn_face):
    band = np.zeros(drawn_face.labels.shape, bool)
    band[60:100, 120:280] = True
    labelled = lambda img, landmarks, fit=None: FaceParse(drawn_face.labels, np.ones(img.shape[:2]))  # noqa: E731
    parse = parse_face(drawn_face.img, drawn_face.landmarks, parser=labelled, hair_mask=band)
    np.testing.assert_array_equal(parse.mask(FaceLabel.HAIR), band)
    assert (parse.labels[(drawn_face.labels == FaceLabel.HAIR) & ~band] == FaceLabel.OTHER).all()


def test_a_hair_mask_of_another_size_is_refused(drawn_face):
    with pytest.raises(ValueError, match="hair_mask: expected the picture's size"):
        parse_face(drawn_face.img, drawn_face.landmarks, hair_mask=np.ones((3, 4), bool))
