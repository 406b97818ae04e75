"""Pack for robots: plugins that only one kind of robot or device uses."""
