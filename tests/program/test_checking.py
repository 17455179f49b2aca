import json
from typing import Any

import pytest

from app.errors import DocumentError, DocumentTooLarge, Fault, InconsistentDocument
from app.program.checking import check
from app.program.model import Program
from app.settings import Settings

SETTINGS = Settings()


def faults(
    document: dict[str, Any],
    error: type[DocumentError] = InconsistentDocument,
    settings: Settings = SETTINGS,
) -> dict[str, str]:
    program = Program.model_validate_json(json.dumps(document))
    with pytest.raises(error) as raised:
        check(program, settings)
    return {fault.pointer: fault.detail for fault in raised.value.faults}


def items(*names: str) -> list[dict[str, Any]]:
    return [{"id": name} for name in names]


def edge(*ends: tuple[str, str | None], name: str = "e") -> dict[str, Any]:
    return {"id": name, "attachments": [{"item": item, "point": point} for item, point in ends]}


def test_a_consistent_program_passes() -> None:
    document = {
        "items": [*items("a", "b"), {"id": "c", "parent": "a"}],
        "hyperedges": [edge(("a", None), ("b", None), ("c", None))],
    }
    check(Program.model_validate(document), SETTINGS)


def test_ids_are_unique() -> None:
    found = faults(
        {
            "items": items("a", "b", "a"),
            "hyperedges": [edge(("a", None), ("b", None)), edge(("a", None), ("b", None))],
        }
    )
    assert set(found) == {"/items/2/id", "/hyperedges/1/id"}
    assert "/items/0" in found["/items/2/id"]


def test_parents_exist() -> None:
    found = faults({"items": [*items("apple"), {"id": "b", "parent": "aple"}]})
    assert found == {"/items/1/parent": 'There is no item "aple". Did you mean "apple"?'}


def test_parents_do_not_go_round_in_a_circle() -> None:
    document = {
        "items": [
            {"id": "a", "parent": "c"},
            {"id": "b", "parent": "a"},
            {"id": "c", "parent": "b"},
        ]
    }
    found = faults(document)
    assert len(found) == 1
    assert '"a" → "c" → "b" → "a"' in found["/items/0/parent"]


def test_an_item_is_not_its_own_parent() -> None:
    assert "circle" in faults({"items": [{"id": "a", "parent": "a"}]})["/items/0/parent"]


def test_attachments_lead_to_items_and_points_that_exist() -> None:
    point = {"id": "top", "position": [0, 0, 1]}
    found = faults(
        {
            "items": [{"id": "a", "attachment_points": [point]}, {"id": "b"}],
            "hyperedges": [edge(("a", "tip"), ("x", None), ("b", "top"))],
        }
    )
    assert set(found) == {
        "/hyperedges/0/attachments/0/point",
        "/hyperedges/0/attachments/1/item",
        "/hyperedges/0/attachments/2/point",
    }
    assert 'Did you mean "top"?' in found["/hyperedges/0/attachments/0/point"]


def test_a_hyperedge_has_no_attachment_twice() -> None:
    document = {
        "items": items("a", "b"),
        "hyperedges": [edge(("a", None), ("b", None), ("a", None))],
    }
    assert set(faults(document)) == {"/hyperedges/0/attachments/2"}


def test_points_of_an_item_differ_and_have_directions() -> None:
    points = [
        {"id": "p", "position": [0, 0, 0]},
        {"id": "p", "position": [0, 0, 1], "direction": [0, 0, 0]},
    ]
    found = faults(
        {"items": [{"id": "a", "attachment_points": points}], "view": {"from": [0, 0, 0]}}
    )
    assert set(found) == {
        "/items/0/attachment_points/1/id",
        "/items/0/attachment_points/1/direction",
        "/view/from",
    }


def test_text_needs_a_label() -> None:
    assert set(faults({"items": [{"id": "a", "shape": {"type": "text"}}]})) == {"/items/0/shape"}


