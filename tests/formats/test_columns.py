from app.formats.columns import depths, levels


def chain(length: int) -> tuple[list[tuple[int, ...]], list[tuple[int, ...]]]:
    return [(n,) for n in range(length - 1)], [(n + 1,) for n in range(length - 1)]


def test_depth_is_the_longest_way() -> None:
    # 0 → 1 → 2 → 3, and a short cut 0 → 3.
    drivers, takers = chain(4)
    assert depths([0] * 4, [False] * 4, [*drivers, (0,)], [*takers, (3,)]) == [0, 1, 2, 3]


def test_a_net_with_two_drivers_stands_behind_both() -> None:
    assert depths([0] * 4, [False] * 4, [(0,), (1, 0)], [(1,), (2, 3)]) == [0, 1, 2, 2]


def test_a_block_that_starts_anew_is_not_behind_its_drivers() -> None:
    drivers, takers = chain(4)
    assert depths([0] * 4, [False, False, True, False], drivers, takers) == [0, 1, 0, 1]


def test_a_circle_is_cut_at_its_first_block() -> None:
    assert depths([0] * 3, [False] * 3, [(0,), (1,), (2,)], [(1,), (2,), (0,)]) == [0, 1, 2]


def test_a_net_that_nobody_drives_holds_nobody_up() -> None:
    assert depths([0] * 2, [False] * 2, [(), (0,)], [(0, 1), (1,)]) == [0, 1]


def test_a_very_long_chain_and_a_very_full_net_are_no_trouble() -> None:
    drivers, takers = chain(50_000)
    assert depths([0] * 50_000, [False] * 50_000, drivers, takers)[-1] == 49_999
    half = 25_000
    full = depths(
        [0] * 2 * half, [False] * 2 * half, [tuple(range(half))], [tuple(range(half, 2 * half))]
    )
    assert set(full[half:]) == {1}


def test_blocks_stand_level_with_their_drivers() -> None:
    # 0 drives 3, 1 drives 2: crossing where they stand in the order of their numbers.
    assert levels([[0, 1], [2, 3]], [(0,), (1,)], [(3,), (2,)]) == [[0, 1], [3, 2]]


def test_blocks_without_drivers_keep_their_order() -> None:
    assert levels([[2, 0, 1]], [], []) == [[2, 0, 1]]
