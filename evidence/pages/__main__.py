"""`python -m evidence.pages`: writes the generated pages and parts of pages again.

They follow from the code and from tables that were measured before; nothing is measured here.
"""

from __future__ import annotations

from evidence.checkout import ROOT
from evidence.pages.generated import generated


def main() -> None:
    """Writes each file of `generated` and prints its name."""
    for path, text in generated().items():
        path.write_text(text, encoding="utf-8")
        print(path.relative_to(ROOT))


if __name__ == "__main__":
    main()
