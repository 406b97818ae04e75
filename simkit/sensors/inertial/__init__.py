"""Inertial measurement units, alone and in batches, and the reference frames of their orientation.

Inputs are the velocities and accelerations of MuJoCo's bodies. Outputs are `Imu` messages. A batch changes no bit of a
message.
"""
