"""MuJoCo's own format, MJCF, as a world or as a model."""
