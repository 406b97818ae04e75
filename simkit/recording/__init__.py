"""What a run leaves (bags, charts, pictures, exported tables), and what plays commands back into a run."""
