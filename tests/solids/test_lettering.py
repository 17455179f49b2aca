from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.solids.fonts import typefaces
from app.solids.lettering import BOX, TextExtent, extent, lettering, runs
from tests.cost import check_growth

PROMISED = "Aαβ Жя→⇒∀∃∈∑≤≠∧∨¬∪∩⊆∅λ×÷±√∞⊢⊨⟨⟩←↔ℕℝ"  # noqa: RUF001 (what labels may hold)
MISSING = "\U0010fffd"

heights = st.floats(1e-3, 1e5)


def shown(text: str) -> str:
    """The characters that are set, without regard to typefaces."""
    return "".join(run for _, run in runs(text))


def test_a_capital_is_as_high_as_asked() -> None:
    assert extent("H", 2.5) == TextExtent(extent("H", 2.5).width, top=2.5, bottom=0.0)


def test_capitals_of_every_typeface_are_equally_high() -> None:
    assert extent("\N{FOR ALL}", 1.0).top == pytest.approx(1.0, abs=0.02)
    assert extent("\N{DOUBLE-STRUCK CAPITAL N}", 1.0).top == pytest.approx(1.0, abs=0.02)


def test_a_descender_reaches_below_the_baseline() -> None:
    assert extent("p", 1.0).bottom < -0.2


@given(st.text(max_size=20), heights)
def test_extent_grows_in_proportion_to_height(text: str, height: float) -> None:
    one, other = extent(text, 1.0), extent(text, height)
    assert (other.width, other.top, other.bottom) == pytest.approx(
        (one.width * height, one.top * height, one.bottom * height), rel=1e-9, abs=1e-12
    )


def test_letters_that_lean_into_each_other_are_kerned() -> None:
    def start_of_second(text: str) -> float:
        return float(lettering(text).origins[1, 0])

    assert start_of_second("AV") < start_of_second("AH") - 0.05


def test_every_promised_character_has_a_glyph_of_its_own() -> None:
    assert shown(PROMISED) == PROMISED
    line = lettering(PROMISED)
    assert len(line.glyphs) == len(PROMISED.replace(" ", ""))
    assert len(set(zip(line.typefaces, line.glyphs, strict=True))) == len(line.glyphs)
    assert (line.glyphs > 0).all()


def test_each_character_comes_from_the_first_typeface_that_has_it() -> None:
    names = [typefaces()[face].name for face, _ in runs("x\N{DOUBLE-STRUCK CAPITAL N}\N{FOR ALL}y")]
    assert names == ["inter", "noto-sans", "fira-code", "inter"]


def test_a_character_without_glyph_is_a_box_to_be_seen() -> None:
    assert shown(MISSING) == BOX
    assert extent(MISSING, 1.0).width > 0.5
    assert shown(f"a{MISSING}b") == f"a{BOX}b"


def test_a_label_reads_as_it_was_written() -> None:
    for text in ("->", "=>", "!=", "4x4", "<=>"):
        glyphs = [number for letter in text for number in lettering(letter).glyphs]
        np.testing.assert_array_equal(lettering(text).glyphs, glyphs)


@pytest.mark.parametrize("text", ["", " ", "\n", "\t \r\n", "\N{ZERO WIDTH JOINER}", "\x00\x07"])
def test_a_blank_label_takes_no_room(text: str) -> None:
    assert extent(text, 3.0) == TextExtent(0.0, 0.0, 0.0)
    assert len(lettering(text).glyphs) == 0


def test_a_line_break_is_a_blank_and_other_controls_are_nothing() -> None:
    assert extent("a\nb", 1.0) == extent("a b", 1.0)
    assert extent("a\x07b", 1.0) == extent("ab", 1.0)


def test_blanks_around_a_label_take_no_room() -> None:
    assert extent("  ab  ", 1.0).width == pytest.approx(extent("ab", 1.0).width)


def test_a_mark_is_composed_with_its_letter() -> None:
    assert extent("e\N{COMBINING ACUTE ACCENT}", 1.0) == extent("é", 1.0)


def test_a_mark_without_glyph_leaves_its_letter_as_it_is() -> None:
    assert shown("a\N{COMBINING RIGHT ARROW ABOVE}") == f"a{BOX}"


def test_an_emoji_sequence_is_a_box_for_each_of_its_signs() -> None:
    family = "\N{WOMAN}\N{ZERO WIDTH JOINER}\N{WOMAN}\N{ZERO WIDTH JOINER}\N{GIRL}"
    assert shown(family) == BOX * 3
    assert shown("\N{GRINNING FACE}\N{VARIATION SELECTOR-16}") == BOX


def test_half_a_surrogate_pair_is_shown_as_replaced() -> None:
    assert shown("\ud83d") == "\N{REPLACEMENT CHARACTER}"


@given(st.text(st.characters(), max_size=40))
def test_any_string_can_be_set(text: str) -> None:
    line = lettering(text)
    assert np.isfinite(line.origins).all()
    assert (line.glyphs > 0).all()
    assert (line.bounds[0] <= line.bounds[1]).all()


def test_a_long_label_takes_no_more_than_its_length() -> None:
    check_growth(lambda count: extent(PROMISED * count, 1.0), 20)


def test_a_heap_of_marks_takes_no_more_than_its_length() -> None:
    marks = "\N{COMBINING CEDILLA}\N{COMBINING ACUTE ACCENT}"
    check_growth(lambda count: extent("a" + marks * count, 1.0), 2_500)
