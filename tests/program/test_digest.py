import json
from typing import Any

from hypothesis import given

from app.program.digest import canonical, digest
from app.program.model import Program
from app.program.reading import read_program
from app.settings import Settings
from tests.program.documents import documents

ITEM = {"id": "a", "position": [1, 2, 3]}


def program(**document: object) -> Program:
    return read_program(json.dumps(document).encode(), Settings())


def backwards(value: Any) -> Any:
    """The same JSON value with the keys of every object in another order."""
    if isinstance(value, dict):
        return {key: backwards(inner) for key, inner in reversed(value.items())}
    return [backwards(inner) for inner in value] if isinstance(value, list) else value


def test_defaults_written_out_make_no_difference() -> None:
    plain = program(items=[ITEM])
    full = program(**json.loads(plain.model_dump_json()))
    assert digest(plain) == digest(full)


def test_key_order_and_number_form_make_no_difference() -> None:
    one = read_program(b'{"items": [{"id": "a", "position": [1, 2, 3]}], "name": "n"}', Settings())
    two = read_program(
        b'{"name": "n", "items": [{"position": [1.0, 2, 3e0], "id": "a"}]}', Settings()
    )
    assert digest(one) == digest(two)


def test_the_order_of_items_makes_a_difference() -> None:
    assert digest(program(items=[{"id": "a"}, {"id": "b"}])) != digest(
        program(items=[{"id": "b"}, {"id": "a"}])
    )


def test_a_digest_is_64_hexadecimal_digits() -> None:
    assert len(bytes.fromhex(digest(program(items=[])))) == 32


def test_free_data_comes_out_in_one_order_whichever_it_came_in() -> None:
    one = program(items=[], data={"a": {"c": 1, "b": [{"e": 1, "d": 2}]}})
    two = program(items=[], data={"a": {"b": [{"d": 2, "e": 1}], "c": 1}})
    assert json.dumps(one.data) == json.dumps(two.data)


def test_free_data_that_goes_out_differently_is_told_apart() -> None:
    assert digest(program(items=[], data={"x": 1})) != digest(program(items=[], data={"x": 1.0}))


@given(documents())
def test_the_canonical_form_is_a_document_of_the_same_program(document: dict[str, Any]) -> None:
    made = program(**document)
    again = read_program(canonical(made), Settings())
    assert again == made
    assert canonical(again) == canonical(made)


@given(documents())
def test_documents_that_mean_the_same_have_one_digest(document: dict[str, Any]) -> None:
    made = program(**document)
    assert digest(program(**backwards(document))) == digest(made)
    assert digest(program(**json.loads(made.model_dump_json()))) == digest(made)
