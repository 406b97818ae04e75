"""Pack for navigation: maps, localisation, filters of odometry, and the servers of Nav2."""
