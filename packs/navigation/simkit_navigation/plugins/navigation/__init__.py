"""Common to the servers of Nav2: parameters, classes of users, velocity commands and planar poses."""
