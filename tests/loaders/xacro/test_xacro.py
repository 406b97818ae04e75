"""xacro: results, lines of the expanded elements, permitted files, and limits."""

from __future__ import annotations

import sys
import threading
import xml.etree.ElementTree as ET
from xml.dom import minidom

import pytest
from urdf_robots import errors, with_code

import simkit
from simkit.diagnostics import Diagnostics
from simkit.loaders import Resolver
from simkit.loaders.resources.xml_reader import parse_file
from simkit.loaders.xacro.expansion import expand
from simkit.loaders.xacro.expansion_limits import BoundError, Budget, ExpansionError
from simkit.loaders.xacro.expression import Evaluator
from simkit.loaders.xacro.expression_functions import math_functions, python_functions

PARTS = """<robot xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="deep" value="7"/>
  <xacro:macro name="part" params="name size:='1 2 3' *origin **inside mass:=${deep}">
    <link name="${name}">
      <visual><xacro:insert_block name="origin"/><geometry><box size="${size}"/></geometry></visual>
      <inertial><mass value="${mass}"/><inertia ixx="${mass * 0.1}" iyy="1" izz="1"/></inertial>
      <xacro:insert_block name="inside"/>
    </link>
  </xacro:macro>
</robot>"""
SETTINGS = """
wheel: {radius: 0.1, width: !millimeters 20, turn: !degrees 90}
names: [a, b, c]
"""
WHOLE = """<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="prefix" default="p_"/>
  <xacro:arg name="flag" default="true"/>
  <xacro:include filename="parts.xacro"/>
  <xacro:include filename="parts.xacro" ns="other"/>
  <xacro:include filename="nothing.xacro" optional="true"/>
  <xacro:property name="conf" value="${xacro.load_yaml('settings.yaml')}"/>
  <xacro:property name="lazy" value="${later * 2}"/>
  <xacro:property name="later" value="3"/>
  <xacro:property name="sizes" value="${[1, 2, 3]}"/>
  <link name="$(arg prefix)base"/>
  <xacro:part name="one" mass="${lazy}">
    <origin xyz="${conf.wheel.radius} ${conf['wheel']['width']} 0" rpy="${pi / 2} ${-radians(90)} ${sin(0.5)}"/>
    <inside><collision><geometry><sphere radius="${max(sizes)}"/></geometry></collision></inside>
  </xacro:part>
  <xacro:other.part name="two" size="${' '.join([str(x * 2) for x in sizes])}">
    <origin xyz="0 0 ${len(conf.names)}"/><inside/>
  </xacro:other.part>
  <xacro:macro name="chain" params="items i:=0">
    <xacro:if value="${i &lt; len(items)}">
      <link name="${items[i]}_${i}"/>
      <joint name="j${i}" type="fixed"><parent link="one"/><child link="${items[i]}_${i}"/></joint>
      <xacro:chain items="${items}" i="${i + 1}"/>
    </xacro:if>
  </xacro:macro>
  <xacro:chain items="${conf.names}"/>
  <xacro:if value="$(arg flag)">
    <joint name="f" type="fixed"><parent link="$(arg prefix)base"/><child link="one"/></joint>
  </xacro:if>
  <xacro:unless value="${not (lazy == 6 and 'b' in conf.names)}">
    <joint name="g" type="fixed"><parent link="one"/><child link="two"/>
      <xacro:attribute name="extra" value="${'x' if True else 'y'}"/></joint>
  </xacro:unless>
  <xacro:element xacro:name="${'gaz' + 'ebo'}"><plugin name="q" filename="x.so">
    <a>$${not}</a><b>$(eval 1 + 2)</b><c>${'%.3f' % pi}</c><d>${python.sum([x for x in [1, 2] if x > 1])}</d>
  </plugin></xacro:element>
</robot>"""


def xacro(content: str) -> str:
    return f'<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">{content}</robot>'


def whole(write):
    write("parts.xacro", PARTS)
    write("settings.yaml", SETTINGS)
    return write("main.urdf.xacro", WHOLE)


def expanded(file, arguments=None, resolver=None):
    diagnostics = Diagnostics()
    document = parse_file(file, diagnostics)
    resolver = (resolver or Resolver()).around(file.parent)
    return expand(document, resolver, arguments or {}, diagnostics), list(diagnostics)


