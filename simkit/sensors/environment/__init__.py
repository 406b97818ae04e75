"""Sensors of the environment (air, magnetic field, satellites, sun) and the models of it that they read.

The pose of a sensor, the world's `<spherical_coordinates>`, atmosphere and lights enter; messages, and numbers for
plugins, leave. The models (`atmosphere`, `magnetic_field`, `geodesy`, `illumination`, `solar_irradiance`) know no
sensor.
"""
