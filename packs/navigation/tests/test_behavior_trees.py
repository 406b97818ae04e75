"""Behaviour trees: the reader, the rules of the nodes, and the messages about problems."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from simkit import msgs
from simkit.extend import Diagnostics
from simkit.msgs.goal_status import GoalStatus
from simkit_navigation.behavior_trees import default_trees
from simkit_navigation.behavior_trees.blackboard import Blackboard
from simkit_navigation.behavior_trees.known_nodes import NODES
from simkit_navigation.behavior_trees.scripts import Script, ScriptError
from simkit_navigation.behavior_trees.tree_node import Tree, TreeError
from simkit_navigation.behavior_trees.tree_reader import build_tree, read_tree_file
from simkit_navigation.plugins.navigation.planar_pose import PlanarPose, path_message, stamped_pose

SECOND = 1_000_000_000
HEADER = msgs.header(0, "map")


class Handle:
    """Goal of a server of a test."""

    def __init__(self, name: str, request: Any) -> None:
        self.action = type("Action", (), {"name": f"/{name}"})()
        self.request, self.status, self.result, self.feedback, self.reason = (
            request,
            GoalStatus.EXECUTING,
            None,
            None,
            "",
        )
        self.is_cancelled = False

    @property
    def is_done(self) -> bool:
        return self.status.is_final

    def cancel(self) -> None:
        self.is_cancelled = True

    def end(self, status: str, **result: Any) -> None:
        self.status, self.result = GoalStatus[status], type("Result", (), {"error_msg": "", **result})()


class Servers:
    """Navigator of a test: it records the goals and calls of a tree."""

    def __init__(self) -> None:
        self.time_ns, self.place = 0, PlanarPose(0.0, 0.0, 0.0)
        self.goals: list[Handle] = []
        self.calls: list[str] = []
        self.messages: dict[str, Any] = {}
        self.missing: set[str] = set()
        self.told: list[str] = []

    def tree_option(self, name: str, default: object) -> Any:
        return default

    def look_up(self, target: str, source: str) -> PlanarPose | None:
        return self.place

    def open_topic(self, topic: str, type_name: str) -> None:
        self.messages.setdefault(topic, None)

    def newest(self, topic: str) -> tuple[Any, Any]:
        return None, self.messages.get(topic)

    def send_goal(self, action: str, request: Any) -> Any:
        if action in self.missing:
            raise TreeError(f"no action '/{action}'")
        self.goals.append(Handle(action, request))
        return self.goals[-1]

    def call_service(self, service: str, request: Any) -> Any:
        self.calls.append(service)
        return type(
            "Call", (), {"is_done": True, "error": None, "response": msgs.make("std_srvs/srv/Empty_Response")}
        )()

    def warn_once(self, cause: str, text: str) -> None:
        self.told.append(text)


def problems_of(folder: Path, text: str) -> list[str]:
    """Return the problems of a tree as `line: code message`."""
    (folder / "tree.xml").write_text(text, "utf-8")
    found = Diagnostics()
    file = read_tree_file(folder / "tree.xml", found)
    if file is not None and not found.has_errors:
        build_tree(file, Servers(), found)
    return [f"{item.line}: {item.code} {item.message}" for item in found]


def tree_of(folder: Path, body: str, servers: Servers | None = None, version: str = "4") -> Tree:
    """Return the tree with nodes, and with further trees after `|`."""
    first, *others = body.split("|")
    more = "".join(f'<BehaviorTree ID="T{index}">{text}</BehaviorTree>' for index, text in enumerate(others))
    head = f'<root BTCPP_format="{version}" main_tree_to_execute="Main">'
    file = folder / "tree.xml"
    file.write_text(f'{head}<BehaviorTree ID="Main">{first}</BehaviorTree>{more}</root>', "utf-8")
    found = Diagnostics()
    read = read_tree_file(file, found)
    tree = None if read is None else build_tree(read, servers or Servers(), found)
    assert tree is not None and not found.has_errors, [str(item) for item in found]
    return tree


def script_of(values: str, **board: Any) -> Any:
    """Return the value of a script."""
    return Script(values).run(Blackboard(board))


def test_all_problems_of_a_tree_are_reported_with_their_lines(tmp_path: Path) -> None:
    text = """<root main_tree_to_execute="Main">
  <BehaviorTree ID="Main"><Sequence>
    <Spinn spin_dist="1"/>
    <Inverter/>
    <Spin spin_distance="1"/>
    <SubTree ID="Recover"/>
    <DockRobot dock_id="1"/>
    <Wait _skipIf="a +"/>
  </Sequence></BehaviorTree>
  <BehaviorTree ID="Recovery"><AlwaysSuccess/></BehaviorTree>
