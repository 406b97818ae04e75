"""Referee of lab 13: it compares the robot with the table of the README, drives it, and moves its arm.

Each topic below `/referee` is a `std_msgs/msg/String`: `right`, or what the robot has and what the table says.

| topic | content |
|---|---|
| `names` | links and joints |
| `masses`, `inertias` | of the links |
| `joints` | type, parent, child, place and axis of each joint |
| `limits` | of the joints of the arm |
| `stands` | height and pitch of the base after 1 s |
| `drives` | path of 3 s at 0.2 m/s |
| `turns` | turn of pi s at 0.5 rad/s |
| `reaches` | places of the tool for two goals |
"""

from __future__ import annotations

import math

from simkit import WorldPlugin

ROBOT = "carrier"
UPPER, FOREARM = 0.30, 0.24  # lengths of the segments [m]
SHOULDER = (-0.06, 0.10)  # x and z of the shoulder in the frame of the base [m]
GOALS = [(0.30, 0.30), (-0.30, 0.48)]  # x and z of the tool in the frame of the base [m]
LIMITS = {  # joint -> lower and upper [rad], effort [N m], velocity [rad/s]
    "shoulder_joint": (-1.4, 1.4, 20.0, 2.0),
    "elbow_joint": (0.0, 2.4, 10.0, 2.5),
}
DRIVE = (2.0, 5.0)  # [s] of a command of 0.2 m/s
TURN = (6.5, 6.5 + math.pi)  # [s] of a command of 0.5 rad/s
REACH = (11.0, 13.0, 15.0)  # [s] first goal, its end and second goal, end
NO_ROBOT = f"there is no model {ROBOT}"


def box(mass, x, y, z):
    return mass, tuple(mass * value / 12 for value in (y * y + z * z, x * x + z * z, x * x + y * y))


def cylinder(mass, radius, length):
    """Return mass and principal moments of a cylinder along z."""
    across = mass * (3 * radius**2 + length**2) / 12
    return mass, (across, across, mass * radius**2 / 2)


