"""Messages of subscriptions and bags become tables of pandas."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import simkit
from simkit import msgs
from simkit.errors import ArgumentTypeError, InputError, MessageError
from simkit.recording.bags.reader import open_bag_to_read
from simkit.recording.bags.recorder import Recorder

pytest.importorskip("pandas")


@pytest.fixture(scope="module")
def drive(tmp_path_factory: pytest.TempPathFactory) -> Iterator[tuple[simkit.Simulation, Any, Path]]:
    """Return a simulation after 0.5 s, a subscription to its odometry, and the bag of the run."""
    bag = tmp_path_factory.mktemp("bags") / "drive.mcap"
    with simkit.load("turtlebot3_empty", seed=1) as sim:
        with Recorder(sim, bag, topics=["/odom", "/scan", "/joint_states", "/tf", "/clock"]):
            odometry = sim.subscribe("/odom")
            sim.publish("/cmd_vel", {"linear": {"x": 0.2}})
            sim.run(0.5)
        yield sim, odometry, bag


def test_a_subscription_becomes_a_table_with_stamps_as_index(drive: Any) -> None:
    _, odometry, _ = drive
    table = odometry.to_dataframe()
    assert table.index.name == "time" and table.index[-1] == 0.5 and len(table) == 15
    assert table["pose.pose.position.x"].tolist() == [m.pose.pose.position.x for m in odometry.messages]
    assert set(table["child_frame_id"]) == {"base_footprint"}
    assert "header.stamp.sec" not in table and table["pose.covariance"].iloc[0].shape == (36,)
    assert simkit.to_dataframe(odometry).equals(table) and simkit.to_dataframe(odometry.messages).equals(table)


def test_a_topic_of_a_bag_becomes_the_same_table(drive: Any) -> None:
    _, odometry, bag = drive
    columns = ["pose.pose.position.x", "twist.twist.linear.x"]
    table = simkit.to_dataframe(bag, "odom")
    assert table[columns].equals(odometry.to_dataframe()[columns])
    with open_bag_to_read(bag) as reader:
        assert reader.to_dataframe("/odom")[columns].equals(table[columns])


def test_arrays_and_lists_are_values_of_one_column(drive: Any) -> None:
    _, _, bag = drive
    scans = simkit.to_dataframe(bag, "/scan")
    assert np.stack(scans["ranges"]).shape == (len(scans), 360) and scans["ranges"].iloc[0].dtype == np.float32
    states = simkit.to_dataframe(bag, "/joint_states")
    assert states["name"].iloc[0] == ["wheel_left_joint", "wheel_right_joint"]
    transforms = simkit.to_dataframe(bag, "/tf")
    assert transforms["transforms[].child_frame_id"].iloc[0] == ["base_footprint"]
    assert transforms.index[-1] == 0.5  # without a stamp of its own: the recording time
    assert simkit.to_dataframe(bag, "/clock").index[9] == 0.1


def test_short_arrays_of_fixed_length_have_a_column_for_each_item() -> None:
    table = simkit.to_dataframe([msgs.make("sensor_msgs/msg/CameraInfo", k=range(9), d=[1.0, 2.0])])
    assert table["k[8]"].tolist() == [8.0] and "k" not in table and table["d"].iloc[0].tolist() == [1.0, 2.0]


def test_messages_without_a_time_are_numbered() -> None:
    table = simkit.to_dataframe(msgs.make("std_msgs/msg/Bool", data=i % 2 == 1) for i in range(3))
    assert table.index.name == "message" and table["data"].tolist() == [False, True, False]
    assert table["data"].dtype == bool
    assert len(simkit.to_dataframe([])) == 0


def test_mistakes_are_named(drive: Any) -> None:
    _, odometry, bag = drive
    with pytest.raises(InputError, match="did you mean '/odom'"):
        simkit.to_dataframe(bag, "/odum")
    with pytest.raises(InputError, match="has 5 topics; give one of them: /clock, /joint_states, /odom, /scan, /tf"):
        simkit.to_dataframe(bag)
    with pytest.raises(ArgumentTypeError, match="the topic must be None, because the source is not a bag"):
        simkit.to_dataframe(odometry, "/odom")
    with pytest.raises(ArgumentTypeError, match=r"messages\[0\] must be a message, got 3"):
        simkit.to_dataframe([3])
    with pytest.raises(ArgumentTypeError, match="the source must be a subscription, a bag or messages"):
        simkit.to_dataframe(3)  # type: ignore[arg-type]
    with pytest.raises(MessageError, match="several types: std_msgs/msg/Bool, std_msgs/msg/Empty"):
        simkit.to_dataframe([msgs.make("std_msgs/msg/Bool"), msgs.make("std_msgs/msg/Empty")])
    broken = msgs.make("std_msgs/msg/Float64")
    broken.data = "much"
    with pytest.raises(MessageError, match="std_msgs/msg/Float64.data of a message has a value of a wrong kind"):
        simkit.to_dataframe([broken])


def test_a_missing_pandas_is_named_with_what_installs_it(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(InputError, match=r'pip install "simkit-robotics\[pandas\] @ git\+https://') as caught:
        simkit.to_dataframe([])
    assert caught.value.code == "SK-INPUT-004"
