"""Sensors of the environment (air, magnetic field, satellites, sun) and the models that they measure.

Inputs are the pose of a sensor and the world's `<spherical_coordinates>`, atmosphere and lights. Outputs are messages,
and numbers for plugins. The models (`atmosphere`, `magnetic_field`, `geodesy`, `illumination`, `solar_irradiance`) do
not depend on a sensor.
"""
