"""Scenarios, exercises and golden runs read from a file name files only in their own folders and the user's."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from falling import ball
from typer.testing import CliRunner

from simkit import LoadError, RunSpec, hidden_text
from simkit.cli import app
from simkit.testing.golden.check import check_golden
from simkit.testing.scenarios.readable_files import ReadableFiles
from simkit.testing.scenarios.scenario_file import read_scenario
from simkit.testing.scenarios.scenario_run import open_scenario
from simkit_verification.testing.grading.exercise import read_exercise

BOX = """<sdf version="1.9"><model name="box"><static>true</static><link name="l"><collision name="c"><geometry><box>
<size>1 1 1</size></box></geometry></collision></link></model></sdf>"""


def simkit(*words: object) -> tuple[int, str]:
    result = CliRunner().invoke(app, [str(word) for word in words], catch_exceptions=False)
    hidden_text._files.clear()
    return result.exit_code, result.output


@pytest.fixture
def stranger(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Folder of a stranger beside private files; the working directory is another one."""
    for name in ("stranger/models", "private", "work"):
        (tmp_path / name).mkdir(parents=True)
    ball(tmp_path / "private")
    ball(tmp_path / "stranger")
    (tmp_path / "private" / "script.yaml").write_text("- {at: 0, topic: /a, message: {data: 1}}\n")
    (tmp_path / "private" / "box.sdf").write_text(BOX)
    (tmp_path / "private" / "list.csv").write_text("a.b\n1\n")
    monkeypatch.chdir(tmp_path / "work")
    return tmp_path / "stranger"


def refused(error: LoadError) -> list[tuple[str, int | None, str]]:
    return [(d.code, d.line, d.message.partition(":")[0]) for d in error.diagnostics]


@pytest.mark.parametrize("style", ["absolute", "climbing", "link"])
@pytest.mark.parametrize(
    "text, key",
    [
        ("world: {}/ball.sdf\n", "world"),
        ("world: file://{}/ball.sdf\n", "world"),
        ("world: ball.sdf\nspawn: '{}/ball.sdf:1,2,0:other'\n", "spawn.0"),
        ("world: ball.sdf\nspawn: '{}/ball.sdf'\n", "spawn.0"),
        ("world: ball.sdf\nmodel_world: {}/ball.sdf\n", "model_world"),
        ("world: ball.sdf\ncommands: {}/script.yaml\n", "commands"),
        ("world: ball.sdf\nplay: {}/run.mcap\n", "play"),
        ("world: ball.sdf\nparams_files: [{}/script.yaml]\n", "params_files.0"),
        ("world: ball.sdf\nparams_files: [arm={}/script.yaml]\n", "params_files.0"),
        ("world: ball.sdf\nresource_paths: {}\n", "resource_paths.0"),
        ("world: ball.sdf\ninterfaces: {}\n", "interfaces.0"),
        ("world: ball.sdf\npackage_paths: [{}]\n", "package_paths.0"),
        ("world: ball.sdf\npackage_paths: {{arm: {}}}\n", "package_paths.arm"),
    ],
)
def test_a_file_outside_is_refused_with_its_line_and_the_option_that_allows_it(
    stranger: Path, text: str, key: str, style: str
) -> None:
    private = stranger.parent / "private"
    (stranger / "linked").symlink_to(private)
    places = {"absolute": str(private), "climbing": "../private", "link": "linked"}
    if text.startswith("world: file") and style != "absolute":
        pytest.skip("a file URI is absolute")
    file = stranger / "s.yaml"
    file.write_text(text.format(places[style]))
    with pytest.raises(LoadError) as caught:
        read_scenario(file)
    assert refused(caught.value) == [("SK-URI-003", text.count("\n"), key)]
    assert f"--resource-path {private}" in caught.value.diagnostics[0].hint
    if not key.startswith(("play", "interfaces")):
        assert read_scenario(file, [private]).file == file