def plain(element):
    attributes = sorted((k, v) for k, v in element.attributes.items() if not k.startswith("xmlns"))
    return (element.name, element.value, attributes, [plain(c) for c in element.children])


def plain_xml(element):
    text = (element.text or "").strip()
    return (element.tag, text, sorted(element.attrib.items()), [plain_xml(c) for c in element])


# ---------------------------------------------------------------------- values of the expansion


def test_a_file_expands_to_the_same_elements_as_with_xacro_itself(write, capsys):
    """The `xacro` package, run as a user runs it, is the reference."""
    import xacro as reference

    file = whole(write)
    document, found = expanded(file)
    assert not errors(found), errors(found)
    said_here = capsys.readouterr()
    assert (said_here.out, said_here.err) == ("", "")
    assert plain(document.root) == plain_xml(ET.fromstring(reference.process(str(file))))


def test_every_expanded_element_has_its_original_file_and_line(write):
    document, _ = expanded(whole(write))
    places = {c.attribute("name"): (c.where.file.rpartition("/")[2], c.where.line) for c in document.root.children}
    assert places["p_base"] == ("main.urdf.xacro", 11)
    assert places["one"] == places["two"] == ("parts.xacro", 4)
    assert places["j2"] == ("main.urdf.xacro", 22)


def test_a_mistake_in_a_macro_is_reported_at_its_own_line(write, load):
    write("parts.xacro", PARTS.replace("${mass}", "${name}"))
    file = write(
        "m.xacro",
        xacro(
            '<xacro:include filename="parts.xacro"/><xacro:part name="one"><origin xyz="0 0 0"/><inside/></xacro:part>'
        ),
    )
    (problem,) = (d for d in load(file)[1] if d.severity == "error")
    assert (problem.code, problem.file.rpartition("/")[2], problem.line) == ("SK-URDF-013", "parts.xacro", 6)


def test_arguments_come_from_the_caller_and_unknown_ones_are_reported(write):
    file = whole(write)
    found = simkit.describe(file, xacro_args={"prefix": "left_", "flga": "1"})
    assert "left_base" in [x["name"] for x in found["model"]["links"]]
    (problem,) = (d for d in found["diagnostics"] if d["code"] == "SK-XACRO-004")
    assert problem["hint"] == "did you mean 'flag'?"


def test_find_uses_the_same_search_as_package_uris(write, load):
    write("ws/parts/package.xml", "<package><name>parts</name></package>")
    write("ws/parts/urdf/part.xacro", xacro('<link name="of_parts"/>'))
    write("ws/parts/meshes/m.stl", "mesh")
    write("ws/bot/package.xml", "<package><name>bot</name></package>")
    file = write(
        "ws/bot/urdf/bot.xacro",
        xacro(
            '<xacro:include filename="$(find parts)/urdf/part.xacro"/><link name="base"><visual><geometry>'
            '<mesh filename="file://$(find parts)/meshes/m.stl"/></geometry></visual></link>'
            '<joint name="j" type="fixed"><parent link="base"/><child link="of_parts"/></joint>'
        ),
    )
    scene, found = load(file)
    assert not errors(found)
    assert [x.name for x in scene.model.links] == ["of_parts", "base"]
    assert scene.model.links[1].visuals[0].geometry.file.read_text() == "mesh"


def test_a_missing_package_whose_files_are_not_opened_causes_a_note(write, load):
    file = write(
        "r.xacro",
        xacro(
            '<link name="l"/><gazebo><plugin name="p" filename="p.so">'
            "<parameters>$(find nope)/a.yaml</parameters></plugin></gazebo>"
        ),
    )
    scene, found = load(file)
    assert scene.model.plugins[0].params.text("parameters") == "package://nope/a.yaml"
    assert [d.severity for d in with_code(found, "SK-XACRO-007")] == ["note"]


def test_a_urdf_file_with_the_xacro_name_space_and_expressions_is_expanded(load):
    scene, found = load(xacro('<xacro:property name="n" value="base"/><link name="${n}_link"/>'))
    assert scene.model.links[0].name == "base_link"
    assert not errors(found)


def test_a_xacro_file_can_contain_sdf(write, load):
    file = write(
        "w.sdf.xacro",
        '<sdf version="1.9" xmlns:xacro="x"><xacro:property name="n" value="box"/>'
        '<model name="${n}"><link name="l"/></model></sdf>',
    )
    assert load(file)[0].model.name == "box"