def test_what_lines_up_is_free_and_of_one_parent() -> None:
    found = faults(
        {
            "items": [
                *items("a", "b"),
                {"id": "c", "parent": "a"},
                {"id": "d", "position": [0, 0, 0]},
            ],
            "layout": {
                "constraints": [
                    {"type": "row", "items": ["a", "c"]},
                    {"type": "column", "items": ["b", "d", "b", "nobody"]},
                ]
            },
        }
    )
    assert set(found) == {
        "/layout/constraints/0/items",
        "/layout/constraints/1/items/1",
        "/layout/constraints/1/items/2",
        "/layout/constraints/1/items/3",
    }


@pytest.mark.parametrize(
    ("limit", "place"),
    [
        ({"max_items": 1}, "/items"),
        ({"max_hyperedges": 1}, "/hyperedges"),
        ({"max_attachments": 3}, "/hyperedges"),
        ({"max_label_characters": 2}, "/items"),
    ],
)
def test_limits_are_told_apart_from_contradictions(limit: dict[str, int], place: str) -> None:
    document = {
        "items": [{"id": "a", "label": "xyz"}, {"id": "a"}],
        "hyperedges": [edge(("a", None), ("b", None)), edge(("a", None), ("c", None), name="f")],
    }
    assert set(faults(document, DocumentTooLarge, Settings.model_validate(limit))) == {place}


def test_items_nest_only_so_deep() -> None:
    chain = [{"id": "0"}, *({"id": str(n), "parent": str(n - 1)} for n in range(1, 70))]
    found = faults({"items": chain})
    assert set(found) == {"/items/64/parent"}


def test_a_deep_chain_listed_backwards_is_measured_too() -> None:
    chain = [{"id": "0"}, *({"id": str(n), "parent": str(n - 1)} for n in range(1, 70))]
    assert set(faults({"items": chain[::-1]})) == {"/items/5/parent"}


def test_many_faults_are_cut_with_their_number() -> None:
    program = Program.model_validate({"items": items(*["same"] * 300)})
    with pytest.raises(InconsistentDocument) as raised:
        check(program, SETTINGS)
    assert raised.value.faults[-1] == Fault("", "And 199 more faults.")


def test_every_kind_of_contradiction_comes_at_once() -> None:
    document = {
        "items": [*items("a", "b", "a"), {"id": "c", "parent": "c"}, {"id": "d", "parent": "z"}],
        "hyperedges": [edge(("a", "p"), ("b", None)), edge(("b", None), ("b", None))],
        "layout": {"constraints": [{"type": "row", "items": ["a", "nobody"]}]},
        "view": {"from": [0, 0, 0]},
    }
    assert set(faults(document)) == {
        "/items/2/id",
        "/items/3/parent",
        "/items/4/parent",
        "/hyperedges/0/attachments/0/point",
        "/hyperedges/1/id",
        "/hyperedges/1/attachments/1",
        "/layout/constraints/0/items/1",
        "/view/from",
    }


def test_a_document_at_its_limits_passes() -> None:
    document = {
        "items": [{"id": "a", "label": "xy"}, {"id": "b", "parent": "a"}],
        "hyperedges": [edge(("a", None), ("b", None))],
    }
    limits = {"max_items": 2, "max_hyperedges": 1, "max_attachments": 2, "max_depth": 2}
    check(
        Program.model_validate(document),
        Settings.model_validate(limits | {"max_label_characters": 2}),
    )


def test_two_circles_are_two_faults_and_what_hangs_on_them_is_none() -> None:
    parents = {"a": "b", "b": "a", "c": "d", "d": "c", "e": "a"}
    found = faults({"items": [{"id": name, "parent": other} for name, other in parents.items()]})
    assert set(found) == {"/items/0/parent", "/items/2/parent"}


def test_two_points_of_one_item_are_two_attachments() -> None:
    points = [{"id": name, "position": [0, 0, 0]} for name in ("p", "q")]
    document = {
        "items": [{"id": "a", "attachment_points": points}],
        "hyperedges": [edge(("a", "p"), ("a", "q"), ("a", None))],
    }
    check(Program.model_validate(document), SETTINGS)
