"""Pages of the reference that are made from the code: names of Python, commands, plugins, messages, codes."""

from __future__ import annotations

import ast
import importlib
import json
import posixpath
import re
from collections.abc import Container, Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any

from site_pages import ROOT, github_anchor, outside_fences, repository_pages

_MOMENT = (
    "moment.Moment",
    *(f"moment_contents.{name}" for name in ("MomentContents", "TouchingPair", "JointLoad", "ConstraintError")),
)

_HANDLES = {
    "Simulation": ("A running simulation, which `simkit.load` returns.", ("simkit.Simulation",)),
    "Models, links, joints": (
        "Handles of a simulation: `sim.model(…)`, `sim.link(…)`, `sim.joint(…)`, `sim.light(…)`, `sim.visual(…)`.",
        ("simkit.Model", "simkit.Link", "simkit.Joint", "simkit.Light", "simkit.Visual"),
    ),
    "Sensors: sim.sensor": (
        "`sim.sensor(name)` returns a sensor. Its class depends on the kind; each has the names below, for example "
        "`sensor.latest` and `sensor.truth`. [The pages of the kinds](../../docs/sensors/index.md) show their "
        "readings. `sensor.capture` is for authors of sensors: [Sensor](simkit.extend.sensors.md) has all methods.",
        ("simkit.sensors.base.Sensor",),
    ),
    "World and contacts: sim.world, sim.contacts": (
        "`sim.world` describes the world as it was read. `sim.contacts()` returns the present contacts, "
        "`sim.wheel_slips()` the slip of the wheels, and `sim.why()` [explains the "
        "moment](../../packs/verification/docs/commands/why.md).",
        (
            "simkit.scene.world.SceneWorld",
            "simkit.runtime.contact.collision_contacts.Contact",
            "simkit.runtime.contact.rim_slip.WheelSlip",
            *(f"simkit.runtime.moment.{name}" for name in _MOMENT),
        ),
    ),
    "Plugins": (
        "Base classes of plugins ([writing a plugin](../../docs/writing_a_plugin.md)), and the elements of a "
        "`<plugin>`. All have the names of `simkit.Plugin`.",
        (
            *("simkit.Plugin", "simkit.ModelPlugin", "simkit.WorldPlugin", "simkit.SensorPlugin"),
            *("simkit.VisualPlugin", "simkit.Params"),
        ),
    ),
    "Topics and frames: sim.subscribe, sim.tf": (
        "`sim.advertise(…)` returns a publisher, `sim.subscribe(…)` a subscription, `sim.tf` the frames.",
        (
            "simkit.Publisher",
            "simkit.Subscription",
            "simkit.DeferredResponse",
            "simkit.runtime.communication.transform_buffer.TransformBuffer",
        ),
    ),
}
"""Pages for objects of a simulation: title -> introduction and names."""

_MODULES = (
    *("msgs", "testing", "recording", "live", "gym", "errors", "pose", "progress"),
    *("elementary_functions", "float_sum", "linear_algebra", "matrix_decompositions"),
)

_WITHOUT_INHERITED_NAMES = (
    *("simkit.ModelPlugin", "simkit.WorldPlugin", "simkit.SensorPlugin", "simkit.VisualPlugin"),
    *("simkit.extend.VectorSensor", "simkit.extend.LidarMeasurement", "simkit.extend.ImuMeasurement"),
    *("simkit.extend.NavSat", "simkit.extend.MessageArtefact"),
)
_NAMES_OF_A_SENSOR = ["topic", "topics", "latest", "truth", "pose", "set_rate", "noise", "options", "capture"]
_OPTIONS: dict[str, dict[str, object]] = {
    "simkit.sensors.base.Sensor": {"members": _NAMES_OF_A_SENSOR},
    **{name: {"inherited_members": False} for name in _WITHOUT_INHERITED_NAMES},
}
"""Options of mkdocstrings for names whose base class has its own entry, or whose other names are not for scripts."""


