"""Pictures and videos of a simulation: what they show, from where, and what is drawn over them.

`subject` collects what a picture shows, `camera` finds the viewpoint, `overlay` draws paths, scans, goals, a title, a
legend and a scale bar, `frames` puts these together, and `video_file` writes GIF, MP4 and WebM files.
"""
