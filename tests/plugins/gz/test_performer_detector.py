"""Performer detector of Gazebo: boxes along the world's axes, one message per entry and exit."""

from __future__ import annotations

from typing import Any

import pytest

import simkit
from simkit.errors import LoadError

BODY = "<inertial><mass>1</mass><inertia><ixx>1</ixx><iyy>1</iyy><izz>1</izz></inertia></inertial>"
BOX = "<geometry><box><size>{}</size></box></geometry>"
DETECTOR = 'filename="gz-sim-performer-detector-system" name="gz::sim::systems::PerformerDetector"'
TOPIC = "/model/gate/performer_detector/status"


def robot(name: str, pose: str) -> str:
    return f'<model name="{name}"><pose>{pose}</pose><link name="l">{BODY}</link></model>'


def world(more: str = "", gate: str = "0 0 0 0 0 0", names: tuple[str, ...] = ("a",), extra: str = "") -> str:
    size = BOX.format("0.2 0.2 0.2")
    performers = "".join(f'<performer name="p{n}"><ref>{n}</ref>{size}</performer>' for n in names)
    plugin = f"<plugin {DETECTOR}>{BOX.format('2 4 2')}{more}</plugin>"
    return f"""<sdf version="1.9"><world name="w"><gravity>0 0 0</gravity>
    <plugin name="gz::sim" filename="dummy">{performers}</plugin>
    <model name="gate"><static>true</static><pose>{gate}</pose><link name="l"/>{plugin}</model>
    {"".join(robot(n, "-3 0 0 0 0 0") for n in names)}{extra}</world></sdf>"""


def events(sim: Any, topic: str = TOPIC) -> list[tuple[int, str, bool, int]]:
    found: list[tuple[int, str, bool, int]] = []
    sim.subscribe(f"{topic}/details", lambda m: found.append((sim.tick, m.name, m.state, m.count)))
    return found


def test_a_performer_is_published_when_its_box_enters_and_leaves() -> None:
    with simkit.load(world()) as sim:
        found = events(sim)
        sim.model("a").set_velocity((1, 0, 0), (0, 0, 0))
        sim.run(6.0)
        # from -3 m at 1 m/s: the boxes meet at -1.1 m and part beyond 1.1 m
        assert found == [(pytest.approx(1900, abs=1), "a", True, 1), (pytest.approx(4101, abs=1), "a", False, 0)]


def test_the_message_has_the_pose_in_the_detector_frame_and_the_header_data() -> None:
    data = "<header_data><key>team</key><value>red</value></header_data>"
    with simkit.load(world(data, gate="5 0 0 0 0 1.5707963267948966")) as sim:
        events(sim)
        plain, full = sim.subscribe(TOPIC), sim.subscribe(f"{TOPIC}/details")
        sim.model("a").set_pose(simkit.Pose((5, 0.5, 0)))
        sim.run(0.01)
        (status,), (pose,) = full.messages, plain.messages
        assert (status.name, status.keys, status.values) == ("a", ["team"], ["red"])
        assert pose.header.frame_id == "gate"
        position = pose.pose.position
        assert (position.x, position.y) == (pytest.approx(0.5), pytest.approx(0.0, abs=1e-9))
        assert sim.topics()[TOPIC] == "geometry_msgs/msg/PoseStamped"


@pytest.mark.parametrize(("y", "is_inside"), [(1.9, True), (2.2, False)])
def test_the_box_does_not_turn_with_its_model(y: float, is_inside: bool) -> None:
    with simkit.load(world(gate="0 0 0 0 0 1.5707963267948966")) as sim:
        found = events(sim)
        sim.model("a").set_pose(simkit.Pose((0, y, 0)))
        sim.run(0.01)
        assert bool(found) == is_inside


def test_the_position_of_the_box_turns_with_its_model() -> None:
    with simkit.load(world("<pose>10 0 0 0 0 0</pose>", gate="0 0 0 0 0 1.5707963267948966")) as sim:
        found = events(sim)
        sim.model("a").set_pose(simkit.Pose((0, 10, 0)))
        sim.run(0.01)
        assert [state for _, _, state, _ in found] == [True]


def test_a_performer_that_is_inside_at_the_start_is_published_and_counted() -> None:
    text = world(names=("a", "b")).replace("-3 0 0", "0 0.5 0")
    with simkit.load(text) as sim:
        found = events(sim)
        sim.run(0.01)
        assert found == [(1, "a", True, 1), (1, "b", True, 2)]
        late = events(sim)
        sim.run(0.01)
        assert late == [], "who is inside already is no news to one who begins to listen"


def test_a_performer_may_be_spawned_removed_and_reset() -> None:
    with simkit.load(world().replace("<ref>a</ref>", "<ref>later</ref>")) as sim:
        assert "SK-PLUGIN-125" in [d.code for d in sim.diagnostics]
        found = events(sim)
        sim.run(0.01)
        sim.spawn(f'<sdf version="1.9">{robot("later", "0 0 0 0 0 0")}</sdf>')
        sim.run(0.01)
        assert [entry[1:] for entry in found] == [("later", True, 1)]
        sim.remove("later")
        sim.run(0.01)
        assert len(found) == 1
        sim.reset()
        sim.run(0.01)
        assert len(found) == 1


def test_two_detectors_may_share_a_topic() -> None:
    other = f'<model name="gate2"><static>true</static><pose>-3 0 0 0 0 0</pose><link name="l"/><plugin {DETECTOR}>'
    other += f"{BOX.format('1 1 1')}<topic>gates</topic></plugin></model>"
    with simkit.load(world("<topic>gates</topic>", extra=other)) as sim:
        found = events(sim, "/gates")
        sim.run(0.01)
        sim.model("a").set_pose(simkit.Pose((0, 0, 0)))
        sim.run(0.01)
        # first inside the box of the other detector; then inside the gate's, with an exit event of the other
        assert found == [(1, "a", True, 1), (11, "a", True, 1), (11, "a", False, 0)]


def test_levels_are_a_note_and_a_detector_without_performers_is_a_warning() -> None:
    text = world(names=()).replace('filename="dummy">', 'filename="dummy"><level name="l"><ref>x</ref></level>')
    with simkit.load(text) as sim:
        assert {"SK-PLUGIN-125", "SK-PLUGIN-126"} <= {d.code for d in sim.diagnostics}


def test_a_performer_without_a_model_is_an_error() -> None:
    with pytest.raises(LoadError, match="found <ref></ref>; expected a name"):
        simkit.load(world(names=("",)))
