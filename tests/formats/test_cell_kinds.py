import pytest

from app.formats.cell_kinds import kind_of, plain_type
from app.notations.loader import load_notation


@pytest.mark.parametrize(
    ("cell_type", "kind"),
    [
        ("$add", "arithmetic"),
        ("$eqx", "arithmetic"),
        ("$reduce_xor", "logic"),
        ("$logic_not", "logic"),
        ("$_NAND_", "logic"),
        ("$_AOI3_", "logic"),
        ("$dffe", "flipflop"),
        ("$_SDFF_PP0_", "flipflop"),
        ("$_DLATCH_P_", "flipflop"),
        ("$pmux", "mux"),
        ("$_MUX_", "mux"),
        ("$mem_v2", "cell"),
        ("$lut", "cell"),
        ("AND2X1", "logic"),
        ("DFFRX1", "flipflop"),
        ("MUX2", "mux"),
        ("order_book", "cell"),
        ("level_shifter", "cell"),
        ("\\notify", "cell"),
        ("$", "cell"),
        ("", "cell"),
    ],
)
def test_a_type_of_cell_says_what_sort_of_thing_it_is(cell_type: str, kind: str) -> None:
    assert kind_of(cell_type) == kind
    assert kind in load_notation("netlist").items


@pytest.mark.parametrize(
    ("cell_type", "plain"),
    [("$add", "add"), ("$_DFF_P_", "DFF_P"), ("\\cpu", "cpu"), ("__x__", "__x__"), ("$_", "$_")],
)
def test_types_are_said_plainly(cell_type: str, plain: str) -> None:
    assert plain_type(cell_type) == plain
