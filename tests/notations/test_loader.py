import pytest

from app.errors import UnknownName
from app.notations.loader import load_notation, notation_names
from app.scene.color import linear_of, srgb_of

PAPERS_KINDS = {
    "clause", "head", "literal", "argument", "partitioned_set", "partition", "ntuple", "variable",
    "constant", "term_table", "intensional_set",
}  # fmt: skip


def test_there_are_notations_for_the_paper_and_for_circuits() -> None:
    assert {"plain", "sparcl", "netlist"} <= set(notation_names())


@pytest.mark.parametrize("name", notation_names())
def test_a_notation_loads_under_its_own_name_and_says_what_it_is(name: str) -> None:
    notation = load_notation(name)
    assert notation.name == name
    assert notation.title
    assert notation.description.endswith(".")


def test_sparcl_knows_all_kinds_of_the_paper() -> None:
    assert set(load_notation("sparcl").items) >= PAPERS_KINDS


def _contrast(one: str, other: str) -> float:
    """The contrast ratio of WCAG 2.2, 1 to 21."""
    lights = sorted(
        sum(w * c for w, c in zip((0.2126, 0.7152, 0.0722), linear_of(srgb_of(color)), strict=True))
        for color in (one, other)
    )
    return float((lights[1] + 0.05) / (lights[0] + 0.05))


@pytest.mark.parametrize("name", notation_names())
def test_labels_stand_out_from_their_items(name: str) -> None:
    notation = load_notation(name)
    for style in (*notation.items.values(), notation.other_items):
        assert _contrast(style.color, style.label_color) >= 4.5


def test_kinds_that_a_notation_does_not_name_look_like_others() -> None:
    notation = load_notation("sparcl")
    assert notation.item_style("surprise") == notation.item_style(None) == notation.other_items
    assert notation.hyperedge_style("surprise") == notation.other_hyperedges


def test_an_unknown_notation_is_named_with_the_known_ones() -> None:
    with pytest.raises(UnknownName, match="plain, sparcl"):
        load_notation("../plain")
