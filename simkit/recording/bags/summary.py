"""Summary of a bag, as `ros2 bag info` prints it."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from simkit.recording.bags.reader import BagReader

_NS = 1_000_000_000
_INDENT = " " * 19
_SERVICE_EVENTS = "/_service_event"


def bag_text(bag: BagReader) -> str:
    """Return the lines of `ros2 bag info`. Times are in UTC; simulated times count from 1970."""
    files = f"\n{_INDENT}".join(bag.files)
    topics = [t for t in bag.topics if not t.name.endswith(_SERVICE_EVENTS)]
    rows = f"\n{_INDENT}".join(
        _line(f"Topic: {t.name} | Type: {t.type_name} | Count: {t.count} | Serialization Format: {t.format}")
        for t in topics
    )
    services = [t for t in bag.topics if t.name.endswith(_SERVICE_EVENTS)]
    events = f"\n{' ' * 21}".join(
        _line(
            f"Service: {t.name.removesuffix(_SERVICE_EVENTS)} | Type: {t.type_name.removesuffix('_Event')} | "
            f"Event Count: {t.count} | Serialization Format: {t.format}"
        )
        for t in services
    )
    return "\n".join(
        (
            "",
            f"Files:             {files}",
            f"Bag size:          {_size(bag.size)}",
            f"Storage id:        {bag.storage}",
            f"ROS Distro:        {bag.distro}",
            f"Duration:          {_seconds(bag.end - bag.start)}s",
            f"Start:             {_moment(bag.start)}",
            f"End:               {_moment(bag.end)}",
            f"Messages:          {bag.count}",
            f"Topic information: {rows}",
            f"Services:          {len(services)}",
            f"Service information: {events}",
            "",
        )
    )


def _line(text: str) -> str:
    """Return a text on one line. A name with a line feed would look like two topics."""
    return text.replace("\n", "\\n")


def bag_summary(bag: BagReader) -> dict[str, object]:
    """Return the summary as plain values; times in seconds."""
    return {
        "path": str(bag.path),
        "files": bag.files,
        "size": bag.size,
        "storage": bag.storage,
        "ros_distro": bag.distro,
        "start": bag.start / _NS,
        "end": bag.end / _NS,
        "duration": (bag.end - bag.start) / _NS,
        "messages": bag.count,
        "complete": not bag.broken,
        "topics": [
            {"name": t.name, "type": t.type_name, "count": t.count, "latched": t.latched, "format": t.format}
            for t in bag.topics
        ],
    }


def _size(count: int) -> str:
    """Format a number of bytes in the binary unit that fits."""
    if count < 1024:
        return f"{count} B"
    size, units = count / 1024, ["KiB", "MiB", "GiB", "TiB"]
    while size >= 1024 and len(units) > 1:
        size /= 1024
        units.pop(0)
    return f"{size:.1f} {units[0]}"


def _seconds(ns: int) -> str:
    return f"{ns // _NS}.{ns % _NS:09d}"


def _moment(ns: int) -> str:
    """Format a time as date and time, then as seconds since 1970."""
    try:
        at = time.gmtime(ns // _NS)
    except (OverflowError, OSError, ValueError):
        return f"({_seconds(ns)})"
    month = ("Jan", "Feb", "Mar", "Apr", "May", "Jun", "Jul", "Aug", "Sep", "Oct", "Nov", "Dec")[at.tm_mon - 1]
    clock = f"{at.tm_hour:02d}:{at.tm_min:02d}:{at.tm_sec:02d}.{ns % _NS:09d}"
    return f"{month} {at.tm_mday:2d} {at.tm_year} {clock} ({_seconds(ns)})"
