"""Rendering: draws the visuals of a simulation with the one OpenGL context of the process.

Inputs are a MuJoCo model, its data and a view. Outputs are arrays of colours, depths and geom ids. This folder does not
depend on sensors, messages or noise.
"""
