"""Graphs of nodes and topics, and of frames, as SVG: `layered_layout` finds the places, `graph_svg` draws them."""
