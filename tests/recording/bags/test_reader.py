"""Bags are read back, whoever recorded them."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import pytest
from rosbags.rosbag2 import StoragePlugin, Writer
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from simkit import msgs
from simkit.errors import InputError
from simkit.recording.bags.reader import open_bag_to_read
from simkit.recording.bags.summary import bag_summary, bag_text
from simkit.recording.bags.writer import McapBag, Rosbag2Folder

SECOND = 1_000_000_000
FOREIGN = "lab_msgs/msg/Reading"


def _numbers(bag: McapBag, count: int = 3) -> None:
    channel = bag.channel("/number", "std_msgs/msg/Float64", latched=False)
    names = bag.channel("/name", "std_msgs/msg/String", latched=True)
    bag.write_raw(names, msgs.serialize(msgs.make("std_msgs/msg/String", data="rover")), 0)
    for i in range(count):
        bag.write_raw(channel, msgs.serialize(msgs.make("std_msgs/msg/Float64", data=float(i))), i * SECOND)


def _foreign(path: Path, storage: Any) -> None:
    """As ROS 2 writes it, with a type that nobody else knows."""
    store = get_typestore(Stores.ROS2_HUMBLE)
    store.register(get_types_from_msg("std_msgs/Header header\nfloat32[] values\nstring unit", FOREIGN))
    kind, header = store.types[FOREIGN], store.types["std_msgs/msg/Header"]
    import numpy as np

    with Writer(path, version=9, storage_plugin=storage) as writer:
        connection = writer.add_connection("/reading", FOREIGN, typestore=store)
        for i in range(2):
            stamp = store.types["builtin_interfaces/msg/Time"](i, 0)
            message = kind(header(stamp, "lab"), np.array([i, 2.5], dtype=np.float32), "V")
            writer.write(connection, i * SECOND, store.serialize_cdr(message, FOREIGN))


@pytest.mark.parametrize("name", ["run.mcap", "run"])
def test_a_bag_of_simkit_is_read_back(name: str, tmp_path: Path) -> None:
    bag = McapBag(tmp_path / name) if name.endswith(".mcap") else Rosbag2Folder(tmp_path / name)
    _numbers(bag)
    bag.close()
    with open_bag_to_read(tmp_path / name) as found:
        assert [(t.name, t.type_name, t.count, t.latched) for t in found.topics] == [
            ("/name", "std_msgs/msg/String", 1, True),
            ("/number", "std_msgs/msg/Float64", 3, False),
        ]
        assert (found.start, found.end, found.count) == (0, 2 * SECOND, 4)
        assert [found.decode(m).data for m in found.messages("/number")] == [0.0, 1.0, 2.0]
        assert [m.time_ns for m in found.messages(["/number"], start=SECOND)] == [SECOND, 2 * SECOND]
        assert found.storage == "mcap" and not found.broken


@pytest.mark.parametrize("storage", [StoragePlugin.SQLITE3, StoragePlugin.MCAP])
def test_a_ros_2_bag_with_custom_types_is_read_with_the_bags_definitions(storage: Any, tmp_path: Path) -> None:
    _foreign(tmp_path / "lab", storage)
    with open_bag_to_read(tmp_path / "lab") as bag:
        assert bag.storage == ("sqlite3" if storage is StoragePlugin.SQLITE3 else "mcap")
        readings = [bag.decode(m) for m in bag.messages()]
        assert [list(r.values) for r in readings] == [[0.0, 2.5], [1.0, 2.5]]
        assert readings[1].header.frame_id == "lab"


def test_a_database_alone_is_a_bag(tmp_path: Path) -> None:
    _foreign(tmp_path / "lab", StoragePlugin.SQLITE3)
    (database,) = (tmp_path / "lab").glob("*.db3")
    with open_bag_to_read(database) as bag:
        assert bag.storage == "sqlite3" and bag.count == 2


def test_a_truncated_bag_is_read_up_to_its_end(tmp_path: Path) -> None:
    path = tmp_path / "run.mcap"
    bag = McapBag(path)
    _numbers(bag, 20)
    bag.close()
    (tmp_path / "cut.mcap").write_bytes(path.read_bytes()[: path.stat().st_size // 4])
    with open_bag_to_read(tmp_path / "cut.mcap") as cut:
        assert "simkit bag recover" in cut.broken
        values = [cut.decode(m).data for m in cut.messages(["/number"])]
        assert values == [float(i) for i in range(len(values))] and 0 < len(values) < 20


def test_a_path_that_is_not_a_bag_is_reported(tmp_path: Path) -> None:
    (tmp_path / "text.mcap").write_text("no bag", encoding="utf-8")
    (tmp_path / "notes.txt").write_text("no bag", encoding="utf-8")
    (tmp_path / "empty").mkdir()
    (tmp_path / "torn").mkdir()
    (tmp_path / "torn" / "metadata.yaml").write_text("rosbag2_bagfile_information: [", encoding="utf-8")
    (tmp_path / "no.db3").write_bytes(b"\0" * 100)
    for name in ("text.mcap", "notes.txt", "empty", "torn", "no.db3", "nothing.mcap"):
        with pytest.raises(InputError, match="SK-CLI-035"):
            open_bag_to_read(tmp_path / name)


def test_the_summary_equals_ros2_bag_info(tmp_path: Path) -> None:
    bag = Rosbag2Folder(tmp_path / "run")
    _numbers(bag)
    bag.close()
    with open_bag_to_read(tmp_path / "run") as found:
        size = f"{found.size / 1024:.1f} KiB"
        assert bag_text(found) == (
            f"\nFiles:             run_0.mcap\nBag size:          {size}\nStorage id:        mcap\n"
            "ROS Distro:        jazzy\nDuration:          2.000000000s\n"
            "Start:             Jan  1 1970 00:00:00.000000000 (0.000000000)\n"
            "End:               Jan  1 1970 00:00:02.000000000 (2.000000000)\nMessages:          4\n"
            "Topic information: Topic: /name | Type: std_msgs/msg/String | Count: 1 | Serialization Format: cdr\n"
            "                   Topic: /number | Type: std_msgs/msg/Float64 | Count: 3 | Serialization Format: cdr\n"
            "Services:          0\nService information: \n"
        )
        assert bag_summary(found)["duration"] == 2.0


@pytest.mark.parametrize("metadata", [None, "", "5", "a: 2024-13-45", "[" * 300, "rosbag2_bagfile_information: 5"])
def test_a_folder_without_metadata_is_read_from_its_files(tmp_path: Path, metadata: str | None) -> None:
    folder = tmp_path / "drive"
    bag = Rosbag2Folder(folder)
    _numbers(bag)
    bag.close()
    (folder / "metadata.yaml").unlink()
    if metadata is not None:
        (folder / "metadata.yaml").write_text(metadata)
    with open_bag_to_read(folder) as found:
        assert found.count == 4 and found.broken
        assert "Messages:          4\n" in bag_text(found)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no pipes with names there")
def test_a_special_file_is_not_opened(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.mcap")
    with pytest.raises(InputError, match="neither a file nor a folder"):
        open_bag_to_read(tmp_path / "pipe.mcap")


@pytest.mark.parametrize("size", [100, 35, 12])
def test_a_recording_truncated_in_its_first_second_is_empty(tmp_path: Path, size: int) -> None:
    bag = McapBag(tmp_path / "run.mcap")
    _numbers(bag, 1)
    begun = (tmp_path / "run.mcap").read_bytes()
    bag.close()
    (tmp_path / "cut.mcap").write_bytes(begun[:size])
    if size == 12:
        with pytest.raises(InputError, match="SK-CLI-035"):
            open_bag_to_read(tmp_path / "cut.mcap")
        return
    with open_bag_to_read(tmp_path / "cut.mcap") as cut:
        assert cut.count == 0 and not list(cut.messages()) and "before the first message" in cut.broken
