"""Wheeled bases, velocity control, odometry."""

from __future__ import annotations

from simkit.codes import Code
from simkit.codes.sketch import INERTIAL, model

_LINKS = "\n".join(f'<link name="{name}">{INERTIAL}</link>' for name in ("base", "wheel"))
_MOVE = '<plugin filename="libgazebo_ros_planar_move.so" name="move"/>'


def _wheel(kind: str, limits: str = "") -> str:
    axis = f"<axis><xyz>0 1 0</xyz>{limits}</axis>"
    return f'<joint name="axle" type="{kind}">\n  <parent>base</parent><child>wheel</child>{axis}\n</joint>'


def _drive(wheel: str, right: str) -> str:
    """A drive whose left wheel is `axle`, and the joint of the right one."""
    return (
        f'{_LINKS}\n<link name="other">{INERTIAL}</link>\n{wheel}\n'
        '<joint name="other_axle" type="continuous">\n  <parent>base</parent><child>other</child>'
        "<axis><xyz>0 1 0</xyz></axis>\n</joint>\n"
        '<plugin filename="gz-sim-diff-drive-system" name="gz::sim::systems::DiffDrive">\n'
        f"  <left_joint>axle</left_joint><right_joint>{right}</right_joint>\n</plugin>"
    )


CODES: tuple[Code, ...] = (
    Code(
        "SK-PLUGIN-050",
        "error",
        "a drive names one joint as two wheels",
        "each wheel has a joint of its own",
        model(_drive(_wheel("continuous"), "axle")),
    ),
    Code(
        "SK-PLUGIN-051",
        "error",
        "a drive names a joint as a wheel that does not turn",
        "a wheel's joint is revolute or continuous",
        model(_drive(_wheel("prismatic"), "other_axle")),
    ),
    Code(
        "SK-PLUGIN-052",
        "warning",
        "a wheel's joint has limits: it stops there",
        'make it `type="continuous"`, or leave `<lower>` and `<upper>` out',
        model(_drive(_wheel("revolute", "<limit><lower>-1.57</lower><upper>1.57</upper></limit>"), "other_axle")),
    ),
    Code(
        "SK-PLUGIN-053",
        "warning",
        "a plugin is to move a model or a link that is joined to the world, and cannot",
        "leave out the joint to the world",
        model(
            f'<link name="base">{INERTIAL}</link>\n'
            '<joint name="anchor" type="fixed"><parent>world</parent><child>base</child></joint>\n'
            f"{_MOVE}"
        ),
    ),
    Code(
        "SK-PLUGIN-054",
        "warning",
        "the frame that a true pose is to be told in is no link of the model: the pose is that in the world",
        "name a link, or `world`",
        model(
            f'<link name="base">{INERTIAL}</link>\n<plugin filename="libgazebo_ros_p3d.so" name="truth">\n'
            "  <body_name>base</body_name><frame_name>bse</frame_name>\n</plugin>"
        ),
    ),
)