# ---------------------------------------------------------------------- mistakes


def test_calls_of_unknown_macros_in_the_output_of_an_old_xacro_are_left_out_with_a_warning(load):
    body = '<link name="base"><visual><geometry><sphere radius="1"/></geometry><xacro:grey/></visual></link>'
    banner = "<!-- |    This document was autogenerated by xacro from op.urdf.xacro    | -->\n"
    scene, found = load(banner + xacro(body))
    assert [link.name for link in scene.model.links] == ["base"]
    assert [d.code for d in found if d.code.startswith("SK-XACRO")] == ["SK-XACRO-008"]


@pytest.mark.parametrize(
    ("content", "line", "part", "hint"),
    [
        ('<xacro:property name="length" value="1"/>\n<link name="${lenth}"/>', 2, "'lenth' is not defined", "length"),
        ('<xacro:macro name="wheel"><a/></xacro:macro>\n<xacro:weel/>', 2, "unknown macro name", "wheel"),
        ('\n\n<link name="$(arg side)"/>', 3, "the argument 'side' has no value", "--xacro-arg side=VALUE"),
        ('<xacro:macro name="m" params="a"><a/></xacro:macro>\n<xacro:m/>', 2, "Undefined parameters [a]", ""),
        ('\n<xacro:if value="${3 +}"><a/></xacro:if>', 2, "invalid expression", ""),
        (
            '<xacro:property name="x" value="${y}"/><xacro:property name="y" value="${x}"/>\n<a b="${x}"/>',
            2,
            "circular",
            "",
        ),
        ("\n${xacro.fatal('no such arm')}", 1, "no such arm", ""),
    ],
)
def test_a_mistake_is_reported_with_its_line_and_the_closest_name(load, content, line, part, hint):
    scene, found = load(xacro(content))
    assert scene.model is None
    (problem,) = (d for d in found if d.severity == "error")
    assert (problem.code, problem.line) == ("SK-XACRO-001", line)
    assert part in problem.message
    assert problem.hint == (
        f"did you mean {hint!r}?" if hint.isalpha() else hint and f"add {hint} (Python: xacro_args)"
    )


def test_all_arguments_without_a_value_are_told_at_once(load):
    content = """<xacro:macro name="m"><link name="${xacro.arg('arm')}"/></xacro:macro>
      <xacro:arg name="colour" default="red"/>
      <xacro:m/>
      <xacro:if value="$(arg mode)"><link name="$(arg colour)"/></xacro:if>
      <link name="${length}"/><link name="$(arg never)"/>"""
    scene, found = load(xacro(content))
    assert scene.model is None
    (problem,) = (d for d in found if d.severity == "error")
    assert (problem.code, problem.line) == ("SK-XACRO-001", 1)
    assert "the arguments 'arm', 'mode' have no value (arguments with values: colour)" in problem.message
    assert "<xacro:m> of" in problem.message
    assert problem.hint == "add --xacro-arg arm=VALUE --xacro-arg mode=VALUE (Python: xacro_args)"


def test_the_macro_calls_that_led_to_a_mistake_are_listed(load):
    inner = '<xacro:macro name="inner"><a b="${nothing}"/></xacro:macro>\n'
    outer = '<xacro:macro name="outer">\n<xacro:inner/></xacro:macro>\n<xacro:outer/>'
    (problem,) = (d for d in load(xacro(inner + outer))[1] if d.severity == "error")
    assert problem.line == 1
    assert "in <xacro:inner> of world given as text:3; in <xacro:outer> of world given as text:4" in problem.message


# ---------------------------------------------------------------------- permitted files and limits


@pytest.mark.parametrize(
    "content",
    [
        '<xacro:include filename="/etc/passwd"/>',
        '<xacro:include filename="../../secret.xacro"/>',
        '<xacro:include filename="$(find ..)/secret.xacro"/>',
        "<a b=\"${xacro.load_yaml('/etc/passwd')}\"/>",
        '<xacro:include filename="../*.xacro"/>',
    ],
)
def test_no_file_outside_the_folders_is_read(write, content):
    write("secret.xacro", xacro('<link name="secret"/>'))
    document, found = expanded(write("a/b/r.xacro", xacro(content)))
    assert document is None
    assert with_code(found, "SK-XACRO-002")


