"""Charts of numbers in messages over time.

Names of fields and a bag or a running simulation enter (`fields`, `series`); SVG or PNG leaves, as a file (`chart`) or
for a page (`page_chart`). Equal numbers give equal bytes.
"""
