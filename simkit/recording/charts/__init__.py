"""Charts that show numbers in messages over time.

`fields` resolves names of message fields, and `series` reads their numbers from a bag or a simulation. `chart` draws
SVG or PNG files, and `page_chart` draws SVG for an HTML page. Equal numbers give equal bytes.
"""
