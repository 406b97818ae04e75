"""URDF, with Gazebo's extensions: one file per concept of the format."""
