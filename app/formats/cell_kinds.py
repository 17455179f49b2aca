"""What sort of thing a cell is, by the name of its type."""

from __future__ import annotations

import re

KINDS = {
    "flipflop": ("dff", "sdff", "adff", "aldff", "dlatch", "adlatch", "ff", "sr"),
    "mux": ("mux", "pmux", "bmux", "demux", "nmux", "bwmux"),
    "arithmetic": ("add", "sub", "mul", "div", "mod", "neg", "alu", "macc", "fa", "lcu", "pow",
                   "lt", "le", "eq", "ne", "ge", "gt", "shl", "shr", "sshl", "sshr", "shift"),
    "logic": ("and", "or", "xor", "xnor", "nand", "nor", "not", "inv", "buf", "logic", "reduce",
              "pos", "aoi", "oai", "tbuf", "tribuf", "bweqx"),
}  # fmt: skip
"""Kinds of cells, by how the types begin that Yosys has of its own (the first that fits)."""

UNMISTAKABLE = ("dff", "mux")
"""Beginnings that mean the same in a library's names; "or" begins "order" too."""


def kind_of(cell_type: str) -> str:
    """The kind of a cell in the notation of netlists.

    >>> [kind_of(name) for name in ("$add", "$_DFF_P_", "AND2", "MUX2", "order", "cpu")]
    ['arithmetic', 'flipflop', 'logic', 'mux', 'cell', 'cell']
    """
    plain = plain_type(cell_type).lower()
    own = cell_type.startswith("$")
    letters = "".join(re.findall(r"^[a-z]+", plain))
    for kind, beginnings in KINDS.items():
        if own and plain.startswith(beginnings):
            return kind
        if not own and (
            letters in beginnings
            or letters.startswith(tuple(name for name in UNMISTAKABLE if name in beginnings))
        ):
            return kind
    return "cell"


def plain_type(cell_type: str) -> str:
    r"""A cell's type as people say it.

    >>> plain_type("$add"), plain_type("$_AND_"), plain_type("\\cpu")
    ('add', 'AND', 'cpu')
    """
    if cell_type.startswith("$"):
        return cell_type.lstrip("$").strip("_") or cell_type
    return cell_type.lstrip("\\") or cell_type
