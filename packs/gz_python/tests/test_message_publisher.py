"""Messages at times of the simulation."""

from __future__ import annotations

import pytest

import simkit


def world(*messages: str) -> str:
    return f"""<sdf version="1.9"><world name="w"><plugin filename="libPublisherPlugin.so" name="vrx::PublisherPlugin">
      {"".join(messages)}</plugin></world></sdf>"""


def message(text: str = "data: 2.5", type_: str = "gz.msgs.Double", topic: str = "/level", more: str = "") -> str:
    return f'<message type="{type_}" topic="{topic}" {more}>{text}</message>'


def test_messages_come_once_or_periodically() -> None:
    text = world(message(more='at="0.5"'), message(topic="/tick", more='at="0.1" every="0.2"'))
    with simkit.load(text) as sim:
        for _ in range(2):
            once, often = sim.subscribe("/level", keep=9), sim.subscribe("/tick", keep=9)
            sim.run(0.4995)
            assert not once.messages
            sim.run(0.5005)
            assert [m.data for m in once.messages] == [2.5]
            assert len(often.messages) == 5  # 0.1, 0.3, 0.5, 0.7, 0.9 s
            sim.reset()


def test_parameters_keep_their_types() -> None:
    values = {"gain": "DOUBLE double_value: 0.3", "on": "BOOLEAN bool_value: true", "number": "INT32 int_value: 3"}
    values |= {"model": 'STRING string_value: "PMS"', "direction": "VECTOR3D vector3d_value { x: 0.6 y: 0.8 }"}
    parameters = "".join(f'params {{ key: "{name}" value {{ type: {value} }} }}' for name, value in values.items())
    with simkit.load(world(message(parameters, "gz.msgs.Param", "/waves"))) as sim:
        waves = sim.subscribe("/waves", keep=1)
        sim.run(0.1)
        found = {p.name: p.value for p in waves.messages[-1].params}
        assert found["direction"].double_array_value.tolist() == [0.6, 0.8, 0.0]
        assert (found["gain"].double_value, found["on"].bool_value) == (0.3, True)
        assert (found["number"].integer_value, found["model"].string_value) == (3, "PMS")
        assert [found[name].type for name in ("on", "number", "gain", "model", "direction")] == [1, 2, 3, 4, 8]


@pytest.mark.parametrize(
    ("bad", "code"),
    [
        (message(type_="gz.msgs.Dubble"), "SK-PLUGIN-120"),
        (message(topic=""), "SK-PARAM-001"),
        (message("value: 3"), "SK-PLUGIN-121"),
        (message(more='at="-1"'), "SK-PARAM-002"),
        (message(more='every="soon"'), "SK-PARAM-002"),
        (message('params { key: "c" value { type: COLOR } }', "gz.msgs.Param"), "SK-PLUGIN-121"),
    ],
)
def test_wrong_messages_are_errors(bad: str, code: str) -> None:
    with pytest.raises(simkit.LoadError, match=code):
        simkit.load(world(bad))
