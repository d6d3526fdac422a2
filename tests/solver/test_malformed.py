"""Inputs that must be refused, by every command: status 2, one message with key, found, allowed and remedy, no file."""

from __future__ import annotations

import hashlib
import os
import re
import signal
from collections.abc import Iterator, Sized
from pathlib import Path

import pytest

from evolvent.commands.app import main
from evolvent.results.archive.run_folder import RunFolder
from evolvent.scene.scene import Scene, load_scene, scene_from_text
from evolvent.scene.schema.errors import keys_of
from evolvent_meshes.mesh.gmsh_io import read_msh
from evolvent_meshes.mesh.mesh_data import MeshError
from tests.support.malformed.inputs import CHART, CHARTS, OPTIONS, RECORD, RECORDS, SCENE_FILES, TEST
from tests.support.malformed.scenes import MALFORMED, UNSUPPORTED
from tests.support.running.scene_effects import setting
from tests.support.scene_texts import HE, WEAR, YANG

MESSAGE = re.compile(r"(?P<key>.*?): found (?P<found>.*); allowed: (?P<allowed>.+); remedy: (?P<remedy>.+)")
Said = dict[str, str]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The current folder, with a scene and a record that are right."""
    (tmp_path / "scene.toml").write_text(HE, encoding="utf-8")
    (tmp_path / "record.csv").write_text(RECORD, encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def refused(folder: Path, capfd: pytest.CaptureFixture[str]) -> Refused:
    return Refused(folder, capfd)


class Refused:
    """refused(arguments): the one message of a command that must end with status 2 and leave every file as it was."""

    def __init__(self, folder: Path, capture: pytest.CaptureFixture[str]) -> None:
        self.folder, self.capture = folder, capture

    def __call__(self, arguments: list[str]) -> Said:
        before = files(self.folder)
        status = main(arguments)
        out, err = self.capture.readouterr()
        assert status == 2, err
        assert out == "" and "Traceback" not in err
        assert files(self.folder) == before
        lines = err.splitlines()
        assert len(lines) == 1, err
        found = MESSAGE.fullmatch(lines[0].removeprefix("evolvent: "))
        assert found is not None, err
        return found.groupdict()


def files(folder: Path) -> dict[str, str]:
    """Every file and folder below a folder, with a hash of its content."""
    return {
        str(path.relative_to(folder)): hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else "folder"
        for path in folder.rglob("*")
    }


def test_at_least_250_malformed_inputs() -> None:
    """At least 250 malformed inputs, all of them different."""
    tables: tuple[Sized, ...] = MALFORMED, SCENE_FILES, CHARTS, RECORDS, OPTIONS
    assert sum(len(table) for table in tables) >= 250


@pytest.mark.parametrize("case", SCENE_FILES)
def test_unreadable_scene_files_are_refused(case: str, refused: Refused) -> None:
    """Encodings, sizes, formats of scene files."""
    content, found, remedy = SCENE_FILES[case]
    (refused.folder / "bad.toml").write_bytes(content)
    if found == "nothing":  # a line for each section that is missing
        assert main(["check", "bad.toml"]) == 2
        assert all(MESSAGE.fullmatch(line) for line in refused.capture.readouterr().err.splitlines())
        return
    said = refused(["check", "bad.toml"])
    assert said["key"] == "bad.toml: scene file"
    assert found in said["found"] and remedy in said["remedy"]


@pytest.mark.parametrize("case", CHARTS)
def test_malformed_flank_charts_are_refused(case: str, refused: Refused) -> None:
    """Charts of flanks: the message names the scene's key."""
    content, found, words = CHARTS[case]
    (refused.folder / "bad.csv").write_bytes(content)
    said = refused(["run", "scene.toml", "--out", "out", "--set", "pinion.flank_csv=bad.csv"])
    assert said["key"] == "scene.toml: pinion.flank_csv"
    assert "bad.csv" in said["found"] and found in said["found"]
    assert words in said["allowed"] + said["remedy"]


@pytest.mark.parametrize("case", RECORDS)
def test_malformed_pin_on_disc_records_are_refused(case: str, refused: Refused) -> None:
    """Pin-on-disc records: the message names the file."""
    content, found, words = RECORDS[case]
    (refused.folder / "bad.csv").write_bytes(content)
    said = refused(["wear-coefficient", "record.csv", "bad.csv", *TEST])
    assert said["key"].startswith("bad.csv") and found in said["found"]
    assert words in said["allowed"] + said["remedy"]


