"""Which sources are compared, how they are aligned and judged, and what a wrong one says."""

from __future__ import annotations

import json
import math
from pathlib import Path

import numpy as np
import pytest
from bags import imu, number, odometry, scan, velocity, write_bag
from typer.testing import CliRunner

import simkit
from simkit.cli import app

CART = """<sdf version="1.9"><world name="yard">
<plugin filename="gz-sim-sensors-system" name="gz::sim::systems::Sensors"/>
<plugin filename="gz-sim-imu-system" name="gz::sim::systems::Imu"/>
<model name="cart"><pose>0 0 0.1 0 0 0</pose><link name="base"><inertial><mass>1</mass></inertial>
<sensor name="imu" type="imu"><update_rate>100</update_rate><topic>/imu</topic><imu><angular_velocity>
<x><noise type="gaussian"><stddev>0.01</stddev></noise></x><y><noise type="gaussian"><stddev>0.01</stddev></noise></y>
<z><noise type="gaussian"><stddev>0.01</stddev></noise></z></angular_velocity></imu></sensor></link>
<plugin filename="gz-sim-velocity-control-system" name="gz::sim::systems::VelocityControl">
<topic>/cmd_vel</topic></plugin>
<plugin filename="gz-sim-odometry-publisher-system" name="gz::sim::systems::OdometryPublisher">
<odom_topic>/odom</odom_topic><robot_base_frame>base</robot_base_frame>
<odom_publish_frequency>50</odom_publish_frequency></plugin>
</model></world></sdf>"""
SCRIPT = """
- {at: 2.0, topic: /cmd_vel, message: {linear: {x: 0.5}}}
- {at: 4.0, topic: /cmd_vel, message: {angular: {z: 0.4}}}
- {at: 6.0, topic: /cmd_vel, message: {}}
"""


def invoke(*words: object) -> tuple[int, str]:
    result = CliRunner().invoke(app, ["compare", *map(str, words)])
    return result.exit_code, result.output


def voltages(path: Path, mean: float = 12.0, seed: int = 1, topic: str = "/voltage", start: float = 0.0) -> Path:
    random = np.random.default_rng(seed)
    entries = [(topic, start + 0.1 * k, number(mean + random.normal(0.0, 0.1))) for k in range(200)]
    return write_bag(path, entries)


