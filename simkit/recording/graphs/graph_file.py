"""Files of graphs: SVG and PDF."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from simkit.errors import InputError
from simkit.recording.graphs.graph_pdf import graph_pdf
from simkit.recording.graphs.graph_svg import GraphBox, GraphEdge, graph_svg
from simkit.writers.atomic_output import check_writable, write_atomically


def check_graph_file(output: Path) -> None:
    """Check that a graph can be written to a file.

    Raises:
        InputError: SK-CLI-016 the suffix of the file is not .svg or .pdf.
    """
    if output.suffix.lower() not in (".svg", ".pdf"):
        suffix = output.suffix or "no suffix"
        raise InputError("SK-CLI-016", f"cannot write {output}: found {suffix}; expected .svg or .pdf")
    check_writable(output)


def write_graph(output: Path, title: str, boxes: Sequence[GraphBox], edges: Sequence[GraphEdge]) -> None:
    """Write a graph as SVG or PDF, as the suffix of the file says."""
    if output.suffix.lower() == ".pdf":
        write_atomically(output, graph_pdf(title, boxes, edges))
    else:
        write_atomically(output, graph_svg(title, boxes, edges).encode())
