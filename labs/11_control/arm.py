"""Move TIAGo's torso, gripper and arm, one goal after another: your plugin. Run it with `simkit lab grade .`"""

from __future__ import annotations

from simkit import ModelPlugin

ARM = [f"arm_{k}_joint" for k in range(1, 8)]
FINGERS = ["gripper_left_finger_joint", "gripper_right_finger_joint"]
FIRST = [0.6, -0.3, -1.0, 1.0, -0.8, -0.3, 0.0]  # [rad], after 2.5 s, with 0.5 rad/s in arm_1_joint and arm_4_joint
SECOND = [1.4, -0.6, -1.5, 1.8, -1.5, -0.5, 0.0]  # [rad], after 5 s


class Arm(ModelPlugin):
    before_step_rate = 20.0  # [Hz], calls of before_step

    def load(self, parent, params):
        self.goal = None  # the goal that was sent last; `self.goal.is_done` is True after its end
        self.to_do = [self.raise_torso]

    def before_step(self):
        # Exercise: send the next goal of the list only when the one before is done.
        if self.to_do and self.goal is None:
            self.goal = self.to_do.pop(0)()

    def raise_torso(self):
        # Exercise: 0.25 m after 5 s. Then write a method for each of the other goals.
        return self.follow("torso_controller", ["torso_lift_joint"], [point(5, [0.0])])

    def follow(self, controller, joints, points):
        """Send a trajectory to a controller and return its goal."""
        trajectory = {"joint_names": joints, "points": points}
        return self.sim.send_goal(f"/{controller}/follow_joint_trajectory", {"trajectory": trajectory})


def point(seconds, positions, velocities=()):
    """Return a point of a trajectory: its time [s], positions [rad or m] and velocities [rad/s or m/s]."""
    time = {"sec": int(seconds), "nanosec": round(seconds % 1 * 1e9)}
    return {"time_from_start": time, "positions": list(positions), "velocities": list(velocities)}
