"""Typical mistakes of the lab `06_localisation`."""

MISTAKES = {
    "moves along the axes of the map": (
        "finds its position to 10 cm",
        "localise.py",
        "way = poses[:, 2] + first",
        "way = first + 0 * poses[:, 2]",
    ),
    "draws as many particles as before": (
        "needs few particles once it knows its place",
        "localise.py",
        "        number = LEAST\n",
        "        number = MOST\n",
    ),
    "never doubts": (
        "finds itself again after it was carried away",
        "localise.py",
        "< 1 - self.fast / self.slow",
        "< 0 * self.slow",
    ),
}