def public_names(module: str) -> list[str]:
    """Return the public names of a module of simkit: `__all__`, else its classes and functions."""
    tree = ast.parse(_module_file(module).read_text(encoding="utf-8"))
    for node in tree.body:
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "__all__":
            names: list[str] = ast.literal_eval(node.value)
            return names
    kinds = (ast.ClassDef, ast.FunctionDef)
    found = [node.name for node in tree.body if isinstance(node, kinds) and not node.name.startswith("_")]
    return list(dict.fromkeys(found))  # overloads have one name


def _module_file(module: str) -> Path:
    path = ROOT.joinpath(*module.split("."))
    return path / "__init__.py" if path.is_dir() else path.with_suffix(".py")


def python_pages() -> dict[str, tuple[str, str]]:
    """Return title and text of each page of public names by its path."""
    pages = {}
    shown: set[str] = set()
    for title, (introduction, names) in _HANDLES.items():
        pages[_path("python", title.partition(":")[0])] = (
            title.partition(":")[0],
            _python_page(title, introduction, names),
        )
        shown.update(names)
    rest = [f"simkit.{name}" for name in public_names("simkit") if f"simkit.{name}" not in shown]
    rest = [name for name in rest if not name.endswith("__")]
    text = _python_page("simkit", "Functions, values and errors that `import simkit` gives.", rest)
    first = {_path("python", "simkit"): ("simkit", text)}
    for module in _MODULES:
        name = f"simkit.{module}"
        docstring = ast.get_docstring(ast.parse(_module_file(name).read_text(encoding="utf-8"))) or ""
        introduction = _with_blocks(docstring)
        names = tuple(f"{name}.{each}" for each in public_names(name))
        pages[_path("python", name)] = (module, _python_page(name, introduction, names))
    return {**first, **pages, **_extend_pages()}


def _extend_pages() -> dict[str, tuple[str, str]]:
    """Return a page for each section of docs/extend.md: its sentences, and the names of its table."""
    narrative = (ROOT / "docs" / "extend.md").read_text(encoding="utf-8")
    names = public_names("simkit.extend")
    pages = {}
    for section in re.split(r"^## ", narrative, flags=re.MULTILINE)[1:]:
        title, _, text = section.partition("\n")
        rows = re.findall(r"^\| (.+?) \|", text, flags=re.MULTILINE)
        shown = [name for row in rows for name in re.findall(r"`(\w+)`", row) if name in names]
        if shown:
            introduction = (
                f"Names of `simkit.extend`: {title[0].lower()}{title[1:]} ([examples](../../docs/extend.md))."
            )
            path = _path("python", f"simkit.extend.{title}")
            pages[path] = (
                f"extend: {title[0].lower()}{title[1:]}",
                _python_page(title, introduction, [f"simkit.extend.{name}" for name in shown]),
            )
    return pages


def _python_page(title: str, introduction: str, names: Iterable[str]) -> str:
    return "\n\n".join([f"# {title}", introduction, *map(_directive, names)]) + "\n"


def _directive(name: str) -> str:
    """Return the line of mkdocstrings for a name. A class that users get only from a handle has no module before it."""
    options = dict(_OPTIONS.get(name, {}))
    if internal := _internal_names(name):
        options["filters"] = ["!^_[^_]", f"!^({'|'.join(internal)})$"]
    if name.count(".") >= 3:
        options["heading"] = name.rpartition(".")[2]
    lines = [f"      {option}: {json.dumps(value)}" for option, value in options.items()]
    return "\n".join([f"::: {name}", *(["    options:"] if lines else []), *lines])


def _internal_names(name: str) -> list[str]:
    """Return the names of a handle's class that only simkit's own code uses."""
    if not any(name in names for _, names in _HANDLES.values()):
        return []
    module, _, attribute = name.rpartition(".")
    return sorted(getattr(getattr(importlib.import_module(module), attribute), "_internal_names", ()))


