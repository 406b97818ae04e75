"""Sensors at the end of a notebook's cell."""

import simkit

WORLD = """<sdf version="1.9"><world name="w"><model name="m"><static>true</static><link name="l">
<sensor name="scan" type="gpu_lidar"><update_rate>10</update_rate><topic>scan</topic><lidar>
<scan><horizontal><samples>4</samples><min_angle>-1</min_angle><max_angle>1</max_angle></horizontal></scan>
<range><min>0.1</min><max>5</max></range></lidar></sensor>
<sensor name="imu" type="imu"><topic>imu</topic></sensor></link></model></world></sdf>"""


def test_a_sensor_shows_its_rate_its_topics_and_its_newest_reading():
    with simkit.load(WORLD) as sim:
        scan, imu = sim.sensor("scan"), sim.sensor("imu")
        assert (
            scan._repr_html_()
            == "<code>&lt;Lidar &#x27;m::l::scan&#x27;&gt;</code> 10 Hz, /scan, /scan/points<br>no reading"
        )
        sim.run(0.2)
        assert "4 rays, no hit" in scan._repr_html_()
        assert "<br><code>Imu(header=" in imu._repr_html_()
    assert scan._repr_html_().endswith("no reading")  # the simulation is closed