class Referee(WorldPlugin):
    before_step_rate = 100.0  # [Hz]

    def load(self, parent, params):
        radius = params.number("wheel_radius", required=True)  # [m]
        self.radius = radius
        sphere = 2 * 0.2 * 0.04**2 / 5
        self.bodies = {  # link -> mass [kg], principal moments [kg m²] in a fixed order of axes
            "base_link": box(5.0, 0.40, 0.28, 0.10),
            "left_wheel": cylinder(0.5, radius, 0.04),
            "right_wheel": cylinder(0.5, radius, 0.04),
            "caster": (0.2, (sphere, sphere, sphere)),
            "upper_arm": cylinder(0.5, 0.025, UPPER),
            "forearm": cylinder(0.3, 0.02, FOREARM),
        }
        self.joints = {  # joint -> type, parent, child, place in the frame of the parent [m]
            "left_wheel_joint": ("continuous", "base_link", "left_wheel", (0.0, 0.17, 0.0)),
            "right_wheel_joint": ("continuous", "base_link", "right_wheel", (0.0, -0.17, 0.0)),
            "caster_joint": ("fixed", "base_link", "caster", (-0.20, 0.0, 0.04 - radius)),
            "shoulder_joint": ("revolute", "base_link", "upper_arm", (SHOULDER[0], 0.0, SHOULDER[1])),
            "elbow_joint": ("revolute", "upper_arm", "forearm", (0.0, 0.0, UPPER)),
            "tool_joint": ("fixed", "forearm", "tool", (0.0, 0.0, FOREARM)),
        }
        names = ("names", "masses", "inertias", "joints", "limits", "stands", "drives", "turns", "reaches")
        self.topics = {name: self.advertise(f"/referee/{name}", "std_msgs/msg/String") for name in names}
        self.drive = self.advertise("/cmd_vel", "geometry_msgs/msg/Twist")
        self.arm = self.advertise("/arm_controller/commands", "std_msgs/msg/Float64MultiArray")
        self.tasks = [  # time [s], what to do
            (0.0, self.compare_model),
            (1.0, self.measure_stand),
            (DRIVE[0], self.note_start),
            (DRIVE[1] + 1.0, self.measure_drive),
            (TURN[0], self.note_start),
            (TURN[1] + 1.0, self.measure_turn),
            (REACH[0], lambda: self.send(0)),
            (REACH[1], lambda: self.measure_reach(0)),
            (REACH[1], lambda: self.send(1)),
            (REACH[2], lambda: self.measure_reach(1)),
        ]
        self.start = None  # pose of the base before a motion
        self.misses = []  # goals that the tool did not reach

    def robot(self):
        return self.sim.models.get(ROBOT)

    def publish(self, name, problems):
        self.topics[name].publish({"data": "; ".join(problems[:3]) or "right"})

    def before_step(self):
        time = self.sim.time + 1e-9
        while self.tasks and time >= self.tasks[0][0]:
            self.tasks.pop(0)[1]()
        if not self.tasks:
            return  # other programs may drive now
        forward = 0.2 if DRIVE[0] <= time < DRIVE[1] else 0.0
        turning = 0.5 if TURN[0] <= time < TURN[1] else 0.0
        self.drive.publish({"linear": {"x": forward}, "angular": {"z": turning}})

    # ------------------------------------------------------------------ the model

    def compare_model(self):
        robot = self.robot()
        if robot is None:
            for name in ("names", "masses", "inertias", "joints", "limits"):
                self.publish(name, [NO_ROBOT])
            return
        links = [name for name in (*self.bodies, "tool") if name not in robot.links]
        joints = [name for name in self.joints if name not in robot.joints]
        self.publish(
            "names", [f"there is no link {name}" for name in links] + [f"there is no joint {n}" for n in joints]
        )
        masses, inertias = [], []
        for name, (mass, moments) in self.bodies.items():
            if name not in robot.links:
                masses.append(f"there is no link {name}")
                inertias.append(f"there is no link {name}")
                continue
            link = robot.link(name)
            if abs(link.mass - mass) > 0.01 * mass:
                masses.append(f"{name}: yours {link.mass:.4g} kg, true {mass:.4g} kg")
            inertias += self.compare_inertia(name, link, moments)
        self.publish("masses", masses)
        self.publish("inertias", inertias)
        self.publish(
            "joints", [text for name, wanted in self.joints.items() for text in self.compare_joint(name, *wanted)]
        )
        self.publish("limits", [text for name, wanted in LIMITS.items() for text in self.compare_limits(name, wanted)])

    def compare_inertia(self, name, link, moments):
        """Compare the moments of a link, in the axes of its <inertial>."""
        x, y, z, *products = link.inertia
        found = (x, y, z)
        if "wheel" in name and abs(y - moments[2]) < 0.01 * moments[2]:  # the axis of the cylinder may be given as y
            moments = (moments[0], moments[2], moments[1])
        wrong = any(abs(a - b) > 0.01 * b for a, b in zip(found, moments, strict=True))
        wrong = wrong or any(abs(product) > 0.01 * max(moments) for product in products)
        texts = [", ".join(f"{value:.4g}" for value in values) for values in (found, moments)]
        return [f"{name}: yours {texts[0]} kg m², true {texts[1]} kg m²"] if wrong else []

    def compare_joint(self, name, kind, parent, child, place):
        robot = self.robot()
        if name not in robot.joints:
            return [f"there is no joint {name}"]
        scene = robot.joint(name).scene
        names = [scoped.rsplit("::", 1)[-1] for scoped in (scene.parent_link, scene.child_link)]
        if names != [parent, child]:
            return [f"{name}: yours from {names[0]} to {names[1]}, true from {parent} to {child}"]
        if scene.type != kind:
            return [f"{name}: yours {scene.type}, true {kind}"]
        texts = []
        frame = robot.link(parent).scene.pose_world
        found = (frame.inverse() @ scene.pose_world).position
        if any(abs(a - b) > 1e-3 for a, b in zip(found, place, strict=True)):
            texts.append(f"{name}: yours at {row(found)} m, true {row(place)} m")
        if kind != "fixed":
            inverse = frame.inverse()
            axis = inverse.transform(scene.axes[0].xyz_world) - inverse.position
            if any(abs(a - b) > 1e-3 for a, b in zip(axis, (0.0, 1.0, 0.0), strict=True)):
                texts.append(f"{name}: your axis {row(axis)}, true (0, 1, 0)")
        return texts

    def compare_limits(self, name, wanted):
        if name not in self.robot().joints:
            return [f"there is no joint {name}"]
        axes = self.robot().joint(name).scene.axes
        if not axes:
            return [f"{name}: it has no axis"]
        found = (axes[0].lower, axes[0].upper, axes[0].effort, axes[0].velocity)
        names = ("lower", "upper", "effort", "velocity")
        return [
            f"{name}: {label} yours {'none' if a is None or math.isinf(a) else f'{a:.4g}'}, true {b:.4g}"
            for label, a, b in zip(names, found, wanted, strict=True)
            if a is None or abs(a - b) > 1e-6
        ]

    # ------------------------------------------------------------------ the motion

    def base(self):
        robot = self.robot()
        return None if robot is None or "base_link" not in robot.links else robot.link("base_link").pose

    def note_start(self):
        self.start = self.base()

    def measure_stand(self):
        pose = self.base()
        if pose is None:
            self.publish("stands", [NO_ROBOT])
            return
        height, pitch = pose.position[2], math.degrees(pose.rpy[1])
        wrong = abs(height - self.radius) > 0.003 or abs(pitch) > 1.0
        found = f"{number(height)} m high and pitched by {number(pitch, 1)} degrees"
        text = f"yours {found}, true {self.radius:.3f} m and 0 degrees"
        self.publish("stands", [text] if wrong else [])

    def moved(self):
        """Return the motion since the start: ahead [m], to the left [m], yaw [degrees]."""
        if self.start is None or self.base() is None:
            return None
        motion = self.start.inverse() @ self.base()
        return motion.position[0], motion.position[1], math.degrees(motion.rpy[2])

    def measure_drive(self):
        moved = self.moved()
        if moved is None:
            self.publish("drives", [NO_ROBOT])
            return
        ahead, left, yaw = moved
        wrong = abs(ahead - 0.6) > 0.02 or abs(left) > 0.01 or abs(yaw) > 1.0
        found = f"{number(ahead)} m ahead, {number(left)} m to the left, {number(yaw, 1)} degrees"
        text = f"yours {found}; true 0.600 m, 0 m, 0 degrees"
        self.publish("drives", [text] if wrong else [])

    def measure_turn(self):
        moved = self.moved()
        if moved is None:
            self.publish("turns", [NO_ROBOT])
            return
        wrong = abs(moved[2] - 90.0) > 3.0 or math.hypot(moved[0], moved[1]) > 0.02
        aside = math.hypot(moved[0], moved[1])
        text = f"yours {number(moved[2], 1)} degrees and {number(aside)} m aside, true 90 degrees and 0 m"
        self.publish("turns", [text] if wrong else [])

    def send(self, index):
        """Send the joint angles for a goal of the tool, with the lengths of the table."""
        x, z = (goal - at for goal, at in zip(GOALS[index], SHOULDER, strict=True))
        elbow = math.acos((x * x + z * z - UPPER**2 - FOREARM**2) / (2 * UPPER * FOREARM))
        shoulder = math.atan2(x, z) - math.atan2(FOREARM * math.sin(elbow), UPPER + FOREARM * math.cos(elbow))
        self.arm.publish({"data": [shoulder, elbow]})

    def measure_reach(self, index):
        robot, goal = self.robot(), (GOALS[index][0], 0.0, GOALS[index][1])
        if robot is None or "tool" not in robot.links:
            self.misses.append("there is no link tool")
        else:
            found = (self.base().inverse() @ robot.link("tool").pose).position
            if math.dist(found, goal) > 0.01:
                self.misses.append(f"goal {index + 1}: yours at {row(found)} m, true {row(goal)} m")
        if index == 1:
            self.publish("reaches", self.misses)


def number(value, digits=3):
    return f"{round(value, digits) + 0.0:.{digits}f}"  # + 0.0 makes 0 of -0


def row(values):
    return "(" + ", ".join(f"{round(value, 4) + 0.0:.3g}" for value in values) + ")"
