"""Kinds that are known and not simulated: they are read in full, checked, and reported once."""

from __future__ import annotations

import pytest
from sensor_worlds import world

import simkit
from simkit.params import Params
from simkit.sensors import sensor_kinds
from simkit.sensors.unsimulated_kinds import UNSIMULATED_READERS, read_transceiver

RADIO = """<transceiver><essid>osrf</essid><frequency>2450</frequency><min_frequency>2412</min_frequency>
<max_frequency>2484</max_frequency><gain>2.6</gain><power>14</power><sensitivity>-90</sensitivity></transceiver>"""
BLOCKS = {
    "rfid": "<rfid/>",
    "rfidtag": "<rfidtag/>",
    "wireless_transmitter": RADIO,
    "wireless_receiver": RADIO,
}


def sensor(kind: str, block: str) -> str:
    common = "<pose>0 0 1 0 0 0</pose><update_rate>5</update_rate><topic>t</topic><always_on>1</always_on>"
    return world(f'<sensor name="s" type="{kind}">{common}{block}</sensor>')


@pytest.mark.parametrize("kind", UNSIMULATED_READERS)
def test_there_is_exactly_one_report(kind: str) -> None:
    with simkit.load(sensor(kind, BLOCKS[kind])) as sim:
        found = [d for d in sim.diagnostics if d.code.startswith(("SK-SENSOR", "SK-PARAM"))]
        assert [(d.code, d.severity) for d in found] == [("SK-SENSOR-052", "warning")]
        assert kind in found[0].message
        assert found[0].line
        sim.step(10)
        assert "/t" not in sim.topics()
        assert not sim.contents.sensors
    assert kind not in sensor_kinds()


@pytest.mark.parametrize("kind", UNSIMULATED_READERS)
def test_an_unknown_element_is_reported_too(kind: str) -> None:
    inner = BLOCKS[kind].replace("</transceiver>", "<gian/></transceiver>")
    text = sensor(kind, inner if "gian" in inner else inner + "<gian/>")
    with simkit.load(text) as sim:
        assert any(d.code == "SK-PARAM-003" and "gian" in d.message for d in sim.diagnostics)


@pytest.mark.parametrize(
    ("kind", "block"),
    [
        ("wireless_transmitter", "<transceiver><gain>much</gain></transceiver>"),
        ("wireless_receiver", "<transceiver><sensitivity>3</sensitivity></transceiver>"),
        ("wireless_receiver", "<transceiver><min_frequency>9000</min_frequency></transceiver>"),
    ],
)
def test_an_invalid_value_is_an_error(kind: str, block: str) -> None:
    with pytest.raises(simkit.LoadError, match="SK-PARAM-002"):
        simkit.load(sensor(kind, block))


def test_all_values_of_the_file_are_read() -> None:
    radio = read_transceiver(Params.from_dict({"transceiver": {"essid": "osrf", "gain": 2.6}}))
    assert (radio.essid, radio.frequency, radio.band, radio.gain) == ("osrf", 2442.0, (2412.0, 2484.0), 2.6)
    assert (radio.power, radio.sensitivity) == (14.5, -90.0)
