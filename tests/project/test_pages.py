"""The pages say what the code and the measured tables say, their links lead somewhere, their example runs."""

from __future__ import annotations

import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from evidence.benchmarks.pages.page import parts
from evidence.pages.generated import generated
from evidence.pages.outputs import unit
from evidence.pages.papers.yang_figures import level_figures
from evidence.pages.promises import PROMISES, measured, promises
from evolvent.results.tables.field_texts import field_texts
from tests.support.checkout import ROOT

PAGES = sorted([*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md")])
PICTURES = list((ROOT / "docs").rglob("*.png"))  # the Docker image goes without
HERTZ_MPa = 857.07  # √(P E'/π R), P = 1000 N/mm, R = 50 mm, E' of steel on steel


@pytest.mark.parametrize("path", generated(), ids=lambda path: path.name)
def test_pages_are_what_the_tables_say(path: Path) -> None:
    """Exact: the file is what `make pages` would write now."""
    assert path.read_text(encoding="utf-8") == generated()[path], "run `make pages`"


def test_the_benchmark_is_what_its_tables_say() -> None:
    """Exact: below its header, which names the machine, docs/benchmark.md is what the tables beside it make."""
    text = (ROOT / "docs" / "benchmark.md").read_text(encoding="utf-8")
    wanted = "\n\n".join(part.strip() for part in parts(ROOT / "docs" / "benchmark")) + "\n"
    assert text.endswith("\n\n" + wanted), "run `python -m evidence.benchmarks page`"
    assert text[: -len(wanted)].count("\n\n") <= 2


def test_another_figure_is_noticed(tmp_path: Path) -> None:
    """A ratio that was measured anew changes the table, and whether its bar is met: a pitch that takes 2.5 times what
    factoring takes is within the bar of 3, at 7.7 it is missed."""
    for name in ("benchmark", "stress"):
        (tmp_path / name).mkdir()
        for source in (ROOT / "docs" / name).iterdir():
            (tmp_path / name / source.name).write_text(source.read_text(encoding="utf-8"), encoding="utf-8")
    page = (ROOT / "docs" / "verification.md").read_text(encoding="utf-8")
    (tmp_path / "verification.md").write_text(page, encoding="utf-8")
    before = promises(tmp_path)
    assert PROMISES.markdown(before) == PROMISES.markdown(promises(ROOT / "docs"))
    ratios = tmp_path / "benchmark" / "ratios.csv"
    head, first, *rest = ratios.read_text().splitlines()
    cells = first.split(",")
    ratios.write_text("\n".join([head, ",".join([*cells[:4], "2.5", *cells[5:]]), *rest]) + "\n")
    (changed,) = set(promises(tmp_path)) - set(before)
    assert changed.what.startswith("a pitch of 40 positions over") and changed.found == "2.5" and changed.met
    assert not next(promise for promise in before if promise.what == changed.what).met


def test_misses_stand_where_the_claims_are() -> None:
    """What is missed is said so in README.md as well as in docs/evidence.md."""
    missed = [promise.what for promise in promises(ROOT / "docs") if not promise.met]
    for name in ("README.md", "docs/evidence.md"):
        text = (ROOT / name).read_text(encoding="utf-8")
        assert text.count("**missed**") >= len(missed)
        assert all(re.search(rf"\| {re.escape(what)} \|.*\*\*missed\*\*", text) for what in missed)


def test_a_page_without_a_table_is_refused(tmp_path: Path) -> None:
    """A page of evidence whose table is gone: an error that names it, not a promise that is met by nothing."""
    page = tmp_path / "empty.md"
    page.write_text("# Nothing\n\n| quantity | value |\n| --- | --- |\n| a | 1 |\n")
    with pytest.raises(ValueError, match=r"empty\.md: wanted a table"):
        measured(page)


@pytest.mark.parametrize("page", PAGES, ids=lambda path: path.name)
def test_links_lead_somewhere(page: Path) -> None:
    """Every relative link is a file, every anchor one of its headings; no page names a file that has gone."""
    text = re.sub(r"```.*?```", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)
    for target in re.findall(r"\]\(([^)\s]+)\)", text):
        if "://" in target:
            continue
        name, _, anchor = target.partition("#")
        path = (page.parent / name).resolve() if name else page
        if path.suffix == ".png" and not PICTURES:
            continue
        assert path.exists(), f"{page.name}: {target}"
        if anchor:
            heads = re.findall(r"^#+ (.*)$", path.read_text(encoding="utf-8"), re.MULTILINE)
            made = {"".join(c for c in head.lower() if c.isalnum() or c in " -_").replace(" ", "-") for head in heads}
            assert anchor in made, f"{page.name}: {target}"
    assert "apt.txt" not in text


def test_every_page_is_in_the_index() -> None:
    """docs/README.md links to each page of docs/."""
    index = (ROOT / "docs" / "README.md").read_text(encoding="utf-8")
    for page in (ROOT / "docs").glob("*.md"):
        assert page.name == "README.md" or f"({page.name})" in index, page.name


def test_the_example_of_the_readme_runs_as_it_stands(tmp_path: Path) -> None:
    """In an empty folder: Hertz' 857 MPa within 0.5 %, 1000 N/mm, then 200 N/mm of friction to the side."""
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    (program,) = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    command = [sys.executable, "-c", f"import sys; sys.path.insert(0, {str(ROOT)!r})\n{program}"]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 0, done.stderr
    numbers = [float(word) for word in re.findall(r"-?\d+\.?\d*(?:e[+-]\d+)?", done.stdout)]
    assert numbers[0] == pytest.approx(HERTZ_MPa, rel=5e-3)
    assert [abs(numbers[k]) for k in (6, 7)] == pytest.approx([200.0, 1000.0], rel=1e-6)
    assert list(tmp_path.iterdir()) == []


def test_words_about_yang_s_pair_fit_its_figures() -> None:
    """What docs/yang2022.md says in words of the figures that were kept: the largest pressure below the pitch line and
    before it is passed, friction raises the stress before the pitch point and lowers it after, tooth 1 falls with
    friction, C and D change more than A, A more than B."""
    f = level_figures(ROOT / "docs", "standard")
    assert f["largest_xi_mm"] < 0.0 and f["largest_deg"] < 0.0 < f["crossing_deg"]
    assert f["change_after_low_percent"] < 0.0 < f["change_before_high_percent"]
    assert all(f[f"tooth_1_{name}_change_percent"] < 0.0 for name in ("largest", "average"))
    a, b, c, d = (abs(f[f"point_{name}_change_MPa"]) for name in "ABCD")
    assert min(c, d) > a > b


def test_changelog_has_the_release() -> None:
    """Of pyproject.toml and CITATION.cff, with a date, below what is not released."""
    version = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["version"]
    assert f"version: {version}\n" in (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    heads = re.findall(r"^## (.*)$", (ROOT / "CHANGELOG.md").read_text(encoding="utf-8"), re.MULTILINE)
    assert heads[0] == "Unreleased" or heads[0].startswith(version)
    assert any(re.fullmatch(rf"{re.escape(version)} - \d{{4}}-\d\d-\d\d", head) for head in heads)


def test_packages_are_used() -> None:
    """Each Python package of packages/debian.txt is imported somewhere, but for what sets the environment up."""
    sets_up = {"venv", "setuptools", "wheel", "pytest-xdist"}  # setuptools before 70 builds with wheel
    sets_up |= {"dask"}  # `python -m dask` of docs/studies.md, which a test runs
    modules = {"dolfinx-real": "dolfinx", "petsc4py-real": "petsc4py", "pil": "PIL", "cattr": "cattrs"}
    lines = (ROOT / "packages" / "debian.txt").read_text(encoding="utf-8").splitlines()
    wanted = {line.split()[0].removeprefix("python3-") for line in lines if line.startswith("python3-")} - sets_up
    files = [path for name in ("meshes", "solver", "wear", "evidence", "tests") for path in (ROOT / name).rglob("*.py")]
    code = "\n".join(path.read_text(encoding="utf-8") for path in files)
    unused = {name for name in wanted if not re.search(rf"^\s*(import|from) {modules.get(name, name)}\b", code, re.M)}
    assert not unused


def test_units_follow_the_names() -> None:
    """N/(mm·µm) is no µm, mm³ no mm; a name without a unit has none."""
    names = ("mesh_stiffness_N_per_mm_um", "volume_mm3", "force_N", "torque_pinion_Nm", "friction", "deepest_um")
    assert [unit(name) for name in names] == ["N/(mm·µm)", "mm³", "N", "N·m", "", "µm"]


class Undescribed:
    """A class with a field that nothing is said of."""

    told: float
    """What it is."""
    silent: float


def test_a_field_without_a_word_is_refused() -> None:
    """So that no column comes without a line in docs/outputs.md."""
    with pytest.raises(ValueError, match=r"Undescribed\.silent: wanted a text below it"):
        field_texts(Undescribed)
