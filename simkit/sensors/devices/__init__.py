"""Sensors in joints and on surfaces: contact, encoder, force and torque.

Joint positions, joint wrenches and contacts of the physics enter; `JointState`, `WrenchStamped` and `Contacts` messages
leave. None of them acts on a joint.
"""
