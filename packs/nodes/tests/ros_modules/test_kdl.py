"""Frames and chains of programs: `PyKDL`, `tf2_kdl` and, for ROS 1, `tf_conversions`."""

from __future__ import annotations

import copy
import math
import pickle
from collections.abc import Callable

import numpy as np
import pytest

from simkit_nodes.interfaces import ROS1
from simkit_nodes.ros1_modules.tf_conversions import posemath
from simkit_nodes.ros_modules import PyKDL
from simkit_nodes.ros_modules.PyKDL import Chain, Frame, JntArray, Joint, Rotation, Segment, Twist, Vector, Wrench

TURNS = [
    (0.3, -0.4, 2.0),
    (-3.0, 1.2, 0.1),
    (0.0, 0.0, 0.0),
    (math.pi, 0.0, 0.0),
    (0.0, math.pi, 0.0),
    (0.0, 0.0, math.pi),
]


@pytest.mark.parametrize("angles", TURNS)
def test_a_rotation_has_many_forms(angles: tuple[float, float, float]) -> None:
    turn = Rotation.RPY(*angles)
    assert Rotation.RPY(*turn.GetRPY()) == turn
    assert Rotation.EulerZYX(*turn.GetEulerZYX()) == turn
    assert Rotation.EulerZYZ(*turn.GetEulerZYZ()) == turn
    assert Rotation.Quaternion(*turn.GetQuaternion()) == turn
    angle, axis = turn.GetRotAngle()
    assert Rotation.Rot(axis, angle) == turn
    assert turn * turn.Inverse() == Rotation.Identity()
    assert Rotation(turn.UnitX(), turn.UnitY(), turn.UnitZ()) == turn


def test_a_pitch_of_90_degrees_has_no_roll() -> None:
    assert Rotation.RPY(0.4, math.pi / 2, 0.0).GetRPY() == pytest.approx((0.0, math.pi / 2, -0.4))


def test_vectors_are_added_multiplied_and_printed() -> None:
    a, b = Vector(1, 2, 3), Vector(0, 1, 0)
    assert a * b == Vector(-3, 0, 1)  # the cross product
    assert (PyKDL.dot(a, b), 2 * a, a / 2, -a) == (2.0, Vector(2, 4, 6), Vector(0.5, 1, 1.5), Vector(-1, -2, -3))
    a += b
    a.x(5)
    assert (a.x(), a[1], list(a)) == (5.0, 3.0, [5.0, 3.0, 3.0])
    assert repr(b) == "[           0,           1,           0]"
    assert Vector(0, 0, 2).Normalize() == 2.0
    PyKDL.SetToZero(a)
    assert a == Vector.Zero()
    with pytest.raises(IndexError, match="Vector index out of range"):
        a[3]


def test_frames_move_vectors_twists_and_wrenches() -> None:
    frame = Frame(Rotation.RotZ(math.pi / 2), Vector(1, 0, 0))
    assert frame * Vector(1, 0, 0) == Vector(1, 1, 0)
    assert frame.Inverse(frame * Vector(1, 2, 3)) == Vector(1, 2, 3)
    twist, wrench = Twist(Vector(1, 2, 3), Vector(0, 0, 1)), Wrench(Vector(3, 2, 1), Vector(1, 1, 1))
    assert frame * twist == Twist(Vector(-2, 0, 3), Vector(0, 0, 1))
    assert PyKDL.dot(frame * twist, frame * wrench) == pytest.approx(PyKDL.dot(twist, wrench))  # the power stays
    assert twist.RefPoint(Vector(1, 0, 0)).vel == Vector(1, 3, 3)
    other = Frame(Rotation.RPY(0.1, 0.2, 0.3), Vector(4, 5, 6))
    assert PyKDL.addDelta(frame, PyKDL.diff(frame, other)) == other
    assert pickle.loads(pickle.dumps(other)) == copy.deepcopy(other) == other
    frame.p.x(7)
    frame.M.DoRotZ(-math.pi / 2)
    assert frame == Frame(Vector(7, 0, 0))


