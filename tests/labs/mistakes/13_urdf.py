"""Typical mistakes of the lab `13_urdf`."""

MISTAKES = {
    "takes the diameter for the radius": (
        "has the inertias of its shapes, to 1 %",
        "macros.xacro",
        'izz="${mass * radius**2 / 2}"',
        'izz="${mass * (2 * radius)**2 / 2}"',
    ),
    "turns the axis of a wheel with its shape": (
        "drives 0.6 m straight ahead",
        "macros.xacro",
        """      <axis xyz="0 1 0"/>""",
        """      <axis xyz="0 ${1 if side == 'left' else -1} 0"/>""",
    ),
    "writes the radius of the wheels as a number": (
        "stands level on wheels and caster",
        "robot.urdf.xacro",
        'value="$(arg wheel_radius)"',
        'value="0.06"',
    ),
}
