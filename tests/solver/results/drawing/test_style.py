"""Titles as users write them, and how wide they are."""

from __future__ import annotations

import warnings

import pytest
from matplotlib.text import Text
from matplotlib.textpath import TextPath

from evolvent.results.drawing.style import foot, png, set_subtitle, sheet, styled, text_width

WORDS = "Largest pressure 2322 ± 269 MPa at φ = −10.59°, μ = 0.07 (ξ = −4.56 mm), K_Hβ 1.2"


def test_characters_without_a_glyph_are_question_marks() -> None:
    """Control characters, and those of a script that the font has not, in title, subtitle and footnote: drawn as
    question marks, without matplotlib's warning; Greek letters and subscripts stay."""
    with warnings.catch_warnings(), styled():
        warnings.simplefilter("error")
        figure = sheet("pair\x01 β₁ 歯車", "sub\x1btitle")
        foot(figure, "foot\tnote", "ü")
        content = png(figure)
    assert content.startswith(b"\x89PNG")
    texts = [each.get_text() for each in figure.findobj(Text)]
    assert {"pair? β₁ ??", "sub?title", "foot?note\nü"} <= set(texts)


@pytest.mark.parametrize("words", [WORDS, WORDS[::-1], "(W", "fÆV/", "j", " ", ""])
def test_width_of_a_text_is_that_of_its_curves(words: str) -> None:
    """Exact: the extent of the letters' outlines with all extrema of their curves; 0 without letters."""
    with styled():
        outline = TextPath((0.0, 0.0), words, size=10.0)
        wanted = outline.get_extents().width / 72.0 if words.strip() else 0.0
        assert text_width(words, 10.0) == pytest.approx(wanted, abs=1e-12)


def test_a_long_subtitle_becomes_as_wide_as_the_figure_has_room() -> None:
    """A subtitle twice as wide as its figure is drawn with 0.3 inch of room beside it; a short one that replaces it has
    ten points again."""
    with styled():
        figure = sheet("pair", 3 * WORDS, (6.0, 4.0))
        subtitle = figure.texts[1]
        assert text_width(subtitle.get_text(), float(subtitle.get_fontsize())) == pytest.approx(5.7, rel=1e-3)
        set_subtitle(figure, "short")
        assert (subtitle.get_text(), subtitle.get_fontsize()) == ("short", 10.0)