DOUBLING = '<xacro:macro name="m0"><a/></xacro:macro>' + "".join(
    f'<xacro:macro name="m{i}"><xacro:m{i - 1}/><xacro:m{i - 1}/></xacro:macro>' for i in range(1, 40)
)
TEXTS = '<xacro:property name="t0" value="aaaaaaaaaa"/>' + "".join(
    f'<xacro:property name="t{i}" value="${{t{i - 1}}}${{t{i - 1}}}"/>' for i in range(1, 60)
)


@pytest.mark.parametrize(
    "content",
    [
        DOUBLING + "<xacro:m39/>",
        TEXTS + '<a b="${t59}"/>',
        '<xacro:macro name="m"><xacro:m/></xacro:macro><xacro:m/>',
        '<xacro:include filename="r.xacro"/>',
        '<a b="${9 ** 9 ** 9}"/>',
    ],
)
def test_an_endless_expansion_is_stopped(write, content):
    document, found = expanded(write("r.xacro", xacro(content)))
    assert document is None
    assert with_code(found, "SK-XACRO-003")


def test_a_macro_parameter_with_exponential_time_in_xacro_is_read_quickly(write):
    content = f'<xacro:macro name="m" params="a:={"x" * 60}\'"><a/></xacro:macro>'
    document, _ = expanded(write("r.xacro", xacro(content)))
    assert document is not None


def test_a_yaml_file_of_aliases_is_stopped(write):
    lines = ["a: &a [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]"]
    lines += [f"{chr(98 + i)}: &{chr(98 + i)} [{', '.join(['*' + chr(97 + i)] * 10)}]" for i in range(12)]
    write("bomb.yaml", "\n".join(lines))
    document, found = expanded(write("r.xacro", xacro("<a b=\"${xacro.load_yaml('bomb.yaml')}\"/>")))
    assert document is None
    assert with_code(found, "SK-XACRO-003")


def evaluate(text, **names):
    budget = Budget()
    evaluator = Evaluator({}, budget)
    evaluator.names = {**math_functions(), **python_functions(evaluator), **names}
    return evaluator.run(text)


@pytest.mark.parametrize(
    "text",
    [
        "1 + 2 * 3 ** 2 // 4 % 5 - -1",
        "0.5 if 1 < 2 <= 2 else 'no'",
        "not (True and False) or 3",
        "[x * y for x in range(3) for y in (1, 2) if x != y]",
        "{'a': 1, **{'b': 2}}['b']",
        "'ab'.upper() + 'c'[0]",
        "', '.join([str(x) for x in sorted([3, 1, 2], reverse=True)])",
        "(lambda a, b: a + b)(1, 2)",
        "list(map(lambda x: x + 1, [1, 2]))",
        "max([1, 5], key=lambda x: -x)",
        "sum([1, 2, 3])",
        "f'{1 + 1:03d}'",
        "'{} {b}'.format(1, b=2)",
        "'%.2f %s' % (1.5, 'a')",
        "{x for x in [1, 1]}",
        "[1, 2, 3][-2:]",
        "[*[1, 2], 3]",
        "isinstance(1.0, float)",
        "{'k': 1}.get('z', 5)",
        "[(a, b) for a, b in {'k': 1}.items()]",
        "1 in [1] and 2 not in [1]",
        "round(1.2345, 2)",
        "abs(-3)",
        "len('abc')",
        "5 & 3 | 8 ^ 1",
        "1 << 4",
        "min(3, 1)",
        "dict(a=1)['a']",
        "None is None",
    ],
)
def test_expressions_have_the_values_of_python(text):
    assert evaluate(text) == eval(text)


def test_a_sum_has_the_same_bits_on_every_python():
    """From 3.12 on, Python's own sum is 1.0."""
    assert evaluate("sum([0.1] * 10)") == 0.9999999999999999
    assert evaluate("sum([[1], [2]], [0])") == [0, 1, 2]


