"""Pictures of numbers, and what is hidden in them."""

from __future__ import annotations

import numpy as np
import pytest

from app.arrays import Floats
from app.readability.drawing import Balls, Drawing, Labels, Triangles
from app.readability.lines import Lines
from app.readability.picture import NOTHING, empty_picture, paint_triangles
from app.readability.view import Readability, paint, readability
from tests.readability.views import ABOVE, seen_from

NO_BALLS = Balls(np.zeros((0, 3)), np.zeros(0), np.zeros(0, dtype=np.int64))
NO_TRIANGLES = Triangles(np.zeros((0, 3, 3)), np.zeros(0, dtype=np.int64))
NO_LABELS = Labels(np.zeros((0, 3)), np.zeros((0, 2)), np.zeros(0, dtype=np.int64))


def tubes(*ways: tuple[list[float], list[float]], radius: float = 0.1) -> Lines:
    """Straight tubes, each of a hyperedge of its own."""
    begins, ends = np.array(ways, dtype=np.float64).reshape(-1, 2, 3).transpose(1, 0, 2)
    return Lines(begins, ends, np.arange(len(ways)), np.full(len(ways), radius))


def plate(
    low: tuple[float, float], high: tuple[float, float], z: float, item: int = 0
) -> Triangles:
    """A level rectangle."""
    (a, b), (c, d) = low, high
    corners: Floats = np.array(
        [[[a, b, z], [c, b, z], [c, d, z]], [[a, b, z], [c, d, z], [a, d, z]]]
    )
    return Triangles(corners, np.array([item, item]))


def seen(
    lines: Lines,
    triangles: Triangles = NO_TRIANGLES,
    balls: Balls = NO_BALLS,
    labels: Labels = NO_LABELS,
) -> Readability:
    return readability(Drawing(lines, len(lines.owners), balls, triangles, labels), ABOVE)


ALONG_X = ([-2.0, 0.0, 0.0], [2.0, 0.0, 0.0])


def test_a_plate_before_half_of_a_tube_hides_half_of_it() -> None:
    found = seen(tubes(ALONG_X), plate((0.0, -1.0), (3.0, 1.0), 1.0))
    assert np.allclose(found.hidden, [0.5], atol=0.001)


def test_a_plate_behind_a_tube_hides_nothing() -> None:
    assert seen(tubes(ALONG_X), plate((0.0, -1.0), (3.0, 1.0), -1.0)).hidden.tolist() == [0.0]


def test_a_ball_hides_its_width() -> None:
    balls = Balls(np.array([[0.5, 0.0, 2.0]]), np.array([0.5]), np.array([0]))
    assert np.allclose(seen(tubes(ALONG_X), balls=balls).hidden, [0.25], atol=0.002)


def test_a_tube_hides_its_width_of_one_that_it_crosses() -> None:
    found = seen(tubes(ALONG_X, ([0.0, -2.0, 1.0], [0.0, 2.0, 1.0])))
    assert np.allclose(found.hidden, [0.05, 0.0], atol=0.002)
    assert (found.crossings, found.acute) == (1, 0)
    assert found.mean_hidden == pytest.approx(0.025, abs=0.001)


def test_a_hyperedge_does_not_hide_itself() -> None:
    lines = tubes(ALONG_X, ([0.0, -2.0, 1.0], [0.0, 2.0, 1.0]))._replace(owners=np.array([0, 0]))
    drawing = Drawing(lines, 1, NO_BALLS, NO_TRIANGLES, NO_LABELS)
    found = readability(drawing, ABOVE)
    assert found.hidden.tolist() == [0.0]
    assert found.crossings == 0


def test_shares_are_of_length_in_space() -> None:
    # Two pieces, equally long in the picture; the one that is hidden is three times as steep.
    pieces = Lines(
        np.array([[-1.0, 0.0, 0.0], [0.0, 0.0, 0.0]]),
        np.array([[0.0, 0.0, 0.0], [1.0, 0.0, -np.sqrt(8.0)]]),
        np.array([0, 0]),
        np.array([0.1, 0.1]),
    )
    drawing = Drawing(pieces, 1, NO_BALLS, plate((0.0, -1.0), (2.0, 1.0), 1.0), NO_LABELS)
    assert np.allclose(readability(drawing, ABOVE).hidden, [0.75], atol=0.002)


def test_a_thin_tube_far_away_is_seen_all_along() -> None:
    thin = tubes(([0.0, 0.0, 0.0], [1000.0, 371.0, 0.0]), radius=1e-4)
    assert seen(thin).hidden.tolist() == [0.0]


