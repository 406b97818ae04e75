"""What plugins that command joints share: one axis, a PID, servos, trajectories, the trees that joints lie in.

Targets enter, efforts leave, within the limits of each joint. No topic is opened here but by `JointCommander`.
"""
