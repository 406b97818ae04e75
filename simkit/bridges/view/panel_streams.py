"""Streams of the panels for plots, log messages, parameters and graphs."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Final

from simkit.bridges.view.graph_streams import GRAPH_STREAMS
from simkit.bridges.view.series_stream import SERIES_STREAMS
from simkit.bridges.view.topic_streams import TOPIC_STREAMS

PANEL_STREAMS: Final[dict[str, Callable[[Any, str], Any]]] = {**SERIES_STREAMS, **TOPIC_STREAMS, **GRAPH_STREAMS}
"""Streams by the first part of their name."""
