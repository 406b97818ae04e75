"""What of a file has no effect: names that the format does not have, and those that mean nothing here.

What is known, and what becomes of it, is the tables' (`simkit.loaders.sdf.element_table`) to say.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import partial

from simkit.diagnostics import Diagnostics, Where, did_you_mean
from simkit.loaders.sdf.element_table import Use, sdf_elements
from simkit.params import Params

# Programs that write SDF give every joint axes; that of a fixed or ball joint says nothing about it.
_LEFT_OVER = frozenset(("axis", "axis2"))
_MAX_REPORTED = 500


def report_unread(root: Params, place: str = "sdf") -> None:
    """Says what in a tree has no effect: a warning for each unknown name, one note for Gazebo's own settings.

    Args:
        place: the table that describes the tree's root.
    """
    report = _UnreadReport(root.diagnostics)
    report.visit(root, place, ())
    quiet = sorted(report.quiet.items(), key=lambda item: item[1].line or 0)
    if quiet:
        listed = ", ".join(f"<{name}> (line {where.line})" for name, where in quiet)
        message = f"settings of Gazebo's without effect here: {listed}"
        root.diagnostics.note("SK-SDF-010", message, Where(quiet[0][1].file))


@dataclass
class _UnreadReport:
    """One walk over a tree; `quiet` keeps the first place of each setting without effect."""

    diagnostics: Diagnostics
    quiet: dict[str, Where] = field(default_factory=dict)
    said: int = 0

    def warn(self, code: str, where: Where, say: Callable[[], tuple[str, str]]) -> None:
        """One warning, its text and hint; a file with more of them than anybody reads is told so once."""
        self.said += 1
        if self.said <= _MAX_REPORTED:
            text, hint = say()
            self.diagnostics.warning(code, text, where, hint)
        elif self.said == _MAX_REPORTED + 1:
            text = f"more than {_MAX_REPORTED} names without effect; the rest of the file's are not listed"
            self.diagnostics.warning("SK-SDF-011", text, where)

    def visit(self, element: Params, place: str, above: tuple[str, ...]) -> None:
        """Everything inside an element that a reader has read."""
        elements = sdf_elements()
        if not elements.is_open(place):
            if element.attributes:
                self._attributes(element, place)
            if element.value and elements.elements(place) and not elements.has_text(place):
                self.warn("SK-SDF-038", element.where, partial(_of_text, element, place))
        read, inside = elements.read_elements(place), (*above, place)
        for child in element.children:
            known = read.get(child.name)
            if known is not None and child.was_read:
                if child.children or child.attributes or elements.elements(known):
                    self.visit(child, known, inside)
            elif ":" not in child.name:
                self._child(child, element, place, above)
            elif child.name.endswith(":include"):
                self.warn("SK-SDF-011", child.where, partial(_of_xinclude, child))

    def _child(self, child: Params, element: Params, place: str, above: tuple[str, ...]) -> None:
        """An element that nobody has read."""
        row = sdf_elements().row(place, child.name)
        if row is None:
            if not sdf_elements().is_open(place):
                self.warn("SK-SDF-011", child.where, partial(_of_unknown, child, element, place, above))
        elif row.use is Use.IGNORED:
            self.quiet.setdefault(child.name, child.where)
        elif row.use is Use.NOT_SIMULATED:
            self.warn("SK-SDF-012", child.where, lambda: (f"<{child.name}>: {row.becomes}", ""))
        elif child.name in _LEFT_OVER:
            self.quiet.setdefault(child.name, child.where)
        else:
            self.warn("SK-SDF-011", child.where, partial(_of_unused, child, element))

    def _attributes(self, element: Params, place: str) -> None:
        for name in element.attributes:
            if ":" not in name and name != "xmlns" and sdf_elements().row(place, f"@{name}") is None:
                self.warn("SK-SDF-037", element.where, partial(_of_attribute, name, element, place))


def _of_unknown(child: Params, element: Params, place: str, above: tuple[str, ...]) -> tuple[str, str]:
    return f"<{child.name}> is not known in <{element.name}> and not used", _hint(child, element, place, above)


def _of_unused(child: Params, element: Params) -> tuple[str, str]:
    """An element that has a meaning, though not here."""
    first = next(c for c in element.children if c.name == child.name)
    if first is not child and first.was_read:
        return f"<{element.name}> has another <{child.name}> (line {first.where.line}); this one is not used", ""
    return f"<{child.name}> has no meaning in this <{element.name}> and is not used", ""


def _of_attribute(name: str, element: Params, place: str) -> tuple[str, str]:
    hint = did_you_mean(name, sdf_elements().attributes(place))
    if name in sdf_elements().elements(place):
        hint = f"it is an element: <{name}>{element.attributes[name]}</{name}>"
    return f"{name}= of <{element.name}> is not known and not used", hint


def _of_text(element: Params, place: str) -> tuple[str, str]:
    """Text between elements, where a file means a value and nobody reads one."""
    shown = element.value if len(element.value) <= 40 else element.value[:40] + "..."
    names = ", ".join(f"<{name}>" for name in sdf_elements().elements(place)[:6])
    return f"the text {shown!r} in <{element.name}> is not used", f"it holds elements: {names}, ..."


def _of_xinclude(child: Params) -> tuple[str, str]:
    return f"<{child.name}> is not read: another file comes in by <include>, as SDF has it", ""


def _hint(child: Params, element: Params, place: str, above: Iterable[str]) -> str:
    """Where an unknown element belongs, or which name was meant."""
    if child.name in sdf_elements().attributes(place):
        return f"it is an attribute: <{element.name} {child.name}={child.value!r}>"
    homes = [
        h for h in sdf_elements().places_with(child.name) if (row := sdf_elements().row(h, child.name)) and row.use.read
    ]
    inside = [home for home in homes if home.rpartition("/")[0] == place or home in _content(place)]
    outside = [home for home in homes if home in above]
    for home in (*inside, *reversed(outside)):
        return f"move it inside <{_tag(home)}>"
    near = did_you_mean(child.name, sdf_elements().elements(place))
    if near or not homes or len(homes) > 6:
        return near
    return "it belongs inside " + " or ".join(f"<{_tag(home)}>" for home in homes[:3])


def _content(place: str) -> set[str]:
    """The tables that describe an element's children."""
    rows = (sdf_elements().row(place, name) for name in sdf_elements().elements(place))
    return {row.like for row in rows if row is not None and row.like}


def _tag(place: str) -> str:
    return place.rpartition("/")[2].removeprefix("saved ")