def _with_blocks(docstring: str) -> str:
    """Return a module's docstring with its lines of Python, indented or not, as blocks of code."""
    paragraphs = []
    for paragraph in re.split(r"\n\s*\n", docstring):
        lines = paragraph.splitlines()
        is_code = lines[0].startswith("    ") or re.match(r"(from|import) \w|with |\w+ = |.*\.\w+\(.*\)$", lines[0])
        text = "\n".join(line.removeprefix("    ") for line in lines) if lines[0].startswith("    ") else paragraph
        paragraphs.append(f"```python\n{text}\n```" if is_code else paragraph)
    return "\n\n".join(paragraphs)


def command_pages() -> dict[str, tuple[str, str]]:
    """Return title and text of a page for each command, with the texts of `--help`, by its path."""
    import typer

    from simkit.cli import app

    root: Any = typer.main.get_command(app)
    context = root.context_class(root, info_name="simkit")
    narrative = {Path(page).stem: page for page in repository_pages() if "/commands/" in page}
    pages = {}
    for name in root.list_commands(context):
        command = root.get_command(context, name)
        text = "\n".join(_command_lines(getattr(command, "real", command), name, context, 1))
        if name in narrative:
            text = text.replace("\n\n", f"\n\n[Description and examples](../../{narrative[name]})\n\n", 1)
        pages[_path("commands", name)] = (f"simkit {name}", text)
    return pages


def with_options_link(markdown: str, path: str, made: Container[str]) -> str:
    """Return a page of a command with a link below its title to its page among the made ones, other pages unchanged."""
    options = _path("commands", Path(path).stem)
    if "/commands/" not in path or options not in made:
        return markdown
    target = posixpath.relpath(options, posixpath.dirname(path))
    return markdown.replace("\n\n", f"\n\n[All options]({target})\n\n", 1)


def _command_lines(command: Any, name: str, parent: Any, level: int) -> Iterator[str]:
    """Yield the lines of Markdown for a command and the commands of its group."""
    context = command.context_class(command, info_name=name, parent=parent)
    yield f"{'#' * level} {context.command_path}\n"
    usage = command.get_usage(context).removeprefix("Usage: ")
    yield f"```text\n{' '.join(usage.split())}\n```\n"
    for paragraph in (command.help or "").replace("\b", "").split("\n\n"):
        yield f"{_plain(paragraph)}\n"
    records = [(parameter, parameter.get_help_record(context)) for parameter in command.get_params(context)]
    rows = [
        f"| {_code(record[0])} | {_plain(_one_line(record[1]))} |"
        for _, record in records
        if record is not None and not record[0].startswith("--help")
    ]
    if rows:
        yield "| argument or option | meaning |\n|---|---|"
        yield from rows
        yield ""
    if hasattr(command, "commands"):
        for each in command.list_commands(context):
            yield from _command_lines(command.get_command(context, each), each, context, level + 1)


def message_pages() -> dict[str, tuple[str, str]]:
    """Return title and text of a page for each package of messages that plugins and sensors publish or receive."""
    from simkit.msgs.interface_definitions import interface_text

    users = _users_of_messages()
    pages = {}
    for package in sorted({type_name.split("/")[0] for type_name in users}):
        lines = [f"# {package}\n"]
        for type_name in sorted(name for name in users if name.startswith(f"{package}/")):
            lines.append(f"## {type_name.rpartition('/')[2]}\n\n`{type_name}`\n")
            lines += [f"{verb} by {_listed(names)}.\n" for verb, names in users[type_name].items()]
            lines.append(f"```text\n{interface_text(type_name).expandtabs(4)}\n```\n")
        lines.append("`simkit interface show TYPE` prints every other type, also of services and actions.\n")
        pages[_path("messages", package)] = (package, "\n".join(lines))
    return pages


