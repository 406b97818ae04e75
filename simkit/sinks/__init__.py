"""What leaves a simulation: bags, progress, pictures; and commands that go in. Each is imported when asked for."""