@pytest.fixture(scope="module")
def cart(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """World and a bag of it, which was recorded with another seed."""
    folder = tmp_path_factory.mktemp("cart")
    world, script, bag = folder / "cart.sdf", folder / "script.yaml", folder / "drive.mcap"
    world.write_text(CART)
    script.write_text(SCRIPT)
    words = ["run", world, "--duration", 8, "--script", script, "--record", bag, "--seed", 1]
    assert CliRunner().invoke(app, list(map(str, words))).exit_code == 0
    return world, bag


@pytest.mark.slow
def test_the_world_repeats_the_commands_and_nothing_differs(cart: tuple[Path, Path]) -> None:
    world, bag = cart
    table = simkit.compare(bag, world, seed=2)
    assert "played: /cmd_vel" in table.notes
    assert table.is_same and table.row("/odom", "speed at /cmd_vel 0.5 m/s").b == pytest.approx(0.5, abs=1e-3)
    assert table.row("/imu", "noise of angular_velocity.x").chance < 1.0


@pytest.mark.slow
def test_a_changed_noise_and_rate_of_the_world_are_found(cart: tuple[Path, Path], tmp_path: Path) -> None:
    world, bag = cart
    page = tmp_path / "compare.html"
    changed = "cart::base::imu.imu.angular_velocity.x.noise.stddev=0.012"
    code, output = invoke(bag, world, "--seed", 2, "--set", changed, "--set", "cart::base::imu.update_rate=50",
                          "--check", "--json", "--html", page)  # fmt: skip
    assert code == 5
    report = json.loads(output[output.index("{") :])
    found = {(row["topic"], row["quantity"]) for row in report["rows"] if row["verdict"] == "differs"}
    assert {("/imu", "rate"), ("/imu", "noise of angular_velocity.x")} <= found
    assert ("/imu", "noise of angular_velocity.y") not in found and not {t for t, _ in found} - {"/imu"}
    assert "<svg" in page.read_text() and "differs" in page.read_text()


def test_topics_with_other_names_are_compared(tmp_path: Path) -> None:
    a, b = voltages(tmp_path / "a.mcap"), voltages(tmp_path / "b.mcap", seed=3, topic="/battery/voltage")
    with pytest.raises(simkit.InputError, match="SK-COMPARE-002"):
        simkit.compare(a, b)
    assert simkit.compare(a, b, names={"/voltage": "/battery/voltage"}).is_same
    assert invoke(a, b, "--map", "/voltage=/battery/voltage", "--check")[0] == 0


def test_a_topic_that_only_one_recording_has_differs(tmp_path: Path) -> None:
    a = voltages(tmp_path / "a.mcap")
    random = np.random.default_rng(3)
    both = [("/voltage", 0.1 * k, number(12.0 + random.normal(0.0, 0.1))) for k in range(200)]
    b = write_bag(tmp_path / "b.mcap", [*both, *(("/current", 0.1 * k, number(1.0)) for k in range(200))])
    table = simkit.compare(a, b)
    assert [row.verdict for row in table if row.topic == "/current"] == ["only in b"]
    assert simkit.compare(a, b, skip="/current").is_same


def test_a_tolerance_in_the_unit_or_in_percent_accepts_a_difference(tmp_path: Path) -> None:
    a, b = voltages(tmp_path / "a.mcap"), voltages(tmp_path / "b.mcap", 12.1, seed=2)
    row = simkit.compare(a, b).row("/voltage", "data")
    assert row.verdict == "differs" and row.text.startswith("differs: b is 0.1")
    for tolerances in ({"data": 0.2}, {"/voltage:data": "2%"}, {"/volt*": "2%"}):
        assert simkit.compare(a, b, tolerances=tolerances).row("/voltage", "data").verdict == "within tolerance"
    assert invoke(a, b, "--tolerance", "data=0.001", "--check")[0] == 5


def test_recordings_with_other_clocks_are_aligned_by_a_signal(tmp_path: Path) -> None:
    random = np.random.default_rng(4)
    at = np.arange(2000) / 50.0
    turn = np.where((at > 10.0) & (at < 14.0), 0.5, np.where((at > 20.0) & (at < 22.0), -0.3, 0.0))
    paths = []
    for name, start in (("a", 0.0), ("b", 1.7e9 + 3.21)):
        noisy = turn + random.normal(0.0, 0.01, len(at))
        cut = 0 if name == "a" else 200  # b begins 4 s later in the drive
        entries = [
            ("/imu", start + t, imu(start + t, (0.0, 0.0, g))) for t, g in zip(at[cut:], noisy[cut:], strict=True)
        ]
        paths.append(write_bag(tmp_path / f"{name}.mcap", entries))
    table = simkit.compare(*paths)
    sentence = next(note for note in table.notes if "correlates best" in note)
    assert float(sentence.split()[4]) == pytest.approx(4.0, abs=0.02)
    assert table.is_same
    started = simkit.compare(*paths, align="start")
    assert any("b is moved by +0.000 s, so that both begin" in note for note in started.notes)


def test_changed_latency_is_found(tmp_path: Path) -> None:
    random = np.random.default_rng(5)
    paths = []
    for name, mean in (("a", 0.020), ("b", 0.023), ("c", 0.020)):
        late = random.gamma(4.0, mean / 4.0, 1000)
        entries = [("/imu", 0.05 * k + d, imu(0.05 * k)) for k, d in enumerate(late.tolist())]
        paths.append(write_bag(tmp_path / f"{name}.mcap", entries))
    row = simkit.compare(paths[0], paths[1]).row("/imu", "latency")
    assert row.verdict == "differs" and row.interval[0] < 0.003 < row.interval[1]
    assert simkit.compare(paths[0], paths[2]).is_same


def test_a_cut_recording_is_compared_and_a_damaged_one_is_an_error(tmp_path: Path) -> None:
    a, b = voltages(tmp_path / "a.mcap"), voltages(tmp_path / "b.mcap", seed=2)
    data = b.read_bytes()
    b.write_bytes(data[: len(data) * 3 // 5])
    table = simkit.compare(a, b)
    assert table.is_same and any(str(b) in note for note in table.notes)
    c = tmp_path / "c.mcap"
    c.write_bytes(b"no bag at all")
    code, output = invoke(a, c)
    assert code == 2 and "SK-CLI-035" in output


@pytest.mark.parametrize(
    ("words", "code"),
    [
        (["turtlebot3_empty"], "SK-COMPARE-001"),
        (["BAG", "--tolerance", "rate"], "SK-COMPARE-003"),
        (["BAG", "BAG", "--tolerance", "rate=-1"], "SK-COMPARE-003"),
        (["BAG", "BAG", "--map", "/scan"], "SK-COMPARE-003"),
        (["BAG", "BAG", "--seed", "3"], "SK-COMPARE-003"),
        (["BAG", "--topic", "/nothing"], "SK-COMPARE-001"),
    ],
)
def test_a_mistake_has_a_code(tmp_path: Path, words: list[str], code: str) -> None:
    bag = voltages(tmp_path / "a.mcap")
    status, output = invoke(*(bag if word == "BAG" else word for word in words))
    assert status == 2 and code in output


def test_sets_of_runs_are_compared_in_pairs(tmp_path: Path) -> None:
    random = np.random.default_rng(6)
    for name, offset in (("a", 0.0), ("b", 0.03)):
        (tmp_path / name).mkdir()
        difficulty = np.random.default_rng(7).normal(5.0, 0.5, 12)
        lines = ["run,seed,goal_time,exit_code,status"]
        for k, value in enumerate(difficulty.tolist()):
            lines.append(f"{k},{k},{value + offset + random.normal(0.0, 0.01)},0,ok")
        (tmp_path / name / "results.csv").write_text("\n".join(lines) + "\n")
    table = simkit.compare(tmp_path / "a", tmp_path / "b")
    row = table.row("", "goal_time")
    assert row.verdict == "differs" and row.interval[0] < 0.03 < row.interval[1]
    assert row.unpaired[0] < 0.0 < row.unpaired[1] and row.saving > 100.0
    with pytest.raises(simkit.InputError, match="SK-COMPARE-004"):
        simkit.compare(tmp_path / "a")


def test_folders_of_bags_are_compared_in_pairs(tmp_path: Path) -> None:
    for name, offset in (("a", 0.0), ("b", 0.02)):
        (tmp_path / name).mkdir()
        for k in range(5):
            voltages(tmp_path / name / f"{k}.mcap", 12.0 + 0.3 * k + offset, seed=k)
    row = simkit.compare(tmp_path / "a", tmp_path / "b").row("/voltage", "data")
    assert row.difference == pytest.approx(0.02, abs=1e-6) and row.verdict == "differs"


def test_a_table_is_read_in_python_and_in_a_notebook(tmp_path: Path) -> None:
    table = simkit.compare(voltages(tmp_path / "a.mcap"), voltages(tmp_path / "b.mcap", 12.5, seed=2))
    frame = table.to_dataframe()
    assert list(frame["verdict"]).count("differs") == len(table.differing) > 0
    assert "/voltage" in table._repr_html_() and "differs" in repr(table)
    assert all(hasattr(table[0], name) for name in ("topic", "quantity", "a", "b", "difference", "unit", "interval"))
    with pytest.raises(KeyError, match="did you mean"):
        table.row("/voltage", "dato")


def test_two_wheels_with_other_scales_are_found(tmp_path: Path) -> None:
    random = np.random.default_rng(8)
    at = np.arange(1000) / 50.0
    speed = 0.2 * np.sign(np.sin(at))
    paths = []
    for name, scale in (("a", 1.0), ("b", 0.97)):
        noisy = scale * speed + random.normal(0.0, 0.005, len(at))
        entries = [("/odom", t, odometry(t, 0.0, 0.0, v, 0.0)) for t, v in zip(at, noisy, strict=True)]
        entries += [("/cmd_vel", t, velocity(s)) for t, s in zip(at[::5], speed[::5], strict=True)]
        paths.append(write_bag(tmp_path / f"{name}.mcap", entries))
    row = simkit.compare(*paths).row("/odom", "spread of twist.twist.linear.x")
    assert row.verdict == "differs" and row.b / row.a == pytest.approx(0.97, abs=0.005)


def test_scans_of_two_noises_are_not_compared_while_the_scene_moves(tmp_path: Path) -> None:
    entries = [("/scan", 0.1 * k, scan(0.1 * k, np.full(100, 1.0 + 0.05 * k))) for k in range(60)]
    table = simkit.compare(write_bag(tmp_path / "a.mcap", entries))
    assert any("never still" in note for note in table.notes)
    assert not [row for row in table if row.quantity.startswith("noise at")]
    assert math.isnan(table.row("/scan", "fields without change").b)


@pytest.mark.slow
def test_two_runs_with_other_seeds_seldom_differ(tmp_path: Path) -> None:
    """At most 5 % of the tables have a false alarm; at 20 tables, 4 or more have a chance of 2 %."""
    world, script = tmp_path / "cart.sdf", tmp_path / "script.yaml"
    world.write_text(CART)
    script.write_text(SCRIPT)
    bags = []
    for seed in range(40):
        bag = tmp_path / f"{seed}.mcap"
        words = ["run", world, "--duration", 8, "--script", script, "--record", bag, "--seed", seed]
        assert CliRunner().invoke(app, list(map(str, words))).exit_code == 0
        bags.append(bag)
    alarms = 0
    chances: list[float] = []
    for a, b in zip(bags[::2], bags[1::2], strict=True):
        table = simkit.compare(a, b)
        alarms += not table.is_same
        chances += [row.chance for row in table if 0.0 < row.chance < 1.0]
    assert alarms <= 3
    assert float(np.mean(np.array(chances) < 0.05)) < 0.07


def test_missing_numbers_are_rows_and_the_types_of_a_topic_are_named(tmp_path: Path) -> None:
    times = [0.01 * k for k in range(100)]
    whole = write_bag(tmp_path / "whole.mcap", [("/imu", t, imu(t, (math.sin(t), 0, 0))) for t in times])
    gyro = [(math.nan, math.inf, 0.0) if k % 4 == 0 else (math.sin(t), 0.0, 0.0) for k, t in enumerate(times)]
    holed = write_bag(tmp_path / "holed.mcap", [("/imu", t, imu(t, g)) for t, g in zip(times, gyro, strict=True)])
    table = simkit.compare(whole, holed)
    for axis in "xy":
        row = table.row("/imu", f"missing share of angular_velocity.{axis}")
        assert (row.verdict, row.b) == ("only in b", pytest.approx(0.25))
    assert simkit.compare(holed, holed).is_same
    other = write_bag(tmp_path / "other.mcap", [("/imu", t, number(t)) for t in times])
    table = simkit.compare(whole, other)
    assert table.row("/imu", "type").text == "differs: types sensor_msgs/msg/Imu and std_msgs/msg/Float64"
    assert "nan" not in table.text(everything=True)


def test_names_of_topics_that_do_not_exist_are_errors_and_unused_tolerances_are_notes(tmp_path: Path) -> None:
    a, b = voltages(tmp_path / "a.mcap"), voltages(tmp_path / "b.mcap", topic="/volts")
    with pytest.raises(simkit.InputError) as caught:
        simkit.compare(a, b, names={"/voltag": "/volts", "/voltage": "/vlts"})
    assert [line.split(";")[1].strip() for line in caught.value.message.splitlines()] == [
        "did you mean '/voltage'?",
        "did you mean '/volts'?",
    ]
    table = simkit.compare(a, b, names={"/voltage": "/volts"}, tolerances={"latncy": 0.1, "data": "5%"})
    assert [note for note in table.notes if "tolerance" in note] == ["tolerance latncy: no row is called so"]


def test_a_recording_with_nothing_but_commands_says_so(cart: tuple[Path, Path], tmp_path: Path) -> None:
    commands = write_bag(tmp_path / "commands.mcap", [("/cmd_vel", 0.1 * k, velocity(0.1)) for k in range(10)])
    with pytest.raises(simkit.InputError, match="no topic in common besides the commands /cmd_vel; a has none"):
        simkit.compare(commands, cart[0])


def test_a_recording_that_was_cut_off_before_its_messages_says_so(tmp_path: Path) -> None:
    a = voltages(tmp_path / "a.mcap")
    (tmp_path / "cut.mcap").write_bytes(a.read_bytes()[:400])
    with pytest.raises(simkit.InputError, match="its topics: none; the recording was cut off"):
        simkit.compare(a, tmp_path / "cut.mcap")