def _users_of_messages() -> dict[str, dict[str, set[str]]]:
    """Return the plugins and sensors of each message type: type -> `Published` or `Received` -> names."""
    import simkit
    from simkit_authoring.catalogue import facts_of, known_plugins

    found: dict[str, dict[str, set[str]]] = {}
    for entry in known_plugins():
        for topic in facts_of(entry.cls).topics:
            for type_name in topic.types:
                if re.fullmatch(r"\w+/msg/\w+", type_name):  # else a placeholder: the world's file has the type
                    verbs = found.setdefault(type_name, {})
                    verbs.setdefault("Published" if topic.published else "Received", set()).add(entry.cls.__name__)
    with simkit.load("sensor_bench") as sim:  # one sensor of each kind
        for sensor in sim.sensors.values():
            for product in sensor.products().values():
                found.setdefault(product.type_name, {}).setdefault("Published", set()).add(sensor.kind)
        for type_name in sim.topics().values():
            found.setdefault(type_name, {})
    return found


def plugin_pages() -> dict[str, tuple[str, str]]:
    """Return title and text of a page for each group of plugins, with all parameters and topics, by its path."""
    from simkit_authoring.catalogue import known_plugins

    groups: dict[str, list[Any]] = {}
    for entry in known_plugins():
        if entry.origin == "simkit":
            groups.setdefault(_plugin_group(entry.cls.__module__), []).append(entry)
    introduction = (
        "Elements, topics, services and actions of each plugin, as `simkit plugin info NAME` prints them. "
        "`{model}`, `{robot}` and names like these in braces stand for the name of the model or the value of an "
        "element. [All plugins](../../docs/catalogue.md) has one line for each.\n"
    )
    pages = {}
    for title in sorted(groups):
        sections = [line for entry in groups[title] for line in _plugin_lines(entry)]
        pages[_path("plugins", title)] = (title, "\n".join([f"# Plugins: {title}\n", introduction, *sections]))
    return pages


def _plugin_group(module: str) -> str:
    """Return the title of the page for the plugins in a module: the simulator, or the pack."""
    package, *folders = module.split(".")
    if package == "simkit":
        return {"gz": "Gazebo Sim", "classic": "Gazebo Classic"}.get(folders[1], "simkit")
    title = package.removeprefix("simkit_").replace("_", " ").capitalize()
    families = {"uuv": ", uuv_simulator", "classic": ", Gazebo Classic", "gz": ", Gazebo Sim"}
    return title + families.get(folders[1], "")


def _plugin_heading(entry: Any) -> str:
    """Return the shortest name of a plugin that a file can use."""
    return str(entry.names[0] if entry.names else entry.cls.__name__)


