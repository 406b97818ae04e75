"""Sensors in joints and on surfaces: contact, encoder, and force and torque.

Inputs are the joint positions, joint wrenches and contacts of the physics. Outputs are `JointState`, `WrenchStamped`
and `Contacts` messages. These sensors exert no force on a joint.
"""
