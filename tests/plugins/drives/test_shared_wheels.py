"""Two plugins that drive the same joint share one velocity servo: the last command of either counts."""

from __future__ import annotations

import pytest

import simkit

WHEEL = (
    "<link name='{0}'><pose>0 {1} 0.1 0 0 0</pose><inertial><mass>1</mass><inertia><ixx>0.01</ixx><iyy>0.01</iyy>"
    "<izz>0.01</izz></inertia></inertial></link><joint name='{0}_joint' type='revolute'><parent>base</parent>"
    "<child>{0}</child><axis><xyz>0 1 0</xyz></axis></joint>"
)
CLASSIC = (
    "<plugin name='classic' filename='libgazebo_ros_diff_drive.so'><left_joint>left_joint</left_joint>"
    "<right_joint>right_joint</right_joint><wheel_separation>0.4</wheel_separation><wheel_diameter>0.2</wheel_diameter>"
    "<max_wheel_torque>100</max_wheel_torque></plugin>"
)
GZ = (
    "<plugin name='gz' filename='gz-sim-diff-drive-system'><left_joint>left_joint</left_joint>"
    "<right_joint>right_joint</right_joint><wheel_separation>0.4</wheel_separation><wheel_radius>0.1</wheel_radius></plugin>"
)


def cart(*plugins: str) -> str:
    wheels = WHEEL.format("left", 0.2) + WHEEL.format("right", -0.2)
    base = "<link name='base'><pose>0 0 0.1 0 0 0</pose><inertial><mass>5</mass></inertial></link>"
    fixed = "<joint name='fix' type='fixed'><parent>world</parent><child>base</child></joint>"
    return f"<sdf version='1.9'><model name='cart'>{base}{fixed}{wheels}{''.join(plugins)}</model></sdf>"


@pytest.mark.parametrize("plugins", [(CLASSIC, GZ), (GZ, CLASSIC)], ids=["classic first", "gz first"])
def test_the_drives_of_both_gazebos_in_one_file_both_work(plugins: tuple[str, str]) -> None:
    with simkit.load(cart(*plugins)) as sim:
        wheel = sim.joint("cart::left_joint")
        assert [d.severity for d in sim.diagnostics if d.code == "SK-JOINT-019"] == ["warning"]
        for topic, speed in (("/cmd_vel", 0.5), ("/model/cart/cmd_vel", -0.2), ("/cmd_vel", 0.3)):
            sim.publish(topic, {"linear": {"x": speed}})
            sim.run(1.0)
            assert wheel.velocity == pytest.approx(speed / 0.1, rel=0.02)  # rim speed over the radius


def test_a_reset_and_a_restore_keep_the_shared_servo() -> None:
    with simkit.load(cart(CLASSIC, GZ)) as sim:
        sim.publish("/cmd_vel", {"linear": {"x": 0.5}})
        sim.run(0.5)
        snapshot = sim.snapshot()
        sim.run(0.5)
        first = sim.mj_data.qpos.tobytes()
        sim.restore(snapshot)
        sim.run(0.5)
        assert sim.mj_data.qpos.tobytes() == first
        sim.reset()
        sim.run(0.5)
        assert sim.joint("cart::left_joint").velocity == pytest.approx(0.0, abs=1e-6)


def test_one_drive_alone_is_no_conflict() -> None:
    with simkit.load(cart(CLASSIC)) as sim:
        assert "SK-JOINT-019" not in [d.code for d in sim.diagnostics]


@pytest.mark.parametrize("plugins", [("weak", "gz"), ("gz", "weak")], ids=["weak first", "weak last"])
def test_the_larger_effort_limit_of_both_drives_counts(plugins: tuple[str, str]) -> None:
    """A motor of 0.01 N·m alone reaches 1 rad/s of a wheel of 0.01 kg m² in a second."""
    weak = CLASSIC.replace("<max_wheel_torque>100<", "<max_wheel_torque>0.01<")
    with simkit.load(cart(weak)) as sim:
        sim.publish("/cmd_vel", {"linear": {"x": 0.5}})
        sim.run(1.0)
        assert sim.joint("cart::left_joint").velocity < 1.1
    with simkit.load(cart(*({"weak": weak, "gz": GZ}[name] for name in plugins))) as sim:
        sim.publish("/model/cart/cmd_vel", {"linear": {"x": 0.5}})
        sim.run(1.0)
        assert sim.joint("cart::left_joint").velocity == pytest.approx(5.0, rel=0.02)


@pytest.mark.parametrize("first", [CLASSIC, GZ], ids=["classic first", "gz first"])
def test_the_second_drive_works_if_the_first_is_disabled(first: str) -> None:
    second = GZ if first == CLASSIC else CLASSIC
    topic = "/model/cart/cmd_vel" if second == GZ else "/cmd_vel"
    with simkit.load(cart(first, second), on_error="disable") as sim:
        plugin = next(iter(sim.plugins.values()))
        sim.engine.faults.disable(plugin, "on_update", RuntimeError("broken"))
        sim.publish(topic, {"linear": {"x": 0.5}})
        sim.run(1.0)
        assert sim.joint("cart::left_joint").velocity == pytest.approx(5.0, rel=0.02)
