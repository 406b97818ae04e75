"""Motions that a robot knows by name."""

from __future__ import annotations

from simkit.codes import Code, Example
from simkit.codes.sketch import INERTIAL, command, model, world

_ELBOW = (
    '<joint name="elbow" type="revolute"><parent>base</parent><child>arm</child>\n'
    "  <axis><xyz>0 0 1</xyz><limit><lower>-1</lower><upper>1</upper><velocity>0.5</velocity></limit></axis>\n</joint>"
)


def _arm(plugins: str = "") -> str:
    return f'<link name="base">{INERTIAL}</link>\n<link name="arm">{INERTIAL}</link>\n{_ELBOW}\n{plugins}'


_PLAYER = (
    '<plugin filename="libsimkit_play_motion.so" name="play_motion2">\n  <motions>motions.yaml</motions>\n</plugin>'
)
_CONTROL = (
    '<plugin filename="libgazebo_ros2_control.so" name="control"><parameters>controllers.yaml</parameters></plugin>'
)
_CONTROLLERS = (
    "controller_manager:\n  ros__parameters:\n"
    "    arm_controller: {type: joint_trajectory_controller/JointTrajectoryController}\n"
    "arm_controller:\n  ros__parameters: {joints: [elbow], command_interfaces: [position], "
    "state_interfaces: [position, velocity]}\n"
)


def _motions(body: str) -> str:
    lines = "".join(f"      {line}\n" for line in body.splitlines())
    return f"play_motion2:\n  ros__parameters:\n    motions:\n{lines}"


def _with(body: str) -> Example:
    """An arm whose file of motions has these."""
    return model(_arm(_PLAYER), files={"motions.yaml": _motions(body)})


_BEND = "bend: {joints: [elbow], positions: [0.5], times_from_start: [1.0]}"
_FILES = {
    "arm.sdf": f'<sdf version="1.9"><world name="w"><model name="arm">{_arm(_PLAYER + _CONTROL)}</model></world></sdf>',
    "bare.sdf": f'<sdf version="1.9"><world name="w"><model name="arm">{_arm()}</model></world></sdf>',
    "controllers.yaml": _CONTROLLERS,
    "motions.yaml": _motions(f"{_BEND}\nfar: {{joints: [elbow], positions: [2.0], times_from_start: [1.0]}}"),
}

CODES: tuple[Code, ...] = (
    Code(
        "SK-MOTION-001",
        "warning, error",
        "a file of motions is not found",
        "the folder of its package is named with `--package-path NAME=DIR`, or the file lies beside the robot's",
        model(_arm(_PLAYER)),
    ),
    Code(
        "SK-MOTION-002",
        "warning",
        "a motion of a file is none: a key is missing, numbers do not fit the joints and times, or times do not rise; "
        "it is left out, the others stay",
        "",
        _with("bend: {joints: [elbow], positions: [0.5, 0.1], times_from_start: [1.0]}"),
    ),
    Code(
        "SK-MOTION-003",
        "warning",
        "a file of motions has none",
        "motions stand in a block `motions` below the name of a node",
        model(_arm(_PLAYER), files={"motions.yaml": "play_motion2:\n  ros__parameters: {approach_velocity: 0.3}\n"}),
    ),
    Code(
        "SK-MOTION-004",
        "warning",
        "a motion cannot be played by this robot: it names a joint that is not there, or leaves the limits of one",
        "the closest joint, or what is allowed, is said",
        _with("bend: {joints: [elbow], positions: [1.5], times_from_start: [1.0]}"),
    ),
    Code(
        "SK-MOTION-005",
        "note",
        "a motion takes longer than its file says, because a joint would be faster than its limit",
        "",
        _with("bend: {joints: [elbow], positions: [0.0, 0.9], times_from_start: [0.5, 1.0]}"),
    ),
    Code(
        "SK-MOTION-006",
        "warning",
        "a key of a motion, a setting beside the motions, or a joint in one, that is not used",
        "the closest one is given",
        _with("bend: {joints: [elbow], positions: [0.5], times_from_start: [1.0], mta: {name: Bend}}"),
    ),
    Code(
        "SK-MOTION-007",
        "note",
        "a robot plays motions under its own name, because another one has the names that it would have",
        "give each a namespace: `<ros><namespace>left</namespace></ros>` in the plugin",
        world(
            "".join(f'<model name="{name}">\n{_arm(_PLAYER)}\n</model>\n' for name in ("left", "right")),
            files={"motions.yaml": _motions(_BEND)},
        ),
    ),
    Code(
        "SK-MOTION-010",
        "error",
        "`simkit motion` has no robot that plays motions, or more than one to choose from",
        "`--motions FILE.yaml` gives a robot its motions, `--model NAME` chooses one",
        command("simkit motion play bend --world bare.sdf", _FILES),
    ),
    Code(
        "SK-MOTION-011",
        "error",
        "the robot knows no motion of that name",
        "the closest one is given; `simkit motion list` names them all",
        command("simkit motion play bned --world arm.sdf", _FILES),
    ),
    Code(
        "SK-MOTION-012",
        "error",
        "a motion was refused, or did not get to its end; why is said: limits, links that would collide, a controller",
        "`--skip-planning` plays it without looking whether anything is in the way",
        command("simkit motion play far --world arm.sdf", _FILES),
    ),
)
