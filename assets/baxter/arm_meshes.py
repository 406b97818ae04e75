"""The shapes of arm and gripper, in the frames of their links.

Of a link whose joint lies along the arm, z points to the hand and x to the elbow's offset; of the others, x points to
the hand and z is the joint's axis.
"""

from __future__ import annotations

from links import LENGTH, WIDTH
from solids import Mesh, along_x, along_y, barrel, block, disc, hull, moved, rectangle, slab, stack


def upper_shoulder() -> list[Mesh]:
    body = stack((disc(0.066), 0.075), (disc(0.068), 0.15), (rectangle((-0.045, -0.058), (0.125, 0.058), 0.04), 0.26))
    return [*body, hull((rectangle((-0.045, -0.058), (0.125, 0.058), 0.04), 0.26), (disc(0.05, 0.05), 0.325))]


def upper_shoulder_motor() -> list[Mesh]:
    return [barrel(0.075, 0.0, 0.075, 0.01), moved(along_y(barrel(0.058, -0.072, 0.072, 0.008)), 0.069, 0, 0.27035)]


def lower_shoulder() -> list[Mesh]:
    return [along_x(hull((disc(0.060), 0.02), (disc(0.066), 0.075), (disc(0.064), 0.095)))]


def lower_shoulder_motor() -> list[Mesh]:
    return [barrel(0.06, -0.05, 0.05, 0.008), along_x(barrel(0.062, 0.092, 0.104, 0.002))]


def upper_elbow() -> list[Mesh]:
    """The upper arm; the elbow's axis lies below it."""
    return stack(
        (disc(0.063), 0.004),
        (disc(0.067), 0.06),
        (disc(0.060, 0.012), 0.16),
        (rectangle((-0.035, -0.052), (0.115, 0.052), 0.045), 0.245),
        (rectangle((-0.010, -0.050), (0.115, 0.050), 0.045), 0.305),
    )


def upper_elbow_motor() -> list[Mesh]:
    return [moved(along_y(barrel(0.055, -0.066, 0.066, 0.008)), 0.069, 0, 0.26242)]


def lower_elbow() -> list[Mesh]:
    return [along_x(hull((disc(0.050), 0.02), (disc(0.056), 0.075), (disc(0.054), 0.092)))]


def lower_elbow_motor() -> list[Mesh]:
    return [barrel(0.052, -0.045, 0.045, 0.008), along_x(barrel(0.052, 0.090, 0.105, 0.002))]


def upper_forearm() -> list[Mesh]:
    return stack(
        (disc(0.053), 0.004),
        (disc(0.057), 0.06),
        (disc(0.049), 0.18),
        (rectangle((-0.045, -0.040), (0.050, 0.040), 0.03), 0.255),
        (rectangle((-0.030, -0.040), (0.050, 0.040), 0.03), 0.310),
    )


def upper_forearm_motor() -> list[Mesh]:
    return [moved(along_y(barrel(0.046, -0.054, 0.054, 0.006)), 0.01, 0, 0.2707)]


def lower_forearm() -> list[Mesh]:
    return [along_x(hull((disc(0.042), 0.02), (disc(0.048), 0.075), (disc(0.046), 0.108)))]


def lower_forearm_motor() -> list[Mesh]:
    return [barrel(0.044, -0.036, 0.036, 0.006), along_x(barrel(0.044, 0.106, 0.118, 0.002))]


def wrist() -> list[Mesh]:
    return [hull((disc(0.045), 0.004), (disc(0.047), 0.03), (disc(0.044), 0.06))]


def wrist_motor() -> list[Mesh]:
    return [barrel(0.041, 0.058, 0.078, 0.003)]


def hand_cuff() -> list[Mesh]:
    """The cuff that a person holds, with the camera beside it."""
    eye = hull((disc(0.012, 0.038, 0.012), -0.012), (disc(0.012, 0.038, 0.012), 0.010), (disc(0.02), -0.02))
    return [*stack((disc(0.043), -0.036), (disc(0.048), -0.016), (disc(0.038), 0.0)), eye]


def gripper_palm() -> list[Mesh]:
    return stack(
        (disc(0.034), -0.025),
        (rectangle((-0.034, -0.050), (0.034, 0.050), 0.02), -0.010),
        (rectangle((-0.030, -0.062), (0.030, 0.062), 0.012), 0.012),
    )


def gripper_rail() -> list[Mesh]:
    return [slab(rectangle((-0.014, -0.060), (0.014, 0.060), 0.004), 0.012, 0.0195)]


def finger(sign: int) -> list[Mesh]:
    """Carriage on the rail, and the blade."""
    middle = sign * WIDTH
    wide = rectangle((-0.005, middle - 0.00675), (0.005, middle + 0.00675), 0.002)
    thin = rectangle((-0.005, middle - 0.004), (0.005, middle + 0.004), 0.002)
    carriage = block((-0.010, sign * -0.003 - 0.025, 0.0), (0.010, sign * -0.003 + 0.025, 0.0168))
    return [hull((wide, 0.002), (wide, 0.05), (thin, LENGTH)), carriage]


def paddle(sign: int) -> list[Mesh]:
    middle = sign * -0.0045
    return [block((-0.021, middle - 0.00325, -0.0335), (0.021, middle + 0.00325, 0.0035))]