def arm() -> Chain:
    chain = Chain()
    for number, kind in enumerate(
        (Joint.RotZ, Joint.RotY, Joint.RotY, Joint.RotZ, Joint.RotY, Joint.RotZ, Joint.Fixed)
    ):
        chain.addSegment(Segment(f"link_{number}", Joint(f"joint_{number}", kind), Frame(Vector(0.0, 0.0, 0.2))))
    return chain


def values(*numbers: float) -> JntArray:
    array = JntArray(len(numbers))
    for index, number in enumerate(numbers):
        array[index] = number
    return array


def test_the_solvers_of_an_arm_agree() -> None:
    chain, goal, jacobian = arm(), Frame(), PyKDL.Jacobian(6)
    forward = PyKDL.ChainFkSolverPos_recursive(chain)
    q = values(0.3, 0.4, 0.5, 0.6, 0.7, 0.8)
    assert forward.JntToCart(q, goal) == 0
    assert PyKDL.ChainJntToJacSolver(chain).JntToJac(q, jacobian) == 0
    for joint in range(6):
        moved, frame = JntArray(q), Frame()
        moved[joint] += 1e-6
        forward.JntToCart(moved, frame)
        assert PyKDL.Equal(PyKDL.diff(goal, frame, 1e-6), jacobian.getColumn(joint), 1e-5)
    velocities = PyKDL.ChainIkSolverVel_pinv(chain)
    low, high = values(*[-2.0] * 6), values(*[2.0] * 6)
    for solver in (
        PyKDL.ChainIkSolverPos_NR(chain, forward, velocities, 100, 1e-6),
        PyKDL.ChainIkSolverPos_NR_JL(chain, low, high, forward, velocities, 100, 1e-6),
        PyKDL.ChainIkSolverPos_LMA(chain),
    ):
        result, frame = JntArray(6), Frame()
        assert solver.CartToJnt(values(0.2, 0.3, 0.4, 0.5, 0.6, 0.7), goal, result) == 0
        forward.JntToCart(result, frame)
        assert PyKDL.Equal(frame, goal, 1e-4)
    assert forward.JntToCart(JntArray(2), goal) == forward.E_SIZE_MISMATCH


def test_a_tree_gives_the_chain_between_two_segments() -> None:
    tree = PyKDL.Tree("base")
    assert tree.addChain(arm(), "base")
    assert not tree.addSegment(Segment("hand"), "missing")
    assert [tree.getNrOfJoints(), tree.getChain("link_1", "link_4").getNrOfSegments()] == [6, 3]


def test_poses_of_ros_1_become_frames() -> None:
    frame = Frame(Rotation.RotZ(0.5), Vector(1, 2, 3))
    pose = posemath.toMsg(frame)
    assert type(pose) is ROS1.message_class("geometry_msgs/msg/Pose")
    assert posemath.fromMsg(pose) == posemath.fromTf(posemath.toTf(frame)) == frame
    assert posemath.fromMatrix(posemath.toMatrix(frame)) == frame
    assert posemath.fromCameraParams(None, np.array([0.0, 0.0, 0.5]), (1, 2, 3)) == frame


def test_a_buffer_moves_objects_of_kdl(run_program: Callable[..., list[str]]) -> None:
    texts = run_program(
        """
        import builtin_interfaces, PyKDL, rclpy, tf2_geometry_msgs, tf2_kdl, tf2_ros
        from geometry_msgs.msg import PointStamped, TransformStamped
        rclpy.init()
        node = rclpy.create_node("a")
        buffer = tf2_ros.Buffer()
        transform = TransformStamped()
        transform.header.frame_id, transform.child_frame_id = "map", "robot"
        transform.transform.translation.x = 2.0
        buffer.set_transform(transform, "a")
        point = tf2_ros.Stamped(PyKDL.Vector(1, 2, 3), builtin_interfaces.msg.Time(sec=0), "robot")
        moved = buffer.transform(point, "map")
        node.get_logger().info(f"{moved} {moved.header.frame_id}")
        message = tf2_ros.convert(moved, PointStamped)
        node.get_logger().info(f"{message.point.x} {message.header.frame_id}")
        node.get_logger().info(f"{tf2_ros.convert(message, PyKDL.Vector).x()}")
        node.get_logger().info(f"{type(moved).__module__}")
        """
    )
    assert texts == ["[           3,           2,           3] map", "3.0 map", "3.0", "PyKDL.frames"]
