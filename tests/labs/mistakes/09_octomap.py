"""Typical mistakes of the lab `09_octomap`."""

MISTAKES = {
    "takes the rotation the wrong way round": (
        "has at least 95 % of the table",
        "mapper.py",
        "points @ rotation.T + position",
        "points @ rotation + position",
    ),
    "takes each leaf, also the free ones": (
        "has at most 1 % of the free cells",
        "mapper.py",
        "tree.isNodeOccupied(leaf) and x > 0.45",
        "x > 0.45",
    ),
    "gives the planner no boxes": (
        "touches nothing on the way",
        "mapper.py",
        '"id": "octomap", "primitives": shapes, "primitive_poses": poses',
        '"id": "octomap", "primitives": shapes[:1], "primitive_poses": poses[:1]',
    ),
}
