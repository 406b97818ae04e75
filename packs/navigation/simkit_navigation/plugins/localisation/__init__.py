"""Plugins that estimate the pose of a robot: in a map by scans (`amcl`), and by odometry and IMU (`ekf_node`)."""
