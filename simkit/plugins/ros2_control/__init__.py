"""ros2_control in the simulation: hardware interfaces, controllers and the controller manager that runs them."""
