"""Cameras: one file for each kind, with their optics, noise and messages; `rendering` draws the pictures.

A `<sensor>` with a `<camera>` block and the simulation enter; `Image`, `CameraInfo`, point clouds, labels and boxes
leave. Only `rendering` touches OpenGL, and no picture is drawn that nobody reads.
"""
