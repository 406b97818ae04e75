"""Topics: who publishes what on them, who hears it, and how much at a time."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import BALL, model, python

_FILES = {"ball.sdf": BALL}

_TWO_TYPES = """
<link name="base"/>
<link name="left"/>
<joint name="l" type="revolute"><parent>base</parent><child>left</child><axis/></joint>
<link name="right"/>
<joint name="r" type="revolute"><parent>base</parent><child>right</child><axis/></joint>
<plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">
  <left_joint>l</left_joint><right_joint>r</right_joint><topic>command</topic>
</plugin>
<plugin filename="gz-sim-joint-controller-system" name="gz::sim::systems::JointController">
  <joint_name>l</joint_name><topic>command</topic>
</plugin>
"""

_LISTENER = """
import simkit

class Listener(simkit.WorldPlugin):
    def load(self, sim, params):
        self.listen("value", "std_msgs/msg/Float64", lambda message: None)

sim = simkit.load("ball.sdf", plugins=[Listener()])
for i in range(2000):
    sim.publish("/value", {"data": float(i)})
sim.step()
"""

_RAISING = """
import simkit

class Talker(simkit.WorldPlugin):
    def load(self, sim, params):
        self.value = self.advertise("value", "std_msgs/msg/Float64")

    def after_step(self):
        self.value.publish(simkit.msgs.make("std_msgs/msg/Float64", data=1.0))

def on_value(message):
    raise ValueError("too small")

sim = simkit.load("ball.sdf", plugins=[Talker()])
sim.subscribe("/value", on_value{how})
sim.run(0.1)
"""

_SHARED = """
import simkit

class Second(simkit.WorldPlugin):
    def load(self, sim, params):
        self.advertise("imu", "sensor_msgs/msg/Imu")

sim = simkit.load("eye.sdf", plugins=[Second()])
"""
_EYE = model('<link name="base">\n  <sensor name="eye" type="imu"><topic>imu</topic><imu/></sensor>\n</link>').text

CODES: tuple[Code, ...] = (
    Code(
        "SK-TOPIC-001",
        "error",
        "two plugins, or a plugin and a sensor, mean two types by one topic, and ROS knows one; both places are said",
        "give one of them a topic of its own",
        model(_TWO_TYPES),
    ),
    Code(
        "SK-TOPIC-002",
        "stop",
        "a subscriber's callback raised; its topic, its name and its place are said; exit code 4",
        '`subscribe(…, on_error="drop")` goes on without it',
        python(_RAISING.format(how=""), _FILES),
    ),
    Code(
        "SK-TOPIC-003",
        "warning",
        'a callback subscribed with `on_error="drop"` raised, and hears no more',
        "",
        python(_RAISING.format(how=', on_error="drop"'), _FILES),
    ),
    Code(
        "SK-TOPIC-004",
        "warning",
        "more messages came for one step than a plugin's input keeps (1000 of a topic): the oldest are dropped",
        "send less often; `sim.bus.dropped` counts them",
        python(_LISTENER, _FILES),
    ),
    Code(
        "SK-TOPIC-005",
        "warning",
        "a subscription without `keep` has had a million messages: the newest are there",
        "`subscribe(…, keep=…)`",
        without="it takes more than a million messages",
    ),
    Code(
        "SK-TOPIC-006",
        "warning",
        "a plugin publishes on a sensor's topic; a reader gets both in turn",
        "give one of them a topic of its own",
        python(_SHARED, {"eye.sdf": _EYE}),
    ),
)
