"""SDF 1.0 to 1.12: one file per concept of the format."""
