"""Presets as text: the page of all, and one of them."""

from __future__ import annotations

from collections.abc import Iterator

from simkit.sensors.presets import presets
from simkit.sensors.presets.preset import Preset, outline

_INTRODUCTION = """\
# Presets

A sensor that names a real device gets its published numbers:

```xml
<sensor name="lds" type="lidar">
  <simkit:preset>LDS-01</simkit:preset>
</sensor>
```

What the file says itself wins, element by element: with `<lidar><range><max>2</max></range></lidar>` beside it the
range ends at 2 m and all else is the LDS-01's. That goes for `<update_rate>`, `<ray>` and `<gps>` too. A
`<noise type="none"/>` of the file takes no noise from the preset, a `<stddev>` puts the preset's `<noise_density>` out,
and the other way round. Plain `<preset>` is the same; with the prefix, and `xmlns:simkit="simkit"` on the root element,
Gazebo passes it over.

Capitals, spaces and dashes in the name do not count. An unknown name is an error that names the closest
([SK-SENSOR-090](../commands/explain.md)), so is a device of another kind (SK-SENSOR-091); a note says what the file got
(SK-SENSOR-092), and `simkit inspect` shows the result. From Python:

```python
from simkit.sensors.presets import find, presets

[preset.name for preset in presets() if preset.kind == "imu"]
find("BMI088")["imu"].elements    # nested elements, in SI units
```

`python -m simkit.sensors.presets NAME` prints one, without a name this page.

What the numbers are: noise, steps, fields of view, ranges and rates of data sheets, typical ones where a sheet has
typical and bounds. An in-run bias stability is taken for the lowest point of the Allan deviation, 0.664 of
`<bias_instability>`. Many sheets give a band (±10 mm) and no deviation: where a remark says *our choice*, that band is
one standard deviation here, which the sheet does not say. A number marked *unconfirmed* was found in no second place:
compare it with the sheet of your device before you rely on it.

What they are not: offsets and scale errors, which a calibration takes away, and errors that follow the range, the
target or the temperature; [noise](noise.md) has elements for a bias, and a [depth camera](depth_camera.md) one for
errors that grow with the square of the range. Where a sheet gives no rate, the file should, for without one a sensor
reads at every step.

Left out, for their beams are not evenly spaced: HDL-64E, VLP-32C, the Livox scanners.

One hall as four presets see it ([examples/sensors/presets.py](../../examples/sensors/presets.py)):

![scans of a hall from above](../images/sensors/presets.png)
"""

_TITLES = {
    "lidar": "Lidars (`lidar`, `ray`, `gpu_lidar`, `gpu_ray`)",
    "rgbd_camera": "Colour and depth (`rgbd_camera`)",
    "depth_camera": "Depth cameras (`depth_camera`, `depth`)",
    "imu": "Inertial measurement units (`imu`)",
    "magnetometer": "Magnetometers (`magnetometer`)",
    "air_pressure": "Barometers (`air_pressure`)",
    "navsat": "Satellite receivers (`navsat`, `gps`)",
    "sonar": "Sonars (`sonar`)",
    "encoder": "Encoders (`encoder`)",
    "force_torque": "Force and torque sensors (`force_torque`)",
}


def presets_page() -> str:
    """`docs/sensors/presets.md`."""
    return _INTRODUCTION + "".join("\n" + "\n".join(_section(kind)) + "\n" for kind in _kinds())


def _kinds() -> list[str]:
    there = {preset.kind for preset in presets()}
    return [kind for kind in _TITLES if kind in there] + sorted(there - set(_TITLES))


def _section(kind: str) -> Iterator[str]:
    yield f"## {_TITLES.get(kind, kind)}\n"
    yield "| preset | Hz | gives | source, remarks |"
    yield "|---|---|---|---|"
    for preset in presets():
        if preset.kind == kind:
            yield f"| {_names(preset)} | {_rate(preset)} | {_given(preset)} | {_source(preset)} |"


def _names(preset: Preset) -> str:
    also = f" ({', '.join(preset.aliases)})" if preset.aliases else ""
    maker = "" if preset.name.startswith(preset.maker) else f"{preset.maker} "
    return f"{maker}**{preset.name}**{also}"


def _rate(preset: Preset) -> str:
    return f"{preset.rate:g}" if preset.rate else ""


def _given(preset: Preset) -> str:
    (block,) = preset.settings.values()
    return f"`{outline(block)}`"


def _source(preset: Preset) -> str:
    remark = f"; {preset.remark}" if preset.remark else ""
    doubt = f"; *unconfirmed*: {', '.join(preset.unconfirmed)}" if preset.unconfirmed else ""
    return preset.source + remark + doubt


def describe_preset(preset: Preset) -> str:
    """One preset, line by line."""
    lines = [f"{preset.name} ({preset.maker}), {' / '.join(preset.sensor_kinds)}"]
    if preset.aliases:
        lines.append(f"also:   {', '.join(preset.aliases)}")
    lines += [f"gives:  {outline(preset.elements)}", f"source: {preset.source}"]
    if preset.remark:
        lines.append(f"note:   {preset.remark}")
    if preset.unconfirmed:
        lines.append(f"unconfirmed: {', '.join(preset.unconfirmed)}")
    return "\n".join(lines)
