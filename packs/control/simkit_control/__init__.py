"""Pack for control: `ros2_control` and `ros_control` with their hardware, controllers and services."""
