# Written by `python -m simkit.msgs.message_class_stubs`; a test compares it with the definitions.
# ruff: noqa
# fmt: off
"""Fields of every message class: `from simkit.msgs import LaserScan`."""

from dataclasses import dataclass
from typing import ClassVar, Generic, type_check_only

import numpy as np
from numpy.typing import NDArray

from simkit.msgs.message_types import F, M, R

@type_check_only
class ServiceRequest(Generic[M, R]):
    """Request of the class `M`, to which a response of the class `R` belongs. No message has this base at run time."""

@type_check_only
class ActionGoal(Generic[M, R, F]):
    """Goal of the class `M`, with results of the class `R` and feedback of the class `F`. Not a base at run time."""

# ackermann_msgs

@dataclass
class AckermannDrive:
    """`ackermann_msgs/msg/AckermannDrive`"""
    steering_angle: float
    steering_angle_velocity: float
    speed: float
    acceleration: float
    jerk: float
    __msgtype__: ClassVar[str]

@dataclass
class AckermannDriveStamped:
    """`ackermann_msgs/msg/AckermannDriveStamped`"""
    header: Header
    drive: AckermannDrive
    __msgtype__: ClassVar[str]

# action_msgs

@dataclass
class GoalInfo:
    """`action_msgs/msg/GoalInfo`"""
    goal_id: UUID
    stamp: Time
    __msgtype__: ClassVar[str]

@dataclass
class action_msgs__msg__GoalStatus:
    """`action_msgs/msg/GoalStatus`"""
    goal_info: GoalInfo
    status: int
    STATUS_UNKNOWN: ClassVar[int] = 0
    STATUS_ACCEPTED: ClassVar[int] = 1
    STATUS_EXECUTING: ClassVar[int] = 2
    STATUS_CANCELING: ClassVar[int] = 3
    STATUS_SUCCEEDED: ClassVar[int] = 4
    STATUS_CANCELED: ClassVar[int] = 5
    STATUS_ABORTED: ClassVar[int] = 6
    __msgtype__: ClassVar[str]

@dataclass
class action_msgs__msg__GoalStatusArray:
    """`action_msgs/msg/GoalStatusArray`"""
    status_list: list[action_msgs__msg__GoalStatus]
    __msgtype__: ClassVar[str]

@dataclass
class CancelGoal_Request(ServiceRequest[CancelGoal_Request, CancelGoal_Response]):
    """`action_msgs/srv/CancelGoal_Request`"""
    goal_info: GoalInfo
    __msgtype__: ClassVar[str]

@dataclass
class CancelGoal_Response:
    """`action_msgs/srv/CancelGoal_Response`"""
    return_code: int
    goals_canceling: list[GoalInfo]
    ERROR_NONE: ClassVar[int] = 0
    ERROR_REJECTED: ClassVar[int] = 1
    ERROR_UNKNOWN_GOAL_ID: ClassVar[int] = 2
    ERROR_GOAL_TERMINATED: ClassVar[int] = 3
    __msgtype__: ClassVar[str]

# action_tutorials_interfaces

@dataclass
class action_tutorials_interfaces__action__Fibonacci_Feedback:
    """`action_tutorials_interfaces/action/Fibonacci_Feedback`"""
    partial_sequence: NDArray[np.int32]
    __msgtype__: ClassVar[str]

@dataclass
class action_tutorials_interfaces__action__Fibonacci_Goal(ActionGoal[action_tutorials_interfaces__action__Fibonacci_Goal, action_tutorials_interfaces__action__Fibonacci_Result, action_tutorials_interfaces__action__Fibonacci_Feedback]):
    """`action_tutorials_interfaces/action/Fibonacci_Goal`"""
    order: int
    __msgtype__: ClassVar[str]

@dataclass
class action_tutorials_interfaces__action__Fibonacci_Result:
    """`action_tutorials_interfaces/action/Fibonacci_Result`"""
    sequence: NDArray[np.int32]
    __msgtype__: ClassVar[str]

# actionlib

@dataclass
class TestRequest_Feedback:
    """`actionlib/action/TestRequest_Feedback`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class TestRequest_Goal(ActionGoal[TestRequest_Goal, TestRequest_Result, TestRequest_Feedback]):
    """`actionlib/action/TestRequest_Goal`"""
    terminate_status: int
    ignore_cancel: bool
    result_text: str
    the_result: int
    is_simple_client: bool
    delay_accept: Duration
    delay_terminate: Duration
    pause_status: Duration
    TERMINATE_SUCCESS: ClassVar[int] = 0
    TERMINATE_ABORTED: ClassVar[int] = 1
    TERMINATE_REJECTED: ClassVar[int] = 2
    TERMINATE_LOSE: ClassVar[int] = 3
    TERMINATE_DROP: ClassVar[int] = 4
    TERMINATE_EXCEPTION: ClassVar[int] = 5
    __msgtype__: ClassVar[str]

@dataclass
class TestRequest_Result:
    """`actionlib/action/TestRequest_Result`"""
    the_result: int
    is_simple_server: bool
    __msgtype__: ClassVar[str]

@dataclass
class Test_Feedback:
    """`actionlib/action/Test_Feedback`"""
    feedback: int
    __msgtype__: ClassVar[str]

@dataclass
class Test_Goal(ActionGoal[Test_Goal, Test_Result, Test_Feedback]):
    """`actionlib/action/Test_Goal`"""
    goal: int
    __msgtype__: ClassVar[str]

@dataclass
class Test_Result:
    """`actionlib/action/Test_Result`"""
    result: int
    __msgtype__: ClassVar[str]

@dataclass
class TwoInts_Feedback:
    """`actionlib/action/TwoInts_Feedback`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class TwoInts_Goal(ActionGoal[TwoInts_Goal, TwoInts_Result, TwoInts_Feedback]):
    """`actionlib/action/TwoInts_Goal`"""
    a: int
    b: int
    __msgtype__: ClassVar[str]

@dataclass
class TwoInts_Result:
    """`actionlib/action/TwoInts_Result`"""
    sum: int
    __msgtype__: ClassVar[str]

# actionlib_msgs

@dataclass
class GoalID:
    """`actionlib_msgs/msg/GoalID`"""
    stamp: Time
    id: str
    __msgtype__: ClassVar[str]

@dataclass
class actionlib_msgs__msg__GoalStatus:
    """`actionlib_msgs/msg/GoalStatus`"""
    goal_id: GoalID
    status: int
    text: str
    PENDING: ClassVar[int] = 0
    ACTIVE: ClassVar[int] = 1
    PREEMPTED: ClassVar[int] = 2
    SUCCEEDED: ClassVar[int] = 3
    ABORTED: ClassVar[int] = 4
    REJECTED: ClassVar[int] = 5
    PREEMPTING: ClassVar[int] = 6
    RECALLING: ClassVar[int] = 7
    RECALLED: ClassVar[int] = 8
    LOST: ClassVar[int] = 9
    __msgtype__: ClassVar[str]

@dataclass
class actionlib_msgs__msg__GoalStatusArray:
    """`actionlib_msgs/msg/GoalStatusArray`"""
    header: Header
    status_list: list[actionlib_msgs__msg__GoalStatus]
    __msgtype__: ClassVar[str]

# actionlib_tutorials

@dataclass
class Averaging_Feedback:
    """`actionlib_tutorials/action/Averaging_Feedback`"""
    sample: int
    data: float
    mean: float
    std_dev: float
    __msgtype__: ClassVar[str]

@dataclass
class Averaging_Goal(ActionGoal[Averaging_Goal, Averaging_Result, Averaging_Feedback]):
    """`actionlib_tutorials/action/Averaging_Goal`"""
    samples: int
    __msgtype__: ClassVar[str]

@dataclass
class Averaging_Result:
    """`actionlib_tutorials/action/Averaging_Result`"""
    mean: float
    std_dev: float
    __msgtype__: ClassVar[str]

@dataclass
class actionlib_tutorials__action__Fibonacci_Feedback:
    """`actionlib_tutorials/action/Fibonacci_Feedback`"""
    sequence: NDArray[np.int32]
    __msgtype__: ClassVar[str]

@dataclass
class actionlib_tutorials__action__Fibonacci_Goal(ActionGoal[actionlib_tutorials__action__Fibonacci_Goal, actionlib_tutorials__action__Fibonacci_Result, actionlib_tutorials__action__Fibonacci_Feedback]):
    """`actionlib_tutorials/action/Fibonacci_Goal`"""
    order: int
    __msgtype__: ClassVar[str]

@dataclass
class actionlib_tutorials__action__Fibonacci_Result:
    """`actionlib_tutorials/action/Fibonacci_Result`"""
    sequence: NDArray[np.int32]
    __msgtype__: ClassVar[str]

# actuator_msgs

@dataclass
class Actuators:
    """`actuator_msgs/msg/Actuators`"""
    header: Header
    position: NDArray[np.float64]
    velocity: NDArray[np.float64]
    normalized: NDArray[np.float64]
    __msgtype__: ClassVar[str]

# apriltag_msgs

@dataclass
class AprilTagDetection:
    """`apriltag_msgs/msg/AprilTagDetection`"""
    family: str
    id: int
    hamming: int
    goodness: float
    decision_margin: float
    centre: apriltag_msgs__msg__Point
    corners: list[apriltag_msgs__msg__Point]
    homography: NDArray[np.float64]
    __msgtype__: ClassVar[str]

@dataclass
class AprilTagDetectionArray:
    """`apriltag_msgs/msg/AprilTagDetectionArray`"""
    header: Header
    detections: list[AprilTagDetection]
    __msgtype__: ClassVar[str]

@dataclass
class apriltag_msgs__msg__Point:
    """`apriltag_msgs/msg/Point`"""
    x: float
    y: float
    __msgtype__: ClassVar[str]

# aruco_msgs

@dataclass
class aruco_msgs__msg__Marker:
    """`aruco_msgs/msg/Marker`"""
    header: Header
    id: int
    pose: PoseWithCovariance
    confidence: float
    __msgtype__: ClassVar[str]

@dataclass
class aruco_msgs__msg__MarkerArray:
    """`aruco_msgs/msg/MarkerArray`"""
    header: Header
    markers: list[aruco_msgs__msg__Marker]
    __msgtype__: ClassVar[str]

# baxter_core_msgs

@dataclass
class AssemblyState:
    """`baxter_core_msgs/msg/AssemblyState`"""
    ready: bool
    enabled: bool
    stopped: bool
    error: bool
    estop_button: int
    estop_source: int
    ESTOP_BUTTON_UNPRESSED: ClassVar[int] = 0
    ESTOP_BUTTON_PRESSED: ClassVar[int] = 1
    ESTOP_BUTTON_UNKNOWN: ClassVar[int] = 2
    ESTOP_BUTTON_RELEASED: ClassVar[int] = 3
    ESTOP_SOURCE_NONE: ClassVar[int] = 0
    ESTOP_SOURCE_USER: ClassVar[int] = 1
    ESTOP_SOURCE_UNKNOWN: ClassVar[int] = 2
    ESTOP_SOURCE_FAULT: ClassVar[int] = 3
    ESTOP_SOURCE_BRAIN: ClassVar[int] = 4
    __msgtype__: ClassVar[str]

@dataclass
class EndEffectorCommand:
    """`baxter_core_msgs/msg/EndEffectorCommand`"""
    id: int
    command: str
    args: str
    sender: str
    sequence: int
    CMD_NO_OP: ClassVar[str] = 'no_op'
    CMD_SET: ClassVar[str] = 'set'
    CMD_CONFIGURE: ClassVar[str] = 'configure'
    CMD_REBOOT: ClassVar[str] = 'reboot'
    CMD_RESET: ClassVar[str] = 'reset'
    CMD_CALIBRATE: ClassVar[str] = 'calibrate'
    CMD_CLEAR_CALIBRATION: ClassVar[str] = 'clear_calibration'
    CMD_PREPARE_TO_GRIP: ClassVar[str] = 'prepare_to_grip'
    CMD_GRIP: ClassVar[str] = 'grip'
    CMD_RELEASE: ClassVar[str] = 'release'
    CMD_GO: ClassVar[str] = 'go'
    CMD_STOP: ClassVar[str] = 'stop'
    __msgtype__: ClassVar[str]

@dataclass
class EndEffectorProperties:
    """`baxter_core_msgs/msg/EndEffectorProperties`"""
    id: int
    ui_type: int
    manufacturer: str
    product: str
    serial_number: str
    hardware_rev: str
    firmware_rev: str
    firmware_date: str
    has_calibration: bool
    controls_grip: bool
    senses_grip: bool
    reverses_grip: bool
    controls_force: bool
    senses_force: bool
    controls_position: bool
    senses_position: bool
    properties: str
    NO_GRIPPER: ClassVar[int] = 0
    SUCTION_CUP_GRIPPER: ClassVar[int] = 1
    ELECTRIC_GRIPPER: ClassVar[int] = 2
    PASSIVE_GRIPPER: ClassVar[int] = 3
    __msgtype__: ClassVar[str]

@dataclass
class EndEffectorState:
    """`baxter_core_msgs/msg/EndEffectorState`"""
    timestamp: Time
    id: int
    enabled: int
    calibrated: int
    ready: int
    moving: int
    gripping: int
    missed: int
    error: int
    reverse: int
    position: float
    force: float
    state: str
    command: str
    command_sender: str
    command_sequence: int
    STATE_FALSE: ClassVar[int] = 0
    STATE_TRUE: ClassVar[int] = 1
    STATE_UNKNOWN: ClassVar[int] = 2
    POSITION_CLOSED: ClassVar[float] = 0.0
    POSITION_OPEN: ClassVar[float] = 100.0
    FORCE_MIN: ClassVar[float] = 0.0
    FORCE_MAX: ClassVar[float] = 100.0
    __msgtype__: ClassVar[str]

@dataclass
class EndpointState:
    """`baxter_core_msgs/msg/EndpointState`"""
    header: Header
    pose: Pose
    twist: Twist
    wrench: Wrench
    __msgtype__: ClassVar[str]

@dataclass
class HeadPanCommand:
    """`baxter_core_msgs/msg/HeadPanCommand`"""
    target: float
    speed_ratio: float
    enable_pan_request: int
    MAX_SPEED_RATIO: ClassVar[float] = 1.0
    MIN_SPEED_RATIO: ClassVar[float] = 0.0
    REQUEST_PAN_DISABLE: ClassVar[int] = 0
    REQUEST_PAN_ENABLE: ClassVar[int] = 1
    REQUEST_PAN_VOID: ClassVar[int] = 2
    __msgtype__: ClassVar[str]

@dataclass
class HeadState:
    """`baxter_core_msgs/msg/HeadState`"""
    pan: float
    is_turning: bool
    is_nodding: bool
    is_pan_enabled: bool
    __msgtype__: ClassVar[str]

@dataclass
class JointCommand:
    """`baxter_core_msgs/msg/JointCommand`"""
    mode: int
    command: NDArray[np.float64]
    names: list[str]
    POSITION_MODE: ClassVar[int] = 1
    VELOCITY_MODE: ClassVar[int] = 2
    TORQUE_MODE: ClassVar[int] = 3
    RAW_POSITION_MODE: ClassVar[int] = 4
    __msgtype__: ClassVar[str]

@dataclass
class SEAJointState:
    """`baxter_core_msgs/msg/SEAJointState`"""
    header: Header
    name: list[str]
    commanded_position: NDArray[np.float64]
    commanded_velocity: NDArray[np.float64]
    commanded_acceleration: NDArray[np.float64]
    commanded_effort: NDArray[np.float64]
    actual_position: NDArray[np.float64]
    actual_velocity: NDArray[np.float64]
    actual_effort: NDArray[np.float64]
    gravity_model_effort: NDArray[np.float64]
    gravity_only: NDArray[np.float64]
    hysteresis_model_effort: NDArray[np.float64]
    crosstalk_model_effort: NDArray[np.float64]
    hyst_state: float
    __msgtype__: ClassVar[str]

@dataclass
class SolvePositionIK_Request(ServiceRequest[SolvePositionIK_Request, SolvePositionIK_Response]):
    """`baxter_core_msgs/srv/SolvePositionIK_Request`"""
    pose_stamp: list[PoseStamped]
    seed_angles: list[JointState]
    seed_mode: int
    SEED_AUTO: ClassVar[int] = 0
    SEED_USER: ClassVar[int] = 1
    SEED_CURRENT: ClassVar[int] = 2
    SEED_NS_MAP: ClassVar[int] = 3
    __msgtype__: ClassVar[str]

@dataclass
class SolvePositionIK_Response:
    """`baxter_core_msgs/srv/SolvePositionIK_Response`"""
    joints: list[JointState]
    is_valid: NDArray[np.bool_]
    result_type: NDArray[np.uint8]
    RESULT_INVALID: ClassVar[int] = 0
    __msgtype__: ClassVar[str]

# builtin_interfaces

@dataclass
class Duration:
    """`builtin_interfaces/msg/Duration`"""
    sec: int
    nanosec: int
    __msgtype__: ClassVar[str]

@dataclass
class Time:
    """`builtin_interfaces/msg/Time`"""
    sec: int
    nanosec: int
    __msgtype__: ClassVar[str]

# control_msgs

@dataclass
class FollowJointTrajectory_Feedback:
    """`control_msgs/action/FollowJointTrajectory_Feedback`"""
    header: Header
    joint_names: list[str]
    desired: JointTrajectoryPoint
    actual: JointTrajectoryPoint
    error: JointTrajectoryPoint
    multi_dof_joint_names: list[str]
    multi_dof_desired: MultiDOFJointTrajectoryPoint
    multi_dof_actual: MultiDOFJointTrajectoryPoint
    multi_dof_error: MultiDOFJointTrajectoryPoint
    __msgtype__: ClassVar[str]

@dataclass
class FollowJointTrajectory_Goal(ActionGoal[FollowJointTrajectory_Goal, FollowJointTrajectory_Result, FollowJointTrajectory_Feedback]):
    """`control_msgs/action/FollowJointTrajectory_Goal`"""
    trajectory: JointTrajectory
    multi_dof_trajectory: MultiDOFJointTrajectory
    path_tolerance: list[JointTolerance]
    component_path_tolerance: list[JointComponentTolerance]
    goal_tolerance: list[JointTolerance]
    component_goal_tolerance: list[JointComponentTolerance]
    goal_time_tolerance: Duration
    __msgtype__: ClassVar[str]

@dataclass
class FollowJointTrajectory_Result:
    """`control_msgs/action/FollowJointTrajectory_Result`"""
    error_code: int
    error_string: str
    SUCCESSFUL: ClassVar[int] = 0
    INVALID_GOAL: ClassVar[int] = -1
    INVALID_JOINTS: ClassVar[int] = -2
    OLD_HEADER_TIMESTAMP: ClassVar[int] = -3
    PATH_TOLERANCE_VIOLATED: ClassVar[int] = -4
    GOAL_TOLERANCE_VIOLATED: ClassVar[int] = -5
    __msgtype__: ClassVar[str]

@dataclass
class GripperCommand_Feedback:
    """`control_msgs/action/GripperCommand_Feedback`"""
    position: float
    effort: float
    stalled: bool
    reached_goal: bool
    __msgtype__: ClassVar[str]

@dataclass
class GripperCommand_Goal(ActionGoal[GripperCommand_Goal, GripperCommand_Result, GripperCommand_Feedback]):
    """`control_msgs/action/GripperCommand_Goal`"""
    command: GripperCommand
    __msgtype__: ClassVar[str]

@dataclass
class GripperCommand_Result:
    """`control_msgs/action/GripperCommand_Result`"""
    position: float
    effort: float
    stalled: bool
    reached_goal: bool
    __msgtype__: ClassVar[str]

@dataclass
class JointTrajectory_Feedback:
    """`control_msgs/action/JointTrajectory_Feedback`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class JointTrajectory_Goal(ActionGoal[JointTrajectory_Goal, JointTrajectory_Result, JointTrajectory_Feedback]):
    """`control_msgs/action/JointTrajectory_Goal`"""
    trajectory: JointTrajectory
    __msgtype__: ClassVar[str]

@dataclass
class JointTrajectory_Result:
    """`control_msgs/action/JointTrajectory_Result`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class ParallelGripperCommand_Feedback:
    """`control_msgs/action/ParallelGripperCommand_Feedback`"""
    state: JointState
    __msgtype__: ClassVar[str]

@dataclass
class ParallelGripperCommand_Goal(ActionGoal[ParallelGripperCommand_Goal, ParallelGripperCommand_Result, ParallelGripperCommand_Feedback]):
    """`control_msgs/action/ParallelGripperCommand_Goal`"""
    command: JointState
    __msgtype__: ClassVar[str]

@dataclass
class ParallelGripperCommand_Result:
    """`control_msgs/action/ParallelGripperCommand_Result`"""
    state: JointState
    stalled: bool
    reached_goal: bool
    __msgtype__: ClassVar[str]

@dataclass
class PointHead_Feedback:
    """`control_msgs/action/PointHead_Feedback`"""
    pointing_angle_error: float
    __msgtype__: ClassVar[str]

@dataclass
class PointHead_Goal(ActionGoal[PointHead_Goal, PointHead_Result, PointHead_Feedback]):
    """`control_msgs/action/PointHead_Goal`"""
    target: PointStamped
    pointing_axis: Vector3
    pointing_frame: str
    min_duration: Duration
    max_velocity: float
    __msgtype__: ClassVar[str]

@dataclass
class PointHead_Result:
    """`control_msgs/action/PointHead_Result`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class SingleJointPosition_Feedback:
    """`control_msgs/action/SingleJointPosition_Feedback`"""
    header: Header
    position: float
    velocity: float
    error: float
    __msgtype__: ClassVar[str]

@dataclass
class SingleJointPosition_Goal(ActionGoal[SingleJointPosition_Goal, SingleJointPosition_Result, SingleJointPosition_Feedback]):
    """`control_msgs/action/SingleJointPosition_Goal`"""
    position: float
    min_duration: Duration
    max_velocity: float
    __msgtype__: ClassVar[str]

@dataclass
class SingleJointPosition_Result:
    """`control_msgs/action/SingleJointPosition_Result`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class AdmittanceControllerState:
    """`control_msgs/msg/AdmittanceControllerState`"""
    mass: Float64MultiArray
    damping: Float64MultiArray
    stiffness: Float64MultiArray
    rot_base_control: Quaternion
    ref_trans_base_ft: TransformStamped
    selected_axes: Int8MultiArray
    ft_sensor_frame: String
    admittance_position: TransformStamped
    admittance_acceleration: TwistStamped
    admittance_velocity: TwistStamped
    wrench_base: WrenchStamped
    joint_state: JointState
    __msgtype__: ClassVar[str]

@dataclass
class DynamicInterfaceGroupValues:
    """`control_msgs/msg/DynamicInterfaceGroupValues`"""
    header: Header
    interface_groups: list[str]
    interface_values: list[InterfaceValue]
    __msgtype__: ClassVar[str]

@dataclass
class DynamicInterfaceValues:
    """`control_msgs/msg/DynamicInterfaceValues`"""
    header: Header
    states: InterfaceValue
    commands: InterfaceValue
    __msgtype__: ClassVar[str]

@dataclass
class DynamicJointState:
    """`control_msgs/msg/DynamicJointState`"""
    header: Header
    joint_names: list[str]
    interface_values: list[InterfaceValue]
    __msgtype__: ClassVar[str]

@dataclass
class GripperCommand:
    """`control_msgs/msg/GripperCommand`"""
    position: float
    max_effort: float
    __msgtype__: ClassVar[str]

@dataclass
class InterfaceValue:
    """`control_msgs/msg/InterfaceValue`"""
    interface_names: list[str]
    values: NDArray[np.float64]
    __msgtype__: ClassVar[str]

@dataclass
class JointComponentTolerance:
    """`control_msgs/msg/JointComponentTolerance`"""
    joint_name: str
    component: int
    position: float
    velocity: float
    acceleration: float
    X_AXIS: ClassVar[int] = 1
    Y_AXIS: ClassVar[int] = 2
    Z_AXIS: ClassVar[int] = 3
    TRANSLATION: ClassVar[int] = 4
    ROTATION: ClassVar[int] = 5
    __msgtype__: ClassVar[str]

@dataclass
class JointControllerState:
    """`control_msgs/msg/JointControllerState`"""
    header: Header
    set_point: float
    process_value: float
    process_value_dot: float
    error: float
    time_step: float
    command: float
    p: float
    i: float
    d: float
    i_clamp: float
    antiwindup: bool
    __msgtype__: ClassVar[str]

@dataclass
class JointJog:
    """`control_msgs/msg/JointJog`"""
    header: Header
    joint_names: list[str]
    displacements: NDArray[np.float64]
    velocities: NDArray[np.float64]
    duration: float
    __msgtype__: ClassVar[str]

@dataclass
class JointTolerance:
    """`control_msgs/msg/JointTolerance`"""
    name: str
    position: float
    velocity: float
    acceleration: float
    __msgtype__: ClassVar[str]

@dataclass
class JointTrajectoryControllerState:
    """`control_msgs/msg/JointTrajectoryControllerState`"""
    header: Header
    joint_names: list[str]
    reference: JointTrajectoryPoint
    feedback: JointTrajectoryPoint
    error: JointTrajectoryPoint
    output: JointTrajectoryPoint
    multi_dof_joint_names: list[str]
    multi_dof_reference: MultiDOFJointTrajectoryPoint
    multi_dof_feedback: MultiDOFJointTrajectoryPoint
    multi_dof_error: MultiDOFJointTrajectoryPoint
    multi_dof_output: MultiDOFJointTrajectoryPoint
    speed_scaling_factor: float
    __msgtype__: ClassVar[str]

@dataclass
class MecanumDriveControllerState:
    """`control_msgs/msg/MecanumDriveControllerState`"""
    header: Header
    front_left_wheel_velocity: float
    back_left_wheel_velocity: float
    back_right_wheel_velocity: float
    front_right_wheel_velocity: float
    reference_velocity: Twist
    __msgtype__: ClassVar[str]

@dataclass
class MultiDOFCommand:
    """`control_msgs/msg/MultiDOFCommand`"""
    dof_names: list[str]
    values: NDArray[np.float64]
    values_dot: NDArray[np.float64]
    __msgtype__: ClassVar[str]

@dataclass
class MultiDOFStateStamped:
    """`control_msgs/msg/MultiDOFStateStamped`"""
    header: Header
    dof_states: list[SingleDOFState]
    __msgtype__: ClassVar[str]

@dataclass
class PidState:
    """`control_msgs/msg/PidState`"""
    header: Header
    timestep: Duration
    error: float
    error_dot: float
    i_term: float
    p_gain: float
    i_gain: float
    d_gain: float
    output: float
    __msgtype__: ClassVar[str]

@dataclass
class SingleDOFState:
    """`control_msgs/msg/SingleDOFState`"""
    name: str
    reference: float
    feedback: float
    feedback_dot: float
    error: float
    error_dot: float
    time_step: float
    output: float
    __msgtype__: ClassVar[str]

@dataclass
class SingleDOFStateStamped:
    """`control_msgs/msg/SingleDOFStateStamped`"""
    header: Header
    dof_state: SingleDOFState
    __msgtype__: ClassVar[str]

@dataclass
class SpeedScalingFactor:
    """`control_msgs/msg/SpeedScalingFactor`"""
    factor: float
    __msgtype__: ClassVar[str]

@dataclass
class SteeringControllerStatus:
    """`control_msgs/msg/SteeringControllerStatus`"""
    header: Header
    traction_wheels_position: NDArray[np.float64]
    traction_wheels_velocity: NDArray[np.float64]
    steer_positions: NDArray[np.float64]
    traction_command: NDArray[np.float64]
    steering_angle_command: NDArray[np.float64]
    __msgtype__: ClassVar[str]

@dataclass
class QueryCalibrationState_Request(ServiceRequest[QueryCalibrationState_Request, QueryCalibrationState_Response]):
    """`control_msgs/srv/QueryCalibrationState_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class QueryCalibrationState_Response:
    """`control_msgs/srv/QueryCalibrationState_Response`"""
    is_calibrated: bool
    __msgtype__: ClassVar[str]

@dataclass
class QueryTrajectoryState_Request(ServiceRequest[QueryTrajectoryState_Request, QueryTrajectoryState_Response]):
    """`control_msgs/srv/QueryTrajectoryState_Request`"""
    time: Time
    __msgtype__: ClassVar[str]

@dataclass
class QueryTrajectoryState_Response:
    """`control_msgs/srv/QueryTrajectoryState_Response`"""
    success: bool
    message: str
    name: list[str]
    position: NDArray[np.float64]
    velocity: NDArray[np.float64]
    acceleration: NDArray[np.float64]
    __msgtype__: ClassVar[str]

# controller_manager_msgs

@dataclass
class ChainConnection:
    """`controller_manager_msgs/msg/ChainConnection`"""
    name: str
    reference_interfaces: list[str]
    __msgtype__: ClassVar[str]

@dataclass
class ControllerState:
    """`controller_manager_msgs/msg/ControllerState`"""
    name: str
    state: str
    type: str
    claimed_interfaces: list[str]
    required_command_interfaces: list[str]
    required_state_interfaces: list[str]
    is_chainable: bool
    is_chained: bool
    reference_interfaces: list[str]
    chain_connections: list[ChainConnection]
    __msgtype__: ClassVar[str]

@dataclass
class HardwareComponentState:
    """`controller_manager_msgs/msg/HardwareComponentState`"""
    name: str
    type: str
    class_type: str
    state: State
    command_interfaces: list[HardwareInterface]
    state_interfaces: list[HardwareInterface]
    __msgtype__: ClassVar[str]

@dataclass
class HardwareInterface:
    """`controller_manager_msgs/msg/HardwareInterface`"""
    name: str
    is_available: bool
    is_claimed: bool
    __msgtype__: ClassVar[str]

@dataclass
class ConfigureController_Request(ServiceRequest[ConfigureController_Request, ConfigureController_Response]):
    """`controller_manager_msgs/srv/ConfigureController_Request`"""
    name: str
    __msgtype__: ClassVar[str]

@dataclass
class ConfigureController_Response:
    """`controller_manager_msgs/srv/ConfigureController_Response`"""
    ok: bool
    __msgtype__: ClassVar[str]

@dataclass
class ListControllerTypes_Request(ServiceRequest[ListControllerTypes_Request, ListControllerTypes_Response]):
    """`controller_manager_msgs/srv/ListControllerTypes_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class ListControllerTypes_Response:
    """`controller_manager_msgs/srv/ListControllerTypes_Response`"""
    types: list[str]
    base_classes: list[str]
    __msgtype__: ClassVar[str]

@dataclass
class ListControllers_Request(ServiceRequest[ListControllers_Request, ListControllers_Response]):
    """`controller_manager_msgs/srv/ListControllers_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class ListControllers_Response:
    """`controller_manager_msgs/srv/ListControllers_Response`"""
    controller: list[ControllerState]
    __msgtype__: ClassVar[str]

@dataclass
class ListHardwareComponents_Request(ServiceRequest[ListHardwareComponents_Request, ListHardwareComponents_Response]):
    """`controller_manager_msgs/srv/ListHardwareComponents_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class ListHardwareComponents_Response:
    """`controller_manager_msgs/srv/ListHardwareComponents_Response`"""
    component: list[HardwareComponentState]
    __msgtype__: ClassVar[str]

@dataclass
class ListHardwareInterfaces_Request(ServiceRequest[ListHardwareInterfaces_Request, ListHardwareInterfaces_Response]):
    """`controller_manager_msgs/srv/ListHardwareInterfaces_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class ListHardwareInterfaces_Response:
    """`controller_manager_msgs/srv/ListHardwareInterfaces_Response`"""
    command_interfaces: list[HardwareInterface]
    state_interfaces: list[HardwareInterface]
    __msgtype__: ClassVar[str]

@dataclass
class LoadController_Request(ServiceRequest[LoadController_Request, LoadController_Response]):
    """`controller_manager_msgs/srv/LoadController_Request`"""
    name: str
    __msgtype__: ClassVar[str]

@dataclass
class LoadController_Response:
    """`controller_manager_msgs/srv/LoadController_Response`"""
    ok: bool
    __msgtype__: ClassVar[str]

@dataclass
class ReloadControllerLibraries_Request(ServiceRequest[ReloadControllerLibraries_Request, ReloadControllerLibraries_Response]):
    """`controller_manager_msgs/srv/ReloadControllerLibraries_Request`"""
    force_kill: bool
    __msgtype__: ClassVar[str]

@dataclass
class ReloadControllerLibraries_Response:
    """`controller_manager_msgs/srv/ReloadControllerLibraries_Response`"""
    ok: bool
    __msgtype__: ClassVar[str]

@dataclass
class SetHardwareComponentState_Request(ServiceRequest[SetHardwareComponentState_Request, SetHardwareComponentState_Response]):
    """`controller_manager_msgs/srv/SetHardwareComponentState_Request`"""
    name: str
    target_state: State
    __msgtype__: ClassVar[str]

@dataclass
class SetHardwareComponentState_Response:
    """`controller_manager_msgs/srv/SetHardwareComponentState_Response`"""
    ok: bool
    state: State
    __msgtype__: ClassVar[str]

@dataclass
class SwitchController_Request(ServiceRequest[SwitchController_Request, SwitchController_Response]):
    """`controller_manager_msgs/srv/SwitchController_Request`"""
    activate_controllers: list[str]
    deactivate_controllers: list[str]
    start_controllers: list[str]
    stop_controllers: list[str]
    strictness: int
    start_asap: bool
    activate_asap: bool
    timeout: Duration
    BEST_EFFORT: ClassVar[int] = 1
    STRICT: ClassVar[int] = 2
    __msgtype__: ClassVar[str]

@dataclass
class SwitchController_Response:
    """`controller_manager_msgs/srv/SwitchController_Response`"""
    ok: bool
    __msgtype__: ClassVar[str]

@dataclass
class UnloadController_Request(ServiceRequest[UnloadController_Request, UnloadController_Response]):
    """`controller_manager_msgs/srv/UnloadController_Request`"""
    name: str
    __msgtype__: ClassVar[str]

@dataclass
class UnloadController_Response:
    """`controller_manager_msgs/srv/UnloadController_Response`"""
    ok: bool
    __msgtype__: ClassVar[str]

# conveyorbelt_msgs

@dataclass
class ConveyorBeltState:
    """`conveyorbelt_msgs/msg/ConveyorBeltState`"""
    power: float
    enabled: bool
    __msgtype__: ClassVar[str]

@dataclass
class ConveyorBeltControl_Request(ServiceRequest[ConveyorBeltControl_Request, ConveyorBeltControl_Response]):
    """`conveyorbelt_msgs/srv/ConveyorBeltControl_Request`"""
    power: float
    __msgtype__: ClassVar[str]

@dataclass
class ConveyorBeltControl_Response:
    """`conveyorbelt_msgs/srv/ConveyorBeltControl_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

# dave_gazebo_ros_plugins

@dataclass
class StratifiedCurrentDatabase:
    """`dave_gazebo_ros_plugins/msg/StratifiedCurrentDatabase`"""
    depths: NDArray[np.float32]
    velocities: list[Vector3]
    time_gmt_year: NDArray[np.int16]
    time_gmt_month: NDArray[np.int16]
    time_gmt_day: NDArray[np.int16]
    time_gmt_hour: NDArray[np.int16]
    time_gmt_minute: NDArray[np.int16]
    tide_velocities: NDArray[np.float32]
    tide_constituents: bool
    m2_amp: float
    m2_phase: float
    m2_speed: float
    s2_amp: float
    s2_phase: float
    s2_speed: float
    n2_amp: float
    n2_phase: float
    n2_speed: float
    ebb_direction: float
    flood_direction: float
    world_start_time_year: int
    world_start_time_month: int
    world_start_time_day: int
    world_start_time_hour: int
    world_start_time_minute: int
    __msgtype__: ClassVar[str]

@dataclass
class StratifiedCurrentVelocity:
    """`dave_gazebo_ros_plugins/msg/StratifiedCurrentVelocity`"""
    header: Header
    depths: NDArray[np.float32]
    velocities: list[Vector3]
    __msgtype__: ClassVar[str]

@dataclass
class dave_gazebo_ros_plugins__srv__GetCurrentModel_Request(ServiceRequest[dave_gazebo_ros_plugins__srv__GetCurrentModel_Request, dave_gazebo_ros_plugins__srv__GetCurrentModel_Response]):
    """`dave_gazebo_ros_plugins/srv/GetCurrentModel_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class dave_gazebo_ros_plugins__srv__GetCurrentModel_Response:
    """`dave_gazebo_ros_plugins/srv/GetCurrentModel_Response`"""
    mean: float
    min: float
    max: float
    noise: float
    mu: float
    __msgtype__: ClassVar[str]

@dataclass
class dave_gazebo_ros_plugins__srv__GetOriginSphericalCoord_Request(ServiceRequest[dave_gazebo_ros_plugins__srv__GetOriginSphericalCoord_Request, dave_gazebo_ros_plugins__srv__GetOriginSphericalCoord_Response]):
    """`dave_gazebo_ros_plugins/srv/GetOriginSphericalCoord_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class dave_gazebo_ros_plugins__srv__GetOriginSphericalCoord_Response:
    """`dave_gazebo_ros_plugins/srv/GetOriginSphericalCoord_Response`"""
    latitude_deg: float
    longitude_deg: float
    altitude: float
    __msgtype__: ClassVar[str]

@dataclass
class dave_gazebo_ros_plugins__srv__SetCurrentDirection_Request(ServiceRequest[dave_gazebo_ros_plugins__srv__SetCurrentDirection_Request, dave_gazebo_ros_plugins__srv__SetCurrentDirection_Response]):
    """`dave_gazebo_ros_plugins/srv/SetCurrentDirection_Request`"""
    angle: float
    __msgtype__: ClassVar[str]

@dataclass
class dave_gazebo_ros_plugins__srv__SetCurrentDirection_Response:
    """`dave_gazebo_ros_plugins/srv/SetCurrentDirection_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class dave_gazebo_ros_plugins__srv__SetCurrentModel_Request(ServiceRequest[dave_gazebo_ros_plugins__srv__SetCurrentModel_Request, dave_gazebo_ros_plugins__srv__SetCurrentModel_Response]):
    """`dave_gazebo_ros_plugins/srv/SetCurrentModel_Request`"""
    mean: float
    min: float
    max: float
    noise: float
    mu: float
    __msgtype__: ClassVar[str]

@dataclass
class dave_gazebo_ros_plugins__srv__SetCurrentModel_Response:
    """`dave_gazebo_ros_plugins/srv/SetCurrentModel_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class dave_gazebo_ros_plugins__srv__SetCurrentVelocity_Request(ServiceRequest[dave_gazebo_ros_plugins__srv__SetCurrentVelocity_Request, dave_gazebo_ros_plugins__srv__SetCurrentVelocity_Response]):
    """`dave_gazebo_ros_plugins/srv/SetCurrentVelocity_Request`"""
    velocity: float
    horizontal_angle: float
    vertical_angle: float
    __msgtype__: ClassVar[str]

@dataclass
class dave_gazebo_ros_plugins__srv__SetCurrentVelocity_Response:
    """`dave_gazebo_ros_plugins/srv/SetCurrentVelocity_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class dave_gazebo_ros_plugins__srv__SetOriginSphericalCoord_Request(ServiceRequest[dave_gazebo_ros_plugins__srv__SetOriginSphericalCoord_Request, dave_gazebo_ros_plugins__srv__SetOriginSphericalCoord_Response]):
    """`dave_gazebo_ros_plugins/srv/SetOriginSphericalCoord_Request`"""
    latitude_deg: float
    longitude_deg: float
    altitude: float
    __msgtype__: ClassVar[str]

@dataclass
class dave_gazebo_ros_plugins__srv__SetOriginSphericalCoord_Response:
    """`dave_gazebo_ros_plugins/srv/SetOriginSphericalCoord_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class SetStratifiedCurrentDirection_Request(ServiceRequest[SetStratifiedCurrentDirection_Request, SetStratifiedCurrentDirection_Response]):
    """`dave_gazebo_ros_plugins/srv/SetStratifiedCurrentDirection_Request`"""
    layer: int
    angle: float
    __msgtype__: ClassVar[str]

@dataclass
class SetStratifiedCurrentDirection_Response:
    """`dave_gazebo_ros_plugins/srv/SetStratifiedCurrentDirection_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class SetStratifiedCurrentVelocity_Request(ServiceRequest[SetStratifiedCurrentVelocity_Request, SetStratifiedCurrentVelocity_Response]):
    """`dave_gazebo_ros_plugins/srv/SetStratifiedCurrentVelocity_Request`"""
    layer: int
    velocity: float
    horizontal_angle: float
    vertical_angle: float
    __msgtype__: ClassVar[str]

@dataclass
class SetStratifiedCurrentVelocity_Response:
    """`dave_gazebo_ros_plugins/srv/SetStratifiedCurrentVelocity_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class dave_gazebo_ros_plugins__srv__TransformFromSphericalCoord_Request(ServiceRequest[dave_gazebo_ros_plugins__srv__TransformFromSphericalCoord_Request, dave_gazebo_ros_plugins__srv__TransformFromSphericalCoord_Response]):
    """`dave_gazebo_ros_plugins/srv/TransformFromSphericalCoord_Request`"""
    latitude_deg: float
    longitude_deg: float
    altitude: float
    __msgtype__: ClassVar[str]

@dataclass
class dave_gazebo_ros_plugins__srv__TransformFromSphericalCoord_Response:
    """`dave_gazebo_ros_plugins/srv/TransformFromSphericalCoord_Response`"""
    output: Vector3
    __msgtype__: ClassVar[str]

@dataclass
class dave_gazebo_ros_plugins__srv__TransformToSphericalCoord_Request(ServiceRequest[dave_gazebo_ros_plugins__srv__TransformToSphericalCoord_Request, dave_gazebo_ros_plugins__srv__TransformToSphericalCoord_Response]):
    """`dave_gazebo_ros_plugins/srv/TransformToSphericalCoord_Request`"""
    input: Vector3
    __msgtype__: ClassVar[str]

@dataclass
class dave_gazebo_ros_plugins__srv__TransformToSphericalCoord_Response:
    """`dave_gazebo_ros_plugins/srv/TransformToSphericalCoord_Response`"""
    latitude_deg: float
    longitude_deg: float
    altitude: float
    __msgtype__: ClassVar[str]

# dave_interfaces

@dataclass
class dave_interfaces__msg__DVL:
    """`dave_interfaces/msg/DVL`"""
    header: Header
    type: str
    target: DVLTarget
    velocity: TwistWithCovariance
    beams: list[dave_interfaces__msg__DVLBeam]
    __msgtype__: ClassVar[str]

@dataclass
class dave_interfaces__msg__DVLBeam:
    """`dave_interfaces/msg/DVLBeam`"""
    id: int
    reference: str
    range: float
    locked: bool
    velocity: TwistWithCovariance
    __msgtype__: ClassVar[str]

@dataclass
class DVLTarget:
    """`dave_interfaces/msg/DVLTarget`"""
    type: str
    range: float
    __msgtype__: ClassVar[str]

# diagnostic_msgs

@dataclass
class DiagnosticArray:
    """`diagnostic_msgs/msg/DiagnosticArray`"""
    header: Header
    status: list[DiagnosticStatus]
    __msgtype__: ClassVar[str]

@dataclass
class DiagnosticStatus:
    """`diagnostic_msgs/msg/DiagnosticStatus`"""
    level: int
    name: str
    message: str
    hardware_id: str
    values: list[diagnostic_msgs__msg__KeyValue]
    OK: ClassVar[int] = 0
    WARN: ClassVar[int] = 1
    ERROR: ClassVar[int] = 2
    STALE: ClassVar[int] = 3
    __msgtype__: ClassVar[str]

@dataclass
class diagnostic_msgs__msg__KeyValue:
    """`diagnostic_msgs/msg/KeyValue`"""
    key: str
    value: str
    __msgtype__: ClassVar[str]

@dataclass
class AddDiagnostics_Request(ServiceRequest[AddDiagnostics_Request, AddDiagnostics_Response]):
    """`diagnostic_msgs/srv/AddDiagnostics_Request`"""
    load_namespace: str
    __msgtype__: ClassVar[str]

@dataclass
class AddDiagnostics_Response:
    """`diagnostic_msgs/srv/AddDiagnostics_Response`"""
    success: bool
    message: str
    __msgtype__: ClassVar[str]

@dataclass
class SelfTest_Request(ServiceRequest[SelfTest_Request, SelfTest_Response]):
    """`diagnostic_msgs/srv/SelfTest_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class SelfTest_Response:
    """`diagnostic_msgs/srv/SelfTest_Response`"""
    id: str
    passed: int
    status: list[DiagnosticStatus]
    __msgtype__: ClassVar[str]

# ds_core_msgs

@dataclass
class DsHeader:
    """`ds_core_msgs/msg/DsHeader`"""
    io_time: Time
    source_uuid: NDArray[np.uint8]
    __msgtype__: ClassVar[str]

# ds_sensor_msgs

@dataclass
class Adcp:
    """`ds_sensor_msgs/msg/Adcp`"""
    header: Header
    ds_header: DsHeader
    coordinate_mode: int
    adcp_type: int
    cells: int
    cell_depth: int
    bin0_distance: float
    beam_unit_vec: list[Vector3]
    vel_bin_beams: list[WaterCurrentProfile]
    ADCP_COORD_BEAM: ClassVar[int] = 0
    ADCP_COORD_INSTRUMENT: ClassVar[int] = 1
    ADCP_COORD_SHIP: ClassVar[int] = 2
    ADCP_COORD_EARTH: ClassVar[int] = 3
    ADCP_TYPE_PISTON: ClassVar[int] = 0
    ADCP_TYPE_PHASED_ARRAY: ClassVar[int] = 1
    __msgtype__: ClassVar[str]

@dataclass
class Dvl:
    """`ds_sensor_msgs/msg/Dvl`"""
    header: Header
    ds_header: DsHeader
    dvl_time: float
    velocity: Vector3
    velocity_covar: NDArray[np.float64]
    altitude: float
    course_gnd: float
    speed_gnd: float
    num_good_beams: int
    speed_sound: float
    beam_unit_vec: list[Vector3]
    range: NDArray[np.float64]
    range_covar: NDArray[np.float32]
    beam_quality: NDArray[np.float32]
    raw_velocity: NDArray[np.float32]
    raw_velocity_covar: NDArray[np.float32]
    velocity_mode: int
    coordinate_mode: int
    dvl_type: int
    DVL_MODE_BOTTOM: ClassVar[int] = 1
    DVL_MODE_WATER: ClassVar[int] = 2
    DVL_COORD_BEAM: ClassVar[int] = 0
    DVL_COORD_INSTRUMENT: ClassVar[int] = 1
    DVL_COORD_SHIP: ClassVar[int] = 2
    DVL_COORD_EARTH: ClassVar[int] = 3
    DVL_TYPE_PISTON: ClassVar[int] = 0
    DVL_TYPE_PHASED_ARRAY: ClassVar[int] = 1
    __msgtype__: ClassVar[str]

@dataclass
class Range3D:
    """`ds_sensor_msgs/msg/Range3D`"""
    range: PointStamped
    range_quality: float
    range_validity: int
    RANGE_INDETERMINANT: ClassVar[int] = 0
    RANGE_LOW: ClassVar[int] = 1
    RANGE_HIGH: ClassVar[int] = 2
    RANGE_VALID: ClassVar[int] = 3
    __msgtype__: ClassVar[str]

@dataclass
class Ranges3D:
    """`ds_sensor_msgs/msg/Ranges3D`"""
    header: Header
    ds_header: DsHeader
    ranges: list[Range3D]
    soundspeed_correction_type: int
    SOUNDSPEED_CORRECTION_NORMAL: ClassVar[int] = 0
    SOUNDSPEED_CORRECTION_PHASEDARRAYDVL: ClassVar[int] = 1
    __msgtype__: ClassVar[str]

@dataclass
class WaterCurrentProfile:
    """`ds_sensor_msgs/msg/WaterCurrentProfile`"""
    velocity_bin_beam: list[Vector3]
    __msgtype__: ClassVar[str]

# example_interfaces

@dataclass
class Fibonacci_Feedback:
    """`example_interfaces/action/Fibonacci_Feedback`"""
    sequence: NDArray[np.int32]
    __msgtype__: ClassVar[str]

@dataclass
class Fibonacci_Goal(ActionGoal[Fibonacci_Goal, Fibonacci_Result, Fibonacci_Feedback]):
    """`example_interfaces/action/Fibonacci_Goal`"""
    order: int
    __msgtype__: ClassVar[str]

@dataclass
class Fibonacci_Result:
    """`example_interfaces/action/Fibonacci_Result`"""
    sequence: NDArray[np.int32]
    __msgtype__: ClassVar[str]

@dataclass
class example_interfaces__msg__Bool:
    """`example_interfaces/msg/Bool`"""
    data: bool
    __msgtype__: ClassVar[str]

@dataclass
class example_interfaces__msg__Byte:
    """`example_interfaces/msg/Byte`"""
    data: int
    __msgtype__: ClassVar[str]

@dataclass
class example_interfaces__msg__ByteMultiArray:
    """`example_interfaces/msg/ByteMultiArray`"""
    layout: example_interfaces__msg__MultiArrayLayout
    data: NDArray[np.uint8]
    __msgtype__: ClassVar[str]

@dataclass
class example_interfaces__msg__Char:
    """`example_interfaces/msg/Char`"""
    data: int
    __msgtype__: ClassVar[str]

@dataclass
class example_interfaces__msg__Empty:
    """`example_interfaces/msg/Empty`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class example_interfaces__msg__Float32:
    """`example_interfaces/msg/Float32`"""
    data: float
    __msgtype__: ClassVar[str]

@dataclass
class example_interfaces__msg__Float32MultiArray:
    """`example_interfaces/msg/Float32MultiArray`"""
    layout: example_interfaces__msg__MultiArrayLayout
    data: NDArray[np.float32]
    __msgtype__: ClassVar[str]

@dataclass
class example_interfaces__msg__Float64:
    """`example_interfaces/msg/Float64`"""
    data: float
    __msgtype__: ClassVar[str]

@dataclass
class example_interfaces__msg__Float64MultiArray:
    """`example_interfaces/msg/Float64MultiArray`"""
    layout: example_interfaces__msg__MultiArrayLayout
    data: NDArray[np.float64]
    __msgtype__: ClassVar[str]

@dataclass
class example_interfaces__msg__Int16:
    """`example_interfaces/msg/Int16`"""
    data: int
    __msgtype__: ClassVar[str]

@dataclass
class example_interfaces__msg__Int16MultiArray:
    """`example_interfaces/msg/Int16MultiArray`"""
    layout: example_interfaces__msg__MultiArrayLayout
    data: NDArray[np.int16]
    __msgtype__: ClassVar[str]

@dataclass
class example_interfaces__msg__Int32:
    """`example_interfaces/msg/Int32`"""
    data: int
    __msgtype__: ClassVar[str]

@dataclass
class example_interfaces__msg__Int32MultiArray:
    """`example_interfaces/msg/Int32MultiArray`"""
    layout: example_interfaces__msg__MultiArrayLayout
    data: NDArray[np.int32]
    __msgtype__: ClassVar[str]

@dataclass
class example_interfaces__msg__Int64:
    """`example_interfaces/msg/Int64`"""
    data: int
    __msgtype__: ClassVar[str]

@dataclass
class example_interfaces__msg__Int64MultiArray:
    """`example_interfaces/msg/Int64MultiArray`"""
    layout: example_interfaces__msg__MultiArrayLayout
    data: NDArray[np.int64]
    __msgtype__: ClassVar[str]

@dataclass
class example_interfaces__msg__Int8:
    """`example_interfaces/msg/Int8`"""
    data: int
    __msgtype__: ClassVar[str]

@dataclass
class example_interfaces__msg__Int8MultiArray:
    """`example_interfaces/msg/Int8MultiArray`"""
    layout: example_interfaces__msg__MultiArrayLayout
    data: NDArray[np.int8]
    __msgtype__: ClassVar[str]

@dataclass
class example_interfaces__msg__MultiArrayDimension:
    """`example_interfaces/msg/MultiArrayDimension`"""
    label: str
    size: int
    stride: int
    __msgtype__: ClassVar[str]

@dataclass
class example_interfaces__msg__MultiArrayLayout:
    """`example_interfaces/msg/MultiArrayLayout`"""
    dim: list[example_interfaces__msg__MultiArrayDimension]
    data_offset: int
    __msgtype__: ClassVar[str]

@dataclass
class example_interfaces__msg__String:
    """`example_interfaces/msg/String`"""
    data: str
    __msgtype__: ClassVar[str]

@dataclass
class example_interfaces__msg__UInt16:
    """`example_interfaces/msg/UInt16`"""
    data: int
    __msgtype__: ClassVar[str]

@dataclass
class example_interfaces__msg__UInt16MultiArray:
    """`example_interfaces/msg/UInt16MultiArray`"""
    layout: example_interfaces__msg__MultiArrayLayout
    data: NDArray[np.uint16]
    __msgtype__: ClassVar[str]

@dataclass
class example_interfaces__msg__UInt32:
    """`example_interfaces/msg/UInt32`"""
    data: int
    __msgtype__: ClassVar[str]

@dataclass
class example_interfaces__msg__UInt32MultiArray:
    """`example_interfaces/msg/UInt32MultiArray`"""
    layout: example_interfaces__msg__MultiArrayLayout
    data: NDArray[np.uint32]
    __msgtype__: ClassVar[str]

@dataclass
class example_interfaces__msg__UInt64:
    """`example_interfaces/msg/UInt64`"""
    data: int
    __msgtype__: ClassVar[str]

@dataclass
class example_interfaces__msg__UInt64MultiArray:
    """`example_interfaces/msg/UInt64MultiArray`"""
    layout: example_interfaces__msg__MultiArrayLayout
    data: NDArray[np.uint64]
    __msgtype__: ClassVar[str]

@dataclass
class example_interfaces__msg__UInt8:
    """`example_interfaces/msg/UInt8`"""
    data: int
    __msgtype__: ClassVar[str]

@dataclass
class example_interfaces__msg__UInt8MultiArray:
    """`example_interfaces/msg/UInt8MultiArray`"""
    layout: example_interfaces__msg__MultiArrayLayout
    data: NDArray[np.uint8]
    __msgtype__: ClassVar[str]

@dataclass
class WString:
    """`example_interfaces/msg/WString`"""
    data: str
    __msgtype__: ClassVar[str]

@dataclass
class AddTwoInts_Request(ServiceRequest[AddTwoInts_Request, AddTwoInts_Response]):
    """`example_interfaces/srv/AddTwoInts_Request`"""
    a: int
    b: int
    __msgtype__: ClassVar[str]

@dataclass
class AddTwoInts_Response:
    """`example_interfaces/srv/AddTwoInts_Response`"""
    sum: int
    __msgtype__: ClassVar[str]

@dataclass
class example_interfaces__srv__SetBool_Request(ServiceRequest[example_interfaces__srv__SetBool_Request, example_interfaces__srv__SetBool_Response]):
    """`example_interfaces/srv/SetBool_Request`"""
    data: bool
    __msgtype__: ClassVar[str]

@dataclass
class example_interfaces__srv__SetBool_Response:
    """`example_interfaces/srv/SetBool_Response`"""
    success: bool
    message: str
    __msgtype__: ClassVar[str]

@dataclass
class example_interfaces__srv__Trigger_Request(ServiceRequest[example_interfaces__srv__Trigger_Request, example_interfaces__srv__Trigger_Response]):
    """`example_interfaces/srv/Trigger_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class example_interfaces__srv__Trigger_Response:
    """`example_interfaces/srv/Trigger_Response`"""
    success: bool
    message: str
    __msgtype__: ClassVar[str]

# gazebo_msgs

@dataclass
class ContactState:
    """`gazebo_msgs/msg/ContactState`"""
    info: str
    collision1_name: str
    collision2_name: str
    wrenches: list[Wrench]
    total_wrench: Wrench
    contact_positions: list[Vector3]
    contact_normals: list[Vector3]
    depths: NDArray[np.float64]
    __msgtype__: ClassVar[str]

@dataclass
class ContactsState:
    """`gazebo_msgs/msg/ContactsState`"""
    header: Header
    states: list[ContactState]
    __msgtype__: ClassVar[str]

@dataclass
class EntityState:
    """`gazebo_msgs/msg/EntityState`"""
    name: str
    pose: Pose
    twist: Twist
    reference_frame: str
    __msgtype__: ClassVar[str]

@dataclass
class LinkState:
    """`gazebo_msgs/msg/LinkState`"""
    link_name: str
    pose: Pose
    twist: Twist
    reference_frame: str
    __msgtype__: ClassVar[str]

@dataclass
class LinkStates:
    """`gazebo_msgs/msg/LinkStates`"""
    name: list[str]
    pose: list[Pose]
    twist: list[Twist]
    __msgtype__: ClassVar[str]

@dataclass
class ModelState:
    """`gazebo_msgs/msg/ModelState`"""
    model_name: str
    pose: Pose
    twist: Twist
    reference_frame: str
    __msgtype__: ClassVar[str]

@dataclass
class ModelStates:
    """`gazebo_msgs/msg/ModelStates`"""
    name: list[str]
    pose: list[Pose]
    twist: list[Twist]
    __msgtype__: ClassVar[str]

@dataclass
class ODEJointProperties:
    """`gazebo_msgs/msg/ODEJointProperties`"""
    damping: NDArray[np.float64]
    hi_stop: NDArray[np.float64]
    lo_stop: NDArray[np.float64]
    erp: NDArray[np.float64]
    cfm: NDArray[np.float64]
    stop_erp: NDArray[np.float64]
    stop_cfm: NDArray[np.float64]
    fudge_factor: NDArray[np.float64]
    fmax: NDArray[np.float64]
    vel: NDArray[np.float64]
    __msgtype__: ClassVar[str]

@dataclass
class ODEPhysics:
    """`gazebo_msgs/msg/ODEPhysics`"""
    auto_disable_bodies: bool
    sor_pgs_precon_iters: int
    sor_pgs_iters: int
    sor_pgs_w: float
    sor_pgs_rms_error_tol: float
    contact_surface_layer: float
    contact_max_correcting_vel: float
    cfm: float
    erp: float
    max_contacts: int
    __msgtype__: ClassVar[str]

@dataclass
class PerformanceMetrics:
    """`gazebo_msgs/msg/PerformanceMetrics`"""
    header: Header
    real_time_factor: float
    sensors: list[SensorPerformanceMetric]
    __msgtype__: ClassVar[str]

@dataclass
class SensorPerformanceMetric:
    """`gazebo_msgs/msg/SensorPerformanceMetric`"""
    name: str
    sim_update_rate: float
    real_update_rate: float
    fps: float
    __msgtype__: ClassVar[str]

@dataclass
class WheelSlip:
    """`gazebo_msgs/msg/WheelSlip`"""
    name: list[str]
    lateral_slip: NDArray[np.float64]
    longitudinal_slip: NDArray[np.float64]
    __msgtype__: ClassVar[str]

@dataclass
class WorldState:
    """`gazebo_msgs/msg/WorldState`"""
    header: Header
    name: list[str]
    pose: list[Pose]
    twist: list[Twist]
    wrench: list[Wrench]
    __msgtype__: ClassVar[str]

@dataclass
class ApplyBodyWrench_Request(ServiceRequest[ApplyBodyWrench_Request, ApplyBodyWrench_Response]):
    """`gazebo_msgs/srv/ApplyBodyWrench_Request`"""
    body_name: str
    reference_frame: str
    reference_point: Point
    wrench: Wrench
    start_time: Time
    duration: Duration
    __msgtype__: ClassVar[str]

@dataclass
class ApplyBodyWrench_Response:
    """`gazebo_msgs/srv/ApplyBodyWrench_Response`"""
    success: bool
    status_message: str
    __msgtype__: ClassVar[str]

@dataclass
class ApplyJointEffort_Request(ServiceRequest[ApplyJointEffort_Request, ApplyJointEffort_Response]):
    """`gazebo_msgs/srv/ApplyJointEffort_Request`"""
    joint_name: str
    effort: float
    start_time: Time
    duration: Duration
    __msgtype__: ClassVar[str]

@dataclass
class ApplyJointEffort_Response:
    """`gazebo_msgs/srv/ApplyJointEffort_Response`"""
    success: bool
    status_message: str
    __msgtype__: ClassVar[str]

@dataclass
class ApplyLinkWrench_Request(ServiceRequest[ApplyLinkWrench_Request, ApplyLinkWrench_Response]):
    """`gazebo_msgs/srv/ApplyLinkWrench_Request`"""
    link_name: str
    reference_frame: str
    reference_point: Point
    wrench: Wrench
    start_time: Time
    duration: Duration
    __msgtype__: ClassVar[str]

@dataclass
class ApplyLinkWrench_Response:
    """`gazebo_msgs/srv/ApplyLinkWrench_Response`"""
    success: bool
    status_message: str
    __msgtype__: ClassVar[str]

@dataclass
class BodyRequest_Request(ServiceRequest[BodyRequest_Request, BodyRequest_Response]):
    """`gazebo_msgs/srv/BodyRequest_Request`"""
    body_name: str
    __msgtype__: ClassVar[str]

@dataclass
class BodyRequest_Response:
    """`gazebo_msgs/srv/BodyRequest_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class gazebo_msgs__srv__DeleteEntity_Request(ServiceRequest[gazebo_msgs__srv__DeleteEntity_Request, gazebo_msgs__srv__DeleteEntity_Response]):
    """`gazebo_msgs/srv/DeleteEntity_Request`"""
    name: str
    __msgtype__: ClassVar[str]

@dataclass
class gazebo_msgs__srv__DeleteEntity_Response:
    """`gazebo_msgs/srv/DeleteEntity_Response`"""
    success: bool
    status_message: str
    __msgtype__: ClassVar[str]

@dataclass
class DeleteLight_Request(ServiceRequest[DeleteLight_Request, DeleteLight_Response]):
    """`gazebo_msgs/srv/DeleteLight_Request`"""
    light_name: str
    __msgtype__: ClassVar[str]

@dataclass
class DeleteLight_Response:
    """`gazebo_msgs/srv/DeleteLight_Response`"""
    success: bool
    status_message: str
    __msgtype__: ClassVar[str]

@dataclass
class DeleteModel_Request(ServiceRequest[DeleteModel_Request, DeleteModel_Response]):
    """`gazebo_msgs/srv/DeleteModel_Request`"""
    model_name: str
    __msgtype__: ClassVar[str]

@dataclass
class DeleteModel_Response:
    """`gazebo_msgs/srv/DeleteModel_Response`"""
    success: bool
    status_message: str
    __msgtype__: ClassVar[str]

@dataclass
class GetEntityState_Request(ServiceRequest[GetEntityState_Request, GetEntityState_Response]):
    """`gazebo_msgs/srv/GetEntityState_Request`"""
    name: str
    reference_frame: str
    __msgtype__: ClassVar[str]

@dataclass
class GetEntityState_Response:
    """`gazebo_msgs/srv/GetEntityState_Response`"""
    header: Header
    state: EntityState
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class GetJointProperties_Request(ServiceRequest[GetJointProperties_Request, GetJointProperties_Response]):
    """`gazebo_msgs/srv/GetJointProperties_Request`"""
    joint_name: str
    __msgtype__: ClassVar[str]

@dataclass
class GetJointProperties_Response:
    """`gazebo_msgs/srv/GetJointProperties_Response`"""
    type: int
    damping: NDArray[np.float64]
    position: NDArray[np.float64]
    rate: NDArray[np.float64]
    success: bool
    status_message: str
    REVOLUTE: ClassVar[int] = 0
    CONTINUOUS: ClassVar[int] = 1
    PRISMATIC: ClassVar[int] = 2
    FIXED: ClassVar[int] = 3
    BALL: ClassVar[int] = 4
    UNIVERSAL: ClassVar[int] = 5
    __msgtype__: ClassVar[str]

@dataclass
class GetLightProperties_Request(ServiceRequest[GetLightProperties_Request, GetLightProperties_Response]):
    """`gazebo_msgs/srv/GetLightProperties_Request`"""
    light_name: str
    __msgtype__: ClassVar[str]

@dataclass
class GetLightProperties_Response:
    """`gazebo_msgs/srv/GetLightProperties_Response`"""
    diffuse: ColorRGBA
    attenuation_constant: float
    attenuation_linear: float
    attenuation_quadratic: float
    success: bool
    status_message: str
    __msgtype__: ClassVar[str]

@dataclass
class GetLinkProperties_Request(ServiceRequest[GetLinkProperties_Request, GetLinkProperties_Response]):
    """`gazebo_msgs/srv/GetLinkProperties_Request`"""
    link_name: str
    __msgtype__: ClassVar[str]

@dataclass
class GetLinkProperties_Response:
    """`gazebo_msgs/srv/GetLinkProperties_Response`"""
    com: Pose
    gravity_mode: bool
    mass: float
    ixx: float
    ixy: float
    ixz: float
    iyy: float
    iyz: float
    izz: float
    success: bool
    status_message: str
    __msgtype__: ClassVar[str]

@dataclass
class GetLinkState_Request(ServiceRequest[GetLinkState_Request, GetLinkState_Response]):
    """`gazebo_msgs/srv/GetLinkState_Request`"""
    link_name: str
    reference_frame: str
    __msgtype__: ClassVar[str]

@dataclass
class GetLinkState_Response:
    """`gazebo_msgs/srv/GetLinkState_Response`"""
    link_state: LinkState
    success: bool
    status_message: str
    __msgtype__: ClassVar[str]

@dataclass
class GetModelList_Request(ServiceRequest[GetModelList_Request, GetModelList_Response]):
    """`gazebo_msgs/srv/GetModelList_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class GetModelList_Response:
    """`gazebo_msgs/srv/GetModelList_Response`"""
    header: Header
    model_names: list[str]
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class GetModelProperties_Request(ServiceRequest[GetModelProperties_Request, GetModelProperties_Response]):
    """`gazebo_msgs/srv/GetModelProperties_Request`"""
    model_name: str
    __msgtype__: ClassVar[str]

@dataclass
class GetModelProperties_Response:
    """`gazebo_msgs/srv/GetModelProperties_Response`"""
    parent_model_name: str
    canonical_body_name: str
    body_names: list[str]
    geom_names: list[str]
    joint_names: list[str]
    child_model_names: list[str]
    is_static: bool
    success: bool
    status_message: str
    __msgtype__: ClassVar[str]

@dataclass
class GetModelState_Request(ServiceRequest[GetModelState_Request, GetModelState_Response]):
    """`gazebo_msgs/srv/GetModelState_Request`"""
    model_name: str
    relative_entity_name: str
    __msgtype__: ClassVar[str]

@dataclass
class GetModelState_Response:
    """`gazebo_msgs/srv/GetModelState_Response`"""
    header: Header
    pose: Pose
    twist: Twist
    success: bool
    status_message: str
    __msgtype__: ClassVar[str]

@dataclass
class GetPhysicsProperties_Request(ServiceRequest[GetPhysicsProperties_Request, GetPhysicsProperties_Response]):
    """`gazebo_msgs/srv/GetPhysicsProperties_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class GetPhysicsProperties_Response:
    """`gazebo_msgs/srv/GetPhysicsProperties_Response`"""
    time_step: float
    pause: bool
    max_update_rate: float
    gravity: Vector3
    ode_config: ODEPhysics
    success: bool
    status_message: str
    __msgtype__: ClassVar[str]

@dataclass
class GetWorldProperties_Request(ServiceRequest[GetWorldProperties_Request, GetWorldProperties_Response]):
    """`gazebo_msgs/srv/GetWorldProperties_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class GetWorldProperties_Response:
    """`gazebo_msgs/srv/GetWorldProperties_Response`"""
    sim_time: float
    model_names: list[str]
    rendering_enabled: bool
    success: bool
    status_message: str
    __msgtype__: ClassVar[str]

@dataclass
class JointRequest_Request(ServiceRequest[JointRequest_Request, JointRequest_Response]):
    """`gazebo_msgs/srv/JointRequest_Request`"""
    joint_name: str
    __msgtype__: ClassVar[str]

@dataclass
class JointRequest_Response:
    """`gazebo_msgs/srv/JointRequest_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class LinkRequest_Request(ServiceRequest[LinkRequest_Request, LinkRequest_Response]):
    """`gazebo_msgs/srv/LinkRequest_Request`"""
    link_name: str
    __msgtype__: ClassVar[str]

@dataclass
class LinkRequest_Response:
    """`gazebo_msgs/srv/LinkRequest_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class SetEntityState_Request(ServiceRequest[SetEntityState_Request, SetEntityState_Response]):
    """`gazebo_msgs/srv/SetEntityState_Request`"""
    state: EntityState
    __msgtype__: ClassVar[str]

@dataclass
class SetEntityState_Response:
    """`gazebo_msgs/srv/SetEntityState_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class SetJointProperties_Request(ServiceRequest[SetJointProperties_Request, SetJointProperties_Response]):
    """`gazebo_msgs/srv/SetJointProperties_Request`"""
    joint_name: str
    ode_joint_config: ODEJointProperties
    __msgtype__: ClassVar[str]

@dataclass
class SetJointProperties_Response:
    """`gazebo_msgs/srv/SetJointProperties_Response`"""
    success: bool
    status_message: str
    __msgtype__: ClassVar[str]

@dataclass
class SetJointTrajectory_Request(ServiceRequest[SetJointTrajectory_Request, SetJointTrajectory_Response]):
    """`gazebo_msgs/srv/SetJointTrajectory_Request`"""
    model_name: str
    joint_trajectory: JointTrajectory
    model_pose: Pose
    set_model_pose: bool
    disable_physics_updates: bool
    __msgtype__: ClassVar[str]

@dataclass
class SetJointTrajectory_Response:
    """`gazebo_msgs/srv/SetJointTrajectory_Response`"""
    success: bool
    status_message: str
    __msgtype__: ClassVar[str]

@dataclass
class SetLightProperties_Request(ServiceRequest[SetLightProperties_Request, SetLightProperties_Response]):
    """`gazebo_msgs/srv/SetLightProperties_Request`"""
    light_name: str
    diffuse: ColorRGBA
    attenuation_constant: float
    attenuation_linear: float
    attenuation_quadratic: float
    __msgtype__: ClassVar[str]

@dataclass
class SetLightProperties_Response:
    """`gazebo_msgs/srv/SetLightProperties_Response`"""
    success: bool
    status_message: str
    __msgtype__: ClassVar[str]

@dataclass
class SetLinkProperties_Request(ServiceRequest[SetLinkProperties_Request, SetLinkProperties_Response]):
    """`gazebo_msgs/srv/SetLinkProperties_Request`"""
    link_name: str
    com: Pose
    gravity_mode: bool
    mass: float
    ixx: float
    ixy: float
    ixz: float
    iyy: float
    iyz: float
    izz: float
    __msgtype__: ClassVar[str]

@dataclass
class SetLinkProperties_Response:
    """`gazebo_msgs/srv/SetLinkProperties_Response`"""
    success: bool
    status_message: str
    __msgtype__: ClassVar[str]

@dataclass
class SetLinkState_Request(ServiceRequest[SetLinkState_Request, SetLinkState_Response]):
    """`gazebo_msgs/srv/SetLinkState_Request`"""
    link_state: LinkState
    __msgtype__: ClassVar[str]

@dataclass
class SetLinkState_Response:
    """`gazebo_msgs/srv/SetLinkState_Response`"""
    success: bool
    status_message: str
    __msgtype__: ClassVar[str]

@dataclass
class SetModelConfiguration_Request(ServiceRequest[SetModelConfiguration_Request, SetModelConfiguration_Response]):
    """`gazebo_msgs/srv/SetModelConfiguration_Request`"""
    model_name: str
    urdf_param_name: str
    joint_names: list[str]
    joint_positions: NDArray[np.float64]
    __msgtype__: ClassVar[str]

@dataclass
class SetModelConfiguration_Response:
    """`gazebo_msgs/srv/SetModelConfiguration_Response`"""
    success: bool
    status_message: str
    __msgtype__: ClassVar[str]

@dataclass
class SetModelState_Request(ServiceRequest[SetModelState_Request, SetModelState_Response]):
    """`gazebo_msgs/srv/SetModelState_Request`"""
    model_state: ModelState
    __msgtype__: ClassVar[str]

@dataclass
class SetModelState_Response:
    """`gazebo_msgs/srv/SetModelState_Response`"""
    success: bool
    status_message: str
    __msgtype__: ClassVar[str]

@dataclass
class SetPhysicsProperties_Request(ServiceRequest[SetPhysicsProperties_Request, SetPhysicsProperties_Response]):
    """`gazebo_msgs/srv/SetPhysicsProperties_Request`"""
    time_step: float
    max_update_rate: float
    gravity: Vector3
    ode_config: ODEPhysics
    __msgtype__: ClassVar[str]

@dataclass
class SetPhysicsProperties_Response:
    """`gazebo_msgs/srv/SetPhysicsProperties_Response`"""
    success: bool
    status_message: str
    __msgtype__: ClassVar[str]

@dataclass
class gazebo_msgs__srv__SpawnEntity_Request(ServiceRequest[gazebo_msgs__srv__SpawnEntity_Request, gazebo_msgs__srv__SpawnEntity_Response]):
    """`gazebo_msgs/srv/SpawnEntity_Request`"""
    name: str
    xml: str
    robot_namespace: str
    initial_pose: Pose
    reference_frame: str
    __msgtype__: ClassVar[str]

@dataclass
class gazebo_msgs__srv__SpawnEntity_Response:
    """`gazebo_msgs/srv/SpawnEntity_Response`"""
    success: bool
    status_message: str
    __msgtype__: ClassVar[str]

@dataclass
class SpawnModel_Request(ServiceRequest[SpawnModel_Request, SpawnModel_Response]):
    """`gazebo_msgs/srv/SpawnModel_Request`"""
    model_name: str
    model_xml: str
    robot_namespace: str
    initial_pose: Pose
    reference_frame: str
    __msgtype__: ClassVar[str]

@dataclass
class SpawnModel_Response:
    """`gazebo_msgs/srv/SpawnModel_Response`"""
    success: bool
    status_message: str
    __msgtype__: ClassVar[str]

# gazebo_ros_link_attacher

@dataclass
class Attach_Request(ServiceRequest[Attach_Request, Attach_Response]):
    """`gazebo_ros_link_attacher/srv/Attach_Request`"""
    model_name_1: str
    link_name_1: str
    model_name_2: str
    link_name_2: str
    __msgtype__: ClassVar[str]

@dataclass
class Attach_Response:
    """`gazebo_ros_link_attacher/srv/Attach_Response`"""
    ok: bool
    __msgtype__: ClassVar[str]

# geographic_msgs

@dataclass
class BoundingBox:
    """`geographic_msgs/msg/BoundingBox`"""
    min_pt: GeoPoint
    max_pt: GeoPoint
    __msgtype__: ClassVar[str]

@dataclass
class GeoPath:
    """`geographic_msgs/msg/GeoPath`"""
    header: Header
    poses: list[GeoPoseStamped]
    __msgtype__: ClassVar[str]

@dataclass
class GeoPoint:
    """`geographic_msgs/msg/GeoPoint`"""
    latitude: float
    longitude: float
    altitude: float
    __msgtype__: ClassVar[str]

@dataclass
class GeoPointStamped:
    """`geographic_msgs/msg/GeoPointStamped`"""
    header: Header
    position: GeoPoint
    __msgtype__: ClassVar[str]

@dataclass
class GeoPose:
    """`geographic_msgs/msg/GeoPose`"""
    position: GeoPoint
    orientation: Quaternion
    __msgtype__: ClassVar[str]

@dataclass
class GeoPoseStamped:
    """`geographic_msgs/msg/GeoPoseStamped`"""
    header: Header
    pose: GeoPose
    __msgtype__: ClassVar[str]

@dataclass
class GeoPoseWithCovariance:
    """`geographic_msgs/msg/GeoPoseWithCovariance`"""
    pose: GeoPose
    covariance: NDArray[np.float64]
    __msgtype__: ClassVar[str]

@dataclass
class GeoPoseWithCovarianceStamped:
    """`geographic_msgs/msg/GeoPoseWithCovarianceStamped`"""
    header: Header
    pose: GeoPoseWithCovariance
    __msgtype__: ClassVar[str]

@dataclass
class geographic_msgs__msg__KeyValue:
    """`geographic_msgs/msg/KeyValue`"""
    key: str
    value: str
    __msgtype__: ClassVar[str]

# geometry_msgs

@dataclass
class Accel:
    """`geometry_msgs/msg/Accel`"""
    linear: Vector3
    angular: Vector3
    __msgtype__: ClassVar[str]

@dataclass
class AccelStamped:
    """`geometry_msgs/msg/AccelStamped`"""
    header: Header
    accel: Accel
    __msgtype__: ClassVar[str]

@dataclass
class AccelWithCovariance:
    """`geometry_msgs/msg/AccelWithCovariance`"""
    accel: Accel
    covariance: NDArray[np.float64]
    __msgtype__: ClassVar[str]

@dataclass
class AccelWithCovarianceStamped:
    """`geometry_msgs/msg/AccelWithCovarianceStamped`"""
    header: Header
    accel: AccelWithCovariance
    __msgtype__: ClassVar[str]

@dataclass
class Inertia:
    """`geometry_msgs/msg/Inertia`"""
    m: float
    com: Vector3
    ixx: float
    ixy: float
    ixz: float
    iyy: float
    iyz: float
    izz: float
    __msgtype__: ClassVar[str]

@dataclass
class InertiaStamped:
    """`geometry_msgs/msg/InertiaStamped`"""
    header: Header
    inertia: Inertia
    __msgtype__: ClassVar[str]

@dataclass
class Point:
    """`geometry_msgs/msg/Point`"""
    x: float
    y: float
    z: float
    __msgtype__: ClassVar[str]

@dataclass
class Point32:
    """`geometry_msgs/msg/Point32`"""
    x: float
    y: float
    z: float
    __msgtype__: ClassVar[str]

@dataclass
class PointStamped:
    """`geometry_msgs/msg/PointStamped`"""
    header: Header
    point: Point
    __msgtype__: ClassVar[str]

@dataclass
class Polygon:
    """`geometry_msgs/msg/Polygon`"""
    points: list[Point32]
    __msgtype__: ClassVar[str]

@dataclass
class PolygonInstance:
    """`geometry_msgs/msg/PolygonInstance`"""
    polygon: Polygon
    id: int
    __msgtype__: ClassVar[str]

@dataclass
class PolygonInstanceStamped:
    """`geometry_msgs/msg/PolygonInstanceStamped`"""
    header: Header
    polygon: PolygonInstance
    __msgtype__: ClassVar[str]

@dataclass
class PolygonStamped:
    """`geometry_msgs/msg/PolygonStamped`"""
    header: Header
    polygon: Polygon
    __msgtype__: ClassVar[str]

@dataclass
class Pose:
    """`geometry_msgs/msg/Pose`"""
    position: Point
    orientation: Quaternion
    __msgtype__: ClassVar[str]

@dataclass
class Pose2D:
    """`geometry_msgs/msg/Pose2D`"""
    x: float
    y: float
    theta: float
    __msgtype__: ClassVar[str]

@dataclass
class PoseArray:
    """`geometry_msgs/msg/PoseArray`"""
    header: Header
    poses: list[Pose]
    __msgtype__: ClassVar[str]

@dataclass
class PoseStamped:
    """`geometry_msgs/msg/PoseStamped`"""
    header: Header
    pose: Pose
    __msgtype__: ClassVar[str]

@dataclass
class PoseWithCovariance:
    """`geometry_msgs/msg/PoseWithCovariance`"""
    pose: Pose
    covariance: NDArray[np.float64]
    __msgtype__: ClassVar[str]

@dataclass
class PoseWithCovarianceStamped:
    """`geometry_msgs/msg/PoseWithCovarianceStamped`"""
    header: Header
    pose: PoseWithCovariance
    __msgtype__: ClassVar[str]

@dataclass
class Quaternion:
    """`geometry_msgs/msg/Quaternion`"""
    x: float
    y: float
    z: float
    w: float
    __msgtype__: ClassVar[str]

@dataclass
class QuaternionStamped:
    """`geometry_msgs/msg/QuaternionStamped`"""
    header: Header
    quaternion: Quaternion
    __msgtype__: ClassVar[str]

@dataclass
class Transform:
    """`geometry_msgs/msg/Transform`"""
    translation: Vector3
    rotation: Quaternion
    __msgtype__: ClassVar[str]

@dataclass
class TransformStamped:
    """`geometry_msgs/msg/TransformStamped`"""
    header: Header
    child_frame_id: str
    transform: Transform
    __msgtype__: ClassVar[str]

@dataclass
class Twist:
    """`geometry_msgs/msg/Twist`"""
    linear: Vector3
    angular: Vector3
    __msgtype__: ClassVar[str]

@dataclass
class TwistStamped:
    """`geometry_msgs/msg/TwistStamped`"""
    header: Header
    twist: Twist
    __msgtype__: ClassVar[str]

@dataclass
class TwistWithCovariance:
    """`geometry_msgs/msg/TwistWithCovariance`"""
    twist: Twist
    covariance: NDArray[np.float64]
    __msgtype__: ClassVar[str]

@dataclass
class TwistWithCovarianceStamped:
    """`geometry_msgs/msg/TwistWithCovarianceStamped`"""
    header: Header
    twist: TwistWithCovariance
    __msgtype__: ClassVar[str]

@dataclass
class Vector3:
    """`geometry_msgs/msg/Vector3`"""
    x: float
    y: float
    z: float
    __msgtype__: ClassVar[str]

@dataclass
class Vector3Stamped:
    """`geometry_msgs/msg/Vector3Stamped`"""
    header: Header
    vector: Vector3
    __msgtype__: ClassVar[str]

@dataclass
class VelocityStamped:
    """`geometry_msgs/msg/VelocityStamped`"""
    header: Header
    body_frame_id: str
    reference_frame_id: str
    velocity: Twist
    __msgtype__: ClassVar[str]

@dataclass
class Wrench:
    """`geometry_msgs/msg/Wrench`"""
    force: Vector3
    torque: Vector3
    __msgtype__: ClassVar[str]

@dataclass
class WrenchStamped:
    """`geometry_msgs/msg/WrenchStamped`"""
    header: Header
    wrench: Wrench
    __msgtype__: ClassVar[str]

# gps_msgs

@dataclass
class GPSFix:
    """`gps_msgs/msg/GPSFix`"""
    header: Header
    status: GPSStatus
    latitude: float
    longitude: float
    altitude: float
    track: float
    speed: float
    climb: float
    pitch: float
    roll: float
    dip: float
    time: float
    gdop: float
    pdop: float
    hdop: float
    vdop: float
    tdop: float
    err: float
    err_horz: float
    err_vert: float
    err_track: float
    err_speed: float
    err_climb: float
    err_time: float
    err_pitch: float
    err_roll: float
    err_dip: float
    position_covariance: NDArray[np.float64]
    position_covariance_type: int
    COVARIANCE_TYPE_UNKNOWN: ClassVar[int] = 0
    COVARIANCE_TYPE_APPROXIMATED: ClassVar[int] = 1
    COVARIANCE_TYPE_DIAGONAL_KNOWN: ClassVar[int] = 2
    COVARIANCE_TYPE_KNOWN: ClassVar[int] = 3
    __msgtype__: ClassVar[str]

@dataclass
class GPSStatus:
    """`gps_msgs/msg/GPSStatus`"""
    header: Header
    satellites_used: int
    satellite_used_prn: NDArray[np.int32]
    satellites_visible: int
    satellite_visible_prn: NDArray[np.int32]
    satellite_visible_z: NDArray[np.int32]
    satellite_visible_azimuth: NDArray[np.int32]
    satellite_visible_snr: NDArray[np.int32]
    status: int
    motion_source: int
    orientation_source: int
    position_source: int
    STATUS_NO_FIX: ClassVar[int] = -1
    STATUS_FIX: ClassVar[int] = 0
    STATUS_SBAS_FIX: ClassVar[int] = 1
    STATUS_GBAS_FIX: ClassVar[int] = 2
    STATUS_DGPS_FIX: ClassVar[int] = 18
    STATUS_RTK_FIX: ClassVar[int] = 19
    STATUS_RTK_FLOAT: ClassVar[int] = 20
    STATUS_WAAS_FIX: ClassVar[int] = 33
    SOURCE_NONE: ClassVar[int] = 0
    SOURCE_GPS: ClassVar[int] = 1
    SOURCE_POINTS: ClassVar[int] = 2
    SOURCE_DOPPLER: ClassVar[int] = 4
    SOURCE_ALTIMETER: ClassVar[int] = 8
    SOURCE_MAGNETIC: ClassVar[int] = 16
    SOURCE_GYRO: ClassVar[int] = 32
    SOURCE_ACCEL: ClassVar[int] = 64
    __msgtype__: ClassVar[str]

# irobot_create_msgs

@dataclass
class AudioNoteSequence_Feedback:
    """`irobot_create_msgs/action/AudioNoteSequence_Feedback`"""
    iterations_played: int
    current_runtime: Duration
    __msgtype__: ClassVar[str]

@dataclass
class AudioNoteSequence_Goal(ActionGoal[AudioNoteSequence_Goal, AudioNoteSequence_Result, AudioNoteSequence_Feedback]):
    """`irobot_create_msgs/action/AudioNoteSequence_Goal`"""
    iterations: int
    note_sequence: AudioNoteVector
    INFINITE: ClassVar[int] = -1
    __msgtype__: ClassVar[str]

@dataclass
class AudioNoteSequence_Result:
    """`irobot_create_msgs/action/AudioNoteSequence_Result`"""
    complete: bool
    iterations_played: int
    runtime: Duration
    __msgtype__: ClassVar[str]

@dataclass
class Dock_Feedback:
    """`irobot_create_msgs/action/Dock_Feedback`"""
    sees_dock: bool
    __msgtype__: ClassVar[str]

@dataclass
class Dock_Goal(ActionGoal[Dock_Goal, Dock_Result, Dock_Feedback]):
    """`irobot_create_msgs/action/Dock_Goal`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class Dock_Result:
    """`irobot_create_msgs/action/Dock_Result`"""
    is_docked: bool
    __msgtype__: ClassVar[str]

@dataclass
class DriveArc_Feedback:
    """`irobot_create_msgs/action/DriveArc_Feedback`"""
    remaining_angle_travel: float
    __msgtype__: ClassVar[str]

@dataclass
class DriveArc_Goal(ActionGoal[DriveArc_Goal, DriveArc_Result, DriveArc_Feedback]):
    """`irobot_create_msgs/action/DriveArc_Goal`"""
    translate_direction: int
    angle: float
    radius: float
    max_translation_speed: float
    TRANSLATE_FORWARD: ClassVar[int] = 1
    TRANSLATE_BACKWARD: ClassVar[int] = -1
    __msgtype__: ClassVar[str]

@dataclass
class DriveArc_Result:
    """`irobot_create_msgs/action/DriveArc_Result`"""
    pose: PoseStamped
    __msgtype__: ClassVar[str]

@dataclass
class DriveDistance_Feedback:
    """`irobot_create_msgs/action/DriveDistance_Feedback`"""
    remaining_travel_distance: float
    __msgtype__: ClassVar[str]

@dataclass
class DriveDistance_Goal(ActionGoal[DriveDistance_Goal, DriveDistance_Result, DriveDistance_Feedback]):
    """`irobot_create_msgs/action/DriveDistance_Goal`"""
    distance: float
    max_translation_speed: float
    __msgtype__: ClassVar[str]

@dataclass
class DriveDistance_Result:
    """`irobot_create_msgs/action/DriveDistance_Result`"""
    pose: PoseStamped
    __msgtype__: ClassVar[str]

@dataclass
class LedAnimation_Feedback:
    """`irobot_create_msgs/action/LedAnimation_Feedback`"""
    remaining_runtime: Duration
    __msgtype__: ClassVar[str]

@dataclass
class LedAnimation_Goal(ActionGoal[LedAnimation_Goal, LedAnimation_Result, LedAnimation_Feedback]):
    """`irobot_create_msgs/action/LedAnimation_Goal`"""
    animation_type: int
    lightring: LightringLeds
    max_runtime: Duration
    BLINK_LIGHTS: ClassVar[int] = 1
    SPIN_LIGHTS: ClassVar[int] = 2
    __msgtype__: ClassVar[str]

@dataclass
class LedAnimation_Result:
    """`irobot_create_msgs/action/LedAnimation_Result`"""
    runtime: Duration
    __msgtype__: ClassVar[str]

@dataclass
class NavigateToPosition_Feedback:
    """`irobot_create_msgs/action/NavigateToPosition_Feedback`"""
    navigate_state: int
    remaining_angle_travel: float
    remaining_travel_distance: float
    ROTATING_TO_GOAL_POSITION: ClassVar[int] = 1
    DRIVING_TO_GOAL_POSITION: ClassVar[int] = 2
    ROTATING_TO_GOAL_ORIENTATION: ClassVar[int] = 3
    __msgtype__: ClassVar[str]

@dataclass
class NavigateToPosition_Goal(ActionGoal[NavigateToPosition_Goal, NavigateToPosition_Result, NavigateToPosition_Feedback]):
    """`irobot_create_msgs/action/NavigateToPosition_Goal`"""
    goal_pose: PoseStamped
    achieve_goal_heading: bool
    max_translation_speed: float
    max_rotation_speed: float
    __msgtype__: ClassVar[str]

@dataclass
class NavigateToPosition_Result:
    """`irobot_create_msgs/action/NavigateToPosition_Result`"""
    pose: PoseStamped
    __msgtype__: ClassVar[str]

@dataclass
class RotateAngle_Feedback:
    """`irobot_create_msgs/action/RotateAngle_Feedback`"""
    remaining_angle_travel: float
    __msgtype__: ClassVar[str]

@dataclass
class RotateAngle_Goal(ActionGoal[RotateAngle_Goal, RotateAngle_Result, RotateAngle_Feedback]):
    """`irobot_create_msgs/action/RotateAngle_Goal`"""
    angle: float
    max_rotation_speed: float
    __msgtype__: ClassVar[str]

@dataclass
class RotateAngle_Result:
    """`irobot_create_msgs/action/RotateAngle_Result`"""
    pose: PoseStamped
    __msgtype__: ClassVar[str]

@dataclass
class Undock_Feedback:
    """`irobot_create_msgs/action/Undock_Feedback`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class Undock_Goal(ActionGoal[Undock_Goal, Undock_Result, Undock_Feedback]):
    """`irobot_create_msgs/action/Undock_Goal`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class Undock_Result:
    """`irobot_create_msgs/action/Undock_Result`"""
    is_docked: bool
    __msgtype__: ClassVar[str]

@dataclass
class WallFollow_Feedback:
    """`irobot_create_msgs/action/WallFollow_Feedback`"""
    engaged: bool
    __msgtype__: ClassVar[str]

@dataclass
class WallFollow_Goal(ActionGoal[WallFollow_Goal, WallFollow_Result, WallFollow_Feedback]):
    """`irobot_create_msgs/action/WallFollow_Goal`"""
    follow_side: int
    max_runtime: Duration
    FOLLOW_RIGHT: ClassVar[int] = -1
    FOLLOW_LEFT: ClassVar[int] = 1
    __msgtype__: ClassVar[str]

@dataclass
class WallFollow_Result:
    """`irobot_create_msgs/action/WallFollow_Result`"""
    runtime: Duration
    __msgtype__: ClassVar[str]

@dataclass
class AudioNote:
    """`irobot_create_msgs/msg/AudioNote`"""
    frequency: int
    max_runtime: Duration
    __msgtype__: ClassVar[str]

@dataclass
class AudioNoteVector:
    """`irobot_create_msgs/msg/AudioNoteVector`"""
    header: Header
    notes: list[AudioNote]
    append: bool
    __msgtype__: ClassVar[str]

@dataclass
class Button:
    """`irobot_create_msgs/msg/Button`"""
    header: Header
    is_pressed: bool
    last_start_pressed_time: Time
    last_pressed_duration: Duration
    __msgtype__: ClassVar[str]

@dataclass
class DockStatus:
    """`irobot_create_msgs/msg/DockStatus`"""
    header: Header
    dock_visible: bool
    is_docked: bool
    __msgtype__: ClassVar[str]

@dataclass
class HazardDetection:
    """`irobot_create_msgs/msg/HazardDetection`"""
    header: Header
    type: int
    BACKUP_LIMIT: ClassVar[int] = 0
    BUMP: ClassVar[int] = 1
    CLIFF: ClassVar[int] = 2
    STALL: ClassVar[int] = 3
    WHEEL_DROP: ClassVar[int] = 4
    OBJECT_PROXIMITY: ClassVar[int] = 5
    __msgtype__: ClassVar[str]

@dataclass
class HazardDetectionVector:
    """`irobot_create_msgs/msg/HazardDetectionVector`"""
    header: Header
    detections: list[HazardDetection]
    __msgtype__: ClassVar[str]

@dataclass
class InterfaceButtons:
    """`irobot_create_msgs/msg/InterfaceButtons`"""
    header: Header
    button_1: Button
    button_power: Button
    button_2: Button
    __msgtype__: ClassVar[str]

@dataclass
class IrIntensity:
    """`irobot_create_msgs/msg/IrIntensity`"""
    header: Header
    value: int
    __msgtype__: ClassVar[str]

@dataclass
class IrIntensityVector:
    """`irobot_create_msgs/msg/IrIntensityVector`"""
    header: Header
    readings: list[IrIntensity]
    __msgtype__: ClassVar[str]

@dataclass
class IrOpcode:
    """`irobot_create_msgs/msg/IrOpcode`"""
    header: Header
    opcode: int
    sensor: int
    CODE_IR_FORCE_FIELD: ClassVar[int] = 161
    CODE_IR_VIRTUAL_WALL: ClassVar[int] = 162
    CODE_IR_BUOY_GREEN: ClassVar[int] = 164
    CODE_IR_BUOY_RED: ClassVar[int] = 168
    CODE_IR_BUOY_BOTH: ClassVar[int] = 172
    CODE_IR_EVAC_GREEN_FIELD: ClassVar[int] = 244
    CODE_IR_EVAC_RED_FIELD: ClassVar[int] = 248
    CODE_IR_EVAC_BOTH_FIELD: ClassVar[int] = 252
    SENSOR_OMNI: ClassVar[int] = 0
    SENSOR_DIRECTIONAL_FRONT: ClassVar[int] = 1
    __msgtype__: ClassVar[str]

@dataclass
class KidnapStatus:
    """`irobot_create_msgs/msg/KidnapStatus`"""
    header: Header
    is_kidnapped: bool
    __msgtype__: ClassVar[str]

@dataclass
class LedColor:
    """`irobot_create_msgs/msg/LedColor`"""
    red: int
    green: int
    blue: int
    __msgtype__: ClassVar[str]

@dataclass
class LightringLeds:
    """`irobot_create_msgs/msg/LightringLeds`"""
    header: Header
    leds: list[LedColor]
    override_system: bool
    __msgtype__: ClassVar[str]

@dataclass
class Mouse:
    """`irobot_create_msgs/msg/Mouse`"""
    header: Header
    integrated_x: float
    integrated_y: float
    frame_id: int
    last_squal: int
    __msgtype__: ClassVar[str]

@dataclass
class SlipStatus:
    """`irobot_create_msgs/msg/SlipStatus`"""
    header: Header
    is_slipping: bool
    __msgtype__: ClassVar[str]

@dataclass
class StopStatus:
    """`irobot_create_msgs/msg/StopStatus`"""
    header: Header
    is_stopped: bool
    __msgtype__: ClassVar[str]

@dataclass
class WheelStatus:
    """`irobot_create_msgs/msg/WheelStatus`"""
    header: Header
    current_ma_left: int
    current_ma_right: int
    pwm_left: int
    pwm_right: int
    wheels_enabled: bool
    __msgtype__: ClassVar[str]

@dataclass
class WheelTicks:
    """`irobot_create_msgs/msg/WheelTicks`"""
    header: Header
    ticks_left: int
    ticks_right: int
    __msgtype__: ClassVar[str]

@dataclass
class WheelVels:
    """`irobot_create_msgs/msg/WheelVels`"""
    header: Header
    velocity_left: float
    velocity_right: float
    __msgtype__: ClassVar[str]

@dataclass
class EStop_Request(ServiceRequest[EStop_Request, EStop_Response]):
    """`irobot_create_msgs/srv/EStop_Request`"""
    e_stop_on: bool
    __msgtype__: ClassVar[str]

@dataclass
class EStop_Response:
    """`irobot_create_msgs/srv/EStop_Response`"""
    success: bool
    message: str
    __msgtype__: ClassVar[str]

@dataclass
class ResetPose_Request(ServiceRequest[ResetPose_Request, ResetPose_Response]):
    """`irobot_create_msgs/srv/ResetPose_Request`"""
    pose: Pose
    __msgtype__: ClassVar[str]

@dataclass
class ResetPose_Response:
    """`irobot_create_msgs/srv/ResetPose_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class RobotPower_Request(ServiceRequest[RobotPower_Request, RobotPower_Response]):
    """`irobot_create_msgs/srv/RobotPower_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class RobotPower_Response:
    """`irobot_create_msgs/srv/RobotPower_Response`"""
    success: bool
    message: str
    __msgtype__: ClassVar[str]

# kobuki_msgs

@dataclass
class AutoDocking_Feedback:
    """`kobuki_msgs/action/AutoDocking_Feedback`"""
    state: str
    text: str
    __msgtype__: ClassVar[str]

@dataclass
class AutoDocking_Goal(ActionGoal[AutoDocking_Goal, AutoDocking_Result, AutoDocking_Feedback]):
    """`kobuki_msgs/action/AutoDocking_Goal`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class AutoDocking_Result:
    """`kobuki_msgs/action/AutoDocking_Result`"""
    text: str
    __msgtype__: ClassVar[str]

@dataclass
class kobuki_msgs__msg__BumperEvent:
    """`kobuki_msgs/msg/BumperEvent`"""
    bumper: int
    state: int
    LEFT: ClassVar[int] = 0
    CENTER: ClassVar[int] = 1
    RIGHT: ClassVar[int] = 2
    RELEASED: ClassVar[int] = 0
    PRESSED: ClassVar[int] = 1
    __msgtype__: ClassVar[str]

@dataclass
class kobuki_msgs__msg__CliffEvent:
    """`kobuki_msgs/msg/CliffEvent`"""
    sensor: int
    state: int
    bottom: int
    LEFT: ClassVar[int] = 0
    CENTER: ClassVar[int] = 1
    RIGHT: ClassVar[int] = 2
    FLOOR: ClassVar[int] = 0
    CLIFF: ClassVar[int] = 1
    __msgtype__: ClassVar[str]

@dataclass
class ControllerInfo:
    """`kobuki_msgs/msg/ControllerInfo`"""
    type: int
    p_gain: float
    i_gain: float
    d_gain: float
    DEFAULT: ClassVar[int] = 0
    USER_CONFIGURED: ClassVar[int] = 1
    __msgtype__: ClassVar[str]

@dataclass
class DigitalInputEvent:
    """`kobuki_msgs/msg/DigitalInputEvent`"""
    values: NDArray[np.bool_]
    __msgtype__: ClassVar[str]

@dataclass
class DigitalOutput:
    """`kobuki_msgs/msg/DigitalOutput`"""
    values: NDArray[np.bool_]
    mask: NDArray[np.bool_]
    __msgtype__: ClassVar[str]

@dataclass
class kobuki_msgs__msg__DockInfraRed:
    """`kobuki_msgs/msg/DockInfraRed`"""
    header: Header
    data: NDArray[np.uint8]
    NEAR_LEFT: ClassVar[int] = 1
    NEAR_CENTER: ClassVar[int] = 2
    NEAR_RIGHT: ClassVar[int] = 4
    FAR_LEFT: ClassVar[int] = 16
    FAR_CENTER: ClassVar[int] = 8
    FAR_RIGHT: ClassVar[int] = 32
    __msgtype__: ClassVar[str]

@dataclass
class ExternalPower:
    """`kobuki_msgs/msg/ExternalPower`"""
    source: int
    state: int
    PWR_3_3V1A: ClassVar[int] = 0
    PWR_5V1A: ClassVar[int] = 1
    PWR_12V5A: ClassVar[int] = 2
    PWR_12V1_5A: ClassVar[int] = 3
    OFF: ClassVar[int] = 0
    ON: ClassVar[int] = 1
    __msgtype__: ClassVar[str]

@dataclass
class Led:
    """`kobuki_msgs/msg/Led`"""
    value: int
    BLACK: ClassVar[int] = 0
    GREEN: ClassVar[int] = 1
    ORANGE: ClassVar[int] = 2
    RED: ClassVar[int] = 3
    __msgtype__: ClassVar[str]

@dataclass
class kobuki_msgs__msg__MotorPower:
    """`kobuki_msgs/msg/MotorPower`"""
    state: int
    OFF: ClassVar[int] = 0
    ON: ClassVar[int] = 1
    __msgtype__: ClassVar[str]

@dataclass
class PowerSystemEvent:
    """`kobuki_msgs/msg/PowerSystemEvent`"""
    event: int
    UNPLUGGED: ClassVar[int] = 0
    PLUGGED_TO_ADAPTER: ClassVar[int] = 1
    PLUGGED_TO_DOCKBASE: ClassVar[int] = 2
    CHARGE_COMPLETED: ClassVar[int] = 3
    BATTERY_LOW: ClassVar[int] = 4
    BATTERY_CRITICAL: ClassVar[int] = 5
    __msgtype__: ClassVar[str]

@dataclass
class RobotStateEvent:
    """`kobuki_msgs/msg/RobotStateEvent`"""
    state: int
    ONLINE: ClassVar[int] = 1
    OFFLINE: ClassVar[int] = 0
    __msgtype__: ClassVar[str]

@dataclass
class ScanAngle:
    """`kobuki_msgs/msg/ScanAngle`"""
    header: Header
    scan_angle: float
    __msgtype__: ClassVar[str]

@dataclass
class kobuki_msgs__msg__SensorState:
    """`kobuki_msgs/msg/SensorState`"""
    header: Header
    time_stamp: int
    bumper: int
    wheel_drop: int
    cliff: int
    left_encoder: int
    right_encoder: int
    left_pwm: int
    right_pwm: int
    buttons: int
    charger: int
    battery: int
    bottom: NDArray[np.uint16]
    current: NDArray[np.uint8]
    over_current: int
    digital_input: int
    analog_input: NDArray[np.uint16]
    BUMPER_RIGHT: ClassVar[int] = 1
    BUMPER_CENTRE: ClassVar[int] = 2
    BUMPER_LEFT: ClassVar[int] = 4
    WHEEL_DROP_RIGHT: ClassVar[int] = 1
    WHEEL_DROP_LEFT: ClassVar[int] = 2
    CLIFF_RIGHT: ClassVar[int] = 1
    CLIFF_CENTRE: ClassVar[int] = 2
    CLIFF_LEFT: ClassVar[int] = 4
    BUTTON0: ClassVar[int] = 1
    BUTTON1: ClassVar[int] = 2
    BUTTON2: ClassVar[int] = 4
    DISCHARGING: ClassVar[int] = 0
    DOCKING_CHARGED: ClassVar[int] = 2
    DOCKING_CHARGING: ClassVar[int] = 6
    ADAPTER_CHARGED: ClassVar[int] = 18
    ADAPTER_CHARGING: ClassVar[int] = 22
    OVER_CURRENT_LEFT_WHEEL: ClassVar[int] = 1
    OVER_CURRENT_RIGHT_WHEEL: ClassVar[int] = 2
    OVER_CURRENT_BOTH_WHEELS: ClassVar[int] = 3
    DIGITAL_INPUT0: ClassVar[int] = 1
    DIGITAL_INPUT1: ClassVar[int] = 2
    DIGITAL_INPUT2: ClassVar[int] = 4
    DIGITAL_INPUT3: ClassVar[int] = 8
    DB25_TEST_BOARD_CONNECTED: ClassVar[int] = 64
    __msgtype__: ClassVar[str]

@dataclass
class kobuki_msgs__msg__Sound:
    """`kobuki_msgs/msg/Sound`"""
    value: int
    ON: ClassVar[int] = 0
    OFF: ClassVar[int] = 1
    RECHARGE: ClassVar[int] = 2
    BUTTON: ClassVar[int] = 3
    ERROR: ClassVar[int] = 4
    CLEANINGSTART: ClassVar[int] = 5
    CLEANINGEND: ClassVar[int] = 6
    __msgtype__: ClassVar[str]

@dataclass
class kobuki_msgs__msg__VersionInfo:
    """`kobuki_msgs/msg/VersionInfo`"""
    hardware: str
    firmware: str
    software: str
    udid: NDArray[np.uint32]
    features: int
    SMOOTH_MOVE_START: ClassVar[int] = 1
    GYROSCOPE_3D_DATA: ClassVar[int] = 2
    __msgtype__: ClassVar[str]

@dataclass
class kobuki_msgs__msg__WheelDropEvent:
    """`kobuki_msgs/msg/WheelDropEvent`"""
    wheel: int
    state: int
    LEFT: ClassVar[int] = 0
    RIGHT: ClassVar[int] = 1
    RAISED: ClassVar[int] = 0
    DROPPED: ClassVar[int] = 1
    __msgtype__: ClassVar[str]

# kobuki_ros_interfaces

@dataclass
class BumperEvent:
    """`kobuki_ros_interfaces/msg/BumperEvent`"""
    bumper: int
    state: int
    LEFT: ClassVar[int] = 0
    CENTER: ClassVar[int] = 1
    RIGHT: ClassVar[int] = 2
    RELEASED: ClassVar[int] = 0
    PRESSED: ClassVar[int] = 1
    __msgtype__: ClassVar[str]

@dataclass
class CliffEvent:
    """`kobuki_ros_interfaces/msg/CliffEvent`"""
    sensor: int
    state: int
    bottom: int
    LEFT: ClassVar[int] = 0
    CENTER: ClassVar[int] = 1
    RIGHT: ClassVar[int] = 2
    FLOOR: ClassVar[int] = 0
    CLIFF: ClassVar[int] = 1
    __msgtype__: ClassVar[str]

@dataclass
class DockInfraRed:
    """`kobuki_ros_interfaces/msg/DockInfraRed`"""
    header: Header
    data: NDArray[np.uint8]
    NEAR_LEFT: ClassVar[int] = 1
    NEAR_CENTER: ClassVar[int] = 2
    NEAR_RIGHT: ClassVar[int] = 4
    FAR_LEFT: ClassVar[int] = 16
    FAR_CENTER: ClassVar[int] = 8
    FAR_RIGHT: ClassVar[int] = 32
    __msgtype__: ClassVar[str]

@dataclass
class MotorPower:
    """`kobuki_ros_interfaces/msg/MotorPower`"""
    state: int
    OFF: ClassVar[int] = 0
    ON: ClassVar[int] = 1
    __msgtype__: ClassVar[str]

@dataclass
class SensorState:
    """`kobuki_ros_interfaces/msg/SensorState`"""
    header: Header
    time_stamp: int
    bumper: int
    wheel_drop: int
    cliff: int
    left_encoder: int
    right_encoder: int
    left_pwm: int
    right_pwm: int
    buttons: int
    charger: int
    battery: int
    bottom: NDArray[np.uint16]
    current: NDArray[np.uint8]
    over_current: int
    digital_input: int
    analog_input: NDArray[np.uint16]
    BUMPER_RIGHT: ClassVar[int] = 1
    BUMPER_CENTRE: ClassVar[int] = 2
    BUMPER_LEFT: ClassVar[int] = 4
    WHEEL_DROP_RIGHT: ClassVar[int] = 1
    WHEEL_DROP_LEFT: ClassVar[int] = 2
    CLIFF_RIGHT: ClassVar[int] = 1
    CLIFF_CENTRE: ClassVar[int] = 2
    CLIFF_LEFT: ClassVar[int] = 4
    BUTTON0: ClassVar[int] = 1
    BUTTON1: ClassVar[int] = 2
    BUTTON2: ClassVar[int] = 4
    DISCHARGING: ClassVar[int] = 0
    DOCKING_CHARGED: ClassVar[int] = 2
    DOCKING_CHARGING: ClassVar[int] = 6
    ADAPTER_CHARGED: ClassVar[int] = 18
    ADAPTER_CHARGING: ClassVar[int] = 22
    OVER_CURRENT_LEFT_WHEEL: ClassVar[int] = 1
    OVER_CURRENT_RIGHT_WHEEL: ClassVar[int] = 2
    OVER_CURRENT_BOTH_WHEELS: ClassVar[int] = 3
    DIGITAL_INPUT0: ClassVar[int] = 1
    DIGITAL_INPUT1: ClassVar[int] = 2
    DIGITAL_INPUT2: ClassVar[int] = 4
    DIGITAL_INPUT3: ClassVar[int] = 8
    DB25_TEST_BOARD_CONNECTED: ClassVar[int] = 64
    __msgtype__: ClassVar[str]

@dataclass
class WheelDropEvent:
    """`kobuki_ros_interfaces/msg/WheelDropEvent`"""
    wheel: int
    state: int
    LEFT: ClassVar[int] = 0
    RIGHT: ClassVar[int] = 1
    RAISED: ClassVar[int] = 0
    DROPPED: ClassVar[int] = 1
    __msgtype__: ClassVar[str]

# lifecycle_msgs

@dataclass
class State:
    """`lifecycle_msgs/msg/State`"""
    id: int
    label: str
    PRIMARY_STATE_UNKNOWN: ClassVar[int] = 0
    PRIMARY_STATE_UNCONFIGURED: ClassVar[int] = 1
    PRIMARY_STATE_INACTIVE: ClassVar[int] = 2
    PRIMARY_STATE_ACTIVE: ClassVar[int] = 3
    PRIMARY_STATE_FINALIZED: ClassVar[int] = 4
    TRANSITION_STATE_CONFIGURING: ClassVar[int] = 10
    TRANSITION_STATE_CLEANINGUP: ClassVar[int] = 11
    TRANSITION_STATE_SHUTTINGDOWN: ClassVar[int] = 12
    TRANSITION_STATE_ACTIVATING: ClassVar[int] = 13
    TRANSITION_STATE_DEACTIVATING: ClassVar[int] = 14
    TRANSITION_STATE_ERRORPROCESSING: ClassVar[int] = 15
    __msgtype__: ClassVar[str]

@dataclass
class Transition:
    """`lifecycle_msgs/msg/Transition`"""
    id: int
    label: str
    TRANSITION_CREATE: ClassVar[int] = 0
    TRANSITION_CONFIGURE: ClassVar[int] = 1
    TRANSITION_CLEANUP: ClassVar[int] = 2
    TRANSITION_ACTIVATE: ClassVar[int] = 3
    TRANSITION_DEACTIVATE: ClassVar[int] = 4
    TRANSITION_UNCONFIGURED_SHUTDOWN: ClassVar[int] = 5
    TRANSITION_INACTIVE_SHUTDOWN: ClassVar[int] = 6
    TRANSITION_ACTIVE_SHUTDOWN: ClassVar[int] = 7
    TRANSITION_DESTROY: ClassVar[int] = 8
    TRANSITION_ON_CONFIGURE_SUCCESS: ClassVar[int] = 10
    TRANSITION_ON_CONFIGURE_FAILURE: ClassVar[int] = 11
    TRANSITION_ON_CONFIGURE_ERROR: ClassVar[int] = 12
    TRANSITION_ON_CLEANUP_SUCCESS: ClassVar[int] = 20
    TRANSITION_ON_CLEANUP_FAILURE: ClassVar[int] = 21
    TRANSITION_ON_CLEANUP_ERROR: ClassVar[int] = 22
    TRANSITION_ON_ACTIVATE_SUCCESS: ClassVar[int] = 30
    TRANSITION_ON_ACTIVATE_FAILURE: ClassVar[int] = 31
    TRANSITION_ON_ACTIVATE_ERROR: ClassVar[int] = 32
    TRANSITION_ON_DEACTIVATE_SUCCESS: ClassVar[int] = 40
    TRANSITION_ON_DEACTIVATE_FAILURE: ClassVar[int] = 41
    TRANSITION_ON_DEACTIVATE_ERROR: ClassVar[int] = 42
    TRANSITION_ON_SHUTDOWN_SUCCESS: ClassVar[int] = 50
    TRANSITION_ON_SHUTDOWN_FAILURE: ClassVar[int] = 51
    TRANSITION_ON_SHUTDOWN_ERROR: ClassVar[int] = 52
    TRANSITION_ON_ERROR_SUCCESS: ClassVar[int] = 60
    TRANSITION_ON_ERROR_FAILURE: ClassVar[int] = 61
    TRANSITION_ON_ERROR_ERROR: ClassVar[int] = 62
    TRANSITION_CALLBACK_SUCCESS: ClassVar[int] = 97
    TRANSITION_CALLBACK_FAILURE: ClassVar[int] = 98
    TRANSITION_CALLBACK_ERROR: ClassVar[int] = 99
    __msgtype__: ClassVar[str]

@dataclass
class TransitionDescription:
    """`lifecycle_msgs/msg/TransitionDescription`"""
    transition: Transition
    start_state: State
    goal_state: State
    __msgtype__: ClassVar[str]

@dataclass
class TransitionEvent:
    """`lifecycle_msgs/msg/TransitionEvent`"""
    timestamp: int
    transition: Transition
    start_state: State
    goal_state: State
    __msgtype__: ClassVar[str]

@dataclass
class ChangeState_Request(ServiceRequest[ChangeState_Request, ChangeState_Response]):
    """`lifecycle_msgs/srv/ChangeState_Request`"""
    transition: Transition
    __msgtype__: ClassVar[str]

@dataclass
class ChangeState_Response:
    """`lifecycle_msgs/srv/ChangeState_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class GetAvailableStates_Request(ServiceRequest[GetAvailableStates_Request, GetAvailableStates_Response]):
    """`lifecycle_msgs/srv/GetAvailableStates_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class GetAvailableStates_Response:
    """`lifecycle_msgs/srv/GetAvailableStates_Response`"""
    available_states: list[State]
    __msgtype__: ClassVar[str]

@dataclass
class GetAvailableTransitions_Request(ServiceRequest[GetAvailableTransitions_Request, GetAvailableTransitions_Response]):
    """`lifecycle_msgs/srv/GetAvailableTransitions_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class GetAvailableTransitions_Response:
    """`lifecycle_msgs/srv/GetAvailableTransitions_Response`"""
    available_transitions: list[TransitionDescription]
    __msgtype__: ClassVar[str]

@dataclass
class GetState_Request(ServiceRequest[GetState_Request, GetState_Response]):
    """`lifecycle_msgs/srv/GetState_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class GetState_Response:
    """`lifecycle_msgs/srv/GetState_Response`"""
    current_state: State
    __msgtype__: ClassVar[str]

# linkattacher_msgs

@dataclass
class AttachLink_Request(ServiceRequest[AttachLink_Request, AttachLink_Response]):
    """`linkattacher_msgs/srv/AttachLink_Request`"""
    model1_name: str
    link1_name: str
    model2_name: str
    link2_name: str
    __msgtype__: ClassVar[str]

@dataclass
class AttachLink_Response:
    """`linkattacher_msgs/srv/AttachLink_Response`"""
    success: bool
    message: str
    __msgtype__: ClassVar[str]

@dataclass
class DetachLink_Request(ServiceRequest[DetachLink_Request, DetachLink_Response]):
    """`linkattacher_msgs/srv/DetachLink_Request`"""
    model1_name: str
    link1_name: str
    model2_name: str
    link2_name: str
    __msgtype__: ClassVar[str]

@dataclass
class DetachLink_Response:
    """`linkattacher_msgs/srv/DetachLink_Response`"""
    success: bool
    message: str
    __msgtype__: ClassVar[str]

# livox_ros_driver2

@dataclass
class CustomMsg:
    """`livox_ros_driver2/msg/CustomMsg`"""
    header: Header
    timebase: int
    point_num: int
    lidar_id: int
    rsvd: NDArray[np.uint8]
    points: list[CustomPoint]
    __msgtype__: ClassVar[str]

@dataclass
class CustomPoint:
    """`livox_ros_driver2/msg/CustomPoint`"""
    offset_time: int
    x: float
    y: float
    z: float
    reflectivity: int
    tag: int
    line: int
    __msgtype__: ClassVar[str]

# map_msgs

@dataclass
class OccupancyGridUpdate:
    """`map_msgs/msg/OccupancyGridUpdate`"""
    header: Header
    x: int
    y: int
    width: int
    height: int
    data: NDArray[np.int8]
    __msgtype__: ClassVar[str]

@dataclass
class PointCloud2Update:
    """`map_msgs/msg/PointCloud2Update`"""
    header: Header
    type: int
    points: PointCloud2
    ADD: ClassVar[int] = 0
    DELETE: ClassVar[int] = 1
    __msgtype__: ClassVar[str]

@dataclass
class ProjectedMap:
    """`map_msgs/msg/ProjectedMap`"""
    map: OccupancyGrid
    min_z: float
    max_z: float
    __msgtype__: ClassVar[str]

@dataclass
class ProjectedMapInfo:
    """`map_msgs/msg/ProjectedMapInfo`"""
    frame_id: str
    x: float
    y: float
    width: float
    height: float
    min_z: float
    max_z: float
    __msgtype__: ClassVar[str]

@dataclass
class GetMapROI_Request(ServiceRequest[GetMapROI_Request, GetMapROI_Response]):
    """`map_msgs/srv/GetMapROI_Request`"""
    x: float
    y: float
    l_x: float
    l_y: float
    __msgtype__: ClassVar[str]

@dataclass
class GetMapROI_Response:
    """`map_msgs/srv/GetMapROI_Response`"""
    sub_map: OccupancyGrid
    __msgtype__: ClassVar[str]

@dataclass
class GetPointMapROI_Request(ServiceRequest[GetPointMapROI_Request, GetPointMapROI_Response]):
    """`map_msgs/srv/GetPointMapROI_Request`"""
    x: float
    y: float
    z: float
    r: float
    l_x: float
    l_y: float
    l_z: float
    __msgtype__: ClassVar[str]

@dataclass
class GetPointMapROI_Response:
    """`map_msgs/srv/GetPointMapROI_Response`"""
    sub_map: PointCloud2
    __msgtype__: ClassVar[str]

@dataclass
class GetPointMap_Request(ServiceRequest[GetPointMap_Request, GetPointMap_Response]):
    """`map_msgs/srv/GetPointMap_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class GetPointMap_Response:
    """`map_msgs/srv/GetPointMap_Response`"""
    map: PointCloud2
    __msgtype__: ClassVar[str]

@dataclass
class ProjectedMapsInfo_Request(ServiceRequest[ProjectedMapsInfo_Request, ProjectedMapsInfo_Response]):
    """`map_msgs/srv/ProjectedMapsInfo_Request`"""
    projected_maps_info: list[ProjectedMapInfo]
    __msgtype__: ClassVar[str]

@dataclass
class ProjectedMapsInfo_Response:
    """`map_msgs/srv/ProjectedMapsInfo_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class SaveMap_Request(ServiceRequest[SaveMap_Request, SaveMap_Response]):
    """`map_msgs/srv/SaveMap_Request`"""
    filename: String
    __msgtype__: ClassVar[str]

@dataclass
class SaveMap_Response:
    """`map_msgs/srv/SaveMap_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class SetMapProjections_Request(ServiceRequest[SetMapProjections_Request, SetMapProjections_Response]):
    """`map_msgs/srv/SetMapProjections_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class SetMapProjections_Response:
    """`map_msgs/srv/SetMapProjections_Response`"""
    projected_maps_info: list[ProjectedMapInfo]
    __msgtype__: ClassVar[str]

# mav_msgs

@dataclass
class mav_msgs__msg__Actuators:
    """`mav_msgs/msg/Actuators`"""
    header: Header
    angles: NDArray[np.float64]
    angular_velocities: NDArray[np.float64]
    normalized: NDArray[np.float64]
    __msgtype__: ClassVar[str]

@dataclass
class AttitudeThrust:
    """`mav_msgs/msg/AttitudeThrust`"""
    header: Header
    attitude: Quaternion
    thrust: Vector3
    __msgtype__: ClassVar[str]

@dataclass
class FilteredSensorData:
    """`mav_msgs/msg/FilteredSensorData`"""
    header: Header
    accelerometer: Vector3
    gyroscope: Vector3
    magnetometer: Vector3
    barometer: float
    __msgtype__: ClassVar[str]

@dataclass
class RateThrust:
    """`mav_msgs/msg/RateThrust`"""
    header: Header
    angular_rates: Vector3
    thrust: Vector3
    __msgtype__: ClassVar[str]

@dataclass
class RollPitchYawrateThrust:
    """`mav_msgs/msg/RollPitchYawrateThrust`"""
    header: Header
    roll: float
    pitch: float
    yaw_rate: float
    thrust: Vector3
    __msgtype__: ClassVar[str]

@dataclass
class Status:
    """`mav_msgs/msg/Status`"""
    header: Header
    vehicle_name: str
    vehicle_type: str
    battery_voltage: float
    rc_command_mode: str
    command_interface_enabled: bool
    flight_time: float
    system_uptime: float
    cpu_load: float
    motor_status: str
    in_air: bool
    gps_status: str
    gps_num_satellites: int
    RC_COMMAND_ATTITUDE: ClassVar[str] = 'attitude_thrust'
    RC_COMMAND_ATTITUDE_HEIGHT: ClassVar[str] = 'attitude_height'
    RC_COMMAND_POSITION: ClassVar[str] = 'position'
    MOTOR_STATUS_RUNNING: ClassVar[str] = 'running'
    MOTOR_STATUS_STOPPED: ClassVar[str] = 'stopped'
    MOTOR_STATUS_STARTING: ClassVar[str] = 'starting'
    MOTOR_STATUS_STOPPING: ClassVar[str] = 'stopping'
    GPS_STATUS_LOCK: ClassVar[str] = 'lock'
    GPS_STATUS_NO_LOCK: ClassVar[str] = 'no_lock'
    __msgtype__: ClassVar[str]

@dataclass
class TorqueThrust:
    """`mav_msgs/msg/TorqueThrust`"""
    header: Header
    torque: Vector3
    thrust: Vector3
    __msgtype__: ClassVar[str]

# mavros_msgs

@dataclass
class ActuatorControl:
    """`mavros_msgs/msg/ActuatorControl`"""
    header: Header
    group_mix: int
    controls: NDArray[np.float32]
    PX4_MIX_FLIGHT_CONTROL: ClassVar[int] = 0
    PX4_MIX_FLIGHT_CONTROL_VTOL_ALT: ClassVar[int] = 1
    PX4_MIX_PAYLOAD: ClassVar[int] = 2
    PX4_MIX_MANUAL_PASSTHROUGH: ClassVar[int] = 3
    __msgtype__: ClassVar[str]

@dataclass
class Altitude:
    """`mavros_msgs/msg/Altitude`"""
    header: Header
    monotonic: float
    amsl: float
    local: float
    relative: float
    terrain: float
    bottom_clearance: float
    __msgtype__: ClassVar[str]

@dataclass
class AttitudeTarget:
    """`mavros_msgs/msg/AttitudeTarget`"""
    header: Header
    type_mask: int
    orientation: Quaternion
    body_rate: Vector3
    thrust: float
    IGNORE_ROLL_RATE: ClassVar[int] = 1
    IGNORE_PITCH_RATE: ClassVar[int] = 2
    IGNORE_YAW_RATE: ClassVar[int] = 4
    IGNORE_THRUST: ClassVar[int] = 64
    IGNORE_ATTITUDE: ClassVar[int] = 128
    __msgtype__: ClassVar[str]

@dataclass
class CommandCode:
    """`mavros_msgs/msg/CommandCode`"""
    structure_needs_at_least_one_member: int = 0
    AIRFRAME_CONFIGURATION: ClassVar[int] = 2520
    ARM_AUTHORIZATION_REQUEST: ClassVar[int] = 3001
    CAMERA_TRACK_POINT: ClassVar[int] = 2004
    CAMERA_TRACK_RECTANGLE: ClassVar[int] = 2005
    CAMERA_STOP_TRACKING: ClassVar[int] = 2010
    CAN_FORWARD: ClassVar[int] = 32000
    COMPONENT_ARM_DISARM: ClassVar[int] = 400
    CONDITION_DELAY: ClassVar[int] = 112
    CONDITION_CHANGE_ALT: ClassVar[int] = 113
    CONDITION_DISTANCE: ClassVar[int] = 114
    CONDITION_YAW: ClassVar[int] = 115
    CONDITION_LAST: ClassVar[int] = 159
    CONTROL_HIGH_LATENCY: ClassVar[int] = 2600
    DO_FOLLOW: ClassVar[int] = 32
    DO_FOLLOW_REPOSITION: ClassVar[int] = 33
    DO_SET_MODE: ClassVar[int] = 176
    DO_JUMP: ClassVar[int] = 177
    DO_CHANGE_SPEED: ClassVar[int] = 178
    DO_SET_HOME: ClassVar[int] = 179
    DO_SET_PARAMETER: ClassVar[int] = 180
    DO_SET_RELAY: ClassVar[int] = 181
    DO_REPEAT_RELAY: ClassVar[int] = 182
    DO_SET_SERVO: ClassVar[int] = 183
    DO_REPEAT_SERVO: ClassVar[int] = 184
    DO_FLIGHTTERMINATION: ClassVar[int] = 185
    DO_CHANGE_ALTITUDE: ClassVar[int] = 186
    DO_RETURN_PATH_START: ClassVar[int] = 188
    DO_LAND_START: ClassVar[int] = 189
    DO_RALLY_LAND: ClassVar[int] = 190
    DO_GO_AROUND: ClassVar[int] = 191
    DO_REPOSITION: ClassVar[int] = 192
    DO_PAUSE_CONTINUE: ClassVar[int] = 193
    DO_SET_REVERSE: ClassVar[int] = 194
    DO_SET_ROI_LOCATION: ClassVar[int] = 195
    DO_SET_ROI_WPNEXT_OFFSET: ClassVar[int] = 196
    DO_SET_ROI_NONE: ClassVar[int] = 197
    DO_SET_ROI_SYSID: ClassVar[int] = 198
    DO_CONTROL_VIDEO: ClassVar[int] = 200
    DO_SET_ROI: ClassVar[int] = 201
    DO_DIGICAM_CONFIGURE: ClassVar[int] = 202
    DO_DIGICAM_CONTROL: ClassVar[int] = 203
    DO_MOUNT_CONFIGURE: ClassVar[int] = 204
    DO_MOUNT_CONTROL: ClassVar[int] = 205
    DO_SET_CAM_TRIGG_DIST: ClassVar[int] = 206
    DO_FENCE_ENABLE: ClassVar[int] = 207
    DO_PARACHUTE: ClassVar[int] = 208
    DO_MOTOR_TEST: ClassVar[int] = 209
    DO_INVERTED_FLIGHT: ClassVar[int] = 210
    DO_GRIPPER: ClassVar[int] = 211
    DO_AUTOTUNE_ENABLE: ClassVar[int] = 212
    DO_SET_CAM_TRIGG_INTERVAL: ClassVar[int] = 214
    DO_MOUNT_CONTROL_QUAT: ClassVar[int] = 220
    DO_GUIDED_MASTER: ClassVar[int] = 221
    DO_GUIDED_LIMITS: ClassVar[int] = 222
    DO_ENGINE_CONTROL: ClassVar[int] = 223
    DO_SET_MISSION_CURRENT: ClassVar[int] = 224
    DO_LAST: ClassVar[int] = 240
    DO_JUMP_TAG: ClassVar[int] = 601
    DO_GIMBAL_MANAGER_PITCHYAW: ClassVar[int] = 1000
    DO_GIMBAL_MANAGER_CONFIGURE: ClassVar[int] = 1001
    DO_TRIGGER_CONTROL: ClassVar[int] = 2003
    DO_VTOL_TRANSITION: ClassVar[int] = 3000
    DO_SET_SAFETY_SWITCH_STATE: ClassVar[int] = 5300
    DO_ADSB_OUT_IDENT: ClassVar[int] = 10001
    DO_WINCH: ClassVar[int] = 42600
    EXTERNAL_POSITION_ESTIMATE: ClassVar[int] = 43003
    FIXED_MAG_CAL_YAW: ClassVar[int] = 42006
    GET_HOME_POSITION: ClassVar[int] = 410
    GET_MESSAGE_INTERVAL: ClassVar[int] = 510
    IMAGE_START_CAPTURE: ClassVar[int] = 2000
    IMAGE_STOP_CAPTURE: ClassVar[int] = 2001
    JUMP_TAG: ClassVar[int] = 600
    LOGGING_START: ClassVar[int] = 2510
    LOGGING_STOP: ClassVar[int] = 2511
    MISSION_START: ClassVar[int] = 300
    NAV_WAYPOINT: ClassVar[int] = 16
    NAV_LOITER_UNLIM: ClassVar[int] = 17
    NAV_LOITER_TURNS: ClassVar[int] = 18
    NAV_LOITER_TIME: ClassVar[int] = 19
    NAV_RETURN_TO_LAUNCH: ClassVar[int] = 20
    NAV_LAND: ClassVar[int] = 21
    NAV_TAKEOFF: ClassVar[int] = 22
    NAV_LAND_LOCAL: ClassVar[int] = 23
    NAV_TAKEOFF_LOCAL: ClassVar[int] = 24
    NAV_FOLLOW: ClassVar[int] = 25
    NAV_CONTINUE_AND_CHANGE_ALT: ClassVar[int] = 30
    NAV_LOITER_TO_ALT: ClassVar[int] = 31
    NAV_ROI: ClassVar[int] = 80
    NAV_PATHPLANNING: ClassVar[int] = 81
    NAV_SPLINE_WAYPOINT: ClassVar[int] = 82
    NAV_VTOL_TAKEOFF: ClassVar[int] = 84
    NAV_VTOL_LAND: ClassVar[int] = 85
    NAV_GUIDED_ENABLE: ClassVar[int] = 92
    NAV_DELAY: ClassVar[int] = 93
    NAV_PAYLOAD_PLACE: ClassVar[int] = 94
    NAV_LAST: ClassVar[int] = 95
    NAV_SET_YAW_SPEED: ClassVar[int] = 213
    NAV_FENCE_RETURN_POINT: ClassVar[int] = 5000
    NAV_FENCE_POLYGON_VERTEX_INCLUSION: ClassVar[int] = 5001
    NAV_FENCE_POLYGON_VERTEX_EXCLUSION: ClassVar[int] = 5002
    NAV_FENCE_CIRCLE_INCLUSION: ClassVar[int] = 5003
    NAV_FENCE_CIRCLE_EXCLUSION: ClassVar[int] = 5004
    NAV_RALLY_POINT: ClassVar[int] = 5100
    OBLIQUE_SURVEY: ClassVar[int] = 260
    OVERRIDE_GOTO: ClassVar[int] = 252
    PANORAMA_CREATE: ClassVar[int] = 2800
    PAYLOAD_PREPARE_DEPLOY: ClassVar[int] = 30001
    PAYLOAD_CONTROL_DEPLOY: ClassVar[int] = 30002
    PREFLIGHT_CALIBRATION: ClassVar[int] = 241
    PREFLIGHT_SET_SENSOR_OFFSETS: ClassVar[int] = 242
    PREFLIGHT_UAVCAN: ClassVar[int] = 243
    PREFLIGHT_STORAGE: ClassVar[int] = 245
    PREFLIGHT_REBOOT_SHUTDOWN: ClassVar[int] = 246
    REQUEST_MESSAGE: ClassVar[int] = 512
    REQUEST_PROTOCOL_VERSION: ClassVar[int] = 519
    REQUEST_AUTOPILOT_CAPABILITIES: ClassVar[int] = 520
    REQUEST_CAMERA_INFORMATION: ClassVar[int] = 521
    REQUEST_CAMERA_SETTINGS: ClassVar[int] = 522
    REQUEST_STORAGE_INFORMATION: ClassVar[int] = 525
    REQUEST_CAMERA_CAPTURE_STATUS: ClassVar[int] = 527
    REQUEST_FLIGHT_INFORMATION: ClassVar[int] = 528
    REQUEST_VIDEO_STREAM_INFORMATION: ClassVar[int] = 2504
    REQUEST_VIDEO_STREAM_STATUS: ClassVar[int] = 2505
    RESET_CAMERA_SETTINGS: ClassVar[int] = 529
    RUN_PREARM_CHECKS: ClassVar[int] = 401
    SET_MESSAGE_INTERVAL: ClassVar[int] = 511
    SET_CAMERA_MODE: ClassVar[int] = 530
    SET_CAMERA_ZOOM: ClassVar[int] = 531
    SET_CAMERA_FOCUS: ClassVar[int] = 532
    SET_STORAGE_USAGE: ClassVar[int] = 533
    SET_CAMERA_SOURCE: ClassVar[int] = 534
    SET_GUIDED_SUBMODE_STANDARD: ClassVar[int] = 4000
    SET_GUIDED_SUBMODE_CIRCLE: ClassVar[int] = 4001
    START_RX_PAIR: ClassVar[int] = 500
    STORAGE_FORMAT: ClassVar[int] = 526
    UAVCAN_GET_NODE_INFO: ClassVar[int] = 5200
    VIDEO_START_CAPTURE: ClassVar[int] = 2500
    VIDEO_STOP_CAPTURE: ClassVar[int] = 2501
    VIDEO_START_STREAMING: ClassVar[int] = 2502
    VIDEO_STOP_STREAMING: ClassVar[int] = 2503
    __msgtype__: ClassVar[str]

@dataclass
class ExtendedState:
    """`mavros_msgs/msg/ExtendedState`"""
    header: Header
    vtol_state: int
    landed_state: int
    VTOL_STATE_UNDEFINED: ClassVar[int] = 0
    VTOL_STATE_TRANSITION_TO_FW: ClassVar[int] = 1
    VTOL_STATE_TRANSITION_TO_MC: ClassVar[int] = 2
    VTOL_STATE_MC: ClassVar[int] = 3
    VTOL_STATE_FW: ClassVar[int] = 4
    LANDED_STATE_UNDEFINED: ClassVar[int] = 0
    LANDED_STATE_ON_GROUND: ClassVar[int] = 1
    LANDED_STATE_IN_AIR: ClassVar[int] = 2
    LANDED_STATE_TAKEOFF: ClassVar[int] = 3
    LANDED_STATE_LANDING: ClassVar[int] = 4
    __msgtype__: ClassVar[str]

@dataclass
class GlobalPositionTarget:
    """`mavros_msgs/msg/GlobalPositionTarget`"""
    header: Header
    coordinate_frame: int
    type_mask: int
    latitude: float
    longitude: float
    altitude: float
    velocity: Vector3
    acceleration_or_force: Vector3
    yaw: float
    yaw_rate: float
    FRAME_GLOBAL_INT: ClassVar[int] = 5
    FRAME_GLOBAL_REL_ALT: ClassVar[int] = 6
    FRAME_GLOBAL_TERRAIN_ALT: ClassVar[int] = 11
    IGNORE_LATITUDE: ClassVar[int] = 1
    IGNORE_LONGITUDE: ClassVar[int] = 2
    IGNORE_ALTITUDE: ClassVar[int] = 4
    IGNORE_VX: ClassVar[int] = 8
    IGNORE_VY: ClassVar[int] = 16
    IGNORE_VZ: ClassVar[int] = 32
    IGNORE_AFX: ClassVar[int] = 64
    IGNORE_AFY: ClassVar[int] = 128
    IGNORE_AFZ: ClassVar[int] = 256
    FORCE: ClassVar[int] = 512
    IGNORE_YAW: ClassVar[int] = 1024
    IGNORE_YAW_RATE: ClassVar[int] = 2048
    __msgtype__: ClassVar[str]

@dataclass
class HomePosition:
    """`mavros_msgs/msg/HomePosition`"""
    header: Header
    geo: GeoPoint
    position: Point
    orientation: Quaternion
    approach: Vector3
    __msgtype__: ClassVar[str]

@dataclass
class LandingTarget:
    """`mavros_msgs/msg/LandingTarget`"""
    header: Header
    target_num: int
    frame: int
    angle: NDArray[np.float32]
    distance: float
    size: NDArray[np.float32]
    pose: Pose
    type: int
    GLOBAL: ClassVar[int] = 0
    LOCAL_NED: ClassVar[int] = 2
    MISSION: ClassVar[int] = 3
    GLOBAL_RELATIVE_ALT: ClassVar[int] = 4
    LOCAL_ENU: ClassVar[int] = 5
    GLOBAL_INT: ClassVar[int] = 6
    GLOBAL_RELATIVE_ALT_INT: ClassVar[int] = 7
    LOCAL_OFFSET_NED: ClassVar[int] = 8
    BODY_NED: ClassVar[int] = 9
    BODY_OFFSET_NED: ClassVar[int] = 10
    GLOBAL_TERRAIN_ALT: ClassVar[int] = 11
    GLOBAL_TERRAIN_ALT_INT: ClassVar[int] = 12
    LIGHT_BEACON: ClassVar[int] = 0
    RADIO_BEACON: ClassVar[int] = 1
    VISION_FIDUCIAL: ClassVar[int] = 2
    VISION_OTHER: ClassVar[int] = 3
    __msgtype__: ClassVar[str]

@dataclass
class ManualControl:
    """`mavros_msgs/msg/ManualControl`"""
    header: Header
    x: float
    y: float
    z: float
    r: float
    buttons: int
    buttons2: int
    enabled_extensions: int
    s: float
    t: float
    aux1: float
    aux2: float
    aux3: float
    aux4: float
    aux5: float
    aux6: float
    __msgtype__: ClassVar[str]

@dataclass
class MountControl:
    """`mavros_msgs/msg/MountControl`"""
    header: Header
    mode: int
    pitch: float
    roll: float
    yaw: float
    altitude: float
    latitude: float
    longitude: float
    MAV_MOUNT_MODE_RETRACT: ClassVar[int] = 0
    MAV_MOUNT_MODE_NEUTRAL: ClassVar[int] = 1
    MAV_MOUNT_MODE_MAVLINK_TARGETING: ClassVar[int] = 2
    MAV_MOUNT_MODE_RC_TARGETING: ClassVar[int] = 3
    MAV_MOUNT_MODE_GPS_POINT: ClassVar[int] = 4
    __msgtype__: ClassVar[str]

@dataclass
class OverrideRCIn:
    """`mavros_msgs/msg/OverrideRCIn`"""
    channels: NDArray[np.uint16]
    CHAN_RELEASE: ClassVar[int] = 0
    CHAN_NOCHANGE: ClassVar[int] = 65535
    __msgtype__: ClassVar[str]

@dataclass
class Param:
    """`mavros_msgs/msg/Param`"""
    header: Header
    param_id: str
    value: ParamValue
    param_index: int
    param_count: int
    __msgtype__: ClassVar[str]

@dataclass
class ParamValue:
    """`mavros_msgs/msg/ParamValue`"""
    integer: int
    real: float
    __msgtype__: ClassVar[str]

@dataclass
class PositionTarget:
    """`mavros_msgs/msg/PositionTarget`"""
    header: Header
    coordinate_frame: int
    type_mask: int
    position: Point
    velocity: Vector3
    acceleration_or_force: Vector3
    yaw: float
    yaw_rate: float
    FRAME_LOCAL_NED: ClassVar[int] = 1
    FRAME_LOCAL_OFFSET_NED: ClassVar[int] = 7
    FRAME_BODY_NED: ClassVar[int] = 8
    FRAME_BODY_OFFSET_NED: ClassVar[int] = 9
    IGNORE_PX: ClassVar[int] = 1
    IGNORE_PY: ClassVar[int] = 2
    IGNORE_PZ: ClassVar[int] = 4
    IGNORE_VX: ClassVar[int] = 8
    IGNORE_VY: ClassVar[int] = 16
    IGNORE_VZ: ClassVar[int] = 32
    IGNORE_AFX: ClassVar[int] = 64
    IGNORE_AFY: ClassVar[int] = 128
    IGNORE_AFZ: ClassVar[int] = 256
    FORCE: ClassVar[int] = 512
    IGNORE_YAW: ClassVar[int] = 1024
    IGNORE_YAW_RATE: ClassVar[int] = 2048
    __msgtype__: ClassVar[str]

@dataclass
class RCIn:
    """`mavros_msgs/msg/RCIn`"""
    header: Header
    rssi: int
    channels: NDArray[np.uint16]
    __msgtype__: ClassVar[str]

@dataclass
class RCOut:
    """`mavros_msgs/msg/RCOut`"""
    header: Header
    channels: NDArray[np.uint16]
    __msgtype__: ClassVar[str]

@dataclass
class mavros_msgs__msg__State:
    """`mavros_msgs/msg/State`"""
    header: Header
    connected: bool
    armed: bool
    guided: bool
    manual_input: bool
    mode: str
    system_status: int
    MODE_APM_PLANE_MANUAL: ClassVar[str] = 'MANUAL'
    MODE_APM_PLANE_CIRCLE: ClassVar[str] = 'CIRCLE'
    MODE_APM_PLANE_STABILIZE: ClassVar[str] = 'STABILIZE'
    MODE_APM_PLANE_TRAINING: ClassVar[str] = 'TRAINING'
    MODE_APM_PLANE_ACRO: ClassVar[str] = 'ACRO'
    MODE_APM_PLANE_FBWA: ClassVar[str] = 'FBWA'
    MODE_APM_PLANE_FBWB: ClassVar[str] = 'FBWB'
    MODE_APM_PLANE_CRUISE: ClassVar[str] = 'CRUISE'
    MODE_APM_PLANE_AUTOTUNE: ClassVar[str] = 'AUTOTUNE'
    MODE_APM_PLANE_AUTO: ClassVar[str] = 'AUTO'
    MODE_APM_PLANE_RTL: ClassVar[str] = 'RTL'
    MODE_APM_PLANE_LOITER: ClassVar[str] = 'LOITER'
    MODE_APM_PLANE_LAND: ClassVar[str] = 'LAND'
    MODE_APM_PLANE_GUIDED: ClassVar[str] = 'GUIDED'
    MODE_APM_PLANE_INITIALISING: ClassVar[str] = 'INITIALISING'
    MODE_APM_PLANE_QSTABILIZE: ClassVar[str] = 'QSTABILIZE'
    MODE_APM_PLANE_QHOVER: ClassVar[str] = 'QHOVER'
    MODE_APM_PLANE_QLOITER: ClassVar[str] = 'QLOITER'
    MODE_APM_PLANE_QLAND: ClassVar[str] = 'QLAND'
    MODE_APM_PLANE_QRTL: ClassVar[str] = 'QRTL'
    MODE_APM_COPTER_STABILIZE: ClassVar[str] = 'STABILIZE'
    MODE_APM_COPTER_ACRO: ClassVar[str] = 'ACRO'
    MODE_APM_COPTER_ALT_HOLD: ClassVar[str] = 'ALT_HOLD'
    MODE_APM_COPTER_AUTO: ClassVar[str] = 'AUTO'
    MODE_APM_COPTER_GUIDED: ClassVar[str] = 'GUIDED'
    MODE_APM_COPTER_LOITER: ClassVar[str] = 'LOITER'
    MODE_APM_COPTER_RTL: ClassVar[str] = 'RTL'
    MODE_APM_COPTER_CIRCLE: ClassVar[str] = 'CIRCLE'
    MODE_APM_COPTER_POSITION: ClassVar[str] = 'POSITION'
    MODE_APM_COPTER_LAND: ClassVar[str] = 'LAND'
    MODE_APM_COPTER_OF_LOITER: ClassVar[str] = 'OF_LOITER'
    MODE_APM_COPTER_DRIFT: ClassVar[str] = 'DRIFT'
    MODE_APM_COPTER_SPORT: ClassVar[str] = 'SPORT'
    MODE_APM_COPTER_FLIP: ClassVar[str] = 'FLIP'
    MODE_APM_COPTER_AUTOTUNE: ClassVar[str] = 'AUTOTUNE'
    MODE_APM_COPTER_POSHOLD: ClassVar[str] = 'POSHOLD'
    MODE_APM_COPTER_BRAKE: ClassVar[str] = 'BRAKE'
    MODE_APM_COPTER_THROW: ClassVar[str] = 'THROW'
    MODE_APM_COPTER_AVOID_ADSB: ClassVar[str] = 'AVOID_ADSB'
    MODE_APM_COPTER_GUIDED_NOGPS: ClassVar[str] = 'GUIDED_NOGPS'
    MODE_APM_ROVER_MANUAL: ClassVar[str] = 'MANUAL'
    MODE_APM_ROVER_LEARNING: ClassVar[str] = 'LEARNING'
    MODE_APM_ROVER_STEERING: ClassVar[str] = 'STEERING'
    MODE_APM_ROVER_HOLD: ClassVar[str] = 'HOLD'
    MODE_APM_ROVER_AUTO: ClassVar[str] = 'AUTO'
    MODE_APM_ROVER_RTL: ClassVar[str] = 'RTL'
    MODE_APM_ROVER_GUIDED: ClassVar[str] = 'GUIDED'
    MODE_APM_ROVER_INITIALISING: ClassVar[str] = 'INITIALISING'
    MODE_PX4_MANUAL: ClassVar[str] = 'MANUAL'
    MODE_PX4_ACRO: ClassVar[str] = 'ACRO'
    MODE_PX4_ALTITUDE: ClassVar[str] = 'ALTCTL'
    MODE_PX4_POSITION: ClassVar[str] = 'POSCTL'
    MODE_PX4_OFFBOARD: ClassVar[str] = 'OFFBOARD'
    MODE_PX4_STABILIZED: ClassVar[str] = 'STABILIZED'
    MODE_PX4_RATTITUDE: ClassVar[str] = 'RATTITUDE'
    MODE_PX4_MISSION: ClassVar[str] = 'AUTO.MISSION'
    MODE_PX4_LOITER: ClassVar[str] = 'AUTO.LOITER'
    MODE_PX4_RTL: ClassVar[str] = 'AUTO.RTL'
    MODE_PX4_LAND: ClassVar[str] = 'AUTO.LAND'
    MODE_PX4_RTGS: ClassVar[str] = 'AUTO.RTGS'
    MODE_PX4_READY: ClassVar[str] = 'AUTO.READY'
    MODE_PX4_TAKEOFF: ClassVar[str] = 'AUTO.TAKEOFF'
    __msgtype__: ClassVar[str]

@dataclass
class StatusText:
    """`mavros_msgs/msg/StatusText`"""
    header: Header
    severity: int
    text: str
    EMERGENCY: ClassVar[int] = 0
    ALERT: ClassVar[int] = 1
    CRITICAL: ClassVar[int] = 2
    ERROR: ClassVar[int] = 3
    WARNING: ClassVar[int] = 4
    NOTICE: ClassVar[int] = 5
    INFO: ClassVar[int] = 6
    DEBUG: ClassVar[int] = 7
    __msgtype__: ClassVar[str]

@dataclass
class SysStatus:
    """`mavros_msgs/msg/SysStatus`"""
    header: Header
    sensors_present: int
    sensors_enabled: int
    sensors_health: int
    load: int
    voltage_battery: int
    current_battery: int
    battery_remaining: int
    drop_rate_comm: int
    errors_comm: int
    errors_count1: int
    errors_count2: int
    errors_count3: int
    errors_count4: int
    __msgtype__: ClassVar[str]

@dataclass
class Thrust:
    """`mavros_msgs/msg/Thrust`"""
    header: Header
    thrust: float
    __msgtype__: ClassVar[str]

@dataclass
class TimesyncStatus:
    """`mavros_msgs/msg/TimesyncStatus`"""
    header: Header
    remote_timestamp_ns: int
    observed_offset_ns: int
    estimated_offset_ns: int
    round_trip_time_ms: float
    __msgtype__: ClassVar[str]

@dataclass
class VfrHud:
    """`mavros_msgs/msg/VfrHud`"""
    header: Header
    airspeed: float
    groundspeed: float
    heading: int
    throttle: float
    altitude: float
    climb: float
    __msgtype__: ClassVar[str]

@dataclass
class Waypoint:
    """`mavros_msgs/msg/Waypoint`"""
    frame: int
    command: int
    is_current: bool
    autocontinue: bool
    param1: float
    param2: float
    param3: float
    param4: float
    x_lat: float
    y_long: float
    z_alt: float
    FRAME_GLOBAL: ClassVar[int] = 0
    FRAME_LOCAL_NED: ClassVar[int] = 1
    FRAME_MISSION: ClassVar[int] = 2
    FRAME_GLOBAL_REL_ALT: ClassVar[int] = 3
    FRAME_LOCAL_ENU: ClassVar[int] = 4
    FRAME_GLOBAL_INT: ClassVar[int] = 5
    FRAME_GLOBAL_RELATIVE_ALT_INT: ClassVar[int] = 6
    FRAME_LOCAL_OFFSET_NED: ClassVar[int] = 7
    FRAME_BODY_NED: ClassVar[int] = 8
    FRAME_BODY_OFFSET_NED: ClassVar[int] = 9
    FRAME_GLOBAL_TERRAIN_ALT: ClassVar[int] = 10
    FRAME_GLOBAL_TERRAIN_ALT_INT: ClassVar[int] = 11
    FRAME_BODY_FRD: ClassVar[int] = 12
    FRAME_RESERVED_13: ClassVar[int] = 13
    FRAME_RESERVED_14: ClassVar[int] = 14
    FRAME_RESERVED_15: ClassVar[int] = 15
    FRAME_RESERVED_16: ClassVar[int] = 16
    FRAME_RESERVED_17: ClassVar[int] = 17
    FRAME_RESERVED_18: ClassVar[int] = 18
    FRAME_RESERVED_19: ClassVar[int] = 19
    FRAME_LOCAL_FRD: ClassVar[int] = 20
    FRAME_LOCAL_FLU: ClassVar[int] = 21
    __msgtype__: ClassVar[str]

@dataclass
class WaypointList:
    """`mavros_msgs/msg/WaypointList`"""
    current_seq: int
    waypoints: list[Waypoint]
    __msgtype__: ClassVar[str]

@dataclass
class WaypointReached:
    """`mavros_msgs/msg/WaypointReached`"""
    header: Header
    wp_seq: int
    __msgtype__: ClassVar[str]

@dataclass
class CommandAck_Request(ServiceRequest[CommandAck_Request, CommandAck_Response]):
    """`mavros_msgs/srv/CommandAck_Request`"""
    command: int
    result: int
    progress: int
    result_param2: int
    __msgtype__: ClassVar[str]

@dataclass
class CommandAck_Response:
    """`mavros_msgs/srv/CommandAck_Response`"""
    success: bool
    result: int
    __msgtype__: ClassVar[str]

@dataclass
class CommandBool_Request(ServiceRequest[CommandBool_Request, CommandBool_Response]):
    """`mavros_msgs/srv/CommandBool_Request`"""
    value: bool
    __msgtype__: ClassVar[str]

@dataclass
class CommandBool_Response:
    """`mavros_msgs/srv/CommandBool_Response`"""
    success: bool
    result: int
    __msgtype__: ClassVar[str]

@dataclass
class CommandHome_Request(ServiceRequest[CommandHome_Request, CommandHome_Response]):
    """`mavros_msgs/srv/CommandHome_Request`"""
    current_gps: bool
    yaw: float
    latitude: float
    longitude: float
    altitude: float
    __msgtype__: ClassVar[str]

@dataclass
class CommandHome_Response:
    """`mavros_msgs/srv/CommandHome_Response`"""
    success: bool
    result: int
    __msgtype__: ClassVar[str]

@dataclass
class CommandInt_Request(ServiceRequest[CommandInt_Request, CommandInt_Response]):
    """`mavros_msgs/srv/CommandInt_Request`"""
    broadcast: bool
    frame: int
    command: int
    current: int
    autocontinue: int
    param1: float
    param2: float
    param3: float
    param4: float
    x: int
    y: int
    z: float
    __msgtype__: ClassVar[str]

@dataclass
class CommandInt_Response:
    """`mavros_msgs/srv/CommandInt_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class CommandLong_Request(ServiceRequest[CommandLong_Request, CommandLong_Response]):
    """`mavros_msgs/srv/CommandLong_Request`"""
    broadcast: bool
    command: int
    confirmation: int
    param1: float
    param2: float
    param3: float
    param4: float
    param5: float
    param6: float
    param7: float
    __msgtype__: ClassVar[str]

@dataclass
class CommandLong_Response:
    """`mavros_msgs/srv/CommandLong_Response`"""
    success: bool
    result: int
    __msgtype__: ClassVar[str]

@dataclass
class CommandTOL_Request(ServiceRequest[CommandTOL_Request, CommandTOL_Response]):
    """`mavros_msgs/srv/CommandTOL_Request`"""
    min_pitch: float
    yaw: float
    latitude: float
    longitude: float
    altitude: float
    __msgtype__: ClassVar[str]

@dataclass
class CommandTOL_Response:
    """`mavros_msgs/srv/CommandTOL_Response`"""
    success: bool
    result: int
    __msgtype__: ClassVar[str]

@dataclass
class CommandVtolTransition_Request(ServiceRequest[CommandVtolTransition_Request, CommandVtolTransition_Response]):
    """`mavros_msgs/srv/CommandVtolTransition_Request`"""
    header: Header
    state: int
    STATE_MC: ClassVar[int] = 3
    STATE_FW: ClassVar[int] = 4
    __msgtype__: ClassVar[str]

@dataclass
class CommandVtolTransition_Response:
    """`mavros_msgs/srv/CommandVtolTransition_Response`"""
    success: bool
    result: int
    __msgtype__: ClassVar[str]

@dataclass
class MessageInterval_Request(ServiceRequest[MessageInterval_Request, MessageInterval_Response]):
    """`mavros_msgs/srv/MessageInterval_Request`"""
    message_id: int
    message_rate: float
    __msgtype__: ClassVar[str]

@dataclass
class MessageInterval_Response:
    """`mavros_msgs/srv/MessageInterval_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class ParamGet_Request(ServiceRequest[ParamGet_Request, ParamGet_Response]):
    """`mavros_msgs/srv/ParamGet_Request`"""
    param_id: str
    __msgtype__: ClassVar[str]

@dataclass
class ParamGet_Response:
    """`mavros_msgs/srv/ParamGet_Response`"""
    success: bool
    value: ParamValue
    __msgtype__: ClassVar[str]

@dataclass
class ParamPull_Request(ServiceRequest[ParamPull_Request, ParamPull_Response]):
    """`mavros_msgs/srv/ParamPull_Request`"""
    force_pull: bool
    __msgtype__: ClassVar[str]

@dataclass
class ParamPull_Response:
    """`mavros_msgs/srv/ParamPull_Response`"""
    success: bool
    param_received: int
    __msgtype__: ClassVar[str]

@dataclass
class ParamSetV2_Request(ServiceRequest[ParamSetV2_Request, ParamSetV2_Response]):
    """`mavros_msgs/srv/ParamSetV2_Request`"""
    force_set: bool
    param_id: str
    value: ParameterValue
    __msgtype__: ClassVar[str]

@dataclass
class ParamSetV2_Response:
    """`mavros_msgs/srv/ParamSetV2_Response`"""
    success: bool
    value: ParameterValue
    __msgtype__: ClassVar[str]

@dataclass
class ParamSet_Request(ServiceRequest[ParamSet_Request, ParamSet_Response]):
    """`mavros_msgs/srv/ParamSet_Request`"""
    param_id: str
    value: ParamValue
    __msgtype__: ClassVar[str]

@dataclass
class ParamSet_Response:
    """`mavros_msgs/srv/ParamSet_Response`"""
    success: bool
    value: ParamValue
    __msgtype__: ClassVar[str]

@dataclass
class SetMavFrame_Request(ServiceRequest[SetMavFrame_Request, SetMavFrame_Response]):
    """`mavros_msgs/srv/SetMavFrame_Request`"""
    mav_frame: int
    FRAME_GLOBAL: ClassVar[int] = 0
    FRAME_LOCAL_NED: ClassVar[int] = 1
    FRAME_MISSION: ClassVar[int] = 2
    FRAME_GLOBAL_RELATIVE_ALT: ClassVar[int] = 3
    FRAME_LOCAL_ENU: ClassVar[int] = 4
    FRAME_GLOBAL_INT: ClassVar[int] = 5
    FRAME_GLOBAL_RELATIVE_ALT_INT: ClassVar[int] = 6
    FRAME_LOCAL_OFFSET_NED: ClassVar[int] = 7
    FRAME_BODY_NED: ClassVar[int] = 8
    FRAME_BODY_OFFSET_NED: ClassVar[int] = 9
    FRAME_GLOBAL_TERRAIN_ALT: ClassVar[int] = 10
    FRAME_GLOBAL_TERRAIN_ALT_INT: ClassVar[int] = 11
    FRAME_BODY_FRD: ClassVar[int] = 12
    FRAME_RESERVED_13: ClassVar[int] = 13
    FRAME_RESERVED_14: ClassVar[int] = 14
    FRAME_RESERVED_15: ClassVar[int] = 15
    FRAME_RESERVED_16: ClassVar[int] = 16
    FRAME_RESERVED_17: ClassVar[int] = 17
    FRAME_RESERVED_18: ClassVar[int] = 18
    FRAME_RESERVED_19: ClassVar[int] = 19
    FRAME_LOCAL_FRD: ClassVar[int] = 20
    FRAME_LOCAL_FLU: ClassVar[int] = 21
    __msgtype__: ClassVar[str]

@dataclass
class SetMavFrame_Response:
    """`mavros_msgs/srv/SetMavFrame_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class SetMode_Request(ServiceRequest[SetMode_Request, SetMode_Response]):
    """`mavros_msgs/srv/SetMode_Request`"""
    base_mode: int
    custom_mode: str
    MAV_MODE_PREFLIGHT: ClassVar[int] = 0
    MAV_MODE_STABILIZE_DISARMED: ClassVar[int] = 80
    MAV_MODE_STABILIZE_ARMED: ClassVar[int] = 208
    MAV_MODE_MANUAL_DISARMED: ClassVar[int] = 64
    MAV_MODE_MANUAL_ARMED: ClassVar[int] = 192
    MAV_MODE_GUIDED_DISARMED: ClassVar[int] = 88
    MAV_MODE_GUIDED_ARMED: ClassVar[int] = 216
    MAV_MODE_AUTO_DISARMED: ClassVar[int] = 92
    MAV_MODE_AUTO_ARMED: ClassVar[int] = 220
    MAV_MODE_TEST_DISARMED: ClassVar[int] = 66
    MAV_MODE_TEST_ARMED: ClassVar[int] = 194
    __msgtype__: ClassVar[str]

@dataclass
class SetMode_Response:
    """`mavros_msgs/srv/SetMode_Response`"""
    mode_sent: bool
    __msgtype__: ClassVar[str]

@dataclass
class StreamRate_Request(ServiceRequest[StreamRate_Request, StreamRate_Response]):
    """`mavros_msgs/srv/StreamRate_Request`"""
    stream_id: int
    message_rate: int
    on_off: bool
    STREAM_ALL: ClassVar[int] = 0
    STREAM_RAW_SENSORS: ClassVar[int] = 1
    STREAM_EXTENDED_STATUS: ClassVar[int] = 2
    STREAM_RC_CHANNELS: ClassVar[int] = 3
    STREAM_RAW_CONTROLLER: ClassVar[int] = 4
    STREAM_POSITION: ClassVar[int] = 6
    STREAM_EXTRA1: ClassVar[int] = 10
    STREAM_EXTRA2: ClassVar[int] = 11
    STREAM_EXTRA3: ClassVar[int] = 12
    __msgtype__: ClassVar[str]

@dataclass
class StreamRate_Response:
    """`mavros_msgs/srv/StreamRate_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class WaypointClear_Request(ServiceRequest[WaypointClear_Request, WaypointClear_Response]):
    """`mavros_msgs/srv/WaypointClear_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class WaypointClear_Response:
    """`mavros_msgs/srv/WaypointClear_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class WaypointPull_Request(ServiceRequest[WaypointPull_Request, WaypointPull_Response]):
    """`mavros_msgs/srv/WaypointPull_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class WaypointPull_Response:
    """`mavros_msgs/srv/WaypointPull_Response`"""
    success: bool
    wp_received: int
    __msgtype__: ClassVar[str]

@dataclass
class WaypointPush_Request(ServiceRequest[WaypointPush_Request, WaypointPush_Response]):
    """`mavros_msgs/srv/WaypointPush_Request`"""
    start_index: int
    waypoints: list[Waypoint]
    __msgtype__: ClassVar[str]

@dataclass
class WaypointPush_Response:
    """`mavros_msgs/srv/WaypointPush_Response`"""
    success: bool
    wp_transfered: int
    __msgtype__: ClassVar[str]

@dataclass
class WaypointSetCurrent_Request(ServiceRequest[WaypointSetCurrent_Request, WaypointSetCurrent_Response]):
    """`mavros_msgs/srv/WaypointSetCurrent_Request`"""
    wp_seq: int
    __msgtype__: ClassVar[str]

@dataclass
class WaypointSetCurrent_Response:
    """`mavros_msgs/srv/WaypointSetCurrent_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

# move_base_msgs

@dataclass
class MoveBase_Feedback:
    """`move_base_msgs/action/MoveBase_Feedback`"""
    base_position: PoseStamped
    __msgtype__: ClassVar[str]

@dataclass
class MoveBase_Goal(ActionGoal[MoveBase_Goal, MoveBase_Result, MoveBase_Feedback]):
    """`move_base_msgs/action/MoveBase_Goal`"""
    target_pose: PoseStamped
    __msgtype__: ClassVar[str]

@dataclass
class MoveBase_Result:
    """`move_base_msgs/action/MoveBase_Result`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class RecoveryStatus:
    """`move_base_msgs/msg/RecoveryStatus`"""
    pose_stamped: PoseStamped
    current_recovery_number: int
    total_number_of_recoveries: int
    recovery_behavior_name: str
    __msgtype__: ClassVar[str]

# moveit_msgs

@dataclass
class ExecuteTrajectory_Feedback:
    """`moveit_msgs/action/ExecuteTrajectory_Feedback`"""
    state: str
    __msgtype__: ClassVar[str]

@dataclass
class ExecuteTrajectory_Goal(ActionGoal[ExecuteTrajectory_Goal, ExecuteTrajectory_Result, ExecuteTrajectory_Feedback]):
    """`moveit_msgs/action/ExecuteTrajectory_Goal`"""
    trajectory: RobotTrajectory
    controller_names: list[str]
    __msgtype__: ClassVar[str]

@dataclass
class ExecuteTrajectory_Result:
    """`moveit_msgs/action/ExecuteTrajectory_Result`"""
    error_code: MoveItErrorCodes
    __msgtype__: ClassVar[str]

@dataclass
class MoveGroupSequence_Feedback:
    """`moveit_msgs/action/MoveGroupSequence_Feedback`"""
    state: str
    __msgtype__: ClassVar[str]

@dataclass
class MoveGroupSequence_Goal(ActionGoal[MoveGroupSequence_Goal, MoveGroupSequence_Result, MoveGroupSequence_Feedback]):
    """`moveit_msgs/action/MoveGroupSequence_Goal`"""
    request: MotionSequenceRequest
    planning_options: PlanningOptions
    __msgtype__: ClassVar[str]

@dataclass
class MoveGroupSequence_Result:
    """`moveit_msgs/action/MoveGroupSequence_Result`"""
    response: MotionSequenceResponse
    __msgtype__: ClassVar[str]

@dataclass
class MoveGroup_Feedback:
    """`moveit_msgs/action/MoveGroup_Feedback`"""
    state: str
    __msgtype__: ClassVar[str]

@dataclass
class MoveGroup_Goal(ActionGoal[MoveGroup_Goal, MoveGroup_Result, MoveGroup_Feedback]):
    """`moveit_msgs/action/MoveGroup_Goal`"""
    request: MotionPlanRequest
    planning_options: PlanningOptions
    __msgtype__: ClassVar[str]

@dataclass
class MoveGroup_Result:
    """`moveit_msgs/action/MoveGroup_Result`"""
    error_code: MoveItErrorCodes
    trajectory_start: RobotState
    planned_trajectory: RobotTrajectory
    executed_trajectory: RobotTrajectory
    planning_time: float
    __msgtype__: ClassVar[str]

@dataclass
class Pickup_Feedback:
    """`moveit_msgs/action/Pickup_Feedback`"""
    state: str
    __msgtype__: ClassVar[str]

@dataclass
class Pickup_Goal(ActionGoal[Pickup_Goal, Pickup_Result, Pickup_Feedback]):
    """`moveit_msgs/action/Pickup_Goal`"""
    target_name: str
    group_name: str
    end_effector: str
    possible_grasps: list[Grasp]
    support_surface_name: str
    allow_gripper_support_collision: bool
    attached_object_touch_links: list[str]
    minimize_object_distance: bool
    path_constraints: Constraints
    planner_id: str
    allowed_touch_objects: list[str]
    allowed_planning_time: float
    planning_options: PlanningOptions
    __msgtype__: ClassVar[str]

@dataclass
class Pickup_Result:
    """`moveit_msgs/action/Pickup_Result`"""
    error_code: MoveItErrorCodes
    trajectory_start: RobotState
    trajectory_stages: list[RobotTrajectory]
    trajectory_descriptions: list[str]
    grasp: Grasp
    planning_time: float
    __msgtype__: ClassVar[str]

@dataclass
class Place_Feedback:
    """`moveit_msgs/action/Place_Feedback`"""
    state: str
    __msgtype__: ClassVar[str]

@dataclass
class Place_Goal(ActionGoal[Place_Goal, Place_Result, Place_Feedback]):
    """`moveit_msgs/action/Place_Goal`"""
    group_name: str
    attached_object_name: str
    place_locations: list[PlaceLocation]
    place_eef: bool
    support_surface_name: str
    allow_gripper_support_collision: bool
    path_constraints: Constraints
    planner_id: str
    allowed_touch_objects: list[str]
    allowed_planning_time: float
    planning_options: PlanningOptions
    __msgtype__: ClassVar[str]

@dataclass
class Place_Result:
    """`moveit_msgs/action/Place_Result`"""
    error_code: MoveItErrorCodes
    trajectory_start: RobotState
    trajectory_stages: list[RobotTrajectory]
    trajectory_descriptions: list[str]
    place_location: PlaceLocation
    planning_time: float
    __msgtype__: ClassVar[str]

@dataclass
class AllowedCollisionEntry:
    """`moveit_msgs/msg/AllowedCollisionEntry`"""
    enabled: NDArray[np.bool_]
    __msgtype__: ClassVar[str]

@dataclass
class AllowedCollisionMatrix:
    """`moveit_msgs/msg/AllowedCollisionMatrix`"""
    entry_names: list[str]
    entry_values: list[AllowedCollisionEntry]
    default_entry_names: list[str]
    default_entry_values: NDArray[np.bool_]
    __msgtype__: ClassVar[str]

@dataclass
class AttachedCollisionObject:
    """`moveit_msgs/msg/AttachedCollisionObject`"""
    link_name: str
    object: CollisionObject
    touch_links: list[str]
    detach_posture: JointTrajectory
    weight: float
    __msgtype__: ClassVar[str]

@dataclass
class BoundingVolume:
    """`moveit_msgs/msg/BoundingVolume`"""
    primitives: list[SolidPrimitive]
    primitive_poses: list[Pose]
    meshes: list[Mesh]
    mesh_poses: list[Pose]
    __msgtype__: ClassVar[str]

@dataclass
class CartesianPoint:
    """`moveit_msgs/msg/CartesianPoint`"""
    pose: Pose
    velocity: Twist
    acceleration: Accel
    __msgtype__: ClassVar[str]

@dataclass
class CartesianTrajectory:
    """`moveit_msgs/msg/CartesianTrajectory`"""
    header: Header
    tracked_frame: str
    points: list[CartesianTrajectoryPoint]
    __msgtype__: ClassVar[str]

@dataclass
class CartesianTrajectoryPoint:
    """`moveit_msgs/msg/CartesianTrajectoryPoint`"""
    point: CartesianPoint
    time_from_start: Duration
    __msgtype__: ClassVar[str]

@dataclass
class CollisionObject:
    """`moveit_msgs/msg/CollisionObject`"""
    header: Header
    pose: Pose
    id: str
    type: ObjectType
    primitives: list[SolidPrimitive]
    primitive_poses: list[Pose]
    meshes: list[Mesh]
    mesh_poses: list[Pose]
    planes: list[Plane]
    plane_poses: list[Pose]
    subframe_names: list[str]
    subframe_poses: list[Pose]
    operation: int
    ADD: ClassVar[int] = 0
    REMOVE: ClassVar[int] = 1
    APPEND: ClassVar[int] = 2
    MOVE: ClassVar[int] = 3
    __msgtype__: ClassVar[str]

@dataclass
class ConstraintEvalResult:
    """`moveit_msgs/msg/ConstraintEvalResult`"""
    result: bool
    distance: float
    __msgtype__: ClassVar[str]

@dataclass
class Constraints:
    """`moveit_msgs/msg/Constraints`"""
    name: str
    joint_constraints: list[JointConstraint]
    position_constraints: list[PositionConstraint]
    orientation_constraints: list[OrientationConstraint]
    visibility_constraints: list[VisibilityConstraint]
    __msgtype__: ClassVar[str]

@dataclass
class ContactInformation:
    """`moveit_msgs/msg/ContactInformation`"""
    header: Header
    position: Point
    normal: Vector3
    depth: float
    contact_body_1: str
    body_type_1: int
    contact_body_2: str
    body_type_2: int
    ROBOT_LINK: ClassVar[int] = 0
    WORLD_OBJECT: ClassVar[int] = 1
    ROBOT_ATTACHED: ClassVar[int] = 2
    __msgtype__: ClassVar[str]

@dataclass
class CostSource:
    """`moveit_msgs/msg/CostSource`"""
    cost_density: float
    aabb_min: Vector3
    aabb_max: Vector3
    __msgtype__: ClassVar[str]

@dataclass
class DisplayRobotState:
    """`moveit_msgs/msg/DisplayRobotState`"""
    state: RobotState
    highlight_links: list[ObjectColor]
    hide: bool
    __msgtype__: ClassVar[str]

@dataclass
class DisplayTrajectory:
    """`moveit_msgs/msg/DisplayTrajectory`"""
    model_id: str
    trajectory: list[RobotTrajectory]
    trajectory_start: RobotState
    __msgtype__: ClassVar[str]

@dataclass
class GenericTrajectory:
    """`moveit_msgs/msg/GenericTrajectory`"""
    header: Header
    joint_trajectory: list[JointTrajectory]
    cartesian_trajectory: list[CartesianTrajectory]
    __msgtype__: ClassVar[str]

@dataclass
class Grasp:
    """`moveit_msgs/msg/Grasp`"""
    id: str
    pre_grasp_posture: JointTrajectory
    grasp_posture: JointTrajectory
    grasp_pose: PoseStamped
    grasp_quality: float
    pre_grasp_approach: GripperTranslation
    post_grasp_retreat: GripperTranslation
    post_place_retreat: GripperTranslation
    max_contact_force: float
    allowed_touch_objects: list[str]
    __msgtype__: ClassVar[str]

@dataclass
class GripperTranslation:
    """`moveit_msgs/msg/GripperTranslation`"""
    direction: Vector3Stamped
    desired_distance: float
    min_distance: float
    __msgtype__: ClassVar[str]

@dataclass
class JointConstraint:
    """`moveit_msgs/msg/JointConstraint`"""
    joint_name: str
    position: float
    tolerance_above: float
    tolerance_below: float
    weight: float
    __msgtype__: ClassVar[str]

@dataclass
class JointLimits:
    """`moveit_msgs/msg/JointLimits`"""
    joint_name: str
    has_position_limits: bool
    min_position: float
    max_position: float
    has_velocity_limits: bool
    max_velocity: float
    has_acceleration_limits: bool
    max_acceleration: float
    __msgtype__: ClassVar[str]

@dataclass
class KinematicSolverInfo:
    """`moveit_msgs/msg/KinematicSolverInfo`"""
    joint_names: list[str]
    limits: list[JointLimits]
    link_names: list[str]
    __msgtype__: ClassVar[str]

@dataclass
class LinkPadding:
    """`moveit_msgs/msg/LinkPadding`"""
    link_name: str
    padding: float
    __msgtype__: ClassVar[str]

@dataclass
class LinkScale:
    """`moveit_msgs/msg/LinkScale`"""
    link_name: str
    scale: float
    __msgtype__: ClassVar[str]

@dataclass
class MotionPlanDetailedResponse:
    """`moveit_msgs/msg/MotionPlanDetailedResponse`"""
    trajectory_start: RobotState
    group_name: str
    trajectory: list[RobotTrajectory]
    description: list[str]
    processing_time: NDArray[np.float64]
    error_code: MoveItErrorCodes
    __msgtype__: ClassVar[str]

@dataclass
class MotionPlanRequest:
    """`moveit_msgs/msg/MotionPlanRequest`"""
    workspace_parameters: WorkspaceParameters
    start_state: RobotState
    goal_constraints: list[Constraints]
    path_constraints: Constraints
    trajectory_constraints: TrajectoryConstraints
    reference_trajectories: list[GenericTrajectory]
    pipeline_id: str
    planner_id: str
    group_name: str
    num_planning_attempts: int
    allowed_planning_time: float
    max_velocity_scaling_factor: float
    max_acceleration_scaling_factor: float
    cartesian_speed_limited_link: str
    max_cartesian_speed: float
    __msgtype__: ClassVar[str]

@dataclass
class MotionPlanResponse:
    """`moveit_msgs/msg/MotionPlanResponse`"""
    trajectory_start: RobotState
    group_name: str
    trajectory: RobotTrajectory
    planning_time: float
    error_code: MoveItErrorCodes
    __msgtype__: ClassVar[str]

@dataclass
class MotionSequenceItem:
    """`moveit_msgs/msg/MotionSequenceItem`"""
    req: MotionPlanRequest
    blend_radius: float
    __msgtype__: ClassVar[str]

@dataclass
class MotionSequenceRequest:
    """`moveit_msgs/msg/MotionSequenceRequest`"""
    items: list[MotionSequenceItem]
    __msgtype__: ClassVar[str]

@dataclass
class MotionSequenceResponse:
    """`moveit_msgs/msg/MotionSequenceResponse`"""
    error_code: MoveItErrorCodes
    sequence_start: RobotState
    planned_trajectories: list[RobotTrajectory]
    planning_time: float
    __msgtype__: ClassVar[str]

@dataclass
class MoveItErrorCodes:
    """`moveit_msgs/msg/MoveItErrorCodes`"""
    val: int
    message: str
    source: str
    SUCCESS: ClassVar[int] = 1
    UNDEFINED: ClassVar[int] = 0
    FAILURE: ClassVar[int] = 99999
    PLANNING_FAILED: ClassVar[int] = -1
    INVALID_MOTION_PLAN: ClassVar[int] = -2
    MOTION_PLAN_INVALIDATED_BY_ENVIRONMENT_CHANGE: ClassVar[int] = -3
    CONTROL_FAILED: ClassVar[int] = -4
    UNABLE_TO_AQUIRE_SENSOR_DATA: ClassVar[int] = -5
    TIMED_OUT: ClassVar[int] = -6
    PREEMPTED: ClassVar[int] = -7
    START_STATE_IN_COLLISION: ClassVar[int] = -10
    START_STATE_VIOLATES_PATH_CONSTRAINTS: ClassVar[int] = -11
    START_STATE_INVALID: ClassVar[int] = -26
    GOAL_IN_COLLISION: ClassVar[int] = -12
    GOAL_VIOLATES_PATH_CONSTRAINTS: ClassVar[int] = -13
    GOAL_CONSTRAINTS_VIOLATED: ClassVar[int] = -14
    GOAL_STATE_INVALID: ClassVar[int] = -27
    UNRECOGNIZED_GOAL_TYPE: ClassVar[int] = -28
    INVALID_GROUP_NAME: ClassVar[int] = -15
    INVALID_GOAL_CONSTRAINTS: ClassVar[int] = -16
    INVALID_ROBOT_STATE: ClassVar[int] = -17
    INVALID_LINK_NAME: ClassVar[int] = -18
    INVALID_OBJECT_NAME: ClassVar[int] = -19
    FRAME_TRANSFORM_FAILURE: ClassVar[int] = -21
    COLLISION_CHECKING_UNAVAILABLE: ClassVar[int] = -22
    ROBOT_STATE_STALE: ClassVar[int] = -23
    SENSOR_INFO_STALE: ClassVar[int] = -24
    COMMUNICATION_FAILURE: ClassVar[int] = -25
    CRASH: ClassVar[int] = -29
    ABORT: ClassVar[int] = -30
    NO_IK_SOLUTION: ClassVar[int] = -31
    __msgtype__: ClassVar[str]

@dataclass
class ObjectColor:
    """`moveit_msgs/msg/ObjectColor`"""
    id: str
    color: ColorRGBA
    __msgtype__: ClassVar[str]

@dataclass
class OrientationConstraint:
    """`moveit_msgs/msg/OrientationConstraint`"""
    header: Header
    orientation: Quaternion
    link_name: str
    absolute_x_axis_tolerance: float
    absolute_y_axis_tolerance: float
    absolute_z_axis_tolerance: float
    parameterization: int
    weight: float
    XYZ_EULER_ANGLES: ClassVar[int] = 0
    ROTATION_VECTOR: ClassVar[int] = 1
    __msgtype__: ClassVar[str]

@dataclass
class OrientedBoundingBox:
    """`moveit_msgs/msg/OrientedBoundingBox`"""
    pose: Pose
    extents: Point32
    __msgtype__: ClassVar[str]

@dataclass
class PlaceLocation:
    """`moveit_msgs/msg/PlaceLocation`"""
    id: str
    post_place_posture: JointTrajectory
    place_pose: PoseStamped
    quality: float
    pre_place_approach: GripperTranslation
    post_place_retreat: GripperTranslation
    allowed_touch_objects: list[str]
    __msgtype__: ClassVar[str]

@dataclass
class PlannerInterfaceDescription:
    """`moveit_msgs/msg/PlannerInterfaceDescription`"""
    name: str
    pipeline_id: str
    planner_ids: list[str]
    __msgtype__: ClassVar[str]

@dataclass
class PlannerParams:
    """`moveit_msgs/msg/PlannerParams`"""
    keys: list[str]
    values: list[str]
    descriptions: list[str]
    __msgtype__: ClassVar[str]

@dataclass
class PlanningOptions:
    """`moveit_msgs/msg/PlanningOptions`"""
    planning_scene_diff: PlanningScene
    plan_only: bool
    look_around: bool
    look_around_attempts: int
    max_safe_execution_cost: float
    replan: bool
    replan_attempts: int
    replan_delay: float
    __msgtype__: ClassVar[str]

@dataclass
class PlanningScene:
    """`moveit_msgs/msg/PlanningScene`"""
    name: str
    robot_state: RobotState
    robot_model_name: str
    fixed_frame_transforms: list[TransformStamped]
    allowed_collision_matrix: AllowedCollisionMatrix
    link_padding: list[LinkPadding]
    link_scale: list[LinkScale]
    object_colors: list[ObjectColor]
    world: PlanningSceneWorld
    is_diff: bool
    __msgtype__: ClassVar[str]

@dataclass
class PlanningSceneComponents:
    """`moveit_msgs/msg/PlanningSceneComponents`"""
    components: int
    SCENE_SETTINGS: ClassVar[int] = 1
    ROBOT_STATE: ClassVar[int] = 2
    ROBOT_STATE_ATTACHED_OBJECTS: ClassVar[int] = 4
    WORLD_OBJECT_NAMES: ClassVar[int] = 8
    WORLD_OBJECT_GEOMETRY: ClassVar[int] = 16
    OCTOMAP: ClassVar[int] = 32
    TRANSFORMS: ClassVar[int] = 64
    ALLOWED_COLLISION_MATRIX: ClassVar[int] = 128
    LINK_PADDING_AND_SCALING: ClassVar[int] = 256
    OBJECT_COLORS: ClassVar[int] = 512
    __msgtype__: ClassVar[str]

@dataclass
class PlanningSceneWorld:
    """`moveit_msgs/msg/PlanningSceneWorld`"""
    collision_objects: list[CollisionObject]
    octomap: OctomapWithPose
    __msgtype__: ClassVar[str]

@dataclass
class PositionConstraint:
    """`moveit_msgs/msg/PositionConstraint`"""
    header: Header
    link_name: str
    target_point_offset: Vector3
    constraint_region: BoundingVolume
    weight: float
    __msgtype__: ClassVar[str]

@dataclass
class PositionIKRequest:
    """`moveit_msgs/msg/PositionIKRequest`"""
    group_name: str
    robot_state: RobotState
    constraints: Constraints
    avoid_collisions: bool
    ik_link_name: str
    pose_stamped: PoseStamped
    ik_link_names: list[str]
    pose_stamped_vector: list[PoseStamped]
    timeout: Duration
    __msgtype__: ClassVar[str]

@dataclass
class RobotState:
    """`moveit_msgs/msg/RobotState`"""
    joint_state: JointState
    multi_dof_joint_state: MultiDOFJointState
    attached_collision_objects: list[AttachedCollisionObject]
    is_diff: bool
    __msgtype__: ClassVar[str]

@dataclass
class RobotTrajectory:
    """`moveit_msgs/msg/RobotTrajectory`"""
    joint_trajectory: JointTrajectory
    multi_dof_joint_trajectory: MultiDOFJointTrajectory
    __msgtype__: ClassVar[str]

@dataclass
class TrajectoryConstraints:
    """`moveit_msgs/msg/TrajectoryConstraints`"""
    constraints: list[Constraints]
    __msgtype__: ClassVar[str]

@dataclass
class VisibilityConstraint:
    """`moveit_msgs/msg/VisibilityConstraint`"""
    target_radius: float
    target_pose: PoseStamped
    cone_sides: int
    sensor_pose: PoseStamped
    max_view_angle: float
    max_range_angle: float
    sensor_view_direction: int
    weight: float
    SENSOR_Z: ClassVar[int] = 0
    SENSOR_Y: ClassVar[int] = 1
    SENSOR_X: ClassVar[int] = 2
    __msgtype__: ClassVar[str]

@dataclass
class WorkspaceParameters:
    """`moveit_msgs/msg/WorkspaceParameters`"""
    header: Header
    min_corner: Vector3
    max_corner: Vector3
    __msgtype__: ClassVar[str]

@dataclass
class ApplyPlanningScene_Request(ServiceRequest[ApplyPlanningScene_Request, ApplyPlanningScene_Response]):
    """`moveit_msgs/srv/ApplyPlanningScene_Request`"""
    scene: PlanningScene
    __msgtype__: ClassVar[str]

@dataclass
class ApplyPlanningScene_Response:
    """`moveit_msgs/srv/ApplyPlanningScene_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class ChangeControlDimensions_Request(ServiceRequest[ChangeControlDimensions_Request, ChangeControlDimensions_Response]):
    """`moveit_msgs/srv/ChangeControlDimensions_Request`"""
    control_x_translation: bool
    control_y_translation: bool
    control_z_translation: bool
    control_x_rotation: bool
    control_y_rotation: bool
    control_z_rotation: bool
    __msgtype__: ClassVar[str]

@dataclass
class ChangeControlDimensions_Response:
    """`moveit_msgs/srv/ChangeControlDimensions_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class ChangeDriftDimensions_Request(ServiceRequest[ChangeDriftDimensions_Request, ChangeDriftDimensions_Response]):
    """`moveit_msgs/srv/ChangeDriftDimensions_Request`"""
    drift_x_translation: bool
    drift_y_translation: bool
    drift_z_translation: bool
    drift_x_rotation: bool
    drift_y_rotation: bool
    drift_z_rotation: bool
    transform_jog_frame_to_drift_frame: Transform
    __msgtype__: ClassVar[str]

@dataclass
class ChangeDriftDimensions_Response:
    """`moveit_msgs/srv/ChangeDriftDimensions_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class CheckIfRobotStateExistsInWarehouse_Request(ServiceRequest[CheckIfRobotStateExistsInWarehouse_Request, CheckIfRobotStateExistsInWarehouse_Response]):
    """`moveit_msgs/srv/CheckIfRobotStateExistsInWarehouse_Request`"""
    name: str
    robot: str
    __msgtype__: ClassVar[str]

@dataclass
class CheckIfRobotStateExistsInWarehouse_Response:
    """`moveit_msgs/srv/CheckIfRobotStateExistsInWarehouse_Response`"""
    exists: bool
    __msgtype__: ClassVar[str]

@dataclass
class DeleteRobotStateFromWarehouse_Request(ServiceRequest[DeleteRobotStateFromWarehouse_Request, DeleteRobotStateFromWarehouse_Response]):
    """`moveit_msgs/srv/DeleteRobotStateFromWarehouse_Request`"""
    name: str
    robot: str
    __msgtype__: ClassVar[str]

@dataclass
class DeleteRobotStateFromWarehouse_Response:
    """`moveit_msgs/srv/DeleteRobotStateFromWarehouse_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class ExecuteKnownTrajectory_Request(ServiceRequest[ExecuteKnownTrajectory_Request, ExecuteKnownTrajectory_Response]):
    """`moveit_msgs/srv/ExecuteKnownTrajectory_Request`"""
    trajectory: RobotTrajectory
    wait_for_execution: bool
    __msgtype__: ClassVar[str]

@dataclass
class ExecuteKnownTrajectory_Response:
    """`moveit_msgs/srv/ExecuteKnownTrajectory_Response`"""
    error_code: MoveItErrorCodes
    __msgtype__: ClassVar[str]

@dataclass
class GetCartesianPath_Request(ServiceRequest[GetCartesianPath_Request, GetCartesianPath_Response]):
    """`moveit_msgs/srv/GetCartesianPath_Request`"""
    header: Header
    start_state: RobotState
    group_name: str
    link_name: str
    waypoints: list[Pose]
    max_step: float
    jump_threshold: float
    prismatic_jump_threshold: float
    revolute_jump_threshold: float
    avoid_collisions: bool
    path_constraints: Constraints
    max_velocity_scaling_factor: float
    max_acceleration_scaling_factor: float
    cartesian_speed_limited_link: str
    max_cartesian_speed: float
    __msgtype__: ClassVar[str]

@dataclass
class GetCartesianPath_Response:
    """`moveit_msgs/srv/GetCartesianPath_Response`"""
    start_state: RobotState
    solution: RobotTrajectory
    fraction: float
    error_code: MoveItErrorCodes
    __msgtype__: ClassVar[str]

@dataclass
class GetMotionPlan_Request(ServiceRequest[GetMotionPlan_Request, GetMotionPlan_Response]):
    """`moveit_msgs/srv/GetMotionPlan_Request`"""
    motion_plan_request: MotionPlanRequest
    __msgtype__: ClassVar[str]

@dataclass
class GetMotionPlan_Response:
    """`moveit_msgs/srv/GetMotionPlan_Response`"""
    motion_plan_response: MotionPlanResponse
    __msgtype__: ClassVar[str]

@dataclass
class GetMotionSequence_Request(ServiceRequest[GetMotionSequence_Request, GetMotionSequence_Response]):
    """`moveit_msgs/srv/GetMotionSequence_Request`"""
    request: MotionSequenceRequest
    __msgtype__: ClassVar[str]

@dataclass
class GetMotionSequence_Response:
    """`moveit_msgs/srv/GetMotionSequence_Response`"""
    response: MotionSequenceResponse
    __msgtype__: ClassVar[str]

@dataclass
class GetPlannerParams_Request(ServiceRequest[GetPlannerParams_Request, GetPlannerParams_Response]):
    """`moveit_msgs/srv/GetPlannerParams_Request`"""
    pipeline_id: str
    planner_config: str
    group: str
    __msgtype__: ClassVar[str]

@dataclass
class GetPlannerParams_Response:
    """`moveit_msgs/srv/GetPlannerParams_Response`"""
    params: PlannerParams
    __msgtype__: ClassVar[str]

@dataclass
class GetPlanningScene_Request(ServiceRequest[GetPlanningScene_Request, GetPlanningScene_Response]):
    """`moveit_msgs/srv/GetPlanningScene_Request`"""
    components: PlanningSceneComponents
    __msgtype__: ClassVar[str]

@dataclass
class GetPlanningScene_Response:
    """`moveit_msgs/srv/GetPlanningScene_Response`"""
    scene: PlanningScene
    __msgtype__: ClassVar[str]

@dataclass
class GetPositionFK_Request(ServiceRequest[GetPositionFK_Request, GetPositionFK_Response]):
    """`moveit_msgs/srv/GetPositionFK_Request`"""
    header: Header
    fk_link_names: list[str]
    robot_state: RobotState
    __msgtype__: ClassVar[str]

@dataclass
class GetPositionFK_Response:
    """`moveit_msgs/srv/GetPositionFK_Response`"""
    pose_stamped: list[PoseStamped]
    fk_link_names: list[str]
    error_code: MoveItErrorCodes
    __msgtype__: ClassVar[str]

@dataclass
class GetPositionIK_Request(ServiceRequest[GetPositionIK_Request, GetPositionIK_Response]):
    """`moveit_msgs/srv/GetPositionIK_Request`"""
    ik_request: PositionIKRequest
    __msgtype__: ClassVar[str]

@dataclass
class GetPositionIK_Response:
    """`moveit_msgs/srv/GetPositionIK_Response`"""
    solution: RobotState
    error_code: MoveItErrorCodes
    __msgtype__: ClassVar[str]

@dataclass
class GetRobotStateFromWarehouse_Request(ServiceRequest[GetRobotStateFromWarehouse_Request, GetRobotStateFromWarehouse_Response]):
    """`moveit_msgs/srv/GetRobotStateFromWarehouse_Request`"""
    name: str
    robot: str
    __msgtype__: ClassVar[str]

@dataclass
class GetRobotStateFromWarehouse_Response:
    """`moveit_msgs/srv/GetRobotStateFromWarehouse_Response`"""
    state: RobotState
    __msgtype__: ClassVar[str]

@dataclass
class GetStateValidity_Request(ServiceRequest[GetStateValidity_Request, GetStateValidity_Response]):
    """`moveit_msgs/srv/GetStateValidity_Request`"""
    robot_state: RobotState
    group_name: str
    constraints: Constraints
    __msgtype__: ClassVar[str]

@dataclass
class GetStateValidity_Response:
    """`moveit_msgs/srv/GetStateValidity_Response`"""
    valid: bool
    contacts: list[ContactInformation]
    cost_sources: list[CostSource]
    constraint_result: list[ConstraintEvalResult]
    __msgtype__: ClassVar[str]

@dataclass
class GraspPlanning_Request(ServiceRequest[GraspPlanning_Request, GraspPlanning_Response]):
    """`moveit_msgs/srv/GraspPlanning_Request`"""
    group_name: str
    target: CollisionObject
    support_surfaces: list[str]
    candidate_grasps: list[Grasp]
    movable_obstacles: list[CollisionObject]
    __msgtype__: ClassVar[str]

@dataclass
class GraspPlanning_Response:
    """`moveit_msgs/srv/GraspPlanning_Response`"""
    grasps: list[Grasp]
    error_code: MoveItErrorCodes
    __msgtype__: ClassVar[str]

@dataclass
class ListRobotStatesInWarehouse_Request(ServiceRequest[ListRobotStatesInWarehouse_Request, ListRobotStatesInWarehouse_Response]):
    """`moveit_msgs/srv/ListRobotStatesInWarehouse_Request`"""
    regex: str
    robot: str
    __msgtype__: ClassVar[str]

@dataclass
class ListRobotStatesInWarehouse_Response:
    """`moveit_msgs/srv/ListRobotStatesInWarehouse_Response`"""
    states: list[str]
    __msgtype__: ClassVar[str]

@dataclass
class moveit_msgs__srv__LoadMap_Request(ServiceRequest[moveit_msgs__srv__LoadMap_Request, moveit_msgs__srv__LoadMap_Response]):
    """`moveit_msgs/srv/LoadMap_Request`"""
    filename: str
    __msgtype__: ClassVar[str]

@dataclass
class moveit_msgs__srv__LoadMap_Response:
    """`moveit_msgs/srv/LoadMap_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class QueryPlannerInterfaces_Request(ServiceRequest[QueryPlannerInterfaces_Request, QueryPlannerInterfaces_Response]):
    """`moveit_msgs/srv/QueryPlannerInterfaces_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class QueryPlannerInterfaces_Response:
    """`moveit_msgs/srv/QueryPlannerInterfaces_Response`"""
    planner_interfaces: list[PlannerInterfaceDescription]
    __msgtype__: ClassVar[str]

@dataclass
class RenameRobotStateInWarehouse_Request(ServiceRequest[RenameRobotStateInWarehouse_Request, RenameRobotStateInWarehouse_Response]):
    """`moveit_msgs/srv/RenameRobotStateInWarehouse_Request`"""
    old_name: str
    new_name: str
    robot: str
    __msgtype__: ClassVar[str]

@dataclass
class RenameRobotStateInWarehouse_Response:
    """`moveit_msgs/srv/RenameRobotStateInWarehouse_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class moveit_msgs__srv__SaveMap_Request(ServiceRequest[moveit_msgs__srv__SaveMap_Request, moveit_msgs__srv__SaveMap_Response]):
    """`moveit_msgs/srv/SaveMap_Request`"""
    filename: str
    __msgtype__: ClassVar[str]

@dataclass
class moveit_msgs__srv__SaveMap_Response:
    """`moveit_msgs/srv/SaveMap_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class SaveRobotStateToWarehouse_Request(ServiceRequest[SaveRobotStateToWarehouse_Request, SaveRobotStateToWarehouse_Response]):
    """`moveit_msgs/srv/SaveRobotStateToWarehouse_Request`"""
    name: str
    robot: str
    state: RobotState
    __msgtype__: ClassVar[str]

@dataclass
class SaveRobotStateToWarehouse_Response:
    """`moveit_msgs/srv/SaveRobotStateToWarehouse_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class SetPlannerParams_Request(ServiceRequest[SetPlannerParams_Request, SetPlannerParams_Response]):
    """`moveit_msgs/srv/SetPlannerParams_Request`"""
    pipeline_id: str
    planner_config: str
    group: str
    params: PlannerParams
    replace: bool
    __msgtype__: ClassVar[str]

@dataclass
class SetPlannerParams_Response:
    """`moveit_msgs/srv/SetPlannerParams_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class UpdatePointcloudOctomap_Request(ServiceRequest[UpdatePointcloudOctomap_Request, UpdatePointcloudOctomap_Response]):
    """`moveit_msgs/srv/UpdatePointcloudOctomap_Request`"""
    cloud: PointCloud2
    __msgtype__: ClassVar[str]

@dataclass
class UpdatePointcloudOctomap_Response:
    """`moveit_msgs/srv/UpdatePointcloudOctomap_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

# nav2_msgs

@dataclass
class AssistedTeleop_Feedback:
    """`nav2_msgs/action/AssistedTeleop_Feedback`"""
    current_teleop_duration: Duration
    __msgtype__: ClassVar[str]

@dataclass
class AssistedTeleop_Goal(ActionGoal[AssistedTeleop_Goal, AssistedTeleop_Result, AssistedTeleop_Feedback]):
    """`nav2_msgs/action/AssistedTeleop_Goal`"""
    time_allowance: Duration
    __msgtype__: ClassVar[str]

@dataclass
class AssistedTeleop_Result:
    """`nav2_msgs/action/AssistedTeleop_Result`"""
    total_elapsed_time: Duration
    error_code: int
    error_msg: str
    NONE: ClassVar[int] = 0
    UNKNOWN: ClassVar[int] = 730
    TIMEOUT: ClassVar[int] = 731
    TF_ERROR: ClassVar[int] = 732
    __msgtype__: ClassVar[str]

@dataclass
class BackUp_Feedback:
    """`nav2_msgs/action/BackUp_Feedback`"""
    distance_traveled: float
    __msgtype__: ClassVar[str]

@dataclass
class BackUp_Goal(ActionGoal[BackUp_Goal, BackUp_Result, BackUp_Feedback]):
    """`nav2_msgs/action/BackUp_Goal`"""
    target: Point
    speed: float
    time_allowance: Duration
    __msgtype__: ClassVar[str]

@dataclass
class BackUp_Result:
    """`nav2_msgs/action/BackUp_Result`"""
    total_elapsed_time: Duration
    error_code: int
    error_msg: str
    NONE: ClassVar[int] = 0
    UNKNOWN: ClassVar[int] = 710
    TIMEOUT: ClassVar[int] = 711
    TF_ERROR: ClassVar[int] = 712
    INVALID_INPUT: ClassVar[int] = 713
    COLLISION_AHEAD: ClassVar[int] = 714
    __msgtype__: ClassVar[str]

@dataclass
class ComputePathThroughPoses_Feedback:
    """`nav2_msgs/action/ComputePathThroughPoses_Feedback`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class ComputePathThroughPoses_Goal(ActionGoal[ComputePathThroughPoses_Goal, ComputePathThroughPoses_Result, ComputePathThroughPoses_Feedback]):
    """`nav2_msgs/action/ComputePathThroughPoses_Goal`"""
    goals: list[PoseStamped]
    start: PoseStamped
    planner_id: str
    use_start: bool
    __msgtype__: ClassVar[str]

@dataclass
class ComputePathThroughPoses_Result:
    """`nav2_msgs/action/ComputePathThroughPoses_Result`"""
    path: Path
    planning_time: Duration
    error_code: int
    error_msg: str
    NONE: ClassVar[int] = 0
    UNKNOWN: ClassVar[int] = 300
    INVALID_PLANNER: ClassVar[int] = 301
    TF_ERROR: ClassVar[int] = 302
    START_OUTSIDE_MAP: ClassVar[int] = 303
    GOAL_OUTSIDE_MAP: ClassVar[int] = 304
    START_OCCUPIED: ClassVar[int] = 305
    GOAL_OCCUPIED: ClassVar[int] = 306
    TIMEOUT: ClassVar[int] = 307
    NO_VALID_PATH: ClassVar[int] = 308
    NO_VIAPOINTS_GIVEN: ClassVar[int] = 309
    __msgtype__: ClassVar[str]

@dataclass
class ComputePathToPose_Feedback:
    """`nav2_msgs/action/ComputePathToPose_Feedback`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class ComputePathToPose_Goal(ActionGoal[ComputePathToPose_Goal, ComputePathToPose_Result, ComputePathToPose_Feedback]):
    """`nav2_msgs/action/ComputePathToPose_Goal`"""
    goal: PoseStamped
    start: PoseStamped
    planner_id: str
    use_start: bool
    __msgtype__: ClassVar[str]

@dataclass
class ComputePathToPose_Result:
    """`nav2_msgs/action/ComputePathToPose_Result`"""
    path: Path
    planning_time: Duration
    error_code: int
    error_msg: str
    NONE: ClassVar[int] = 0
    UNKNOWN: ClassVar[int] = 200
    INVALID_PLANNER: ClassVar[int] = 201
    TF_ERROR: ClassVar[int] = 202
    START_OUTSIDE_MAP: ClassVar[int] = 203
    GOAL_OUTSIDE_MAP: ClassVar[int] = 204
    START_OCCUPIED: ClassVar[int] = 205
    GOAL_OCCUPIED: ClassVar[int] = 206
    TIMEOUT: ClassVar[int] = 207
    NO_VALID_PATH: ClassVar[int] = 208
    __msgtype__: ClassVar[str]

@dataclass
class DockRobot_Feedback:
    """`nav2_msgs/action/DockRobot_Feedback`"""
    state: int
    docking_time: Duration
    num_retries: int
    NONE: ClassVar[int] = 0
    NAV_TO_STAGING_POSE: ClassVar[int] = 1
    INITIAL_PERCEPTION: ClassVar[int] = 2
    CONTROLLING: ClassVar[int] = 3
    WAIT_FOR_CHARGE: ClassVar[int] = 4
    RETRY: ClassVar[int] = 5
    __msgtype__: ClassVar[str]

@dataclass
class DockRobot_Goal(ActionGoal[DockRobot_Goal, DockRobot_Result, DockRobot_Feedback]):
    """`nav2_msgs/action/DockRobot_Goal`"""
    use_dock_id: bool
    dock_id: str
    dock_pose: PoseStamped
    dock_type: str
    max_staging_time: float
    navigate_to_staging_pose: bool
    __msgtype__: ClassVar[str]

@dataclass
class DockRobot_Result:
    """`nav2_msgs/action/DockRobot_Result`"""
    success: bool
    error_code: int
    num_retries: int
    error_msg: str
    NONE: ClassVar[int] = 0
    DOCK_NOT_IN_DB: ClassVar[int] = 901
    DOCK_NOT_VALID: ClassVar[int] = 902
    FAILED_TO_STAGE: ClassVar[int] = 903
    FAILED_TO_DETECT_DOCK: ClassVar[int] = 904
    FAILED_TO_CONTROL: ClassVar[int] = 905
    FAILED_TO_CHARGE: ClassVar[int] = 906
    UNKNOWN: ClassVar[int] = 999
    __msgtype__: ClassVar[str]

@dataclass
class DriveOnHeading_Feedback:
    """`nav2_msgs/action/DriveOnHeading_Feedback`"""
    distance_traveled: float
    __msgtype__: ClassVar[str]

@dataclass
class DriveOnHeading_Goal(ActionGoal[DriveOnHeading_Goal, DriveOnHeading_Result, DriveOnHeading_Feedback]):
    """`nav2_msgs/action/DriveOnHeading_Goal`"""
    target: Point
    speed: float
    time_allowance: Duration
    __msgtype__: ClassVar[str]

@dataclass
class DriveOnHeading_Result:
    """`nav2_msgs/action/DriveOnHeading_Result`"""
    total_elapsed_time: Duration
    error_code: int
    error_msg: str
    NONE: ClassVar[int] = 0
    UNKNOWN: ClassVar[int] = 720
    TIMEOUT: ClassVar[int] = 721
    TF_ERROR: ClassVar[int] = 722
    COLLISION_AHEAD: ClassVar[int] = 723
    INVALID_INPUT: ClassVar[int] = 724
    __msgtype__: ClassVar[str]

@dataclass
class DummyBehavior_Feedback:
    """`nav2_msgs/action/DummyBehavior_Feedback`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class DummyBehavior_Goal(ActionGoal[DummyBehavior_Goal, DummyBehavior_Result, DummyBehavior_Feedback]):
    """`nav2_msgs/action/DummyBehavior_Goal`"""
    command: String
    __msgtype__: ClassVar[str]

@dataclass
class DummyBehavior_Result:
    """`nav2_msgs/action/DummyBehavior_Result`"""
    total_elapsed_time: Duration
    error_code: int
    error_msg: str
    __msgtype__: ClassVar[str]

@dataclass
class FollowGPSWaypoints_Feedback:
    """`nav2_msgs/action/FollowGPSWaypoints_Feedback`"""
    current_waypoint: int
    __msgtype__: ClassVar[str]

@dataclass
class FollowGPSWaypoints_Goal(ActionGoal[FollowGPSWaypoints_Goal, FollowGPSWaypoints_Result, FollowGPSWaypoints_Feedback]):
    """`nav2_msgs/action/FollowGPSWaypoints_Goal`"""
    number_of_loops: int
    goal_index: int
    gps_poses: list[GeoPose]
    __msgtype__: ClassVar[str]

@dataclass
class FollowGPSWaypoints_Result:
    """`nav2_msgs/action/FollowGPSWaypoints_Result`"""
    missed_waypoints: list[MissedWaypoint]
    error_code: int
    error_msg: str
    NONE: ClassVar[int] = 0
    UNKNOWN: ClassVar[int] = 600
    TASK_EXECUTOR_FAILED: ClassVar[int] = 601
    __msgtype__: ClassVar[str]

@dataclass
class FollowPath_Feedback:
    """`nav2_msgs/action/FollowPath_Feedback`"""
    distance_to_goal: float
    speed: float
    __msgtype__: ClassVar[str]

@dataclass
class FollowPath_Goal(ActionGoal[FollowPath_Goal, FollowPath_Result, FollowPath_Feedback]):
    """`nav2_msgs/action/FollowPath_Goal`"""
    path: Path
    controller_id: str
    goal_checker_id: str
    progress_checker_id: str
    __msgtype__: ClassVar[str]

@dataclass
class FollowPath_Result:
    """`nav2_msgs/action/FollowPath_Result`"""
    result: Empty
    error_code: int
    error_msg: str
    NONE: ClassVar[int] = 0
    UNKNOWN: ClassVar[int] = 100
    INVALID_CONTROLLER: ClassVar[int] = 101
    TF_ERROR: ClassVar[int] = 102
    INVALID_PATH: ClassVar[int] = 103
    PATIENCE_EXCEEDED: ClassVar[int] = 104
    FAILED_TO_MAKE_PROGRESS: ClassVar[int] = 105
    NO_VALID_CONTROL: ClassVar[int] = 106
    CONTROLLER_TIMED_OUT: ClassVar[int] = 107
    __msgtype__: ClassVar[str]

@dataclass
class FollowWaypoints_Feedback:
    """`nav2_msgs/action/FollowWaypoints_Feedback`"""
    current_waypoint: int
    __msgtype__: ClassVar[str]

@dataclass
class FollowWaypoints_Goal(ActionGoal[FollowWaypoints_Goal, FollowWaypoints_Result, FollowWaypoints_Feedback]):
    """`nav2_msgs/action/FollowWaypoints_Goal`"""
    number_of_loops: int
    goal_index: int
    poses: list[PoseStamped]
    __msgtype__: ClassVar[str]

@dataclass
class FollowWaypoints_Result:
    """`nav2_msgs/action/FollowWaypoints_Result`"""
    missed_waypoints: list[MissedWaypoint]
    error_code: int
    error_msg: str
    NONE: ClassVar[int] = 0
    UNKNOWN: ClassVar[int] = 600
    TASK_EXECUTOR_FAILED: ClassVar[int] = 601
    __msgtype__: ClassVar[str]

@dataclass
class NavigateThroughPoses_Feedback:
    """`nav2_msgs/action/NavigateThroughPoses_Feedback`"""
    current_pose: PoseStamped
    navigation_time: Duration
    estimated_time_remaining: Duration
    number_of_recoveries: int
    distance_remaining: float
    number_of_poses_remaining: int
    __msgtype__: ClassVar[str]

@dataclass
class NavigateThroughPoses_Goal(ActionGoal[NavigateThroughPoses_Goal, NavigateThroughPoses_Result, NavigateThroughPoses_Feedback]):
    """`nav2_msgs/action/NavigateThroughPoses_Goal`"""
    poses: list[PoseStamped]
    behavior_tree: str
    __msgtype__: ClassVar[str]

@dataclass
class NavigateThroughPoses_Result:
    """`nav2_msgs/action/NavigateThroughPoses_Result`"""
    error_code: int
    error_msg: str
    NONE: ClassVar[int] = 0
    __msgtype__: ClassVar[str]

@dataclass
class NavigateToPose_Feedback:
    """`nav2_msgs/action/NavigateToPose_Feedback`"""
    current_pose: PoseStamped
    navigation_time: Duration
    estimated_time_remaining: Duration
    number_of_recoveries: int
    distance_remaining: float
    __msgtype__: ClassVar[str]

@dataclass
class NavigateToPose_Goal(ActionGoal[NavigateToPose_Goal, NavigateToPose_Result, NavigateToPose_Feedback]):
    """`nav2_msgs/action/NavigateToPose_Goal`"""
    pose: PoseStamped
    behavior_tree: str
    __msgtype__: ClassVar[str]

@dataclass
class NavigateToPose_Result:
    """`nav2_msgs/action/NavigateToPose_Result`"""
    error_code: int
    error_msg: str
    NONE: ClassVar[int] = 0
    __msgtype__: ClassVar[str]

@dataclass
class SmoothPath_Feedback:
    """`nav2_msgs/action/SmoothPath_Feedback`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class SmoothPath_Goal(ActionGoal[SmoothPath_Goal, SmoothPath_Result, SmoothPath_Feedback]):
    """`nav2_msgs/action/SmoothPath_Goal`"""
    path: Path
    smoother_id: str
    max_smoothing_duration: Duration
    check_for_collisions: bool
    __msgtype__: ClassVar[str]

@dataclass
class SmoothPath_Result:
    """`nav2_msgs/action/SmoothPath_Result`"""
    path: Path
    smoothing_duration: Duration
    was_completed: bool
    error_code: int
    error_msg: str
    NONE: ClassVar[int] = 0
    UNKNOWN: ClassVar[int] = 500
    INVALID_SMOOTHER: ClassVar[int] = 501
    TIMEOUT: ClassVar[int] = 502
    SMOOTHED_PATH_IN_COLLISION: ClassVar[int] = 503
    FAILED_TO_SMOOTH_PATH: ClassVar[int] = 504
    INVALID_PATH: ClassVar[int] = 505
    __msgtype__: ClassVar[str]

@dataclass
class Spin_Feedback:
    """`nav2_msgs/action/Spin_Feedback`"""
    angular_distance_traveled: float
    __msgtype__: ClassVar[str]

@dataclass
class Spin_Goal(ActionGoal[Spin_Goal, Spin_Result, Spin_Feedback]):
    """`nav2_msgs/action/Spin_Goal`"""
    target_yaw: float
    time_allowance: Duration
    __msgtype__: ClassVar[str]

@dataclass
class Spin_Result:
    """`nav2_msgs/action/Spin_Result`"""
    total_elapsed_time: Duration
    error_code: int
    error_msg: str
    NONE: ClassVar[int] = 0
    UNKNOWN: ClassVar[int] = 700
    TIMEOUT: ClassVar[int] = 701
    TF_ERROR: ClassVar[int] = 702
    COLLISION_AHEAD: ClassVar[int] = 703
    __msgtype__: ClassVar[str]

@dataclass
class UndockRobot_Feedback:
    """`nav2_msgs/action/UndockRobot_Feedback`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class UndockRobot_Goal(ActionGoal[UndockRobot_Goal, UndockRobot_Result, UndockRobot_Feedback]):
    """`nav2_msgs/action/UndockRobot_Goal`"""
    dock_type: str
    max_undocking_time: float
    __msgtype__: ClassVar[str]

@dataclass
class UndockRobot_Result:
    """`nav2_msgs/action/UndockRobot_Result`"""
    success: bool
    error_code: int
    error_msg: str
    NONE: ClassVar[int] = 0
    DOCK_NOT_VALID: ClassVar[int] = 902
    FAILED_TO_CONTROL: ClassVar[int] = 905
    UNKNOWN: ClassVar[int] = 999
    __msgtype__: ClassVar[str]

@dataclass
class Wait_Feedback:
    """`nav2_msgs/action/Wait_Feedback`"""
    time_left: Duration
    __msgtype__: ClassVar[str]

@dataclass
class Wait_Goal(ActionGoal[Wait_Goal, Wait_Result, Wait_Feedback]):
    """`nav2_msgs/action/Wait_Goal`"""
    time: Duration
    __msgtype__: ClassVar[str]

@dataclass
class Wait_Result:
    """`nav2_msgs/action/Wait_Result`"""
    total_elapsed_time: Duration
    error_code: int
    error_msg: str
    __msgtype__: ClassVar[str]

@dataclass
class BehaviorTreeLog:
    """`nav2_msgs/msg/BehaviorTreeLog`"""
    timestamp: Time
    event_log: list[BehaviorTreeStatusChange]
    __msgtype__: ClassVar[str]

@dataclass
class BehaviorTreeStatusChange:
    """`nav2_msgs/msg/BehaviorTreeStatusChange`"""
    timestamp: Time
    node_name: str
    uid: int
    previous_status: str
    current_status: str
    __msgtype__: ClassVar[str]

@dataclass
class CollisionDetectorState:
    """`nav2_msgs/msg/CollisionDetectorState`"""
    polygons: list[str]
    detections: NDArray[np.bool_]
    __msgtype__: ClassVar[str]

@dataclass
class CollisionMonitorState:
    """`nav2_msgs/msg/CollisionMonitorState`"""
    action_type: int
    polygon_name: str
    DO_NOTHING: ClassVar[int] = 0
    STOP: ClassVar[int] = 1
    SLOWDOWN: ClassVar[int] = 2
    APPROACH: ClassVar[int] = 3
    LIMIT: ClassVar[int] = 4
    __msgtype__: ClassVar[str]

@dataclass
class Costmap:
    """`nav2_msgs/msg/Costmap`"""
    header: Header
    metadata: CostmapMetaData
    data: NDArray[np.uint8]
    __msgtype__: ClassVar[str]

@dataclass
class CostmapFilterInfo:
    """`nav2_msgs/msg/CostmapFilterInfo`"""
    header: Header
    type: int
    filter_mask_topic: str
    base: float
    multiplier: float
    __msgtype__: ClassVar[str]

@dataclass
class CostmapMetaData:
    """`nav2_msgs/msg/CostmapMetaData`"""
    map_load_time: Time
    update_time: Time
    layer: str
    resolution: float
    size_x: int
    size_y: int
    origin: Pose
    __msgtype__: ClassVar[str]

@dataclass
class CostmapUpdate:
    """`nav2_msgs/msg/CostmapUpdate`"""
    header: Header
    x: int
    y: int
    size_x: int
    size_y: int
    data: NDArray[np.uint8]
    __msgtype__: ClassVar[str]

@dataclass
class MissedWaypoint:
    """`nav2_msgs/msg/MissedWaypoint`"""
    index: int
    goal: PoseStamped
    error_code: int
    __msgtype__: ClassVar[str]

@dataclass
class Particle:
    """`nav2_msgs/msg/Particle`"""
    pose: Pose
    weight: float
    __msgtype__: ClassVar[str]

@dataclass
class ParticleCloud:
    """`nav2_msgs/msg/ParticleCloud`"""
    header: Header
    particles: list[Particle]
    __msgtype__: ClassVar[str]

@dataclass
class SpeedLimit:
    """`nav2_msgs/msg/SpeedLimit`"""
    header: Header
    percentage: bool
    speed_limit: float
    __msgtype__: ClassVar[str]

@dataclass
class VoxelGrid:
    """`nav2_msgs/msg/VoxelGrid`"""
    header: Header
    data: NDArray[np.uint32]
    origin: Point32
    resolutions: Vector3
    size_x: int
    size_y: int
    size_z: int
    __msgtype__: ClassVar[str]

@dataclass
class ClearCostmapAroundPose_Request(ServiceRequest[ClearCostmapAroundPose_Request, ClearCostmapAroundPose_Response]):
    """`nav2_msgs/srv/ClearCostmapAroundPose_Request`"""
    pose: PoseStamped
    reset_distance: float
    __msgtype__: ClassVar[str]

@dataclass
class ClearCostmapAroundPose_Response:
    """`nav2_msgs/srv/ClearCostmapAroundPose_Response`"""
    response: Empty
    __msgtype__: ClassVar[str]

@dataclass
class ClearCostmapAroundRobot_Request(ServiceRequest[ClearCostmapAroundRobot_Request, ClearCostmapAroundRobot_Response]):
    """`nav2_msgs/srv/ClearCostmapAroundRobot_Request`"""
    reset_distance: float
    __msgtype__: ClassVar[str]

@dataclass
class ClearCostmapAroundRobot_Response:
    """`nav2_msgs/srv/ClearCostmapAroundRobot_Response`"""
    response: Empty
    __msgtype__: ClassVar[str]

@dataclass
class ClearCostmapExceptRegion_Request(ServiceRequest[ClearCostmapExceptRegion_Request, ClearCostmapExceptRegion_Response]):
    """`nav2_msgs/srv/ClearCostmapExceptRegion_Request`"""
    reset_distance: float
    __msgtype__: ClassVar[str]

@dataclass
class ClearCostmapExceptRegion_Response:
    """`nav2_msgs/srv/ClearCostmapExceptRegion_Response`"""
    response: Empty
    __msgtype__: ClassVar[str]

@dataclass
class ClearEntireCostmap_Request(ServiceRequest[ClearEntireCostmap_Request, ClearEntireCostmap_Response]):
    """`nav2_msgs/srv/ClearEntireCostmap_Request`"""
    request: Empty
    __msgtype__: ClassVar[str]

@dataclass
class ClearEntireCostmap_Response:
    """`nav2_msgs/srv/ClearEntireCostmap_Response`"""
    response: Empty
    __msgtype__: ClassVar[str]

@dataclass
class GetCostmap_Request(ServiceRequest[GetCostmap_Request, GetCostmap_Response]):
    """`nav2_msgs/srv/GetCostmap_Request`"""
    specs: CostmapMetaData
    __msgtype__: ClassVar[str]

@dataclass
class GetCostmap_Response:
    """`nav2_msgs/srv/GetCostmap_Response`"""
    map: Costmap
    __msgtype__: ClassVar[str]

@dataclass
class IsPathValid_Request(ServiceRequest[IsPathValid_Request, IsPathValid_Response]):
    """`nav2_msgs/srv/IsPathValid_Request`"""
    path: Path
    __msgtype__: ClassVar[str]

@dataclass
class IsPathValid_Response:
    """`nav2_msgs/srv/IsPathValid_Response`"""
    is_valid: bool
    invalid_pose_indices: NDArray[np.int32]
    __msgtype__: ClassVar[str]

@dataclass
class nav2_msgs__srv__LoadMap_Request(ServiceRequest[nav2_msgs__srv__LoadMap_Request, nav2_msgs__srv__LoadMap_Response]):
    """`nav2_msgs/srv/LoadMap_Request`"""
    map_url: str
    __msgtype__: ClassVar[str]

@dataclass
class nav2_msgs__srv__LoadMap_Response:
    """`nav2_msgs/srv/LoadMap_Response`"""
    map: OccupancyGrid
    result: int
    RESULT_SUCCESS: ClassVar[int] = 0
    RESULT_MAP_DOES_NOT_EXIST: ClassVar[int] = 1
    RESULT_INVALID_MAP_DATA: ClassVar[int] = 2
    RESULT_INVALID_MAP_METADATA: ClassVar[int] = 3
    RESULT_UNDEFINED_FAILURE: ClassVar[int] = 255
    __msgtype__: ClassVar[str]

@dataclass
class ManageLifecycleNodes_Request(ServiceRequest[ManageLifecycleNodes_Request, ManageLifecycleNodes_Response]):
    """`nav2_msgs/srv/ManageLifecycleNodes_Request`"""
    command: int
    STARTUP: ClassVar[int] = 0
    PAUSE: ClassVar[int] = 1
    RESUME: ClassVar[int] = 2
    RESET: ClassVar[int] = 3
    SHUTDOWN: ClassVar[int] = 4
    CONFIGURE: ClassVar[int] = 5
    CLEANUP: ClassVar[int] = 6
    __msgtype__: ClassVar[str]

@dataclass
class ManageLifecycleNodes_Response:
    """`nav2_msgs/srv/ManageLifecycleNodes_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class ReloadDockDatabase_Request(ServiceRequest[ReloadDockDatabase_Request, ReloadDockDatabase_Response]):
    """`nav2_msgs/srv/ReloadDockDatabase_Request`"""
    filepath: str
    __msgtype__: ClassVar[str]

@dataclass
class ReloadDockDatabase_Response:
    """`nav2_msgs/srv/ReloadDockDatabase_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class nav2_msgs__srv__SaveMap_Request(ServiceRequest[nav2_msgs__srv__SaveMap_Request, nav2_msgs__srv__SaveMap_Response]):
    """`nav2_msgs/srv/SaveMap_Request`"""
    map_topic: str
    map_url: str
    image_format: str
    map_mode: str
    free_thresh: float
    occupied_thresh: float
    __msgtype__: ClassVar[str]

@dataclass
class nav2_msgs__srv__SaveMap_Response:
    """`nav2_msgs/srv/SaveMap_Response`"""
    result: bool
    __msgtype__: ClassVar[str]

@dataclass
class SetInitialPose_Request(ServiceRequest[SetInitialPose_Request, SetInitialPose_Response]):
    """`nav2_msgs/srv/SetInitialPose_Request`"""
    pose: PoseWithCovarianceStamped
    __msgtype__: ClassVar[str]

@dataclass
class SetInitialPose_Response:
    """`nav2_msgs/srv/SetInitialPose_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

# nav_msgs

@dataclass
class Goals:
    """`nav_msgs/msg/Goals`"""
    header: Header
    goals: list[PoseStamped]
    __msgtype__: ClassVar[str]

@dataclass
class GridCells:
    """`nav_msgs/msg/GridCells`"""
    header: Header
    cell_width: float
    cell_height: float
    cells: list[Point]
    __msgtype__: ClassVar[str]

@dataclass
class MapMetaData:
    """`nav_msgs/msg/MapMetaData`"""
    map_load_time: Time
    resolution: float
    width: int
    height: int
    origin: Pose
    __msgtype__: ClassVar[str]

@dataclass
class OccupancyGrid:
    """`nav_msgs/msg/OccupancyGrid`"""
    header: Header
    info: MapMetaData
    data: NDArray[np.int8]
    __msgtype__: ClassVar[str]

@dataclass
class Odometry:
    """`nav_msgs/msg/Odometry`"""
    header: Header
    child_frame_id: str
    pose: PoseWithCovariance
    twist: TwistWithCovariance
    __msgtype__: ClassVar[str]

@dataclass
class Path:
    """`nav_msgs/msg/Path`"""
    header: Header
    poses: list[PoseStamped]
    __msgtype__: ClassVar[str]

@dataclass
class GetMap_Request(ServiceRequest[GetMap_Request, GetMap_Response]):
    """`nav_msgs/srv/GetMap_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class GetMap_Response:
    """`nav_msgs/srv/GetMap_Response`"""
    map: OccupancyGrid
    __msgtype__: ClassVar[str]

@dataclass
class GetPlan_Request(ServiceRequest[GetPlan_Request, GetPlan_Response]):
    """`nav_msgs/srv/GetPlan_Request`"""
    start: PoseStamped
    goal: PoseStamped
    tolerance: float
    __msgtype__: ClassVar[str]

@dataclass
class GetPlan_Response:
    """`nav_msgs/srv/GetPlan_Response`"""
    plan: Path
    __msgtype__: ClassVar[str]

@dataclass
class LoadMap_Request(ServiceRequest[LoadMap_Request, LoadMap_Response]):
    """`nav_msgs/srv/LoadMap_Request`"""
    map_url: str
    __msgtype__: ClassVar[str]

@dataclass
class LoadMap_Response:
    """`nav_msgs/srv/LoadMap_Response`"""
    map: OccupancyGrid
    result: int
    RESULT_SUCCESS: ClassVar[int] = 0
    RESULT_MAP_DOES_NOT_EXIST: ClassVar[int] = 1
    RESULT_INVALID_MAP_DATA: ClassVar[int] = 2
    RESULT_INVALID_MAP_METADATA: ClassVar[int] = 3
    RESULT_UNDEFINED_FAILURE: ClassVar[int] = 255
    __msgtype__: ClassVar[str]

@dataclass
class SetMap_Request(ServiceRequest[SetMap_Request, SetMap_Response]):
    """`nav_msgs/srv/SetMap_Request`"""
    map: OccupancyGrid
    initial_pose: PoseWithCovarianceStamped
    __msgtype__: ClassVar[str]

@dataclass
class SetMap_Response:
    """`nav_msgs/srv/SetMap_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

# object_recognition_msgs

@dataclass
class ObjectRecognition_Feedback:
    """`object_recognition_msgs/action/ObjectRecognition_Feedback`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class ObjectRecognition_Goal(ActionGoal[ObjectRecognition_Goal, ObjectRecognition_Result, ObjectRecognition_Feedback]):
    """`object_recognition_msgs/action/ObjectRecognition_Goal`"""
    use_roi: bool
    filter_limits: NDArray[np.float32]
    __msgtype__: ClassVar[str]

@dataclass
class ObjectRecognition_Result:
    """`object_recognition_msgs/action/ObjectRecognition_Result`"""
    recognized_objects: RecognizedObjectArray
    __msgtype__: ClassVar[str]

@dataclass
class ObjectInformation:
    """`object_recognition_msgs/msg/ObjectInformation`"""
    name: str
    ground_truth_mesh: Mesh
    ground_truth_point_cloud: PointCloud2
    __msgtype__: ClassVar[str]

@dataclass
class ObjectType:
    """`object_recognition_msgs/msg/ObjectType`"""
    key: str
    db: str
    __msgtype__: ClassVar[str]

@dataclass
class RecognizedObject:
    """`object_recognition_msgs/msg/RecognizedObject`"""
    header: Header
    type: ObjectType
    confidence: float
    point_clouds: list[PointCloud2]
    bounding_mesh: Mesh
    bounding_contours: list[Point]
    pose: PoseWithCovarianceStamped
    __msgtype__: ClassVar[str]

@dataclass
class RecognizedObjectArray:
    """`object_recognition_msgs/msg/RecognizedObjectArray`"""
    header: Header
    objects: list[RecognizedObject]
    cooccurrence: NDArray[np.float32]
    __msgtype__: ClassVar[str]

@dataclass
class Table:
    """`object_recognition_msgs/msg/Table`"""
    header: Header
    pose: Pose
    convex_hull: list[Point]
    __msgtype__: ClassVar[str]

@dataclass
class TableArray:
    """`object_recognition_msgs/msg/TableArray`"""
    header: Header
    tables: list[Table]
    __msgtype__: ClassVar[str]

@dataclass
class GetObjectInformation_Request(ServiceRequest[GetObjectInformation_Request, GetObjectInformation_Response]):
    """`object_recognition_msgs/srv/GetObjectInformation_Request`"""
    type: ObjectType
    __msgtype__: ClassVar[str]

@dataclass
class GetObjectInformation_Response:
    """`object_recognition_msgs/srv/GetObjectInformation_Response`"""
    information: ObjectInformation
    __msgtype__: ClassVar[str]

# octomap_msgs

@dataclass
class Octomap:
    """`octomap_msgs/msg/Octomap`"""
    header: Header
    binary: bool
    id: str
    resolution: float
    data: NDArray[np.int8]
    __msgtype__: ClassVar[str]

@dataclass
class OctomapWithPose:
    """`octomap_msgs/msg/OctomapWithPose`"""
    header: Header
    origin: Pose
    octomap: Octomap
    __msgtype__: ClassVar[str]

@dataclass
class BoundingBoxQuery_Request(ServiceRequest[BoundingBoxQuery_Request, BoundingBoxQuery_Response]):
    """`octomap_msgs/srv/BoundingBoxQuery_Request`"""
    min: Point
    max: Point
    __msgtype__: ClassVar[str]

@dataclass
class BoundingBoxQuery_Response:
    """`octomap_msgs/srv/BoundingBoxQuery_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class GetOctomap_Request(ServiceRequest[GetOctomap_Request, GetOctomap_Response]):
    """`octomap_msgs/srv/GetOctomap_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class GetOctomap_Response:
    """`octomap_msgs/srv/GetOctomap_Response`"""
    map: Octomap
    __msgtype__: ClassVar[str]

# osrf_gear

@dataclass
class osrf_gear__msg__ConveyorBeltState:
    """`osrf_gear/msg/ConveyorBeltState`"""
    power: float
    enabled: bool
    __msgtype__: ClassVar[str]

@dataclass
class VacuumGripperState:
    """`osrf_gear/msg/VacuumGripperState`"""
    enabled: bool
    attached: bool
    __msgtype__: ClassVar[str]

@dataclass
class osrf_gear__srv__ConveyorBeltControl_Request(ServiceRequest[osrf_gear__srv__ConveyorBeltControl_Request, osrf_gear__srv__ConveyorBeltControl_Response]):
    """`osrf_gear/srv/ConveyorBeltControl_Request`"""
    power: float
    __msgtype__: ClassVar[str]

@dataclass
class osrf_gear__srv__ConveyorBeltControl_Response:
    """`osrf_gear/srv/ConveyorBeltControl_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class VacuumGripperControl_Request(ServiceRequest[VacuumGripperControl_Request, VacuumGripperControl_Response]):
    """`osrf_gear/srv/VacuumGripperControl_Request`"""
    enable: bool
    __msgtype__: ClassVar[str]

@dataclass
class VacuumGripperControl_Response:
    """`osrf_gear/srv/VacuumGripperControl_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

# play_motion2_msgs

@dataclass
class PlayMotion2Raw_Feedback:
    """`play_motion2_msgs/action/PlayMotion2Raw_Feedback`"""
    current_time: Time
    __msgtype__: ClassVar[str]

@dataclass
class PlayMotion2Raw_Goal(ActionGoal[PlayMotion2Raw_Goal, PlayMotion2Raw_Result, PlayMotion2Raw_Feedback]):
    """`play_motion2_msgs/action/PlayMotion2Raw_Goal`"""
    motion: Motion
    skip_planning: bool
    __msgtype__: ClassVar[str]

@dataclass
class PlayMotion2Raw_Result:
    """`play_motion2_msgs/action/PlayMotion2Raw_Result`"""
    success: bool
    error: str
    __msgtype__: ClassVar[str]

@dataclass
class PlayMotion2_Feedback:
    """`play_motion2_msgs/action/PlayMotion2_Feedback`"""
    current_time: Time
    __msgtype__: ClassVar[str]

@dataclass
class PlayMotion2_Goal(ActionGoal[PlayMotion2_Goal, PlayMotion2_Result, PlayMotion2_Feedback]):
    """`play_motion2_msgs/action/PlayMotion2_Goal`"""
    motion_name: str
    skip_planning: bool
    __msgtype__: ClassVar[str]

@dataclass
class PlayMotion2_Result:
    """`play_motion2_msgs/action/PlayMotion2_Result`"""
    success: bool
    error: str
    __msgtype__: ClassVar[str]

@dataclass
class Motion:
    """`play_motion2_msgs/msg/Motion`"""
    key: str
    name: str
    usage: str
    description: str
    joints: list[str]
    positions: NDArray[np.float64]
    times_from_start: NDArray[np.float64]
    __msgtype__: ClassVar[str]

@dataclass
class AddMotion_Request(ServiceRequest[AddMotion_Request, AddMotion_Response]):
    """`play_motion2_msgs/srv/AddMotion_Request`"""
    motion: Motion
    overwrite: bool
    __msgtype__: ClassVar[str]

@dataclass
class AddMotion_Response:
    """`play_motion2_msgs/srv/AddMotion_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class GetMotionInfo_Request(ServiceRequest[GetMotionInfo_Request, GetMotionInfo_Response]):
    """`play_motion2_msgs/srv/GetMotionInfo_Request`"""
    motion_key: str
    __msgtype__: ClassVar[str]

@dataclass
class GetMotionInfo_Response:
    """`play_motion2_msgs/srv/GetMotionInfo_Response`"""
    motion: Motion
    __msgtype__: ClassVar[str]

@dataclass
class IsJointListReady_Request(ServiceRequest[IsJointListReady_Request, IsJointListReady_Response]):
    """`play_motion2_msgs/srv/IsJointListReady_Request`"""
    joints: list[str]
    __msgtype__: ClassVar[str]

@dataclass
class IsJointListReady_Response:
    """`play_motion2_msgs/srv/IsJointListReady_Response`"""
    is_ready: bool
    __msgtype__: ClassVar[str]

@dataclass
class IsMotionReady_Request(ServiceRequest[IsMotionReady_Request, IsMotionReady_Response]):
    """`play_motion2_msgs/srv/IsMotionReady_Request`"""
    motion_key: str
    __msgtype__: ClassVar[str]

@dataclass
class IsMotionReady_Response:
    """`play_motion2_msgs/srv/IsMotionReady_Response`"""
    is_ready: bool
    __msgtype__: ClassVar[str]

@dataclass
class play_motion2_msgs__srv__ListMotions_Request(ServiceRequest[play_motion2_msgs__srv__ListMotions_Request, play_motion2_msgs__srv__ListMotions_Response]):
    """`play_motion2_msgs/srv/ListMotions_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class play_motion2_msgs__srv__ListMotions_Response:
    """`play_motion2_msgs/srv/ListMotions_Response`"""
    motion_keys: list[str]
    __msgtype__: ClassVar[str]

@dataclass
class RemoveMotion_Request(ServiceRequest[RemoveMotion_Request, RemoveMotion_Response]):
    """`play_motion2_msgs/srv/RemoveMotion_Request`"""
    motion_key: str
    __msgtype__: ClassVar[str]

@dataclass
class RemoveMotion_Response:
    """`play_motion2_msgs/srv/RemoveMotion_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

# play_motion_msgs

@dataclass
class PlayMotion_Feedback:
    """`play_motion_msgs/action/PlayMotion_Feedback`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class PlayMotion_Goal(ActionGoal[PlayMotion_Goal, PlayMotion_Result, PlayMotion_Feedback]):
    """`play_motion_msgs/action/PlayMotion_Goal`"""
    motion_name: str
    skip_planning: bool
    priority: int
    __msgtype__: ClassVar[str]

@dataclass
class PlayMotion_Result:
    """`play_motion_msgs/action/PlayMotion_Result`"""
    error_code: int
    error_string: str
    SUCCEEDED: ClassVar[int] = 1
    MOTION_NOT_FOUND: ClassVar[int] = -1
    CONTROLLER_BUSY: ClassVar[int] = -3
    MISSING_CONTROLLER: ClassVar[int] = -4
    TRAJECTORY_ERROR: ClassVar[int] = -5
    GOAL_NOT_REACHED: ClassVar[int] = -6
    PLANNER_OFFLINE: ClassVar[int] = -7
    NO_PLAN_FOUND: ClassVar[int] = -8
    OTHER_ERROR: ClassVar[int] = -42
    __msgtype__: ClassVar[str]

@dataclass
class MotionInfo:
    """`play_motion_msgs/msg/MotionInfo`"""
    name: str
    joints: list[str]
    duration: Duration
    __msgtype__: ClassVar[str]

@dataclass
class IsAlreadyThere_Request(ServiceRequest[IsAlreadyThere_Request, IsAlreadyThere_Response]):
    """`play_motion_msgs/srv/IsAlreadyThere_Request`"""
    motion_name: str
    tolerance: float
    __msgtype__: ClassVar[str]

@dataclass
class IsAlreadyThere_Response:
    """`play_motion_msgs/srv/IsAlreadyThere_Response`"""
    already_there: bool
    __msgtype__: ClassVar[str]

@dataclass
class play_motion_msgs__srv__ListMotions_Request(ServiceRequest[play_motion_msgs__srv__ListMotions_Request, play_motion_msgs__srv__ListMotions_Response]):
    """`play_motion_msgs/srv/ListMotions_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class play_motion_msgs__srv__ListMotions_Response:
    """`play_motion_msgs/srv/ListMotions_Response`"""
    motions: list[MotionInfo]
    __msgtype__: ClassVar[str]

# prius_msgs

@dataclass
class Control:
    """`prius_msgs/msg/Control`"""
    header: Header
    throttle: float
    brake: float
    steer: float
    shift_gears: int
    NO_COMMAND: ClassVar[int] = 0
    NEUTRAL: ClassVar[int] = 1
    FORWARD: ClassVar[int] = 2
    REVERSE: ClassVar[int] = 3
    __msgtype__: ClassVar[str]

# rcl_interfaces

@dataclass
class FloatingPointRange:
    """`rcl_interfaces/msg/FloatingPointRange`"""
    from_value: float
    to_value: float
    step: float
    __msgtype__: ClassVar[str]

@dataclass
class IntegerRange:
    """`rcl_interfaces/msg/IntegerRange`"""
    from_value: int
    to_value: int
    step: int
    __msgtype__: ClassVar[str]

@dataclass
class ListParametersResult:
    """`rcl_interfaces/msg/ListParametersResult`"""
    names: list[str]
    prefixes: list[str]
    __msgtype__: ClassVar[str]

@dataclass
class Log:
    """`rcl_interfaces/msg/Log`"""
    stamp: Time
    level: int
    name: str
    msg: str
    file: str
    function: str
    line: int
    DEBUG: ClassVar[int] = 10
    INFO: ClassVar[int] = 20
    WARN: ClassVar[int] = 30
    ERROR: ClassVar[int] = 40
    FATAL: ClassVar[int] = 50
    __msgtype__: ClassVar[str]

@dataclass
class LoggerLevel:
    """`rcl_interfaces/msg/LoggerLevel`"""
    name: str
    level: int
    LOG_LEVEL_UNKNOWN: ClassVar[int] = 0
    LOG_LEVEL_DEBUG: ClassVar[int] = 10
    LOG_LEVEL_INFO: ClassVar[int] = 20
    LOG_LEVEL_WARN: ClassVar[int] = 30
    LOG_LEVEL_ERROR: ClassVar[int] = 40
    LOG_LEVEL_FATAL: ClassVar[int] = 50
    __msgtype__: ClassVar[str]

@dataclass
class Parameter:
    """`rcl_interfaces/msg/Parameter`"""
    name: str
    value: ParameterValue
    __msgtype__: ClassVar[str]

@dataclass
class ParameterDescriptor:
    """`rcl_interfaces/msg/ParameterDescriptor`"""
    name: str
    type: int
    description: str
    additional_constraints: str
    read_only: bool
    dynamic_typing: bool
    floating_point_range: list[FloatingPointRange]
    integer_range: list[IntegerRange]
    __msgtype__: ClassVar[str]

@dataclass
class ParameterEvent:
    """`rcl_interfaces/msg/ParameterEvent`"""
    stamp: Time
    node: str
    new_parameters: list[Parameter]
    changed_parameters: list[Parameter]
    deleted_parameters: list[Parameter]
    __msgtype__: ClassVar[str]

@dataclass
class ParameterEventDescriptors:
    """`rcl_interfaces/msg/ParameterEventDescriptors`"""
    new_parameters: list[ParameterDescriptor]
    changed_parameters: list[ParameterDescriptor]
    deleted_parameters: list[ParameterDescriptor]
    __msgtype__: ClassVar[str]

@dataclass
class ParameterType:
    """`rcl_interfaces/msg/ParameterType`"""
    structure_needs_at_least_one_member: int = 0
    PARAMETER_NOT_SET: ClassVar[int] = 0
    PARAMETER_BOOL: ClassVar[int] = 1
    PARAMETER_INTEGER: ClassVar[int] = 2
    PARAMETER_DOUBLE: ClassVar[int] = 3
    PARAMETER_STRING: ClassVar[int] = 4
    PARAMETER_BYTE_ARRAY: ClassVar[int] = 5
    PARAMETER_BOOL_ARRAY: ClassVar[int] = 6
    PARAMETER_INTEGER_ARRAY: ClassVar[int] = 7
    PARAMETER_DOUBLE_ARRAY: ClassVar[int] = 8
    PARAMETER_STRING_ARRAY: ClassVar[int] = 9
    __msgtype__: ClassVar[str]

@dataclass
class ParameterValue:
    """`rcl_interfaces/msg/ParameterValue`"""
    type: int
    bool_value: bool
    integer_value: int
    double_value: float
    string_value: str
    byte_array_value: NDArray[np.uint8]
    bool_array_value: NDArray[np.bool_]
    integer_array_value: NDArray[np.int64]
    double_array_value: NDArray[np.float64]
    string_array_value: list[str]
    __msgtype__: ClassVar[str]

@dataclass
class SetLoggerLevelsResult:
    """`rcl_interfaces/msg/SetLoggerLevelsResult`"""
    successful: bool
    reason: str
    __msgtype__: ClassVar[str]

@dataclass
class SetParametersResult:
    """`rcl_interfaces/msg/SetParametersResult`"""
    successful: bool
    reason: str
    __msgtype__: ClassVar[str]

@dataclass
class DescribeParameters_Request(ServiceRequest[DescribeParameters_Request, DescribeParameters_Response]):
    """`rcl_interfaces/srv/DescribeParameters_Request`"""
    names: list[str]
    __msgtype__: ClassVar[str]

@dataclass
class DescribeParameters_Response:
    """`rcl_interfaces/srv/DescribeParameters_Response`"""
    descriptors: list[ParameterDescriptor]
    __msgtype__: ClassVar[str]

@dataclass
class GetLoggerLevels_Request(ServiceRequest[GetLoggerLevels_Request, GetLoggerLevels_Response]):
    """`rcl_interfaces/srv/GetLoggerLevels_Request`"""
    names: list[str]
    __msgtype__: ClassVar[str]

@dataclass
class GetLoggerLevels_Response:
    """`rcl_interfaces/srv/GetLoggerLevels_Response`"""
    levels: list[LoggerLevel]
    __msgtype__: ClassVar[str]

@dataclass
class GetParameterTypes_Request(ServiceRequest[GetParameterTypes_Request, GetParameterTypes_Response]):
    """`rcl_interfaces/srv/GetParameterTypes_Request`"""
    names: list[str]
    __msgtype__: ClassVar[str]

@dataclass
class GetParameterTypes_Response:
    """`rcl_interfaces/srv/GetParameterTypes_Response`"""
    types: NDArray[np.uint8]
    __msgtype__: ClassVar[str]

@dataclass
class GetParameters_Request(ServiceRequest[GetParameters_Request, GetParameters_Response]):
    """`rcl_interfaces/srv/GetParameters_Request`"""
    names: list[str]
    __msgtype__: ClassVar[str]

@dataclass
class GetParameters_Response:
    """`rcl_interfaces/srv/GetParameters_Response`"""
    values: list[ParameterValue]
    __msgtype__: ClassVar[str]

@dataclass
class ListParameters_Request(ServiceRequest[ListParameters_Request, ListParameters_Response]):
    """`rcl_interfaces/srv/ListParameters_Request`"""
    prefixes: list[str]
    depth: int
    DEPTH_RECURSIVE: ClassVar[int] = 0
    __msgtype__: ClassVar[str]

@dataclass
class ListParameters_Response:
    """`rcl_interfaces/srv/ListParameters_Response`"""
    result: ListParametersResult
    __msgtype__: ClassVar[str]

@dataclass
class SetLoggerLevels_Request(ServiceRequest[SetLoggerLevels_Request, SetLoggerLevels_Response]):
    """`rcl_interfaces/srv/SetLoggerLevels_Request`"""
    levels: list[LoggerLevel]
    __msgtype__: ClassVar[str]

@dataclass
class SetLoggerLevels_Response:
    """`rcl_interfaces/srv/SetLoggerLevels_Response`"""
    results: list[SetLoggerLevelsResult]
    __msgtype__: ClassVar[str]

@dataclass
class SetParametersAtomically_Request(ServiceRequest[SetParametersAtomically_Request, SetParametersAtomically_Response]):
    """`rcl_interfaces/srv/SetParametersAtomically_Request`"""
    parameters: list[Parameter]
    __msgtype__: ClassVar[str]

@dataclass
class SetParametersAtomically_Response:
    """`rcl_interfaces/srv/SetParametersAtomically_Response`"""
    result: SetParametersResult
    __msgtype__: ClassVar[str]

@dataclass
class SetParameters_Request(ServiceRequest[SetParameters_Request, SetParameters_Response]):
    """`rcl_interfaces/srv/SetParameters_Request`"""
    parameters: list[Parameter]
    __msgtype__: ClassVar[str]

@dataclass
class SetParameters_Response:
    """`rcl_interfaces/srv/SetParameters_Response`"""
    results: list[SetParametersResult]
    __msgtype__: ClassVar[str]

# rmf_dispenser_msgs

@dataclass
class DispenserRequest:
    """`rmf_dispenser_msgs/msg/DispenserRequest`"""
    time: Time
    request_guid: str
    target_guid: str
    transporter_type: str
    items: list[DispenserRequestItem]
    __msgtype__: ClassVar[str]

@dataclass
class DispenserRequestItem:
    """`rmf_dispenser_msgs/msg/DispenserRequestItem`"""
    type_guid: str
    quantity: int
    compartment_name: str
    __msgtype__: ClassVar[str]

@dataclass
class DispenserResult:
    """`rmf_dispenser_msgs/msg/DispenserResult`"""
    time: Time
    request_guid: str
    source_guid: str
    status: int
    ACKNOWLEDGED: ClassVar[int] = 0
    SUCCESS: ClassVar[int] = 1
    FAILED: ClassVar[int] = 2
    __msgtype__: ClassVar[str]

@dataclass
class DispenserState:
    """`rmf_dispenser_msgs/msg/DispenserState`"""
    time: Time
    guid: str
    mode: int
    request_guid_queue: list[str]
    seconds_remaining: float
    IDLE: ClassVar[int] = 0
    BUSY: ClassVar[int] = 1
    OFFLINE: ClassVar[int] = 2
    __msgtype__: ClassVar[str]

# rmf_door_msgs

@dataclass
class DoorMode:
    """`rmf_door_msgs/msg/DoorMode`"""
    value: int
    MODE_CLOSED: ClassVar[int] = 0
    MODE_MOVING: ClassVar[int] = 1
    MODE_OPEN: ClassVar[int] = 2
    MODE_OFFLINE: ClassVar[int] = 3
    MODE_UNKNOWN: ClassVar[int] = 4
    __msgtype__: ClassVar[str]

@dataclass
class DoorRequest:
    """`rmf_door_msgs/msg/DoorRequest`"""
    request_time: Time
    requester_id: str
    door_name: str
    requested_mode: DoorMode
    __msgtype__: ClassVar[str]

@dataclass
class DoorSessions:
    """`rmf_door_msgs/msg/DoorSessions`"""
    door_name: str
    sessions: list[Session]
    __msgtype__: ClassVar[str]

@dataclass
class DoorState:
    """`rmf_door_msgs/msg/DoorState`"""
    door_time: Time
    door_name: str
    current_mode: DoorMode
    __msgtype__: ClassVar[str]

@dataclass
class Session:
    """`rmf_door_msgs/msg/Session`"""
    request_time: Time
    requester_id: str
    __msgtype__: ClassVar[str]

@dataclass
class SupervisorHeartbeat:
    """`rmf_door_msgs/msg/SupervisorHeartbeat`"""
    all_sessions: list[DoorSessions]
    __msgtype__: ClassVar[str]

# rmf_fleet_msgs

@dataclass
class BeaconState:
    """`rmf_fleet_msgs/msg/BeaconState`"""
    id: str
    online: bool
    category: str
    activated: bool
    level: str
    __msgtype__: ClassVar[str]

@dataclass
class ChargingAssignment:
    """`rmf_fleet_msgs/msg/ChargingAssignment`"""
    robot_name: str
    waypoint_name: str
    mode: int
    MODE_CHARGE: ClassVar[int] = 0
    MODE_WAIT: ClassVar[int] = 1
    __msgtype__: ClassVar[str]

@dataclass
class ChargingAssignments:
    """`rmf_fleet_msgs/msg/ChargingAssignments`"""
    fleet_name: str
    assignments: list[ChargingAssignment]
    __msgtype__: ClassVar[str]

@dataclass
class ClosedLanes:
    """`rmf_fleet_msgs/msg/ClosedLanes`"""
    fleet_name: str
    closed_lanes: NDArray[np.uint64]
    __msgtype__: ClassVar[str]

@dataclass
class DeliveryAlert:
    """`rmf_fleet_msgs/msg/DeliveryAlert`"""
    id: str
    category: DeliveryAlertCategory
    tier: DeliveryAlertTier
    task_id: str
    action: DeliveryAlertAction
    message: str
    __msgtype__: ClassVar[str]

@dataclass
class DeliveryAlertAction:
    """`rmf_fleet_msgs/msg/DeliveryAlertAction`"""
    value: int
    WAITING: ClassVar[int] = 0
    CANCEL: ClassVar[int] = 1
    OVERRIDE: ClassVar[int] = 2
    RESUME: ClassVar[int] = 3
    __msgtype__: ClassVar[str]

@dataclass
class DeliveryAlertCategory:
    """`rmf_fleet_msgs/msg/DeliveryAlertCategory`"""
    value: int
    MISSING: ClassVar[int] = 0
    WRONG: ClassVar[int] = 1
    OBSTRUCTED: ClassVar[int] = 2
    CANCELLED: ClassVar[int] = 3
    __msgtype__: ClassVar[str]

@dataclass
class DeliveryAlertTier:
    """`rmf_fleet_msgs/msg/DeliveryAlertTier`"""
    value: int
    WARNING: ClassVar[int] = 0
    ERROR: ClassVar[int] = 1
    __msgtype__: ClassVar[str]

@dataclass
class DestinationRequest:
    """`rmf_fleet_msgs/msg/DestinationRequest`"""
    fleet_name: str
    robot_name: str
    destination: Location
    task_id: str
    __msgtype__: ClassVar[str]

@dataclass
class Dock:
    """`rmf_fleet_msgs/msg/Dock`"""
    fleet_name: str
    params: list[DockParameter]
    __msgtype__: ClassVar[str]

@dataclass
class DockParameter:
    """`rmf_fleet_msgs/msg/DockParameter`"""
    start: str
    finish: str
    path: list[Location]
    __msgtype__: ClassVar[str]

@dataclass
class DockSummary:
    """`rmf_fleet_msgs/msg/DockSummary`"""
    docks: list[Dock]
    __msgtype__: ClassVar[str]

@dataclass
class EmergencySignal:
    """`rmf_fleet_msgs/msg/EmergencySignal`"""
    fleet_names: list[str]
    is_emergency: bool
    __msgtype__: ClassVar[str]

@dataclass
class FleetState:
    """`rmf_fleet_msgs/msg/FleetState`"""
    name: str
    robots: list[rmf_fleet_msgs__msg__RobotState]
    __msgtype__: ClassVar[str]

@dataclass
class InterruptRequest:
    """`rmf_fleet_msgs/msg/InterruptRequest`"""
    fleet_name: str
    robot_name: str
    interrupt_id: str
    labels: list[str]
    type: int
    TYPE_INTERRUPT: ClassVar[int] = 0
    TYPE_RESUME: ClassVar[int] = 1
    __msgtype__: ClassVar[str]

@dataclass
class LaneRequest:
    """`rmf_fleet_msgs/msg/LaneRequest`"""
    fleet_name: str
    open_lanes: NDArray[np.uint64]
    close_lanes: NDArray[np.uint64]
    __msgtype__: ClassVar[str]

@dataclass
class LaneStates:
    """`rmf_fleet_msgs/msg/LaneStates`"""
    fleet_name: str
    closed_lanes: NDArray[np.uint64]
    speed_limits: list[SpeedLimitedLane]
    __msgtype__: ClassVar[str]

@dataclass
class Location:
    """`rmf_fleet_msgs/msg/Location`"""
    t: Time
    x: float
    y: float
    yaw: float
    obey_approach_speed_limit: bool
    approach_speed_limit: float
    level_name: str
    index: int
    __msgtype__: ClassVar[str]

@dataclass
class ModeParameter:
    """`rmf_fleet_msgs/msg/ModeParameter`"""
    name: str
    value: str
    __msgtype__: ClassVar[str]

@dataclass
class ModeRequest:
    """`rmf_fleet_msgs/msg/ModeRequest`"""
    fleet_name: str
    robot_name: str
    mode: RobotMode
    task_id: str
    parameters: list[ModeParameter]
    __msgtype__: ClassVar[str]

@dataclass
class MutexGroupAssignment:
    """`rmf_fleet_msgs/msg/MutexGroupAssignment`"""
    group: str
    claimant: int
    claim_time: Time
    __msgtype__: ClassVar[str]

@dataclass
class MutexGroupManualRelease:
    """`rmf_fleet_msgs/msg/MutexGroupManualRelease`"""
    release_mutex_groups: list[str]
    fleet: str
    robot: str
    __msgtype__: ClassVar[str]

@dataclass
class MutexGroupRequest:
    """`rmf_fleet_msgs/msg/MutexGroupRequest`"""
    group: str
    claimant: int
    claim_time: Time
    mode: int
    MODE_RELEASE: ClassVar[int] = 0
    MODE_LOCK: ClassVar[int] = 1
    __msgtype__: ClassVar[str]

@dataclass
class MutexGroupStates:
    """`rmf_fleet_msgs/msg/MutexGroupStates`"""
    assignments: list[MutexGroupAssignment]
    __msgtype__: ClassVar[str]

@dataclass
class PathRequest:
    """`rmf_fleet_msgs/msg/PathRequest`"""
    fleet_name: str
    robot_name: str
    path: list[Location]
    task_id: str
    __msgtype__: ClassVar[str]

@dataclass
class PauseRequest:
    """`rmf_fleet_msgs/msg/PauseRequest`"""
    fleet_name: str
    robot_name: str
    mode_request_id: int
    type: int
    at_checkpoint: int
    TYPE_PAUSE_IMMEDIATELY: ClassVar[int] = 0
    TYPE_PAUSE_AT_CHECKPOINT: ClassVar[int] = 1
    TYPE_RESUME: ClassVar[int] = 2
    __msgtype__: ClassVar[str]

@dataclass
class RobotCollision:
    """`rmf_fleet_msgs/msg/RobotCollision`"""
    robot_name: str
    location: Location
    __msgtype__: ClassVar[str]

@dataclass
class RobotMode:
    """`rmf_fleet_msgs/msg/RobotMode`"""
    mode: int
    mode_request_id: int
    MODE_IDLE: ClassVar[int] = 0
    MODE_CHARGING: ClassVar[int] = 1
    MODE_MOVING: ClassVar[int] = 2
    MODE_PAUSED: ClassVar[int] = 3
    MODE_WAITING: ClassVar[int] = 4
    MODE_EMERGENCY: ClassVar[int] = 5
    MODE_GOING_HOME: ClassVar[int] = 6
    MODE_DOCKING: ClassVar[int] = 7
    MODE_ADAPTER_ERROR: ClassVar[int] = 8
    MODE_CLEANING: ClassVar[int] = 9
    __msgtype__: ClassVar[str]

@dataclass
class rmf_fleet_msgs__msg__RobotState:
    """`rmf_fleet_msgs/msg/RobotState`"""
    name: str
    model: str
    task_id: str
    seq: int
    mode: RobotMode
    battery_percent: float
    location: Location
    path: list[Location]
    __msgtype__: ClassVar[str]

@dataclass
class SpeedLimitRequest:
    """`rmf_fleet_msgs/msg/SpeedLimitRequest`"""
    fleet_name: str
    speed_limits: list[SpeedLimitedLane]
    remove_limits: NDArray[np.uint64]
    __msgtype__: ClassVar[str]

@dataclass
class SpeedLimitedLane:
    """`rmf_fleet_msgs/msg/SpeedLimitedLane`"""
    lane_index: int
    speed_limit: float
    __msgtype__: ClassVar[str]

@dataclass
class LiftClearance_Request(ServiceRequest[LiftClearance_Request, LiftClearance_Response]):
    """`rmf_fleet_msgs/srv/LiftClearance_Request`"""
    robot_name: str
    lift_name: str
    __msgtype__: ClassVar[str]

@dataclass
class LiftClearance_Response:
    """`rmf_fleet_msgs/srv/LiftClearance_Response`"""
    decision: int
    DECISION_CLEAR: ClassVar[int] = 1
    DECISION_CROWDED: ClassVar[int] = 2
    __msgtype__: ClassVar[str]

# rmf_ingestor_msgs

@dataclass
class IngestorRequest:
    """`rmf_ingestor_msgs/msg/IngestorRequest`"""
    time: Time
    request_guid: str
    target_guid: str
    transporter_type: str
    items: list[IngestorRequestItem]
    __msgtype__: ClassVar[str]

@dataclass
class IngestorRequestItem:
    """`rmf_ingestor_msgs/msg/IngestorRequestItem`"""
    type_guid: str
    quantity: int
    compartment_name: str
    __msgtype__: ClassVar[str]

@dataclass
class IngestorResult:
    """`rmf_ingestor_msgs/msg/IngestorResult`"""
    time: Time
    request_guid: str
    source_guid: str
    status: int
    ACKNOWLEDGED: ClassVar[int] = 0
    SUCCESS: ClassVar[int] = 1
    FAILED: ClassVar[int] = 2
    __msgtype__: ClassVar[str]

@dataclass
class IngestorState:
    """`rmf_ingestor_msgs/msg/IngestorState`"""
    time: Time
    guid: str
    mode: int
    request_guid_queue: list[str]
    seconds_remaining: float
    IDLE: ClassVar[int] = 0
    BUSY: ClassVar[int] = 1
    OFFLINE: ClassVar[int] = 2
    __msgtype__: ClassVar[str]

# rmf_lift_msgs

@dataclass
class LiftRequest:
    """`rmf_lift_msgs/msg/LiftRequest`"""
    lift_name: str
    request_time: Time
    session_id: str
    request_type: int
    destination_floor: str
    door_state: int
    REQUEST_END_SESSION: ClassVar[int] = 0
    REQUEST_AGV_MODE: ClassVar[int] = 1
    REQUEST_HUMAN_MODE: ClassVar[int] = 2
    DOOR_CLOSED: ClassVar[int] = 0
    DOOR_OPEN: ClassVar[int] = 2
    __msgtype__: ClassVar[str]

@dataclass
class LiftState:
    """`rmf_lift_msgs/msg/LiftState`"""
    lift_time: Time
    lift_name: str
    available_floors: list[str]
    current_floor: str
    destination_floor: str
    door_state: int
    motion_state: int
    available_modes: NDArray[np.uint8]
    current_mode: int
    session_id: str
    DOOR_CLOSED: ClassVar[int] = 0
    DOOR_MOVING: ClassVar[int] = 1
    DOOR_OPEN: ClassVar[int] = 2
    MOTION_STOPPED: ClassVar[int] = 0
    MOTION_UP: ClassVar[int] = 1
    MOTION_DOWN: ClassVar[int] = 2
    MOTION_UNKNOWN: ClassVar[int] = 3
    MODE_UNKNOWN: ClassVar[int] = 0
    MODE_HUMAN: ClassVar[int] = 1
    MODE_AGV: ClassVar[int] = 2
    MODE_FIRE: ClassVar[int] = 3
    MODE_OFFLINE: ClassVar[int] = 4
    MODE_EMERGENCY: ClassVar[int] = 5
    __msgtype__: ClassVar[str]

# rmf_task_msgs

@dataclass
class DynamicEvent_Feedback:
    """`rmf_task_msgs/action/DynamicEvent_Feedback`"""
    status: str
    id: int
    logs: list[LogEntry]
    __msgtype__: ClassVar[str]

@dataclass
class DynamicEvent_Goal(ActionGoal[DynamicEvent_Goal, DynamicEvent_Result, DynamicEvent_Feedback]):
    """`rmf_task_msgs/action/DynamicEvent_Goal`"""
    dynamic_event_seq: int
    event_type: int
    category: str
    description: str
    id: int
    stubborn_period: float
    EVENT_TYPE_UNINITIALIZED: ClassVar[int] = 0
    EVENT_TYPE_NEXT: ClassVar[int] = 1
    EVENT_TYPE_CANCEL: ClassVar[int] = 2
    EVENT_TYPE_FINISHED: ClassVar[int] = 3
    __msgtype__: ClassVar[str]

@dataclass
class DynamicEvent_Result:
    """`rmf_task_msgs/action/DynamicEvent_Result`"""
    execution_failure: str
    status: str
    id: int
    __msgtype__: ClassVar[str]

@dataclass
class Alert:
    """`rmf_task_msgs/msg/Alert`"""
    id: str
    title: str
    subtitle: str
    message: str
    display: bool
    tier: int
    responses_available: list[str]
    alert_parameters: list[AlertParameter]
    task_id: str
    TIER_INFO: ClassVar[int] = 0
    TIER_WARNING: ClassVar[int] = 1
    TIER_ERROR: ClassVar[int] = 2
    __msgtype__: ClassVar[str]

@dataclass
class AlertParameter:
    """`rmf_task_msgs/msg/AlertParameter`"""
    name: str
    value: str
    __msgtype__: ClassVar[str]

@dataclass
class AlertResponse:
    """`rmf_task_msgs/msg/AlertResponse`"""
    id: str
    response: str
    __msgtype__: ClassVar[str]

@dataclass
class ApiRequest:
    """`rmf_task_msgs/msg/ApiRequest`"""
    json_msg: str
    request_id: str
    __msgtype__: ClassVar[str]

@dataclass
class ApiResponse:
    """`rmf_task_msgs/msg/ApiResponse`"""
    type: int
    json_msg: str
    request_id: str
    TYPE_UNINITIALIZED: ClassVar[int] = 0
    TYPE_ACKNOWLEDGE: ClassVar[int] = 1
    TYPE_RESPONDING: ClassVar[int] = 2
    __msgtype__: ClassVar[str]

@dataclass
class Assignment:
    """`rmf_task_msgs/msg/Assignment`"""
    is_assigned: bool
    fleet_name: str
    expected_robot_name: str
    __msgtype__: ClassVar[str]

@dataclass
class Behavior:
    """`rmf_task_msgs/msg/Behavior`"""
    name: str
    parameters: list[BehaviorParameter]
    __msgtype__: ClassVar[str]

@dataclass
class BehaviorParameter:
    """`rmf_task_msgs/msg/BehaviorParameter`"""
    name: str
    value: str
    __msgtype__: ClassVar[str]

@dataclass
class BidNotice:
    """`rmf_task_msgs/msg/BidNotice`"""
    request: str
    task_id: str
    time_window: Duration
    dry_run: bool
    __msgtype__: ClassVar[str]

@dataclass
class BidProposal:
    """`rmf_task_msgs/msg/BidProposal`"""
    fleet_name: str
    expected_robot_name: str
    prev_cost: float
    new_cost: float
    finish_time: Time
    __msgtype__: ClassVar[str]

@dataclass
class BidResponse:
    """`rmf_task_msgs/msg/BidResponse`"""
    task_id: str
    has_proposal: bool
    proposal: BidProposal
    errors: list[str]
    __msgtype__: ClassVar[str]

@dataclass
class Clean:
    """`rmf_task_msgs/msg/Clean`"""
    start_waypoint: str
    __msgtype__: ClassVar[str]

@dataclass
class Delivery:
    """`rmf_task_msgs/msg/Delivery`"""
    task_id: str
    items: list[DispenserRequestItem]
    pickup_place_name: str
    pickup_dispenser: str
    pickup_behavior: Behavior
    dropoff_place_name: str
    dropoff_ingestor: str
    dropoff_behavior: Behavior
    __msgtype__: ClassVar[str]

@dataclass
class DispatchAck:
    """`rmf_task_msgs/msg/DispatchAck`"""
    dispatch_id: int
    success: bool
    errors: list[str]
    __msgtype__: ClassVar[str]

@dataclass
class DispatchCommand:
    """`rmf_task_msgs/msg/DispatchCommand`"""
    fleet_name: str
    task_id: str
    dispatch_id: int
    timestamp: Time
    type: int
    TYPE_AWARD: ClassVar[int] = 1
    TYPE_REMOVE: ClassVar[int] = 2
    __msgtype__: ClassVar[str]

@dataclass
class DispatchState:
    """`rmf_task_msgs/msg/DispatchState`"""
    task_id: str
    status: int
    assignment: Assignment
    errors: list[str]
    STATUS_UNINITIALIZED: ClassVar[int] = 0
    STATUS_QUEUED: ClassVar[int] = 1
    STATUS_SELECTED: ClassVar[int] = 2
    STATUS_DISPATCHED: ClassVar[int] = 3
    STATUS_FAILED_TO_ASSIGN: ClassVar[int] = 4
    STATUS_CANCELED_IN_FLIGHT: ClassVar[int] = 5
    __msgtype__: ClassVar[str]

@dataclass
class DispatchStates:
    """`rmf_task_msgs/msg/DispatchStates`"""
    active: list[DispatchState]
    finished: list[DispatchState]
    __msgtype__: ClassVar[str]

@dataclass
class DynamicEventDescription:
    """`rmf_task_msgs/msg/DynamicEventDescription`"""
    fleet: str
    robot: str
    dynamic_event_seq: int
    description: str
    start_time: Time
    __msgtype__: ClassVar[str]

@dataclass
class DynamicEventStatus:
    """`rmf_task_msgs/msg/DynamicEventStatus`"""
    dynamic_event_seq: int
    dynamic_state: int
    status: str
    id: int
    time: Time
    DYNAMIC_STATE_INACTIVE: ClassVar[int] = 0
    DYNAMIC_STATE_WAITING: ClassVar[int] = 1
    DYNAMIC_STATE_RUNNING: ClassVar[int] = 2
    __msgtype__: ClassVar[str]

@dataclass
class LogEntry:
    """`rmf_task_msgs/msg/LogEntry`"""
    seq: int
    tier: str
    unix_millis_time: int
    text: str
    TIER_UNINITIALIZED: ClassVar[str] = 'uninitialized'
    TIER_INFO: ClassVar[str] = 'info'
    TIER_WARNING: ClassVar[str] = 'warning'
    TIER_ERROR: ClassVar[str] = 'error'
    __msgtype__: ClassVar[str]

@dataclass
class Loop:
    """`rmf_task_msgs/msg/Loop`"""
    task_id: str
    robot_type: str
    num_loops: int
    start_name: str
    finish_name: str
    __msgtype__: ClassVar[str]

@dataclass
class Priority:
    """`rmf_task_msgs/msg/Priority`"""
    value: int
    __msgtype__: ClassVar[str]

@dataclass
class Station:
    """`rmf_task_msgs/msg/Station`"""
    task_id: str
    robot_type: str
    place_name: str
    __msgtype__: ClassVar[str]

@dataclass
class TaskDescription:
    """`rmf_task_msgs/msg/TaskDescription`"""
    start_time: Time
    priority: Priority
    task_type: TaskType
    station: Station
    loop: Loop
    delivery: Delivery
    clean: Clean
    __msgtype__: ClassVar[str]

@dataclass
class TaskProfile:
    """`rmf_task_msgs/msg/TaskProfile`"""
    task_id: str
    submission_time: Time
    description: TaskDescription
    __msgtype__: ClassVar[str]

@dataclass
class TaskSummary:
    """`rmf_task_msgs/msg/TaskSummary`"""
    fleet_name: str
    task_id: str
    task_profile: TaskProfile
    state: int
    status: str
    submission_time: Time
    start_time: Time
    end_time: Time
    robot_name: str
    STATE_QUEUED: ClassVar[int] = 0
    STATE_ACTIVE: ClassVar[int] = 1
    STATE_COMPLETED: ClassVar[int] = 2
    STATE_FAILED: ClassVar[int] = 3
    STATE_CANCELED: ClassVar[int] = 4
    STATE_PENDING: ClassVar[int] = 5
    __msgtype__: ClassVar[str]

@dataclass
class TaskType:
    """`rmf_task_msgs/msg/TaskType`"""
    type: int
    TYPE_STATION: ClassVar[int] = 0
    TYPE_LOOP: ClassVar[int] = 1
    TYPE_DELIVERY: ClassVar[int] = 2
    TYPE_CHARGE_BATTERY: ClassVar[int] = 3
    TYPE_CLEAN: ClassVar[int] = 4
    TYPE_PATROL: ClassVar[int] = 5
    __msgtype__: ClassVar[str]

@dataclass
class Tasks:
    """`rmf_task_msgs/msg/Tasks`"""
    tasks: list[TaskSummary]
    __msgtype__: ClassVar[str]

@dataclass
class Tow:
    """`rmf_task_msgs/msg/Tow`"""
    task_id: str
    object_type: str
    is_object_id_known: bool
    object_id: str
    pickup_place_name: str
    is_dropoff_place_known: bool
    dropoff_place_name: str
    __msgtype__: ClassVar[str]

@dataclass
class ApiService_Request(ServiceRequest[ApiService_Request, ApiService_Response]):
    """`rmf_task_msgs/srv/ApiService_Request`"""
    json_msg: str
    __msgtype__: ClassVar[str]

@dataclass
class ApiService_Response:
    """`rmf_task_msgs/srv/ApiService_Response`"""
    json_msg: str
    __msgtype__: ClassVar[str]

@dataclass
class CancelTask_Request(ServiceRequest[CancelTask_Request, CancelTask_Response]):
    """`rmf_task_msgs/srv/CancelTask_Request`"""
    requester: str
    task_id: str
    __msgtype__: ClassVar[str]

@dataclass
class CancelTask_Response:
    """`rmf_task_msgs/srv/CancelTask_Response`"""
    success: bool
    message: str
    __msgtype__: ClassVar[str]

@dataclass
class GetDispatchStates_Request(ServiceRequest[GetDispatchStates_Request, GetDispatchStates_Response]):
    """`rmf_task_msgs/srv/GetDispatchStates_Request`"""
    task_ids: list[str]
    __msgtype__: ClassVar[str]

@dataclass
class GetDispatchStates_Response:
    """`rmf_task_msgs/srv/GetDispatchStates_Response`"""
    success: bool
    states: DispatchStates
    __msgtype__: ClassVar[str]

@dataclass
class ReviveTask_Request(ServiceRequest[ReviveTask_Request, ReviveTask_Response]):
    """`rmf_task_msgs/srv/ReviveTask_Request`"""
    requester: str
    task_id: str
    __msgtype__: ClassVar[str]

@dataclass
class ReviveTask_Response:
    """`rmf_task_msgs/srv/ReviveTask_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class SubmitTask_Request(ServiceRequest[SubmitTask_Request, SubmitTask_Response]):
    """`rmf_task_msgs/srv/SubmitTask_Request`"""
    requester: str
    description: TaskDescription
    __msgtype__: ClassVar[str]

@dataclass
class SubmitTask_Response:
    """`rmf_task_msgs/srv/SubmitTask_Response`"""
    success: bool
    task_id: str
    message: str
    __msgtype__: ClassVar[str]

# rmw_dds_common

@dataclass
class Gid:
    """`rmw_dds_common/msg/Gid`"""
    data: NDArray[np.uint8]
    __msgtype__: ClassVar[str]

@dataclass
class NodeEntitiesInfo:
    """`rmw_dds_common/msg/NodeEntitiesInfo`"""
    node_namespace: str
    node_name: str
    reader_gid_seq: list[Gid]
    writer_gid_seq: list[Gid]
    __msgtype__: ClassVar[str]

@dataclass
class ParticipantEntitiesInfo:
    """`rmw_dds_common/msg/ParticipantEntitiesInfo`"""
    gid: Gid
    node_entities_info_seq: list[NodeEntitiesInfo]
    __msgtype__: ClassVar[str]

# robot_localization

@dataclass
class FromLL_Request(ServiceRequest[FromLL_Request, FromLL_Response]):
    """`robot_localization/srv/FromLL_Request`"""
    ll_point: GeoPoint
    __msgtype__: ClassVar[str]

@dataclass
class FromLL_Response:
    """`robot_localization/srv/FromLL_Response`"""
    map_point: Point
    __msgtype__: ClassVar[str]

@dataclass
class robot_localization__srv__GetState_Request(ServiceRequest[robot_localization__srv__GetState_Request, robot_localization__srv__GetState_Response]):
    """`robot_localization/srv/GetState_Request`"""
    time_stamp: Time
    frame_id: str
    __msgtype__: ClassVar[str]

@dataclass
class robot_localization__srv__GetState_Response:
    """`robot_localization/srv/GetState_Response`"""
    state: NDArray[np.float64]
    covariance: NDArray[np.float64]
    __msgtype__: ClassVar[str]

@dataclass
class SetDatum_Request(ServiceRequest[SetDatum_Request, SetDatum_Response]):
    """`robot_localization/srv/SetDatum_Request`"""
    geo_pose: GeoPose
    __msgtype__: ClassVar[str]

@dataclass
class SetDatum_Response:
    """`robot_localization/srv/SetDatum_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class SetPose_Request(ServiceRequest[SetPose_Request, SetPose_Response]):
    """`robot_localization/srv/SetPose_Request`"""
    pose: PoseWithCovarianceStamped
    __msgtype__: ClassVar[str]

@dataclass
class SetPose_Response:
    """`robot_localization/srv/SetPose_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class SetUTMZone_Request(ServiceRequest[SetUTMZone_Request, SetUTMZone_Response]):
    """`robot_localization/srv/SetUTMZone_Request`"""
    utm_zone: str
    __msgtype__: ClassVar[str]

@dataclass
class SetUTMZone_Response:
    """`robot_localization/srv/SetUTMZone_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class ToLL_Request(ServiceRequest[ToLL_Request, ToLL_Response]):
    """`robot_localization/srv/ToLL_Request`"""
    map_point: Point
    __msgtype__: ClassVar[str]

@dataclass
class ToLL_Response:
    """`robot_localization/srv/ToLL_Response`"""
    ll_point: GeoPoint
    __msgtype__: ClassVar[str]

@dataclass
class ToggleFilterProcessing_Request(ServiceRequest[ToggleFilterProcessing_Request, ToggleFilterProcessing_Response]):
    """`robot_localization/srv/ToggleFilterProcessing_Request`"""
    on: bool
    __msgtype__: ClassVar[str]

@dataclass
class ToggleFilterProcessing_Response:
    """`robot_localization/srv/ToggleFilterProcessing_Response`"""
    status: bool
    __msgtype__: ClassVar[str]

# ros2_aruco_interfaces

@dataclass
class ArucoMarkers:
    """`ros2_aruco_interfaces/msg/ArucoMarkers`"""
    header: Header
    marker_ids: NDArray[np.int64]
    poses: list[Pose]
    __msgtype__: ClassVar[str]

# ros_gz_interfaces

@dataclass
class AirSpeed:
    """`ros_gz_interfaces/msg/AirSpeed`"""
    header: Header
    diff_pressure: float
    temperature: float
    __msgtype__: ClassVar[str]

@dataclass
class Altimeter:
    """`ros_gz_interfaces/msg/Altimeter`"""
    header: Header
    vertical_position: float
    vertical_velocity: float
    vertical_reference: float
    __msgtype__: ClassVar[str]

@dataclass
class Contact:
    """`ros_gz_interfaces/msg/Contact`"""
    collision1: Entity
    collision2: Entity
    positions: list[Vector3]
    normals: list[Vector3]
    depths: NDArray[np.float64]
    wrenches: list[JointWrench]
    __msgtype__: ClassVar[str]

@dataclass
class Contacts:
    """`ros_gz_interfaces/msg/Contacts`"""
    header: Header
    contacts: list[Contact]
    __msgtype__: ClassVar[str]

@dataclass
class Dataframe:
    """`ros_gz_interfaces/msg/Dataframe`"""
    header: Header
    src_address: str
    dst_address: str
    data: NDArray[np.uint8]
    rssi: float
    __msgtype__: ClassVar[str]

@dataclass
class Entity:
    """`ros_gz_interfaces/msg/Entity`"""
    id: int
    name: str
    type: int
    NONE: ClassVar[int] = 0
    LIGHT: ClassVar[int] = 1
    MODEL: ClassVar[int] = 2
    LINK: ClassVar[int] = 3
    VISUAL: ClassVar[int] = 4
    COLLISION: ClassVar[int] = 5
    SENSOR: ClassVar[int] = 6
    JOINT: ClassVar[int] = 7
    __msgtype__: ClassVar[str]

@dataclass
class EntityFactory:
    """`ros_gz_interfaces/msg/EntityFactory`"""
    name: str
    allow_renaming: bool
    sdf: str
    sdf_filename: str
    clone_name: str
    pose: Pose
    relative_to: str
    __msgtype__: ClassVar[str]

@dataclass
class EntityWrench:
    """`ros_gz_interfaces/msg/EntityWrench`"""
    header: Header
    entity: Entity
    wrench: Wrench
    __msgtype__: ClassVar[str]

@dataclass
class Float32Array:
    """`ros_gz_interfaces/msg/Float32Array`"""
    data: NDArray[np.float32]
    __msgtype__: ClassVar[str]

@dataclass
class JointWrench:
    """`ros_gz_interfaces/msg/JointWrench`"""
    header: Header
    body_1_name: String
    body_1_id: UInt32
    body_2_name: String
    body_2_id: UInt32
    body_1_wrench: Wrench
    body_2_wrench: Wrench
    __msgtype__: ClassVar[str]

@dataclass
class Light:
    """`ros_gz_interfaces/msg/Light`"""
    header: Header
    name: str
    type: int
    pose: Pose
    diffuse: ColorRGBA
    specular: ColorRGBA
    attenuation_constant: float
    attenuation_linear: float
    attenuation_quadratic: float
    direction: Vector3
    range: float
    cast_shadows: bool
    spot_inner_angle: float
    spot_outer_angle: float
    spot_falloff: float
    id: int
    parent_id: int
    intensity: float
    POINT: ClassVar[int] = 0
    SPOT: ClassVar[int] = 1
    DIRECTIONAL: ClassVar[int] = 2
    __msgtype__: ClassVar[str]

@dataclass
class LogPlaybackStatistics:
    """`ros_gz_interfaces/msg/LogPlaybackStatistics`"""
    header: Header
    start_time: Time
    end_time: Time
    __msgtype__: ClassVar[str]

@dataclass
class LogicalCameraImage:
    """`ros_gz_interfaces/msg/LogicalCameraImage`"""
    header: Header
    pose: Pose
    model: list[LogicalCameraImageModel]
    __msgtype__: ClassVar[str]

@dataclass
class LogicalCameraImageModel:
    """`ros_gz_interfaces/msg/LogicalCameraImageModel`"""
    name: str
    pose: Pose
    __msgtype__: ClassVar[str]

@dataclass
class MaterialColor:
    """`ros_gz_interfaces/msg/MaterialColor`"""
    header: Header
    entity: Entity
    ambient: ColorRGBA
    diffuse: ColorRGBA
    specular: ColorRGBA
    emissive: ColorRGBA
    shininess: float
    entity_match: int
    FIRST: ClassVar[int] = 0
    ALL: ClassVar[int] = 1
    __msgtype__: ClassVar[str]

@dataclass
class ParamVec:
    """`ros_gz_interfaces/msg/ParamVec`"""
    header: Header
    params: list[Parameter]
    __msgtype__: ClassVar[str]

@dataclass
class WorldControl:
    """`ros_gz_interfaces/msg/WorldControl`"""
    pause: bool
    step: bool
    multi_step: int
    reset: WorldReset
    seed: int
    run_to_sim_time: Time
    __msgtype__: ClassVar[str]

@dataclass
class WorldReset:
    """`ros_gz_interfaces/msg/WorldReset`"""
    all: bool
    time_only: bool
    model_only: bool
    __msgtype__: ClassVar[str]

@dataclass
class WorldStatistics:
    """`ros_gz_interfaces/msg/WorldStatistics`"""
    header: Header
    sim_time: Time
    pause_time: Time
    real_time: Time
    paused: bool
    iterations: int
    model_count: int
    log_playback_statistics: LogPlaybackStatistics
    real_time_factor: float
    step_size: Time
    stepping: bool
    __msgtype__: ClassVar[str]

@dataclass
class ControlWorld_Request(ServiceRequest[ControlWorld_Request, ControlWorld_Response]):
    """`ros_gz_interfaces/srv/ControlWorld_Request`"""
    world_control: WorldControl
    __msgtype__: ClassVar[str]

@dataclass
class ControlWorld_Response:
    """`ros_gz_interfaces/srv/ControlWorld_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class ros_gz_interfaces__srv__DeleteEntity_Request(ServiceRequest[ros_gz_interfaces__srv__DeleteEntity_Request, ros_gz_interfaces__srv__DeleteEntity_Response]):
    """`ros_gz_interfaces/srv/DeleteEntity_Request`"""
    entity: Entity
    __msgtype__: ClassVar[str]

@dataclass
class ros_gz_interfaces__srv__DeleteEntity_Response:
    """`ros_gz_interfaces/srv/DeleteEntity_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class SetEntityPose_Request(ServiceRequest[SetEntityPose_Request, SetEntityPose_Response]):
    """`ros_gz_interfaces/srv/SetEntityPose_Request`"""
    entity: Entity
    pose: Pose
    __msgtype__: ClassVar[str]

@dataclass
class SetEntityPose_Response:
    """`ros_gz_interfaces/srv/SetEntityPose_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class ros_gz_interfaces__srv__SpawnEntity_Request(ServiceRequest[ros_gz_interfaces__srv__SpawnEntity_Request, ros_gz_interfaces__srv__SpawnEntity_Response]):
    """`ros_gz_interfaces/srv/SpawnEntity_Request`"""
    entity_factory: EntityFactory
    __msgtype__: ClassVar[str]

@dataclass
class ros_gz_interfaces__srv__SpawnEntity_Response:
    """`ros_gz_interfaces/srv/SpawnEntity_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

# rosbag2_interfaces

@dataclass
class ReadSplitEvent:
    """`rosbag2_interfaces/msg/ReadSplitEvent`"""
    closed_file: str
    opened_file: str
    node_name: str
    __msgtype__: ClassVar[str]

@dataclass
class WriteSplitEvent:
    """`rosbag2_interfaces/msg/WriteSplitEvent`"""
    closed_file: str
    opened_file: str
    node_name: str
    __msgtype__: ClassVar[str]

# roscpp

@dataclass
class Logger:
    """`roscpp/msg/Logger`"""
    name: str
    level: str
    __msgtype__: ClassVar[str]

@dataclass
class GetLoggers_Request(ServiceRequest[GetLoggers_Request, GetLoggers_Response]):
    """`roscpp/srv/GetLoggers_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class GetLoggers_Response:
    """`roscpp/srv/GetLoggers_Response`"""
    loggers: list[Logger]
    __msgtype__: ClassVar[str]

@dataclass
class SetLoggerLevel_Request(ServiceRequest[SetLoggerLevel_Request, SetLoggerLevel_Response]):
    """`roscpp/srv/SetLoggerLevel_Request`"""
    logger: str
    level: str
    __msgtype__: ClassVar[str]

@dataclass
class SetLoggerLevel_Response:
    """`roscpp/srv/SetLoggerLevel_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

# roscpp_tutorials

@dataclass
class TwoInts_Request(ServiceRequest[TwoInts_Request, TwoInts_Response]):
    """`roscpp_tutorials/srv/TwoInts_Request`"""
    a: int
    b: int
    __msgtype__: ClassVar[str]

@dataclass
class TwoInts_Response:
    """`roscpp_tutorials/srv/TwoInts_Response`"""
    sum: int
    __msgtype__: ClassVar[str]

# rosgraph_msgs

@dataclass
class Clock:
    """`rosgraph_msgs/msg/Clock`"""
    clock: Time
    __msgtype__: ClassVar[str]

# rospy_tutorials

@dataclass
class Floats:
    """`rospy_tutorials/msg/Floats`"""
    data: NDArray[np.float32]
    __msgtype__: ClassVar[str]

@dataclass
class HeaderString:
    """`rospy_tutorials/msg/HeaderString`"""
    header: Header
    data: str
    __msgtype__: ClassVar[str]

@dataclass
class rospy_tutorials__srv__AddTwoInts_Request(ServiceRequest[rospy_tutorials__srv__AddTwoInts_Request, rospy_tutorials__srv__AddTwoInts_Response]):
    """`rospy_tutorials/srv/AddTwoInts_Request`"""
    a: int
    b: int
    __msgtype__: ClassVar[str]

@dataclass
class rospy_tutorials__srv__AddTwoInts_Response:
    """`rospy_tutorials/srv/AddTwoInts_Response`"""
    sum: int
    __msgtype__: ClassVar[str]

@dataclass
class BadTwoInts_Request(ServiceRequest[BadTwoInts_Request, BadTwoInts_Response]):
    """`rospy_tutorials/srv/BadTwoInts_Request`"""
    a: int
    b: int
    __msgtype__: ClassVar[str]

@dataclass
class BadTwoInts_Response:
    """`rospy_tutorials/srv/BadTwoInts_Response`"""
    sum: int
    __msgtype__: ClassVar[str]

# sensor_msgs

@dataclass
class BatteryState:
    """`sensor_msgs/msg/BatteryState`"""
    header: Header
    voltage: float
    temperature: float
    current: float
    charge: float
    capacity: float
    design_capacity: float
    percentage: float
    power_supply_status: int
    power_supply_health: int
    power_supply_technology: int
    present: bool
    cell_voltage: NDArray[np.float32]
    cell_temperature: NDArray[np.float32]
    location: str
    serial_number: str
    POWER_SUPPLY_STATUS_UNKNOWN: ClassVar[int] = 0
    POWER_SUPPLY_STATUS_CHARGING: ClassVar[int] = 1
    POWER_SUPPLY_STATUS_DISCHARGING: ClassVar[int] = 2
    POWER_SUPPLY_STATUS_NOT_CHARGING: ClassVar[int] = 3
    POWER_SUPPLY_STATUS_FULL: ClassVar[int] = 4
    POWER_SUPPLY_HEALTH_UNKNOWN: ClassVar[int] = 0
    POWER_SUPPLY_HEALTH_GOOD: ClassVar[int] = 1
    POWER_SUPPLY_HEALTH_OVERHEAT: ClassVar[int] = 2
    POWER_SUPPLY_HEALTH_DEAD: ClassVar[int] = 3
    POWER_SUPPLY_HEALTH_OVERVOLTAGE: ClassVar[int] = 4
    POWER_SUPPLY_HEALTH_UNSPEC_FAILURE: ClassVar[int] = 5
    POWER_SUPPLY_HEALTH_COLD: ClassVar[int] = 6
    POWER_SUPPLY_HEALTH_WATCHDOG_TIMER_EXPIRE: ClassVar[int] = 7
    POWER_SUPPLY_HEALTH_SAFETY_TIMER_EXPIRE: ClassVar[int] = 8
    POWER_SUPPLY_TECHNOLOGY_UNKNOWN: ClassVar[int] = 0
    POWER_SUPPLY_TECHNOLOGY_NIMH: ClassVar[int] = 1
    POWER_SUPPLY_TECHNOLOGY_LION: ClassVar[int] = 2
    POWER_SUPPLY_TECHNOLOGY_LIPO: ClassVar[int] = 3
    POWER_SUPPLY_TECHNOLOGY_LIFE: ClassVar[int] = 4
    POWER_SUPPLY_TECHNOLOGY_NICD: ClassVar[int] = 5
    POWER_SUPPLY_TECHNOLOGY_LIMN: ClassVar[int] = 6
    POWER_SUPPLY_TECHNOLOGY_TERNARY: ClassVar[int] = 7
    POWER_SUPPLY_TECHNOLOGY_VRLA: ClassVar[int] = 8
    __msgtype__: ClassVar[str]

@dataclass
class CameraInfo:
    """`sensor_msgs/msg/CameraInfo`"""
    header: Header
    height: int
    width: int
    distortion_model: str
    d: NDArray[np.float64]
    k: NDArray[np.float64]
    r: NDArray[np.float64]
    p: NDArray[np.float64]
    binning_x: int
    binning_y: int
    roi: RegionOfInterest
    __msgtype__: ClassVar[str]

@dataclass
class ChannelFloat32:
    """`sensor_msgs/msg/ChannelFloat32`"""
    name: str
    values: NDArray[np.float32]
    __msgtype__: ClassVar[str]

@dataclass
class CompressedImage:
    """`sensor_msgs/msg/CompressedImage`"""
    header: Header
    format: str
    data: NDArray[np.uint8]
    __msgtype__: ClassVar[str]

@dataclass
class FluidPressure:
    """`sensor_msgs/msg/FluidPressure`"""
    header: Header
    fluid_pressure: float
    variance: float
    __msgtype__: ClassVar[str]

@dataclass
class Illuminance:
    """`sensor_msgs/msg/Illuminance`"""
    header: Header
    illuminance: float
    variance: float
    __msgtype__: ClassVar[str]

@dataclass
class Image:
    """`sensor_msgs/msg/Image`"""
    header: Header
    height: int
    width: int
    encoding: str
    is_bigendian: int
    step: int
    data: NDArray[np.uint8]
    __msgtype__: ClassVar[str]

@dataclass
class Imu:
    """`sensor_msgs/msg/Imu`"""
    header: Header
    orientation: Quaternion
    orientation_covariance: NDArray[np.float64]
    angular_velocity: Vector3
    angular_velocity_covariance: NDArray[np.float64]
    linear_acceleration: Vector3
    linear_acceleration_covariance: NDArray[np.float64]
    __msgtype__: ClassVar[str]

@dataclass
class JointState:
    """`sensor_msgs/msg/JointState`"""
    header: Header
    name: list[str]
    position: NDArray[np.float64]
    velocity: NDArray[np.float64]
    effort: NDArray[np.float64]
    __msgtype__: ClassVar[str]

@dataclass
class Joy:
    """`sensor_msgs/msg/Joy`"""
    header: Header
    axes: NDArray[np.float32]
    buttons: NDArray[np.int32]
    __msgtype__: ClassVar[str]

@dataclass
class JoyFeedback:
    """`sensor_msgs/msg/JoyFeedback`"""
    type: int
    id: int
    intensity: float
    TYPE_LED: ClassVar[int] = 0
    TYPE_RUMBLE: ClassVar[int] = 1
    TYPE_BUZZER: ClassVar[int] = 2
    __msgtype__: ClassVar[str]

@dataclass
class JoyFeedbackArray:
    """`sensor_msgs/msg/JoyFeedbackArray`"""
    array: list[JoyFeedback]
    __msgtype__: ClassVar[str]

@dataclass
class LaserEcho:
    """`sensor_msgs/msg/LaserEcho`"""
    echoes: NDArray[np.float32]
    __msgtype__: ClassVar[str]

@dataclass
class LaserScan:
    """`sensor_msgs/msg/LaserScan`"""
    header: Header
    angle_min: float
    angle_max: float
    angle_increment: float
    time_increment: float
    scan_time: float
    range_min: float
    range_max: float
    ranges: NDArray[np.float32]
    intensities: NDArray[np.float32]
    __msgtype__: ClassVar[str]

@dataclass
class MagneticField:
    """`sensor_msgs/msg/MagneticField`"""
    header: Header
    magnetic_field: Vector3
    magnetic_field_covariance: NDArray[np.float64]
    __msgtype__: ClassVar[str]

@dataclass
class MultiDOFJointState:
    """`sensor_msgs/msg/MultiDOFJointState`"""
    header: Header
    joint_names: list[str]
    transforms: list[Transform]
    twist: list[Twist]
    wrench: list[Wrench]
    __msgtype__: ClassVar[str]

@dataclass
class MultiEchoLaserScan:
    """`sensor_msgs/msg/MultiEchoLaserScan`"""
    header: Header
    angle_min: float
    angle_max: float
    angle_increment: float
    time_increment: float
    scan_time: float
    range_min: float
    range_max: float
    ranges: list[LaserEcho]
    intensities: list[LaserEcho]
    __msgtype__: ClassVar[str]

@dataclass
class NavSatFix:
    """`sensor_msgs/msg/NavSatFix`"""
    header: Header
    status: NavSatStatus
    latitude: float
    longitude: float
    altitude: float
    position_covariance: NDArray[np.float64]
    position_covariance_type: int
    COVARIANCE_TYPE_UNKNOWN: ClassVar[int] = 0
    COVARIANCE_TYPE_APPROXIMATED: ClassVar[int] = 1
    COVARIANCE_TYPE_DIAGONAL_KNOWN: ClassVar[int] = 2
    COVARIANCE_TYPE_KNOWN: ClassVar[int] = 3
    __msgtype__: ClassVar[str]

@dataclass
class NavSatStatus:
    """`sensor_msgs/msg/NavSatStatus`"""
    status: int
    service: int
    STATUS_UNKNOWN: ClassVar[int] = -2
    STATUS_NO_FIX: ClassVar[int] = -1
    STATUS_FIX: ClassVar[int] = 0
    STATUS_SBAS_FIX: ClassVar[int] = 1
    STATUS_GBAS_FIX: ClassVar[int] = 2
    SERVICE_UNKNOWN: ClassVar[int] = 0
    SERVICE_GPS: ClassVar[int] = 1
    SERVICE_GLONASS: ClassVar[int] = 2
    SERVICE_COMPASS: ClassVar[int] = 4
    SERVICE_GALILEO: ClassVar[int] = 8
    __msgtype__: ClassVar[str]

@dataclass
class PointCloud:
    """`sensor_msgs/msg/PointCloud`"""
    header: Header
    points: list[Point32]
    channels: list[ChannelFloat32]
    __msgtype__: ClassVar[str]

@dataclass
class PointCloud2:
    """`sensor_msgs/msg/PointCloud2`"""
    header: Header
    height: int
    width: int
    fields: list[PointField]
    is_bigendian: bool
    point_step: int
    row_step: int
    data: NDArray[np.uint8]
    is_dense: bool
    __msgtype__: ClassVar[str]

@dataclass
class PointField:
    """`sensor_msgs/msg/PointField`"""
    name: str
    offset: int
    datatype: int
    count: int
    INT8: ClassVar[int] = 1
    UINT8: ClassVar[int] = 2
    INT16: ClassVar[int] = 3
    UINT16: ClassVar[int] = 4
    INT32: ClassVar[int] = 5
    UINT32: ClassVar[int] = 6
    FLOAT32: ClassVar[int] = 7
    FLOAT64: ClassVar[int] = 8
    __msgtype__: ClassVar[str]

@dataclass
class Range:
    """`sensor_msgs/msg/Range`"""
    header: Header
    radiation_type: int
    field_of_view: float
    min_range: float
    max_range: float
    range: float
    variance: float
    ULTRASOUND: ClassVar[int] = 0
    INFRARED: ClassVar[int] = 1
    __msgtype__: ClassVar[str]

@dataclass
class RegionOfInterest:
    """`sensor_msgs/msg/RegionOfInterest`"""
    x_offset: int
    y_offset: int
    height: int
    width: int
    do_rectify: bool
    __msgtype__: ClassVar[str]

@dataclass
class RelativeHumidity:
    """`sensor_msgs/msg/RelativeHumidity`"""
    header: Header
    relative_humidity: float
    variance: float
    __msgtype__: ClassVar[str]

@dataclass
class Temperature:
    """`sensor_msgs/msg/Temperature`"""
    header: Header
    temperature: float
    variance: float
    __msgtype__: ClassVar[str]

@dataclass
class TimeReference:
    """`sensor_msgs/msg/TimeReference`"""
    header: Header
    time_ref: Time
    source: str
    __msgtype__: ClassVar[str]

@dataclass
class SetCameraInfo_Request(ServiceRequest[SetCameraInfo_Request, SetCameraInfo_Response]):
    """`sensor_msgs/srv/SetCameraInfo_Request`"""
    camera_info: CameraInfo
    __msgtype__: ClassVar[str]

@dataclass
class SetCameraInfo_Response:
    """`sensor_msgs/srv/SetCameraInfo_Response`"""
    success: bool
    status_message: str
    __msgtype__: ClassVar[str]

# service_msgs

@dataclass
class ServiceEventInfo:
    """`service_msgs/msg/ServiceEventInfo`"""
    event_type: int
    stamp: Time
    client_gid: NDArray[np.uint8]
    sequence_number: int
    REQUEST_SENT: ClassVar[int] = 0
    REQUEST_RECEIVED: ClassVar[int] = 1
    RESPONSE_SENT: ClassVar[int] = 2
    RESPONSE_RECEIVED: ClassVar[int] = 3
    __msgtype__: ClassVar[str]

# shape_msgs

@dataclass
class Mesh:
    """`shape_msgs/msg/Mesh`"""
    triangles: list[MeshTriangle]
    vertices: list[Point]
    __msgtype__: ClassVar[str]

@dataclass
class MeshTriangle:
    """`shape_msgs/msg/MeshTriangle`"""
    vertex_indices: NDArray[np.uint32]
    __msgtype__: ClassVar[str]

@dataclass
class Plane:
    """`shape_msgs/msg/Plane`"""
    coef: NDArray[np.float64]
    __msgtype__: ClassVar[str]

@dataclass
class SolidPrimitive:
    """`shape_msgs/msg/SolidPrimitive`"""
    type: int
    dimensions: NDArray[np.float64]
    polygon: Polygon
    BOX: ClassVar[int] = 1
    SPHERE: ClassVar[int] = 2
    CYLINDER: ClassVar[int] = 3
    CONE: ClassVar[int] = 4
    PRISM: ClassVar[int] = 5
    BOX_X: ClassVar[int] = 0
    BOX_Y: ClassVar[int] = 1
    BOX_Z: ClassVar[int] = 2
    SPHERE_RADIUS: ClassVar[int] = 0
    CYLINDER_HEIGHT: ClassVar[int] = 0
    CYLINDER_RADIUS: ClassVar[int] = 1
    CONE_HEIGHT: ClassVar[int] = 0
    CONE_RADIUS: ClassVar[int] = 1
    PRISM_HEIGHT: ClassVar[int] = 0
    __msgtype__: ClassVar[str]

# simkit_msgs

@dataclass
class LogicalCameraSensor:
    """`simkit_msgs/msg/LogicalCameraSensor`"""
    header: Header
    near_clip: float
    far_clip: float
    horizontal_fov: float
    aspect_ratio: float
    __msgtype__: ClassVar[str]

@dataclass
class PerformerStatus:
    """`simkit_msgs/msg/PerformerStatus`"""
    header: Header
    name: str
    pose: Pose
    state: bool
    count: int
    keys: list[str]
    values: list[str]
    __msgtype__: ClassVar[str]

@dataclass
class SceneEntity:
    """`simkit_msgs/msg/SceneEntity`"""
    entity: Entity
    parent: str
    pose: Pose
    is_static: bool
    __msgtype__: ClassVar[str]

@dataclass
class WheelMotion:
    """`simkit_msgs/msg/WheelMotion`"""
    header: Header
    name: list[str]
    load: NDArray[np.float64]
    rim_speed: NDArray[np.float64]
    axle_speed: NDArray[np.float64]
    slip: NDArray[np.float64]
    ratio: NDArray[np.float64]
    sideways: NDArray[np.float64]
    __msgtype__: ClassVar[str]

@dataclass
class Wind:
    """`simkit_msgs/msg/Wind`"""
    header: Header
    linear_velocity: Vector3
    enable_wind: bool
    __msgtype__: ClassVar[str]

@dataclass
class EntityRequest_Request(ServiceRequest[EntityRequest_Request, EntityRequest_Response]):
    """`simkit_msgs/srv/EntityRequest_Request`"""
    entity: Entity
    __msgtype__: ClassVar[str]

@dataclass
class EntityRequest_Response:
    """`simkit_msgs/srv/EntityRequest_Response`"""
    success: bool
    status_message: str
    __msgtype__: ClassVar[str]

@dataclass
class GenerateWorldSdf_Request(ServiceRequest[GenerateWorldSdf_Request, GenerateWorldSdf_Response]):
    """`simkit_msgs/srv/GenerateWorldSdf_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class GenerateWorldSdf_Response:
    """`simkit_msgs/srv/GenerateWorldSdf_Response`"""
    success: bool
    status_message: str
    sdf: str
    __msgtype__: ClassVar[str]

@dataclass
class GetScene_Request(ServiceRequest[GetScene_Request, GetScene_Response]):
    """`simkit_msgs/srv/GetScene_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class GetScene_Response:
    """`simkit_msgs/srv/GetScene_Response`"""
    name: str
    header: Header
    entities: list[SceneEntity]
    ambient: ColorRGBA
    background: ColorRGBA
    shadows: bool
    grid: bool
    sky: bool
    __msgtype__: ClassVar[str]

@dataclass
class SetEntityPoses_Request(ServiceRequest[SetEntityPoses_Request, SetEntityPoses_Response]):
    """`simkit_msgs/srv/SetEntityPoses_Request`"""
    entities: list[Entity]
    poses: list[Pose]
    __msgtype__: ClassVar[str]

@dataclass
class SetEntityPoses_Response:
    """`simkit_msgs/srv/SetEntityPoses_Response`"""
    success: bool
    status_message: str
    __msgtype__: ClassVar[str]

@dataclass
class SetLight_Request(ServiceRequest[SetLight_Request, SetLight_Response]):
    """`simkit_msgs/srv/SetLight_Request`"""
    light: Light
    __msgtype__: ClassVar[str]

@dataclass
class SetLight_Response:
    """`simkit_msgs/srv/SetLight_Response`"""
    success: bool
    status_message: str
    __msgtype__: ClassVar[str]

@dataclass
class SetMaterialColor_Request(ServiceRequest[SetMaterialColor_Request, SetMaterialColor_Response]):
    """`simkit_msgs/srv/SetMaterialColor_Request`"""
    material_color: MaterialColor
    __msgtype__: ClassVar[str]

@dataclass
class SetMaterialColor_Response:
    """`simkit_msgs/srv/SetMaterialColor_Response`"""
    success: bool
    status_message: str
    __msgtype__: ClassVar[str]

@dataclass
class SetSphericalCoordinates_Request(ServiceRequest[SetSphericalCoordinates_Request, SetSphericalCoordinates_Response]):
    """`simkit_msgs/srv/SetSphericalCoordinates_Request`"""
    surface_model: int
    latitude_deg: float
    longitude_deg: float
    elevation: float
    heading_deg: float
    entity: Entity
    EARTH_WGS84: ClassVar[int] = 0
    MOON_SCS: ClassVar[int] = 1
    __msgtype__: ClassVar[str]

@dataclass
class SetSphericalCoordinates_Response:
    """`simkit_msgs/srv/SetSphericalCoordinates_Response`"""
    success: bool
    status_message: str
    __msgtype__: ClassVar[str]

@dataclass
class SetWheelSlip_Request(ServiceRequest[SetWheelSlip_Request, SetWheelSlip_Response]):
    """`simkit_msgs/srv/SetWheelSlip_Request`"""
    entity: Entity
    slip_compliance_lateral: float
    slip_compliance_longitudinal: float
    __msgtype__: ClassVar[str]

@dataclass
class SetWheelSlip_Response:
    """`simkit_msgs/srv/SetWheelSlip_Response`"""
    success: bool
    status_message: str
    __msgtype__: ClassVar[str]

@dataclass
class SpawnEntities_Request(ServiceRequest[SpawnEntities_Request, SpawnEntities_Response]):
    """`simkit_msgs/srv/SpawnEntities_Request`"""
    entity_factories: list[EntityFactory]
    __msgtype__: ClassVar[str]

@dataclass
class SpawnEntities_Response:
    """`simkit_msgs/srv/SpawnEntities_Response`"""
    success: bool
    status_message: str
    __msgtype__: ClassVar[str]

@dataclass
class WindInfo_Request(ServiceRequest[WindInfo_Request, WindInfo_Response]):
    """`simkit_msgs/srv/WindInfo_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class WindInfo_Response:
    """`simkit_msgs/srv/WindInfo_Response`"""
    wind: Wind
    velocity: Vector3
    __msgtype__: ClassVar[str]

# simulation_interfaces

@dataclass
class SimulateSteps_Feedback:
    """`simulation_interfaces/action/SimulateSteps_Feedback`"""
    completed_steps: int
    remaining_steps: int
    __msgtype__: ClassVar[str]

@dataclass
class SimulateSteps_Goal(ActionGoal[SimulateSteps_Goal, SimulateSteps_Result, SimulateSteps_Feedback]):
    """`simulation_interfaces/action/SimulateSteps_Goal`"""
    steps: int
    __msgtype__: ClassVar[str]

@dataclass
class SimulateSteps_Result:
    """`simulation_interfaces/action/SimulateSteps_Result`"""
    result: Result
    __msgtype__: ClassVar[str]

@dataclass
class Bounds:
    """`simulation_interfaces/msg/Bounds`"""
    type: int
    points: list[Vector3]
    TYPE_EMPTY: ClassVar[int] = 0
    TYPE_BOX: ClassVar[int] = 1
    TYPE_CONVEX_HULL: ClassVar[int] = 2
    TYPE_SPHERE: ClassVar[int] = 3
    __msgtype__: ClassVar[str]

@dataclass
class EntityCategory:
    """`simulation_interfaces/msg/EntityCategory`"""
    category: int
    CATEGORY_OBJECT: ClassVar[int] = 0
    CATEGORY_ROBOT: ClassVar[int] = 1
    CATEGORY_HUMAN: ClassVar[int] = 2
    CATEGORY_DYNAMIC_OBJECT: ClassVar[int] = 4
    CATEGORY_STATIC_OBJECT: ClassVar[int] = 5
    __msgtype__: ClassVar[str]

@dataclass
class EntityFilters:
    """`simulation_interfaces/msg/EntityFilters`"""
    filter: str
    categories: list[EntityCategory]
    tags: TagsFilter
    bounds: Bounds
    __msgtype__: ClassVar[str]

@dataclass
class EntityInfo:
    """`simulation_interfaces/msg/EntityInfo`"""
    category: EntityCategory
    description: str
    tags: list[str]
    __msgtype__: ClassVar[str]

@dataclass
class simulation_interfaces__msg__EntityState:
    """`simulation_interfaces/msg/EntityState`"""
    header: Header
    pose: Pose
    twist: Twist
    acceleration: Accel
    __msgtype__: ClassVar[str]

@dataclass
class NamedPose:
    """`simulation_interfaces/msg/NamedPose`"""
    name: str
    description: str
    tags: list[str]
    pose: Pose
    __msgtype__: ClassVar[str]

@dataclass
class Resource:
    """`simulation_interfaces/msg/Resource`"""
    uri: str
    resource_string: str
    __msgtype__: ClassVar[str]

@dataclass
class Result:
    """`simulation_interfaces/msg/Result`"""
    result: int
    error_message: str
    RESULT_FEATURE_UNSUPPORTED: ClassVar[int] = 0
    RESULT_OK: ClassVar[int] = 1
    RESULT_NOT_FOUND: ClassVar[int] = 2
    RESULT_INCORRECT_STATE: ClassVar[int] = 3
    RESULT_OPERATION_FAILED: ClassVar[int] = 4
    __msgtype__: ClassVar[str]

@dataclass
class SimulationState:
    """`simulation_interfaces/msg/SimulationState`"""
    state: int
    STATE_STOPPED: ClassVar[int] = 0
    STATE_PLAYING: ClassVar[int] = 1
    STATE_PAUSED: ClassVar[int] = 2
    STATE_QUITTING: ClassVar[int] = 3
    STATE_NO_WORLD: ClassVar[int] = 4
    STATE_LOADING_WORLD: ClassVar[int] = 5
    __msgtype__: ClassVar[str]

@dataclass
class SimulatorFeatures:
    """`simulation_interfaces/msg/SimulatorFeatures`"""
    features: NDArray[np.uint16]
    spawn_formats: list[str]
    custom_info: str
    SPAWNING: ClassVar[int] = 0
    DELETING: ClassVar[int] = 1
    NAMED_POSES: ClassVar[int] = 2
    POSE_BOUNDS: ClassVar[int] = 3
    ENTITY_TAGS: ClassVar[int] = 4
    ENTITY_BOUNDS: ClassVar[int] = 5
    ENTITY_BOUNDS_BOX: ClassVar[int] = 6
    ENTITY_BOUNDS_CONVEX: ClassVar[int] = 7
    ENTITY_CATEGORIES: ClassVar[int] = 8
    SPAWNING_RESOURCE_STRING: ClassVar[int] = 9
    ENTITY_STATE_GETTING: ClassVar[int] = 10
    ENTITY_STATE_SETTING: ClassVar[int] = 11
    ENTITY_INFO_GETTING: ClassVar[int] = 12
    ENTITY_INFO_SETTING: ClassVar[int] = 13
    SPAWNABLES: ClassVar[int] = 14
    SIMULATION_RESET: ClassVar[int] = 20
    SIMULATION_RESET_TIME: ClassVar[int] = 21
    SIMULATION_RESET_STATE: ClassVar[int] = 22
    SIMULATION_RESET_SPAWNED: ClassVar[int] = 23
    SIMULATION_STATE_GETTING: ClassVar[int] = 24
    SIMULATION_STATE_SETTING: ClassVar[int] = 25
    SIMULATION_STATE_PAUSE: ClassVar[int] = 26
    STEP_SIMULATION_SINGLE: ClassVar[int] = 31
    STEP_SIMULATION_MULTIPLE: ClassVar[int] = 32
    STEP_SIMULATION_ACTION: ClassVar[int] = 33
    WORLD_LOADING: ClassVar[int] = 40
    WORLD_RESOURCE_STRING: ClassVar[int] = 41
    WORLD_TAGS: ClassVar[int] = 42
    WORLD_UNLOADING: ClassVar[int] = 43
    WORLD_INFO_GETTING: ClassVar[int] = 44
    AVAILABLE_WORLDS: ClassVar[int] = 45
    SPAWNING_ENTITIES: ClassVar[int] = 50
    __msgtype__: ClassVar[str]

@dataclass
class SpawnEntity:
    """`simulation_interfaces/msg/SpawnEntity`"""
    name: str
    allow_renaming: bool
    entity_resource: Resource
    entity_namespace: str
    initial_pose: PoseStamped
    __msgtype__: ClassVar[str]

@dataclass
class SpawnResult:
    """`simulation_interfaces/msg/SpawnResult`"""
    result: Result
    entity_name: str
    NAME_NOT_UNIQUE: ClassVar[int] = 101
    NAME_INVALID: ClassVar[int] = 102
    UNSUPPORTED_FORMAT: ClassVar[int] = 103
    NO_RESOURCE: ClassVar[int] = 104
    NAMESPACE_INVALID: ClassVar[int] = 105
    RESOURCE_PARSE_ERROR: ClassVar[int] = 106
    MISSING_ASSETS: ClassVar[int] = 107
    UNSUPPORTED_ASSETS: ClassVar[int] = 108
    INVALID_POSE: ClassVar[int] = 109
    __msgtype__: ClassVar[str]

@dataclass
class Spawnable:
    """`simulation_interfaces/msg/Spawnable`"""
    entity_resource: Resource
    description: str
    spawn_bounds: Bounds
    __msgtype__: ClassVar[str]

@dataclass
class TagsFilter:
    """`simulation_interfaces/msg/TagsFilter`"""
    tags: list[str]
    filter_mode: int
    FILTER_MODE_ANY: ClassVar[int] = 0
    FILTER_MODE_ALL: ClassVar[int] = 1
    __msgtype__: ClassVar[str]

@dataclass
class WorldResource:
    """`simulation_interfaces/msg/WorldResource`"""
    name: str
    world_resource: Resource
    description: str
    tags: list[str]
    __msgtype__: ClassVar[str]

@dataclass
class simulation_interfaces__srv__DeleteEntity_Request(ServiceRequest[simulation_interfaces__srv__DeleteEntity_Request, simulation_interfaces__srv__DeleteEntity_Response]):
    """`simulation_interfaces/srv/DeleteEntity_Request`"""
    entity: str
    __msgtype__: ClassVar[str]

@dataclass
class simulation_interfaces__srv__DeleteEntity_Response:
    """`simulation_interfaces/srv/DeleteEntity_Response`"""
    result: Result
    __msgtype__: ClassVar[str]

@dataclass
class GetAvailableWorlds_Request(ServiceRequest[GetAvailableWorlds_Request, GetAvailableWorlds_Response]):
    """`simulation_interfaces/srv/GetAvailableWorlds_Request`"""
    additional_sources: list[str]
    filter: TagsFilter
    offline_only: bool
    continue_on_error: bool
    __msgtype__: ClassVar[str]

@dataclass
class GetAvailableWorlds_Response:
    """`simulation_interfaces/srv/GetAvailableWorlds_Response`"""
    result: Result
    worlds: list[WorldResource]
    DEFAULT_SOURCES_FAILED: ClassVar[int] = 101
    __msgtype__: ClassVar[str]

@dataclass
class GetCurrentWorld_Request(ServiceRequest[GetCurrentWorld_Request, GetCurrentWorld_Response]):
    """`simulation_interfaces/srv/GetCurrentWorld_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class GetCurrentWorld_Response:
    """`simulation_interfaces/srv/GetCurrentWorld_Response`"""
    result: Result
    world: WorldResource
    NO_WORLD_LOADED: ClassVar[int] = 101
    __msgtype__: ClassVar[str]

@dataclass
class GetEntitiesStates_Request(ServiceRequest[GetEntitiesStates_Request, GetEntitiesStates_Response]):
    """`simulation_interfaces/srv/GetEntitiesStates_Request`"""
    filters: EntityFilters
    __msgtype__: ClassVar[str]

@dataclass
class GetEntitiesStates_Response:
    """`simulation_interfaces/srv/GetEntitiesStates_Response`"""
    result: Result
    entities: list[str]
    states: list[simulation_interfaces__msg__EntityState]
    __msgtype__: ClassVar[str]

@dataclass
class GetEntities_Request(ServiceRequest[GetEntities_Request, GetEntities_Response]):
    """`simulation_interfaces/srv/GetEntities_Request`"""
    filters: EntityFilters
    __msgtype__: ClassVar[str]

@dataclass
class GetEntities_Response:
    """`simulation_interfaces/srv/GetEntities_Response`"""
    result: Result
    entities: list[str]
    __msgtype__: ClassVar[str]

@dataclass
class GetEntityBounds_Request(ServiceRequest[GetEntityBounds_Request, GetEntityBounds_Response]):
    """`simulation_interfaces/srv/GetEntityBounds_Request`"""
    entity: str
    __msgtype__: ClassVar[str]

@dataclass
class GetEntityBounds_Response:
    """`simulation_interfaces/srv/GetEntityBounds_Response`"""
    result: Result
    bounds: Bounds
    __msgtype__: ClassVar[str]

@dataclass
class GetEntityInfo_Request(ServiceRequest[GetEntityInfo_Request, GetEntityInfo_Response]):
    """`simulation_interfaces/srv/GetEntityInfo_Request`"""
    entity: str
    __msgtype__: ClassVar[str]

@dataclass
class GetEntityInfo_Response:
    """`simulation_interfaces/srv/GetEntityInfo_Response`"""
    result: Result
    info: EntityInfo
    __msgtype__: ClassVar[str]

@dataclass
class simulation_interfaces__srv__GetEntityState_Request(ServiceRequest[simulation_interfaces__srv__GetEntityState_Request, simulation_interfaces__srv__GetEntityState_Response]):
    """`simulation_interfaces/srv/GetEntityState_Request`"""
    entity: str
    __msgtype__: ClassVar[str]

@dataclass
class simulation_interfaces__srv__GetEntityState_Response:
    """`simulation_interfaces/srv/GetEntityState_Response`"""
    result: Result
    state: simulation_interfaces__msg__EntityState
    __msgtype__: ClassVar[str]

@dataclass
class GetNamedPoseBounds_Request(ServiceRequest[GetNamedPoseBounds_Request, GetNamedPoseBounds_Response]):
    """`simulation_interfaces/srv/GetNamedPoseBounds_Request`"""
    name: str
    __msgtype__: ClassVar[str]

@dataclass
class GetNamedPoseBounds_Response:
    """`simulation_interfaces/srv/GetNamedPoseBounds_Response`"""
    result: Result
    bounds: Bounds
    __msgtype__: ClassVar[str]

@dataclass
class GetNamedPoses_Request(ServiceRequest[GetNamedPoses_Request, GetNamedPoses_Response]):
    """`simulation_interfaces/srv/GetNamedPoses_Request`"""
    tags: TagsFilter
    __msgtype__: ClassVar[str]

@dataclass
class GetNamedPoses_Response:
    """`simulation_interfaces/srv/GetNamedPoses_Response`"""
    result: Result
    poses: list[NamedPose]
    __msgtype__: ClassVar[str]

@dataclass
class GetSimulationState_Request(ServiceRequest[GetSimulationState_Request, GetSimulationState_Response]):
    """`simulation_interfaces/srv/GetSimulationState_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class GetSimulationState_Response:
    """`simulation_interfaces/srv/GetSimulationState_Response`"""
    state: SimulationState
    result: Result
    __msgtype__: ClassVar[str]

@dataclass
class GetSimulatorFeatures_Request(ServiceRequest[GetSimulatorFeatures_Request, GetSimulatorFeatures_Response]):
    """`simulation_interfaces/srv/GetSimulatorFeatures_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class GetSimulatorFeatures_Response:
    """`simulation_interfaces/srv/GetSimulatorFeatures_Response`"""
    features: SimulatorFeatures
    __msgtype__: ClassVar[str]

@dataclass
class GetSpawnables_Request(ServiceRequest[GetSpawnables_Request, GetSpawnables_Response]):
    """`simulation_interfaces/srv/GetSpawnables_Request`"""
    sources: list[str]
    __msgtype__: ClassVar[str]

@dataclass
class GetSpawnables_Response:
    """`simulation_interfaces/srv/GetSpawnables_Response`"""
    result: Result
    spawnables: list[Spawnable]
    __msgtype__: ClassVar[str]

@dataclass
class LoadWorld_Request(ServiceRequest[LoadWorld_Request, LoadWorld_Response]):
    """`simulation_interfaces/srv/LoadWorld_Request`"""
    world_resource: Resource
    fail_on_unsupported_element: bool
    ignore_missing_or_unsupported_assets: bool
    __msgtype__: ClassVar[str]

@dataclass
class LoadWorld_Response:
    """`simulation_interfaces/srv/LoadWorld_Response`"""
    result: Result
    world: WorldResource
    UNSUPPORTED_FORMAT: ClassVar[int] = 101
    NO_RESOURCE: ClassVar[int] = 102
    RESOURCE_PARSE_ERROR: ClassVar[int] = 103
    MISSING_ASSETS: ClassVar[int] = 104
    UNSUPPORTED_ASSETS: ClassVar[int] = 105
    UNSUPPORTED_ELEMENTS: ClassVar[int] = 106
    __msgtype__: ClassVar[str]

@dataclass
class ResetSimulation_Request(ServiceRequest[ResetSimulation_Request, ResetSimulation_Response]):
    """`simulation_interfaces/srv/ResetSimulation_Request`"""
    scope: int
    SCOPE_DEFAULT: ClassVar[int] = 0
    SCOPE_TIME: ClassVar[int] = 1
    SCOPE_STATE: ClassVar[int] = 2
    SCOPE_SPAWNED: ClassVar[int] = 4
    SCOPE_ALL: ClassVar[int] = 255
    __msgtype__: ClassVar[str]

@dataclass
class ResetSimulation_Response:
    """`simulation_interfaces/srv/ResetSimulation_Response`"""
    result: Result
    __msgtype__: ClassVar[str]

@dataclass
class SetEntityInfo_Request(ServiceRequest[SetEntityInfo_Request, SetEntityInfo_Response]):
    """`simulation_interfaces/srv/SetEntityInfo_Request`"""
    entity: str
    info: EntityInfo
    __msgtype__: ClassVar[str]

@dataclass
class SetEntityInfo_Response:
    """`simulation_interfaces/srv/SetEntityInfo_Response`"""
    result: Result
    __msgtype__: ClassVar[str]

@dataclass
class simulation_interfaces__srv__SetEntityState_Request(ServiceRequest[simulation_interfaces__srv__SetEntityState_Request, simulation_interfaces__srv__SetEntityState_Response]):
    """`simulation_interfaces/srv/SetEntityState_Request`"""
    entity: str
    state: simulation_interfaces__msg__EntityState
    set_pose: bool
    set_twist: bool
    set_acceleration: bool
    __msgtype__: ClassVar[str]

@dataclass
class simulation_interfaces__srv__SetEntityState_Response:
    """`simulation_interfaces/srv/SetEntityState_Response`"""
    result: Result
    INVALID_POSE: ClassVar[int] = 101
    __msgtype__: ClassVar[str]

@dataclass
class SetSimulationState_Request(ServiceRequest[SetSimulationState_Request, SetSimulationState_Response]):
    """`simulation_interfaces/srv/SetSimulationState_Request`"""
    state: SimulationState
    __msgtype__: ClassVar[str]

@dataclass
class SetSimulationState_Response:
    """`simulation_interfaces/srv/SetSimulationState_Response`"""
    result: Result
    ALREADY_IN_TARGET_STATE: ClassVar[int] = 101
    STATE_TRANSITION_ERROR: ClassVar[int] = 102
    INCORRECT_TRANSITION: ClassVar[int] = 103
    __msgtype__: ClassVar[str]

@dataclass
class simulation_interfaces__srv__SpawnEntities_Request(ServiceRequest[simulation_interfaces__srv__SpawnEntities_Request, simulation_interfaces__srv__SpawnEntities_Response]):
    """`simulation_interfaces/srv/SpawnEntities_Request`"""
    spawn_requests: list[SpawnEntity]
    __msgtype__: ClassVar[str]

@dataclass
class simulation_interfaces__srv__SpawnEntities_Response:
    """`simulation_interfaces/srv/SpawnEntities_Response`"""
    result: Result
    results: list[SpawnResult]
    ENTITIES_SPAWN_FAILED: ClassVar[int] = 150
    __msgtype__: ClassVar[str]

@dataclass
class simulation_interfaces__srv__SpawnEntity_Request(ServiceRequest[simulation_interfaces__srv__SpawnEntity_Request, simulation_interfaces__srv__SpawnEntity_Response]):
    """`simulation_interfaces/srv/SpawnEntity_Request`"""
    name: str
    allow_renaming: bool
    entity_resource: Resource
    entity_namespace: str
    initial_pose: PoseStamped
    __msgtype__: ClassVar[str]

@dataclass
class simulation_interfaces__srv__SpawnEntity_Response:
    """`simulation_interfaces/srv/SpawnEntity_Response`"""
    result: Result
    entity_name: str
    NAME_NOT_UNIQUE: ClassVar[int] = 101
    NAME_INVALID: ClassVar[int] = 102
    UNSUPPORTED_FORMAT: ClassVar[int] = 103
    NO_RESOURCE: ClassVar[int] = 104
    NAMESPACE_INVALID: ClassVar[int] = 105
    RESOURCE_PARSE_ERROR: ClassVar[int] = 106
    MISSING_ASSETS: ClassVar[int] = 107
    UNSUPPORTED_ASSETS: ClassVar[int] = 108
    INVALID_POSE: ClassVar[int] = 109
    __msgtype__: ClassVar[str]

@dataclass
class StepSimulation_Request(ServiceRequest[StepSimulation_Request, StepSimulation_Response]):
    """`simulation_interfaces/srv/StepSimulation_Request`"""
    steps: int
    __msgtype__: ClassVar[str]

@dataclass
class StepSimulation_Response:
    """`simulation_interfaces/srv/StepSimulation_Response`"""
    result: Result
    __msgtype__: ClassVar[str]

@dataclass
class UnloadWorld_Request(ServiceRequest[UnloadWorld_Request, UnloadWorld_Response]):
    """`simulation_interfaces/srv/UnloadWorld_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class UnloadWorld_Response:
    """`simulation_interfaces/srv/UnloadWorld_Response`"""
    result: Result
    NO_WORLD_LOADED: ClassVar[int] = 101
    __msgtype__: ClassVar[str]

# slam_toolbox

@dataclass
class AddSubmap_Request(ServiceRequest[AddSubmap_Request, AddSubmap_Response]):
    """`slam_toolbox/srv/AddSubmap_Request`"""
    filename: str
    __msgtype__: ClassVar[str]

@dataclass
class AddSubmap_Response:
    """`slam_toolbox/srv/AddSubmap_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class ClearQueue_Request(ServiceRequest[ClearQueue_Request, ClearQueue_Response]):
    """`slam_toolbox/srv/ClearQueue_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class ClearQueue_Response:
    """`slam_toolbox/srv/ClearQueue_Response`"""
    status: bool
    __msgtype__: ClassVar[str]

@dataclass
class Clear_Request(ServiceRequest[Clear_Request, Clear_Response]):
    """`slam_toolbox/srv/Clear_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class Clear_Response:
    """`slam_toolbox/srv/Clear_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class DeserializePoseGraph_Request(ServiceRequest[DeserializePoseGraph_Request, DeserializePoseGraph_Response]):
    """`slam_toolbox/srv/DeserializePoseGraph_Request`"""
    filename: str
    match_type: int
    initial_pose: Pose2D
    UNSET: ClassVar[int] = 0
    START_AT_FIRST_NODE: ClassVar[int] = 1
    START_AT_GIVEN_POSE: ClassVar[int] = 2
    LOCALIZE_AT_POSE: ClassVar[int] = 3
    __msgtype__: ClassVar[str]

@dataclass
class DeserializePoseGraph_Response:
    """`slam_toolbox/srv/DeserializePoseGraph_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class LoopClosure_Request(ServiceRequest[LoopClosure_Request, LoopClosure_Response]):
    """`slam_toolbox/srv/LoopClosure_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class LoopClosure_Response:
    """`slam_toolbox/srv/LoopClosure_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class MergeMaps_Request(ServiceRequest[MergeMaps_Request, MergeMaps_Response]):
    """`slam_toolbox/srv/MergeMaps_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class MergeMaps_Response:
    """`slam_toolbox/srv/MergeMaps_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class Pause_Request(ServiceRequest[Pause_Request, Pause_Response]):
    """`slam_toolbox/srv/Pause_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class Pause_Response:
    """`slam_toolbox/srv/Pause_Response`"""
    status: bool
    __msgtype__: ClassVar[str]

@dataclass
class Reset_Request(ServiceRequest[Reset_Request, Reset_Response]):
    """`slam_toolbox/srv/Reset_Request`"""
    pause_new_measurements: bool
    __msgtype__: ClassVar[str]

@dataclass
class Reset_Response:
    """`slam_toolbox/srv/Reset_Response`"""
    result: int
    RESULT_SUCCESS: ClassVar[int] = 0
    __msgtype__: ClassVar[str]

@dataclass
class slam_toolbox__srv__SaveMap_Request(ServiceRequest[slam_toolbox__srv__SaveMap_Request, slam_toolbox__srv__SaveMap_Response]):
    """`slam_toolbox/srv/SaveMap_Request`"""
    name: String
    __msgtype__: ClassVar[str]

@dataclass
class slam_toolbox__srv__SaveMap_Response:
    """`slam_toolbox/srv/SaveMap_Response`"""
    result: int
    RESULT_SUCCESS: ClassVar[int] = 0
    RESULT_NO_MAP_RECEIEVD: ClassVar[int] = 1
    RESULT_UNDEFINED_FAILURE: ClassVar[int] = 255
    __msgtype__: ClassVar[str]

@dataclass
class SerializePoseGraph_Request(ServiceRequest[SerializePoseGraph_Request, SerializePoseGraph_Response]):
    """`slam_toolbox/srv/SerializePoseGraph_Request`"""
    filename: str
    __msgtype__: ClassVar[str]

@dataclass
class SerializePoseGraph_Response:
    """`slam_toolbox/srv/SerializePoseGraph_Response`"""
    result: int
    RESULT_SUCCESS: ClassVar[int] = 0
    RESULT_FAILED_TO_WRITE_FILE: ClassVar[int] = 255
    __msgtype__: ClassVar[str]

@dataclass
class ToggleInteractive_Request(ServiceRequest[ToggleInteractive_Request, ToggleInteractive_Response]):
    """`slam_toolbox/srv/ToggleInteractive_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class ToggleInteractive_Response:
    """`slam_toolbox/srv/ToggleInteractive_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

# statistics_msgs

@dataclass
class MetricsMessage:
    """`statistics_msgs/msg/MetricsMessage`"""
    measurement_source_name: str
    metrics_source: str
    unit: str
    window_start: Time
    window_stop: Time
    statistics: list[StatisticDataPoint]
    __msgtype__: ClassVar[str]

@dataclass
class StatisticDataPoint:
    """`statistics_msgs/msg/StatisticDataPoint`"""
    data_type: int
    data: float
    __msgtype__: ClassVar[str]

@dataclass
class StatisticDataType:
    """`statistics_msgs/msg/StatisticDataType`"""
    structure_needs_at_least_one_member: int = 0
    STATISTICS_DATA_TYPE_UNINITIALIZED: ClassVar[int] = 0
    STATISTICS_DATA_TYPE_AVERAGE: ClassVar[int] = 1
    STATISTICS_DATA_TYPE_MINIMUM: ClassVar[int] = 2
    STATISTICS_DATA_TYPE_MAXIMUM: ClassVar[int] = 3
    STATISTICS_DATA_TYPE_STDDEV: ClassVar[int] = 4
    STATISTICS_DATA_TYPE_SAMPLE_COUNT: ClassVar[int] = 5
    __msgtype__: ClassVar[str]

# std_msgs

@dataclass
class Bool:
    """`std_msgs/msg/Bool`"""
    data: bool
    __msgtype__: ClassVar[str]

@dataclass
class Byte:
    """`std_msgs/msg/Byte`"""
    data: int
    __msgtype__: ClassVar[str]

@dataclass
class ByteMultiArray:
    """`std_msgs/msg/ByteMultiArray`"""
    layout: MultiArrayLayout
    data: NDArray[np.uint8]
    __msgtype__: ClassVar[str]

@dataclass
class Char:
    """`std_msgs/msg/Char`"""
    data: int
    __msgtype__: ClassVar[str]

@dataclass
class ColorRGBA:
    """`std_msgs/msg/ColorRGBA`"""
    r: float
    g: float
    b: float
    a: float
    __msgtype__: ClassVar[str]

@dataclass
class Empty:
    """`std_msgs/msg/Empty`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class Float32:
    """`std_msgs/msg/Float32`"""
    data: float
    __msgtype__: ClassVar[str]

@dataclass
class Float32MultiArray:
    """`std_msgs/msg/Float32MultiArray`"""
    layout: MultiArrayLayout
    data: NDArray[np.float32]
    __msgtype__: ClassVar[str]

@dataclass
class Float64:
    """`std_msgs/msg/Float64`"""
    data: float
    __msgtype__: ClassVar[str]

@dataclass
class Float64MultiArray:
    """`std_msgs/msg/Float64MultiArray`"""
    layout: MultiArrayLayout
    data: NDArray[np.float64]
    __msgtype__: ClassVar[str]

@dataclass
class Header:
    """`std_msgs/msg/Header`"""
    stamp: Time
    frame_id: str
    __msgtype__: ClassVar[str]

@dataclass
class Int16:
    """`std_msgs/msg/Int16`"""
    data: int
    __msgtype__: ClassVar[str]

@dataclass
class Int16MultiArray:
    """`std_msgs/msg/Int16MultiArray`"""
    layout: MultiArrayLayout
    data: NDArray[np.int16]
    __msgtype__: ClassVar[str]

@dataclass
class Int32:
    """`std_msgs/msg/Int32`"""
    data: int
    __msgtype__: ClassVar[str]

@dataclass
class Int32MultiArray:
    """`std_msgs/msg/Int32MultiArray`"""
    layout: MultiArrayLayout
    data: NDArray[np.int32]
    __msgtype__: ClassVar[str]

@dataclass
class Int64:
    """`std_msgs/msg/Int64`"""
    data: int
    __msgtype__: ClassVar[str]

@dataclass
class Int64MultiArray:
    """`std_msgs/msg/Int64MultiArray`"""
    layout: MultiArrayLayout
    data: NDArray[np.int64]
    __msgtype__: ClassVar[str]

@dataclass
class Int8:
    """`std_msgs/msg/Int8`"""
    data: int
    __msgtype__: ClassVar[str]

@dataclass
class Int8MultiArray:
    """`std_msgs/msg/Int8MultiArray`"""
    layout: MultiArrayLayout
    data: NDArray[np.int8]
    __msgtype__: ClassVar[str]

@dataclass
class MultiArrayDimension:
    """`std_msgs/msg/MultiArrayDimension`"""
    label: str
    size: int
    stride: int
    __msgtype__: ClassVar[str]

@dataclass
class MultiArrayLayout:
    """`std_msgs/msg/MultiArrayLayout`"""
    dim: list[MultiArrayDimension]
    data_offset: int
    __msgtype__: ClassVar[str]

@dataclass
class String:
    """`std_msgs/msg/String`"""
    data: str
    __msgtype__: ClassVar[str]

@dataclass
class UInt16:
    """`std_msgs/msg/UInt16`"""
    data: int
    __msgtype__: ClassVar[str]

@dataclass
class UInt16MultiArray:
    """`std_msgs/msg/UInt16MultiArray`"""
    layout: MultiArrayLayout
    data: NDArray[np.uint16]
    __msgtype__: ClassVar[str]

@dataclass
class UInt32:
    """`std_msgs/msg/UInt32`"""
    data: int
    __msgtype__: ClassVar[str]

@dataclass
class UInt32MultiArray:
    """`std_msgs/msg/UInt32MultiArray`"""
    layout: MultiArrayLayout
    data: NDArray[np.uint32]
    __msgtype__: ClassVar[str]

@dataclass
class UInt64:
    """`std_msgs/msg/UInt64`"""
    data: int
    __msgtype__: ClassVar[str]

@dataclass
class UInt64MultiArray:
    """`std_msgs/msg/UInt64MultiArray`"""
    layout: MultiArrayLayout
    data: NDArray[np.uint64]
    __msgtype__: ClassVar[str]

@dataclass
class UInt8:
    """`std_msgs/msg/UInt8`"""
    data: int
    __msgtype__: ClassVar[str]

@dataclass
class UInt8MultiArray:
    """`std_msgs/msg/UInt8MultiArray`"""
    layout: MultiArrayLayout
    data: NDArray[np.uint8]
    __msgtype__: ClassVar[str]

# std_srvs

@dataclass
class Empty_Request(ServiceRequest[Empty_Request, Empty_Response]):
    """`std_srvs/srv/Empty_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class Empty_Response:
    """`std_srvs/srv/Empty_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class SetBool_Request(ServiceRequest[SetBool_Request, SetBool_Response]):
    """`std_srvs/srv/SetBool_Request`"""
    data: bool
    __msgtype__: ClassVar[str]

@dataclass
class SetBool_Response:
    """`std_srvs/srv/SetBool_Response`"""
    success: bool
    message: str
    __msgtype__: ClassVar[str]

@dataclass
class Trigger_Request(ServiceRequest[Trigger_Request, Trigger_Response]):
    """`std_srvs/srv/Trigger_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class Trigger_Response:
    """`std_srvs/srv/Trigger_Response`"""
    success: bool
    message: str
    __msgtype__: ClassVar[str]

# stereo_msgs

@dataclass
class DisparityImage:
    """`stereo_msgs/msg/DisparityImage`"""
    header: Header
    image: Image
    f: float
    t: float
    valid_window: RegionOfInterest
    min_disparity: float
    max_disparity: float
    delta_d: float
    __msgtype__: ClassVar[str]

# tf

@dataclass
class tf__srv__FrameGraph_Request(ServiceRequest[tf__srv__FrameGraph_Request, tf__srv__FrameGraph_Response]):
    """`tf/srv/FrameGraph_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class tf__srv__FrameGraph_Response:
    """`tf/srv/FrameGraph_Response`"""
    dot_graph: str
    __msgtype__: ClassVar[str]

# tf2_msgs

@dataclass
class LookupTransform_Feedback:
    """`tf2_msgs/action/LookupTransform_Feedback`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class LookupTransform_Goal(ActionGoal[LookupTransform_Goal, LookupTransform_Result, LookupTransform_Feedback]):
    """`tf2_msgs/action/LookupTransform_Goal`"""
    target_frame: str
    source_frame: str
    source_time: Time
    timeout: Duration
    target_time: Time
    fixed_frame: str
    advanced: bool
    __msgtype__: ClassVar[str]

@dataclass
class LookupTransform_Result:
    """`tf2_msgs/action/LookupTransform_Result`"""
    transform: TransformStamped
    error: TF2Error
    __msgtype__: ClassVar[str]

@dataclass
class TF2Error:
    """`tf2_msgs/msg/TF2Error`"""
    error: int
    error_string: str
    NO_ERROR: ClassVar[int] = 0
    LOOKUP_ERROR: ClassVar[int] = 1
    CONNECTIVITY_ERROR: ClassVar[int] = 2
    EXTRAPOLATION_ERROR: ClassVar[int] = 3
    INVALID_ARGUMENT_ERROR: ClassVar[int] = 4
    TIMEOUT_ERROR: ClassVar[int] = 5
    TRANSFORM_ERROR: ClassVar[int] = 6
    __msgtype__: ClassVar[str]

@dataclass
class TFMessage:
    """`tf2_msgs/msg/TFMessage`"""
    transforms: list[TransformStamped]
    __msgtype__: ClassVar[str]

@dataclass
class tf2_msgs__srv__FrameGraph_Request(ServiceRequest[tf2_msgs__srv__FrameGraph_Request, tf2_msgs__srv__FrameGraph_Response]):
    """`tf2_msgs/srv/FrameGraph_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class tf2_msgs__srv__FrameGraph_Response:
    """`tf2_msgs/srv/FrameGraph_Response`"""
    frame_yaml: str
    __msgtype__: ClassVar[str]

# theora_image_transport

@dataclass
class Packet:
    """`theora_image_transport/msg/Packet`"""
    header: Header
    data: NDArray[np.uint8]
    b_o_s: int
    e_o_s: int
    granulepos: int
    packetno: int
    __msgtype__: ClassVar[str]

# topic_tools

@dataclass
class topic_tools__srv__DemuxAdd_Request(ServiceRequest[topic_tools__srv__DemuxAdd_Request, topic_tools__srv__DemuxAdd_Response]):
    """`topic_tools/srv/DemuxAdd_Request`"""
    topic: str
    __msgtype__: ClassVar[str]

@dataclass
class topic_tools__srv__DemuxAdd_Response:
    """`topic_tools/srv/DemuxAdd_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class topic_tools__srv__DemuxDelete_Request(ServiceRequest[topic_tools__srv__DemuxDelete_Request, topic_tools__srv__DemuxDelete_Response]):
    """`topic_tools/srv/DemuxDelete_Request`"""
    topic: str
    __msgtype__: ClassVar[str]

@dataclass
class topic_tools__srv__DemuxDelete_Response:
    """`topic_tools/srv/DemuxDelete_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class topic_tools__srv__DemuxList_Request(ServiceRequest[topic_tools__srv__DemuxList_Request, topic_tools__srv__DemuxList_Response]):
    """`topic_tools/srv/DemuxList_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class topic_tools__srv__DemuxList_Response:
    """`topic_tools/srv/DemuxList_Response`"""
    topics: list[str]
    __msgtype__: ClassVar[str]

@dataclass
class topic_tools__srv__DemuxSelect_Request(ServiceRequest[topic_tools__srv__DemuxSelect_Request, topic_tools__srv__DemuxSelect_Response]):
    """`topic_tools/srv/DemuxSelect_Request`"""
    topic: str
    __msgtype__: ClassVar[str]

@dataclass
class topic_tools__srv__DemuxSelect_Response:
    """`topic_tools/srv/DemuxSelect_Response`"""
    prev_topic: str
    __msgtype__: ClassVar[str]

@dataclass
class topic_tools__srv__MuxAdd_Request(ServiceRequest[topic_tools__srv__MuxAdd_Request, topic_tools__srv__MuxAdd_Response]):
    """`topic_tools/srv/MuxAdd_Request`"""
    topic: str
    __msgtype__: ClassVar[str]

@dataclass
class topic_tools__srv__MuxAdd_Response:
    """`topic_tools/srv/MuxAdd_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class topic_tools__srv__MuxDelete_Request(ServiceRequest[topic_tools__srv__MuxDelete_Request, topic_tools__srv__MuxDelete_Response]):
    """`topic_tools/srv/MuxDelete_Request`"""
    topic: str
    __msgtype__: ClassVar[str]

@dataclass
class topic_tools__srv__MuxDelete_Response:
    """`topic_tools/srv/MuxDelete_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class topic_tools__srv__MuxList_Request(ServiceRequest[topic_tools__srv__MuxList_Request, topic_tools__srv__MuxList_Response]):
    """`topic_tools/srv/MuxList_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class topic_tools__srv__MuxList_Response:
    """`topic_tools/srv/MuxList_Response`"""
    topics: list[str]
    __msgtype__: ClassVar[str]

@dataclass
class topic_tools__srv__MuxSelect_Request(ServiceRequest[topic_tools__srv__MuxSelect_Request, topic_tools__srv__MuxSelect_Response]):
    """`topic_tools/srv/MuxSelect_Request`"""
    topic: str
    __msgtype__: ClassVar[str]

@dataclass
class topic_tools__srv__MuxSelect_Response:
    """`topic_tools/srv/MuxSelect_Response`"""
    prev_topic: str
    __msgtype__: ClassVar[str]

# topic_tools_interfaces

@dataclass
class topic_tools_interfaces__srv__DemuxAdd_Request(ServiceRequest[topic_tools_interfaces__srv__DemuxAdd_Request, topic_tools_interfaces__srv__DemuxAdd_Response]):
    """`topic_tools_interfaces/srv/DemuxAdd_Request`"""
    topic: str
    __msgtype__: ClassVar[str]

@dataclass
class topic_tools_interfaces__srv__DemuxAdd_Response:
    """`topic_tools_interfaces/srv/DemuxAdd_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class topic_tools_interfaces__srv__DemuxDelete_Request(ServiceRequest[topic_tools_interfaces__srv__DemuxDelete_Request, topic_tools_interfaces__srv__DemuxDelete_Response]):
    """`topic_tools_interfaces/srv/DemuxDelete_Request`"""
    topic: str
    __msgtype__: ClassVar[str]

@dataclass
class topic_tools_interfaces__srv__DemuxDelete_Response:
    """`topic_tools_interfaces/srv/DemuxDelete_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class topic_tools_interfaces__srv__DemuxList_Request(ServiceRequest[topic_tools_interfaces__srv__DemuxList_Request, topic_tools_interfaces__srv__DemuxList_Response]):
    """`topic_tools_interfaces/srv/DemuxList_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class topic_tools_interfaces__srv__DemuxList_Response:
    """`topic_tools_interfaces/srv/DemuxList_Response`"""
    topics: list[str]
    __msgtype__: ClassVar[str]

@dataclass
class topic_tools_interfaces__srv__DemuxSelect_Request(ServiceRequest[topic_tools_interfaces__srv__DemuxSelect_Request, topic_tools_interfaces__srv__DemuxSelect_Response]):
    """`topic_tools_interfaces/srv/DemuxSelect_Request`"""
    topic: str
    __msgtype__: ClassVar[str]

@dataclass
class topic_tools_interfaces__srv__DemuxSelect_Response:
    """`topic_tools_interfaces/srv/DemuxSelect_Response`"""
    prev_topic: str
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class topic_tools_interfaces__srv__MuxAdd_Request(ServiceRequest[topic_tools_interfaces__srv__MuxAdd_Request, topic_tools_interfaces__srv__MuxAdd_Response]):
    """`topic_tools_interfaces/srv/MuxAdd_Request`"""
    topic: str
    __msgtype__: ClassVar[str]

@dataclass
class topic_tools_interfaces__srv__MuxAdd_Response:
    """`topic_tools_interfaces/srv/MuxAdd_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class topic_tools_interfaces__srv__MuxDelete_Request(ServiceRequest[topic_tools_interfaces__srv__MuxDelete_Request, topic_tools_interfaces__srv__MuxDelete_Response]):
    """`topic_tools_interfaces/srv/MuxDelete_Request`"""
    topic: str
    __msgtype__: ClassVar[str]

@dataclass
class topic_tools_interfaces__srv__MuxDelete_Response:
    """`topic_tools_interfaces/srv/MuxDelete_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class topic_tools_interfaces__srv__MuxList_Request(ServiceRequest[topic_tools_interfaces__srv__MuxList_Request, topic_tools_interfaces__srv__MuxList_Response]):
    """`topic_tools_interfaces/srv/MuxList_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class topic_tools_interfaces__srv__MuxList_Response:
    """`topic_tools_interfaces/srv/MuxList_Response`"""
    topics: list[str]
    __msgtype__: ClassVar[str]

@dataclass
class topic_tools_interfaces__srv__MuxSelect_Request(ServiceRequest[topic_tools_interfaces__srv__MuxSelect_Request, topic_tools_interfaces__srv__MuxSelect_Response]):
    """`topic_tools_interfaces/srv/MuxSelect_Request`"""
    topic: str
    __msgtype__: ClassVar[str]

@dataclass
class topic_tools_interfaces__srv__MuxSelect_Response:
    """`topic_tools_interfaces/srv/MuxSelect_Response`"""
    prev_topic: str
    success: bool
    __msgtype__: ClassVar[str]

# trajectory_msgs

@dataclass
class JointTrajectory:
    """`trajectory_msgs/msg/JointTrajectory`"""
    header: Header
    joint_names: list[str]
    points: list[JointTrajectoryPoint]
    __msgtype__: ClassVar[str]

@dataclass
class JointTrajectoryPoint:
    """`trajectory_msgs/msg/JointTrajectoryPoint`"""
    positions: NDArray[np.float64]
    velocities: NDArray[np.float64]
    accelerations: NDArray[np.float64]
    effort: NDArray[np.float64]
    time_from_start: Duration
    __msgtype__: ClassVar[str]

@dataclass
class MultiDOFJointTrajectory:
    """`trajectory_msgs/msg/MultiDOFJointTrajectory`"""
    header: Header
    joint_names: list[str]
    points: list[MultiDOFJointTrajectoryPoint]
    __msgtype__: ClassVar[str]

@dataclass
class MultiDOFJointTrajectoryPoint:
    """`trajectory_msgs/msg/MultiDOFJointTrajectoryPoint`"""
    transforms: list[Transform]
    velocities: list[Twist]
    accelerations: list[Twist]
    time_from_start: Duration
    __msgtype__: ClassVar[str]

# turtlebot3_msgs

@dataclass
class Patrol_Feedback:
    """`turtlebot3_msgs/action/Patrol_Feedback`"""
    state: str
    __msgtype__: ClassVar[str]

@dataclass
class Patrol_Goal(ActionGoal[Patrol_Goal, Patrol_Result, Patrol_Feedback]):
    """`turtlebot3_msgs/action/Patrol_Goal`"""
    goal: Vector3
    __msgtype__: ClassVar[str]

@dataclass
class Patrol_Result:
    """`turtlebot3_msgs/action/Patrol_Result`"""
    result: str
    __msgtype__: ClassVar[str]

@dataclass
class turtlebot3_msgs__msg__SensorState:
    """`turtlebot3_msgs/msg/SensorState`"""
    header: Header
    bumper: int
    cliff: float
    sonar: float
    illumination: float
    led: int
    button: int
    torque: bool
    left_encoder: int
    right_encoder: int
    battery: float
    BUMPER_FORWARD: ClassVar[int] = 1
    BUMPER_BACKWARD: ClassVar[int] = 2
    CLIFF: ClassVar[int] = 1
    SONAR: ClassVar[int] = 1
    ILLUMINATION: ClassVar[int] = 1
    BUTTON0: ClassVar[int] = 1
    BUTTON1: ClassVar[int] = 2
    ERROR_LEFT_MOTOR: ClassVar[int] = 1
    ERROR_RIGHT_MOTOR: ClassVar[int] = 2
    TORQUE_ON: ClassVar[int] = 1
    TORQUE_OFF: ClassVar[int] = 2
    __msgtype__: ClassVar[str]

@dataclass
class turtlebot3_msgs__msg__Sound:
    """`turtlebot3_msgs/msg/Sound`"""
    value: int
    OFF: ClassVar[int] = 0
    ON: ClassVar[int] = 1
    LOW_BATTERY: ClassVar[int] = 2
    ERROR: ClassVar[int] = 3
    BUTTON1: ClassVar[int] = 4
    BUTTON2: ClassVar[int] = 5
    __msgtype__: ClassVar[str]

@dataclass
class turtlebot3_msgs__msg__VersionInfo:
    """`turtlebot3_msgs/msg/VersionInfo`"""
    hardware: str
    firmware: str
    software: str
    __msgtype__: ClassVar[str]

@dataclass
class Dqn_Request(ServiceRequest[Dqn_Request, Dqn_Response]):
    """`turtlebot3_msgs/srv/Dqn_Request`"""
    action: int
    init: bool
    __msgtype__: ClassVar[str]

@dataclass
class Dqn_Response:
    """`turtlebot3_msgs/srv/Dqn_Response`"""
    state: NDArray[np.float32]
    reward: float
    done: bool
    __msgtype__: ClassVar[str]

@dataclass
class Goal_Request(ServiceRequest[Goal_Request, Goal_Response]):
    """`turtlebot3_msgs/srv/Goal_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class Goal_Response:
    """`turtlebot3_msgs/srv/Goal_Response`"""
    pose_x: float
    pose_y: float
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class Sound_Request(ServiceRequest[Sound_Request, Sound_Response]):
    """`turtlebot3_msgs/srv/Sound_Request`"""
    value: int
    __msgtype__: ClassVar[str]

@dataclass
class Sound_Response:
    """`turtlebot3_msgs/srv/Sound_Response`"""
    success: bool
    message: str
    __msgtype__: ClassVar[str]

# turtlebot4_msgs

@dataclass
class UserButton:
    """`turtlebot4_msgs/msg/UserButton`"""
    button: NDArray[np.bool_]
    __msgtype__: ClassVar[str]

@dataclass
class UserDisplay:
    """`turtlebot4_msgs/msg/UserDisplay`"""
    ip: str
    battery: str
    entries: list[str]
    selected_entry: int
    __msgtype__: ClassVar[str]

@dataclass
class UserLed:
    """`turtlebot4_msgs/msg/UserLed`"""
    led: int
    color: int
    blink_period: int
    duty_cycle: float
    USER_LED_1: ClassVar[int] = 0
    USER_LED_2: ClassVar[int] = 1
    COLOR_OFF: ClassVar[int] = 0
    COLOR_GREEN: ClassVar[int] = 1
    COLOR_RED: ClassVar[int] = 2
    COLOR_YELLOW: ClassVar[int] = 3
    __msgtype__: ClassVar[str]

# turtlesim

@dataclass
class turtlesim__action__RotateAbsolute_Feedback:
    """`turtlesim/action/RotateAbsolute_Feedback`"""
    remaining: float
    __msgtype__: ClassVar[str]

@dataclass
class turtlesim__action__RotateAbsolute_Goal(ActionGoal[turtlesim__action__RotateAbsolute_Goal, turtlesim__action__RotateAbsolute_Result, turtlesim__action__RotateAbsolute_Feedback]):
    """`turtlesim/action/RotateAbsolute_Goal`"""
    theta: float
    __msgtype__: ClassVar[str]

@dataclass
class turtlesim__action__RotateAbsolute_Result:
    """`turtlesim/action/RotateAbsolute_Result`"""
    delta: float
    __msgtype__: ClassVar[str]

@dataclass
class turtlesim__msg__Color:
    """`turtlesim/msg/Color`"""
    r: int
    g: int
    b: int
    __msgtype__: ClassVar[str]

@dataclass
class turtlesim__msg__Pose:
    """`turtlesim/msg/Pose`"""
    x: float
    y: float
    theta: float
    linear_velocity: float
    angular_velocity: float
    __msgtype__: ClassVar[str]

@dataclass
class turtlesim__srv__Kill_Request(ServiceRequest[turtlesim__srv__Kill_Request, turtlesim__srv__Kill_Response]):
    """`turtlesim/srv/Kill_Request`"""
    name: str
    __msgtype__: ClassVar[str]

@dataclass
class turtlesim__srv__Kill_Response:
    """`turtlesim/srv/Kill_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class turtlesim__srv__SetPen_Request(ServiceRequest[turtlesim__srv__SetPen_Request, turtlesim__srv__SetPen_Response]):
    """`turtlesim/srv/SetPen_Request`"""
    r: int
    g: int
    b: int
    width: int
    off: int
    __msgtype__: ClassVar[str]

@dataclass
class turtlesim__srv__SetPen_Response:
    """`turtlesim/srv/SetPen_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class turtlesim__srv__Spawn_Request(ServiceRequest[turtlesim__srv__Spawn_Request, turtlesim__srv__Spawn_Response]):
    """`turtlesim/srv/Spawn_Request`"""
    x: float
    y: float
    theta: float
    name: str
    __msgtype__: ClassVar[str]

@dataclass
class turtlesim__srv__Spawn_Response:
    """`turtlesim/srv/Spawn_Response`"""
    name: str
    __msgtype__: ClassVar[str]

@dataclass
class turtlesim__srv__TeleportAbsolute_Request(ServiceRequest[turtlesim__srv__TeleportAbsolute_Request, turtlesim__srv__TeleportAbsolute_Response]):
    """`turtlesim/srv/TeleportAbsolute_Request`"""
    x: float
    y: float
    theta: float
    __msgtype__: ClassVar[str]

@dataclass
class turtlesim__srv__TeleportAbsolute_Response:
    """`turtlesim/srv/TeleportAbsolute_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class turtlesim__srv__TeleportRelative_Request(ServiceRequest[turtlesim__srv__TeleportRelative_Request, turtlesim__srv__TeleportRelative_Response]):
    """`turtlesim/srv/TeleportRelative_Request`"""
    linear: float
    angular: float
    __msgtype__: ClassVar[str]

@dataclass
class turtlesim__srv__TeleportRelative_Response:
    """`turtlesim/srv/TeleportRelative_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

# turtlesim_msgs

@dataclass
class turtlesim_msgs__action__RotateAbsolute_Feedback:
    """`turtlesim_msgs/action/RotateAbsolute_Feedback`"""
    remaining: float
    __msgtype__: ClassVar[str]

@dataclass
class turtlesim_msgs__action__RotateAbsolute_Goal(ActionGoal[turtlesim_msgs__action__RotateAbsolute_Goal, turtlesim_msgs__action__RotateAbsolute_Result, turtlesim_msgs__action__RotateAbsolute_Feedback]):
    """`turtlesim_msgs/action/RotateAbsolute_Goal`"""
    theta: float
    __msgtype__: ClassVar[str]

@dataclass
class turtlesim_msgs__action__RotateAbsolute_Result:
    """`turtlesim_msgs/action/RotateAbsolute_Result`"""
    delta: float
    __msgtype__: ClassVar[str]

@dataclass
class turtlesim_msgs__msg__Color:
    """`turtlesim_msgs/msg/Color`"""
    r: int
    g: int
    b: int
    __msgtype__: ClassVar[str]

@dataclass
class turtlesim_msgs__msg__Pose:
    """`turtlesim_msgs/msg/Pose`"""
    x: float
    y: float
    theta: float
    linear_velocity: float
    angular_velocity: float
    __msgtype__: ClassVar[str]

@dataclass
class turtlesim_msgs__srv__Kill_Request(ServiceRequest[turtlesim_msgs__srv__Kill_Request, turtlesim_msgs__srv__Kill_Response]):
    """`turtlesim_msgs/srv/Kill_Request`"""
    name: str
    __msgtype__: ClassVar[str]

@dataclass
class turtlesim_msgs__srv__Kill_Response:
    """`turtlesim_msgs/srv/Kill_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class turtlesim_msgs__srv__SetPen_Request(ServiceRequest[turtlesim_msgs__srv__SetPen_Request, turtlesim_msgs__srv__SetPen_Response]):
    """`turtlesim_msgs/srv/SetPen_Request`"""
    r: int
    g: int
    b: int
    width: int
    off: int
    __msgtype__: ClassVar[str]

@dataclass
class turtlesim_msgs__srv__SetPen_Response:
    """`turtlesim_msgs/srv/SetPen_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class turtlesim_msgs__srv__Spawn_Request(ServiceRequest[turtlesim_msgs__srv__Spawn_Request, turtlesim_msgs__srv__Spawn_Response]):
    """`turtlesim_msgs/srv/Spawn_Request`"""
    x: float
    y: float
    theta: float
    name: str
    __msgtype__: ClassVar[str]

@dataclass
class turtlesim_msgs__srv__Spawn_Response:
    """`turtlesim_msgs/srv/Spawn_Response`"""
    name: str
    __msgtype__: ClassVar[str]

@dataclass
class turtlesim_msgs__srv__TeleportAbsolute_Request(ServiceRequest[turtlesim_msgs__srv__TeleportAbsolute_Request, turtlesim_msgs__srv__TeleportAbsolute_Response]):
    """`turtlesim_msgs/srv/TeleportAbsolute_Request`"""
    x: float
    y: float
    theta: float
    __msgtype__: ClassVar[str]

@dataclass
class turtlesim_msgs__srv__TeleportAbsolute_Response:
    """`turtlesim_msgs/srv/TeleportAbsolute_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class turtlesim_msgs__srv__TeleportRelative_Request(ServiceRequest[turtlesim_msgs__srv__TeleportRelative_Request, turtlesim_msgs__srv__TeleportRelative_Response]):
    """`turtlesim_msgs/srv/TeleportRelative_Request`"""
    linear: float
    angular: float
    __msgtype__: ClassVar[str]

@dataclass
class turtlesim_msgs__srv__TeleportRelative_Response:
    """`turtlesim_msgs/srv/TeleportRelative_Response`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

# type_description_interfaces

@dataclass
class Field:
    """`type_description_interfaces/msg/Field`"""
    name: str
    type: FieldType
    default_value: str
    __msgtype__: ClassVar[str]

@dataclass
class FieldType:
    """`type_description_interfaces/msg/FieldType`"""
    type_id: int
    capacity: int
    string_capacity: int
    nested_type_name: str
    FIELD_TYPE_NOT_SET: ClassVar[int] = 0
    FIELD_TYPE_NESTED_TYPE: ClassVar[int] = 1
    FIELD_TYPE_INT8: ClassVar[int] = 2
    FIELD_TYPE_UINT8: ClassVar[int] = 3
    FIELD_TYPE_INT16: ClassVar[int] = 4
    FIELD_TYPE_UINT16: ClassVar[int] = 5
    FIELD_TYPE_INT32: ClassVar[int] = 6
    FIELD_TYPE_UINT32: ClassVar[int] = 7
    FIELD_TYPE_INT64: ClassVar[int] = 8
    FIELD_TYPE_UINT64: ClassVar[int] = 9
    FIELD_TYPE_FLOAT: ClassVar[int] = 10
    FIELD_TYPE_DOUBLE: ClassVar[int] = 11
    FIELD_TYPE_LONG_DOUBLE: ClassVar[int] = 12
    FIELD_TYPE_CHAR: ClassVar[int] = 13
    FIELD_TYPE_WCHAR: ClassVar[int] = 14
    FIELD_TYPE_BOOLEAN: ClassVar[int] = 15
    FIELD_TYPE_BYTE: ClassVar[int] = 16
    FIELD_TYPE_STRING: ClassVar[int] = 17
    FIELD_TYPE_WSTRING: ClassVar[int] = 18
    FIELD_TYPE_FIXED_STRING: ClassVar[int] = 19
    FIELD_TYPE_FIXED_WSTRING: ClassVar[int] = 20
    FIELD_TYPE_BOUNDED_STRING: ClassVar[int] = 21
    FIELD_TYPE_BOUNDED_WSTRING: ClassVar[int] = 22
    FIELD_TYPE_NESTED_TYPE_ARRAY: ClassVar[int] = 49
    FIELD_TYPE_INT8_ARRAY: ClassVar[int] = 50
    FIELD_TYPE_UINT8_ARRAY: ClassVar[int] = 51
    FIELD_TYPE_INT16_ARRAY: ClassVar[int] = 52
    FIELD_TYPE_UINT16_ARRAY: ClassVar[int] = 53
    FIELD_TYPE_INT32_ARRAY: ClassVar[int] = 54
    FIELD_TYPE_UINT32_ARRAY: ClassVar[int] = 55
    FIELD_TYPE_INT64_ARRAY: ClassVar[int] = 56
    FIELD_TYPE_UINT64_ARRAY: ClassVar[int] = 57
    FIELD_TYPE_FLOAT_ARRAY: ClassVar[int] = 58
    FIELD_TYPE_DOUBLE_ARRAY: ClassVar[int] = 59
    FIELD_TYPE_LONG_DOUBLE_ARRAY: ClassVar[int] = 60
    FIELD_TYPE_CHAR_ARRAY: ClassVar[int] = 61
    FIELD_TYPE_WCHAR_ARRAY: ClassVar[int] = 62
    FIELD_TYPE_BOOLEAN_ARRAY: ClassVar[int] = 63
    FIELD_TYPE_BYTE_ARRAY: ClassVar[int] = 64
    FIELD_TYPE_STRING_ARRAY: ClassVar[int] = 65
    FIELD_TYPE_WSTRING_ARRAY: ClassVar[int] = 66
    FIELD_TYPE_FIXED_STRING_ARRAY: ClassVar[int] = 67
    FIELD_TYPE_FIXED_WSTRING_ARRAY: ClassVar[int] = 68
    FIELD_TYPE_BOUNDED_STRING_ARRAY: ClassVar[int] = 69
    FIELD_TYPE_BOUNDED_WSTRING_ARRAY: ClassVar[int] = 70
    FIELD_TYPE_NESTED_TYPE_BOUNDED_SEQUENCE: ClassVar[int] = 97
    FIELD_TYPE_INT8_BOUNDED_SEQUENCE: ClassVar[int] = 98
    FIELD_TYPE_UINT8_BOUNDED_SEQUENCE: ClassVar[int] = 99
    FIELD_TYPE_INT16_BOUNDED_SEQUENCE: ClassVar[int] = 100
    FIELD_TYPE_UINT16_BOUNDED_SEQUENCE: ClassVar[int] = 101
    FIELD_TYPE_INT32_BOUNDED_SEQUENCE: ClassVar[int] = 102
    FIELD_TYPE_UINT32_BOUNDED_SEQUENCE: ClassVar[int] = 103
    FIELD_TYPE_INT64_BOUNDED_SEQUENCE: ClassVar[int] = 104
    FIELD_TYPE_UINT64_BOUNDED_SEQUENCE: ClassVar[int] = 105
    FIELD_TYPE_FLOAT_BOUNDED_SEQUENCE: ClassVar[int] = 106
    FIELD_TYPE_DOUBLE_BOUNDED_SEQUENCE: ClassVar[int] = 107
    FIELD_TYPE_LONG_DOUBLE_BOUNDED_SEQUENCE: ClassVar[int] = 108
    FIELD_TYPE_CHAR_BOUNDED_SEQUENCE: ClassVar[int] = 109
    FIELD_TYPE_WCHAR_BOUNDED_SEQUENCE: ClassVar[int] = 110
    FIELD_TYPE_BOOLEAN_BOUNDED_SEQUENCE: ClassVar[int] = 111
    FIELD_TYPE_BYTE_BOUNDED_SEQUENCE: ClassVar[int] = 112
    FIELD_TYPE_STRING_BOUNDED_SEQUENCE: ClassVar[int] = 113
    FIELD_TYPE_WSTRING_BOUNDED_SEQUENCE: ClassVar[int] = 114
    FIELD_TYPE_FIXED_STRING_BOUNDED_SEQUENCE: ClassVar[int] = 115
    FIELD_TYPE_FIXED_WSTRING_BOUNDED_SEQUENCE: ClassVar[int] = 116
    FIELD_TYPE_BOUNDED_STRING_BOUNDED_SEQUENCE: ClassVar[int] = 117
    FIELD_TYPE_BOUNDED_WSTRING_BOUNDED_SEQUENCE: ClassVar[int] = 118
    FIELD_TYPE_NESTED_TYPE_UNBOUNDED_SEQUENCE: ClassVar[int] = 145
    FIELD_TYPE_INT8_UNBOUNDED_SEQUENCE: ClassVar[int] = 146
    FIELD_TYPE_UINT8_UNBOUNDED_SEQUENCE: ClassVar[int] = 147
    FIELD_TYPE_INT16_UNBOUNDED_SEQUENCE: ClassVar[int] = 148
    FIELD_TYPE_UINT16_UNBOUNDED_SEQUENCE: ClassVar[int] = 149
    FIELD_TYPE_INT32_UNBOUNDED_SEQUENCE: ClassVar[int] = 150
    FIELD_TYPE_UINT32_UNBOUNDED_SEQUENCE: ClassVar[int] = 151
    FIELD_TYPE_INT64_UNBOUNDED_SEQUENCE: ClassVar[int] = 152
    FIELD_TYPE_UINT64_UNBOUNDED_SEQUENCE: ClassVar[int] = 153
    FIELD_TYPE_FLOAT_UNBOUNDED_SEQUENCE: ClassVar[int] = 154
    FIELD_TYPE_DOUBLE_UNBOUNDED_SEQUENCE: ClassVar[int] = 155
    FIELD_TYPE_LONG_DOUBLE_UNBOUNDED_SEQUENCE: ClassVar[int] = 156
    FIELD_TYPE_CHAR_UNBOUNDED_SEQUENCE: ClassVar[int] = 157
    FIELD_TYPE_WCHAR_UNBOUNDED_SEQUENCE: ClassVar[int] = 158
    FIELD_TYPE_BOOLEAN_UNBOUNDED_SEQUENCE: ClassVar[int] = 159
    FIELD_TYPE_BYTE_UNBOUNDED_SEQUENCE: ClassVar[int] = 160
    FIELD_TYPE_STRING_UNBOUNDED_SEQUENCE: ClassVar[int] = 161
    FIELD_TYPE_WSTRING_UNBOUNDED_SEQUENCE: ClassVar[int] = 162
    FIELD_TYPE_FIXED_STRING_UNBOUNDED_SEQUENCE: ClassVar[int] = 163
    FIELD_TYPE_FIXED_WSTRING_UNBOUNDED_SEQUENCE: ClassVar[int] = 164
    FIELD_TYPE_BOUNDED_STRING_UNBOUNDED_SEQUENCE: ClassVar[int] = 165
    FIELD_TYPE_BOUNDED_WSTRING_UNBOUNDED_SEQUENCE: ClassVar[int] = 166
    __msgtype__: ClassVar[str]

@dataclass
class IndividualTypeDescription:
    """`type_description_interfaces/msg/IndividualTypeDescription`"""
    type_name: str
    fields: list[Field]
    __msgtype__: ClassVar[str]

@dataclass
class type_description_interfaces__msg__KeyValue:
    """`type_description_interfaces/msg/KeyValue`"""
    key: str
    value: str
    __msgtype__: ClassVar[str]

@dataclass
class TypeDescription:
    """`type_description_interfaces/msg/TypeDescription`"""
    type_description: IndividualTypeDescription
    referenced_type_descriptions: list[IndividualTypeDescription]
    __msgtype__: ClassVar[str]

@dataclass
class TypeSource:
    """`type_description_interfaces/msg/TypeSource`"""
    type_name: str
    encoding: str
    raw_file_contents: str
    __msgtype__: ClassVar[str]

@dataclass
class GetTypeDescription_Request(ServiceRequest[GetTypeDescription_Request, GetTypeDescription_Response]):
    """`type_description_interfaces/srv/GetTypeDescription_Request`"""
    type_name: str
    type_hash: str
    include_type_sources: bool
    __msgtype__: ClassVar[str]

@dataclass
class GetTypeDescription_Response:
    """`type_description_interfaces/srv/GetTypeDescription_Response`"""
    successful: bool
    failure_reason: str
    type_description: TypeDescription
    type_sources: list[TypeSource]
    extra_information: list[type_description_interfaces__msg__KeyValue]
    __msgtype__: ClassVar[str]

# unique_identifier_msgs

@dataclass
class UUID:
    """`unique_identifier_msgs/msg/UUID`"""
    uuid: NDArray[np.uint8]
    __msgtype__: ClassVar[str]

# ur_msgs

@dataclass
class Analog:
    """`ur_msgs/msg/Analog`"""
    pin: int
    domain: int
    state: float
    CURRENT: ClassVar[int] = 0
    VOLTAGE: ClassVar[int] = 1
    __msgtype__: ClassVar[str]

@dataclass
class Digital:
    """`ur_msgs/msg/Digital`"""
    pin: int
    state: bool
    __msgtype__: ClassVar[str]

@dataclass
class IOStates:
    """`ur_msgs/msg/IOStates`"""
    digital_in_states: list[Digital]
    digital_out_states: list[Digital]
    flag_states: list[Digital]
    analog_in_states: list[Analog]
    analog_out_states: list[Analog]
    __msgtype__: ClassVar[str]

@dataclass
class MasterboardDataMsg:
    """`ur_msgs/msg/MasterboardDataMsg`"""
    digital_input_bits: int
    digital_output_bits: int
    analog_input_range0: int
    analog_input_range1: int
    analog_input0: float
    analog_input1: float
    analog_output_domain0: int
    analog_output_domain1: int
    analog_output0: float
    analog_output1: float
    masterboard_temperature: float
    robot_voltage_48v: float
    robot_current: float
    master_io_current: float
    master_safety_state: int
    master_onoff_state: int
    __msgtype__: ClassVar[str]

@dataclass
class RobotModeDataMsg:
    """`ur_msgs/msg/RobotModeDataMsg`"""
    timestamp: int
    is_robot_connected: bool
    is_real_robot_enabled: bool
    is_power_on_robot: bool
    is_emergency_stopped: bool
    is_protective_stopped: bool
    is_program_running: bool
    is_program_paused: bool
    __msgtype__: ClassVar[str]

@dataclass
class RobotStateRTMsg:
    """`ur_msgs/msg/RobotStateRTMsg`"""
    time: float
    q_target: NDArray[np.float64]
    qd_target: NDArray[np.float64]
    qdd_target: NDArray[np.float64]
    i_target: NDArray[np.float64]
    m_target: NDArray[np.float64]
    q_actual: NDArray[np.float64]
    qd_actual: NDArray[np.float64]
    i_actual: NDArray[np.float64]
    tool_acc_values: NDArray[np.float64]
    tcp_force: NDArray[np.float64]
    tool_vector: NDArray[np.float64]
    tcp_speed: NDArray[np.float64]
    digital_input_bits: float
    motor_temperatures: NDArray[np.float64]
    controller_timer: float
    test_value: float
    robot_mode: float
    joint_modes: NDArray[np.float64]
    __msgtype__: ClassVar[str]

@dataclass
class ToolDataMsg:
    """`ur_msgs/msg/ToolDataMsg`"""
    analog_input_range2: int
    analog_input_range3: int
    analog_input2: float
    analog_input3: float
    tool_voltage_48v: float
    tool_output_voltage: int
    tool_current: float
    tool_temperature: float
    tool_mode: int
    ANALOG_INPUT_RANGE_CURRENT: ClassVar[int] = 0
    ANALOG_INPUT_RANGE_VOLTAGE: ClassVar[int] = 1
    TOOL_BOOTLOADER_MODE: ClassVar[int] = 249
    TOOL_RUNNING_MODE: ClassVar[int] = 253
    TOOL_IDLE_MODE: ClassVar[int] = 255
    __msgtype__: ClassVar[str]

@dataclass
class SetIO_Request(ServiceRequest[SetIO_Request, SetIO_Response]):
    """`ur_msgs/srv/SetIO_Request`"""
    fun: int
    pin: int
    state: float
    PIN_AOUT0: ClassVar[int] = 0
    PIN_AOUT1: ClassVar[int] = 1
    PIN_DOUT0: ClassVar[int] = 0
    PIN_DOUT1: ClassVar[int] = 1
    PIN_DOUT2: ClassVar[int] = 2
    PIN_DOUT3: ClassVar[int] = 3
    PIN_DOUT4: ClassVar[int] = 4
    PIN_DOUT5: ClassVar[int] = 5
    PIN_DOUT6: ClassVar[int] = 6
    PIN_DOUT7: ClassVar[int] = 7
    PIN_CONF_OUT0: ClassVar[int] = 8
    PIN_CONF_OUT1: ClassVar[int] = 9
    PIN_CONF_OUT2: ClassVar[int] = 10
    PIN_CONF_OUT3: ClassVar[int] = 11
    PIN_CONF_OUT4: ClassVar[int] = 12
    PIN_CONF_OUT5: ClassVar[int] = 13
    PIN_CONF_OUT6: ClassVar[int] = 14
    PIN_CONF_OUT7: ClassVar[int] = 15
    PIN_TOOL_DOUT0: ClassVar[int] = 16
    PIN_TOOL_DOUT1: ClassVar[int] = 17
    FUN_SET_DIGITAL_OUT: ClassVar[int] = 1
    FUN_SET_FLAG: ClassVar[int] = 2
    FUN_SET_ANALOG_OUT: ClassVar[int] = 3
    FUN_SET_TOOL_VOLTAGE: ClassVar[int] = 4
    STATE_OFF: ClassVar[int] = 0
    STATE_ON: ClassVar[int] = 1
    STATE_TOOL_VOLTAGE_0V: ClassVar[int] = 0
    STATE_TOOL_VOLTAGE_12V: ClassVar[int] = 12
    STATE_TOOL_VOLTAGE_24V: ClassVar[int] = 24
    __msgtype__: ClassVar[str]

@dataclass
class SetIO_Response:
    """`ur_msgs/srv/SetIO_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class SetPayload_Request(ServiceRequest[SetPayload_Request, SetPayload_Response]):
    """`ur_msgs/srv/SetPayload_Request`"""
    mass: float
    center_of_gravity: Vector3
    __msgtype__: ClassVar[str]

@dataclass
class SetPayload_Response:
    """`ur_msgs/srv/SetPayload_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class SetSpeedSliderFraction_Request(ServiceRequest[SetSpeedSliderFraction_Request, SetSpeedSliderFraction_Response]):
    """`ur_msgs/srv/SetSpeedSliderFraction_Request`"""
    speed_slider_fraction: float
    __msgtype__: ClassVar[str]

@dataclass
class SetSpeedSliderFraction_Response:
    """`ur_msgs/srv/SetSpeedSliderFraction_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

# uuv_gazebo_ros_plugins_msgs

@dataclass
class FloatStamped:
    """`uuv_gazebo_ros_plugins_msgs/msg/FloatStamped`"""
    header: Header
    data: float
    __msgtype__: ClassVar[str]

@dataclass
class ThrusterConversionFcn:
    """`uuv_gazebo_ros_plugins_msgs/msg/ThrusterConversionFcn`"""
    function_name: str
    tags: list[str]
    data: NDArray[np.float64]
    lookup_table_input: NDArray[np.float64]
    lookup_table_output: NDArray[np.float64]
    __msgtype__: ClassVar[str]

@dataclass
class UnderwaterObjectModel:
    """`uuv_gazebo_ros_plugins_msgs/msg/UnderwaterObjectModel`"""
    added_mass: NDArray[np.float64]
    linear_damping: NDArray[np.float64]
    linear_damping_forward_speed: NDArray[np.float64]
    quadratic_damping: NDArray[np.float64]
    volume: float
    bbox_height: float
    bbox_length: float
    bbox_width: float
    fluid_density: float
    cob: Vector3
    neutrally_buoyant: bool
    inertia: Inertia
    __msgtype__: ClassVar[str]

@dataclass
class GetFloat_Request(ServiceRequest[GetFloat_Request, GetFloat_Response]):
    """`uuv_gazebo_ros_plugins_msgs/srv/GetFloat_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class GetFloat_Response:
    """`uuv_gazebo_ros_plugins_msgs/srv/GetFloat_Response`"""
    data: float
    __msgtype__: ClassVar[str]

@dataclass
class GetListParam_Request(ServiceRequest[GetListParam_Request, GetListParam_Response]):
    """`uuv_gazebo_ros_plugins_msgs/srv/GetListParam_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class GetListParam_Response:
    """`uuv_gazebo_ros_plugins_msgs/srv/GetListParam_Response`"""
    description: str
    tags: list[str]
    data: NDArray[np.float64]
    __msgtype__: ClassVar[str]

@dataclass
class uuv_gazebo_ros_plugins_msgs__srv__GetModelProperties_Request(ServiceRequest[uuv_gazebo_ros_plugins_msgs__srv__GetModelProperties_Request, uuv_gazebo_ros_plugins_msgs__srv__GetModelProperties_Response]):
    """`uuv_gazebo_ros_plugins_msgs/srv/GetModelProperties_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class uuv_gazebo_ros_plugins_msgs__srv__GetModelProperties_Response:
    """`uuv_gazebo_ros_plugins_msgs/srv/GetModelProperties_Response`"""
    link_names: list[str]
    models: list[UnderwaterObjectModel]
    __msgtype__: ClassVar[str]

@dataclass
class GetThrusterConversionFcn_Request(ServiceRequest[GetThrusterConversionFcn_Request, GetThrusterConversionFcn_Response]):
    """`uuv_gazebo_ros_plugins_msgs/srv/GetThrusterConversionFcn_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class GetThrusterConversionFcn_Response:
    """`uuv_gazebo_ros_plugins_msgs/srv/GetThrusterConversionFcn_Response`"""
    fcn: ThrusterConversionFcn
    __msgtype__: ClassVar[str]

@dataclass
class GetThrusterEfficiency_Request(ServiceRequest[GetThrusterEfficiency_Request, GetThrusterEfficiency_Response]):
    """`uuv_gazebo_ros_plugins_msgs/srv/GetThrusterEfficiency_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class GetThrusterEfficiency_Response:
    """`uuv_gazebo_ros_plugins_msgs/srv/GetThrusterEfficiency_Response`"""
    efficiency: float
    __msgtype__: ClassVar[str]

@dataclass
class GetThrusterState_Request(ServiceRequest[GetThrusterState_Request, GetThrusterState_Response]):
    """`uuv_gazebo_ros_plugins_msgs/srv/GetThrusterState_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class GetThrusterState_Response:
    """`uuv_gazebo_ros_plugins_msgs/srv/GetThrusterState_Response`"""
    is_on: bool
    __msgtype__: ClassVar[str]

@dataclass
class SetFloat_Request(ServiceRequest[SetFloat_Request, SetFloat_Response]):
    """`uuv_gazebo_ros_plugins_msgs/srv/SetFloat_Request`"""
    data: float
    __msgtype__: ClassVar[str]

@dataclass
class SetFloat_Response:
    """`uuv_gazebo_ros_plugins_msgs/srv/SetFloat_Response`"""
    success: bool
    message: str
    __msgtype__: ClassVar[str]

@dataclass
class SetThrusterEfficiency_Request(ServiceRequest[SetThrusterEfficiency_Request, SetThrusterEfficiency_Response]):
    """`uuv_gazebo_ros_plugins_msgs/srv/SetThrusterEfficiency_Request`"""
    efficiency: float
    __msgtype__: ClassVar[str]

@dataclass
class SetThrusterEfficiency_Response:
    """`uuv_gazebo_ros_plugins_msgs/srv/SetThrusterEfficiency_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class SetThrusterState_Request(ServiceRequest[SetThrusterState_Request, SetThrusterState_Response]):
    """`uuv_gazebo_ros_plugins_msgs/srv/SetThrusterState_Request`"""
    on: bool
    __msgtype__: ClassVar[str]

@dataclass
class SetThrusterState_Response:
    """`uuv_gazebo_ros_plugins_msgs/srv/SetThrusterState_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class SetUseGlobalCurrentVel_Request(ServiceRequest[SetUseGlobalCurrentVel_Request, SetUseGlobalCurrentVel_Response]):
    """`uuv_gazebo_ros_plugins_msgs/srv/SetUseGlobalCurrentVel_Request`"""
    use_global: bool
    __msgtype__: ClassVar[str]

@dataclass
class SetUseGlobalCurrentVel_Response:
    """`uuv_gazebo_ros_plugins_msgs/srv/SetUseGlobalCurrentVel_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

# uuv_sensor_ros_plugins_msgs

@dataclass
class ChemicalParticleConcentration:
    """`uuv_sensor_ros_plugins_msgs/msg/ChemicalParticleConcentration`"""
    header: Header
    position: Vector3
    latitude: float
    longitude: float
    depth: float
    concentration: float
    is_measuring: bool
    __msgtype__: ClassVar[str]

@dataclass
class uuv_sensor_ros_plugins_msgs__msg__DVL:
    """`uuv_sensor_ros_plugins_msgs/msg/DVL`"""
    header: Header
    velocity: Vector3
    velocity_covariance: NDArray[np.float64]
    altitude: float
    beams: list[uuv_sensor_ros_plugins_msgs__msg__DVLBeam]
    __msgtype__: ClassVar[str]

@dataclass
class uuv_sensor_ros_plugins_msgs__msg__DVLBeam:
    """`uuv_sensor_ros_plugins_msgs/msg/DVLBeam`"""
    range: float
    range_covariance: float
    velocity: float
    velocity_covariance: float
    pose: PoseStamped
    __msgtype__: ClassVar[str]

@dataclass
class PositionWithCovariance:
    """`uuv_sensor_ros_plugins_msgs/msg/PositionWithCovariance`"""
    pos: Point
    covariance: NDArray[np.float64]
    __msgtype__: ClassVar[str]

@dataclass
class PositionWithCovarianceStamped:
    """`uuv_sensor_ros_plugins_msgs/msg/PositionWithCovarianceStamped`"""
    header: Header
    pos: PositionWithCovariance
    __msgtype__: ClassVar[str]

@dataclass
class Salinity:
    """`uuv_sensor_ros_plugins_msgs/msg/Salinity`"""
    header: Header
    salinity: float
    variance: float
    unit: str
    PSU: ClassVar[str] = 'psu'
    PPM: ClassVar[str] = 'ppm'
    PPT: ClassVar[str] = 'ppt'
    __msgtype__: ClassVar[str]

@dataclass
class ChangeSensorState_Request(ServiceRequest[ChangeSensorState_Request, ChangeSensorState_Response]):
    """`uuv_sensor_ros_plugins_msgs/srv/ChangeSensorState_Request`"""
    on: bool
    __msgtype__: ClassVar[str]

@dataclass
class ChangeSensorState_Response:
    """`uuv_sensor_ros_plugins_msgs/srv/ChangeSensorState_Response`"""
    success: bool
    message: str
    __msgtype__: ClassVar[str]

# uuv_world_ros_plugins_msgs

@dataclass
class uuv_world_ros_plugins_msgs__srv__GetCurrentModel_Request(ServiceRequest[uuv_world_ros_plugins_msgs__srv__GetCurrentModel_Request, uuv_world_ros_plugins_msgs__srv__GetCurrentModel_Response]):
    """`uuv_world_ros_plugins_msgs/srv/GetCurrentModel_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class uuv_world_ros_plugins_msgs__srv__GetCurrentModel_Response:
    """`uuv_world_ros_plugins_msgs/srv/GetCurrentModel_Response`"""
    mean: float
    min: float
    max: float
    noise: float
    mu: float
    __msgtype__: ClassVar[str]

@dataclass
class uuv_world_ros_plugins_msgs__srv__GetOriginSphericalCoord_Request(ServiceRequest[uuv_world_ros_plugins_msgs__srv__GetOriginSphericalCoord_Request, uuv_world_ros_plugins_msgs__srv__GetOriginSphericalCoord_Response]):
    """`uuv_world_ros_plugins_msgs/srv/GetOriginSphericalCoord_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class uuv_world_ros_plugins_msgs__srv__GetOriginSphericalCoord_Response:
    """`uuv_world_ros_plugins_msgs/srv/GetOriginSphericalCoord_Response`"""
    latitude_deg: float
    longitude_deg: float
    altitude: float
    __msgtype__: ClassVar[str]

@dataclass
class uuv_world_ros_plugins_msgs__srv__SetCurrentDirection_Request(ServiceRequest[uuv_world_ros_plugins_msgs__srv__SetCurrentDirection_Request, uuv_world_ros_plugins_msgs__srv__SetCurrentDirection_Response]):
    """`uuv_world_ros_plugins_msgs/srv/SetCurrentDirection_Request`"""
    angle: float
    __msgtype__: ClassVar[str]

@dataclass
class uuv_world_ros_plugins_msgs__srv__SetCurrentDirection_Response:
    """`uuv_world_ros_plugins_msgs/srv/SetCurrentDirection_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class uuv_world_ros_plugins_msgs__srv__SetCurrentModel_Request(ServiceRequest[uuv_world_ros_plugins_msgs__srv__SetCurrentModel_Request, uuv_world_ros_plugins_msgs__srv__SetCurrentModel_Response]):
    """`uuv_world_ros_plugins_msgs/srv/SetCurrentModel_Request`"""
    mean: float
    min: float
    max: float
    noise: float
    mu: float
    __msgtype__: ClassVar[str]

@dataclass
class uuv_world_ros_plugins_msgs__srv__SetCurrentModel_Response:
    """`uuv_world_ros_plugins_msgs/srv/SetCurrentModel_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class uuv_world_ros_plugins_msgs__srv__SetCurrentVelocity_Request(ServiceRequest[uuv_world_ros_plugins_msgs__srv__SetCurrentVelocity_Request, uuv_world_ros_plugins_msgs__srv__SetCurrentVelocity_Response]):
    """`uuv_world_ros_plugins_msgs/srv/SetCurrentVelocity_Request`"""
    velocity: float
    horizontal_angle: float
    vertical_angle: float
    __msgtype__: ClassVar[str]

@dataclass
class uuv_world_ros_plugins_msgs__srv__SetCurrentVelocity_Response:
    """`uuv_world_ros_plugins_msgs/srv/SetCurrentVelocity_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class uuv_world_ros_plugins_msgs__srv__SetOriginSphericalCoord_Request(ServiceRequest[uuv_world_ros_plugins_msgs__srv__SetOriginSphericalCoord_Request, uuv_world_ros_plugins_msgs__srv__SetOriginSphericalCoord_Response]):
    """`uuv_world_ros_plugins_msgs/srv/SetOriginSphericalCoord_Request`"""
    latitude_deg: float
    longitude_deg: float
    altitude: float
    __msgtype__: ClassVar[str]

@dataclass
class uuv_world_ros_plugins_msgs__srv__SetOriginSphericalCoord_Response:
    """`uuv_world_ros_plugins_msgs/srv/SetOriginSphericalCoord_Response`"""
    success: bool
    __msgtype__: ClassVar[str]

@dataclass
class uuv_world_ros_plugins_msgs__srv__TransformFromSphericalCoord_Request(ServiceRequest[uuv_world_ros_plugins_msgs__srv__TransformFromSphericalCoord_Request, uuv_world_ros_plugins_msgs__srv__TransformFromSphericalCoord_Response]):
    """`uuv_world_ros_plugins_msgs/srv/TransformFromSphericalCoord_Request`"""
    latitude_deg: float
    longitude_deg: float
    altitude: float
    __msgtype__: ClassVar[str]

@dataclass
class uuv_world_ros_plugins_msgs__srv__TransformFromSphericalCoord_Response:
    """`uuv_world_ros_plugins_msgs/srv/TransformFromSphericalCoord_Response`"""
    output: Vector3
    __msgtype__: ClassVar[str]

@dataclass
class uuv_world_ros_plugins_msgs__srv__TransformToSphericalCoord_Request(ServiceRequest[uuv_world_ros_plugins_msgs__srv__TransformToSphericalCoord_Request, uuv_world_ros_plugins_msgs__srv__TransformToSphericalCoord_Response]):
    """`uuv_world_ros_plugins_msgs/srv/TransformToSphericalCoord_Request`"""
    input: Vector3
    __msgtype__: ClassVar[str]

@dataclass
class uuv_world_ros_plugins_msgs__srv__TransformToSphericalCoord_Response:
    """`uuv_world_ros_plugins_msgs/srv/TransformToSphericalCoord_Response`"""
    latitude_deg: float
    longitude_deg: float
    altitude: float
    __msgtype__: ClassVar[str]

# vision_msgs

@dataclass
class BoundingBox2D:
    """`vision_msgs/msg/BoundingBox2D`"""
    center: vision_msgs__msg__Pose2D
    size_x: float
    size_y: float
    __msgtype__: ClassVar[str]

@dataclass
class BoundingBox2DArray:
    """`vision_msgs/msg/BoundingBox2DArray`"""
    header: Header
    boxes: list[BoundingBox2D]
    __msgtype__: ClassVar[str]

@dataclass
class BoundingBox3D:
    """`vision_msgs/msg/BoundingBox3D`"""
    center: Pose
    size: Vector3
    __msgtype__: ClassVar[str]

@dataclass
class BoundingBox3DArray:
    """`vision_msgs/msg/BoundingBox3DArray`"""
    header: Header
    boxes: list[BoundingBox3D]
    __msgtype__: ClassVar[str]

@dataclass
class Classification:
    """`vision_msgs/msg/Classification`"""
    header: Header
    results: list[ObjectHypothesis]
    __msgtype__: ClassVar[str]

@dataclass
class Detection2D:
    """`vision_msgs/msg/Detection2D`"""
    header: Header
    results: list[ObjectHypothesisWithPose]
    bbox: BoundingBox2D
    id: str
    __msgtype__: ClassVar[str]

@dataclass
class Detection2DArray:
    """`vision_msgs/msg/Detection2DArray`"""
    header: Header
    detections: list[Detection2D]
    __msgtype__: ClassVar[str]

@dataclass
class Detection3D:
    """`vision_msgs/msg/Detection3D`"""
    header: Header
    results: list[ObjectHypothesisWithPose]
    bbox: BoundingBox3D
    id: str
    __msgtype__: ClassVar[str]

@dataclass
class Detection3DArray:
    """`vision_msgs/msg/Detection3DArray`"""
    header: Header
    detections: list[Detection3D]
    __msgtype__: ClassVar[str]

@dataclass
class LabelInfo:
    """`vision_msgs/msg/LabelInfo`"""
    header: Header
    class_map: list[VisionClass]
    threshold: float
    __msgtype__: ClassVar[str]

@dataclass
class ObjectHypothesis:
    """`vision_msgs/msg/ObjectHypothesis`"""
    class_id: str
    score: float
    __msgtype__: ClassVar[str]

@dataclass
class ObjectHypothesisWithPose:
    """`vision_msgs/msg/ObjectHypothesisWithPose`"""
    hypothesis: ObjectHypothesis
    pose: PoseWithCovariance
    __msgtype__: ClassVar[str]

@dataclass
class Point2D:
    """`vision_msgs/msg/Point2D`"""
    x: float
    y: float
    __msgtype__: ClassVar[str]

@dataclass
class vision_msgs__msg__Pose2D:
    """`vision_msgs/msg/Pose2D`"""
    position: Point2D
    theta: float
    __msgtype__: ClassVar[str]

@dataclass
class VisionClass:
    """`vision_msgs/msg/VisionClass`"""
    class_id: int
    class_name: str
    __msgtype__: ClassVar[str]

@dataclass
class VisionInfo:
    """`vision_msgs/msg/VisionInfo`"""
    header: Header
    method: str
    database_location: str
    database_version: int
    __msgtype__: ClassVar[str]

# visualization_msgs

@dataclass
class ImageMarker:
    """`visualization_msgs/msg/ImageMarker`"""
    header: Header
    ns: str
    id: int
    type: int
    action: int
    position: Point
    scale: float
    outline_color: ColorRGBA
    filled: int
    fill_color: ColorRGBA
    lifetime: Duration
    points: list[Point]
    outline_colors: list[ColorRGBA]
    CIRCLE: ClassVar[int] = 0
    LINE_STRIP: ClassVar[int] = 1
    LINE_LIST: ClassVar[int] = 2
    POLYGON: ClassVar[int] = 3
    POINTS: ClassVar[int] = 4
    ADD: ClassVar[int] = 0
    REMOVE: ClassVar[int] = 1
    __msgtype__: ClassVar[str]

@dataclass
class InteractiveMarker:
    """`visualization_msgs/msg/InteractiveMarker`"""
    header: Header
    pose: Pose
    name: str
    description: str
    scale: float
    menu_entries: list[MenuEntry]
    controls: list[InteractiveMarkerControl]
    __msgtype__: ClassVar[str]

@dataclass
class InteractiveMarkerControl:
    """`visualization_msgs/msg/InteractiveMarkerControl`"""
    name: str
    orientation: Quaternion
    orientation_mode: int
    interaction_mode: int
    always_visible: bool
    markers: list[Marker]
    independent_marker_orientation: bool
    description: str
    INHERIT: ClassVar[int] = 0
    FIXED: ClassVar[int] = 1
    VIEW_FACING: ClassVar[int] = 2
    NONE: ClassVar[int] = 0
    MENU: ClassVar[int] = 1
    BUTTON: ClassVar[int] = 2
    MOVE_AXIS: ClassVar[int] = 3
    MOVE_PLANE: ClassVar[int] = 4
    ROTATE_AXIS: ClassVar[int] = 5
    MOVE_ROTATE: ClassVar[int] = 6
    MOVE_3D: ClassVar[int] = 7
    ROTATE_3D: ClassVar[int] = 8
    MOVE_ROTATE_3D: ClassVar[int] = 9
    __msgtype__: ClassVar[str]

@dataclass
class InteractiveMarkerFeedback:
    """`visualization_msgs/msg/InteractiveMarkerFeedback`"""
    header: Header
    client_id: str
    marker_name: str
    control_name: str
    event_type: int
    pose: Pose
    menu_entry_id: int
    mouse_point: Point
    mouse_point_valid: bool
    KEEP_ALIVE: ClassVar[int] = 0
    POSE_UPDATE: ClassVar[int] = 1
    MENU_SELECT: ClassVar[int] = 2
    BUTTON_CLICK: ClassVar[int] = 3
    MOUSE_DOWN: ClassVar[int] = 4
    MOUSE_UP: ClassVar[int] = 5
    __msgtype__: ClassVar[str]

@dataclass
class InteractiveMarkerInit:
    """`visualization_msgs/msg/InteractiveMarkerInit`"""
    server_id: str
    seq_num: int
    markers: list[InteractiveMarker]
    __msgtype__: ClassVar[str]

@dataclass
class InteractiveMarkerPose:
    """`visualization_msgs/msg/InteractiveMarkerPose`"""
    header: Header
    pose: Pose
    name: str
    __msgtype__: ClassVar[str]

@dataclass
class InteractiveMarkerUpdate:
    """`visualization_msgs/msg/InteractiveMarkerUpdate`"""
    server_id: str
    seq_num: int
    type: int
    markers: list[InteractiveMarker]
    poses: list[InteractiveMarkerPose]
    erases: list[str]
    KEEP_ALIVE: ClassVar[int] = 0
    UPDATE: ClassVar[int] = 1
    __msgtype__: ClassVar[str]

@dataclass
class Marker:
    """`visualization_msgs/msg/Marker`"""
    header: Header
    ns: str
    id: int
    type: int
    action: int
    pose: Pose
    scale: Vector3
    color: ColorRGBA
    lifetime: Duration
    frame_locked: bool
    points: list[Point]
    colors: list[ColorRGBA]
    texture_resource: str
    texture: CompressedImage
    uv_coordinates: list[UVCoordinate]
    text: str
    mesh_resource: str
    mesh_file: MeshFile
    mesh_use_embedded_materials: bool
    ARROW: ClassVar[int] = 0
    CUBE: ClassVar[int] = 1
    SPHERE: ClassVar[int] = 2
    CYLINDER: ClassVar[int] = 3
    LINE_STRIP: ClassVar[int] = 4
    LINE_LIST: ClassVar[int] = 5
    CUBE_LIST: ClassVar[int] = 6
    SPHERE_LIST: ClassVar[int] = 7
    POINTS: ClassVar[int] = 8
    TEXT_VIEW_FACING: ClassVar[int] = 9
    MESH_RESOURCE: ClassVar[int] = 10
    TRIANGLE_LIST: ClassVar[int] = 11
    ARROW_STRIP: ClassVar[int] = 12
    ADD: ClassVar[int] = 0
    MODIFY: ClassVar[int] = 0
    DELETE: ClassVar[int] = 2
    DELETEALL: ClassVar[int] = 3
    __msgtype__: ClassVar[str]

@dataclass
class MarkerArray:
    """`visualization_msgs/msg/MarkerArray`"""
    markers: list[Marker]
    __msgtype__: ClassVar[str]

@dataclass
class MenuEntry:
    """`visualization_msgs/msg/MenuEntry`"""
    id: int
    parent_id: int
    title: str
    command: str
    command_type: int
    FEEDBACK: ClassVar[int] = 0
    ROSRUN: ClassVar[int] = 1
    ROSLAUNCH: ClassVar[int] = 2
    __msgtype__: ClassVar[str]

@dataclass
class MeshFile:
    """`visualization_msgs/msg/MeshFile`"""
    filename: str
    data: NDArray[np.uint8]
    __msgtype__: ClassVar[str]

@dataclass
class UVCoordinate:
    """`visualization_msgs/msg/UVCoordinate`"""
    u: float
    v: float
    __msgtype__: ClassVar[str]

@dataclass
class GetInteractiveMarkers_Request(ServiceRequest[GetInteractiveMarkers_Request, GetInteractiveMarkers_Response]):
    """`visualization_msgs/srv/GetInteractiveMarkers_Request`"""
    structure_needs_at_least_one_member: int = 0
    __msgtype__: ClassVar[str]

@dataclass
class GetInteractiveMarkers_Response:
    """`visualization_msgs/srv/GetInteractiveMarkers_Response`"""
    sequence_number: int
    markers: list[InteractiveMarker]
    __msgtype__: ClassVar[str]

__all__: list[str] = [
    "Accel",
    "AccelStamped",
    "AccelWithCovariance",
    "AccelWithCovarianceStamped",
    "AckermannDrive",
    "AckermannDriveStamped",
    "ActuatorControl",
    "Actuators",
    "Adcp",
    "AddDiagnostics_Request",
    "AddDiagnostics_Response",
    "AddMotion_Request",
    "AddMotion_Response",
    "AddSubmap_Request",
    "AddSubmap_Response",
    "AddTwoInts_Request",
    "AddTwoInts_Response",
    "AdmittanceControllerState",
    "AirSpeed",
    "Alert",
    "AlertParameter",
    "AlertResponse",
    "AllowedCollisionEntry",
    "AllowedCollisionMatrix",
    "Altimeter",
    "Altitude",
    "Analog",
    "ApiRequest",
    "ApiResponse",
    "ApiService_Request",
    "ApiService_Response",
    "ApplyBodyWrench_Request",
    "ApplyBodyWrench_Response",
    "ApplyJointEffort_Request",
    "ApplyJointEffort_Response",
    "ApplyLinkWrench_Request",
    "ApplyLinkWrench_Response",
    "ApplyPlanningScene_Request",
    "ApplyPlanningScene_Response",
    "AprilTagDetection",
    "AprilTagDetectionArray",
    "ArucoMarkers",
    "AssemblyState",
    "Assignment",
    "AssistedTeleop_Feedback",
    "AssistedTeleop_Goal",
    "AssistedTeleop_Result",
    "AttachLink_Request",
    "AttachLink_Response",
    "Attach_Request",
    "Attach_Response",
    "AttachedCollisionObject",
    "AttitudeTarget",
    "AttitudeThrust",
    "AudioNote",
    "AudioNoteSequence_Feedback",
    "AudioNoteSequence_Goal",
    "AudioNoteSequence_Result",
    "AudioNoteVector",
    "AutoDocking_Feedback",
    "AutoDocking_Goal",
    "AutoDocking_Result",
    "Averaging_Feedback",
    "Averaging_Goal",
    "Averaging_Result",
    "BackUp_Feedback",
    "BackUp_Goal",
    "BackUp_Result",
    "BadTwoInts_Request",
    "BadTwoInts_Response",
    "BatteryState",
    "BeaconState",
    "Behavior",
    "BehaviorParameter",
    "BehaviorTreeLog",
    "BehaviorTreeStatusChange",
    "BidNotice",
    "BidProposal",
    "BidResponse",
    "BodyRequest_Request",
    "BodyRequest_Response",
    "Bool",
    "BoundingBox",
    "BoundingBox2D",
    "BoundingBox2DArray",
    "BoundingBox3D",
    "BoundingBox3DArray",
    "BoundingBoxQuery_Request",
    "BoundingBoxQuery_Response",
    "BoundingVolume",
    "Bounds",
    "BumperEvent",
    "Button",
    "Byte",
    "ByteMultiArray",
    "CameraInfo",
    "CancelGoal_Request",
    "CancelGoal_Response",
    "CancelTask_Request",
    "CancelTask_Response",
    "CartesianPoint",
    "CartesianTrajectory",
    "CartesianTrajectoryPoint",
    "ChainConnection",
    "ChangeControlDimensions_Request",
    "ChangeControlDimensions_Response",
    "ChangeDriftDimensions_Request",
    "ChangeDriftDimensions_Response",
    "ChangeSensorState_Request",
    "ChangeSensorState_Response",
    "ChangeState_Request",
    "ChangeState_Response",
    "ChannelFloat32",
    "Char",
    "ChargingAssignment",
    "ChargingAssignments",
    "CheckIfRobotStateExistsInWarehouse_Request",
    "CheckIfRobotStateExistsInWarehouse_Response",
    "ChemicalParticleConcentration",
    "Classification",
    "Clean",
    "ClearCostmapAroundPose_Request",
    "ClearCostmapAroundPose_Response",
    "ClearCostmapAroundRobot_Request",
    "ClearCostmapAroundRobot_Response",
    "ClearCostmapExceptRegion_Request",
    "ClearCostmapExceptRegion_Response",
    "ClearEntireCostmap_Request",
    "ClearEntireCostmap_Response",
    "ClearQueue_Request",
    "ClearQueue_Response",
    "Clear_Request",
    "Clear_Response",
    "CliffEvent",
    "Clock",
    "ClosedLanes",
    "CollisionDetectorState",
    "CollisionMonitorState",
    "CollisionObject",
    "ColorRGBA",
    "CommandAck_Request",
    "CommandAck_Response",
    "CommandBool_Request",
    "CommandBool_Response",
    "CommandCode",
    "CommandHome_Request",
    "CommandHome_Response",
    "CommandInt_Request",
    "CommandInt_Response",
    "CommandLong_Request",
    "CommandLong_Response",
    "CommandTOL_Request",
    "CommandTOL_Response",
    "CommandVtolTransition_Request",
    "CommandVtolTransition_Response",
    "CompressedImage",
    "ComputePathThroughPoses_Feedback",
    "ComputePathThroughPoses_Goal",
    "ComputePathThroughPoses_Result",
    "ComputePathToPose_Feedback",
    "ComputePathToPose_Goal",
    "ComputePathToPose_Result",
    "ConfigureController_Request",
    "ConfigureController_Response",
    "ConstraintEvalResult",
    "Constraints",
    "Contact",
    "ContactInformation",
    "ContactState",
    "Contacts",
    "ContactsState",
    "Control",
    "ControlWorld_Request",
    "ControlWorld_Response",
    "ControllerInfo",
    "ControllerState",
    "ConveyorBeltControl_Request",
    "ConveyorBeltControl_Response",
    "ConveyorBeltState",
    "CostSource",
    "Costmap",
    "CostmapFilterInfo",
    "CostmapMetaData",
    "CostmapUpdate",
    "CustomMsg",
    "CustomPoint",
    "DVLTarget",
    "Dataframe",
    "DeleteLight_Request",
    "DeleteLight_Response",
    "DeleteModel_Request",
    "DeleteModel_Response",
    "DeleteRobotStateFromWarehouse_Request",
    "DeleteRobotStateFromWarehouse_Response",
    "Delivery",
    "DeliveryAlert",
    "DeliveryAlertAction",
    "DeliveryAlertCategory",
    "DeliveryAlertTier",
    "DescribeParameters_Request",
    "DescribeParameters_Response",
    "DeserializePoseGraph_Request",
    "DeserializePoseGraph_Response",
    "DestinationRequest",
    "DetachLink_Request",
    "DetachLink_Response",
    "Detection2D",
    "Detection2DArray",
    "Detection3D",
    "Detection3DArray",
    "DiagnosticArray",
    "DiagnosticStatus",
    "Digital",
    "DigitalInputEvent",
    "DigitalOutput",
    "DisparityImage",
    "DispatchAck",
    "DispatchCommand",
    "DispatchState",
    "DispatchStates",
    "DispenserRequest",
    "DispenserRequestItem",
    "DispenserResult",
    "DispenserState",
    "DisplayRobotState",
    "DisplayTrajectory",
    "Dock",
    "DockInfraRed",
    "DockParameter",
    "DockRobot_Feedback",
    "DockRobot_Goal",
    "DockRobot_Result",
    "DockStatus",
    "DockSummary",
    "Dock_Feedback",
    "Dock_Goal",
    "Dock_Result",
    "DoorMode",
    "DoorRequest",
    "DoorSessions",
    "DoorState",
    "Dqn_Request",
    "Dqn_Response",
    "DriveArc_Feedback",
    "DriveArc_Goal",
    "DriveArc_Result",
    "DriveDistance_Feedback",
    "DriveDistance_Goal",
    "DriveDistance_Result",
    "DriveOnHeading_Feedback",
    "DriveOnHeading_Goal",
    "DriveOnHeading_Result",
    "DsHeader",
    "DummyBehavior_Feedback",
    "DummyBehavior_Goal",
    "DummyBehavior_Result",
    "Duration",
    "Dvl",
    "DynamicEventDescription",
    "DynamicEventStatus",
    "DynamicEvent_Feedback",
    "DynamicEvent_Goal",
    "DynamicEvent_Result",
    "DynamicInterfaceGroupValues",
    "DynamicInterfaceValues",
    "DynamicJointState",
    "EStop_Request",
    "EStop_Response",
    "EmergencySignal",
    "Empty",
    "Empty_Request",
    "Empty_Response",
    "EndEffectorCommand",
    "EndEffectorProperties",
    "EndEffectorState",
    "EndpointState",
    "Entity",
    "EntityCategory",
    "EntityFactory",
    "EntityFilters",
    "EntityInfo",
    "EntityRequest_Request",
    "EntityRequest_Response",
    "EntityState",
    "EntityWrench",
    "ExecuteKnownTrajectory_Request",
    "ExecuteKnownTrajectory_Response",
    "ExecuteTrajectory_Feedback",
    "ExecuteTrajectory_Goal",
    "ExecuteTrajectory_Result",
    "ExtendedState",
    "ExternalPower",
    "Fibonacci_Feedback",
    "Fibonacci_Goal",
    "Fibonacci_Result",
    "Field",
    "FieldType",
    "FilteredSensorData",
    "FleetState",
    "Float32",
    "Float32Array",
    "Float32MultiArray",
    "Float64",
    "Float64MultiArray",
    "FloatStamped",
    "FloatingPointRange",
    "Floats",
    "FluidPressure",
    "FollowGPSWaypoints_Feedback",
    "FollowGPSWaypoints_Goal",
    "FollowGPSWaypoints_Result",
    "FollowJointTrajectory_Feedback",
    "FollowJointTrajectory_Goal",
    "FollowJointTrajectory_Result",
    "FollowPath_Feedback",
    "FollowPath_Goal",
    "FollowPath_Result",
    "FollowWaypoints_Feedback",
    "FollowWaypoints_Goal",
    "FollowWaypoints_Result",
    "FromLL_Request",
    "FromLL_Response",
    "GPSFix",
    "GPSStatus",
    "GenerateWorldSdf_Request",
    "GenerateWorldSdf_Response",
    "GenericTrajectory",
    "GeoPath",
    "GeoPoint",
    "GeoPointStamped",
    "GeoPose",
    "GeoPoseStamped",
    "GeoPoseWithCovariance",
    "GeoPoseWithCovarianceStamped",
    "GetAvailableStates_Request",
    "GetAvailableStates_Response",
    "GetAvailableTransitions_Request",
    "GetAvailableTransitions_Response",
    "GetAvailableWorlds_Request",
    "GetAvailableWorlds_Response",
    "GetCartesianPath_Request",
    "GetCartesianPath_Response",
    "GetCostmap_Request",
    "GetCostmap_Response",
    "GetCurrentWorld_Request",
    "GetCurrentWorld_Response",
    "GetDispatchStates_Request",
    "GetDispatchStates_Response",
    "GetEntitiesStates_Request",
    "GetEntitiesStates_Response",
    "GetEntities_Request",
    "GetEntities_Response",
    "GetEntityBounds_Request",
    "GetEntityBounds_Response",
    "GetEntityInfo_Request",
    "GetEntityInfo_Response",
    "GetEntityState_Request",
    "GetEntityState_Response",
    "GetFloat_Request",
    "GetFloat_Response",
    "GetInteractiveMarkers_Request",
    "GetInteractiveMarkers_Response",
    "GetJointProperties_Request",
    "GetJointProperties_Response",
    "GetLightProperties_Request",
    "GetLightProperties_Response",
    "GetLinkProperties_Request",
    "GetLinkProperties_Response",
    "GetLinkState_Request",
    "GetLinkState_Response",
    "GetListParam_Request",
    "GetListParam_Response",
    "GetLoggerLevels_Request",
    "GetLoggerLevels_Response",
    "GetLoggers_Request",
    "GetLoggers_Response",
    "GetMapROI_Request",
    "GetMapROI_Response",
    "GetMap_Request",
    "GetMap_Response",
    "GetModelList_Request",
    "GetModelList_Response",
    "GetModelProperties_Request",
    "GetModelProperties_Response",
    "GetModelState_Request",
    "GetModelState_Response",
    "GetMotionInfo_Request",
    "GetMotionInfo_Response",
    "GetMotionPlan_Request",
    "GetMotionPlan_Response",
    "GetMotionSequence_Request",
    "GetMotionSequence_Response",
    "GetNamedPoseBounds_Request",
    "GetNamedPoseBounds_Response",
    "GetNamedPoses_Request",
    "GetNamedPoses_Response",
    "GetObjectInformation_Request",
    "GetObjectInformation_Response",
    "GetOctomap_Request",
    "GetOctomap_Response",
    "GetParameterTypes_Request",
    "GetParameterTypes_Response",
    "GetParameters_Request",
    "GetParameters_Response",
    "GetPhysicsProperties_Request",
    "GetPhysicsProperties_Response",
    "GetPlan_Request",
    "GetPlan_Response",
    "GetPlannerParams_Request",
    "GetPlannerParams_Response",
    "GetPlanningScene_Request",
    "GetPlanningScene_Response",
    "GetPointMapROI_Request",
    "GetPointMapROI_Response",
    "GetPointMap_Request",
    "GetPointMap_Response",
    "GetPositionFK_Request",
    "GetPositionFK_Response",
    "GetPositionIK_Request",
    "GetPositionIK_Response",
    "GetRobotStateFromWarehouse_Request",
    "GetRobotStateFromWarehouse_Response",
    "GetScene_Request",
    "GetScene_Response",
    "GetSimulationState_Request",
    "GetSimulationState_Response",
    "GetSimulatorFeatures_Request",
    "GetSimulatorFeatures_Response",
    "GetSpawnables_Request",
    "GetSpawnables_Response",
    "GetStateValidity_Request",
    "GetStateValidity_Response",
    "GetState_Request",
    "GetState_Response",
    "GetThrusterConversionFcn_Request",
    "GetThrusterConversionFcn_Response",
    "GetThrusterEfficiency_Request",
    "GetThrusterEfficiency_Response",
    "GetThrusterState_Request",
    "GetThrusterState_Response",
    "GetTypeDescription_Request",
    "GetTypeDescription_Response",
    "GetWorldProperties_Request",
    "GetWorldProperties_Response",
    "Gid",
    "GlobalPositionTarget",
    "GoalID",
    "GoalInfo",
    "Goal_Request",
    "Goal_Response",
    "Goals",
    "Grasp",
    "GraspPlanning_Request",
    "GraspPlanning_Response",
    "GridCells",
    "GripperCommand",
    "GripperCommand_Feedback",
    "GripperCommand_Goal",
    "GripperCommand_Result",
    "GripperTranslation",
    "HardwareComponentState",
    "HardwareInterface",
    "HazardDetection",
    "HazardDetectionVector",
    "HeadPanCommand",
    "HeadState",
    "Header",
    "HeaderString",
    "HomePosition",
    "IOStates",
    "Illuminance",
    "Image",
    "ImageMarker",
    "Imu",
    "IndividualTypeDescription",
    "Inertia",
    "InertiaStamped",
    "IngestorRequest",
    "IngestorRequestItem",
    "IngestorResult",
    "IngestorState",
    "Int16",
    "Int16MultiArray",
    "Int32",
    "Int32MultiArray",
    "Int64",
    "Int64MultiArray",
    "Int8",
    "Int8MultiArray",
    "IntegerRange",
    "InteractiveMarker",
    "InteractiveMarkerControl",
    "InteractiveMarkerFeedback",
    "InteractiveMarkerInit",
    "InteractiveMarkerPose",
    "InteractiveMarkerUpdate",
    "InterfaceButtons",
    "InterfaceValue",
    "InterruptRequest",
    "IrIntensity",
    "IrIntensityVector",
    "IrOpcode",
    "IsAlreadyThere_Request",
    "IsAlreadyThere_Response",
    "IsJointListReady_Request",
    "IsJointListReady_Response",
    "IsMotionReady_Request",
    "IsMotionReady_Response",
    "IsPathValid_Request",
    "IsPathValid_Response",
    "JointCommand",
    "JointComponentTolerance",
    "JointConstraint",
    "JointControllerState",
    "JointJog",
    "JointLimits",
    "JointRequest_Request",
    "JointRequest_Response",
    "JointState",
    "JointTolerance",
    "JointTrajectory",
    "JointTrajectoryControllerState",
    "JointTrajectoryPoint",
    "JointTrajectory_Feedback",
    "JointTrajectory_Goal",
    "JointTrajectory_Result",
    "JointWrench",
    "Joy",
    "JoyFeedback",
    "JoyFeedbackArray",
    "KidnapStatus",
    "KinematicSolverInfo",
    "LabelInfo",
    "LandingTarget",
    "LaneRequest",
    "LaneStates",
    "LaserEcho",
    "LaserScan",
    "Led",
    "LedAnimation_Feedback",
    "LedAnimation_Goal",
    "LedAnimation_Result",
    "LedColor",
    "LiftClearance_Request",
    "LiftClearance_Response",
    "LiftRequest",
    "LiftState",
    "Light",
    "LightringLeds",
    "LinkPadding",
    "LinkRequest_Request",
    "LinkRequest_Response",
    "LinkScale",
    "LinkState",
    "LinkStates",
    "ListControllerTypes_Request",
    "ListControllerTypes_Response",
    "ListControllers_Request",
    "ListControllers_Response",
    "ListHardwareComponents_Request",
    "ListHardwareComponents_Response",
    "ListHardwareInterfaces_Request",
    "ListHardwareInterfaces_Response",
    "ListParametersResult",
    "ListParameters_Request",
    "ListParameters_Response",
    "ListRobotStatesInWarehouse_Request",
    "ListRobotStatesInWarehouse_Response",
    "LoadController_Request",
    "LoadController_Response",
    "LoadMap_Request",
    "LoadMap_Response",
    "LoadWorld_Request",
    "LoadWorld_Response",
    "Location",
    "Log",
    "LogEntry",
    "LogPlaybackStatistics",
    "Logger",
    "LoggerLevel",
    "LogicalCameraImage",
    "LogicalCameraImageModel",
    "LogicalCameraSensor",
    "LookupTransform_Feedback",
    "LookupTransform_Goal",
    "LookupTransform_Result",
    "Loop",
    "LoopClosure_Request",
    "LoopClosure_Response",
    "MagneticField",
    "ManageLifecycleNodes_Request",
    "ManageLifecycleNodes_Response",
    "ManualControl",
    "MapMetaData",
    "Marker",
    "MarkerArray",
    "MasterboardDataMsg",
    "MaterialColor",
    "MecanumDriveControllerState",
    "MenuEntry",
    "MergeMaps_Request",
    "MergeMaps_Response",
    "Mesh",
    "MeshFile",
    "MeshTriangle",
    "MessageInterval_Request",
    "MessageInterval_Response",
    "MetricsMessage",
    "MissedWaypoint",
    "ModeParameter",
    "ModeRequest",
    "ModelState",
    "ModelStates",
    "Motion",
    "MotionInfo",
    "MotionPlanDetailedResponse",
    "MotionPlanRequest",
    "MotionPlanResponse",
    "MotionSequenceItem",
    "MotionSequenceRequest",
    "MotionSequenceResponse",
    "MotorPower",
    "MountControl",
    "Mouse",
    "MoveBase_Feedback",
    "MoveBase_Goal",
    "MoveBase_Result",
    "MoveGroupSequence_Feedback",
    "MoveGroupSequence_Goal",
    "MoveGroupSequence_Result",
    "MoveGroup_Feedback",
    "MoveGroup_Goal",
    "MoveGroup_Result",
    "MoveItErrorCodes",
    "MultiArrayDimension",
    "MultiArrayLayout",
    "MultiDOFCommand",
    "MultiDOFJointState",
    "MultiDOFJointTrajectory",
    "MultiDOFJointTrajectoryPoint",
    "MultiDOFStateStamped",
    "MultiEchoLaserScan",
    "MutexGroupAssignment",
    "MutexGroupManualRelease",
    "MutexGroupRequest",
    "MutexGroupStates",
    "NamedPose",
    "NavSatFix",
    "NavSatStatus",
    "NavigateThroughPoses_Feedback",
    "NavigateThroughPoses_Goal",
    "NavigateThroughPoses_Result",
    "NavigateToPose_Feedback",
    "NavigateToPose_Goal",
    "NavigateToPose_Result",
    "NavigateToPosition_Feedback",
    "NavigateToPosition_Goal",
    "NavigateToPosition_Result",
    "NodeEntitiesInfo",
    "ODEJointProperties",
    "ODEPhysics",
    "ObjectColor",
    "ObjectHypothesis",
    "ObjectHypothesisWithPose",
    "ObjectInformation",
    "ObjectRecognition_Feedback",
    "ObjectRecognition_Goal",
    "ObjectRecognition_Result",
    "ObjectType",
    "OccupancyGrid",
    "OccupancyGridUpdate",
    "Octomap",
    "OctomapWithPose",
    "Odometry",
    "OrientationConstraint",
    "OrientedBoundingBox",
    "OverrideRCIn",
    "Packet",
    "ParallelGripperCommand_Feedback",
    "ParallelGripperCommand_Goal",
    "ParallelGripperCommand_Result",
    "Param",
    "ParamGet_Request",
    "ParamGet_Response",
    "ParamPull_Request",
    "ParamPull_Response",
    "ParamSetV2_Request",
    "ParamSetV2_Response",
    "ParamSet_Request",
    "ParamSet_Response",
    "ParamValue",
    "ParamVec",
    "Parameter",
    "ParameterDescriptor",
    "ParameterEvent",
    "ParameterEventDescriptors",
    "ParameterType",
    "ParameterValue",
    "ParticipantEntitiesInfo",
    "Particle",
    "ParticleCloud",
    "Path",
    "PathRequest",
    "Patrol_Feedback",
    "Patrol_Goal",
    "Patrol_Result",
    "PauseRequest",
    "Pause_Request",
    "Pause_Response",
    "PerformanceMetrics",
    "PerformerStatus",
    "Pickup_Feedback",
    "Pickup_Goal",
    "Pickup_Result",
    "PidState",
    "PlaceLocation",
    "Place_Feedback",
    "Place_Goal",
    "Place_Result",
    "Plane",
    "PlannerInterfaceDescription",
    "PlannerParams",
    "PlanningOptions",
    "PlanningScene",
    "PlanningSceneComponents",
    "PlanningSceneWorld",
    "PlayMotion2Raw_Feedback",
    "PlayMotion2Raw_Goal",
    "PlayMotion2Raw_Result",
    "PlayMotion2_Feedback",
    "PlayMotion2_Goal",
    "PlayMotion2_Result",
    "PlayMotion_Feedback",
    "PlayMotion_Goal",
    "PlayMotion_Result",
    "Point",
    "Point2D",
    "Point32",
    "PointCloud",
    "PointCloud2",
    "PointCloud2Update",
    "PointField",
    "PointHead_Feedback",
    "PointHead_Goal",
    "PointHead_Result",
    "PointStamped",
    "Polygon",
    "PolygonInstance",
    "PolygonInstanceStamped",
    "PolygonStamped",
    "Pose",
    "Pose2D",
    "PoseArray",
    "PoseStamped",
    "PoseWithCovariance",
    "PoseWithCovarianceStamped",
    "PositionConstraint",
    "PositionIKRequest",
    "PositionTarget",
    "PositionWithCovariance",
    "PositionWithCovarianceStamped",
    "PowerSystemEvent",
    "Priority",
    "ProjectedMap",
    "ProjectedMapInfo",
    "ProjectedMapsInfo_Request",
    "ProjectedMapsInfo_Response",
    "Quaternion",
    "QuaternionStamped",
    "QueryCalibrationState_Request",
    "QueryCalibrationState_Response",
    "QueryPlannerInterfaces_Request",
    "QueryPlannerInterfaces_Response",
    "QueryTrajectoryState_Request",
    "QueryTrajectoryState_Response",
    "RCIn",
    "RCOut",
    "Range",
    "Range3D",
    "Ranges3D",
    "RateThrust",
    "ReadSplitEvent",
    "RecognizedObject",
    "RecognizedObjectArray",
    "RecoveryStatus",
    "RegionOfInterest",
    "RelativeHumidity",
    "ReloadControllerLibraries_Request",
    "ReloadControllerLibraries_Response",
    "ReloadDockDatabase_Request",
    "ReloadDockDatabase_Response",
    "RemoveMotion_Request",
    "RemoveMotion_Response",
    "RenameRobotStateInWarehouse_Request",
    "RenameRobotStateInWarehouse_Response",
    "ResetPose_Request",
    "ResetPose_Response",
    "ResetSimulation_Request",
    "ResetSimulation_Response",
    "Reset_Request",
    "Reset_Response",
    "Resource",
    "Result",
    "ReviveTask_Request",
    "ReviveTask_Response",
    "RobotCollision",
    "RobotMode",
    "RobotModeDataMsg",
    "RobotPower_Request",
    "RobotPower_Response",
    "RobotState",
    "RobotStateEvent",
    "RobotStateRTMsg",
    "RobotTrajectory",
    "RollPitchYawrateThrust",
    "RotateAngle_Feedback",
    "RotateAngle_Goal",
    "RotateAngle_Result",
    "SEAJointState",
    "Salinity",
    "SaveMap_Request",
    "SaveMap_Response",
    "SaveRobotStateToWarehouse_Request",
    "SaveRobotStateToWarehouse_Response",
    "ScanAngle",
    "SceneEntity",
    "SelfTest_Request",
    "SelfTest_Response",
    "SensorPerformanceMetric",
    "SensorState",
    "SerializePoseGraph_Request",
    "SerializePoseGraph_Response",
    "ServiceEventInfo",
    "Session",
    "SetBool_Request",
    "SetBool_Response",
    "SetCameraInfo_Request",
    "SetCameraInfo_Response",
    "SetDatum_Request",
    "SetDatum_Response",
    "SetEntityInfo_Request",
    "SetEntityInfo_Response",
    "SetEntityPose_Request",
    "SetEntityPose_Response",
    "SetEntityPoses_Request",
    "SetEntityPoses_Response",
    "SetEntityState_Request",
    "SetEntityState_Response",
    "SetFloat_Request",
    "SetFloat_Response",
    "SetHardwareComponentState_Request",
    "SetHardwareComponentState_Response",
    "SetIO_Request",
    "SetIO_Response",
    "SetInitialPose_Request",
    "SetInitialPose_Response",
    "SetJointProperties_Request",
    "SetJointProperties_Response",
    "SetJointTrajectory_Request",
    "SetJointTrajectory_Response",
    "SetLightProperties_Request",
    "SetLightProperties_Response",
    "SetLight_Request",
    "SetLight_Response",
    "SetLinkProperties_Request",
    "SetLinkProperties_Response",
    "SetLinkState_Request",
    "SetLinkState_Response",
    "SetLoggerLevel_Request",
    "SetLoggerLevel_Response",
    "SetLoggerLevelsResult",
    "SetLoggerLevels_Request",
    "SetLoggerLevels_Response",
    "SetMapProjections_Request",
    "SetMapProjections_Response",
    "SetMap_Request",
    "SetMap_Response",
    "SetMaterialColor_Request",
    "SetMaterialColor_Response",
    "SetMavFrame_Request",
    "SetMavFrame_Response",
    "SetMode_Request",
    "SetMode_Response",
    "SetModelConfiguration_Request",
    "SetModelConfiguration_Response",
    "SetModelState_Request",
    "SetModelState_Response",
    "SetParametersAtomically_Request",
    "SetParametersAtomically_Response",
    "SetParametersResult",
    "SetParameters_Request",
    "SetParameters_Response",
    "SetPayload_Request",
    "SetPayload_Response",
    "SetPhysicsProperties_Request",
    "SetPhysicsProperties_Response",
    "SetPlannerParams_Request",
    "SetPlannerParams_Response",
    "SetPose_Request",
    "SetPose_Response",
    "SetSimulationState_Request",
    "SetSimulationState_Response",
    "SetSpeedSliderFraction_Request",
    "SetSpeedSliderFraction_Response",
    "SetSphericalCoordinates_Request",
    "SetSphericalCoordinates_Response",
    "SetStratifiedCurrentDirection_Request",
    "SetStratifiedCurrentDirection_Response",
    "SetStratifiedCurrentVelocity_Request",
    "SetStratifiedCurrentVelocity_Response",
    "SetThrusterEfficiency_Request",
    "SetThrusterEfficiency_Response",
    "SetThrusterState_Request",
    "SetThrusterState_Response",
    "SetUTMZone_Request",
    "SetUTMZone_Response",
    "SetUseGlobalCurrentVel_Request",
    "SetUseGlobalCurrentVel_Response",
    "SetWheelSlip_Request",
    "SetWheelSlip_Response",
    "SimulateSteps_Feedback",
    "SimulateSteps_Goal",
    "SimulateSteps_Result",
    "SimulationState",
    "SimulatorFeatures",
    "SingleDOFState",
    "SingleDOFStateStamped",
    "SingleJointPosition_Feedback",
    "SingleJointPosition_Goal",
    "SingleJointPosition_Result",
    "SlipStatus",
    "SmoothPath_Feedback",
    "SmoothPath_Goal",
    "SmoothPath_Result",
    "SolidPrimitive",
    "SolvePositionIK_Request",
    "SolvePositionIK_Response",
    "Sound_Request",
    "Sound_Response",
    "SpawnEntities_Request",
    "SpawnEntities_Response",
    "SpawnEntity",
    "SpawnModel_Request",
    "SpawnModel_Response",
    "SpawnResult",
    "Spawnable",
    "SpeedLimit",
    "SpeedLimitRequest",
    "SpeedLimitedLane",
    "SpeedScalingFactor",
    "Spin_Feedback",
    "Spin_Goal",
    "Spin_Result",
    "State",
    "Station",
    "StatisticDataPoint",
    "StatisticDataType",
    "Status",
    "StatusText",
    "SteeringControllerStatus",
    "StepSimulation_Request",
    "StepSimulation_Response",
    "StopStatus",
    "StratifiedCurrentDatabase",
    "StratifiedCurrentVelocity",
    "StreamRate_Request",
    "StreamRate_Response",
    "String",
    "SubmitTask_Request",
    "SubmitTask_Response",
    "SupervisorHeartbeat",
    "SwitchController_Request",
    "SwitchController_Response",
    "SysStatus",
    "TF2Error",
    "TFMessage",
    "Table",
    "TableArray",
    "TagsFilter",
    "TaskDescription",
    "TaskProfile",
    "TaskSummary",
    "TaskType",
    "Tasks",
    "Temperature",
    "TestRequest_Feedback",
    "TestRequest_Goal",
    "TestRequest_Result",
    "Test_Feedback",
    "Test_Goal",
    "Test_Result",
    "Thrust",
    "ThrusterConversionFcn",
    "Time",
    "TimeReference",
    "TimesyncStatus",
    "ToLL_Request",
    "ToLL_Response",
    "ToggleFilterProcessing_Request",
    "ToggleFilterProcessing_Response",
    "ToggleInteractive_Request",
    "ToggleInteractive_Response",
    "ToolDataMsg",
    "TorqueThrust",
    "Tow",
    "TrajectoryConstraints",
    "Transform",
    "TransformStamped",
    "Transition",
    "TransitionDescription",
    "TransitionEvent",
    "Trigger_Request",
    "Trigger_Response",
    "Twist",
    "TwistStamped",
    "TwistWithCovariance",
    "TwistWithCovarianceStamped",
    "TwoInts_Feedback",
    "TwoInts_Goal",
    "TwoInts_Request",
    "TwoInts_Response",
    "TwoInts_Result",
    "TypeDescription",
    "TypeSource",
    "UInt16",
    "UInt16MultiArray",
    "UInt32",
    "UInt32MultiArray",
    "UInt64",
    "UInt64MultiArray",
    "UInt8",
    "UInt8MultiArray",
    "UUID",
    "UVCoordinate",
    "UnderwaterObjectModel",
    "UndockRobot_Feedback",
    "UndockRobot_Goal",
    "UndockRobot_Result",
    "Undock_Feedback",
    "Undock_Goal",
    "Undock_Result",
    "UnloadController_Request",
    "UnloadController_Response",
    "UnloadWorld_Request",
    "UnloadWorld_Response",
    "UpdatePointcloudOctomap_Request",
    "UpdatePointcloudOctomap_Response",
    "UserButton",
    "UserDisplay",
    "UserLed",
    "VacuumGripperControl_Request",
    "VacuumGripperControl_Response",
    "VacuumGripperState",
    "Vector3",
    "Vector3Stamped",
    "VelocityStamped",
    "VfrHud",
    "VisibilityConstraint",
    "VisionClass",
    "VisionInfo",
    "VoxelGrid",
    "WString",
    "Wait_Feedback",
    "Wait_Goal",
    "Wait_Result",
    "WallFollow_Feedback",
    "WallFollow_Goal",
    "WallFollow_Result",
    "WaterCurrentProfile",
    "Waypoint",
    "WaypointClear_Request",
    "WaypointClear_Response",
    "WaypointList",
    "WaypointPull_Request",
    "WaypointPull_Response",
    "WaypointPush_Request",
    "WaypointPush_Response",
    "WaypointReached",
    "WaypointSetCurrent_Request",
    "WaypointSetCurrent_Response",
    "WheelDropEvent",
    "WheelMotion",
    "WheelSlip",
    "WheelStatus",
    "WheelTicks",
    "WheelVels",
    "Wind",
    "WindInfo_Request",
    "WindInfo_Response",
    "WorkspaceParameters",
    "WorldControl",
    "WorldReset",
    "WorldResource",
    "WorldState",
    "WorldStatistics",
    "Wrench",
    "WrenchStamped",
    "WriteSplitEvent",
    "action_msgs__msg__GoalStatus",
    "action_msgs__msg__GoalStatusArray",
    "action_tutorials_interfaces__action__Fibonacci_Feedback",
    "action_tutorials_interfaces__action__Fibonacci_Goal",
    "action_tutorials_interfaces__action__Fibonacci_Result",
    "actionlib_msgs__msg__GoalStatus",
    "actionlib_msgs__msg__GoalStatusArray",
    "actionlib_tutorials__action__Fibonacci_Feedback",
    "actionlib_tutorials__action__Fibonacci_Goal",
    "actionlib_tutorials__action__Fibonacci_Result",
    "apriltag_msgs__msg__Point",
    "aruco_msgs__msg__Marker",
    "aruco_msgs__msg__MarkerArray",
    "dave_gazebo_ros_plugins__srv__GetCurrentModel_Request",
    "dave_gazebo_ros_plugins__srv__GetCurrentModel_Response",
    "dave_gazebo_ros_plugins__srv__GetOriginSphericalCoord_Request",
    "dave_gazebo_ros_plugins__srv__GetOriginSphericalCoord_Response",
    "dave_gazebo_ros_plugins__srv__SetCurrentDirection_Request",
    "dave_gazebo_ros_plugins__srv__SetCurrentDirection_Response",
    "dave_gazebo_ros_plugins__srv__SetCurrentModel_Request",
    "dave_gazebo_ros_plugins__srv__SetCurrentModel_Response",
    "dave_gazebo_ros_plugins__srv__SetCurrentVelocity_Request",
    "dave_gazebo_ros_plugins__srv__SetCurrentVelocity_Response",
    "dave_gazebo_ros_plugins__srv__SetOriginSphericalCoord_Request",
    "dave_gazebo_ros_plugins__srv__SetOriginSphericalCoord_Response",
    "dave_gazebo_ros_plugins__srv__TransformFromSphericalCoord_Request",
    "dave_gazebo_ros_plugins__srv__TransformFromSphericalCoord_Response",
    "dave_gazebo_ros_plugins__srv__TransformToSphericalCoord_Request",
    "dave_gazebo_ros_plugins__srv__TransformToSphericalCoord_Response",
    "dave_interfaces__msg__DVL",
    "dave_interfaces__msg__DVLBeam",
    "diagnostic_msgs__msg__KeyValue",
    "example_interfaces__msg__Bool",
    "example_interfaces__msg__Byte",
    "example_interfaces__msg__ByteMultiArray",
    "example_interfaces__msg__Char",
    "example_interfaces__msg__Empty",
    "example_interfaces__msg__Float32",
    "example_interfaces__msg__Float32MultiArray",
    "example_interfaces__msg__Float64",
    "example_interfaces__msg__Float64MultiArray",
    "example_interfaces__msg__Int16",
    "example_interfaces__msg__Int16MultiArray",
    "example_interfaces__msg__Int32",
    "example_interfaces__msg__Int32MultiArray",
    "example_interfaces__msg__Int64",
    "example_interfaces__msg__Int64MultiArray",
    "example_interfaces__msg__Int8",
    "example_interfaces__msg__Int8MultiArray",
    "example_interfaces__msg__MultiArrayDimension",
    "example_interfaces__msg__MultiArrayLayout",
    "example_interfaces__msg__String",
    "example_interfaces__msg__UInt16",
    "example_interfaces__msg__UInt16MultiArray",
    "example_interfaces__msg__UInt32",
    "example_interfaces__msg__UInt32MultiArray",
    "example_interfaces__msg__UInt64",
    "example_interfaces__msg__UInt64MultiArray",
    "example_interfaces__msg__UInt8",
    "example_interfaces__msg__UInt8MultiArray",
    "example_interfaces__srv__SetBool_Request",
    "example_interfaces__srv__SetBool_Response",
    "example_interfaces__srv__Trigger_Request",
    "example_interfaces__srv__Trigger_Response",
    "gazebo_msgs__srv__DeleteEntity_Request",
    "gazebo_msgs__srv__DeleteEntity_Response",
    "gazebo_msgs__srv__SpawnEntity_Request",
    "gazebo_msgs__srv__SpawnEntity_Response",
    "geographic_msgs__msg__KeyValue",
    "kobuki_msgs__msg__BumperEvent",
    "kobuki_msgs__msg__CliffEvent",
    "kobuki_msgs__msg__DockInfraRed",
    "kobuki_msgs__msg__MotorPower",
    "kobuki_msgs__msg__SensorState",
    "kobuki_msgs__msg__Sound",
    "kobuki_msgs__msg__VersionInfo",
    "kobuki_msgs__msg__WheelDropEvent",
    "mav_msgs__msg__Actuators",
    "mavros_msgs__msg__State",
    "moveit_msgs__srv__LoadMap_Request",
    "moveit_msgs__srv__LoadMap_Response",
    "moveit_msgs__srv__SaveMap_Request",
    "moveit_msgs__srv__SaveMap_Response",
    "nav2_msgs__srv__LoadMap_Request",
    "nav2_msgs__srv__LoadMap_Response",
    "nav2_msgs__srv__SaveMap_Request",
    "nav2_msgs__srv__SaveMap_Response",
    "osrf_gear__msg__ConveyorBeltState",
    "osrf_gear__srv__ConveyorBeltControl_Request",
    "osrf_gear__srv__ConveyorBeltControl_Response",
    "play_motion2_msgs__srv__ListMotions_Request",
    "play_motion2_msgs__srv__ListMotions_Response",
    "play_motion_msgs__srv__ListMotions_Request",
    "play_motion_msgs__srv__ListMotions_Response",
    "rmf_fleet_msgs__msg__RobotState",
    "robot_localization__srv__GetState_Request",
    "robot_localization__srv__GetState_Response",
    "ros_gz_interfaces__srv__DeleteEntity_Request",
    "ros_gz_interfaces__srv__DeleteEntity_Response",
    "ros_gz_interfaces__srv__SpawnEntity_Request",
    "ros_gz_interfaces__srv__SpawnEntity_Response",
    "rospy_tutorials__srv__AddTwoInts_Request",
    "rospy_tutorials__srv__AddTwoInts_Response",
    "simulation_interfaces__msg__EntityState",
    "simulation_interfaces__srv__DeleteEntity_Request",
    "simulation_interfaces__srv__DeleteEntity_Response",
    "simulation_interfaces__srv__GetEntityState_Request",
    "simulation_interfaces__srv__GetEntityState_Response",
    "simulation_interfaces__srv__SetEntityState_Request",
    "simulation_interfaces__srv__SetEntityState_Response",
    "simulation_interfaces__srv__SpawnEntities_Request",
    "simulation_interfaces__srv__SpawnEntities_Response",
    "simulation_interfaces__srv__SpawnEntity_Request",
    "simulation_interfaces__srv__SpawnEntity_Response",
    "slam_toolbox__srv__SaveMap_Request",
    "slam_toolbox__srv__SaveMap_Response",
    "tf2_msgs__srv__FrameGraph_Request",
    "tf2_msgs__srv__FrameGraph_Response",
    "tf__srv__FrameGraph_Request",
    "tf__srv__FrameGraph_Response",
    "topic_tools__srv__DemuxAdd_Request",
    "topic_tools__srv__DemuxAdd_Response",
    "topic_tools__srv__DemuxDelete_Request",
    "topic_tools__srv__DemuxDelete_Response",
    "topic_tools__srv__DemuxList_Request",
    "topic_tools__srv__DemuxList_Response",
    "topic_tools__srv__DemuxSelect_Request",
    "topic_tools__srv__DemuxSelect_Response",
    "topic_tools__srv__MuxAdd_Request",
    "topic_tools__srv__MuxAdd_Response",
    "topic_tools__srv__MuxDelete_Request",
    "topic_tools__srv__MuxDelete_Response",
    "topic_tools__srv__MuxList_Request",
    "topic_tools__srv__MuxList_Response",
    "topic_tools__srv__MuxSelect_Request",
    "topic_tools__srv__MuxSelect_Response",
    "topic_tools_interfaces__srv__DemuxAdd_Request",
    "topic_tools_interfaces__srv__DemuxAdd_Response",
    "topic_tools_interfaces__srv__DemuxDelete_Request",
    "topic_tools_interfaces__srv__DemuxDelete_Response",
    "topic_tools_interfaces__srv__DemuxList_Request",
    "topic_tools_interfaces__srv__DemuxList_Response",
    "topic_tools_interfaces__srv__DemuxSelect_Request",
    "topic_tools_interfaces__srv__DemuxSelect_Response",
    "topic_tools_interfaces__srv__MuxAdd_Request",
    "topic_tools_interfaces__srv__MuxAdd_Response",
    "topic_tools_interfaces__srv__MuxDelete_Request",
    "topic_tools_interfaces__srv__MuxDelete_Response",
    "topic_tools_interfaces__srv__MuxList_Request",
    "topic_tools_interfaces__srv__MuxList_Response",
    "topic_tools_interfaces__srv__MuxSelect_Request",
    "topic_tools_interfaces__srv__MuxSelect_Response",
    "turtlebot3_msgs__msg__SensorState",
    "turtlebot3_msgs__msg__Sound",
    "turtlebot3_msgs__msg__VersionInfo",
    "turtlesim__action__RotateAbsolute_Feedback",
    "turtlesim__action__RotateAbsolute_Goal",
    "turtlesim__action__RotateAbsolute_Result",
    "turtlesim__msg__Color",
    "turtlesim__msg__Pose",
    "turtlesim__srv__Kill_Request",
    "turtlesim__srv__Kill_Response",
    "turtlesim__srv__SetPen_Request",
    "turtlesim__srv__SetPen_Response",
    "turtlesim__srv__Spawn_Request",
    "turtlesim__srv__Spawn_Response",
    "turtlesim__srv__TeleportAbsolute_Request",
    "turtlesim__srv__TeleportAbsolute_Response",
    "turtlesim__srv__TeleportRelative_Request",
    "turtlesim__srv__TeleportRelative_Response",
    "turtlesim_msgs__action__RotateAbsolute_Feedback",
    "turtlesim_msgs__action__RotateAbsolute_Goal",
    "turtlesim_msgs__action__RotateAbsolute_Result",
    "turtlesim_msgs__msg__Color",
    "turtlesim_msgs__msg__Pose",
    "turtlesim_msgs__srv__Kill_Request",
    "turtlesim_msgs__srv__Kill_Response",
    "turtlesim_msgs__srv__SetPen_Request",
    "turtlesim_msgs__srv__SetPen_Response",
    "turtlesim_msgs__srv__Spawn_Request",
    "turtlesim_msgs__srv__Spawn_Response",
    "turtlesim_msgs__srv__TeleportAbsolute_Request",
    "turtlesim_msgs__srv__TeleportAbsolute_Response",
    "turtlesim_msgs__srv__TeleportRelative_Request",
    "turtlesim_msgs__srv__TeleportRelative_Response",
    "type_description_interfaces__msg__KeyValue",
    "uuv_gazebo_ros_plugins_msgs__srv__GetModelProperties_Request",
    "uuv_gazebo_ros_plugins_msgs__srv__GetModelProperties_Response",
    "uuv_sensor_ros_plugins_msgs__msg__DVL",
    "uuv_sensor_ros_plugins_msgs__msg__DVLBeam",
    "uuv_world_ros_plugins_msgs__srv__GetCurrentModel_Request",
    "uuv_world_ros_plugins_msgs__srv__GetCurrentModel_Response",
    "uuv_world_ros_plugins_msgs__srv__GetOriginSphericalCoord_Request",
    "uuv_world_ros_plugins_msgs__srv__GetOriginSphericalCoord_Response",
    "uuv_world_ros_plugins_msgs__srv__SetCurrentDirection_Request",
    "uuv_world_ros_plugins_msgs__srv__SetCurrentDirection_Response",
    "uuv_world_ros_plugins_msgs__srv__SetCurrentModel_Request",
    "uuv_world_ros_plugins_msgs__srv__SetCurrentModel_Response",
    "uuv_world_ros_plugins_msgs__srv__SetCurrentVelocity_Request",
    "uuv_world_ros_plugins_msgs__srv__SetCurrentVelocity_Response",
    "uuv_world_ros_plugins_msgs__srv__SetOriginSphericalCoord_Request",
    "uuv_world_ros_plugins_msgs__srv__SetOriginSphericalCoord_Response",
    "uuv_world_ros_plugins_msgs__srv__TransformFromSphericalCoord_Request",
    "uuv_world_ros_plugins_msgs__srv__TransformFromSphericalCoord_Response",
    "uuv_world_ros_plugins_msgs__srv__TransformToSphericalCoord_Request",
    "uuv_world_ros_plugins_msgs__srv__TransformToSphericalCoord_Response",
    "vision_msgs__msg__Pose2D",
]
