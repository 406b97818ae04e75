"""Messages between robots by radio and sound."""

from __future__ import annotations

import math

import pytest

import simkit
from simkit_water_and_air.plugins.comms.signal_loss import RadioChannel

ENDPOINT = """<plugin filename="gz-sim-comms-endpoint-system" name="gz::sim::systems::CommsEndpoint">
  <address>{address}</address><topic>{topic}</topic></plugin>"""


def world(system: str, distance: float) -> str:
    models = "".join(
        f"""<model name="{name}"><static>true</static><pose>{x} 0 0 0 0 0</pose><link name="l"/>
        {ENDPOINT.format(address=address, topic=f"{address}/rx")}</model>"""
        for name, address, x in (("one", "addr1", 0.0), ("two", "addr2", distance))
    )
    return f"""<sdf version="1.9"><world name="air">
      <physics name="p" type="ode"><max_step_size>0.01</max_step_size></physics>{system}{models}</world></sdf>"""


def system(kind: str, name: str, more: str = "") -> str:
    return f'<plugin filename="gz-sim-{kind}-comms-system" name="gz::sim::systems::{name}Comms">{more}</plugin>'


def send(sim: simkit.Simulation, size: int = 4, target: str = "addr2") -> None:
    sim.publish("/broker/msgs", {"src_address": "addr1", "dst_address": target, "data": [7] * size})


def test_perfect_comms_deliver_to_the_address_and_to_no_other() -> None:
    with simkit.load(world(system("perfect", "Perfect"), 1e6)) as sim:
        here, there = (sim.subscribe(f"/addr{i}/rx", keep=10) for i in (1, 2))
        send(sim)
        send(sim, target="nobody")
        sim.run(0.05)
        assert [list(m.data) for m in there.messages] == [[7] * 4]
        assert there.messages[0].src_address == "addr1"
        assert not here.messages


RF = """<range_config><max_range>{most}</max_range><fading_exponent>2.5</fading_exponent><l0>40</l0>
  <sigma>{sigma}</sigma></range_config><radio_config><capacity>{capacity}</capacity><tx_power>20</tx_power>
  <noise_floor>-90</noise_floor><modulation>QPSK</modulation></radio_config>"""


def test_radio_reaches_its_range_with_the_power_of_the_formula() -> None:
    rf = system("rf", "RF", RF.format(most=50, sigma=0, capacity=54e6))
    for distance, expected in ((40.0, 20 - 40 - 25 * math.log10(40.0)), (60.0, None)):
        with simkit.load(world(rf, distance)) as sim:
            got = sim.subscribe("/addr2/rx", keep=10)
            send(sim)
            sim.run(0.05)
            assert [m.rssi for m in got.messages] == ([] if expected is None else [pytest.approx(expected)])


def test_a_radio_sends_no_more_than_its_capacity_in_a_second() -> None:
    with simkit.load(world(system("rf", "RF", RF.format(most=50, sigma=0, capacity=800)), 5.0)) as sim:
        got = sim.subscribe("/addr2/rx", keep=10)
        for _ in range(5):
            send(sim, size=40)
        sim.run(0.5)
        assert len(got.messages) == 2
        sim.run(1.0)
        send(sim, size=40)
        sim.run(0.1)
        assert len(got.messages) == 3


def test_losses_follow_the_seed_and_repeat_after_a_reset() -> None:
    rf = system("rf", "RF", RF.format(most=-1, sigma=6, capacity=54e6))

    def received(seed: int) -> list[float]:
        with simkit.load(world(rf, 500.0), seed=seed) as sim:
            got = sim.subscribe("/addr2/rx", keep=500)
            for run in range(2):
                if run:
                    sim.reset()
                for _ in range(100):
                    send(sim, size=100)
                    sim.run(0.01)
            powers = [m.rssi for m in got.messages]
            half = len(powers) // 2
            assert powers[:half] == powers[half:]
            return powers

    first = received(1)
    assert first == received(1) != received(2)
    assert 0 < len(first) < 200


