"""Types of the user: found in folders, checked with file and line, encoded as ROS 2 encodes them."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

import simkit
from simkit import msgs
from simkit.errors import InterfaceError, MessageError
from simkit.msgs import own_interfaces
from simkit.recording.bags.type_definitions import definition_store

WORLD = '<sdf version="1.9"><world name="room"/></sdf>'
Write = Callable[[str, str], Path]


@pytest.fixture
def write(tmp_path: Path) -> Write:
    """Return a function that writes a file below the test's folder."""

    def to(name: str, text: str) -> Path:
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
        return path

    return to


def problems(name: str, text: str) -> list[tuple[str, int | None, str]]:
    """Return code, line and message of each problem of a definition."""
    with pytest.raises(InterfaceError) as caught:
        msgs.add(name, text)
    return [(d.code, d.line, d.message) for d in caught.value.diagnostics]


def test_a_definition_gives_defaults_constants_bounds_and_nested_types() -> None:
    msgs.add("own_a/msg/Inner", "byte level 3\nwstring label\n")
    msgs.add(
        "own_a/msg/Outer",
        "uint8 RED=1\nstring TEXT='a # b'  # a comment\nint64 number 7\nfloat64[3] axis [1, 2, 3]\nInner[2] inner\n"
        'string<=5 name "abc"\nbool is_on TRUE\nuint64[] big [18446744073709551615, 1]\nint32[<=2] few\n',
    )
    made = msgs.make("own_a/Outer", inner=[{"label": "é"}, {"level": 4}])
    assert (made.RED, made.TEXT, made.number, made.name, made.is_on) == (1, "a # b", 7, "abc", True)
    assert made.axis.tolist() == [1.0, 2.0, 3.0]
    assert made.big.tolist() == [2**64 - 1, 1]
    assert [(inner.level, inner.label) for inner in made.inner] == [(3, "é"), (4, "")]
    again = msgs.deserialize(msgs.serialize(made), "own_a/msg/Outer")
    assert msgs.serialize(again) == msgs.serialize(made)
    assert msgs.type_of("own_a/msg/Outer") is simkit.msgs.Outer
    for field, value, text in (
        ("name", "abcdef", "at most 5"),
        ("few", [1, 2, 3], "at most 2"),
        ("axis", [1], "expected 3"),
    ):
        with pytest.raises(MessageError, match=text):
            msgs.make("own_a/msg/Outer", **{field: value})


def test_wide_strings_have_the_bytes_of_ros_2_in_both_byte_orders() -> None:
    """The bytes are those of `rclpy.serialization.serialize_message` (Jazzy) for a field of type `wstring`."""
    msgs.add("own_w/msg/Wide", "uint8 first\nwstring text\nwstring<=9[] more\nfloat64 last\n")
    made = msgs.make("own_w/msg/Wide", first=1, text="hé😀", more=["", "x"], last=0.5)
    data = msgs.serialize(made)
    assert data[8:28] == bytes.fromhex("0400000068000000e90000003dd8000000de0000")
    assert msgs.deserialize(data, "own_w/msg/Wide") == made
    big = bytes(msgs.type_store().serialize_cdr(made, "own_w/msg/Wide", little_endian=False))
    assert big[8:16] == bytes.fromhex("0000000400000068")
    assert msgs.deserialize(big, "own_w/msg/Wide") == made
    store = definition_store("own_w/msg/Wide", msgs.definition("own_w/msg/Wide"))
    assert store.deserialize_cdr(data, "own_w/msg/Wide").more == ["", "x"]


def test_type_hashes_are_those_that_ros_2_computed_for_test_msgs() -> None:
    """The definitions and hashes are of the package test_msgs (Jazzy)."""
    text = "wstring wstring_value\n" + "".join(
        f'wstring wstring_value_default{i} "{value}"\n'
        for i, value in enumerate(("Hello world!", "Hellö wörld!", "ハローワールド"), 1)
    )
    arrays = "wstring[3] array_of_wstrings\nwstring[<=3] bounded_sequence_of_wstrings\n"
    arrays += "wstring[] unbounded_sequence_of_wstrings\n"
    msgs.add("test_msgs/msg/WStrings", text + arrays)
    msgs.add("test_msgs/action/Fibonacci", "int32 order\n---\nint32[] sequence\n---\nint32[] sequence\n")
    assert (
        msgs.rihs("test_msgs/msg/WStrings") == "RIHS01_5a2c8ddb2054600023b9a180652f2ba895373217cad4b1f0fc1258c9e4424a79"
    )
    assert (
        msgs.rihs("test_msgs/action/Fibonacci")
        == "RIHS01_be9273e3557225044b4a040811112491f7079326e3a573f83258b0b4c30bd069"
    )