</root>"""
    assert problems_of(tmp_path, text) == [
        "3: SK-BT-002 there is no node <Spinn>",
        "4: SK-BT-004 <Inverter> has 0 children; it needs 1 child",
        "5: SK-BT-003 <Spin> has no port 'spin_distance'; it has no effect",
        "6: SK-BT-005 <SubTree>: there is no tree 'Recover'",
        "7: SK-BT-002 the node <DockRobot> of Nav2 is not available: robots do not dock",
        "8: SK-BT-006 <Wait> _skipIf: 'end' is not expected there",
    ]


DONE = "<AlwaysSuccess/>"
DEEP = "<Inverter>" * 110 + DONE + "</Inverter>" * 110


@pytest.mark.parametrize(
    ("content", "problem"),
    [
        ("", "1: SK-BT-001 the file has no <BehaviorTree>"),
        ("<BehaviorTree ID='A'><SubTree ID='A'/></BehaviorTree>", "1: SK-BT-005 the tree 'A' contains itself"),
        (f"<include path='../x.xml'/><BehaviorTree ID='A'>{DONE}</BehaviorTree>", "SK-BT-007"),
        (f"<include path='/etc/x.xml'/><BehaviorTree ID='A'>{DONE}</BehaviorTree>", "SK-BT-007"),
        (f"<BehaviorTree ID='A'>{DEEP}</BehaviorTree>", "deeper than 100"),
    ],
)
def test_a_file_that_is_no_usable_tree_is_an_error(tmp_path: Path, content: str, problem: str) -> None:
    assert problem in problems_of(tmp_path, f"<root>{content}</root>")[0]


def test_another_xml_file_is_an_error(tmp_path: Path) -> None:
    expected = "1: SK-BT-001 <robot> begins the file; a behaviour tree begins with <root>"
    assert problems_of(tmp_path, "<robot/>") == [expected]


def test_a_file_in_the_folder_is_included(tmp_path: Path) -> None:
    more = '<root><include path="tree.xml"/><BehaviorTree ID="B"><AlwaysFailure/></BehaviorTree></root>'
    (tmp_path / "more.xml").write_text(more)
    main = '<include path="more.xml"/><BehaviorTree ID="A"><SubTree ID="B"/></BehaviorTree>'
    text = f'<root main_tree_to_execute="A">{main}</root>'
    assert problems_of(tmp_path, text) == []


FILES = {f"{file.parent.name}-{file.stem}": file for file in sorted(default_trees.FOLDER.glob("*/*.xml"))}


@pytest.mark.parametrize("file", FILES.values(), ids=list(FILES))
def test_each_default_tree_is_read_without_a_problem_and_asks_for_its_first_server(file: Path) -> None:
    found, servers = Diagnostics(), Servers()
    read = read_tree_file(file, found)
    assert read is not None
    tree = build_tree(read, servers, found)
    assert tree is not None and not list(found)
    tree.board.set("goal", stamped_pose(PlanarPose(1.0, 2.0, 0.0), HEADER))
    tree.board.set("goals", [stamped_pose(PlanarPose(1.0, 2.0, 0.0), HEADER)])
    assert tree.tick() == "RUNNING"
    first = "drive_on_heading" if "calibration" in file.name else "compute_path"
    assert servers.goals[0].action.name.startswith(f"/{first}")


def test_a_default_tree_is_found_by_its_name_and_by_the_folder_of_its_package(tmp_path: Path) -> None:
    name = "navigate_w_replanning_distance.xml"
    for text, version in (
        (name, "jazzy"),
        (f"$(find-pkg-share nav2_bt_navigator)/behavior_trees/{name}", "jazzy"),
        (f"/opt/ros/humble/share/nav2_bt_navigator/behavior_trees/{name}", "humble"),
    ):
        assert default_trees.find_tree_file(text, ()) == default_trees.FOLDER / version / name
    assert default_trees.find_tree_file(f"/elsewhere/{name}", ()) is None
    name_in_foxy = "navigate_w_replanning_and_recovery.xml"  # in turtlebot3_navigation2/param/humble/burger.yaml
    assert default_trees.find_tree_file(name_in_foxy, ()) == default_trees.FOLDER / "humble" / default_trees.TO_POSE
    (tmp_path / name).write_text("<root/>")
    assert default_trees.find_tree_file(name, (tmp_path,)) == tmp_path / name


# ---------------------------------------------------------------------- rules of the nodes


def statuses(tree: Tree, count: int) -> str:
    """Return the first letters of the statuses of several ticks."""
    return "".join(tree.tick()[:2] for _ in range(count))


@pytest.mark.parametrize(
    ("body", "expected"),
    [
        ("<Sequence><AlwaysSuccess/><AlwaysFailure/></Sequence>", "FA"),
        ("<Fallback><AlwaysFailure/><AlwaysSuccess/></Fallback>", "SU"),
        ("<Sequence><AlwaysSuccess _skipIf='true'/></Sequence>", "SK"),
        ("<Inverter><AlwaysSuccess/></Inverter>", "FA"),
        ("<ForceSuccess><AlwaysFailure/></ForceSuccess>", "SU"),
        ("<Parallel success_count='1' failure_count='2'><AlwaysFailure/><AlwaysSuccess/></Parallel>", "SU"),
        ("<ParallelAll max_failures='2'><AlwaysFailure/><AlwaysSuccess/></ParallelAll>", "SU"),
        ("<IfThenElse><AlwaysFailure/><AlwaysFailure/><AlwaysSuccess/></IfThenElse>", "SU"),
        ("<WhileDoElse><AlwaysSuccess/><AlwaysFailure/><AlwaysSuccess/></WhileDoElse>", "FA"),
        ("<Repeat num_cycles='3'><AlwaysSuccess/></Repeat>", "RURUSU"),
        ("<RetryUntilSuccessful num_attempts='2'><AlwaysFailure/></RetryUntilSuccessful>", "RUFA"),
        ("<KeepRunningUntilFailure><AlwaysSuccess/></KeepRunningUntilFailure>", "RURU"),
        ("<RunOnce><AlwaysFailure/></RunOnce>", "FASK"),
        ("<RecoveryNode number_of_retries='3'><AlwaysFailure/><AlwaysSuccess/></RecoveryNode>", "FA"),
        ("<RoundRobin><AlwaysFailure/><AlwaysSuccess/><AlwaysFailure/></RoundRobin>", "SUSU"),
        ("<SingleTrigger><AlwaysSuccess/></SingleTrigger>", "SUFA"),
        (
            "<Sequence><Script code='n := 2'/><Switch2 variable='{n}' case_1='1' case_2='2'>"
            "<AlwaysFailure/><AlwaysSuccess/><AlwaysFailure/></Switch2></Sequence>",
            "SU",
        ),
        ("<Sequence><SetBlackboard value='5' output_key='n'/><ScriptCondition code='n &lt; 5'/></Sequence>", "FA"),
        ("<AreErrorCodesPresent error_code='7' error_codes_to_check='5;7'/>", "SU"),
        ("<WouldAPlannerRecoveryHelp error_code='204'/>", "FA"),
        ("<GlobalUpdatedGoal/>", "SUFA"),
    ],
)
def test_a_node_returns_the_statuses_of_behaviortree_cpp(tmp_path: Path, body: str, expected: str) -> None:
    assert statuses(tree_of(tmp_path, body), len(expected) // 2) == expected


def test_a_round_robin_begins_with_the_next_child_after_a_success(tmp_path: Path) -> None:
    servers = Servers()
    tree = tree_of(tmp_path, "<RoundRobin><Spin/><Wait/><BackUp/></RoundRobin>", servers)
    for _ in range(4):
        tree.tick()
        servers.goals[-1].end("SUCCEEDED")
        assert tree.tick() == "SUCCESS"
    assert [goal.action.name for goal in servers.goals] == ["/spin", "/wait", "/backup", "/spin"]
    assert tree.recoveries == 4


def test_a_pipeline_ticks_the_planner_again_while_the_controller_drives(tmp_path: Path) -> None:
    servers = Servers()
    body = (
        '<PipelineSequence><RateController hz="1"><ComputePathToPose goal="{goal}" path="{path}"/></RateController>'
        '<FollowPath path="{path}"/></PipelineSequence>'
    )
    tree = tree_of(tmp_path, body, servers)
    for tick in range(25):
        servers.time_ns = tick * SECOND // 10
        tree.tick()
        for goal in servers.goals:
            if "compute" in goal.action.name and not goal.is_done:
                goal.end("SUCCEEDED", path=path_message(PATH + tick, HEADER))
    names = [goal.action.name for goal in servers.goals]
    assert names.count("/compute_path_to_pose") == 3
    assert names.count("/follow_path") == 3  # each new path is a new goal
    servers.goals[-1].end("SUCCEEDED")
    assert tree.tick() == "SUCCESS"


PATH = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [3.0, 0.0, 0.0]])


def test_a_new_goal_ends_the_recovery_that_runs(tmp_path: Path) -> None:
    servers = Servers()
    tree = tree_of(tmp_path, "<ReactiveFallback><GoalUpdated/><Spin/></ReactiveFallback>", servers)
    tree.board.set("goal", stamped_pose(PlanarPose(1.0, 0.0, 0.0), HEADER))
    assert statuses(tree, 3) == "RURURU"
    tree.board.set("goal", stamped_pose(PlanarPose(2.0, 0.0, 0.0), HEADER))
    assert tree.tick() == "SUCCESS" and servers.goals[0].is_cancelled


def test_a_halt_cancels_the_goals_of_the_nodes(tmp_path: Path) -> None:
    servers = Servers()
    tree = tree_of(tmp_path, "<Sequence><Delay delay_msec='100'><Wait wait_duration='5'/></Delay></Sequence>", servers)
    assert tree.tick() == "RUNNING" and not servers.goals
    servers.time_ns = SECOND // 10
    assert tree.tick() == "RUNNING" and servers.goals[0].request["time"].sec == 5
    tree.halt()
    assert servers.goals[0].is_cancelled and {node.status for node in tree.nodes} == {"IDLE"}


def test_a_timeout_halts_its_child(tmp_path: Path) -> None:
    servers = Servers()
    tree = tree_of(tmp_path, "<Timeout msec='500'><Wait wait_duration='5'/></Timeout>", servers)
    assert statuses(tree, 2) == "RURU"
    servers.time_ns = SECOND // 2
    assert tree.tick() == "FAILURE" and servers.goals[0].is_cancelled


def test_the_error_of_a_server_is_on_the_blackboard_and_a_missing_server_is_told(tmp_path: Path) -> None:
    servers = Servers()
    servers.missing = {"wait"}
    tree = tree_of(tmp_path, "<Fallback><Spin error_code_id='{code}' error_msg='{text}'/><Wait/></Fallback>", servers)
    tree.tick()
    servers.goals[0].end("ABORTED", error_code=703, error_msg="a wall")
    assert tree.tick() == "FAILURE"
    assert (tree.board.get("code"), tree.board.get("text"), tree.failure) == (703, "a wall", (703, "a wall"))
    assert servers.told == ["no action '/wait'; its node in the tree fails"]


@pytest.mark.parametrize(
    ("version", "subtree"),
    [
        ("4", "<SubTree ID='T0' inner='{outer}' text='word'/>"),
        ("4", "<SubTree ID='T0' _autoremap='true' inner='{outer}' text='word'/>"),
        ("3", "<SubTreePlus ID='T0' inner='{outer}' text='word'/>"),
    ],
)
def test_a_subtree_has_a_blackboard_of_its_own(tmp_path: Path, version: str, subtree: str) -> None:
    second = "<SetBlackboard value='1' output_key='own'/>"
    inner = f"<Sequence><SetBlackboard value='{{text}}' output_key='{{inner}}'/>{second}</Sequence>"
    tree = tree_of(tmp_path, f"<Sequence>{subtree}</Sequence>|{inner}", version=version)
    assert tree.tick() == "SUCCESS"
    assert tree.board.get("outer") == "word" and tree.board.has("inner") is False
    assert tree.board.has("own") is ("_autoremap" in subtree)


def test_paths_are_truncated_and_passed_goals_removed(tmp_path: Path) -> None:
    servers = Servers()
    body = (
        "<Sequence><TruncatePath distance='1.5' input_path='{path}' output_path='{short}'/>"
        "<TruncatePathLocal input_path='{path}' output_path='{near}' distance_forward='0.5' distance_backward='0'/>"
        "<GetPoseFromPath path='{path}' index='-1' pose='{end}'/>"
        "<RemovePassedGoals input_goals='{goals}' output_goals='{goals}' radius='0.7'/></Sequence>"
    )
    tree = tree_of(tmp_path, body, servers)
    path = path_message(PATH, HEADER)
    tree.board.set("path", path)
    tree.board.set("goals", path.poses[1:])
    servers.place = PlanarPose(1.1, 0.0, 0.0)
    assert tree.tick() == "SUCCESS"
    xs = {name: [pose.pose.position.x for pose in tree.board.get(name).poses] for name in ("short", "near")}
    assert xs == {"short": [0.0, 1.0], "near": [1.0]}
    assert tree.board.get("end") == path.poses[-1] and tree.board.get("goals") == path.poses[2:]


@pytest.mark.parametrize(
    ("code", "value"),
    [
        ("1 + 2 * 3 == 7 && !false", True),
        ("n := 4; n -= 1; n > 2 ? 'yes' : 'no'", "yes"),
        ("'a' .. 1", "a1"),
        ("-(2 - 5) / 2", 1.5),
        ("m == 5", True),
    ],
)
def test_scripts_compute_values(code: str, value: object) -> None:
    assert script_of(code, m="5") == value


@pytest.mark.parametrize(
    ("code", "problem"),
    [("n + 1", "no entry 'n'"), ("1 / 0", "zero"), ("n = 1", "':=' creates"), ("'a' * 2", "combine")],
)
def test_a_script_with_an_error_names_it(code: str, problem: str) -> None:
    with pytest.raises(ScriptError, match=problem):
        script_of(code)


def test_the_page_names_each_node() -> None:
    page = (Path(__file__).parents[1] / "docs/behavior_trees.md").read_text("utf-8")
    hidden = {"inverter", "RetryUntilSuccesful", "ParallelNode", "initialPoseReceived"}
    hidden |= {"clearEntirelyCostmapServiceRequest", "globalLocalizationServiceRequest"}
    assert [name for name in NODES if f"`{name}`" not in page and name not in hidden] == []
