"""Bags: MCAP files and rosbag2 folders.

Messages of a run enter and files leave (`recorder`, `writer`); files enter and messages leave (`reader`, `playback`,
`recovery`, `summary`). Times are simulated ones; two runs of one seed write the same bytes.
"""
