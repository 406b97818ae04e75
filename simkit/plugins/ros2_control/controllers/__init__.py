"""The controllers of ros2_controllers and of TIAGo, one module for each kind."""
