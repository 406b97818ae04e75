"""`<gazebo>`: what the robot's file says to Gazebo about links, joints and the whole robot."""

from __future__ import annotations

from collections.abc import Iterable

from simkit.diagnostics import Diagnostics, did_you_mean
from simkit.loaders.urdf.element_attributes import extension_boolean, extension_numbers, extension_text, text_attribute
from simkit.params import Params


class GazeboExtensions:
    """All `<gazebo>` blocks of a robot; those with one reference count as one, in document order.

    Attributes:
        robot: the blocks without a reference, as one.
        kinds: what each reference names, "link" or "joint", once that is known.
    """

    def __init__(self, robot: Params, diagnostics: Diagnostics) -> None:
        self.diagnostics = diagnostics
        self._blocks: dict[str, list[Params]] = {}
        for block in robot.all("gazebo"):
            self._blocks.setdefault(text_attribute(block, "reference"), []).append(block)
        self._merged = {name: _merge_blocks(blocks) for name, blocks in self._blocks.items()}
        self.robot = self.of("")
        self.kinds: dict[str, str] = {}

    def of(self, name: str) -> Params:
        """What is said about a link or joint; an empty block where nothing is."""
        return self._merged.get(name) or Params("gazebo", diagnostics=self.diagnostics)

    def report_unknown(self, links: Iterable[str], joints: Iterable[str]) -> None:
        """Warns about each reference to nothing; Gazebo passes over it in silence."""
        self.kinds = {**dict.fromkeys(joints, "joint"), **dict.fromkeys(links, "link")}
        names = list(self.kinds)
        for name, blocks in self._blocks.items():
            if name and name not in names:
                for block in blocks:
                    block.mark_all_read()
                message = f"<gazebo reference={name!r}>: there is no link or joint of that name; it has no effect"
                self.diagnostics.warning("SK-URDF-021", message, blocks[0].where, did_you_mean(name, names))

    @property
    def merged(self) -> dict[str, Params]:
        """Each reference's blocks as one, for the report on what nobody read."""
        return dict(self._merged)


def _merge_blocks(blocks: list[Params]) -> Params:
    first = blocks[0]
    children = [child for block in blocks for child in block.children]
    return Params("gazebo", "", {}, children, first.where, first.diagnostics)


def last_child(block: Params, *names: str) -> Params | None:
    """The last child of one of these names: of several blocks the later has the last word."""
    found = [child for name in names for child in block.all(name)]
    return max(found, key=lambda c: c.where.line or 0) if found else None


def read_flag(block: Params, *names: str) -> bool | None:
    """A true or false; None where nothing is said."""
    found = last_child(block, *names)
    return None if found is None else extension_boolean(found)


def read_number(block: Params, *names: str, minimum: float | None = None) -> float | None:
    """A number; None where nothing (or, with an error recorded, nothing usable) is said."""
    found = last_child(block, *names)
    values = None if found is None else extension_numbers(found, 1)
    if found is None or values is None:
        return None
    if minimum is not None and values[0] < minimum:
        message = f"<{found.name}> is {values[0]:g}, it must be at least {minimum:g}"
        found.diagnostics.error("SK-URDF-013", message, found.where)
        return None
    return values[0]


def read_vector(block: Params, name: str) -> tuple[float, float, float] | None:
    """Three numbers; None where nothing usable is said."""
    found = last_child(block, name)
    values = None if found is None else extension_numbers(found, 3)
    return None if values is None else (values[0], values[1], values[2])


def read_word(block: Params, name: str) -> str:
    """A text; empty where nothing is said."""
    found = last_child(block, name)
    return "" if found is None else extension_text(found)
