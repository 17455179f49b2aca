import json

from hypothesis import given
from hypothesis import strategies as st

from app.program.digest import canonical, digest
from app.program.model import Program
from app.program.reading import read_program
from app.settings import Settings

ITEM = {"id": "a", "position": [1, 2, 3]}


def program(**document: object) -> Program:
    return read_program(json.dumps(document).encode(), Settings())


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


@given(
    st.text(max_size=20), st.floats(-10, 10), st.dictionaries(st.text(max_size=3), st.integers())
)
def test_the_canonical_form_is_a_document_of_the_same_program(
    label: str, x: float, data: dict[str, int]
) -> None:
    made = program(items=[{"id": "a", "label": label, "position": [x, 0, 0], "data": data}])
    again = read_program(canonical(made), Settings())
    assert canonical(again) == canonical(made)
    assert again.items[0].data == data
