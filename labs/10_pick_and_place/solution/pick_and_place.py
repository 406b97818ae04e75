"""Pick up a block with a marker on its top, and place it elsewhere: a solution."""

from __future__ import annotations

import cv2
import numpy as np

from simkit import Pose, WorldPlugin, msgs

CAMERA, CAMERA_FRAME = "/head_front_camera/rgb", "head_front_camera_rgb_optical_frame"
BASE = "base_footprint"
MARKER, MARKER_WIDTH = 582, 0.06  # number in DICT_ARUCO_ORIGINAL; width of the black square [m]
BLOCK_HEIGHT = 0.10  # [m]
ABOVE = 0.12  # [m], the hand comes from so far above the grasp
DEPTH = 0.04  # [m], distance from the marker up to the grasping frame
TORSO, HEAD, FINGERS = ("torso_lift_joint",), ("head_1_joint", "head_2_joint"), ("gripper_right_finger_joint",)
OPEN, CLOSED = 0.045, 0.03  # position of a finger [m]; the block is 0.07 m wide


def find_marker(pixels, camera_matrix):
    """Return the pose of the marker in the optical frame of the camera; None if it is not in the picture.

    pixels: picture, shape (rows, columns, 3), red first.
    camera_matrix: K of the camera, shape (3, 3) [px].
    """
    parameters = cv2.aruco.DetectorParameters()
    parameters.cornerRefinementMethod = cv2.aruco.CORNER_REFINE_APRILTAG  # fits lines to the whole edges
    dictionary = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_ARUCO_ORIGINAL)
    grey = cv2.cvtColor(pixels, cv2.COLOR_RGB2GRAY)
    corners, numbers, _ = cv2.aruco.ArucoDetector(dictionary, parameters).detectMarkers(grey)
    if numbers is None or MARKER not in numbers:
        return None
    found = corners[list(numbers.ravel()).index(MARKER)][0]
    h = MARKER_WIDTH / 2
    square = np.array([[-h, h, 0], [h, h, 0], [h, -h, 0], [-h, -h, 0]])  # in the order of detectMarkers
    _, rotation, translation = cv2.solvePnP(square, found, camera_matrix, None, flags=cv2.SOLVEPNP_IPPE_SQUARE)
    return pose_of(cv2.Rodrigues(rotation)[0], translation.ravel())


def grasps_of(marker):
    """Return poses of the frame gripper_grasping_frame that grasp the block, the best first.

    marker: pose of the marker, in the same frame as the result; marker.matrix has its three axes as columns.
    """
    across, down = marker.matrix[:, 0], -marker.matrix[:, 2]  # the block is narrow along the x axis of its marker
    place = marker.position - DEPTH * down
    return [pose_of(np.column_stack([down, y, np.cross(down, y)]), place) for y in (across, -across)]


