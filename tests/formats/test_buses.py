from __future__ import annotations

from app.formats.buses import Bus, Port, Run, buses
from app.formats.netlist import Bit

DRIVER = Port(0, "Q", tuple(range(2, 10)), gives=True)


def takes(block: int, *bits: Bit) -> Port:
    return Port(block, "D", bits, gives=False)


def between(found: list[Bus] | tuple[Bus, ...]) -> list[tuple[tuple[int, int], list[int]]]:
    """Each bus: first and last place of its source, and the ports that take from it."""
    return [
        ((bus.source.first, bus.source.last), [run.port for run, _ in bus.takers]) for bus in found
    ]


def test_what_goes_from_one_port_to_another_is_one_bus() -> None:
    found = buses([DRIVER, takes(1, *range(2, 10))], 2)
    assert between(found.buses) == [((0, 7), [1])]
    assert found.buses[0].takers == [(Run(1, 0, 7), Run(0, 0, 7))]


def test_runs_that_overlap_are_one_bus_and_others_are_not() -> None:
    found = buses([DRIVER, takes(1, 2, 3, 4), takes(2, 4, 5), takes(3, 8, 9)], 4)
    assert between(found.buses) == [((0, 3), [1, 2]), ((6, 7), [3])]


def test_a_bit_that_comes_again_and_again_is_taken_once() -> None:
    found = buses([DRIVER, takes(1, 2, 3, 3, 3)], 2)
    assert between(found.buses) == [((0, 1), [1, 1])] or between(found.buses) == [
        ((0, 1), [1]),
        ((1, 1), [1]),
    ]
    assert sum(run.width for bus in found.buses for run, _ in bus.takers) == 4


def test_constants_are_no_bus() -> None:
    found = buses([DRIVER, takes(1, 2, "0", "1", 3)], 2)
    assert [(each.run, each.values) for each in found.constants] == [(Run(1, 1, 2), "10")]
    assert between(found.buses) == [((0, 0), [1]), ((1, 1), [1])]


def test_a_join_stands_only_where_one_list_of_runs_enters_two_ports() -> None:
    other = Port(1, "Q", (20, 21), gives=True)
    once = buses([DRIVER, other, takes(2, 2, 3, 20)], 3)
    assert once.joins == ()
    twice = buses([DRIVER, other, takes(2, 2, 3, 20), takes(3, 2, 3, 20)], 4)
    assert twice.joins == (4,)
    # Both take all that the join gives; the join takes from both drivers.
    assert between(twice.buses) == [((0, 1), [4]), ((0, 0), [4]), ((0, 2), [2, 3])]


def test_of_two_drivers_the_first_gives_and_the_other_is_joined_to_it() -> None:
    found = buses([Port(0, "Y", (2,), True), Port(1, "Y", (2,), True), takes(2, 2)], 3)
    assert between(found.buses) == [((0, 0), [1, 2])]


def test_what_nobody_drives_is_joined_still() -> None:
    found = buses([takes(0, 2), takes(1, 2)], 2)
    assert between(found.buses) == [((0, 0), [1])]


def test_single_bits_are_nets_of_their_own() -> None:
    found = buses([DRIVER, takes(1, *range(2, 10)), takes(2, *range(2, 10))], 3, single=True)
    assert between(found.buses) == [((place, place), [1, 2]) for place in range(8)]
