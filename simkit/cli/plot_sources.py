"""Charts of bags, and of worlds and scenarios that are run for the chart: `simkit plot` and `simkit bag plot`."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass, replace
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Final

from simkit.cli.run_options import GivenOptions, scenario_spec
from simkit.cli.terminal.output import print_diagnostics, print_json, print_line, print_note
from simkit.errors import InputError
from simkit.number_text import counted
from simkit.run_spec import RunSpec
from simkit.writers.atomic_output import check_writable, write_atomically

if TYPE_CHECKING:
    from rosbags.typesys.store import Typestore

    from simkit.recording.charts.chart import Chart, Style
    from simkit.recording.charts.fields import Curve
    from simkit.recording.charts.series import Series
    from simkit.testing.conditions.value_series import ValueSeries


_BAGS: Final = (".mcap", ".db3")
_SCENARIOS: Final = (".yaml", ".yml")
_WORLDS: Final = (".sdf", ".world", ".urdf", ".xacro", ".xml", ".model", ".mjcf", ".erb", ".config")
_FIELDS_NAMED: Final = 3  # fields in the title of a chart
_TOPICS_LISTED: Final = 20  # topics in the error message for a plot without fields


def _world_spec(world: str) -> RunSpec:
    return scenario_spec(world, GivenOptions())


@dataclass(frozen=True)
class PlotRequest:
    """Options of a plot.

    Attributes:
        output: file to write.
        against: field for the horizontal axis instead of time.
        start, end: limits of the plotted times [s].
        title: title of the chart; empty for the fields and the sources.
        run: function that returns the run specification of a world.
    """

    output: Path
    against: str | None = None
    start: float | None = None
    end: float | None = None
    title: str = ""
    run: Callable[[str], RunSpec] = _world_spec


def is_bag(path: Path) -> bool:
    """Check whether a path is a bag."""
    if path.suffix.lower() in _BAGS:
        return True
    return path.is_dir() and ((path / "metadata.yaml").exists() or any(path.glob("*.mcap")))


def split_sources_and_fields(arguments: Sequence[str]) -> tuple[list[str], list[str]]:
    """Split arguments into sources and fields.

    The first argument is a source. Each further argument is a source if it exists or looks like one. A field is the
    path of a number in the messages of a topic, or an expression with a function, as in a condition.
    """
    sources: list[str] = list(arguments[:1])
    fields: list[str] = []
    for argument in arguments[1:]:
        path = Path(argument)
        known = path.suffix.lower() in (*_BAGS, *_SCENARIOS, *_WORLDS)
        is_name = not is_expression(argument) and "/" not in argument and "." not in argument
        (sources if known or is_name or path.exists() else fields).append(argument)
    return sources, fields


def is_expression(field: str) -> bool:
    """Check whether a field is an expression, such as `distance('a', 'b')`; no name of a topic has a bracket."""
    return "(" in field


def draw_chart(sources: Sequence[str], fields: Sequence[str], request: PlotRequest, *, json_: bool) -> None:
    """Draw fields of sources to a file.

    Raises:
        InputError: SK-BAG-010 to 012, SK-CLI-016, SK-CLI-030, SK-CLI-033, SK-CLI-035; errors of loading a world, and of
            the expressions.
    """
    from simkit.recording.charts.chart import check_suffix, render_chart

    check_suffix(request.output.name)
    check_writable(request.output)
    labels = _source_labels(sources)
    curves: list[tuple[Series, Style]] = []
    for number, source in enumerate(sources):
        prefix = f"{labels[number]}: " if len(sources) > 1 else ""
        curves += _with_styles(_series(source, fields, request), number, prefix, alone=len(sources) == 1)
    curves = [(series, style) for series, style in curves if _has_numbers(series)]
    if not curves:
        raise InputError("SK-BAG-011", "nothing to plot: the fields have no finite numbers")
    if len(sources) > 1:
        curves.sort(key=lambda pair: pair[1].colour)
    if not request.title:
        request = replace(request, title=_title(labels, fields, request.against))
    write_atomically(request.output, render_chart(_chart(curves, request), request.output.suffix))
    _summary(request.output, [series for series, _ in curves], json_=json_)


def _title(labels: Sequence[str], fields: Sequence[str], against: str | None) -> str:
    """Return the title of a chart without `--title`: its sources and its fields."""
    names = [*fields[:_FIELDS_NAMED], *(["…"] if len(fields) > _FIELDS_NAMED else [])]
    return f"{', '.join(labels)}: {', '.join(names)}{f' over {against}' if against else ''}"


def _source_labels(sources: Sequence[str]) -> list[str]:
    """Return the names of sources in the chart: their stems, if all stems differ."""
    stems = [Path(source).stem if "<" not in source else "world" for source in sources]
    return stems if len(set(stems)) == len(stems) else list(sources)


def _with_styles(series: list[Series], number: int, prefix: str, *, alone: bool) -> list[tuple[Series, Style]]:
    """Assign a colour to each field and a dash pattern to each source."""
    from simkit.recording.charts.chart import Style

    return [
        (replace(curve, label=prefix + curve.label), Style(colour, number) if not alone else Style(colour))
        for colour, curve in enumerate(series)
    ]


def _has_numbers(series: Series) -> bool:
    if not series.count:
        print_note(f"note: {series.label}: no finite numbers, left out")
    return bool(series.count)


def _chart(curves: list[tuple[Series, Style]], request: PlotRequest) -> Chart:
    from simkit.recording.charts.chart import Chart

    series = [curve for curve, _ in curves]
    # with one source, each curve has its own colour; with several, equal fields have equal colours
    label, is_plane = "time [s]", False
    if request.against is not None:
        unit = series[0].base_unit
        label = request.against + (f" [{unit}]" if unit else "")
        is_plane = unit == "m" and {curve.unit for curve in series} == {"m"}
    return Chart(series, [style for _, style in curves], request.title, label, is_plane)


def _summary(output: Path, series: list[Series], *, json_: bool) -> None:
    rows = [curve.summary() for curve in series]
    if json_:
        print_json({"output": str(output), "curves": rows})
        return
    width = max(len(str(row["label"])) for row in rows)
    for row in rows:
        unit = f" {row['unit']}" if row["unit"] else ""
        numbers = "  ".join(f"{key} {row[key]:.6g}" for key in ("min", "max", "mean", "last"))
        print_line(f"{row['label']:<{width}}  {row['count']:>7}  {numbers}{unit}")
    print_line(f"{output}: {counted(len(rows), 'curve')}")


# ---------------------------------------------------------------------- numbers of a source


def _series(source: str, fields: Sequence[str], request: PlotRequest) -> list[Series]:
    from simkit.recording.charts.series import series_over

    path = Path(source)
    read_series = _bag_series if is_bag(path) else _world_series
    plotted = list(fields) if request.against is None else [*fields, request.against]
    series_list, counts = read_series(source, plotted, request)
    if request.start is not None or request.end is not None:
        series_list = [series.between(request.start, request.end) for series in series_list]
    if request.against is None:
        return series_list
    base = series_list[-counts[-1] :]
    if len(base) != 1:
        raise InputError("SK-BAG-010", f"--against {request.against}: has {counted(len(base), 'number')}; expected 1")
    return series_over(series_list[: -counts[-1]], base[0])


def _curves(
    fields: Sequence[str], topics: Mapping[str, str], store_of: Callable[[str], Typestore], where: str
) -> tuple[list[Curve], list[int]]:
    """Return the curves of fields, and the number of curves of each field."""
    from simkit.msgs.field_units import unit_of
    from simkit.recording.charts.fields import curves_of

    if not fields:
        names = list(topics)
        listed = ", ".join(names[:_TOPICS_LISTED]) + (
            f" and {len(names) - _TOPICS_LISTED} more" if len(names) > _TOPICS_LISTED else ""
        )
        text = f"give a field to plot, such as /odom.pose.pose.position.x; {where} has {listed or 'no topics'}"
        raise InputError("SK-BAG-011", text)
    groups = [curves_of(text, topics, store_of, where, unit_of) for text in fields]
    return [curve for curves in groups for curve in curves], [len(curves) for curves in groups]


def _refuse_expressions(expressions: Sequence[str], source: str, topics: Mapping[str, str]) -> None:
    """Raise an error for expressions of a bag, which has messages but no world."""
    listed = ", ".join(list(topics)[:_TOPICS_LISTED]) or "none"
    text = f"{', '.join(expressions)}: an expression needs a running world, and {source} is a bag; its topics: {listed}"
    raise InputError(
        "SK-BAG-010", text, help="plot a field such as /odom.pose.pose.position.x, or the world of the bag"
    )


def _bag_series(source: str, fields: Sequence[str], _: PlotRequest) -> tuple[list[Series], list[int]]:
    from simkit.recording.bags.reader import open_bag_to_read
    from simkit.recording.charts.series import bag_series

    with open_bag_to_read(source) as bag:
        if bag.broken:
            print_note(f"note: {source}: {bag.broken}")
        topics = {t.name: t.type_name for t in sorted(bag.topics, key=lambda t: t.count)}
        for topic in bag.topics:
            if topic.type_name != topics[topic.name]:
                print_note(f"note: {topic.name} also has messages of type {topic.type_name}; they are left out")
        topics = dict(sorted(topics.items()))
        if expressions := [field for field in fields if is_expression(field)]:
            _refuse_expressions(expressions, source, topics)
        curves, counts = _curves(fields, topics, bag.store_of, f"the bag {source}")
        return bag_series(bag, curves), counts


def _world_series(source: str, fields: Sequence[str], request: PlotRequest) -> tuple[list[Series], list[int]]:
    from simkit import msgs
    from simkit.recording.charts.series import SeriesTap
    from simkit.testing.conditions.value_series import ValueSeries
    from simkit.testing.scenarios.scenario_run import open_scenario, run_scenario

    scenario = request.run(source)
    with ExitStack() as stack:
        sim = stack.enter_context(open_scenario(scenario))
        print_diagnostics(sim.diagnostics, verbose=False)
        topics = sim.communication.bus.topics()
        expressions = [field for field in fields if is_expression(field)]
        paths = [field for field in fields if not is_expression(field)]
        is_any = bool(paths) or not expressions
        curves, counts = _curves(paths, topics, lambda _: msgs.type_store(), scenario.title) if is_any else ([], [])
        values = stack.enter_context(ValueSeries(sim, expressions))
        tap = stack.enter_context(SeriesTap(sim, curves))
        run_scenario(scenario, sim)
    return _in_order(fields, tap.series(), counts, values)


def _in_order(
    fields: Sequence[str], of_messages: Sequence[Series], counts: Sequence[int], of_expressions: ValueSeries
) -> tuple[list[Series], list[int]]:
    """Return the series of fields in their order, and the number of series of each field."""
    from simkit.recording.charts.series import Series

    groups: list[list[Series]] = []
    rest, rest_counts = iter(of_messages), iter(counts)
    expressions = zip(of_expressions.values(), of_expressions.units(), strict=True)
    for field in fields:
        if is_expression(field):
            values, unit = next(expressions)
            is_angle = unit == "rad" and not field.endswith("pitch")
            groups.append([Series(field, unit, is_angle, times=of_expressions.times, values=values)])
        else:
            groups.append(list(islice(rest, next(rest_counts))))
    return [series for group in groups for series in group], [len(group) for group in groups]
