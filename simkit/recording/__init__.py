"""What a run leaves, and what plays it back: bags, charts, pictures, exported tables, scripted commands.

A running simulation or a bag enters; files leave, as a whole or not at all. Recording listens and never changes what
is measured. It knows no sensor kinds, plugins or commands of the command line; its modules are imported when used.
"""
