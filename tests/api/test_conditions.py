import pytest

from app.api.conditions import entity_tag, known_tags


@pytest.mark.parametrize(
    ("header", "tags"),
    [
        (None, set()),
        ("", set()),
        ("*", {"*"}),
        ('"a"', {"a"}),
        ('"a", "b"', {"a", "b"}),
        ('W/"a","b"', {"a", "b"}),
        ('"a,b"', {"a,b"}),
        ("a", set()),
        ('"*"', set()),
    ],
)
def test_tags_are_read_from_if_none_match(header: str | None, tags: set[str]) -> None:
    assert known_tags(header) == tags


def test_a_tag_is_strong_and_comes_back() -> None:
    assert known_tags(entity_tag("0af3")) == {"0af3"}
