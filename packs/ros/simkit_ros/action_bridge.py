"""Actions of a simulation in ROS: three services and two topics for each action, as ROS 2 defines them.

SendGoal, its goal's id and feedback begin with 16 bytes of id, so the CDR after the id is that of the goal or the
feedback itself. A result follows a single byte of status, which shifts its alignment: the simulation encodes it.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import TYPE_CHECKING

from simkit.bridges.live.protocol import JsonObject, LiveError
from simkit.bridges.simulation_link import CDR_HEADER, SimulationLink
from simkit.msgs.goal_status import GoalStatus
from simkit_ros.ros_session import Qos, RequestHeader, RosSession, ServiceEnd
from simkit_ros.ros_types import RosType

if TYPE_CHECKING:
    from action_msgs.msg import GoalInfo

_ID_END = 4 + 16  # bytes of the CDR header and of a goal's id
_MOST_ENDED = 100  # ended goals of an action whose results are kept
_STATUS_QOS = Qos(is_latched=True, depth=1)
_NONE, _REJECTED, _UNKNOWN_GOAL, _TERMINATED = range(4)  # return codes of action_msgs/srv/CancelGoal


class _Goal:
    """Goal of a ROS client.

    Attributes:
        id: id of the goal in ROS, 16 bytes.
        number: number of the goal in the connection to the simulation.
        stamp_ns: simulated time at which the goal arrived [ns].
        result: response of GetResult as CDR, once the goal has ended.
        waiting: headers of the requests for the result.
    """

    def __init__(self, goal_id: bytes, number: int, stamp_ns: int) -> None:
        self.id, self.number, self.stamp_ns = goal_id, number, stamp_ns
        self.status = GoalStatus.UNKNOWN
        self.result: bytes | None = None
        self.waiting: list[RequestHeader] = []

    def stamp(self) -> tuple[int, int]:
        """Return the seconds and nanoseconds of the time at which the goal arrived."""
        return divmod(self.stamp_ns, 10**9)


class ActionBridge:
    """Action of the simulation that ROS can use.

    Args:
        link: connection to the simulation.
        session: session of ROS; its thread must be stopped while an action is opened or closed.
        action: name in the simulation.
        name: name in ROS.
        type_name: type of the action, such as `control_msgs/action/FollowJointTrajectory`.
        now: function that returns the simulated time [ns].
        report: callback for a note to the user.

    Raises:
        TypeUnavailable: the type cannot be passed on.
    """

    def __init__(
        self,
        link: SimulationLink,
        session: RosSession,
        action: str,
        name: str,
        type_name: str,
        now: Callable[[], int],
        report: Callable[[str], None],
    ) -> None:
        from action_msgs.msg import GoalStatusArray
        from action_msgs.srv import CancelGoal

        find = session.types.find
        send, result, feedback = (find(f"{type_name}_{part}") for part in ("SendGoal", "GetResult", "FeedbackMessage"))
        self._link, self._session, self.action, self.type_name = link, session, action, type_name
        self._now, self._report = now, report
        self._goals: dict[bytes, _Goal] = {}
        self._is_closed = False
        # resolved here, because a remapping of the action's name concerns all of its services and topics
        begin = session.node.resolve_service_name(name) + "/_action/"
        self._cancel_type, self._status_class = CancelGoal, GoalStatusArray
        cancel = RosType("action_msgs/srv/CancelGoal", CancelGoal)
        self._send_end = session.offer(begin + "send_goal", send)
        self._cancel_end = session.offer(begin + "cancel_goal", cancel)
        self._result_end = session.offer(begin + "get_result", result)
        self._feedback = session.advertise(begin + "feedback", feedback, Qos())
        status = RosType("action_msgs/msg/GoalStatusArray", GoalStatusArray)
        self._status = session.advertise(begin + "status", status, _STATUS_QOS)

    @property
    def ends(self) -> list[ServiceEnd]:
        """Service servers of rclpy."""
        return [self._send_end, self._cancel_end, self._result_end]

    def take(self) -> None:
        """Process the requests that have arrived."""
        for end, process in (
            (self._send_end, self._send),
            (self._cancel_end, self._cancel),
            (self._result_end, self._get),
        ):
            while (request := end.take()) is not None:
                process(*request)

    # ------------------------------------------------------------------ goals

    def _send(self, data: bytes, header: RequestHeader) -> None:
        goal = _Goal(data[4:_ID_END], self._link.next_number(), self._now())
        if goal.id in self._goals:
            self._accept(header, goal, False)
            return
        self._goals[goal.id] = goal
        self._link.goals[goal.number] = lambda words, data: self._update(goal, header, words, data)
        args = {"name": self.action, "number": goal.number, "type": f"{self.type_name}_Goal"}

        def refuse(error: LiveError) -> None:
            self._report(f"{self.action} rejected a goal: {error}")
            self._forget(goal)
            self._accept(header, goal, False)

        self._link.ask("goal", args, CDR_HEADER + data[_ID_END:], failed=refuse)

    def _accept(self, header: RequestHeader, goal: _Goal, is_accepted: bool) -> None:
        if not self._is_closed:
            self._send_end.respond(header, CDR_HEADER + struct.pack("<?3xiI", is_accepted, *goal.stamp()))

    def _update(self, goal: _Goal, header: RequestHeader, words: JsonObject, data: bytes) -> None:
        """Process feedback, a status or a result of a goal."""
        if self._is_closed:
            return
        if "status" not in words:
            self._feedback.publish(CDR_HEADER + goal.id + data[4:])
            return
        before, goal.status = goal.status, GoalStatus(int(words["status"]))
        if goal.status is GoalStatus.UNKNOWN:
            return
        if before is GoalStatus.UNKNOWN:
            self._accept(header, goal, goal.status is not GoalStatus.REJECTED)
        if goal.status is GoalStatus.REJECTED:
            self._forget(goal)
            return
        self._publish_status()
        if goal.status.is_final:
            self._link.goals.pop(goal.number, None)
            args = {"action": self.type_name, "status": int(goal.status)}
            if data:
                args["type"] = f"{self.type_name}_Result"
            self._link.ask("goal_result", args, data, then=lambda _, result: self._end_goal(goal, result))

    def _end_goal(self, goal: _Goal, result: bytes) -> None:
        goal.result = result
        for header in goal.waiting:
            if not self._is_closed:
                self._result_end.respond(header, result)
        goal.waiting.clear()
        ended = [g for g in self._goals.values() if g.result is not None]
        for old in ended[:-_MOST_ENDED]:
            del self._goals[old.id]

    def _forget(self, goal: _Goal) -> None:
        self._goals.pop(goal.id, None)
        self._link.goals.pop(goal.number, None)

    def _get(self, data: bytes, header: RequestHeader) -> None:
        """Answer a request for a result, now or when the goal ends."""
        goal = self._goals.get(data[4:_ID_END])
        if goal is None:
            args = {"action": self.type_name, "status": int(GoalStatus.UNKNOWN)}
            self._link.ask("goal_result", args, then=lambda _, result: self._respond_result(header, result))
        elif goal.result is not None:
            self._respond_result(header, goal.result)
        else:
            goal.waiting.append(header)

    def _respond_result(self, header: RequestHeader, result: bytes) -> None:
        if not self._is_closed:
            self._result_end.respond(header, result)

    # ------------------------------------------------------------------ cancellation and status

    def _cancel(self, data: bytes, header: RequestHeader) -> None:
        from rclpy.serialization import deserialize_message, serialize_message

        info = deserialize_message(data, self._cancel_type.Request).goal_info
        goal_id, stamp_ns = bytes(info.goal_id.uuid), info.stamp.sec * 10**9 + info.stamp.nanosec
        response = self._cancel_type.Response()
        is_any = not any(goal_id)
        for goal in self._goals.values():
            is_named = goal.id == goal_id
            is_old = goal.stamp_ns <= stamp_ns if stamp_ns else is_any
            if goal.status.is_final or not (is_named or is_old):
                continue
            self._link.ask("cancel", {"number": goal.number})
            response.goals_canceling.append(self._goal_info(goal, type(info)()))
        if not response.goals_canceling and not is_any:
            response.return_code = _TERMINATED if goal_id in self._goals else _UNKNOWN_GOAL
        self._cancel_end.respond(header, bytes(serialize_message(response)))

    def _goal_info(self, goal: _Goal, info: GoalInfo) -> GoalInfo:
        info.goal_id.uuid = list(goal.id)
        info.stamp.sec, info.stamp.nanosec = goal.stamp()
        return info

    def _publish_status(self) -> None:
        from action_msgs.msg import GoalStatus as StatusMessage

        statuses = self._status_class()
        for goal in self._goals.values():
            if goal.status is not GoalStatus.UNKNOWN:
                entry = StatusMessage(status=int(goal.status))
                self._goal_info(goal, entry.goal_info)
                statuses.status_list.append(entry)
        self._status.publish(statuses)

    def close(self) -> None:
        """Close the action in ROS; its goals continue in the simulation."""
        self._is_closed = True
        for end in self.ends:
            self._session.close_service(end)
        for publisher in (self._feedback, self._status):
            self._session.node.destroy_publisher(publisher)
