"""Pack with the bridge between a running simulation and ROS 2, in a process of its own.

The bridge process is a client of the simulation's socket on one side and a user of rclpy on the other. It may run in
another Python than the simulation, so these modules need only the standard library until `ros_session` imports rclpy.
`bridge_process` is the only module that the simulation's process uses.
"""
