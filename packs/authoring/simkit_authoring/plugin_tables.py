"""Tables of a plugin's parameters, topics, services and actions, for the terminal and for the site."""

from __future__ import annotations

from simkit.extend import counted
from simkit_authoring.plugin_facts import Facts, Parameter, Service, Topic


def tables_of(facts: Facts) -> dict[str, list[tuple[str, ...]]]:
    """Return the rows of each table of a plugin by its title, without empty tables.

    A row of the parameters has the name (indented by two spaces for each block around it), the type, the default, the
    unit and notes; a row of the other tables has the name, the types and notes.
    """
    tables = {
        "parameters": [_parameter_row(p) for p in facts.parameters],
        "publishes": [_topic_row(t) for t in facts.topics if t.published],
        "subscribes to": [_topic_row(t) for t in facts.topics if not t.published],
        "services": [_service_row(s) for s in facts.services if not s.is_action],
        "actions": [_service_row(s) for s in facts.services if s.is_action],
    }
    return {title: rows for title, rows in tables.items() if rows}


def _parameter_row(p: Parameter) -> tuple[str, ...]:
    kind = counted(p.size, "number") if p.kind == "vector" and p.size else {"vector": "numbers"}.get(p.kind, p.kind)
    notes = [_range(p), "one of " + ", ".join(map(repr, p.choices)) if p.choices else ""]
    notes += ["repeatable" if p.repeated else "", "live" if p.live else "", p.says]
    depth = "  " * (len(p.path) - 1)
    return depth + p.path[-1], kind or "(taken)", _default(p), p.unit, "; ".join(filter(None, notes))


def _range(p: Parameter) -> str:
    if p.minimum is not None and p.maximum is not None:
        return f"{p.minimum:g} to {p.maximum:g}"
    if p.minimum is not None:
        return f"at least {p.minimum:g}"
    return f"at most {p.maximum:g}" if p.maximum is not None else ""


def _default(p: Parameter) -> str:
    if p.required:
        return "required"
    if isinstance(p.default, bool):
        shown = str(p.default).lower()
    elif isinstance(p.default, tuple):
        shown = " ".join(_number(v) for v in p.default)
    elif isinstance(p.default, (int, float)):
        shown = _number(p.default)
    else:
        shown = str(p.default or "")
    if p.instead:
        shown = f"<{'>, else <'.join(p.instead)}>" + (f", else {shown}" if shown else "")
    return shown


def _number(value: object) -> str:
    return f"{value:g}" if isinstance(value, float) else str(value)


def _topic_row(t: Topic) -> tuple[str, ...]:
    notes = ["latched" if t.latched else "", "named by " + _in_brackets(t.elements) if t.elements else ""]
    return t.name, " or ".join(t.types), "; ".join(filter(None, notes))


def _service_row(s: Service) -> tuple[str, ...]:
    return s.name, s.type, "named by " + _in_brackets(s.elements) if s.elements else ""


def _in_brackets(names: tuple[str, ...]) -> str:
    return ", ".join(f"<{name}>" for name in names)
