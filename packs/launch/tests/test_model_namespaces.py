"""Plugins of a spawned model are in the namespace of the spawner."""

from __future__ import annotations

from simkit_launch.model_spawning import with_namespace

ROBOT = '<robot name="r"><gazebo><plugin name="c" filename="libgazebo_ros_control.so"{}</gazebo></robot>'
NAMESPACE = "<robotNamespace>/</robotNamespace>"


def test_ros_control_of_ros_1_is_in_the_root_namespace_of_its_spawner_not_in_that_of_the_model() -> None:
    assert with_namespace(ROBOT.format("/>"), "/") == ROBOT.format(f">{NAMESPACE}</plugin>")
    assert with_namespace(ROBOT.format("><a>1</a></plugin>"), "/") == ROBOT.format(f">{NAMESPACE}<a>1</a></plugin>")


def test_a_namespace_in_the_file_remains() -> None:
    robot = ROBOT.format("><robotNamespace>/arm</robotNamespace></plugin>")
    assert with_namespace(robot, "/") == robot


def test_a_name_of_a_model_is_no_text_to_change() -> None:
    assert with_namespace("model://waffle", "/") == "model://waffle"
