"""Inertial measurement units, one by one and in batches, and the frames that their orientation is measured against.

Velocities and accelerations of MuJoCo's bodies enter; `Imu` messages leave. A batch changes no bit of a message.
"""
