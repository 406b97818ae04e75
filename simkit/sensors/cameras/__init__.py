"""Cameras: one file per kind, with optics, noise and messages; `rendering` draws the images.

Inputs are a `<sensor>` with a `<camera>` block and the simulation. Outputs are `Image`, `CameraInfo`, point clouds,
labels and boxes. Only `rendering` uses OpenGL, and images without a reader are not drawn.
"""
