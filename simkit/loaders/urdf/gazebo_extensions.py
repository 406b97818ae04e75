"""`<gazebo>`: Gazebo's settings of links, joints and the whole robot."""

from __future__ import annotations

from collections.abc import Container, Iterable

from simkit.diagnostics import Diagnostics, did_you_mean
from simkit.loaders.urdf.element_attributes import extension_boolean, extension_numbers, text_attribute
from simkit.params import Params
from simkit.scene.geometry import Vec3, vec3


class GazeboExtensions:
    """All `<gazebo>` blocks of a robot; blocks with the same reference are joined in document order.

    Attributes:
        merged: joined blocks by reference.
        robot: joined blocks without a reference.
        kinds: kind of each referenced element, "link" or "joint", once this is known.
    """

    def __init__(self, robot: Params, diagnostics: Diagnostics) -> None:
        self.diagnostics = diagnostics
        self._blocks: dict[str, list[Params]] = {}
        for block in robot.all("gazebo"):
            self._blocks.setdefault(text_attribute(block, "reference"), []).append(block)
        self.merged = {name: _merge_blocks(blocks) for name, blocks in self._blocks.items()}
        self.robot = self.of("")
        self.kinds: dict[str, str] = {}

    def of(self, name: str) -> Params:
        """Return the block of a link or joint; an empty block if there is none."""
        return self.merged.get(name) or Params("gazebo", diagnostics=self.diagnostics)

    def report_unknown(self, links: Iterable[str], joints: Iterable[str], faulty: Container[str]) -> None:
        """Warn about each reference to an unknown name; Gazebo ignores such references without a message.

        Args:
            links: names of the links.
            joints: names of the joints.
            faulty: names of elements whose errors were reported.
        """
        self.kinds = {**dict.fromkeys(joints, "joint"), **dict.fromkeys(links, "link")}
        names = list(self.kinds)
        for name, blocks in self._blocks.items():
            if name and name not in names:
                for block in blocks:
                    block.mark_all_read()
                if name in faulty:
                    continue
                message = f"<gazebo reference={name!r}>: no link or joint has this name; it has no effect"
                blocks[0].warning("SK-URDF-021", message, did_you_mean(name, names))


def _merge_blocks(blocks: list[Params]) -> Params:
    first = blocks[0]
    children = [child for block in blocks for child in block.children]
    return Params("gazebo", "", {}, children, first.where, first.diagnostics)


def last_child(block: Params, *names: str) -> Params | None:
    """Return the last child with one of these names, because a later block overrides an earlier one."""
    children = [child for name in names for child in block.all(name)]
    return max(children, key=lambda c: c.where.line or 0) if children else None


def read_flag(block: Params, *names: str) -> bool | None:
    """Return a boolean, or None if the file gives none."""
    element = last_child(block, *names)
    return None if element is None else extension_boolean(element)


def read_number(block: Params, *names: str, minimum: float | None = None) -> float | None:
    """Return a number; None if the file gives none or, with an error recorded, an invalid one."""
    element = last_child(block, *names)
    values = None if element is None else extension_numbers(element, 1)
    if element is None or values is None:
        return None
    if minimum is not None and values[0] < minimum:
        element.error("SK-URDF-013", f"<{element.name}> is {values[0]:g}; it must be at least {minimum:g}")
        return None
    return values[0]


def read_vector(block: Params, name: str) -> Vec3 | None:
    """Return three numbers; None if the file gives none or, with an error recorded, invalid ones."""
    element = last_child(block, name)
    values = None if element is None else extension_numbers(element, 3)
    return None if values is None else vec3(values)
