"""Move TIAGo's torso, gripper and arm, one goal after another: a solution."""

from __future__ import annotations

from simkit import ModelPlugin

ARM = [f"arm_{k}_joint" for k in range(1, 8)]
FINGERS = ["gripper_left_finger_joint", "gripper_right_finger_joint"]
FIRST = [0.6, -0.3, -1.0, 1.0, -0.8, -0.3, 0.0]  # [rad], after 2.5 s, with 0.5 rad/s in arm_1_joint and arm_4_joint
SECOND = [1.4, -0.6, -1.5, 1.8, -1.5, -0.5, 0.0]  # [rad], after 5 s


class Arm(ModelPlugin):
    before_step_rate = 20.0  # [Hz]

    def load(self, parent, params):
        self.goal = None
        self.to_do = [self.raise_torso, self.open_gripper, self.move_arm, self.go_home]

    def before_step(self):
        if self.to_do and (self.goal is None or self.goal.is_done):
            self.goal = self.to_do.pop(0)()

    def raise_torso(self):
        return self.follow("torso_controller", ["torso_lift_joint"], [point(5, [0.25])])

    def open_gripper(self):
        return self.follow("gripper_controller", FINGERS, [point(2, [0.04, 0.04])])

    def move_arm(self):
        passing = [0.5, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0]
        return self.follow("arm_controller", ARM, [point(2.5, FIRST, passing), point(5, SECOND, [0.0] * 7)])

    def go_home(self):
        return self.sim.send_goal("/play_motion2", {"motion_name": "home"})

    def follow(self, controller, joints, points):
        """Send a trajectory to a controller and return its goal."""
        trajectory = {"joint_names": joints, "points": points}
        return self.sim.send_goal(f"/{controller}/follow_joint_trajectory", {"trajectory": trajectory})


def point(seconds, positions, velocities=()):
    """Return a point of a trajectory: its time [s], positions [rad or m] and velocities [rad/s or m/s]."""
    time = {"sec": int(seconds), "nanosec": round(seconds % 1 * 1e9)}
    return {"time_from_start": time, "positions": list(positions), "velocities": list(velocities)}