def test_the_loss_of_a_packet_grows_with_distance_and_size() -> None:
    channel = RadioChannel(-1.0, 2.5, 40.0, 0.0, 20.0, -90.0)
    near, far = channel.received_power(10.0, 0.0), channel.received_power(400.0, 0.0)
    assert near - far == pytest.approx(25 * math.log10(40.0))
    assert channel.loss_probability(near, 100) == pytest.approx(0.0, abs=1e-12)
    ratio = 10 ** ((far + 90.0) / 10)
    assert channel.loss_probability(far, 10) == pytest.approx(1 - (1 - math.erfc(math.sqrt(ratio))) ** 10)
    assert channel.loss_probability(-math.inf, 1) == 1.0


def test_sound_arrives_after_its_way_through_the_water() -> None:
    sound = system("acoustic", "Acoustic", "<max_range>500</max_range><speed_of_sound>1500</speed_of_sound>")
    with simkit.load(world(sound, 300.0)) as sim:
        got = sim.subscribe("/addr2/rx", keep=10)
        send(sim)
        sim.run(0.19)
        assert not got.messages
        sim.run(0.03)
        assert len(got.messages) == 1
    with simkit.load(world(sound, 600.0)) as sim:
        got = sim.subscribe("/addr2/rx", keep=10)
        send(sim)
        sim.run(1.0)
        assert not got.messages


def test_a_receiver_is_deaf_while_a_message_lasts() -> None:
    more = "<speed_of_sound>1500</speed_of_sound><collision_time_per_byte>0.01</collision_time_per_byte>"
    with simkit.load(world(system("acoustic", "Acoustic", more), 3.0)) as sim:
        got = sim.subscribe("/addr2/rx", keep=10)
        for _ in range(3):
            send(sim, size=20)
            sim.run(0.15)
        assert len(got.messages) == 2


def test_a_wrong_number_in_a_block_is_an_error_when_the_world_is_loaded() -> None:
    wrong = "<range_config><l0>loud</l0></range_config>"
    ranges = f'<plugin filename="libRFRange.so" name="gz::sim::systems::RFRange">{wrong}</plugin>'
    model = "<propagation_model><source_power>loud</source_power></propagation_model>"
    for systems in (ranges, system("rf", "RF", wrong), system("acoustic", "Acoustic", model)):
        with pytest.raises(simkit.errors.SimkitError, match="found .*loud"):
            simkit.load(world(systems, 5.0))


def test_the_propagation_model_is_read_when_the_world_is_loaded() -> None:
    model = "<source_power>100</source_power><noise_level>2</noise_level><spectral_efficiency>5</spectral_efficiency>"
    sound = system("acoustic", "Acoustic", f"<propagation_model>{model}</propagation_model>")
    with simkit.load(world(sound, 3.0)) as sim:
        assert not [d for d in sim.diagnostics if d.severity != "note"]


def test_radios_measure_their_distance() -> None:
    blocks = RF.format(most=500, sigma=0, capacity=1).replace("</l0>", "</l0><rssi_1>-20</rssi_1>")
    robots = "".join(
        f"""<model name="{name}"><static>true</static><pose>{x} 0 0 0 0 0</pose><link name="l"/>
        <model name="rf"><link name="l"/>
        <plugin filename="libRFRange.so" name="ignition::gazebo::systems::RFRangeSensor"/></model></model>"""
        for name, x in (("one", 0.0), ("two", 30.0))
    )
    text = f"""<sdf version="1.9"><world name="air">{robots}<plugin filename="libRFRange.so"
      name="ignition::gazebo::systems::RFRange"><update_rate>2</update_rate>{blocks}</plugin></world></sdf>"""
    with simkit.load(text) as sim:
        assert not [d for d in sim.diagnostics if d.severity != "note"]
        got = sim.subscribe("/world/air/model/one/model/rf/rfsensor", keep=10)
        sim.run(1.1)
        assert len(got.messages) == 2
        values = {p.name: p.value for p in got.messages[-1].params}
        assert values["model"].string_value == "two"
        assert values["range"].double_value == pytest.approx(30.0)
        assert values["rssi"].double_value == pytest.approx(20 - 40 - 25 * math.log10(30.0))
