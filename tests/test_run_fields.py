"""Fields of a run: a new one is found everywhere, and every command that runs a world has every option."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass, fields
from importlib import import_module
from pathlib import Path
from typing import Annotated, Any

import pytest
import typer
from typer.testing import CliRunner

from simkit.cli import app
from simkit.cli.run_options import NONE_GIVEN, PARTS, GivenOptions, OfferedOptions, scenario_spec, with_run_options
from simkit.diagnostics import LoadError
from simkit.packs import installed_packs
from simkit.run_fields import LOAD_FIELDS, CommandOption, RunField, described_fields, run_field
from simkit.run_spec import RunSpec, run_fields
from simkit.run_values import Number, ParameterFiles, Text
from simkit.testing.golden.record_encoding import decode_scenario, encode_scenario
from simkit.testing.scenarios.readable_files import ReadableFiles
from simkit.testing.scenarios.scenario_file import read_scenario
from simkit_verification.testing.bundles import open_bundle
from simkit_verification.testing.bundles.bundle_staging import WorldStager
from simkit_verification.testing.bundles.manifest import Manifest, RunEnd, read_manifest
from simkit_verification.testing.certify.certification import with_absolute_paths

BALL = """<sdf version="1.9"><world name="w"><model name="ball"><pose>0 0 5 0 0 0</pose><link name="l"><inertial><mass>1
</mass></inertial><sensor name="imu" type="imu"><always_on>1</always_on><topic>/imu</topic><update_rate>50</update_rate>
</sensor><sensor name="alt" type="altimeter"><always_on>1</always_on><topic>/alt</topic><update_rate>50</update_rate>
</sensor></link></model></world></sdf>"""

PYTHON_OR_OBJECTS = {
    "world": "argument of every command; each reader handles its files",
    "commands": "messages; --script and --cmd-vel are options for them",
    "plugins": "objects of Python",
    "tolerances": "objects, in a scenario file",
    "options": "the load options have descriptions of their own",
    "folder": "place of the description itself",
    "file": "place of the description itself",
    "recording": "--record with --force, of simkit run and simkit motion play alone",
    "change_world": "function of Python",
    "code_requests": "refusal that the user lifts by --plugin-path or --allow-code",
    "diagnostics": "messages about the description itself",
}
"""Fields of `RunSpec` without a description, with the reason."""

NO_OPTION = {
    "state": "part of a comparison, in a scenario file",
    "model": "part of a comparison, in a scenario file",
    "picture": "part of a comparison, in a scenario file",
    "test": "written by the pytest fixture",
    "bits": "written by the pytest fixture",
    "interfaces": "every command has --interfaces",
    "launch": "key of scenario files; the command is simkit launch",
    "launch_arguments": "as launch",
    "ros_parameters": "mapping, in a scenario file; a node has -p /NAME:=VALUE",
    "sleep": "from Python alone",
    "start_controllers": "from Python alone; a launch file with spawners sets it",
    "render_thread": "from Python alone; it changes no bits",
}
"""Described fields without an option, with the reason."""

RUN_A_WORLD = ("run", "launch", "plot", "bench", "bundle", "certify", "golden record", "view", "motion play", "check")
LOAD_A_WORLD = ("map", "graph", "bag video")
"""Commands that load a world and send nothing to it: the parts run and session do not apply."""
RUN_A_STORED_RUN = {
    "golden check": "the golden run has the description",
    "replay": "the bundle has the description",
    "grade": "the exercise has the description; options would change the points",
    "lab grade": "the exercise has the description; options would change the points",
    "sweep run": "the sweep file has the description",
    "sweep replay": "the sweep file has the description",
}


def command_of(line: str) -> Any:
    """Return the function of a command."""
    name, _, second = line.partition(" ")
    of_packs = (pack.package for pack in installed_packs() if Path(pack.folder, "cli", f"{name}.py").is_file())
    packages = ("simkit", *of_packs)
    found = getattr(import_module(f"{packages[-1]}.cli.{name}"), name)
    if not second:
        return found
    callbacks = {c.name or c.callback.__name__: c.callback for c in found.registered_commands if c.callback}
    return callbacks[second]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Working directory with a world in the folder `place`."""
    (tmp_path / "place").mkdir()
    (tmp_path / "place" / "ball.sdf").write_text(BALL)
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.fixture
def row(monkeypatch: pytest.MonkeyPatch) -> RunField:
    """Description of a new field."""
    option = CommandOption("--wait-for", "TOPIC", "Wait for this topic; default: {default}.", "world", usual="none")
    found = RunField("wait_for", Text(), option, "wait_for", is_loaded=True, is_load_option=True)
    monkeypatch.setitem(LOAD_FIELDS, "wait_for", found)
    return found


