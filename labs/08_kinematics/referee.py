"""Referee of lab 8: puts the robot into its start pose, and publishes numbers from the ground truth. Given.

/referee/fk_error       distance of the newest /student/tool_pose from the true tool [m], when it was published
/referee/pose_error     distance of the tool from the pose goal [m]
/referee/turn_error     angle between the tool and the pose goal [rad]
/referee/joint_error    largest error of a joint against the joint goal [rad or m]
/referee/self_contacts  number of contacts between links of the robot, without those between the fingers
/referee/over_limit     largest excess over a limit: position [rad or m], or speed as a part of its limit
"""

from __future__ import annotations

import math

from simkit import ModelPlugin, Pose, msgs

NAMES = ["torso_lift_joint"] + [f"arm_{i}_joint" for i in range(1, 8)]
START = [0.15, 0.2, -1.34, -0.2, 1.94, -1.57, 1.37, 0.0]  # the end of the motion `home`
POSE = Pose.from_rpy(0.4, -0.3, 0.26, -0.011, 1.57, 0.037)
JOINTS = [0.0, 2.7, 0.2, -2.1, 2.0, 1.0, -0.8, 0.0]
TOPICS = ("fk_error", "pose_error", "turn_error", "joint_error", "self_contacts", "over_limit")


class Referee(ModelPlugin):
    after_step_rate = 100.0  # [Hz]

    def load(self, parent, params):
        self.robot = parent
        self.joints = [parent.joint(name) for name in NAMES]
        for joint, value in zip(self.joints, START):
            joint.set_position(value)
        self.out = {name: self.advertise(f"/referee/{name}", "std_msgs/msg/Float64") for name in TOPICS}
        self.subscribe("/student/tool_pose", self.take_pose)

    def tool(self):
        """Return the true pose of the tool in base_footprint."""
        return self.robot.link("base_footprint").pose.inverse() @ self.robot.link("arm_tool_link").pose

    def take_pose(self, message):
        error = math.dist(msgs.pose(message).position, self.tool().position)
        self.out["fk_error"].publish({"data": error})

    def after_step(self):
        tool = self.tool()
        self.tell("pose_error", math.dist(tool.position, POSE.position))
        self.tell("turn_error", 2 * math.acos(min(1.0, abs((tool.inverse() @ POSE).quaternion[0]))))
        self.tell("joint_error", max(abs(j.position - goal) for j, goal in zip(self.joints, JOINTS)))
        self.tell("self_contacts", len(self.self_contacts()))
        self.tell("over_limit", max(self.over_limit(joint) for joint in self.joints))

    def self_contacts(self):
        found, own = [], f"{self.robot.scoped}::"
        for contact in self.sim.contacts(self.robot):
            is_own = contact.first.startswith(own) and contact.second.startswith(own)
            if is_own and not ("finger" in contact.first and "finger" in contact.second):
                found.append((contact.first, contact.second))
        return found

    def over_limit(self, joint):
        axis = joint.scene.axes[0]
        return max(axis.lower - joint.position, joint.position - axis.upper, abs(joint.velocity) / axis.velocity - 1, 0)

    def tell(self, name, value):
        self.out[name].publish({"data": float(value)})
