"""A client may have several nodes, may leave out its own messages, and the last message of a latched topic."""

from __future__ import annotations

import simkit
from simkit.bridges.simulation_link import SimulationLink, text_message
from simkit.live import Client, LiveSubscription

STRING = "std_msgs/msg/String"


def test_the_nodes_of_a_client_are_listed_with_what_they_have_opened(client: Client) -> None:
    own = client.info["node"]
    assert own in client.ask("nodes")
    assert client.ask("open_node", name="/r1/driver") == "/r1/driver"
    client.ask("advertise", number=client.next_number(), topic="/speed", type=STRING, latched=False, node="/r1/driver")
    client.ask("offer", number=client.next_number(), name="/stop", type="std_srvs/srv/Trigger", node="/r1/driver")
    nodes = client.ask("nodes")
    assert own not in nodes
    assert nodes["/r1/driver"]["publishers"] == {"/speed": [STRING]}
    assert nodes["/r1/driver"]["services"] == {"/stop": ["std_srvs/srv/Trigger"]}
    client.ask("open_node", name="/idle")
    client.ask("close_node", name="/idle")
    assert "/idle" not in client.ask("nodes")


def test_a_subscription_can_leave_out_the_last_message_of_a_latched_topic(client: Client) -> None:
    news = client.advertise("/news", STRING, latched=True)
    news.publish({"data": "early"})
    client.flush()
    numbers = client.next_number(), client.next_number()
    taken: list[LiveSubscription] = []
    for number in numbers:
        taken.append(LiveSubscription(client, number, "/news", 10))
        client.subscriptions[number] = taken[-1].take
        client.ask("subscribe", number=number, topic="/news", depth=10, skips_latched=number == numbers[0])
    news.publish({"data": "late"})
    client.flush()
    client.wait(lambda: len(taken[1].waiting) == 2 and len(taken[0].waiting) == 1, 20.0)
    assert [[each.message.data for each in subscription.waiting] for subscription in taken] == [
        ["late"],
        ["early", "late"],
    ]


def test_a_client_that_skips_its_own_messages_gets_those_of_others(client: Client) -> None:
    link = SimulationLink(client.path, lambda _: None, "mirror", is_bridge=False)
    received: list[bytes] = []
    link.subscribe("/news", lambda *message: received.append(message[2]), lambda _: None)
    opened: list[int] = []
    link.advertise("/news", STRING, opened.append, lambda _: None)
    link.request("ping", {})
    link.dispatch_answers()
    link.publish(opened[0], text_message("own"))
    link.request("ping", {})
    client.publish("/news", simkit.msgs.type_of(STRING)(data="of others"))
    client.flush()
    assert link.wait(lambda: bool(received), 20.0)
    link.close()
    assert received == [text_message("of others")]
