"""What several commands share: options, output, completion, keyboard, and where topics are read from.

Words of a command line enter, values and lines of text leave. Nothing here is a command or imports one, and nothing
loads MuJoCo, NumPy or rosbags before a command needs them.
"""
