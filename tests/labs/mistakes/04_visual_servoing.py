"""Typical mistakes of the lab `04_visual_servoing`."""

MISTAKES = {
    "looks at the hue alone": (
        "finds the ball to 2 pixels",
        "ball.py",
        "(5, 170, 60)",
        "(5, 60, 60)",
    ),
    "keeps the gain of the start": (
        "both errors decay with the new rate after the gain was changed",
        "follow.py",
        "-self.gain.value *",
        "-0.5 *",
    ),
    "forgets that the camera turns with the arm": (
        "all errors decay with the rate gain, within 10 %",
        "arm.py",
        "interaction @ self.camera_jacobian()",
        "interaction[:, :3] @ self.camera_jacobian()[:3]",
    ),
    "forgets the friction of the motors": (
        "turns at least at wz_min outside of the dead zone",
        "course_law.py",
        "max(self.kp.value * abs(error), self.wz_min.value)",
        "self.kp.value * abs(error)",
    ),
}
