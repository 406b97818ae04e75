"""Exchange of messages between robots in gz: endpoints with addresses, and the models that deliver the messages.

The models are `gz::sim::systems::PerfectComms`, `RFComms` and `AcousticComms`. Parameters, defaults and order follow
`Broker.cc`, `CommsEndpoint.cc`, `RFComms.cc` and `AcousticComms.cc` of gz-sim.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Final

import numpy as np

from simkit import ModelPlugin, Params, WorldPlugin, msgs
from simkit.extend import Options, OptionsOf, block, integer, listens, number, publishes, text, without_effect
from simkit.linear_algebra import norm
from simkit_water_and_air.plugins.comms.signal_loss import (
    RadioOptions,
    RangeOptions,
    acoustic_loss_probability,
    read_channel,
)

if TYPE_CHECKING:
    from simkit import Model, Simulation
    from simkit.extend import Vector
    from simkit.msgs import Message

DATAFRAME: Final = "ros_gz_interfaces/msg/Dataframe"
_EPOCH: Final = 1.0  # over which the capacity of a radio counts [s]
_BIND: Final = "/broker/bind"


class BrokerOptions(Options):
    """Options of `<broker>`; endpoint and model belong together if their `<bind_service>` is the same."""

    messages_topic: str = text("/broker/msgs")
    bind_service: str = text(_BIND)
    unbind_service: bool = without_effect()


class CommsEndpointOptions(Options):
    """Options of `CommsEndpoint`."""

    address: str = text(required=True)
    topic: str = text(required=True)
    broker: BrokerOptions = block(BrokerOptions)


class CommsEndpoint(ModelPlugin):
    """Gives its model an `<address>`: messages to it are published on `<topic>`.

    A world plugin such as `RFComms` delivers the messages.
    """

    endpoints = (publishes("{topic}", DATAFRAME, named_by=("topic",)),)
    options = OptionsOf(CommsEndpointOptions)
    filenames = ("gz-sim-comms-endpoint-system",)
    names = ("gz::sim::systems::CommsEndpoint",)

    def load(self, parent: Model, params: Params) -> None:
        options = self.options.read_all()
        self.model, self.address = parent, options.address
        self.service = "/" + options.broker.bind_service.strip("/")
        self._output = self.advertise("/" + options.topic.strip("/"), DATAFRAME)

    def deliver(self, message: Message) -> None:
        """Publish a received message."""
        self._output.publish(message)


@dataclass(frozen=True)
class Packet:
    """Message on its way.

    Attributes:
        message: the message, with the time of its transmission in its header.
        time: time of the transmission [s].
        start: place of the transmission [m].
    """

    message: Message
    time: float
    start: Vector

    @property
    def size(self) -> int:
        """Number of bytes."""
        return len(self.message.data)


@dataclass
class Radio:
    """Bytes that a radio has sent and received lately, as pairs of time [s] and bytes."""

    sent: deque[tuple[float, int]] = field(default_factory=deque)
    received: deque[tuple[float, int]] = field(default_factory=deque)


class CommsModelOptions(Options):
    """Options of all models."""

    broker: BrokerOptions = block(BrokerOptions)
    step_size: bool = without_effect()


class CommsModel(WorldPlugin):
    """Base class of models that deliver `Dataframe` messages from `<messages_topic>` (`/broker/msgs`).

    A message whose `src_address` or `dst_address` no endpoint has is dropped.
    """

    options = OptionsOf(CommsModelOptions)
    endpoints = (listens("/broker/msgs", DATAFRAME, named_by=("broker/messages_topic",)),)

    def load(self, parent: Simulation, params: Params) -> None:
        options = self.options.read_all()
        self._service = "/" + options.broker.bind_service.strip("/")
        self._outbound: list[Packet] = []
        self.listen("/" + options.broker.messages_topic.strip("/"), DATAFRAME, self._on_message)

    def _on_message(self, message: Message) -> None:
        header = msgs.header(self.sim.time_ns, message.header.frame_id)
        sent = msgs.make(
            DATAFRAME,
            header=header,
            src_address=message.src_address,
            dst_address=message.dst_address,
            data=message.data,
            rssi=message.rssi,
        )
        ends = self._endpoints()
        start = ends[message.src_address][0].model.pose.position if message.src_address in ends else np.zeros(3)
        self._outbound.append(Packet(sent, self.sim.time, start))

    def _endpoints(self) -> dict[str, list[CommsEndpoint]]:
        """Return the endpoints by address; the first model with an address keeps it."""
        table: dict[str, list[CommsEndpoint]] = {}
        for plugin in self.sim.engine.structure.all_plugins():
            if isinstance(plugin, CommsEndpoint) and plugin.service == self._service:
                listed = table.setdefault(plugin.address, [])
                if not listed or listed[0].model.scoped == plugin.model.scoped:
                    listed.append(plugin)
                else:
                    owner = f"the address {plugin.address!r} belongs to model {listed[0].model.scoped!r}"
                    self._once.left_out(plugin.scoped, f"{owner}, so model {plugin.model.scoped!r} does not get it")
        return table

    def before_step(self) -> None:
        """Deliver the messages that arrive in this step."""
        if not self._outbound:
            return
        ends, waiting = self._endpoints(), self._outbound
        self._outbound = []
        for packet in waiting:
            source, target = (ends.get(a) for a in (packet.message.src_address, packet.message.dst_address))
            if not source or not target:
                self._once.left_out("address", "a message from or to an address without an endpoint is dropped")
                continue
            delivered = self.send(packet, source[0], target[0])
            if delivered is not None:
                for endpoint in target:
                    endpoint.deliver(delivered)

    def send(self, packet: Packet, source: CommsEndpoint, target: CommsEndpoint) -> Message | None:
        """Return the received message; None if it is lost or still on its way."""
        raise NotImplementedError


class PerfectComms(CommsModel):
    """Delivers each `Dataframe` in the next step, without loss."""

    filenames = ("gz-sim-perfect-comms-system",)
    names = ("gz::sim::systems::PerfectComms",)

    def send(self, packet: Packet, source: CommsEndpoint, target: CommsEndpoint) -> Message | None:
        return packet.message


class RfCommsOptions(CommsModelOptions):
    """Options of `RfComms`."""

    reach: RangeOptions = block(RangeOptions, element="range_config")
    radio: RadioOptions = block(RadioOptions, element="radio_config")


class RfComms(CommsModel):
    """Delivers each `Dataframe` by radio: with a loss that depends on the distance, and up to the radio's capacity.

    The received power is `<tx_power>` - `<l0>` - 10 · `<fading_exponent>` · log₁₀(distance), with the standard
    deviation `<sigma>`; it is the `rssi` of the received message [dBm].
    """

    options = OptionsOf(RfCommsOptions)
    filenames = ("gz-sim-rf-comms-system",)
    names = ("gz::sim::systems::RFComms",)

    def load(self, parent: Simulation, params: Params) -> None:
        super().load(parent, params)
        options = self.options
        _ = options.radio.modulation, options.reach.rssi_1
        self._channel, self._capacity = read_channel(options.reach, options.radio), options.radio.capacity
        self._radios: dict[str, Radio] = {}
        self._fading, self._loss, self._index = self.random("fading"), self.random("loss"), 0

    def send(self, packet: Packet, source: CommsEndpoint, target: CommsEndpoint) -> Message | None:
        sender = self._radios.setdefault(source.address, Radio())
        receiver = self._radios.setdefault(target.address, Radio())
        if not self._takes(sender.sent, packet.size, source.address):
            return None
        normal = float(self._fading.normal(self._index)[0])
        uniform = 0.5 + 0.5 * float(self._loss.uniform(self._index)[0])
        self._index += 1
        distance = norm(source.model.pose.position - target.model.pose.position)
        power = self._channel.received_power(distance, normal)
        if uniform <= self._channel.loss_probability(power, packet.size):
            return None
        if not self._takes(receiver.received, packet.size, target.address):
            return None
        return replace(packet.message, rssi=power)

    def _takes(self, history: deque[tuple[float, int]], size: int, address: str) -> bool:
        """Add a packet to the history of a radio; False if this would exceed the capacity."""
        now = self.sim.time
        while history and history[0][0] <= now - _EPOCH:
            history.popleft()
        total = size
        for _, count in history:
            total += count
        if 8 * total > self._capacity * _EPOCH:
            self._once.left_out(f"capacity {address}", f"{address!r} exceeds its capacity; the message is dropped")
            return False
        history.append((now, size))
        return True


class PropagationOptions(Options):
    """Options of `<propagation_model>`."""

    source_power: float = number(2000.0, "W", minimum=1e-12, maximum=1e12)
    noise_level: float = number(1.0, "dB", minimum=-1e6, maximum=1e6)
    spectral_efficiency: float = number(7.0, "bit/s/Hz", minimum=1e-9, maximum=1e9)
    seed: int = integer(0)


class AcousticCommsOptions(CommsModelOptions):
    """Options of `AcousticComms`."""

    max_range: float = number(1000.0, "m", minimum=0.0, maximum=1e12)
    speed: float = number(343.0, "m/s", element="speed_of_sound", minimum=1e-9, maximum=1e12)
    block_per_byte: float = number(0.0, "s", element="collision_time_per_byte", minimum=0.0, maximum=1e9)
    block_of_lost: float = number(0.0, "s", element="collision_time_packet_drop", minimum=0.0, maximum=1e9)
    propagation: PropagationOptions = block(PropagationOptions, element="propagation_model")


class AcousticComms(CommsModel):
    """Delivers each `Dataframe` by sound: after the time that sound needs from the sender to the receiver.

    A receiver is deaf for `<collision_time_per_byte>` times the bytes of its last message. `<propagation_model>` adds a
    loss by the sonar equation.
    """

    options = OptionsOf(AcousticCommsOptions)
    filenames = ("gz-sim-acoustic-comms-system",)
    names = ("gz::sim::systems::AcousticComms",)

    def load(self, parent: Simulation, params: Params) -> None:
        super().load(parent, params)
        self._deaf: dict[str, tuple[float, float]] = {}  # by address: time of the last message and its duration [s]
        propagation = self.options.propagation.read_all()
        self._loss, self._index = self.random(f"loss {propagation.seed}"), 0

    def send(self, packet: Packet, source: CommsEndpoint, target: CommsEndpoint) -> Message | None:
        options, now = self.options, self.sim.time
        covered = (now - packet.time) * options.speed
        if covered > options.max_range:
            return None
        if covered < norm(packet.start - target.model.pose.position):
            self._outbound.append(packet)
            return None
        last, duration = self._deaf.get(target.address, (0.0, 0.0))
        is_received = target.address not in self._deaf or now - last >= duration
        if options.propagation.is_given:
            is_received = self._propagates(covered, packet.size) and is_received
        if is_received:
            self._deaf[target.address] = now, options.block_per_byte * packet.size
            return packet.message
        self._deaf[target.address] = last, duration + options.block_of_lost
        return None

    def _propagates(self, covered: float, size: int) -> bool:
        model = self.options.propagation
        uniform = 0.5 + 0.5 * float(self._loss.uniform(self._index)[0])
        self._index += 1
        return uniform > acoustic_loss_probability(
            covered, size, model.source_power, model.noise_level, model.spectral_efficiency
        )