def test_the_variable_of_the_resource_path_allows_files_too(stranger: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (stranger / "s.yaml").write_text("world: ../private/ball.sdf\nduration: 0.1\n")
    record = ("golden", "record", stranger / "s.yaml", "--force", "-o", stranger / "g")
    assert simkit(*record)[0] == 2
    assert simkit(*record, "--resource-path", stranger.parent / "private")[0] == 0
    monkeypatch.setenv("SIMKIT_RESOURCE_PATH", str(stranger.parent / "private"))
    assert simkit(*record)[0] == 0


def test_the_home_folder_that_a_tilde_names_is_outside(stranger: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(stranger.parent / "private"))
    monkeypatch.chdir(stranger)
    text = "world: ball.sdf\ninterfaces: ['~/msgs']\npackage_paths: {a: '~/a', b: '~nobody_here/x'}\n"
    Path("s.yaml").write_text(text)
    with pytest.raises(LoadError) as caught:
        read_scenario(Path("s.yaml"))
    assert [key for _, _, key in refused(caught.value)][:2] == ["interfaces.0", "package_paths.a"]


def test_a_file_of_the_working_directory_is_not_read_for_a_bare_name(
    stranger: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (stranger / "s.yaml").write_text("world: ball.sdf\n")
    (stranger / "ball.sdf").unlink()
    monkeypatch.chdir(stranger.parent / "private")
    with pytest.raises(LoadError, match="SK-URI-003"):
        read_scenario(stranger / "s.yaml")
    (stranger / "s.yaml").write_text("world: empty\nspawn: ['turtlebot3_burger:1,2,0']\n")
    assert read_scenario(stranger / "s.yaml").world == "empty"


@pytest.mark.parametrize("marker", [".git", "pyproject.toml", "package.xml"])
def test_files_of_the_project_are_read(stranger: Path, marker: str) -> None:
    (stranger.parent / marker).mkdir()
    (stranger / "s.yaml").write_text("world: ../private/ball.sdf\nspawn: ['../private/ball.sdf:0,0,0:b']\n")
    assert read_scenario(stranger / "s.yaml").source.endswith("private/ball.sdf")


def test_a_file_below_the_working_directory_may_name_files_of_it(
    stranger: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (stranger / "s.yaml").write_text("world: ../private/ball.sdf\n")
    monkeypatch.chdir(stranger.parent)
    assert read_scenario(stranger / "s.yaml").world == "../private/ball.sdf"
    monkeypatch.setenv("HOME", str(stranger.parent))  # the home folder is no project
    with pytest.raises(LoadError, match="SK-URI-003"):
        read_scenario(stranger / "s.yaml")


def test_a_specification_made_in_python_may_name_any_file(stranger: Path) -> None:
    with open_scenario(RunSpec(str(stranger.parent / "private" / "ball.sdf"), duration=0.1)) as sim:
        assert sim.models


@pytest.mark.slow
def test_the_runs_of_an_exercise_spawn_no_model_from_elsewhere(stranger: Path) -> None:
    file = stranger / "e.yaml"
    file.write_text(
        "world: ball.sdf\ngoals: ['time > 0']\nexercise:\n  title: t\n  runs:\n"
        "    - spawn: ['../private/box.sdf:0,0,0:b']\n"
    )
    with pytest.raises(LoadError) as caught:
        read_exercise(file)
    assert refused(caught.value) == [("SK-URI-003", 6, "exercise.runs.0.spawn.0")]
    assert read_exercise(file, [stranger.parent / "private"]).folders == (stranger.parent / "private",)
    assert simkit("grade", file)[0] == 2
    assert simkit("grade", file, "--resource-path", stranger.parent / "private")[0] == 0


# ---------------------------------------------------------------------- golden runs


def test_a_golden_run_is_recorded_and_checked_in_any_folder(stranger: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(stranger)
    assert simkit("golden", "record", "ball.sdf", "-o", "g", "--duration", 0.1)[0] == 0
    assert simkit("golden", "check", "g")[0] == 0
    monkeypatch.chdir(stranger.parent / "work")
    assert simkit("golden", "check", stranger / "g")[0] == 0
    monkeypatch.chdir("/")
    assert simkit("golden", "check", stranger / "g")[0] == 0


def test_a_golden_run_of_a_world_elsewhere_is_recorded_with_a_note_and_checked_with_the_option(stranger: Path) -> None:
    private, folder = stranger.parent / "private", stranger / "runs" / "g"
    code, said = simkit("golden", "record", private / "ball.sdf", "-o", folder, "--duration", 0.1)
    assert code == 0 and f"note: simkit golden check {folder} needs --resource-path {private}" in said
    code, said = simkit("golden", "check", folder)
    line = (folder / "golden.json").read_text().split("\n").index('  "world": "../../../private/ball.sdf",') + 1
    assert code == 2 and f"golden.json:{line}: error SK-URI-003: world: " in said
    assert f"--resource-path {private}" in said
    assert simkit("golden", "check", folder, "--resource-path", private)[0] == 0
    assert check_golden(folder, folders=[private]).passed
    with pytest.raises(LoadError, match="SK-URI-003"):
        check_golden(folder)


@pytest.mark.parametrize(
    "change",
    [
        {"world": "../../../private/ball.sdf"},
        {"spawn": ["/private/x.sdf:0,0,0"]},
        {"model_world": "/private/x.sdf"},
        {"play": "/private/run.mcap"},
        {"file": "../../../private/s.yaml"},
        {"options": {"params_files": ["/private/p.yaml"]}},
        {"options": {"resource_paths": ["/private"]}},
        {"options": {"package_paths": {"a": "/private"}}},
        {"options": {"interfaces": ["/private"]}},
    ],
)
def test_a_changed_golden_run_names_no_file_elsewhere(stranger: Path, change: dict[str, object]) -> None:
    folder = stranger / "runs" / "g"
    assert simkit("golden", "record", "empty", "-o", folder, "--duration", 0.1)[0] == 0
    main = json.loads((folder / "golden.json").read_text())
    main["scenario"] |= change
    (folder / "golden.json").write_text(json.dumps(main, indent=1))
    code, said = simkit("golden", "check", folder)
    assert code == 2 and "SK-URI-003" in said and "golden.json:" in said, said


def test_a_golden_run_directly_in_the_home_folder_names_files_beside_it_and_none_below(
    stranger: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("HOME", str(stranger))
    (stranger / ".ssh").mkdir()
    files = ReadableFiles(stranger / "g" / "golden.json", container=stranger)
    assert files.allows(stranger / "ball.sdf") and files.allows(stranger / "g" / "x.sdf")
    assert not files.allows(stranger / ".ssh" / "key") and not files.allows(stranger / "models" / "m.sdf")
    assert not files.allows(stranger / ".netrc")


HEAT = """<sdf version="1.9"><world name="w"><model name="m"><link name="l"><visual name="v"><geometry>
<box><size>1 1 1</size></box></geometry><plugin filename="gz-sim-thermal-system" name="gz::sim::systems::Thermal">
<heat_signature>t.png</heat_signature></plugin></visual></link><plugin filename="libsimkit_play_motion.so"
name="play_motion2"><motions>none.yaml</motions></plugin></model></world></sdf>"""
OVERRIDES = {  # the place of the value is a message, and no path: the second part would be a folder of the scenario
    "m::l::v::gz::sim::systems::Thermal.heat_signature": ("{}", "../private/t.png", "q/../../private/t.png"),
    "m::play_motion2.motions": ("{}", "file://{}", "../private/t.png", "linked/t.png"),
}


@pytest.mark.parametrize("element", OVERRIDES)
def test_an_override_opens_no_file_outside(stranger: Path, element: str, monkeypatch: pytest.MonkeyPatch) -> None:
    private = stranger.parent / "private" / "t.png"
    private.write_text("no image: [")
    (stranger / "linked").symlink_to(private.parent)
    (stranger / "w.sdf").write_text(HEAT)
    monkeypatch.chdir(stranger)
    for text in OVERRIDES[element]:
        value = text.format(private)
        (stranger / "s.yaml").write_text(f"world: w.sdf\nduration: 0\nset: {{'{element}': '{value}'}}\n")
        with open_scenario(read_scenario(stranger / "s.yaml")) as sim:
            said = [d.message for d in sim.diagnostics if value in d.message]
        assert said and all("is not found" in message for message in said), said
