"""Launch files of ROS 2 in XML and YAML make the same plan as those in Python."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path

import pytest

from simkit.errors import LoadError
from simkit_launch.launch_file import declared_arguments, read_launch_file
from simkit_launch.launch_plan import LaunchedProcess, LaunchPlan, StartCondition

Read = Callable[..., LaunchPlan]


@pytest.fixture
def read(tmp_path: Path) -> Read:
    """Function that reads the elements of a launch file in XML; other files are beside it."""

    def read_elements(elements: str, files: Mapping[str, str] | None = None, **arguments: str) -> LaunchPlan:
        _write(tmp_path, files or {})
        file = tmp_path / "robot.launch.xml"
        file.write_text(f"<launch>\n{elements}\n</launch>\n")
        return read_launch_file(file, arguments)

    return read_elements


@pytest.fixture
def read_yaml(tmp_path: Path) -> Read:
    """Function that reads a launch file in YAML; other files are beside it."""

    def read_text(text: str, files: Mapping[str, str] | None = None, **arguments: str) -> LaunchPlan:
        _write(tmp_path, files or {})
        file = tmp_path / "robot.launch.yaml"
        file.write_text(text)
        return read_launch_file(file, arguments)

    return read_text


def _write(folder: Path, files: Mapping[str, str]) -> None:
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)


def package(name: str) -> str:
    return f"<package><name>{name}</name></package>"


def node(attributes: str = "", elements: str = "") -> str:
    return f'<node pkg="p" exec="e" {attributes}>{elements}</node>'


def only_process(plan: LaunchPlan) -> LaunchedProcess:
    assert len(plan.processes) == 1
    return plan.processes[0]


def parameters(plan: LaunchPlan) -> dict[str, object]:
    """Values of the parameters of the only process."""
    values: dict[str, object] = {}
    for each in only_process(plan).parameters:
        assert isinstance(each, Mapping)
        values |= each
    return values


def errors(read: Read, text: str, files: Mapping[str, str] | None = None, **arguments: str) -> list[str]:
    """Messages of the errors of a file, each with its line."""
    with pytest.raises(LoadError) as caught:
        read(text, files, **arguments)
    return [f"{d.line}: {d.message}" for d in caught.value.diagnostics if d.severity == "error"]


# ---------------------------------------------------------------------- nodes and processes


def test_a_node_has_its_program_names_words_and_place(read: Read, tmp_path: Path) -> None:
    plan = read(
        '<node pkg="ros_gz_sim" exec="create" name="spawn" namespace="robot" output="screen" '
        "args=\"-name waffle -string '&lt;a b/&gt;'\"/>"
    )
    process = only_process(plan)
    assert (process.package, process.executable) == ("ros_gz_sim", "create")
    assert (process.name, process.namespace) == ("spawn", "/robot")
    assert process.arguments == ("-name", "waffle", "-string", "<a b/>")
    assert str(process.where) == f"{tmp_path / 'robot.launch.xml'}:2"


def test_remappings_variables_and_endings_of_a_node(read: Read) -> None:
    plan = read(
        node(
            'respawn="true" respawn_delay="2.5"',
            '<remap from="scan" to="/front"/><remap from="a" to="b"/><env name="MODE" value="fast"/>',
        )
        + node('on_exit="shutdown" cwd="/tmp"')
    )
    first, second = plan.processes
    assert first.remappings == (("scan", "/front"), ("a", "b"))
    assert first.environment == {"MODE": "fast"}
    assert first.respawn_delay == 2.5
    assert second.ends_run
    assert second.folder == Path("/tmp")


def test_parameters_have_the_types_of_yaml(read: Read) -> None:
    values = {"a": "1", "b": "1.5", "c": "true", "d": "text", "e": "[1, 2]", "f": "'7'"}
    plan = read(node("", "".join(f'<param name="{name}" value="{value}"/>' for name, value in values.items())))
    assert parameters(plan) == {"a": 1, "b": 1.5, "c": True, "d": "text", "e": [1, 2], "f": "7"}


def test_a_type_decides_about_a_parameter(read: Read) -> None:
    plan = read(
        '<arg name="n" default="3"/>'
        + node(
            "",
            '<param name="a" value="1" type="str"/><param name="b" value="1" type="float"/>'
            '<param name="c" value="$(var n)"/><param name="d" value="$(var n)" type="str"/>'
            '<param name="e" value="x,y" value-sep=","/><param name="f" value="$(var n);4" value-sep=";"/>',
        )
    )
    found = parameters(plan)
    assert found == {"a": "1", "b": 1.0, "c": 3, "d": "3", "e": ["x", "y"], "f": [3, 4]}
    assert type(found["b"]) is float


def test_parameters_are_nested_and_come_from_files(read: Read, tmp_path: Path) -> None:
    plan = read(
        node(
            "",
            '<param name="limits"><param name="v"><param name="x" value="1.0"/></param>'
            '<param name="w" value="2"/></param>'
            '<param from="$(dirname)/p.yaml"/>',
        ),
        {"p.yaml": "/**: {ros__parameters: {a: 1}}\n"},
    )
    values, file = only_process(plan).parameters
    assert values == {"limits.v.x": 1.0, "limits.w": 2}
    assert file == tmp_path / "p.yaml"


def test_a_command_has_words_a_folder_and_variables(read: Read) -> None:
    plan = read(
        '<arg name="world" default="my world.sdf"/>'
        '<executable cmd="gz sim -r $(var world) --name=\'a b\'" cwd="/tmp"><env name="A" value="1"/></executable>'
    )
    process = only_process(plan)
    assert process.kind == "command"
    assert process.arguments == ("gz", "sim", "-r", "my world.sdf", "--name=a b")
    assert (process.folder, process.environment) == (Path("/tmp"), {"A": "1"})


def test_components_are_loaded_into_their_container(read: Read) -> None:
    component = '<composable_node pkg="q" plugin="q::Talker" name="{}"><param name="a" value="1"/></composable_node>'
    plan = read(
        f'<node_container pkg="rclcpp_components" exec="component_container" name="c" namespace="/n">'
        f"{component.format('one')}</node_container>"
        f'<load_composable_node target="/n/c">{component.format("two")}</load_composable_node>'
    )
    container, *components = plan.processes
    assert (container.executable, container.name, container.namespace) == ("component_container", "c", "/n")
    assert [(each.kind, each.package, each.executable, each.name) for each in components] == [
        ("component", "q", "q::Talker", "one"),
        ("component", "q", "q::Talker", "two"),
    ]
    assert [dict(each.parameters[0]) for each in components if isinstance(each.parameters[0], Mapping)] == [
        {"a": 1},
        {"a": 1},
    ]


# ---------------------------------------------------------------------- arguments, groups, includes


def test_arguments_conditions_and_values(read: Read) -> None:
    elements = (
        '<arg name="gui" default="true"/><let name="name" value="r_$(var gui)"/>'
        + node('name="$(var name)" if="$(var gui)"')
        + node('name="b" unless="$(var gui)"')
        + node('name="c" if="$(eval \'&quot;$(var gui)&quot; == &quot;true&quot;\')"')
    )
    assert [process.name for process in read(elements).processes] == ["r_true", "c"]
    assert [process.name for process in read(elements, gui="false").processes] == ["b"]


def test_the_declared_arguments_have_choices_and_descriptions(tmp_path: Path) -> None:
    file = tmp_path / "robot.launch.xml"
    file.write_text(
        '<launch><arg name="model" default="waffle" description="Robot"><choice value="waffle"/>'
        '<choice value="burger"/></arg><arg name="x"/></launch>'
    )
    first, second = declared_arguments(file)
    assert (first.name, first.default, first.description, first.choices) == (
        *("model", "waffle", "Robot"),
        ("waffle", "burger"),
    )
    assert (second.name, second.default) == ("x", None)


def test_what_a_scoped_group_sets_ends_with_it(read: Read) -> None:
    plan = read(
        '<group><push_ros_namespace namespace="a"/><group><push-ros-namespace namespace="b"/>'
        f'<set_remap from="x" to="y"/><set_parameter name="use_sim_time" value="true"/>{node()}</group>{node()}</group>'
        '<group scoped="false"><let name="v" value="1"/></group>' + node('name="n_$(var v)"')
    )
    assert [process.namespace for process in plan.processes] == ["/a/b", "/a", ""]
    assert plan.processes[0].remappings == (("x", "y"),)
    assert plan.processes[0].parameters == ({"use_sim_time": True},)
    assert plan.processes[1].parameters == ()
    assert plan.processes[2].name == "n_1"


def test_variables_of_the_environment_are_set_appended_and_unset(read: Read, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("GONE", "1")
    plan = read(
        '<set_env name="PATHS" value="/a"/><append_env name="PATHS" value="/b"/>'
        '<append_env name="PATHS" value="/c" prepend="true" separator=","/><unset_env name="GONE"/>'
        + node("", '<param name="p" value="$(env PATHS) $(env GONE none)"/>')
    )
    assert parameters(plan) == {"p": "/c,/a:/b none"}


def test_the_variables_of_packages_hold_as_after_sourcing_the_workspace(
    read: Read, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for name in ("GZ_SIM_RESOURCE_PATH", "GAZEBO_MODEL_PATH", "BOT_MODE"):
        monkeypatch.delenv(name, raising=False)
    files = {
        "bot/package.xml": package("bot"),
        "bot/models/a/model.txt": "",
        "bot/worlds/a.txt": "",
        "bot/hooks/paths.dsv.in": (
            "prepend-non-duplicate;GZ_SIM_RESOURCE_PATH;@CMAKE_INSTALL_PREFIX@/share/@PROJECT_NAME@/models\n"
            "set;BOT_MODE;fast\nprepend-non-duplicate;PATH;bin\n"
        ),
        "bot/hooks/paths.sh": (
            'ament_append_unique_value GZ_SIM_RESOURCE_PATH "$AMENT_CURRENT_PREFIX/share/bot/worlds"\n'
        ),
    }
    plan = read(node("", '<param name="p" value="$(env BOT_MODE)"/>'), files)
    assert parameters(plan) == {"p": "fast"}
    assert plan.resource_paths == [str(tmp_path / "bot/models"), str(tmp_path / "bot/worlds")]


def test_files_of_any_kind_are_included_with_arguments(read: Read, tmp_path: Path) -> None:
    files = {
        "bot/package.xml": package("bot"),
        "bot/launch/a.launch.xml": '<launch><arg name="x"/><node pkg="p" exec="xml" name="$(var x)"/></launch>',
        "bot/launch/b.launch.yaml": "launch: [{node: {pkg: p, exec: yaml, name: $(var x)}}]\n",
        "bot/launch/c.launch.py": (
            "from launch import LaunchDescription\nfrom launch_ros.actions import Node\n"
            "def generate_launch_description():\n"
            "    return LaunchDescription([Node(package='p', executable='python')])\n"
        ),
    }
    arg = '<arg name="x" value="1"/>'
    plan = read(
        "".join(
            f'<include file="$(find-pkg-share bot)/launch/{name}">{arg}</include>'
            for name in ("a.launch.xml", "b.launch.yaml", "c.launch.py")
        ),
        files,
    )
    assert [process.executable for process in plan.processes] == ["xml", "yaml", "python"]
    assert plan.processes[0].where.file == str(tmp_path / "bot/launch/a.launch.xml")


def test_a_file_that_a_build_installs_elsewhere_is_found_in_the_package(read: Read) -> None:
    files = {"bot/package.xml": package("bot"), "bot/launch/a.launch.xml": f"<launch>{node()}</launch>"}
    assert only_process(read('<include file="$(find-pkg-share bot)/a.launch.xml"/>', files)).executable == "e"


def test_missing_includes_are_warnings(read: Read) -> None:
    plan = read('<include file="$(find-pkg-share nobody)/a.launch.xml"/>\n<include file="none.launch.xml"/>' + node())
    assert len(plan.processes) == 1
    assert [d.line for d in plan.diagnostics if d.severity == "warning"] == [2, 2, 3]


def test_timers_logs_and_the_end_of_the_launch(read: Read) -> None:
    plan = read(
        f'<log message="begin $(var x 1)"/><log_warning message="careful"/><timer period="3.0">{node()}</timer>'
        '<timer period="$(eval \'2 + 3\')"><shutdown reason="enough"/></timer>'
    )
    first, second = plan.processes
    assert first.condition == StartCondition(delay=3.0)
    assert (second.kind, second.condition.delay) == ("shutdown", 5.0)
    assert "begin 1" in "\n".join(plan.log)


def test_a_prefix_with_sleep_delays_the_start_and_another_one_is_noted(read: Read) -> None:
    plan = read(node("""launch-prefix="bash -c 'sleep 5; $0 $@'" """) + node('launch-prefix="xterm -e"'))
    assert [process.condition.delay for process in plan.processes] == [5.0, 0.0]
    assert [d.code for d in plan.diagnostics] == ["SK-LAUNCH-029"]


def test_loops_repeat_their_actions_with_values(read: Read) -> None:
    plan = read(
        '<arg name="robots" default="{name: a, id: 1};{name: b}"/>'
        f'<for len="2" name="i"><group><push_ros_namespace namespace="r$(index i)"/>{node()}</group></for>'
        '<for_each values="$(var robots)">' + node('name="$(for-var name)_$(for-var id 7)"') + "</for_each>"
    )
    assert [process.namespace for process in plan.processes[:2]] == ["/r0", "/r1"]
    assert [process.name for process in plan.processes[2:]] == ["a_1", "b_7"]


# ---------------------------------------------------------------------- substitutions


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("$(var x)", "1"),
        ("$(var missing 'a b')", "a b"),
        ("$(var missing $(var x))", "1"),
        ("$(env NOT_SET_ANYWHERE none)", "none"),
        ("$(eval '$(var x) + 2 * (3 + 4)')", "15"),
        ("$(eval &quot;'a' + 'b'&quot;)", "ab"),
        (
            "$(not true)_$(and true false)_$(or true false)_$(any false true)_$(all true false)",
            "false_false_true_true_false",
        ),
        ("$(equals $(var x) 1)_$(not-equals a b)", "true_true"),
        ("$(if true yes no)_$(if false yes)_", "yes__"),
        ("$(path-join /a b c.yaml)", "/a/b/c.yaml"),
        ("$(string-join . a b c)", "a.b.c"),
        ("$(dirname)/$(file-content $(dirname)/t.txt)", "{folder}/hello"),
        ("$(find-pkg-share bot)/urdf", "{folder}/bot/urdf"),
        ("$(command 'cat $(dirname)/t.txt')", "hello"),
        (r"\$(var x) a\\b", r"$(var x) a\b"),
        ("a $ b", "a $ b"),
        ("$(var x)$(var x)-$(var x)", "11-1"),
    ],
)
def test_substitutions_are_replaced(read: Read, tmp_path: Path, text: str, expected: str) -> None:
    files = {"t.txt": "hello", "bot/package.xml": package("bot")}
    elements = '<let name="x" value="1"/>' + node("", f'<param name="p" type="str" value="{text}"/>')
    assert parameters(read(elements, files)) == {"p": expected.replace("{folder}", str(tmp_path))}


def test_anonymous_names_are_the_same_for_an_id(read: Read) -> None:
    plan = read(node('name="$(anon viewer)" args="$(anon viewer)"'))
    process = only_process(plan)
    assert process.name.startswith("viewer_")
    assert process.arguments == (process.name,)


def test_the_output_of_xacro_is_a_parameter(read: Read) -> None:
    files = {"r.xacro": '<robot name="r" xmlns:xacro="http://ros.org/wiki/xacro"/>'}
    elements = node("", """<param name="robot_description" value="$(command 'xacro $(dirname)/r.xacro')"/>""")
    assert '<robot name="r"/>' in str(parameters(read(elements, files))["robot_description"])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("$(vra x)", "there is no substitution $(vra x)"),
        ("$(find bot)/a", "there is no substitution $(find bot)"),
        ("$(var)", "found $(var); expected $(var NAME [DEFAULT])"),
        ("$(eval 1 + 2)", "found $(eval 1 + 2); expected $(eval 'EXPRESSION')"),
        ("$(eval int(2))", "a word without quotes has no parenthesis"),
        ("$(var x", "the substitution has no closing parenthesis"),
        ("$(var 'x)", "the quote is not closed"),
        ("$(for-var x)", "no loop around the text has this value"),
    ],
)
def test_an_invalid_substitution_is_an_error_in_its_line(read: Read, text: str, message: str) -> None:
    (found,) = errors(read, f'\n<let name="a" value="{text}"/>')
    assert found.startswith("3: <let>: ")
    assert message in found


# ---------------------------------------------------------------------- problems


def test_all_errors_of_a_file_are_found_in_one_pass(read: Read) -> None:
    found = errors(
        read,
        '<nod pkg="p"/>\n<node pkg="p"/>\n<node pkg="p" exec="e" namex="n"/>\n<arg default="1"/>\n'
        '<node pkg="p" exec="e"><paramx name="a"/></node>\n<node pkg="p" exec="e"><param name="a"/></node>\n'
        '<timer period="long" if="1" unless="1"/>\n<group scoped="maybe"/>\n<node pkg="p" exec="e" on_exit="stop"/>\n'
        '<node pkg="p" exec="e"><param name="a" type="floatx" value="1"/></node>',
    )
    assert [line.partition(":")[0] for line in found] == ["2", "3", "4", "5", "6", "7", "8", "9", "10", "11"]
    assert found[0] == "2: there is no action <nod>"
    assert found[1] == "3: <node>: the attribute 'exec' is missing"
    assert found[2] == "4: <node> has no attribute 'namex'"


def test_a_misspelt_name_has_a_suggestion_and_one_of_ros_1_that_of_ros_2(read: Read) -> None:
    with pytest.raises(LoadError) as caught:
        read(
            '<nod pkg="p"/>\n<node pkg="p" exec="e" namex="n"/>\n'
            '<node pkg="p" type="e"/>\n<node pkg="p" exec="e" ns="a"/>'
        )
    assert [d.hint for d in caught.value.diagnostics] == [
        "did you mean 'node'?",
        "did you mean 'name'?",
        "'type' is its name in ROS 1",
        "in ROS 2 its name is 'namespace'",
    ]


def test_a_missing_argument_is_an_error(read: Read) -> None:
    (found,) = errors(read, '<arg name="x"/><arg name="y"/>' + node())
    assert "x" in found
    assert "y" in found


# ---------------------------------------------------------------------- YAML


def test_a_file_in_yaml_makes_the_same_plan_as_one_in_xml(read: Read, read_yaml: Read) -> None:
    xml = read(
        '<arg name="rate" default="10"/><group><push_ros_namespace namespace="robot"/>'
        '<node pkg="p" exec="e" name="n" args="-v $(var rate)"><param name="rate" value="$(var rate)"/>'
        '<param name="names" value="[a, b]"/><param name="pid"><param name="p" value="1.0"/></param>'
        '<remap from="a" to="b"/></node></group>'
        '<executable cmd="gz sim" if="true"/>'
    )
    yaml = read_yaml(
        """\
