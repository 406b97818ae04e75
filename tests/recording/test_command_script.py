"""Commands over time: sent at exact ticks, and what is wrong with a script is said with its line."""

from __future__ import annotations

from pathlib import Path

import pytest

import simkit
from simkit.errors import InputError
from simkit.recording.command_script import Command, Commands, read_script, steady_velocity

TOPICS = {"/cmd_vel": "geometry_msgs/msg/Twist", "/imu": "sensor_msgs/msg/Imu"}
EMPTY = "<sdf version='1.9'><world name='w'/></sdf>"


def sent(commands: list[Command], seconds: float, chunk: int) -> list[tuple[int, float]]:
    """(tick, value) of what arrives, advancing as a loop does."""
    arrived: list[tuple[int, float]] = []
    with simkit.load(EMPTY) as sim:
        sim.communication.bus.listen("/level", ["std_msgs/msg/Float64"], lambda m: arrived.append((sim.tick, m.data)))
        queue = Commands(sim, commands)
        end = round(seconds / sim.timestep)
        while sim.tick < end:
            queue.send_due()
            ahead = queue.next_tick
            sim.step(min(chunk, end - sim.tick, (ahead or end + chunk) - sim.tick))
    return arrived


@pytest.mark.parametrize("chunk", [1, 7, 1000])
def test_commands_arrive_before_the_step_of_their_tick_for_any_length_of_runs(chunk: int) -> None:
    commands = [
        Command(0.0, "/level", {"data": 1.0}),
        Command(0.0335, "/level", {"data": 2.0}),
        Command(0.02, "/level", {"data": 3.0}, until=0.04, rate=100),
    ]
    assert sent(commands, 0.1, chunk) == [(0, 1.0), (20, 3.0), (30, 3.0), (34, 2.0), (40, 3.0)]


def test_commands_of_the_same_time_are_sent_in_the_order_of_the_list() -> None:
    commands = [Command(0.01, "/level", {"data": float(i)}) for i in range(5)]
    assert [value for _, value in sent(commands, 0.02, 1000)] == [0.0, 1.0, 2.0, 3.0, 4.0]


@pytest.mark.parametrize("text", ["0.2,0.3", "0.2 0.3", " 0.2 , 0.3 "])
def test_a_constant_velocity_is_sent_on_cmd_vel(text: str) -> None:
    command = steady_velocity(text, TOPICS)
    assert (command.topic, command.at) == ("/cmd_vel", 0.0)
    assert command.message == {"linear": {"x": 0.2}, "angular": {"z": 0.3}}
    assert [command.time(index) for index in (1, 2, 36_000)] == [0.1, 0.2, 3600.0]


def test_a_constant_velocity_is_sent_on_the_only_twist_topic() -> None:
    command = steady_velocity(
        "1,0", {"/model/a/cmd_vel": "geometry_msgs/msg/TwistStamped", "/imu": "sensor_msgs/msg/Imu"}
    )
    assert command.topic == "/model/a/cmd_vel"
    assert command.message["twist"]["linear"] == {"x": 1.0}


def test_a_constant_velocity_drives_a_controller_with_a_second_input_and_an_output() -> None:
    topics = {
        "/base/cmd_vel": "geometry_msgs/msg/Twist",
        "/base/cmd_vel_unstamped": "geometry_msgs/msg/Twist",
        "/base/cmd_vel_out": "geometry_msgs/msg/TwistStamped",
    }
    assert steady_velocity("1,0", topics).topic == "/base/cmd_vel"


def test_a_constant_velocity_is_sent_on_the_remapped_topic_of_a_controller() -> None:
    twist = "geometry_msgs/msg/Twist"
    topics = {"/robot/base_controller/cmd_vel": twist, "/robot/cmd_vel": twist}
    assert steady_velocity("1,0", topics).topic == "/robot/cmd_vel"
    with pytest.raises(InputError, match="several"):
        steady_velocity("1,0", {**topics, "/other/cmd_vel": twist})


def test_a_constant_velocity_is_not_sent_to_an_inactive_controller() -> None:
    twist = "geometry_msgs/msg/Twist"
    topics = {"/base/cmd_vel": twist, "/spare/cmd_vel": twist}
    assert steady_velocity("1,0", topics, {"/spare/cmd_vel"}).topic == "/base/cmd_vel"
    with pytest.raises(InputError, match="several"):
        steady_velocity("1,0", topics, topics)
    assert steady_velocity("1,0", {"/spare/cmd_vel": twist}, {"/spare/cmd_vel"}).topic == "/spare/cmd_vel"