def _plugin_lines(entry: Any) -> Iterator[str]:
    """Yield the lines of Markdown for a plugin."""
    from simkit_authoring.catalogue import facts_of
    from simkit_authoring.plugin_tables import tables_of

    parents = " or a ".join(entry.parents).replace("any", "model, world, sensor or visual")
    yield f"## {_plugin_heading(entry)}\n\n`{entry.cls.__name__}`, on a {parents}. {_plain(entry.summary)}\n"
    names = [name for name in entry.names[1:] if "ignition" not in name and not name.startswith("lib")]
    if names:
        yield f"Other names: {', '.join(f'`{name}`' for name in names)}.\n"
    heads = {"parameters": ("element", "type", "default", "unit", "")}
    for title, rows in tables_of(facts_of(entry.cls)).items():
        head = heads.get(title, (title, "type", ""))
        yield f"| {' | '.join(head)} |\n|{'---|' * len(head)}"
        for name, *cells in rows:
            depth = "· " * ((len(name) - len(name.lstrip())) // 2)
            yield f"| {depth}{_code(name.lstrip())} | {' | '.join(map(_plain, cells))} |"
        yield ""


def plugin_anchors() -> dict[str, str]:
    """Return the page and the heading (`page#heading`) of each plugin by every name that a file can use."""
    from simkit_authoring.catalogue import known_plugins

    return {
        name: f"{_path('plugins', _plugin_group(entry.cls.__module__))}#{github_anchor(_plugin_heading(entry), '-')}"
        for entry in known_plugins()
        if entry.origin == "simkit"
        for name in entry.names
    }


def with_plugin_links(markdown: str, path: str, anchors: Mapping[str, str]) -> str:
    """Return a page in which the first mention of each plugin leads to its elements and topics in the reference.

    Below a heading that names plugins, a line has these links.
    """
    linked: set[str] = set()

    def link(name: str) -> str:
        linked.add(name)
        return f"[`{name}`]({posixpath.relpath(anchors[name], posixpath.dirname(path))})"

    def named(text: str) -> list[str]:
        return [name for name in re.findall(r"`([^`]+)`", text) if name in anchors]

    def in_paragraph(paragraph: str) -> str:
        if paragraph.startswith("#"):
            links = ", ".join(link(name) for name in named(paragraph))
            return paragraph + (f"\n\nAll elements and topics: {links}\n" if links else "")
        for name in named(paragraph):
            if name not in linked and (found := re.search(rf"(?<!\[)`{re.escape(name)}`(?!\])", paragraph)):
                paragraph = paragraph[: found.start()] + link(name) + paragraph[found.end() :]
        return paragraph

    return outside_fences(markdown, in_paragraph)


def _listed(names: Iterable[str]) -> str:
    """Return names as a list in code; of more than eight, the first ones and their number."""
    ordered = sorted(names)
    more = f" and {len(ordered) - 8} more" if len(ordered) > 8 else ""
    return ", ".join(f"`{name}`" for name in ordered[:8]) + more


def _one_line(text: str) -> str:
    return " ".join(text.split())


def _code(text: str) -> str:
    """Return the names of an option as code; `|` would end the cell of a table."""
    return f"`{text}`".replace("|", "¦")


def _plain(text: str) -> str:
    """Return a text for a terminal as Markdown that shows it unchanged."""
    parts = re.split(r"(`[^`]+`)", text)
    return "".join(
        part if part.startswith("`") else re.sub(r"([\\*_>|\[\]])", r"\\\1", part).replace("<", "&lt;")
        for part in parts
    )


def diagnostic_pages() -> dict[str, tuple[str, str]]:
    """Return title and text of a page for each area of diagnostic codes by its path; the first is the introduction."""
    from simkit.cli.diagnostic_catalogue import page

    introduction, *areas = re.split(r"^## ", page(), flags=re.MULTILINE)
    pages = {}
    rows = ["| area | codes |", "|---|---|"]
    for area in areas:
        title, _, text = area.partition("\n")
        codes = re.findall(r"^### (SK-\S+)$", text, flags=re.MULTILINE)
        path = _path("diagnostics", title)
        text = re.sub(r"\]\((?!#|https?:)", "](../../docs/", text)  # links are relative to the folder docs
        pages[path] = (title, f"# {title}\n" + text.replace("\n### ", "\n## "))
        rows.append(f"| [{title}](../{path}) | {_range_of(codes)} |")
    first = introduction.replace("This page is generated", "These pages are generated")
    return {"docs/diagnostics.md": ("Diagnostics", first + "\n" + "\n".join(rows) + "\n"), **pages}


def _range_of(codes: list[str]) -> str:
    """Return the first and the last code of each prefix as text."""
    by_prefix: dict[str, list[str]] = {}
    for code in codes:
        by_prefix.setdefault(code.rpartition("-")[0], []).append(code)
    return ", ".join(f"`{c[0]}`" + (f" to `{c[-1]}`" if len(c) > 1 else "") for c in by_prefix.values())


def generated_pages() -> Mapping[str, tuple[str, str]]:
    """Return title and text of all generated pages by their paths."""
    return {**python_pages(), **command_pages(), **plugin_pages(), **message_pages(), **diagnostic_pages()}


def _path(folder: str, title: str) -> str:
    return f"reference/{folder}/{re.sub(r'[^a-z0-9.]+', '_', title.lower()).strip('_')}.md"
