"""What one run gave: its messages, the states of its physics, and the inputs that it was made from, as arrays.

A run specification or an open simulation enters, a `RunRecord` leaves. Whether a record is right is not judged here:
`simkit.testing.golden` compares two of them.
"""
