"""Video streams of cameras: begun and ended by messages, decodable, and only on this machine."""

from __future__ import annotations

import io
import socket
from collections.abc import Iterator
from typing import Any

import pytest

import simkit

IMAGES = "/eye"


def world(plugin: str, filename: str = "GstCameraPlugin", image: str = "") -> str:
    return f"""<sdf version="1.9"><world name="w">
<scene><background>0 0 1 1</background><ambient>1 1 1 1</ambient></scene>
<model name="m"><static>true</static><link name="l"><sensor name="eye" type="camera"><update_rate>10</update_rate>
<topic>eye</topic><camera><image><width>64</width><height>48</height>{image}</image></camera>
<plugin filename="{filename}" name="GstCameraPlugin">{plugin}</plugin></sensor></link></model></world></sdf>"""


@pytest.fixture
def receiver() -> Iterator[socket.socket]:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as opened:
        opened.bind(("127.0.0.1", 0))
        opened.setblocking(False)
        yield opened


def received(receiver: socket.socket) -> list[bytes]:
    packets = []
    while True:
        try:
            packets.append(receiver.recv(65536))
        except BlockingIOError:
            return packets


def port(receiver: socket.socket) -> int:
    return int(receiver.getsockname()[1])


def test_the_stream_begins_and_ends_on_request(receiver: socket.socket) -> None:
    av: Any = pytest.importorskip("av")
    with simkit.load(world(f"<udp_port>{port(receiver)}</udp_port>")) as sim:
        sim.run(0.5)
        assert received(receiver) == []
        sim.publish(f"{IMAGES}/enable_streaming", {"data": True})
        sim.run(1.0)
        sim.publish(f"{IMAGES}/enable_streaming", {"data": False})
        sim.run(0.1)
        data = b"".join(received(receiver))
        sim.run(0.5)
        assert received(receiver) == []
    frames = [f.to_ndarray(format="rgb24") for f in av.open(io.BytesIO(data), format="mpegts").decode(video=0)]
    assert len(frames) == 10
    red, green, blue = frames[-1][24, 32].tolist()
    assert blue > 200 > 60 > max(red, green)  # the colour of the background


def test_the_basic_pipeline_is_rtp(receiver: socket.socket) -> None:
    pytest.importorskip("av")
    plugin = f"<use_basic_pipeline>true</use_basic_pipeline><udp_port>{port(receiver)}</udp_port>"
    with simkit.load(world(plugin)) as sim:
        sim.publish(f"{IMAGES}/enable_streaming", {"data": True})
        sim.run(0.5)
        packets = received(receiver)
    assert packets
    assert {(packet[0] >> 6, packet[1] & 0x7F) for packet in packets} == {(2, 96)}  # version, type of payload


def test_px4s_plugin_streams_after_a_message(receiver: socket.socket) -> None:
    pytest.importorskip("av")
    with simkit.load(world(f"<udpPort>{port(receiver)}</udpPort>", "libgazebo_gst_camera_plugin.so")) as sim:
        sim.run(0.2)
        assert received(receiver) == []
        sim.publish("/video_stream", {"data": True})
        sim.run(0.3)
        assert received(receiver)


def test_the_stream_continues_after_a_reset_and_a_restore(receiver: socket.socket) -> None:
    pytest.importorskip("av")
    with simkit.load(world(f"<udp_port>{port(receiver)}</udp_port>")) as sim:
        snapshot = sim.snapshot()
        sim.publish(f"{IMAGES}/enable_streaming", {"data": True})
        sim.run(0.3)
        for step_back in (sim.reset, lambda: sim.restore(snapshot)):
            received(receiver)
            step_back()
            sim.run(0.3)
            assert received(receiver)


def test_a_grey_camera_streams_too(receiver: socket.socket) -> None:
    pytest.importorskip("av")
    with simkit.load(world(f"<udp_port>{port(receiver)}</udp_port>", image="<format>L8</format>")) as sim:
        sim.publish(f"{IMAGES}/enable_streaming", {"data": True})
        sim.run(0.3)
        assert received(receiver)


@pytest.mark.parametrize(
    "element",
    [
        "<udp_host>192.0.2.7</udp_host>",
        "<udp_host>ground.station</udp_host>",
        "<rtmp_location>rtmp://a/b</rtmp_location>",
    ],
)
def test_a_target_on_another_machine_is_replaced_and_reported(element: str, receiver: socket.socket) -> None:
    pytest.importorskip("av")
    with simkit.load(world(f"{element}<udp_port>{port(receiver)}</udp_port>")) as sim:
        assert [d.severity for d in sim.diagnostics if d.code == "SK-SENSOR-150"] == ["note"]
        sim.publish(f"{IMAGES}/enable_streaming", {"data": True})
        sim.run(0.3)
        assert received(receiver)


def test_without_the_encoder_a_warning_names_other_ways(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(__import__("sys").modules, "av", None)
    with simkit.load(world("")) as sim:
        sim.publish(f"{IMAGES}/enable_streaming", {"data": True})
        sim.run(0.2)
        warning = next(d for d in sim.diagnostics if d.code == "SK-SENSOR-151")
        assert IMAGES in str(warning)


def test_a_camera_with_one_pixel_gives_a_warning_and_no_stream(receiver: socket.socket) -> None:
    pytest.importorskip("av")
    text = world(f"<udp_port>{port(receiver)}</udp_port>").replace(">64<", ">1<").replace(">48<", ">1<")
    with simkit.load(text) as sim:
        sim.publish(f"{IMAGES}/enable_streaming", {"data": True})
        sim.run(0.5)
        assert "SK-SENSOR-151" in {d.code for d in sim.diagnostics}
    assert received(receiver) == []


@pytest.mark.parametrize("rate", ["0.0001", "1e6"])
def test_an_extreme_update_rate_streams(rate: str, receiver: socket.socket) -> None:
    pytest.importorskip("av")
    text = world(f"<udp_port>{port(receiver)}</udp_port>").replace(">10</update_rate>", f">{rate}</update_rate>")
    with simkit.load(text) as sim:
        sim.publish(f"{IMAGES}/enable_streaming", {"data": True})
        sim.run(0.05)
        sim.publish(f"{IMAGES}/enable_streaming", {"data": False})
        sim.run(0.01)
    assert received(receiver)
