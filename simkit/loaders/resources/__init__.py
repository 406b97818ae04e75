"""Find the files that an input names (URIs, ROS packages, bundled models) and read them within bounds, XML into
`Params`.
"""
