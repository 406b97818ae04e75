"""Charts: numbers of message fields over time, drawn as SVG or PNG."""
