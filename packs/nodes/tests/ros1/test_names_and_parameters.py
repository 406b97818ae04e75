"""Tests: names, remappings and parameters of programs of ROS 1."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import simkit

PRINT_NAMES = """
    import rospy
    rospy.init_node("follower")
    rospy.loginfo("%s %s %s", rospy.get_name(), rospy.get_namespace(), rospy.get_caller_id())
    for name in ("scan", "/scan", "~scan", "a//b/", ""):
        rospy.loginfo(rospy.resolve_name(name))
"""


def test_names_are_relative_to_the_namespace_and_private_ones_to_the_node(sim: Any, add: Any, texts: Any) -> None:
    node = add(PRINT_NAMES, namespace="robot")
    sim.run(0.01)
    expected = ["/robot/follower /robot/ /robot/follower", "/robot/scan", "/scan", "/robot/follower/scan"]
    assert texts(node) == [*expected, "/robot/a/b", "/robot/"]


def test_words_of_the_command_line_rename_the_node_and_its_topics(sim: Any, add: Any, texts: Any) -> None:
    node = add(PRINT_NAMES, args=("__name:=driver", "__ns:=/r1", "scan:=/laser", "~scan:=other", "7"))
    sim.run(0.01)
    assert texts(node)[:4] == ["/r1/driver /r1/ /r1/driver", "/laser", "/scan", "/r1/other"]


def test_options_of_the_run_rename_the_node_and_its_topics(sim: Any, add: Any, texts: Any) -> None:
    node = add(PRINT_NAMES, name="driver", remap={"scan": "laser"})
    sim.run(0.01)
    assert texts(node)[:2] == ["/driver / /driver", "/laser"]


def test_myargv_has_no_words_for_ros(sim: Any, add: Any, texts: Any) -> None:
    node = add(
        """
        import rospy, sys
        rospy.init_node("a")
        rospy.loginfo("%s", rospy.myargv(sys.argv)[1:])
        """,
        args=("fast", "a:=b", "_x:=1", "__name:=n", "--level=2"),
    )
    sim.run(0.01)
    assert texts(node) == ["['fast', '--level=2']"]


def test_anonymous_nodes_have_different_names_which_are_the_same_in_each_run(sim: Any, add: Any, texts: Any) -> None:
    text = """
        import rospy
        rospy.init_node("talker", anonymous=True)
        rospy.loginfo(rospy.get_name())
    """
    nodes = [add(text, "one"), add(text, "two")]
    sim.run(0.01)
    assert [texts(node) for node in nodes] == [["/talker_one_1"], ["/talker_two_2"]]


def test_a_second_init_node_with_other_arguments_is_an_error(sim: Any, add: Any, texts: Any) -> None:
    node = add(
        """
        import rospy
        try:
            rospy.init_node("a/b")
        except ValueError as error:
            print(error)
        rospy.init_node("a")
        rospy.init_node("a")
        try:
            rospy.init_node("b")
        except rospy.ROSException as error:
            rospy.loginfo(str(error)[:68])
        """
    )
    sim.run(0.01)
    assert texts(node) == [
        "namespaces are not allowed in node names",
        "rospy.init_node() has already been called with different arguments: ",
    ]


def test_parameters_come_from_the_run_and_the_command_line(sim: Any, add: Any, texts: Any) -> None:
    node = add(
        """
        import rospy
        rospy.init_node("a")
        for name in ("~speed", "~gains/p", "/limit", "~name", "~list"):
            rospy.loginfo("%r", rospy.get_param(name))
        """,
        params={"speed": 0.5, "gains": {"p": 2}, "/limit": 7},
        args=("_name:=Bob", "_list:=[1, 2.5]"),
    )
    sim.run(0.01)
    assert texts(node) == ["0.5", "2", "7", "'Bob'", "[1, 2.5]"]


def test_the_arguments_of_ros_2_work_and_the_program_does_not_see_them(
    sim: Any, add: Any, texts: Any, tmp_path: Path
) -> None:
    (tmp_path / "a.yaml").write_text("gains: {p: 3}\nspeed: 1\n")
    words = ["-r", "scan:=/laser", "-r", "__node:=b", "-r", "__ns:=/r1", "-p", "speed:=0.5", "-p", "/limit:=7"]
    node = add(
        """
        import rospy, sys
        rospy.init_node("a")
        rospy.loginfo("%s %s %s", rospy.get_name(), rospy.resolve_name("scan"), sys.argv[1:])
        rospy.loginfo("%s %s %s", rospy.get_param("~speed"), rospy.get_param("~gains/p"), rospy.get_param("/limit"))
        """,
        args=("7", "--ros-args", *words, "--params-file", str(tmp_path / "a.yaml")),
    )
    sim.run(0.01)
    assert texts(node) == ["/r1/b /laser ['7']", "0.5 3 7"]
    with pytest.raises(simkit.InputError, match="SK-NODE-030 program: Couldn't parse remap rule: '-r ab'"):
        add("import rospy", args=("--ros-args", "-r", "ab"))


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("gains: [1, 2", "SK-NODE-031 .*a.yaml.* is not valid YAML"),
        ("word", "SK-NODE-031 .*a.yaml has no names of parameters"),
        (None, "SK-NODE-031 .*a.yaml cannot be read"),
    ],
)
def test_a_wrong_file_of_parameters_is_an_error_of_the_user_before_the_start(
    add: Any, tmp_path: Path, text: str | None, reason: str
) -> None:
    file = tmp_path / "a.yaml"
    if text is not None:
        file.write_text(text)
    with pytest.raises(simkit.InputError, match=reason):
        add("import rospy", args=("--ros-args", "--params-file", str(file)))


def test_a_parameter_of_the_command_line_that_is_not_yaml_is_an_error_of_the_user(add: Any) -> None:
    with pytest.raises(simkit.InputError, match=r"SK-NODE-030 found '\[1' for parameter 'x'"):
        add("import rospy", args=("--ros-args", "-p", "x:=[1"))


def test_a_missing_parameter_is_an_error_or_the_default(sim: Any, add: Any, texts: Any) -> None:
    node = add(
        """
        import rospy
        rospy.init_node("a")
        rospy.loginfo("%r %r", rospy.get_param("~x", 3), rospy.get_param("~x", None))
        try:
            rospy.get_param("~x")
        except KeyError as error:
            rospy.loginfo("%s", error)
        """
    )
    sim.run(0.01)
    assert texts(node) == ["3 None", "'~x'"]


def test_a_dictionary_is_a_tree_of_parameters(sim: Any, add: Any, texts: Any) -> None:
    node = add(
        """
        import rospy
        rospy.init_node("a")
        rospy.set_param("/arm", {"x": 1, "sub": {"y": (2, 3)}})
        rospy.set_param("/arm/sub/z", True)
        rospy.loginfo("%r", rospy.get_param("/arm"))
        rospy.loginfo("%r", [n for n in rospy.get_param_names() if n.startswith("/arm")])
        rospy.delete_param("/arm/sub")
        rospy.loginfo("%s %s", rospy.has_param("/arm/sub/y"), rospy.has_param("/arm/x"))
        rospy.get_param("/arm")["x"] = 9
        rospy.loginfo("%r", rospy.get_param("/arm"))
        """
    )
    sim.run(0.01)
    expected = ["{'x': 1, 'sub': {'y': [2, 3], 'z': True}}", "['/arm/x', '/arm/sub/y', '/arm/sub/z']"]
    assert texts(node) == [*expected, "False True", "{'x': 1}"]


def test_a_search_finds_the_parameter_of_the_innermost_namespace(sim: Any, add: Any, texts: Any) -> None:
    node = add(
        """
        import rospy
        rospy.init_node("a")
        rospy.set_param("/model", 1)
        rospy.loginfo("%r", rospy.search_param("model"))
        rospy.set_param("/robot/model", 2)
        rospy.loginfo("%r %r", rospy.search_param("model"), rospy.search_param("other"))
        """,
        namespace="robot",
    )
    sim.run(0.01)
    assert texts(node) == ["'/model'", "'/robot/model' None"]


def test_all_programs_of_a_run_share_the_parameters(sim: Any, add: Any, texts: Any) -> None:
    add("import rospy\nrospy.init_node('a')\nrospy.set_param('/shared', 5)", "first")
    second = add("import rospy\nrospy.init_node('b')\nrospy.loginfo('%r', rospy.get_param('/shared'))", "second")
    sim.run(0.01)
    assert texts(second) == ["5"]


@pytest.mark.parametrize(
    ("value", "text"),
    [("None", "cannot marshal None unless allow_none is enabled"), ("2**40", "int exceeds XML-RPC limits")],
)
def test_values_that_ros_1_cannot_store_are_errors(sim: Any, add: Any, texts: Any, value: str, text: str) -> None:
    node = add(f"import rospy\nrospy.init_node('a')\nrospy.set_param('x', {value})")
    sim.run(0.01)
    assert str(node.error) == text


def test_a_reset_forgets_parameters_that_programs_have_set(sim: Any, add: Any, texts: Any) -> None:
    node = add(
        """
        import rospy
        rospy.init_node("a")
        rospy.loginfo("%r", rospy.get_param("/count", 0))
        rospy.set_param("/count", rospy.get_param("/count", 0) + 1)
        """
    )
    sim.run(0.01)
    sim.reset()
    sim.run(0.01)
    assert texts(node) == ["0"]


def test_a_program_for_python_2_is_named_with_its_line(sim: Any, add: Any, texts: Any) -> None:
    with pytest.raises(simkit.InputError, match=r"SK-NODE-041 .*program.py:3: written for Python 2: the print") as info:
        add("import rospy\n\nprint 'hello'\n")
    assert "Python 3" in info.value.help