class PickAndPlace(WorldPlugin):
    before_step_rate = 20.0  # [Hz]

    def load(self, parent, params):
        x, y, yaw = params.vector3("place", required=True)
        height = params.number("table_height", required=True) + BLOCK_HEIGHT
        self.marker_goal = Pose.from_rpy(x, y, height, 0, 0, yaw)  # of the placed marker, in the frame of the base
        self.task, self.busy, self.steps, self.goals = "", False, [], []
        self.marker = self.grasp = self.camera = None
        self.status = self.advertise("/pick_and_place/status", "std_msgs/msg/String")
        self.marker_pose = self.advertise("/aruco_single/pose", "geometry_msgs/msg/PoseStamped")
        self.offer("/pick", "std_srvs/srv/Trigger", self.pick)
        self.offer("/place", "std_srvs/srv/Trigger", self.place)

    def pick(self, request):
        steps = [self.look, self.take_picture, self.see, self.rise, self.approach, self.close, self.rise_hand]
        return self.begin("pick", steps)

    def place(self, request):
        if self.grasp is None:
            return {"success": False, "message": "the hand has not grasped a block"}
        return self.begin("place", [self.bring, self.open, self.rise_hand])

    # ------------------------------------------------------------------ steps: each returns the goals that it has sent

    def look(self):
        head = self.move_joints("head", HEAD, [0.0, -0.9], 1.5)
        return [head, self.move_joints("torso", TORSO, [0.2], 4.0), *self.open()]

    def see(self):
        marker = find_marker(self.pixels, self.camera_matrix)
        if marker is None:
            return self.fail("the marker is not in the picture")
        self.marker = self.sim.tf.lookup(BASE, CAMERA_FRAME) @ marker
        header = msgs.header(self.sim.time_ns, BASE)
        self.marker_pose.publish(msgs.pose_message(self.marker, "geometry_msgs/msg/PoseStamped", header))
        return []

    def rise(self):
        return [self.move_joints("torso", TORSO, [0.34], 3.0)]

    def approach(self):
        return self.descend(grasps_of(self.marker))

    def bring(self):
        held = self.marker.inverse() @ self.grasp  # pose of the hand in the frame of the marker: constant in the grasp
        return self.descend([self.marker_goal @ held])

    def rise_hand(self):
        return [self.move_hand([raised(self.grasp)], straight=True)]

    def open(self):
        return [self.move_joints("gripper", FINGERS, [OPEN], 1.5)]

    def close(self):
        return [self.move_joints("gripper", FINGERS, [CLOSED], 1.5)]

    def descend(self, grasps):
        """Move the hand over the first of these poses that it reaches, and down to it."""
        reason = "there is no grasp"
        for grasp in grasps:
            poses = [raised(grasp), grasp]
            answer = self.sim.call("/arm/can_reach", {"poses": [msgs.pose_message(pose) for pose in poses]})
            if answer.success:
                self.grasp = grasp
                return [self.move_hand(poses)]
            reason = answer.message
        return self.fail(reason)

    # ------------------------------------------------------------------ given: steps one after another

    def begin(self, task, steps):
        """Start a task: a list of functions. Each returns a list of goals that must succeed before the next one."""
        if self.busy:
            return {"success": False, "message": f"the robot is busy: {self.task}"}
        self.task, self.busy, self.steps = task, True, list(steps)
        self.say("running")
        return {"success": True, "message": f"{task} begins"}

    def before_step(self):
        failed = [goal for goal in self.goals if goal.is_done and goal.status.name != "SUCCEEDED"]
        if failed:
            self.fail(f"a goal ended with {failed[0].status.name}: {failed[0].reason}")
        if not self.busy or not all(goal.is_done for goal in self.goals):
            return
        if self.steps:
            self.goals = self.steps.pop(0)()
        else:
            self.busy, self.goals = False, []
            self.say("done")

    def fail(self, reason):
        self.busy, self.steps, self.goals = False, [], []
        self.say(f"failed: {reason}")
        return []

    def say(self, text):
        self.status.publish({"data": f"{self.task} {text}"})

    def take_picture(self):
        """Store one picture as `pixels` (rows, columns, RGB), and the 3 x 3 matrix of the camera."""
        if self.camera is None:
            self.camera = [self.subscribe(f"{CAMERA}/{name}", keep=1) for name in ("image_raw", "camera_info")]
        image, info = (topic.latest for topic in self.camera)
        if image is None or info is None:
            self.steps.insert(0, self.take_picture)  # there is no picture yet: the same step again
            return []
        for topic in self.camera:
            topic.close()  # simkit draws pictures only while the topic has a subscriber
        self.camera, self.pixels = None, msgs.image(image)
        self.camera_matrix = np.array(info.k).reshape(3, 3)
        return []

    # ------------------------------------------------------------------ given: motions

    def move_joints(self, controller, joints, positions, seconds):
        """Send a goal to a trajectory controller: positions [rad or m] to be reached after a time [s]."""
        point = {"positions": positions, "time_from_start": {"sec": int(seconds), "nanosec": int(seconds % 1 * 1e9)}}
        trajectory = {"joint_names": joints, "points": [point]}
        return self.sim.send_goal(f"/{controller}_controller/follow_joint_trajectory", {"trajectory": trajectory})

    def move_hand(self, poses, straight=False):
        """Send a goal to the arm: poses of the frame gripper_grasping_frame in the frame of the base."""
        poses = [msgs.pose_message(pose) for pose in poses]
        return self.sim.send_goal("/arm/move_hand", {"poses": poses, "straight": straight})


def raised(pose):
    """Return a pose that is higher by ABOVE."""
    return Pose(pose.position + np.array([0, 0, ABOVE]), pose.quaternion)


def pose_of(rotation, position):
    """Return the simkit.Pose of a rotation matrix (3, 3) and a position [m]."""
    vector = cv2.Rodrigues(np.asarray(rotation, float))[0].ravel()  # axis times angle
    angle = np.linalg.norm(vector)
    return Pose(position, (np.cos(angle / 2), *(vector / 2 * np.sinc(angle / 2 / np.pi))))
