from hypothesis import given
from hypothesis import strategies as st

from app.placement import rows
from app.placement.rows import FEW, arrange

sizes = st.lists(st.tuples(st.floats(0.1, 5), st.floats(0.1, 5)), min_size=1, max_size=60)


@given(sizes, st.floats(0.01, 1), st.sampled_from(["row", "column", "rows"]))
def test_rectangles_are_a_gap_apart_and_within_the_whole(
    rectangles: list[tuple[float, float]], gap: float, arrangement: str
) -> None:
    made = arrange(rectangles, gap, arrangement)  # type: ignore[arg-type]
    boxes = [
        (x - w / 2, x + w / 2, y - d / 2, y + d / 2)
        for (x, y), (w, d) in zip(made.centers, rectangles, strict=True)
    ]
    slack = 1e-9
    for number, (left, right, near, far) in enumerate(boxes):
        assert left >= -made.width / 2 - slack
        assert right <= made.width / 2 + slack
        assert near >= -made.depth / 2 - slack
        assert far <= made.depth / 2 + slack
        for other in boxes[:number]:
            beside = max(left - other[1], other[0] - right)
            behind = max(near - other[3], other[2] - far)
            assert max(beside, behind) >= gap - slack


@given(st.integers(2, 60))
def test_they_read_from_left_to_right_and_from_the_back(count: int) -> None:
    made = arrange([(1.0, 1.0)] * count, 0.2)
    reading = sorted(made.centers, key=lambda center: (-round(center[1], 6), center[0]))
    assert reading == list(made.centers)


def test_a_row_and_a_column() -> None:
    assert arrange([(1.0, 2.0)] * 3, 0.5, "row").depth == 2.0
    assert arrange([(1.0, 2.0)] * 3, 0.5, "column").width == 1.0


def test_twenty_thousand_rectangles_make_a_good_whole() -> None:
    made = arrange([(1.0, 1.0)] * 20_000, 0.5)
    assert 0.8 < made.width / made.depth < 2.0


def test_nothing_takes_no_room() -> None:
    assert arrange([], 1.0).width == 0.0


def test_many_rectangles_are_forgotten_again() -> None:
    kept = rows._kept.cache_info().currsize
    arrange([(1.5, 1.25)] * (FEW + 1), 0.3)
    assert rows._kept.cache_info().currsize == kept
