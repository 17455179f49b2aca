from app.program.hints import Hints


def test_the_nearest_name_is_meant() -> None:
    assert Hints().at("colour", ["color", "cone"]) == ' Did you mean "color"?'


def test_a_name_like_no_other_has_no_hint() -> None:
    assert Hints().at("xyz", ["color", "cone"]) == ""


def test_hints_end_where_they_become_dear() -> None:
    hints = Hints(effort=1_000)
    assert hints.at("labl", ["label"] * 10)
    assert not hints.at("labl", ["label"] * 10)


def test_a_very_long_name_is_not_compared() -> None:
    assert Hints().at("a" * 100_000, ["a" * 100_000]) == ""
