"""Rendering: draws the visuals of a simulation through the one OpenGL context of the process.

A MuJoCo model, its data and a view enter; arrays of colours, depths and geom ids leave. Nothing here knows sensors,
messages or noise.
"""