@pytest.mark.usefixtures("row")
def test_a_new_field_is_an_option_of_a_command() -> None:
    given_to_command: list[GivenOptions] = []
    small = typer.Typer(rich_markup_mode=None)

    @small.command()
    @with_run_options("world", without={"spawn": "no model"}, usual={"model_world": "empty space"})
    def command(
        world: Annotated[str, typer.Argument()],
        given: GivenOptions = NONE_GIVEN,
        many: Annotated[bool, typer.Option("--many")] = False,
    ) -> None:
        given_to_command.append(given)

    text = " ".join(CliRunner().invoke(small, ["--help"]).output.split())
    assert "--wait-for TOPIC" in text and "Wait for this topic; default: none." in text
    assert "--spawn" not in text and "default: empty space" in text
    done = CliRunner().invoke(small, ["w.sdf", "--wait-for", "/scan", "--seed", "0", "--many"])
    assert done.exit_code == 0, done.output
    assert given_to_command[0].values == {"wait_for": "/scan", "seed": 0}
    spec = given_to_command[0].run_spec("w.sdf")
    assert spec.seed == 0 and spec.load_arguments()["wait_for"] == "/scan"  # type: ignore[typeddict-item]


@pytest.mark.usefixtures("row")
def test_a_new_field_is_in_scenario_files_golden_runs_and_bundles(folder: Path) -> None:
    file = folder / "place" / "s.yaml"
    file.write_text("world: ball.sdf\nduration: 1\nwait_for: /scan\n")
    spec = read_scenario(file)
    assert spec.options == {"wait_for": "/scan"}
    plain = json.loads(json.dumps(encode_scenario(spec, folder / "g")))
    assert plain["options"] == {"wait_for": "/scan"}
    assert decode_scenario(plain, folder / "g").options == {"wait_for": "/scan"}
    packed = WorldStager(spec, folder / "stage").unloaded().run
    text = Manifest("n", packed, {}, (), (), {}, RunEnd(0, 0, 0, "")).text()
    assert json.loads(text)["run"] == {"wait_for": "/scan"}
    assert read_manifest(text.encode(), "b.zip").run_spec.options["wait_for"] == "/scan"  # type: ignore[typeddict-item]
    file.write_text("world: ball.sdf\nduration: 1\nwait_for: 3\n")
    with pytest.raises(LoadError, match="wait_for: found 3, expected a string"):
        read_scenario(file)