@pytest.mark.parametrize("case", OPTIONS)
def test_malformed_options_are_refused(case: str, refused: Refused, monkeypatch: pytest.MonkeyPatch) -> None:
    """Options and arguments of every command; no machine has the memory for all that can be asked."""
    monkeypatch.setattr("evolvent.check.problem_size.machine_megabytes", lambda: 24e3)
    arguments, key, found, words = OPTIONS[case]
    names = {"{scene}": "scene.toml", "{record}": "record.csv", "{folder}": str(refused.folder), "{large}": "large.csv"}
    if "{large}" in arguments:
        (refused.folder / "large.csv").write_bytes(b"1" * 20_000_001)

    def named(text: str) -> str:
        for name, value in names.items():
            text = text.replace(name, value)
        return text

    said = refused([named(argument) for argument in arguments])
    assert said["key"].endswith(named(key)) and named(found) in said["found"]
    assert words in said["allowed"] + said["remedy"]


def pipe_without_writer(folder: Path, name: str) -> Path:
    """Whoever reads it waits for ever."""
    os.mkfifo(folder / name)
    return folder / name


@pytest.fixture
def in_time() -> Iterator[None]:
    """A test that hangs fails, which no command can take for an error of its own and say."""

    def late(*_: object) -> None:
        pytest.fail("still waits for the pipe's writer")

    before = signal.signal(signal.SIGALRM, late)
    signal.setitimer(signal.ITIMER_REAL, 20.0, 20.0)  # again: what ends a command may wait, too
    yield
    signal.setitimer(signal.ITIMER_REAL, 0.0)
    signal.signal(signal.SIGALRM, before)


@pytest.mark.parametrize("name", ["scene.toml", "chart.csv", "record.csv"])
def test_named_pipes_as_input_are_refused(name: str, refused: Refused, in_time: None) -> None:
    """A scene, a chart, a record that is a named pipe: refused at once."""
    pipe = str(pipe_without_writer(refused.folder, f"pipe_{name}"))
    scene = pipe if name == "scene.toml" else "scene.toml"
    chart = ["--set", f"pinion.flank_csv={pipe}"] if name == "chart.csv" else []
    each = [["check", scene, *chart], ["run", scene, "--out", "out", *chart], ["mesh", scene, "--out", "a.msh", *chart]]
    for arguments in [["wear-coefficient", pipe, *TEST]] if name == "record.csv" else each:
        said = refused(arguments)
        assert "a named pipe" in said["found"] and "to a file" in said["remedy"]


def test_named_pipe_as_mesh_is_refused(tmp_path: Path, in_time: None) -> None:
    """A named pipe is no mesh."""
    with pytest.raises(MeshError, match="found what is no file at"):
        read_msh(pipe_without_writer(tmp_path, "block.msh"))


@pytest.mark.parametrize(("name", "words"), [
    ("results/state.npz", "state.npz"), ("results/cost.json", "cost.json"), ("results/evolvent-files.jsonl", "list of"),
])
def test_named_pipes_in_a_run_folder_are_refused(
    name: str, words: str, folder: Path, capfd: pytest.CaptureFixture[str], in_time: None
) -> None:
    """Named pipes in place of a run's own files, from which it goes on: refused by `run --resume`, never read."""
    RunFolder(folder / "out").write(name, b"").unlink()
    pipe_without_writer(folder / "out", name)
    assert main(["run", "scene.toml", "--out", "out", "--resume"]) == 2
    err = capfd.readouterr().err
    assert words in err and "Traceback" not in err and not (folder / "out" / "run.log").exists()


@pytest.mark.parametrize("case", UNSUPPORTED)
def test_unsupported_keys_are_answered(case: str) -> None:
    """A key for something that is not supported: the message says that it is not."""
    text, overrides, key, _, _ = MALFORMED[case]
    with pytest.raises(ValueError, match=UNSUPPORTED[case]) as caught:
        scene_from_text(text, overrides)
    assert f"{key}: found" in str(caught.value)


def test_unknown_key_message_names_one_key() -> None:
    """The message about an unknown key names one key, not all that there are."""
    with pytest.raises(ValueError, match=r"did you mean pinion\.profile_shift") as caught:
        scene_from_text(YANG, ["pinion.proffile_shift=0.3"])
    assert "face_width" not in str(caught.value) and "addendum" not in str(caught.value)


