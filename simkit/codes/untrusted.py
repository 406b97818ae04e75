"""Codes of files that are too much: too many errors, numbers too far apart, too many moving bodies."""

from __future__ import annotations

from simkit.codes import Code, Example

_MANY = """import simkit

frames = "".join(f"<frame name='f{i}' attached_to='g{i}'/>" for i in range(2000))
found = simkit.check(f"<sdf version='1.9'><model name='m'><link name='l'/>{frames}</model></sdf>")
print(list(found)[-1])
"""

CODES: tuple[Code, ...] = (
    Code(
        "SK-LOAD-012",
        "error",
        "the file has a thousand errors; the rest is not looked at",
        "mend the first ones: the others often follow from them",
        Example(_MANY, "python"),
    ),
    Code(
        "SK-PHYS-028",
        "error",
        "masses, inertias and distances are so far apart that the engine cannot compute with them",
        "check the units: metres, kilograms and kg·m²",
        without="what is known to bring it about depends on rounding: a joint 1e8 m away from a link of 1e-9 kg",
    ),
    Code(
        "SK-PHYS-029",
        "error",
        "there are more moving bodies than can be compiled in reasonable time",
        "make what never moves <static>",
        without="a file with that many bodies is too long for an example",
    ),
)
