"""Typical mistakes of the lab `08_kinematics`."""

MISTAKES = {
    "moves straight": (
        "no link touches another",
        "arm.py",
        "    path = connect(arm, start, goal, random)\n",
        "    path = [start, goal]\n",
    ),
    "turns about the axis in the joint's own frame": (
        "reaches the pose to 2 mm and 0.5 degrees",
        "arm.py",
        "axis = frame.rotation @ joint.axis",
        "axis = joint.axis",
    ),
    "forgets where a joint is placed": (
        "knows where its tool is",
        "arm.py",
        "        pose = pose * joint.placement\n        frames.append(pose)\n",
        "        frames.append(pose)\n",
    ),
}