def test_a_new_field_with_files_moves_with_the_run(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    row = RunField("masks", ParameterFiles(), key="masks", is_loaded=True, is_load_option=True, default=())
    monkeypatch.setitem(LOAD_FIELDS, "masks", row)
    (folder / "place" / "m.png").write_text("mask")
    (folder / "place" / "s.yaml").write_text("world: ball.sdf\nduration: 1\nmasks: [robot=m.png]\n")
    spec = read_scenario(Path("place/s.yaml"))
    assert spec.options == {"masks": ("robot=place/m.png",)}
    plain = encode_scenario(spec, folder / "g" / "h")
    assert plain["options"] == {"masks": ["robot=../../place/m.png"]}
    assert with_absolute_paths(spec).options == {"masks": (f"robot={folder}/place/m.png",)}
    found = WorldStager(spec, folder / "stage").unloaded().run
    assert found.options["masks"] == ("robot=masks/0/m.png",)  # type: ignore[typeddict-item]
    assert (folder / "stage" / "masks" / "0" / "m.png").read_text() == "mask"
    elsewhere = spec.with_values({"masks": ("/private/m.png",)})
    refused = [keys for keys, _ in ReadableFiles(folder / "place" / "s.yaml").refused(elsewhere)]
    assert refused == [("masks", 0)]


def test_the_field_of_the_architecture_page_has_an_option_a_key_and_a_place_in_bundles() -> None:
    page = (Path(__file__).resolve().parents[1] / "docs" / "architecture.md").read_text(encoding="utf-8")
    lines = re.search(r"^    settle: .*?^    \)$", page, re.M | re.S)
    assert lines is not None
    names = {"dataclass": dataclass, "run_field": run_field, "Number": Number, "CommandOption": CommandOption}
    exec(f"@dataclass\nclass Run:\n{lines[0]}\n", names)
    settle = described_fields(names["Run"])["settle"]
    assert settle.option is not None
    assert (settle.option.name, settle.key, settle.packed, settle.is_stored) == ("--settle", "settle", "changed", True)


def test_each_field_of_a_run_has_a_description_or_a_reason() -> None:
    described = run_fields()
    assert {one.name for one in fields(RunSpec)} - described.keys() == PYTHON_OR_OBJECTS.keys()
    assert {name for name, one in described.items() if one.option is None} == NO_OPTION.keys()
    names = [one.option.name for one in described.values() if one.option is not None]
    assert len(set(names)) == len(names)


@pytest.mark.parametrize("line", [*RUN_A_WORLD, *LOAD_A_WORLD])
def test_every_command_that_runs_a_world_has_every_option_or_a_reason(line: str) -> None:
    offered: OfferedOptions = command_of(line).offered_options
    reasons = {*offered.without, *(("run", "session") if line in LOAD_A_WORLD else ())}
    missing = {
        name
        for name, one in run_fields().items()
        if one.option is not None
        and name not in offered.names
        and not reasons & {name, one.option.part, one.option.of_field}
    }
    assert not missing
    known = {*PARTS, *run_fields()}
    assert offered.without.keys() <= known and all(len(reason) > 10 for reason in offered.without.values())


def test_a_command_without_a_field_has_no_option_that_belongs_to_the_field() -> None:
    @with_run_options("run", without={"until": "the command runs to its end"})
    def command(given: GivenOptions = NONE_GIVEN) -> None: ...

    names = command.offered_options.names  # type: ignore[attr-defined]
    assert "wall_timeout" in names and not {"until", "timeout"} & {*names}
    described = run_fields()
    assert {one.option.of_field for one in described.values() if one.option is not None} <= {"", *described}


@pytest.mark.parametrize("line", RUN_A_STORED_RUN)
def test_a_command_that_repeats_a_stored_run_changes_nothing_of_it(line: str) -> None:
    assert not hasattr(command_of(line), "offered_options")


def test_an_option_replaces_or_follows_the_value_of_a_scenario(folder: Path) -> None:
    text = "world: ball.sdf\nduration: 1\nseed: 5\nset: [a.b=1]\nskip: /alt\ntopics: /imu\nbase: fixed\n"
    (folder / "place" / "s.yaml").write_text(text)
    given = {"seed": 0, "overrides": ("c.d=2",), "skip": ("/tf*",), "topics": ("/odom",), "base": "floating"}
    found = scenario_spec("place/s.yaml", GivenOptions(given))
    assert (found.seed, found.overrides, found.skip, found.topics) == (
        0,
        ("a.b=1", "c.d=2"),
        ("/alt", "/tf*"),
        ("/odom",),
    )
    assert found.options == {"base": "floating"}


def test_a_file_of_an_option_starts_from_the_working_directory(folder: Path) -> None:
    (folder / "place" / "s.yaml").write_text("world: turtlebot3_burger\nduration: 0.1\n")
    (folder / "lab.sdf").write_text(BALL)
    spec = scenario_spec("place/s.yaml", GivenOptions({"model_world": "lab.sdf"}))
    assert spec.model_world_source == str(folder / "lab.sdf")
    assert encode_scenario(spec, folder / "g")["model_world"] == "../lab.sdf"


def test_a_world_in_the_home_folder_is_no_file_of_a_scenario(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("HOME", str(folder))
    (folder / "lab.sdf").write_text(BALL)
    for key, value in (("model_world", "~/lab.sdf"), ("spawn", "~/lab.sdf:1,0,0"), ("play", "~/lab.sdf")):
        spec = RunSpec("turtlebot3_burger", folder=folder / "place")
        spec = spec.with_values({key: (value,) if key == "spawn" else value})
        assert str(folder / "lab.sdf") not in map(str, (name.used_path(spec.folder) for name in spec.files()))
        assert spec.model_world_source != str(folder / "lab.sdf")


def test_a_process_of_a_certificate_finds_the_script_and_the_bag(folder: Path) -> None:
    (folder / "go.yaml").write_text("[]\n")
    spec = with_absolute_paths(RunSpec("ball.sdf", folder=Path("place"), script=Path("go.yaml"), play="b.mcap"))
    assert spec.script == folder / "go.yaml" and spec.played_bag == folder / "place" / "b.mcap"
    assert spec.source == str(folder / "place" / "ball.sdf")


def test_a_bundle_leaves_out_topics_and_repeats_the_run_without_them(folder: Path) -> None:
    runner = CliRunner()
    words = ["bundle", "place/ball.sdf", "-o", "b.zip", "--duration", "0.2", "--skip", "/alt"]
    done = runner.invoke(app, [*words, "--on-plugin-error", "disable"])
    assert done.exit_code == 0, done.output
    with open_bundle("b.zip") as bundle:
        assert "/imu" in bundle.manifest.streams and "/alt" not in bundle.manifest.streams
        assert bundle.manifest.run_spec.skip == ("/alt",)
        assert bundle.manifest.run_spec.options["on_error"] == "disable"
    again = runner.invoke(app, ["replay", "b.zip"])
    assert again.exit_code == 0 and "identical" in again.output, again.output
