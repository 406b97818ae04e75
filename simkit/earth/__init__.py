"""The planet that a world stands on: the air above it, its magnetic field, its ellipsoid."""