@pytest.mark.parametrize(
    ("text", "topics", "reason"),
    [
        ("fast", TOPICS, "expected LINEAR,ANGULAR"),
        ("0.2", TOPICS, "expected LINEAR,ANGULAR"),
        ("0.2,nan", TOPICS, "expected LINEAR,ANGULAR"),
        ("0.2,0", {"/imu": "sensor_msgs/msg/Imu"}, "found none"),
        ("0.2,0", {"/a": "geometry_msgs/msg/Twist", "/b": "geometry_msgs/msg/Twist"}, "several (/a, /b)"),
    ],
)
def test_an_invalid_velocity_is_reported(text: str, topics: dict[str, str], reason: str) -> None:
    with pytest.raises(InputError) as error:
        steady_velocity(text, topics)
    assert reason in str(error.value)


def test_a_script_is_read(tmp_path: Path) -> None:
    path = tmp_path / "drive.yaml"
    path.write_text("- {at: 0.5, topic: cmd_vel, message: {linear: {x: 0.26}}}\n- {at: 2, topic: /cmd_vel}\n")
    first, second = read_script(path, TOPICS)
    assert (first.at, first.topic, first.message) == (0.5, "/cmd_vel", {"linear": {"x": 0.26}})
    assert (second.at, second.message) == (2.0, {})


@pytest.mark.parametrize(
    ("text", "line", "reason"),
    [
        ("- {at: 0, topic: /cmd_vel}\n- {at: x, topic: /cmd_vel}\n", 2, "at: found 'x'"),
        ("- {at: 0, topic: /cmd_vle}\n", 1, "did you mean '/cmd_vel'?"),
        ("\n\n- {at: 0, topik: /cmd_vel}\n", 3, "did you mean 'topic'?"),
        ("- {topic: /cmd_vel}\n", 1, "key 'at' is missing"),
        ("- {at: -1, topic: /cmd_vel}\n", 1, "at least 0"),
        ("- {at: 1e308, topic: /cmd_vel}\n", 1, "at most 2147483647"),
        ("- {at: 1, until: 2, rate: 1e300, topic: /cmd_vel}\n", 1, "at most 1000000"),
        ("- {at: 2, until: 1, topic: /cmd_vel}\n", 1, "until"),
        ("- {at: 1, topic: /cmd_vel, message: 3}\n", 1, "message: found 3"),
        ("- just a text\n", 1, "expected {at, topic, message}"),
        ("at: 0\n", 1, "is not a list of {at, topic, message}"),
        ("- {at: 0, topic: [\n", 2, "is not YAML"),
    ],
)
def test_an_invalid_script_is_reported_with_its_line(tmp_path: Path, text: str, line: int, reason: str) -> None:
    path = tmp_path / "drive.yaml"
    path.write_text(text)
    with pytest.raises(InputError) as error:
        read_script(path, TOPICS)
    assert str(error.value).startswith(f"{path}:{line}: ")
    assert reason in str(error.value)


@pytest.mark.parametrize("item", [f"{{at: 0, topic: {[0.0] * 5000}}}", f"{{at: 0, topic: {'x' * 5000}}}"])
def test_a_long_value_is_shortened_in_the_message(tmp_path: Path, item: str) -> None:
    (tmp_path / "s.yaml").write_text(f"- {item}\n")
    with pytest.raises(InputError, match="topic") as found:
        read_script(tmp_path / "s.yaml", {"/cmd_vel": "geometry_msgs/msg/Twist"})
    assert len(str(found.value).removeprefix(str(tmp_path))) < 300


def test_a_missing_script_is_reported(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="No such file"):
        read_script(tmp_path / "drive.yaml", TOPICS)


def test_a_mismatched_message_is_reported_with_its_line() -> None:
    with simkit.load(EMPTY) as sim:
        sim.communication.bus.listen("/level", ["std_msgs/msg/Float64"], lambda m: None)
        queue = Commands(sim, [Command(0.0, "/level", {"dat": 1.0}, where="drive.yaml:7")])
        with pytest.raises(InputError, match=r"drive\.yaml:7: .*did you mean 'data'"):
            queue.send_due()


@pytest.mark.parametrize("text", ["\0", "[" * 3000])
def test_a_script_that_is_not_yaml_is_reported(text: str, tmp_path: Path) -> None:
    script = tmp_path / "odd.yaml"
    script.write_text(text)
    with pytest.raises(InputError, match="SK-CLI-011"):
        read_script(script, TOPICS)