def test_a_tilted_plate_hides_what_is_behind_it_alone() -> None:
    # Through the tube at x = 1: nearer beyond.
    corners = np.array(
        [
            [[0.0, -1.0, -1.0], [2.0, -1.0, 1.0], [2.0, 1.0, 1.0]],
            [[0.0, -1.0, -1.0], [2.0, 1.0, 1.0], [0.0, 1.0, -1.0]],
        ]
    )
    # It comes before the tube's upper side, 0.1 above the middle line, at x = 1.1.
    found = seen(tubes(ALONG_X), Triangles(corners, np.array([0, 0])))
    assert np.allclose(found.hidden, [0.9 / 4], atol=0.002)


def test_as_much_is_hidden_from_nearby() -> None:
    # The eye is above the middle: the plate halfway down hides all of the half behind it.
    eye = seen_from(0.0, 0.0, 1.0, eye=(0.0, 0.0, 10.0))
    drawing = Drawing(tubes(ALONG_X), 1, NO_BALLS, plate((0.0, -1.0), (1.0, 1.0), 5.0), NO_LABELS)
    assert np.allclose(readability(drawing, eye).hidden, [0.5], atol=0.002)
    smaller = drawing._replace(triangles=plate((0.0, -1.0), (0.5, 1.0), 5.0))
    assert np.allclose(readability(smaller, eye).hidden, [0.25], atol=0.002)


@pytest.mark.parametrize("from_z", [1.0, -1.0])
def test_what_is_nearer_is_seen(from_z: float) -> None:
    plates = [plate((-1.0, -1.0), (1.0, 1.0), float(z), item=z) for z in range(3)]
    triangles = Triangles(*(np.concatenate(parts) for parts in zip(*plates, strict=True)))
    drawing = Drawing(tubes(), 0, NO_BALLS, triangles, NO_LABELS)
    picture = paint(drawing, seen_from(0.0, 0.0, from_z), 50)
    assert picture.numbers.shape == (50, 50)
    assert (picture.numbers[2:-2, 2:-2] == (2 if from_z > 0 else 0)).all()
    assert (picture.numbers[0] == NOTHING).all()


def test_a_triangle_is_seen_whichever_way_round() -> None:
    corners = ABOVE.seen(np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]))
    other = ABOVE.seen(np.array([[0.0, 0, 0], [0, 1, 0], [1, 0, 0]]))
    pictures = []
    for triangle in (corners, other):
        picture = empty_picture(np.zeros(2), np.ones(2), 100)
        paint_triangles(picture, triangle, np.array([4]))
        pictures.append(picture.numbers)
    assert np.array_equal(pictures[0], pictures[1])
    assert np.isclose((pictures[0] == 4).mean(), 0.5 * 0.98**2, atol=0.01)


def label(x: float, item: int) -> Labels:
    return Labels(np.array([[x, 0.0, 0.0]]), np.array([[2.0, 0.5]]), np.array([item]))


@pytest.mark.parametrize(
    ("z", "item", "covered"),
    [
        (1.0, 0, 0.25),  # of another item
        (1.0, 1, 0.0),  # of its own
        (-1.0, 0, 0.0),  # behind
        (0.04, 0, 0.0),  # hardly before it
    ],
)
def test_a_plate_covers_a_quarter_of_a_label(z: float, item: int, covered: float) -> None:
    found = seen(tubes(), plate((-1.0, -1.0), (0.0, 1.0), z, item), labels=label(0.5, 1))
    assert np.allclose(found.covered, [covered], atol=0.01)
    assert found.free_labels == float(covered < 0.2)


def test_a_tube_covers_a_label() -> None:
    found = seen(tubes(([-2.0, 0.0, 1.0], [2.0, 0.0, 1.0])), labels=label(0.0, 0))
    assert np.allclose(found.covered, [0.4], atol=0.02)


def test_of_nothing_all_is_readable() -> None:
    found = seen(tubes())
    assert (found.crossings, found.mean_hidden, found.free_labels) == (0, 0.0, 1.0)


def test_of_many_tubes_each_hides_as_much_in_any_order() -> None:
    chance = np.random.default_rng(7)
    ways = chance.uniform(-5.0, 5.0, (40, 2, 3))
    lines = Lines(
        ways[:, 0].copy(), ways[:, 1].copy(), np.arange(40), chance.uniform(0.05, 0.3, 40)
    )
    order = chance.permutation(40)
    other = Lines(lines.begins[order], lines.ends[order], np.arange(40), lines.radii[order])
    here, there = seen(lines), seen(other)
    assert np.allclose(here.hidden[order], there.hidden, atol=1e-12)
    assert (here.crossings, here.acute) == (there.crossings, there.acute)
