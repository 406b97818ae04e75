"""Handles of the entities of a simulation: Model, Link, Joint, Light, Visual.

What enters: scoped names, poses, velocities, efforts. What leaves: readings of the state at the present tick. What
never: stepping, messages, and MuJoCo objects that a spawn makes stale, since handles are bound anew to each structure.
"""
