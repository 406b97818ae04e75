"""Report on elements without effect: names that are unknown in SDF, and elements that simkit does not use.

The tables in `simkit.loaders.sdf.element_table` define the known names and their use.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import partial

from simkit.diagnostics import Diagnostics, Where, did_you_mean
from simkit.loaders.sdf.element_table import Use, sdf_elements
from simkit.params import Params

# Programs that write SDF give axes to every joint; the axis of a fixed or ball joint has no effect.
_LEFT_OVER = frozenset(("axis", "axis2"))
_MAX_REPORTED = 500


def report_unread(root: Params, place: str = "sdf") -> None:
    """Report elements without effect in a tree: a warning for each unknown name, one note for Gazebo's settings.

    Args:
        root: root of the tree.
        place: table that describes the root.
    """
    report = _UnreadReport(root.diagnostics)
    report.visit(root, place, ())
    settings = sorted(report.ignored_settings.items(), key=lambda item: item[1].line or 0)
    if settings:
        listed = ", ".join(f"<{name}> (line {where.line})" for name, where in settings)
        message = f"Gazebo's own settings, without effect in simkit: {listed}"
        root.diagnostics.note("SK-SDF-010", message, Where(settings[0][1].file))


@dataclass
class _UnreadReport:
    """Report on one tree; `ignored_settings` holds the first place of each setting without effect."""

    diagnostics: Diagnostics
    ignored_settings: dict[str, Where] = field(default_factory=dict)
    count: int = 0

    def warn(self, code: str, where: Where, make_message: Callable[[], tuple[str, str]]) -> None:
        """Record one warning with text and hint; after 500 warnings, one last warning replaces the remaining ones."""
        self.count += 1
        if self.count <= _MAX_REPORTED:
            text, hint = make_message()
            self.diagnostics.warning(code, text, where, hint)
        elif self.count == _MAX_REPORTED + 1:
            text = f"more than {_MAX_REPORTED} names without effect; the others are not listed"
            self.diagnostics.warning("SK-SDF-011", text, where)

    def visit(self, element: Params, place: str, above: tuple[str, ...]) -> None:
        """Check everything inside an element that a reader has read."""
        elements = sdf_elements()
        if not elements.is_open(place):
            if element.attributes:
                self._attributes(element, place)
            if element.value and elements.elements(place) and not elements.has_text(place):
                self.warn("SK-SDF-038", element.where, partial(_text_message, element, place))
        read, inside = elements.read_elements(place), (*above, place)
        for child in element.children:
            known = read.get(child.name)
            if known is not None and child.was_read:
                if child.children or child.attributes or elements.elements(known):
                    self.visit(child, known, inside)
            elif ":" not in child.name:
                self._child(child, element, place, above)
            elif child.name.endswith(":include"):
                self.warn("SK-SDF-011", child.where, partial(_xinclude_message, child))

    def _child(self, child: Params, element: Params, place: str, above: tuple[str, ...]) -> None:
        """Report an element that was not read."""
        row = sdf_elements().row(place, child.name)
        if row is None:
            if not sdf_elements().is_open(place):
                self.warn("SK-SDF-011", child.where, partial(_unknown_message, child, element, place, above))
        elif row.use is Use.IGNORED:
            self.ignored_settings.setdefault(child.name, child.where)
        elif row.use is Use.NOT_SIMULATED:
            self.warn("SK-SDF-012", child.where, lambda: (f"<{child.name}>: {row.becomes}", ""))
        elif child.name in _LEFT_OVER:
            self.ignored_settings.setdefault(child.name, child.where)
        else:
            self.warn("SK-SDF-011", child.where, partial(_unused_message, child, element))

    def _attributes(self, element: Params, place: str) -> None:
        for name in element.attributes:
            if ":" not in name and name != "xmlns" and sdf_elements().row(place, f"@{name}") is None:
                self.warn("SK-SDF-037", element.where, partial(_attribute_message, name, element, place))


def _unknown_message(child: Params, element: Params, place: str, above: tuple[str, ...]) -> tuple[str, str]:
    return f"<{element.name}> has no element <{child.name}>; it is ignored", _hint(child, element, place, above)


def _unused_message(child: Params, element: Params) -> tuple[str, str]:
    """Return text and hint for an element of the format that has no effect in this place."""
    first = next(c for c in element.children if c.name == child.name)
    if first is not child and first.was_read:
        return f"<{element.name}> already has a <{child.name}> (line {first.where.line}); this one is ignored", ""
    return f"<{child.name}> has no effect in this <{element.name}>", ""


def _attribute_message(name: str, element: Params, place: str) -> tuple[str, str]:
    hint = did_you_mean(name, sdf_elements().attributes(place))
    if name in sdf_elements().elements(place):
        hint = f"write it as an element: <{name}>{element.attributes[name]}</{name}>"
    return f"<{element.name}> has no attribute {name}=; it is ignored", hint


def _text_message(element: Params, place: str) -> tuple[str, str]:
    """Return text and hint for text between elements, which is not read."""
    shown = element.value if len(element.value) <= 40 else element.value[:40] + "..."
    names = ", ".join(f"<{name}>" for name in sdf_elements().elements(place)[:6])
    return f"the text {shown!r} in <{element.name}> is ignored", f"put it into one of its elements: {names}, ..."


def _xinclude_message(child: Params) -> tuple[str, str]:
    return f"<{child.name}> is not supported", "use SDF's own <include>"


def _hint(child: Params, element: Params, place: str, above: Iterable[str]) -> str:
    """Suggest the place of an unknown element, or the closest name."""
    if child.name in sdf_elements().attributes(place):
        return f"write it as an attribute: <{element.name} {child.name}={child.value!r}>"
    places = [
        p for p in sdf_elements().places_with(child.name) if (row := sdf_elements().row(p, child.name)) and row.use.read
    ]
    inside = [p for p in places if p.rpartition("/")[0] == place or p in _content(place)]
    outside = [p for p in places if p in above]
    for parent in (*inside, *reversed(outside)):
        return f"move it inside <{_tag(parent)}>"
    near = did_you_mean(child.name, sdf_elements().elements(place))
    if near or not places or len(places) > 6:
        return near
    return "move it inside " + " or ".join(f"<{_tag(parent)}>" for parent in places[:3])


def _content(place: str) -> set[str]:
    """Return the tables that describe an element's children."""
    rows = (sdf_elements().row(place, name) for name in sdf_elements().elements(place))
    return {row.like for row in rows if row is not None and row.like}


def _tag(place: str) -> str:
    return place.rpartition("/")[2].removeprefix("saved ")
