"""What the plugins that move robots share: wheels, odometry, held velocities."""
