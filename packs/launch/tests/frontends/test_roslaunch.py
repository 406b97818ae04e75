"""Launch files of ROS 1 become a plan of processes and parameters."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from pathlib import Path

import pytest

from simkit.diagnostics import Diagnostics
from simkit.errors import LoadError
from simkit.loaders.resources.xml_reader import parse_text
from simkit_launch.frontends.roslaunch import read_roslaunch, roslaunch_arguments
from simkit_launch.frontends.roslaunch_elements import is_roslaunch
from simkit_launch.launch_plan import LaunchedProcess, LaunchPlan

Read = Callable[..., LaunchPlan]


@pytest.fixture
def read(tmp_path: Path) -> Read:
    """Function that reads the elements of a launch file; other files are beside it."""

    def read_elements(elements: str, files: Mapping[str, str] | None = None, **arguments: str) -> LaunchPlan:
        for name, text in (files or {}).items():
            path = tmp_path / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        file = tmp_path / "robot.launch"
        file.write_text(f"<launch>\n{elements}\n</launch>\n")
        return read_roslaunch(file, arguments)

    return read_elements


def package(name: str) -> str:
    return f"<package><name>{name}</name></package>"


def node(attributes: str = "", elements: str = "") -> str:
    return f'<node pkg="p" type="t" name="n" {attributes}>{elements}</node>'


def only_process(plan: LaunchPlan) -> LaunchedProcess:
    assert len(plan.processes) == 1
    return plan.processes[0]


def errors(read: Read, elements: str, files: Mapping[str, str] | None = None, **arguments: str) -> list[str]:
    """Messages of the errors of a file, each with its line."""
    with pytest.raises(LoadError) as caught:
        read(elements, files, **arguments)
    return [f"{d.line}: {d.message}" for d in caught.value.diagnostics if d.severity == "error"]


def warnings(plan: LaunchPlan) -> list[str]:
    return [f"{d.line}: {d.message}" for d in plan.diagnostics if d.severity == "warning"]


# ---------------------------------------------------------------------- nodes


def test_a_node_has_its_package_program_name_words_and_place(read: Read, tmp_path: Path) -> None:
    plan = read('<node pkg="gazebo_ros" type="spawn_model" name="spawn" args="-x 1 -model \'my robot\'"/>')
    process = only_process(plan)
    assert (process.package, process.executable, process.name) == ("gazebo_ros", "spawn_model", "spawn")
    assert process.arguments == ("-x", "1", "-model", "my robot")
    assert process.is_ros1
    assert str(process.where) == f"{tmp_path / 'robot.launch'}:2"


def test_namespaces_of_groups_and_nodes_are_joined(read: Read) -> None:
    absolute = node('ns="/c"')
    plan = read(f'<group ns="a"><group ns="b">{node()}</group>{absolute}</group>')
    assert [process.namespace for process in plan.processes] == ["/a/b", "/c"]


def test_remappings_hold_for_later_nodes_of_the_scope_only(read: Read) -> None:
    plan = read(
        '<node pkg="p" type="t" name="before"/>'
        '<remap from="scan" to="front"/>'
        '<group><remap from="scan" to="rear"/><remap from="a" to="b"/><node pkg="p" type="t" name="inside"/></group>'
        '<node pkg="p" type="t" name="after"><remap from="odom" to="/odom"/></node>'
    )
    assert [process.remappings for process in plan.processes] == [
        (),
        (("scan", "rear"), ("a", "b")),
        (("scan", "front"), ("odom", "/odom")),
    ]


def test_words_for_ros_are_no_words_of_the_program(read: Read) -> None:
    plan = read(node('args="-v scan:=front _rate:=10 __name:=other __ns:=robot file.yaml"'))
    process = only_process(plan)
    assert process.arguments == ("-v", "file.yaml")
    assert process.remappings == (("scan", "front"),)
    assert (process.name, process.namespace) == ("other", "/robot")
    assert plan.parameters == {"/n/rate": 10}


def test_required_ends_the_run_and_respawn_starts_again(read: Read) -> None:
    plan = read(
        '<node pkg="p" type="t" name="a" required="true"/>'
        '<node pkg="p" type="t" name="b" respawn="true" respawn_delay="3"/>'
        '<node pkg="p" type="t" name="c"/>'
    )
    assert [process.ends_run for process in plan.processes] == [True, False, False]
    assert [process.respawn_delay for process in plan.processes] == [None, 3.0, None]


def test_a_prefix_with_sleep_delays_the_start(read: Read) -> None:
    plan = read(node("""launch-prefix="bash -c 'sleep 5.5; $0 $@'" """))
    assert only_process(plan).condition.delay == 5.5


def test_another_prefix_is_noted(read: Read) -> None:
    plan = read(node('launch-prefix="gdb -ex run --args"'))
    assert any("has no effect" in d.message for d in plan.diagnostics)


def test_variables_reach_the_nodes_of_their_scope(read: Read) -> None:
    plan = read(
        '<group><env name="A" value="1"/><node pkg="p" type="t" name="a"><env name="B" value="2"/></node></group>'
        '<node pkg="p" type="t" name="b"/>'
    )
    assert [dict(process.environment) for process in plan.processes] == [{"A": "1", "B": "2"}, {}]


def test_folders_of_models_are_resource_paths(read: Read) -> None:
    plan = read('<env name="GAZEBO_MODEL_PATH" value="/m/a:/m/b"/>')
    assert plan.resource_paths == ["/m/a", "/m/b"]


def test_a_test_is_not_started(read: Read) -> None:
    plan = read('<test pkg="p" type="t" test-name="check"/>')
    assert not plan.processes


# ---------------------------------------------------------------------- arguments and conditions


def test_given_arguments_replace_defaults(read: Read) -> None:
    elements = '<arg name="x" default="1"/><arg name="y" value="2"/><param name="x" value="$(arg x)"/>'
    assert read(elements).arguments == {"x": "1"}
    assert read(elements, x="5").parameters == {"/x": 5}


def test_arguments_of_a_group_do_not_leave_it(read: Read) -> None:
    found = errors(read, '<group>\n<arg name="x" default="1"/>\n</group>\n<param name="p" value="$(arg x)"/>')
    assert found == ["""5: <param name="p">: the argument 'x' has no value"""]


def test_an_included_file_has_only_the_passed_arguments(read: Read) -> None:
    files = {"inner.launch": '<launch><arg name="x" default="1"/><param name="x" value="$(arg x)"/></launch>'}
    outer = '<arg name="x" default="2"/>'
    assert read(f'{outer}<include file="$(dirname)/inner.launch"/>', files).parameters == {"/x": 1}
    passed = f'{outer}<include file="$(dirname)/inner.launch"><arg name="x" value="$(arg x)0"/></include>'
    assert read(passed, files).parameters == {"/x": 20}
    everything = f'{outer}<include file="$(dirname)/inner.launch" pass_all_args="true"/>'
    assert read(everything, files).parameters == {"/x": 2}


def test_an_included_file_is_in_the_namespace_and_has_the_remappings_of_the_include(read: Read) -> None:
    files = {"inner.launch": f"<launch>{node()}</launch>"}
    plan = read('<remap from="a" to="b"/><include ns="r1" file="$(dirname)/inner.launch"/>', files)
    process = only_process(plan)
    assert (process.namespace, process.remappings) == ("/r1", (("a", "b"),))


def test_if_and_unless_choose_elements(read: Read) -> None:
    plan = read(
        '<arg name="gui" default="true"/>'
        '<node if="$(arg gui)" pkg="p" type="t" name="a"/><node unless="$(arg gui)" pkg="p" type="t" name="b"/>'
        '<node if="0" pkg="p" type="t" name="c"/><node if="$(eval arg(\'gui\') and 1 == 1)" pkg="p" type="t" name="d"/>'
    )
    assert [process.name for process in plan.processes] == ["a", "d"]


def test_all_arguments_without_a_value_are_named_at_once(read: Read) -> None:
    found = errors(
        read,
        '<arg name="x"/>\n<arg name="y"/>\n<arg name="unused"/>\n'
        '<arg name="z" default="$(arg x)"/>\n'
        '<param name="p" value="$(arg z) $(arg y)"/>\n<param name="q" value="$(arg y)"/>',
    )
    assert found == ["2: the arguments x, y need a value"]


def test_all_arguments_without_a_value_in_one_text_are_named(read: Read) -> None:
    found = errors(read, '<arg name="x"/>\n<arg name="y"/>\n<param name="p" value="$(arg x) $(arg z) $(arg y)"/>')
    assert found == [
        """4: <param name="p">: the argument 'z' has no value""",
        "2: the arguments x, y need a value",
    ]


def test_an_include_names_the_arguments_that_it_lacks(read: Read, tmp_path: Path) -> None:
    files = {"inner.launch": '<launch><arg name="x"/><param name="p" value="$(arg x)"/></launch>'}
    found = errors(read, '<include file="$(dirname)/inner.launch"/>', files)
    assert found == [f"2: <include>: the file {tmp_path / 'inner.launch'} needs the argument 'x'"]


def test_an_include_that_passes_an_argument_that_is_not_declared_is_a_warning(read: Read, tmp_path: Path) -> None:
    files = {"inner.launch": '<launch><arg name="world_name" default="a"/></launch>'}
    plan = read('<include file="$(dirname)/inner.launch">\n<arg name="world" value="b"/></include>', files)
    message = "has no argument 'world', which roslaunch refuses; did you mean 'world_name'?"
    assert warnings(plan) == [f"3: the file {tmp_path / 'inner.launch'} {message}"]


def test_a_given_argument_that_is_not_declared_is_a_warning(read: Read) -> None:
    plan = read('<arg name="world_name" default="a"/>', world="b")
    assert warnings(plan) == ["1: the launch file has no argument 'world'; did you mean 'world_name'?"]


def test_a_fixed_argument_cannot_be_given(read: Read) -> None:
    found = errors(read, '<arg name="x" value="1"/>', x="2")
    assert found == ["""2: <arg name="x">: argument 'x' has a fixed value, so that it cannot be given"""]


def test_the_declared_arguments_have_defaults_and_descriptions(tmp_path: Path) -> None:
    file = tmp_path / "robot.launch"
    file.write_text('<launch><arg name="x" default="$(eval 1 + 1)" doc="Number"/><arg name="y"/></launch>')
    found = roslaunch_arguments(file, {})
    assert [(each.name, each.default, each.description) for each in found] == [("x", "2", "Number"), ("y", None, "")]


def test_files_that_include_each_other_are_an_error(read: Read) -> None:
    found = errors(read, '<include file="$(dirname)/robot.launch"/>')
    assert any("include one another" in message for message in found)


# ---------------------------------------------------------------------- substitutions


def test_substitutions_are_replaced(read: Read, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ROBOT", "husky")
    monkeypatch.delenv("OTHER", raising=False)
    plan = read(
        '<arg name="n" default="3"/>'
        '<param name="a" value="$(env ROBOT)_$(optenv OTHER none at all)"/>'
        '<param name="b" value="$(find bot)/urdf"/>'
        '<param name="c" value="$(dirname)"/>'
        "<param name=\"d\" value=\"$(eval 'r' + str(n * 2) + optenv('OTHER', 'x') + env('ROBOT'))\"/>"
        '<param name="e" value="$(eval int(cos(pi)) if n > 2 else 7)"/>',
        {"bot/package.xml": package("bot")},
    )
    assert plan.parameters == {
        "/a": "husky_none at all",
        "/b": f"{tmp_path / 'bot'}/urdf",
        "/c": str(tmp_path),
        "/d": "r6xhusky",
        "/e": -1,
    }


def test_an_argument_can_name_a_package(read: Read, tmp_path: Path) -> None:
    files = {"bot/package.xml": package("bot")}
    plan = read('<arg name="x" default="1"/><param name="x" value="$(arg x)"/>', files, x="$(find bot)/a.world")
    assert plan.parameters == {"/x": f"{tmp_path / 'bot'}/a.world"}


def test_anonymous_names_are_the_same_for_an_id_and_differ_between_files(read: Read) -> None:
    files = {"inner.launch": '<launch><node pkg="p" type="t" name="$(anon viewer)" args="$(anon viewer)"/></launch>'}
    include = '<include file="$(dirname)/inner.launch"/>'
    plan = read(include + include, files)
    assert [(process.name, process.arguments) for process in plan.processes] == [
        ("viewer_1", ("viewer_1",)),
        ("viewer_2", ("viewer_2",)),
    ]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("$(argument x)", "there is no substitution $(argument x)"),
        ("$(fin x)", "there is no substitution $(fin x); did you mean 'find'?"),
        ("$(find)", "found $(find); expected one word after 'find'"),
        ("a $(eval 1)", "found 'a $(eval 1)'; $(eval …) has to be the whole text"),
        ("$(find $(arg x))", "a substitution of ROS 1 contains no other substitution and no parentheses"),
        ("$(find x", "a substitution has no closing parenthesis"),
        ("$(env NOT_SET_ANYWHERE)", "the environment variable NOT_SET_ANYWHERE is not set"),
        ("$(eval 1 +)", "$(eval 1 +): invalid expression"),
        ("$(eval __import__('os'))", "an expression has no double underscore"),
    ],
)
def test_an_invalid_substitution_is_an_error(read: Read, text: str, message: str) -> None:
    (found,) = errors(read, f'<param name="p" value="{text}"/>')
    assert message in found


def test_the_variables_of_packages_are_read_from_their_environment_hooks(
    read: Read, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("BOT_BASE", raising=False)
    monkeypatch.delenv("GAZEBO_MODEL_PATH", raising=False)
    files = {
        "bot/package.xml": package("bot"),
        "bot/models/model.txt": "",
        "bot/env-hooks/25.bot.sh.em": ": ${BOT_BASE:=kobuki}  # create\n: ${BOT_MAP:=`rospack find bot`/m}\n",
        "bot/bot.dsv.in": "prepend-non-duplicate;GAZEBO_MODEL_PATH;share/@PROJECT_NAME@/models\n",
    }
    elements = "".join(f'<param name="{n}" value="$(env {n})"/>' for n in ("BOT_BASE", "BOT_MAP", "GAZEBO_MODEL_PATH"))
    assert read(elements, files).parameters == {
        "/BOT_BASE": "kobuki",
        "/BOT_MAP": f"{tmp_path / 'bot'}/m",
        "/GAZEBO_MODEL_PATH": str(tmp_path / "bot/models"),
    }


def test_an_unset_model_of_turtlebot3_is_the_waffle(read: Read, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("TURTLEBOT3_MODEL", raising=False)
    plan = read('<param name="m" value="$(env TURTLEBOT3_MODEL)"/>')
    assert plan.parameters == {"/m": "waffle"}
    assert [d.code for d in plan.diagnostics] == ["SK-LAUNCH-021"]


# ---------------------------------------------------------------------- parameters


def test_texts_are_converted_as_roslaunch_does(read: Read) -> None:
    values = {"a": "1", "b": "1.5", "c": "true", "d": "1_000", "e": " text ", "f": "1e3"}
    plan = read("".join(f'<param name="{name}" value="{value}"/>' for name, value in values.items()))
    assert plan.parameters == {"/a": 1, "/b": 1.5, "/c": True, "/d": "1_000", "/e": "text", "/f": "1e3"}
    assert type(plan.parameters["/a"]) is int


def test_a_type_decides_the_conversion(read: Read) -> None:
    plan = read(
        '<param name="a" type="str" value="1"/><param name="b" type="double" value="1"/>'
        '<param name="c" type="bool" value="1"/><param name="d" type="yaml" value="[1, {x: 2}]"/>'
    )
    assert plan.parameters == {"/a": "1", "/b": 1.0, "/c": True, "/d": [1, {"x": 2}]}
    assert type(plan.parameters["/b"]) is float


def test_private_parameters_belong_to_the_later_nodes(read: Read) -> None:
    plan = read(
        '<param name="~a" value="1"/><group ns="g"><param name="b" value="2"/><node pkg="p" type="t" name="n">'
        '<param name="c" value="3"/><param name="~d" value="4"/><rosparam>{e: {f: 5}}</rosparam></node></group>'
    )
    assert plan.parameters == {"/g/b": 2, "/g/n/e/f": 5, "/g/n/a": 1, "/g/n/c": 3, "/g/n/d": 4}


def test_rosparam_reads_indented_text_files_and_angles(read: Read) -> None:
    text = "\n    wheels:\n      radius: 0.1\n      names: [a, b]\n    angle: deg(180)\n    turn: !degrees 90\n"
    files = {"p.yaml": "limits: {v: $(arg v)}\n"}
    plan = read(
        '<arg name="v" default="2"/>'
        f'<rosparam ns="base">{text}</rosparam>'
        '<rosparam command="load" file="$(dirname)/p.yaml" subst_value="true"/>'
        '<rosparam param="joints">[x, y]</rosparam><rosparam command="delete" param="joints"/>',
        files,
    )
    assert plan.parameters == {
        "/base/wheels/radius": 0.1,
        "/base/wheels/names": ["a", "b"],
        "/base/angle": math.pi,
        "/base/turn": math.pi / 2,
        "/limits/v": 2,
        "/joints": ["x", "y"],
    }


def test_a_parameter_without_a_value_is_an_error(read: Read) -> None:
    assert errors(read, "<rosparam>{a: {b: }}</rosparam>") == [
        "2: <rosparam>: the parameter /a/b has no value; write b: VALUE"
    ]


def test_a_parameter_is_the_content_of_a_file(read: Read, tmp_path: Path) -> None:
    files = {"a.urdf": "<robot/>"}
    plan = read('<param name="a" textfile="$(dirname)/a.urdf"/><param name="b" binfile="$(dirname)/a.urdf"/>', files)
    assert plan.parameters == {"/a": "<robot/>", "/b": b"<robot/>"}
    plan = read(f'<param name="c" command="cat {tmp_path / "a.urdf"}"/>')
    assert plan.parameters == {"/c": "<robot/>"}


@pytest.mark.parametrize("command", ["xacro --inorder", "$(find xacro)/xacro.py", "rosrun xacro xacro"])
def test_a_parameter_is_the_output_of_xacro(read: Read, command: str) -> None:
    files = {
        "r.xacro": '<robot name="$(arg n)" xmlns:xacro="http://ros.org/wiki/xacro">'
        '<xacro:arg name="n" default="a"/></robot>'
    }
    plan = read(f'<param name="robot_description" command="{command} \'$(dirname)/r.xacro\' n:=bob"/>', files)
    assert '<robot name="bob"/>' in plan.parameters["/robot_description"]
    assert not warnings(plan)


def test_a_command_that_cannot_run_is_left_out(read: Read) -> None:
    plan = read('<param name="a" command="python make.py"/>\n<param name="b" command="xacro nobody.xacro"/>')
    assert not plan.parameters
    assert (
        warnings(plan)[0] == "2: the output of `python make.py` is left out: only xacro, cat and echo run without ROS"
    )
    assert warnings(plan)[1].startswith("3: the model of xacro file nobody.xacro is left out: ")


# ---------------------------------------------------------------------- problems


def test_missing_packages_and_files_are_warnings(read: Read) -> None:
    plan = read(
        '<include file="$(find nobody)/launch/a.launch"/>\n<rosparam file="$(find nobody)/b.yaml"/>\n'
        '<include file="none.launch"/>\n' + node()
    )
    assert [process.name for process in plan.processes] == ["n"]
    assert warnings(plan) == [
        "2: there is no ROS package 'nobody'; what the launch file takes from it is left out",
        "3: the parameter file b.yaml is left out: its package 'nobody' is not there",
        "4: the included file none.launch is left out: there is no such file",
    ]


def test_strict_counts_warnings_as_errors(tmp_path: Path) -> None:
    file = tmp_path / "robot.launch"
    file.write_text('<launch><include file="none.launch"/></launch>')
    with pytest.raises(LoadError):
        read_roslaunch(file, {}, strict=True)


def test_all_errors_of_a_file_are_found_in_one_pass(read: Read) -> None:
    found = errors(
        read,
        '<node pkg="p" type="t"/>\n<param name="a"/>\n<param name="b" type="int" value="x"/>\n'
        '<node pkg="p" type="t" name="a/b"/>\n<group if="maybe"/>\n<rosparam>a: [</rosparam>\n'
        '<node pkg="p" type="t" name="n" respawn="yes"/>\n'
        '<remap from="a" to="b c"/>\n<arg name="x" value="1" default="2"/>',
    )
    assert [line.partition(":")[0] for line in found] == ["2", "3", "4", "5", "6", "7", "8", "9", "10"]
    assert found[0] == "2: <node>: the attribute 'name' is missing"
    assert found[2] == """4: <param name="b">: found 'x'; expected a value of type int"""
    assert found[4] == "6: <group>: found 'maybe'; expected true, false, 1 or 0"


def test_unknown_elements_and_attributes_are_warnings_with_a_suggestion(read: Read) -> None:
    plan = read('<nod pkg="p"/>\n<node pkg="p" type="t" name="n" respawnx="true"><paramx/></node>')
    hints = {f"{d.line}: {d.message}": d.hint for d in plan.diagnostics}
    assert hints == {
        "2: <launch> has no element <nod>; it has no effect": "did you mean 'node'?",
        "3: <node> has no attribute 'respawnx'; it has no effect": "did you mean 'respawn'?",
        "3: <node> has no element <paramx>; it has no effect": "did you mean 'param'?",
    }


def test_two_nodes_with_one_name_are_an_error_as_in_roslaunch(read: Read, tmp_path: Path) -> None:
    found = errors(read, node() + "\n" + node())
    first = f"{tmp_path / 'robot.launch'}:2"
    assert found == [f'3: <node name="n">: there are two nodes /n; the first one is in {first}']
    assert len(read(node('ns="a"') + node('ns="b"')).processes) == 2


def test_an_error_in_an_included_file_has_its_place(read: Read, tmp_path: Path) -> None:
    files = {"inner.launch": '<launch>\n\n<param name="a"/></launch>'}
    with pytest.raises(LoadError) as caught:
        read('<include file="$(dirname)/inner.launch"/>', files)
    assert [(d.file, d.line) for d in caught.value.diagnostics] == [(str(tmp_path / "inner.launch"), 3)]


def test_a_file_with_another_outermost_element_is_an_error(tmp_path: Path) -> None:
    file = tmp_path / "robot.launch"
    file.write_text("<lanch/>")
    with pytest.raises(LoadError, match="did you mean 'launch'"):
        read_roslaunch(file, {})


@pytest.mark.parametrize(
    ("elements", "expected"),
    [
        ('<node pkg="p" type="t" name="n"/>', True),
        ('<param name="a" command="x"/>', True),
        ('<param name="a" value="x"/>', True),
        ('<include file="$(find p)/a.launch"/>', True),
        ('<node pkg="p" exec="t"/>', False),
        ('<include file="$(find-pkg-share p)/a.launch"/>', False),
        ('<let name="a" value="b"/>', False),
    ],
)
def test_the_elements_tell_ros_1_from_ros_2(elements: str, expected: bool) -> None:
    root = parse_text(f"<launch>{elements}</launch>", Diagnostics())
    assert root is not None
    assert is_roslaunch(root) is expected