launch:
- arg: {name: rate, default: '10'}
- group:
  - push_ros_namespace: {namespace: robot}
  - node:
      pkg: p
      exec: e
      name: n
      args: -v $(var rate)
      param:
      - {name: rate, value: $(var rate)}
      - {name: names, value: [a, b]}
      - name: pid
        param:
        - {name: p, value: 1.0}
      remap:
      - {from: a, to: b}
- executable: {cmd: gz sim, if: 'true'}
"""
    )

    def described(plan: LaunchPlan) -> list[object]:
        return [(p.source, p.name, p.namespace, p.arguments, p.parameters, p.remappings) for p in plan.processes]

    assert described(yaml) == described(xml)
    assert [process.where.line for process in yaml.processes] == [6, 18]


def test_a_group_in_yaml_can_have_values_and_children(read_yaml: Read) -> None:
    plan = read_yaml(
        "launch:\n- group:\n    if: 'true'\n    scoped: false\n    children:\n    - let: {name: a, value: '1'}\n"
        "- node: {pkg: p, exec: e, name: n_$(var a)}\n"
    )
    assert only_process(plan).name == "n_1"


def test_all_errors_of_a_yaml_file_are_found_in_one_pass(read_yaml: Read) -> None:
    found = errors(
        read_yaml,
        "launch:\n- nod: {pkg: p}\n- node: {pkg: p, exec: 5}\n- arg:\n  name: x\n"
        "- let: {name: a, value: '1', valuex: 2}\n",
    )
    assert found == [
        "4: found arg, name; each item of the list has one key, such as 'node', with its values below it",
        "2: there is no action 'nod'",
        "3: 'node': attribute 'exec': found 5; expected a text",
        "6: 'let' has no attribute 'valuex'",
    ]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("launch: [", "the launch file is not YAML"),
        ("lanch: []", "found the outermost element 'lanch'"),
        ("a: 1\nb: 2", "found the outermost keys 'a', 'b'"),
        ("", "found the outermost keys none"),
    ],
)
def test_a_file_that_is_no_launch_file_is_an_error(read_yaml: Read, text: str, message: str) -> None:
    (found,) = errors(read_yaml, text)
    assert message in found


def test_the_launch_file_of_twist_mux_passes_its_files_and_its_output(read: Read, tmp_path: Path) -> None:
    arguments = f'<arg name="config_topics" value="{tmp_path}/t.yaml"/><arg name="cmd_vel_out" value="base/cmd_vel"/>'
    file = "$(find-pkg-share twist_mux)/launch/twist_mux_launch.py"
    sources = {"t.yaml": "twist_mux: {ros__parameters: {topics: {keys: {topic: key_vel}}}}"}
    process = only_process(read(f'<include file="{file}">{arguments}</include>', files=sources))
    assert (process.package, process.executable) == ("twist_mux", "twist_mux")
    assert ("cmd_vel_out", "base/cmd_vel") in process.remappings
    assert any(str(each).endswith("t.yaml") for each in process.parameters)


def test_a_load_controller_description_of_humble_names_the_type(tmp_path: Path) -> None:
    """Humble's function has the argument `controller_type`, which later versions do not have."""
    file = tmp_path / "arm.launch.py"
    file.write_text(
        "from controller_manager.launch_utils import generate_load_controller_launch_description as load\n"
        "def generate_launch_description():\n    return load(controller_name='arm', controller_type='a/B')\n"
    )
    arguments = only_process(read_launch_file(file, {})).arguments
    assert "--controller-type a/B" in " ".join(arguments)
