"""Sensors of vehicles in water and wind."""
