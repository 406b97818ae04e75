"""Systems of gz-sim."""