@pytest.mark.parametrize(
    "text",
    [
        "().__class__",
        "(lambda: ().__class__)()",
        "(x for x in [1]).gi_frame",
        "''.join.__self__",
        "open('/etc/passwd')",
        "__import__('os')",
        "'{0.__class__}'.format(1)",
        "'{0[0]}'.format([1])",
        "len.__globals__",
        "abs.call",
        "vars()",
        "exec('1')",
        "[].__init__",
        "str.mro()",
        "(1).real",
        "type(1)('2')",
        "globals()",
        "x := 1",
        "eval('1')",
    ],
)
def test_expressions_cannot_access_python_internals(text):
    with pytest.raises(ExpansionError):
        evaluate(text)


@pytest.mark.slow
@pytest.mark.parametrize(
    "text",
    [
        "9 ** 9 ** 9",
        "'a' * 10 ** 9",
        "[0] * 10 ** 9",
        "list(range(10 ** 9))",
        "factorial(10 ** 6)",
        "1 << 10 ** 9",
        "'%999999999d' % 1",
        "'a'.zfill(10 ** 9)",
        "','.join(['a' * 9999] * 9999)",
        "'a' * 99999 + 'a' * 99999",
        "list(map(list, [list(range(9999))] * 9999))",
        "[1 for a in range(9000) for b in range(9000) if False]",
        "f'{1:999999999}'",
        "'aaaa'.replace('a', 'b' * 99999)",
        "(" * 500 + "1" + ")" * 500,
        "-" * 5000 + "1",
    ],
)
def test_values_and_computations_are_limited(text):
    with pytest.raises((BoundError, ExpansionError)):
        evaluate(text)


def test_expansions_leave_no_modules_and_do_not_share_state_between_threads(write):
    before, modules = minidom.Element.writexml, {m for m in sys.modules if "simkit_xacro" in m}
    files = [
        write(f"r{i}.xacro", xacro(f'<xacro:arg name="n" default="{i}"/><link name="l$(arg n)"/>')) for i in range(8)
    ]
    names: dict[int, str] = {}

    def run(index: int) -> None:
        for _ in range(5):
            document, _ = expanded(files[index])
            names[index] = document.root.children[0].attribute("name")

    threads = [threading.Thread(target=run, args=(i,)) for i in range(len(files))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert names == {i: f"l{i}" for i in range(len(files))}
    assert minidom.Element.writexml is before
    assert {m for m in sys.modules if "simkit_xacro" in m} == modules


def test_defaults_with_quotes_have_the_values_of_xacro_itself(write):
    import xacro as original

    for default in ("'''", "''", "'a b'", "^|'q'", "x'''", "'a'b'c'"):
        content = (
            f'<xacro:macro name="m" params="n:={default} k:=1"><a b="[${{n}}]" c="${{k}}"/></xacro:macro><xacro:m/>'
        )
        file = write("r.xacro", xacro(content))
        document, found = expanded(file)
        assert document is not None, [d.message for d in found]
        wanted = original.process_file(str(file)).getElementsByTagName("a")[0]
        (element,) = document.root.children
        assert element.attributes == {"b": wanted.getAttribute("b"), "c": "1"}


def test_a_variable_of_every_ros_installation_has_a_value_on_a_machine_without_ros(tmp_path, monkeypatch):
    monkeypatch.delenv("ROS_VERSION", raising=False)
    path = tmp_path / "robot.urdf.xacro"
    path.write_text("""<robot name="r" xmlns:xacro="http://www.ros.org/wiki/xacro">
      <xacro:property name="ros" value="$(env ROS_VERSION)"/>
      <xacro:if value="${int(ros) == 2 and int(ros) != 1}"><link name="two"/></xacro:if></robot>""")
    found = simkit.check(path)
    (warning,) = with_code(found, "SK-XACRO-005")
    assert "ROS_VERSION is not set; 2 is used" in warning.message
    assert simkit.describe(path)["model"]["links"][0]["name"] == "two"
    path.write_text(path.read_text().replace("ROS_VERSION", "ROS_MODEL"))
    (error,) = with_code(simkit.check(path), "SK-XACRO-001")
    assert "ROS_MODEL is not set" in error.message


def test_an_argument_that_only_a_substitution_uses_is_known() -> None:
    text = "<robot name='r' xmlns:xacro='x'><link name='$(arg side)_arm'/></robot>"
    found = simkit.describe(text, xacro_args={"side": "left"})["diagnostics"]
    assert "SK-XACRO-004" not in [d["code"] for d in found]