def test_byte_order_mark_and_line_ends_are_ignored(tmp_path: Path) -> None:
    """A scene and a chart with a byte order mark, as some editors write it, are read as without; so are CR LF."""
    for text in (HE, HE.replace("\n", "\r\n")):
        (tmp_path / "scene.toml").write_bytes(b"\xef\xbb\xbf" + text.encode())
        assert load_scene(tmp_path / "scene.toml") == scene_from_text(HE)
    (tmp_path / "chart.csv").write_text(CHART, encoding="utf-8")
    setting = f"pinion.flank_csv={tmp_path / 'chart.csv'}"
    plain = load_scene(tmp_path / "scene.toml", [setting]).flank_chart("pinion")
    for text in (CHART, CHART.replace("\n", "\r\n")):
        (tmp_path / "chart.csv").write_bytes(b"\xef\xbb\xbf" + text.encode())
        marked = load_scene(tmp_path / "scene.toml", [setting]).flank_chart("pinion")
        assert plain is not None and marked is not None and marked.text() == plain.text()


def test_chart_paths_of_scene_and_overrides(folder: Path) -> None:
    """A chart in the scene file is looked for beside it, one of an override where the program runs."""
    (folder / "elsewhere").mkdir()
    (folder / "chart.csv").write_text(CHART)
    scene = folder / "elsewhere/scene.toml"
    scene.write_text(HE, encoding="utf-8")
    assert load_scene(scene, ["pinion.flank_csv=chart.csv"]).flank_chart("pinion") is not None
    scene.write_text(HE.replace("[wheel]", 'flank_csv = "chart.csv"\n[wheel]'), encoding="utf-8")
    with pytest.raises(ValueError, match=r"elsewhere/chart\.csv: No such file"):
        load_scene(scene)


@pytest.mark.parametrize(("path", "found"), [("/", "/: Is a directory"), ("/dev/null", "/dev/null: a device")])
def test_chart_path_of_an_override_needs_no_quotes(path: str, found: str) -> None:
    """A directory or a device for a chart, as the shell hands it over, is named as such, not as a text without quotes;
    so is the name of a material as an unknown key."""
    with pytest.raises(ValueError, match=rf"pinion\.flank_csv: found {found}"):
        scene_from_text(HE, [f"pinion.flank_csv={path}"])
    with pytest.raises(ValueError, match="there is no list of materials"):
        scene_from_text(HE, ["pinion.material=18CrNiMo7-6"])


EXTREMES = (
    "5e-324", "1e-300", "1e-160", "1e-30", "1e-9", "1e-3", "0.5", "1", "2", "5", "45", "1000", "1e6", "1e9", "1e160",
    "1.7e308", "1000000000000", "0", "-0.0", "-1", "-1e300", "1" + "0" * 400,
)
NUMBERS = [key for key, field in keys_of(Scene).items() if re.search(r"float|int|Literal\[1", str(field.annotation))]
PARTS = 8
"""Parts into which the extreme values are divided; of the n-th key, `make test` tries part n modulo PARTS."""
TRIALS = [
    pytest.param(key, part, id=f"{key}-{part}", marks=() if part == number % PARTS else pytest.mark.evidence)
    for number, key in enumerate(NUMBERS) for part in range(PARTS)
]
LONG_WAY = 'exact.parts=["plane", "one-pitch", "far-teeth", "one-sector", "coarse-body", "window"]'


@pytest.mark.parametrize(("key", "part"), TRIALS)
def test_check_survives_extreme_numbers(key: str, part: int, folder: Path, capfd: pytest.CaptureFixture[str]) -> None:
    """Every numeric key at extreme values, helical and spur, with wear and computed the long way: `check` ends with
    status 0, or with 2 and one message a line; no traceback and no warning."""
    (folder / "yang.toml").write_text(YANG, encoding="utf-8")
    bases = [["scene.toml", *WEAR]] if key.startswith("wear.") else [["yang.toml"], ["scene.toml", LONG_WAY]]
    for name, *settings in bases:
        for value in EXTREMES[part::PARTS]:
            overrides = [part for text in (*settings, setting(key, value)) for part in ("--set", text)]
            status = main(["check", name, *overrides])
            err = capfd.readouterr().err
            assert status in (0, 2), (value, err)
            lines = err.splitlines()
            assert all(MESSAGE.fullmatch(line.removeprefix("evolvent: ")) for line in lines), (value, err)
            assert bool(lines) == (status == 2), (value, err)
