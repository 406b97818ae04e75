"""Handles of the entities of a simulation: Model, Link, Joint, Light, Visual.

- Input: scoped names, poses, velocities and efforts.
- Output: readings of the state at the present tick.
- Not known here: stepping, messages, and MuJoCo objects across a spawn, because handles are bound to each new
  structure.
"""