def test_every_problem_of_a_definition_is_reported_in_one_pass() -> None:
    text = "int a\nint32 wheelCount\nint8 b 300\nPose pose\nfloat64 c=1\n"
    text += "int32[0] d\nint32 b\nstring<=2 e 'abc'\nint8<=3 f\n---\n"
    found = problems("own_b/msg/Bad", text)
    assert [(code, line) for code, line, _ in found] == [
        ("SK-INTERFACE-003", 1),
        ("SK-INTERFACE-002", 2),
        ("SK-INTERFACE-001", 3),
        ("SK-INTERFACE-002", 5),
        ("SK-INTERFACE-001", 6),
        ("SK-INTERFACE-001", 7),
        ("SK-INTERFACE-001", 8),
        ("SK-INTERFACE-001", 9),
        ("SK-INTERFACE-001", None),
        ("SK-INTERFACE-003", 4),
    ]
    assert "expected a whole number from -128 to 127" in found[2][2]


@pytest.mark.parametrize(
    ("name", "text", "code"),
    [
        ("own_c/msg/lower", "int8 a", "SK-INTERFACE-002"),
        ("Own_c/msg/Num", "int8 a", "SK-INTERFACE-002"),
        ("own__c/msg/Num", "int8 a", "SK-INTERFACE-002"),
        ("own_c/Num", "int8 a", "SK-INTERFACE-002"),
        ("own_c/srv/Half", "int8 a", "SK-INTERFACE-001"),
        ("own_c/action/Half", "int8 a\n---\n", "SK-INTERFACE-001"),
        ("own_c/msg/Loop", "Loop[] loops", "SK-INTERFACE-005"),
        ("own_c/msg/Huge", "geometry_msgs/Pose[1000000] poses", "SK-INTERFACE-005"),
        ("own_c/msg/Word", "int8", "SK-INTERFACE-001"),
        ("own_c/msg/Quote", "string a 'x", "SK-INTERFACE-001"),
        ("own_c/msg/Nested", "geometry_msgs/Pose pose 3", "SK-INTERFACE-001"),
        ("std_msgs/msg/String", "string text", "SK-INTERFACE-004"),
    ],
)
def test_a_definition_is_refused_with_its_code_and_is_not_stored(name: str, text: str, code: str) -> None:
    assert [problem[0] for problem in problems(name, text)] == [code]
    if not name.startswith("std_msgs"):
        with pytest.raises(MessageError, match="unknown message type"):
            msgs.make(name)


def test_an_equal_second_definition_has_no_effect_and_a_different_one_is_an_error() -> None:
    msgs.add("own_d/msg/Num", "int64 num")
    msgs.add("own_d/msg/Num", "# the same\nint64 num  # number\n")
    (problem,) = problems("own_d/msg/Num", "int64 num 3")
    assert problem[0] == "SK-INTERFACE-004"
    (problem,) = problems("own_d/msg/Num", "float64 num")
    assert "fields" in problem[2]


def test_a_folder_is_a_package_a_workspace_or_plain(write: Write, tmp_path: Path) -> None:
    write("ws/src/group/robot_msgs_e/package.xml", "<package><name>own_e</name></package>")
    write("ws/src/group/robot_msgs_e/msg/Num.msg", "int64 num\nown_f/Other other\n")
    write("ws/src/group/robot_msgs_e/srv/Add.srv", "int64 a\n---\nint64 sum\n")
    write("ws/install/own_e/share/own_e/srv/Add.srv", "int64 a\n---\nint64 sum\n")
    write("ws/install/own_e/share/own_e/srv/Add_Request.msg", "int64 a\n")
    write("ws/build/own_e/msg/Num.msg", "broken\n")
    write("ws/src/ignored/COLCON_IGNORE", "")
    write("ws/src/ignored/msg/Num.msg", "broken\n")
    write("plain/own_f/Other.msg", "float32 value\n")
    own_interfaces.add_folders([tmp_path / "ws", tmp_path / "plain"])
    assert msgs.make("own_e/Num", other={"value": 0.5}).other.value == 0.5
    assert msgs.make("own_e/srv/Add_Response").sum == 0


def test_problems_of_all_folders_and_files_are_reported_together_with_their_files(write: Write, tmp_path: Path) -> None:
    first = write("own_g/msg/First.msg", "int64 num\nint64 num\n")
    second = write("own_g/msg/Second.msg", "\nUnknown field\n")
    write("own_g/msg/latin.msg", "")
    with pytest.raises(InterfaceError) as caught:
        own_interfaces.add_folders([tmp_path / "own_g", tmp_path / "missing"])
    places = {(d.file, d.line) for d in caught.value.diagnostics if d.line}
    assert places == {(str(first), 2), (str(second), 2)}
    assert sorted(d.code[-1] for d in caught.value.diagnostics) == ["1", "2", "3", "6"]


def test_a_definition_with_errors_is_left_out_with_those_that_use_it(write: Write, tmp_path: Path) -> None:
    bad = write("own_r/msg/Bad.msg", "int64 num\nint64 num\n")
    user = write("own_r/msg/User.msg", "float32 value\nBad bad\n")
    write("own_r/msg/Good.msg", "int64 num\n")
    reports = own_interfaces.add_folders([tmp_path / "own_r"])
    assert [(r.code, r.severity, r.file, r.line) for r in reports] == [
        ("SK-INTERFACE-001", "warning", str(bad), 2),
        ("SK-INTERFACE-003", "warning", str(user), 2),
    ]
    assert msgs.make("own_r/Good", num=3).num == 3
    with pytest.raises(InterfaceError, match="defined twice"):
        msgs.make("own_r/Bad")
    bad.write_text("int64 num\n", encoding="utf-8")
    assert own_interfaces.add_folders([tmp_path / "own_r"]) == []
    assert msgs.make("own_r/User", bad={"num": 4}).bad.num == 4


