"""For who writes plugins: what a plugin's code says of itself, skeletons of new ones, reloading in a run."""
