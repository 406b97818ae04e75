"""Search for input files and reading of their content.

The input is a URI, a ROS package or a bundled name; the output is a path, or a file's content as `Params`. Sizes are
limited, and files are read only inside the resource folders. Nothing is downloaded, and no format is interpreted here.
"""
