"""Titles as users write them."""

from __future__ import annotations

import warnings

from matplotlib.text import Text

from evolvent.results.drawing.style import foot, png, sheet, styled


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