def test_a_catkin_package_may_have_the_names_and_types_of_ros_1(write: Write, tmp_path: Path) -> None:
    catkin = "<package><name>own_t</name><buildtool_depend>catkin</buildtool_depend></package>"
    write("own_t/package.xml", catkin)
    file = write("own_t/srv/AddInts.srv", "int64 A\nint64 B\n---\nint64 Sum\n")
    write("own_t/msg/Stamped.msg", "Header header\ntime begin\nduration length\n")
    (note,) = own_interfaces.add_folders([tmp_path / "own_t"])
    assert (note.code, note.severity, note.file) == ("SK-INTERFACE-007", "note", str(file))
    assert "A, B, Sum" in note.message
    request = msgs.make("own_t/srv/AddInts_Request", A=1, B=2)
    assert msgs.deserialize(msgs.serialize(request), "own_t/srv/AddInts_Request") == request
    stamped = msgs.make("own_t/Stamped", header={"frame_id": "map"}, begin={"sec": 1}, length={"sec": 2})
    assert (stamped.header.frame_id, stamped.begin.sec, stamped.length.sec) == ("map", 1, 2)
    write("own_t/package.xml", catkin.replace("catkin", "ament_cmake").replace("own_t", "own_u"))
    with pytest.raises(InterfaceError, match="is not the name of a field"):
        own_interfaces.add_folders([tmp_path / "own_t" / "srv"])


def test_the_variable_and_a_ros_workspace_are_read(
    write: Write, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    write("env/own_h/msg/Num.msg", "int64 num\n")
    write("prefix/share/own_i/msg/Num.msg", "own_h/Num[] nums\n")
    write("prefix/share/std_msgs/msg/String.msg", "string another\n")
    monkeypatch.setenv("SIMKIT_INTERFACES", str(tmp_path / "env"))
    monkeypatch.setenv("AMENT_PREFIX_PATH", str(tmp_path / "prefix"))
    assert "own_h/msg/Num" in own_interfaces.names()
    own_interfaces.set_finder(lambda package, file: None)
    assert msgs.make("own_i/Num", nums=[{"num": 2}]).nums[0].num == 2
    assert msgs.make("std_msgs/String", data="simkit's own").data == "simkit's own"


class Speaker(simkit.WorldPlugin):
    """Publishes one message of a type of the user."""

    def load(self, parent: object, params: object) -> None:
        self.advertise("/num", "own_j/msg/Num", latched=True).publish(msgs.make("own_j/msg/Num"))


def test_packages_near_the_world_are_found_when_a_type_is_used(write: Write) -> None:
    world = write("ws/src/robots/worlds/room.sdf", WORLD)
    write("ws/src/robots/package.xml", "<package><name>robots</name></package>")
    write("ws/src/own_messages/package.xml", "<package><name>own_j</name></package>")
    write("ws/src/own_messages/msg/Num.msg", "int64 num 5\n")
    broken = write("ws/src/robots/worlds/own_k/msg/Num.msg", "int64\n")
    with simkit.load(world, plugins=[Speaker()]) as sim:
        heard = sim.subscribe("/num")
        sim.step()
        assert sim.topics()["/num"] == "own_j/msg/Num"
        assert heard.latest.num == 5
    with pytest.raises(InterfaceError, match="expected TYPE NAME") as caught:
        msgs.full_name("own_k/msg/Num")
    assert [(d.file, d.line) for d in caught.value.diagnostics] == [(str(broken), 1)]


def test_problems_of_interfaces_are_reported_with_those_of_the_world(write: Write, tmp_path: Path) -> None:
    write("own_l/msg/Num.msg", "int64\n")
    with pytest.raises(simkit.LoadError) as caught:
        simkit.load(WORLD.replace("<world", "<wrold"), interfaces=[tmp_path / "own_l"])
    codes = {d.code for d in caught.value.diagnostics}
    assert "SK-INTERFACE-001" in codes
    assert len(codes) > 1


def test_a_received_definition_is_read_at_its_first_use_and_must_equal_a_known_one() -> None:
    own_interfaces.remember_received(
        {"own_m/msg/Num": "Part part\n", "own_m/msg/Part": "float32[2] xs\n"}, "simulation 'a'"
    )
    made = msgs.make("own_m/msg/Num", part={"xs": np.array([1, 2])})
    assert made.part.xs.tolist() == [1.0, 2.0]
    with pytest.raises(InterfaceError, match="defined differently already"):
        own_interfaces.remember_received({"own_m/msg/Part": "float64[2] xs\n"}, "simulation 'b'")
    own_interfaces.remember_received({"own_n/msg/Num": "int8 a\n"}, "simulation 'a'")
    with pytest.raises(InterfaceError, match="compare with own_n/msg/Num of simulation 'a'"):
        msgs.add("own_n/msg/Num", "int16 a\n")
