"""The bits of buses as one: runs of bits that go from one port to another together."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from app.formats.netlist import Bit


@dataclass(frozen=True, slots=True)
class Port:
    """A port of the block with this number, with its bits; ``gives``: whether it may drive them."""

    block: int
    name: str
    bits: tuple[Bit, ...]
    gives: bool


@dataclass(frozen=True, slots=True)
class Run:
    """Places ``first`` to ``last`` of a port: what a pin has."""

    port: int
    first: int
    last: int

    @property
    def width(self) -> int:
        """How many bits it has."""
        return self.last - self.first + 1


@dataclass(slots=True)
class Bus:
    """A run of a driving port, and the runs that take from it: each with the part that it takes."""

    source: Run
    takers: list[tuple[Run, Run]] = field(default_factory=list)


@dataclass(frozen=True, slots=True)
class Constant:
    """A run that is fed by constants, ``values`` from its last bit to its first."""

    run: Run
    values: str


@dataclass(frozen=True, slots=True)
class Buses:
    """All ports, those of joins among them, with what is between them.

    A join stands for one list of runs that enters two or more ports: ``joins`` are the numbers of
    their blocks, which follow all others. Each has a port A that takes and a port Y that gives.
    """

    ports: tuple[Port, ...]
    buses: tuple[Bus, ...]
    constants: tuple[Constant, ...]
    joins: tuple[int, ...]


def buses(ports: Sequence[Port], blocks: int, *, single: bool = False) -> Buses:
    """What runs between ``ports`` of so many ``blocks``; each bit for itself where ``single``.

    A port's bits are cut into the longest runs of consecutive bits of one driving port, of one bit
    again and again, or of constants. Runs of one driving port that overlap are one bus.
    """
    every = list(ports)
    drivers = _drivers(ports)
    wanted: list[tuple[Run, Run]] = []
    constants: list[Constant] = []
    lists: dict[tuple[Run, ...], list[list[tuple[Run, Run]]]] = defaultdict(list)
    for number, port in enumerate(ports):
        runs: list[tuple[Run, Run]] = []
        pure = True
        for run, source in _runs(number, port, drivers, single=single):
            if source is None:
                constants.append(Constant(run, _values(port.bits[run.first : run.last + 1])))
                pure = False
            else:
                runs.append((run, source))
        whole = pure and sum(run.width for run, _ in runs) == len(port.bits)
        if whole and len(runs) > 1 and not single:
            lists[tuple(source for _, source in runs)].append(runs)
        else:
            wanted.extend(runs)
    joins: list[int] = []
    for sources, users in lists.items():
        if len(users) == 1:
            wanted.extend(users[0])
            continue
        block = blocks + len(joins)
        joins.append(block)
        bits = tuple(bit for source in sources for bit in _bits(ports, source))
        taking, giving = len(every), len(every) + 1
        every += [Port(block, "A", bits, gives=False), Port(block, "Y", bits, gives=True)]
        wanted.extend((Run(taking, run.first, run.last), source) for run, source in users[0])
        for runs in users:
            whole_run = Run(runs[0][0].port, 0, len(bits) - 1)
            wanted.append((whole_run, Run(giving, 0, len(bits) - 1)))
    return Buses(tuple(every), tuple(_merged(wanted)), tuple(constants), tuple(joins))


def _bits(ports: Sequence[Port], run: Run) -> tuple[Bit, ...]:
    return ports[run.port].bits[run.first : run.last + 1]


def _values(bits: Sequence[Bit]) -> str:
    return "".join(str(bit) for bit in reversed(bits))


def _drivers(ports: Sequence[Port]) -> dict[Bit, tuple[int, int]]:
    """The port and place that drives each bit: the first that may, else the first of all."""
    found: dict[Bit, tuple[int, int]] = {}
    for gives in (True, False):
        for number, port in enumerate(ports):
            if port.gives is gives:
                for place, bit in enumerate(port.bits):
                    if not isinstance(bit, str):
                        found.setdefault(bit, (number, place))
    return found


def _runs(
    number: int, port: Port, drivers: dict[Bit, tuple[int, int]], *, single: bool
) -> Iterator[tuple[Run, Run | None]]:
    """The runs of a port that others drive, and of what; None: of constants."""
    place = 0
    bits = port.bits
    while place < len(bits):
        first = place
        bit = bits[first]
        place += 1
        if isinstance(bit, str):
            while place < len(bits) and isinstance(bits[place], str) and not single:
                place += 1
            yield Run(number, first, place - 1), None
            continue
        source, start = drivers[bit]
        if (source, start) == (number, first):
            continue
        end = start
        if not single:
            while place < len(bits) and bits[place] == bit:
                place += 1
            if place == first + 1:
                while place < len(bits) and drivers.get(bits[place]) == (source, end + 1):
                    # What the port drives itself is no part of it.
                    place, end = place + 1, end + 1
        yield Run(number, first, place - 1), Run(source, start, end)


def _merged(wanted: Sequence[tuple[Run, Run]]) -> list[Bus]:
    """One bus for all runs of a driving port that overlap."""
    by_port: dict[int, list[tuple[Run, Run]]] = defaultdict(list)
    for taker, source in wanted:
        by_port[source.port].append((taker, source))
    found: list[Bus] = []
    for port in sorted(by_port):
        last = -1
        for taker, source in sorted(by_port[port], key=lambda each: each[1].first):
            if source.first > last:
                found.append(Bus(source))
            bus = found[-1]
            last = max(last, source.last)
            bus.source = Run(port, bus.source.first, last)
            bus.takers.append((taker, source))
    return found
