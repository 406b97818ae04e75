"""Loading says everything at once."""

import pytest

import simkit

BROKEN = """<sdf version="1.9"><world name="w">
  <plugin filename="libnobody.so" name="nobody"/>
  <model name="m"><link name="l"><inertial><mass>-1</mass></inertial>
    <sensor name="s" type="lidar"><lidar><scan><horizontal><samples>many</samples></horizontal></scan>
      <range><min>0.1</min><max>3</max></range></lidar></sensor>
  </link></model></world></sdf>"""


def test_a_bad_link_hides_neither_a_bad_sensor_nor_an_unknown_plugin():
    with pytest.raises(simkit.LoadError) as caught:
        simkit.load(BROKEN)
    found = {(d.code, d.line) for d in caught.value.diagnostics}
    assert {("SK-PARAM-002", 4), ("SK-PLUGIN-001", 2)} < found
    assert any(code == "SK-SDF-013" for code, _ in found)
