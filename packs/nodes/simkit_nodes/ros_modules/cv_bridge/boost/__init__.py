"""Functions of `cv_bridge` that ROS has in C++."""

__all__: list[str] = []
