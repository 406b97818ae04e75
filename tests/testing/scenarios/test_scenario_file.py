"""Scenario files: all keys are read, or every problem is reported with its line."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pytest

from simkit import LoadError
from simkit.run_spec import Check, RunSpec, Tolerance
from simkit.testing.scenarios.scenario_file import is_scenario_file, read_scenario
from simkit.testing.scenarios.scenario_run import open_scenario, run_scenario

BALL = """<sdf version="1.9"><world name="default"><model name="ball"><pose>0 0 5 0 0 0</pose><link name="b">
<collision name="c"><geometry><sphere><radius>0.1</radius></sphere></geometry></collision>
<sensor name="imu" type="imu"><update_rate>100</update_rate><topic>imu</topic></sensor></link></model></world></sdf>"""


def scenario(tmp_path: Path, text: str, name: str = "drop.yaml", folders: Sequence[Path] = ()) -> RunSpec:
    (tmp_path / "ball.sdf").write_text(BALL)
    file = tmp_path / name
    file.write_text(text)
    return read_scenario(file, folders)


def problems(tmp_path: Path, text: str, name: str = "drop.yaml") -> list[tuple[int | None, str]]:
    with pytest.raises(LoadError) as caught:
        scenario(tmp_path, text, name)
    return [(found.line, found.code) for found in caught.value.diagnostics]


def test_a_world_alone_is_a_scenario_of_ten_seconds(tmp_path):
    found = scenario(tmp_path, "world: ball.sdf\n")
    assert (found.world, found.duration, found.seed, found.title) == ("ball.sdf", 10.0, 0, "ball")
    assert found.source == str(tmp_path / "ball.sdf")
    assert found.checks == found.tolerances == found.commands == ()


def test_a_bare_name_that_is_no_file_beside_it_stays_one(tmp_path):
    assert scenario(tmp_path, "world: turtlebot3_world\n").source == "turtlebot3_world"


def test_all_keys_of_a_scenario_are_read(tmp_path):
    found = scenario(
        tmp_path,
        """
        world: ball.sdf
        name: fall
        duration: 1e0
        seed: 3
        set: {physics.max_step_size: 0.002, world.gravity: [0, 0, -1], ball.static: false}
        spawn: "box:0,0,0"
        resource_paths: [models]
        package_paths: {my_robot: ../robot}
        params_files: [arm=control.yaml, plain.yaml]
        xacro_args: {arm: true}
        commands:
          - {at: 1, topic: cmd_vel, message: {linear: {x: 1e-1}}}
        """,
        folders=[tmp_path.parent],
    )
    assert (found.title, found.duration, found.seed) == ("fall", 1.0, 3)
    assert found.overrides == ("physics.max_step_size=0.002", "world.gravity=0 0 -1", "ball.static=false")
    assert found.spawn == ("box:0,0,0",)
    assert found.options["resource_paths"] == (tmp_path / "models",)
    assert found.options["package_paths"] == {"my_robot": tmp_path / ".." / "robot"}
    assert found.options["params_files"] == (f"arm={tmp_path / 'control.yaml'}", str(tmp_path / "plain.yaml"))
    assert found.options["xacro_args"] == {"arm": "true"}
    assert found.commands[0]["at"] == 1 and found.commands[0]["where"].endswith("drop.yaml:13")


def test_package_paths_can_be_a_list_whose_folders_keep_their_place_in_golden_runs_and_certificates(tmp_path):
    from simkit.testing.golden.record_encoding import decode_scenario, encode_scenario
    from simkit_verification.testing.certify.certification import with_absolute_paths

    found = scenario(tmp_path, "world: ball.sdf\npackage_paths: [../ws, arm=robot]\n", folders=[tmp_path.parent])
    expected = [f"arm={tmp_path / 'robot'}", tmp_path / ".." / "ws"]
    assert found.options["package_paths"] == expected
    assert with_absolute_paths(found).options["package_paths"] == [str(path) for path in expected]
    golden = tmp_path / "golden" / "drop"
    data = encode_scenario(found, golden)
    assert data["options"] == {"package_paths": ["arm=../../robot", "../../../ws"]}
    again = decode_scenario(data, golden).options["package_paths"]
    assert again == [f"arm={golden}/../../robot", f"{golden}/../../../ws"]


def test_commands_can_be_in_a_script_file(tmp_path):
    (tmp_path / "push.yaml").write_text("- {at: 0.5, topic: /push, message: {data: 1}}\n")
    found = scenario(tmp_path, "world: ball.sdf\ncommands: push.yaml\n")
    assert [command["topic"] for command in found.commands] == ["/push"]


def test_tolerances_are_numbers_words_or_mappings(tmp_path):
    found = scenario(
        tmp_path,
        """
        world: ball.sdf
        tolerances:
          /imu.linear_acceleration: 0.1
          /scan: {absolute: 0.002, share: 0.01}
          odom: exact
          /camera/*: {ssim: 0.9, image: 2}
          /clock: ignore
        statistics: imu
        """,
    )
    assert [replaced(t) for t in found.tolerances] == [
        Tolerance("/imu.linear_acceleration", absolute=0.1),
        Tolerance("/scan", absolute=0.002, share=0.01),
        Tolerance("/odom", exact=True),
        Tolerance("/camera/*", ssim=0.9, image=2.0),
        Tolerance("/clock", ignore=True),
        Tolerance("/imu", statistics=True),
    ]
    assert [t.pattern for t in found.tolerance("/imu", "linear_acceleration.x")] == ["/imu.linear_acceleration", "/imu"]
    assert [t.pattern for t in found.tolerance("/camera/image")] == ["/camera/*"]


def replaced(tolerance: Tolerance) -> Tolerance:
    from dataclasses import replace

    return replace(tolerance, where="")


def test_a_condition_is_an_expression_or_a_mapping(tmp_path):
    found = scenario(
        tmp_path,
        """
        world: ball.sdf
        goals:
          - pose('ball').z < 4
          - {name: lands, that: "contact('ball')", by: 2, points: 3, hint: let go}
        limits: speed('ball') < 20
        at_end: [true]
        no_contact: [[ball, wall], ball]
        rates: {/imu: own, scan: 5}
        """,
    )
    kinds = [(check.kind, check.title) for check in found.checks]
    assert kinds == [
        ("goal", "pose('ball').z < 4"),
        ("goal", "lands"),
        ("always", "speed('ball') < 20"),
        ("final", "true"),
        ("apart", "ball and wall do not touch"),
        ("apart", "ball touches nothing"),
        ("rate", "/imu ticks"),
        ("rate", "/scan ticks at 5 Hz"),
    ]
    lands = found.checks[1]
    assert (lands.by, lands.points, lands.hint) == (2.0, 3.0, "let go")
    assert lands.where.endswith("drop.yaml:5")


def test_all_problems_are_reported_at_once_with_their_lines(tmp_path):
    found = problems(
        tmp_path,
        "world: ball.sdf\n"
        "duraton: 3\n"
        "duration: 3\n"
        "duration: -1\n"
        "seed: 1.5\n"
        "goals: [{thta: x}]\n"
        "tolerances: {/imu: {share: 2}, /odom: often}\n"
        "no_contact: [[a, b, c]]\n"
        "base: floor\n"
        "commands: 3\n",
    )
    assert sorted(found) == [
        (2, "SK-SCEN-002"),
        (4, "SK-SCEN-003"),  # duplicate key
        (4, "SK-SCEN-003"),  # not a duration
        (5, "SK-SCEN-003"),
        (6, "SK-SCEN-002"),
        (6, "SK-SCEN-004"),
        (7, "SK-SCEN-003"),
        (7, "SK-SCEN-003"),
        (8, "SK-SCEN-003"),
        (9, "SK-SCEN-003"),
        (10, "SK-SCEN-003"),
    ]


def test_problems_of_expressions_and_the_world_are_reported_together(tmp_path):
    with pytest.raises(LoadError) as caught:
        scenario(
            tmp_path,
            "world: turtlebot3_wrld\n"
            "duraton: 3\n"
            "base: floor\n"
            "until: pose('ball').z >\n"
            "goals:\n"
            "  - pose('ball').z > > 2\n"
            "  - {that: speed(, by: 1}\n",
        )
    found = [(one.line, one.code) for one in caught.value.diagnostics]
    assert sorted(found, key=str) == [
        (2, "SK-SCEN-002"),
        (3, "SK-SCEN-003"),
        (4, "SK-COND-001"),
        (6, "SK-COND-001"),
        (7, "SK-COND-001"),
        (None, "SK-LOAD-002"),
    ]
    assert "turtlebot3_world" in str(caught.value)
    assert "^" in str(caught.value), "the place within the expression is shown"


@pytest.mark.parametrize(
    "text, code",
    [
        ("world: [", "SK-SCEN-001"),
        ("", "SK-SCEN-004"),
        ("- world\n", "SK-SCEN-003"),
        ("world: &a [*a]\n", "SK-SCEN-001"),
        ("world: {" + "a: {" * 300, "SK-SCEN-001"),
        ("world: \x00", "SK-SCEN-001"),
    ],
)
def test_an_invalid_scenario_has_the_code_of_its_problem(tmp_path, text, code):
    assert code in [found for _, found in problems(tmp_path, text)]


def test_a_missing_file_is_reported(tmp_path):
    with pytest.raises(LoadError, match="SK-SCEN-001"):
        read_scenario(tmp_path / "none.yaml")
    with pytest.raises(LoadError, match="SK-SCEN-001"):
        read_scenario(tmp_path / "none.py")


def test_a_python_file_has_a_scenario(tmp_path):
    found = scenario(
        tmp_path,
        "from simkit.run_spec import Check, RunSpec\n"
        "scenario = RunSpec('ball.sdf', 0.2, checks=(Check('goal', expression='time > 0.1'),))\n",
        "drop.py",
    )
    assert found.source == str(tmp_path / "ball.sdf")
    assert found.checks == (Check("goal", expression="time > 0.1"),)


@pytest.mark.parametrize("text, line", [("x = 1\n", None), ("a = 1\nb = a / 0\n", 2), ("def f(:\n", 1)])
def test_a_python_file_that_fails_or_has_no_scenario_is_an_error(tmp_path, text, line):
    assert problems(tmp_path, text, "drop.py") == [(line, "SK-SCEN-005")]


def test_a_scenario_file_is_recognised_by_its_suffix():
    assert is_scenario_file("drop.yaml") and is_scenario_file("a/drop.py")
    assert not is_scenario_file("ball.sdf") and not is_scenario_file("turtlebot3_world")


def test_a_scenario_runs_to_its_end_with_its_seed_and_settings(tmp_path):
    found = scenario(tmp_path, "world: ball.sdf\nduration: 0.5\nset: {physics.max_step_size: 0.01}\nseed: 4\n")
    with open_scenario(found) as sim:
        ended = run_scenario(found, sim)
        assert (ended.reason, sim.time, sim.tick, sim.engine.streams.seed) == ("duration", 0.5, 50, 4)
        assert sim.model("ball").pose.position[2] == pytest.approx(5 - 0.5 * 9.8 * 0.5**2, abs=0.03)


SLED = """<sdf version="1.9"><world name="ice"><model name="sled"><pose>0 0 1 0 0 0</pose><link name="base"/>
<plugin filename="gz-sim-velocity-control-system" name="gz::sim::systems::VelocityControl"/></model></world></sdf>"""


def test_a_bag_is_played_at_its_ticks_and_sets_the_duration(tmp_path):
    """The run is bit-identical, also for a golden run, which stores the path of the bag relative to its folder."""
    from simkit.recording.bags.recorder import Recorder
    from simkit.runtime.engine.snapshot import state_hash
    from simkit.testing.golden.record_encoding import decode_scenario, encode_scenario

    (tmp_path / "ice.sdf").write_text(SLED)
    topic = "/model/sled/cmd_vel"
    commands = [{"at": at, "topic": topic, "message": {"linear": {"x": at}}} for at in (0.05, 0.133)]
    driven = RunSpec("ice.sdf", duration=0.2, commands=tuple(commands), folder=tmp_path)
    with open_scenario(driven) as sim:
        with Recorder(sim, tmp_path / "drive.mcap"):
            run_scenario(driven, sim)
        wanted = state_hash(sim)
    (tmp_path / "again.yaml").write_text("world: ice.sdf\nplay: drive.mcap\n")
    read = read_scenario(tmp_path / "again.yaml")
    golden = tmp_path / "golden" / "ice"
    golden.mkdir(parents=True)
    for played in (read, decode_scenario(encode_scenario(read, golden), golden)):
        assert played.duration == pytest.approx(0.2)
        with open_scenario(played) as sim:
            run_scenario(played, sim)
            assert state_hash(sim) == wanted


def test_an_invalid_bag_is_reported_with_its_line(tmp_path):
    for text in ("play: none.mcap", "play: ball.sdf", "play: 3", "play: ''", "play_topics: [/a]"):
        ((line, code),) = problems(tmp_path, f"world: ball.sdf\n{text}\n")
        assert line == 2
        assert code in ("SK-CLI-035", "SK-SCEN-003", "SK-SCEN-004")


@pytest.mark.parametrize(
    "text, found",
    [
        ("timeout: 3\n", [(2, "SK-SCEN-004")]),
        ("until: time > 1\nduration: 2\ntimeout: 3\n", [(4, "SK-SCEN-003")]),
        ("tolerances: {/imu: {exact: true, ignore: true}}\n", [(2, "SK-SCEN-003")]),
        ("no_contact: [[ball, ball]]\n", [(2, "SK-SCEN-003")]),
        ("goals: ['']\nspawn: ['']\nrates: {'': 3}\n", [(2, "SK-SCEN-003"), (3, "SK-SCEN-003"), (4, "SK-SCEN-003")]),
        ("set: {a: {b: c}, d: null}\n", [(2, "SK-SCEN-003")] * 2),
        ("xacro_args: {a: null}\n", [(2, "SK-SCEN-003")]),
        ("seed: 1\non: 3\n", [(3, "SK-SCEN-002")]),
        (f"duration: {10**400}\n", [(2, "SK-SCEN-003")]),
        ("duration: 12:30\n", [(2, "SK-SCEN-003")]),
        ("commands:\n - 1\n - {at: 1:30, topic: /a}\n - {at: 1}\n", [(n, "SK-CLI-011") for n in (3, 4, 5)]),
    ],
)
def test_missing_and_conflicting_keys_are_reported(tmp_path, text, found):
    assert sorted(problems(tmp_path, "world: ball.sdf\n" + text)) == found


def test_a_scenario_with_a_byte_order_mark_and_windows_line_ends_is_read(tmp_path):
    (tmp_path / "ball.sdf").write_text(BALL)
    file = tmp_path / "drop.yaml"
    file.write_bytes("\ufeffworld: ball.sdf\r\nname: größe 机\r\ngoals:\r\n  - 1 > 0\r\n".encode())
    found = read_scenario(file)
    assert found.name == "größe 机" and found.checks[0].where.endswith(":4")


def test_a_spawned_file_is_resolved_relative_to_the_scenario(tmp_path):
    (tmp_path / "box.sdf").write_text("<sdf/>")
    found = scenario(tmp_path, "world: ball.sdf\nspawn: ['box.sdf:1,2,0', 'tiago:0,0,0']\n")
    assert found.spawn == (f"{tmp_path / 'box.sdf'}:1,2,0", "tiago:0,0,0")
    text = "from simkit import RunSpec\nscenario = RunSpec('ball.sdf', spawn=('box.sdf:1,2,0',))\n"
    assert scenario(tmp_path, text, "drop.py").spawn == (f"{tmp_path / 'box.sdf'}:1,2,0",)


def test_a_scenario_created_in_python_is_validated(tmp_path):
    text = """
from simkit.run_spec import Check, RunSpec
scenario = RunSpec(
    3, float("nan"), seed=-1, topics="imu", spawn=[1], until=None, commands=({"topic": "/x"},), tolerances=(1,),
    checks=(Check("gaol", by="now"), Check("apart", models="ball")),
)
"""
    assert problems(tmp_path, text, "drop.py") == [(None, "SK-SCEN-003")] * 11


def test_a_folder_that_is_no_model_does_not_hide_a_world_of_its_name(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "turtlebot3_empty").mkdir()
    (tmp_path / "turtlebot3_empty" / "golden.json").write_text("{}")
    found = scenario(tmp_path, "world: turtlebot3_empty\nduration: 0\n")
    assert found.source == "turtlebot3_empty"
    with open_scenario(found) as sim:
        assert "turtlebot3" in sim.models
