"""Nodes with several children: those of BehaviorTree.CPP (`src/controls`) and of Nav2 (`plugins/control`)."""

from __future__ import annotations

from typing import ClassVar, Final

from simkit_navigation.behavior_trees.tree_node import (
    FAILURE,
    RUNNING,
    SKIPPED,
    SUCCESS,
    ControlNode,
    Ports,
    TreeError,
)


class Sequence(ControlNode):
    """Ticks the children in turn until one fails."""

    stops: ClassVar[str] = FAILURE
    restarts: ClassVar[bool] = True
    """False if a child that has succeeded is not ticked again after another one has failed."""

    def prepare(self) -> None:
        self.index = self.skipped = 0

    def clear(self) -> None:
        self.index = self.skipped = 0

    def tick(self) -> str:
        if not self.is_active:
            self.skipped = 0
        self.set_status(RUNNING)
        while self.index < len(self.children):
            status = self.children[self.index].execute()
            if status == RUNNING:
                return RUNNING
            if status == self.stops:
                if self.restarts:
                    self.reset_children()
                    self.index = 0
                else:
                    for index in range(self.index, len(self.children)):
                        self.halt_child(index)
                return status
            self.index += 1
            self.skipped += status == SKIPPED
        are_all_skipped = self.skipped == len(self.children)
        self.reset_children()
        self.index = self.skipped = 0
        return SKIPPED if are_all_skipped else SUCCESS if self.stops == FAILURE else FAILURE


class SequenceWithMemory(Sequence):
    """Ticks the children in turn until one fails, and begins with that one the next time."""

    restarts = False


class Fallback(Sequence):
    """Ticks the children in turn until one succeeds."""

    stops = SUCCESS


class ReactiveSequence(ControlNode):
    """Ticks all children from the first one on at each tick, until one fails or is running."""

    stops: ClassVar[str] = FAILURE

    def tick(self) -> str:
        are_all_skipped = True
        self.set_status(RUNNING)
        for index, child in enumerate(self.children):
            status = child.execute()
            are_all_skipped &= status == SKIPPED
            if status == RUNNING:
                for other in range(len(self.children)):
                    if other != index:
                        self.halt_child(other)
                return RUNNING
            if status == self.stops:
                self.reset_children()
                return status
            if status == SKIPPED:
                self.halt_child(index)
        self.reset_children()
        return SKIPPED if are_all_skipped else SUCCESS if self.stops == FAILURE else FAILURE


class ReactiveFallback(ReactiveSequence):
    """Ticks all children from the first one on at each tick, until one succeeds or is running."""

    stops = SUCCESS


class Parallel(ControlNode):
    """Ticks all children at each tick, until enough have succeeded or failed."""

    ports: ClassVar[Ports] = (
        "success_count",
        "failure_count",
        "threshold",
        "success_threshold",
        "failure_threshold",
        "threshold_M",
    )

    def prepare(self) -> None:
        self.clear()

    def clear(self) -> None:
        self.completed: dict[int, str] = {}

    def _threshold(self, names: tuple[str, ...], default: int) -> int:
        threshold = next((self.integer(name, default) for name in names if name in self.inputs), default)
        return max(len(self.children) + threshold + 1, 0) if threshold < 0 else threshold

    def tick(self) -> str:
        enough = self._threshold(("success_count", "success_threshold", "threshold", "threshold_M"), -1)
        too_many = self._threshold(("failure_count", "failure_threshold"), 1)
        count = len(self.children)
        if count < enough or count < too_many:
            raise TreeError(f"<{self.tag}> has {count} children, fewer than its threshold")
        self.set_status(RUNNING)
        skipped = 0
        for index, child in enumerate(self.children):
            if index not in self.completed:
                status = child.execute()
                skipped += status == SKIPPED
                if status in (SUCCESS, FAILURE):
                    self.completed[index] = status
            results = list(self.completed.values())
            successes, failures = results.count(SUCCESS), results.count(FAILURE)
            ended = ""
            if successes >= enough or (enough == count and successes + skipped >= enough):
                ended = SUCCESS
            elif count - failures < enough or failures == too_many:
                ended = FAILURE
            if ended:
                self.clear()
                self.reset_children()
                return ended
        return SKIPPED if skipped == count else RUNNING


class ParallelAll(ControlNode):
    """Ticks all children until all have ended; fails after `max_failures` failures."""

    ports: ClassVar[Ports] = ("max_failures",)

    def prepare(self) -> None:
        self.clear()

    def clear(self) -> None:
        self.completed: dict[int, str] = {}

    def tick(self) -> str:
        most, count, skipped = self.integer("max_failures", 1), len(self.children), 0
        most = max(count + most + 1, 0) if most < 0 else most
        self.set_status(RUNNING)
        for index, child in enumerate(self.children):
            if index not in self.completed:
                status = child.execute()
                skipped += status == SKIPPED
                if status in (SUCCESS, FAILURE):
                    self.completed[index] = status
        if skipped == count:
            return SKIPPED
        if skipped + len(self.completed) < count:
            return RUNNING
        failures = list(self.completed.values()).count(FAILURE)
        self.reset_children()
        self.clear()
        return FAILURE if failures >= most else SUCCESS


class IfThenElse(ControlNode):
    """Ticks the second child if the first one succeeds, or else the third one."""

    child_counts: ClassVar[tuple[int, int | None]] = (2, 3)

    def prepare(self) -> None:
        self.index = 0

    def clear(self) -> None:
        self.index = 0

    def tick(self) -> str:
        self.set_status(RUNNING)
        if self.index == 0:
            status = self.children[0].execute()
            if status in (RUNNING, SKIPPED):
                return status
            if status == FAILURE and len(self.children) == 2:
                return FAILURE
            self.index = 1 if status == SUCCESS else 2
        status = self.children[self.index].execute()
        if status != RUNNING:
            self.reset_children()
            self.index = 0
        return status


class WhileDoElse(ControlNode):
    """Ticks the second child while the first one succeeds, or else the third one; checks at each tick."""

    child_counts: ClassVar[tuple[int, int | None]] = (2, 3)

    def tick(self) -> str:
        self.set_status(RUNNING)
        condition = self.children[0].execute()
        if condition in (RUNNING, SKIPPED):
            return condition
        has_else = len(self.children) == 3
        if condition == SUCCESS:
            if has_else:
                self.halt_child(2)
            status = self.children[1].execute()
        else:
            self.halt_child(1)
            status = self.children[2].execute() if has_else else FAILURE
        if status != RUNNING:
            self.reset_children()
        return status


class Switch(ControlNode):
    """Ticks the child whose case equals a variable, or the last child."""

    ports: ClassVar[Ports] = ("variable", *(f"case_{index}" for index in range(1, 7)))

    def prepare(self) -> None:
        self.running: int | None = None

    def clear(self) -> None:
        self.running = None

    def tick(self) -> str:
        cases = int(self.tag[-1])
        if len(self.children) != cases + 1:
            raise TreeError(f"<{self.tag}> has {len(self.children)} children; it needs {cases + 1}")
        chosen = cases
        if self.has_input("variable"):
            value = self.input("variable")
            texts = [self.input(f"case_{index}") for index in range(1, cases + 1)]
            chosen = next((index for index, text in enumerate(texts) if _is_equal(value, text)), cases)
        if self.running is not None and self.running != chosen:
            self.halt_child(self.running)
        status = self.children[chosen].execute()
        self.running = chosen if status == RUNNING else None
        if status in (SUCCESS, FAILURE):
            self.reset_children()
        return status


def _is_equal(value: object, text: object) -> bool:
    if text is None:
        return False
    try:
        return str(value) == str(text) or float(str(value)) == float(str(text))
    except ValueError:
        return False


class PipelineSequence(ControlNode):
    """Ticks the children in turn, and at each tick again those before the one that is running."""

    def prepare(self) -> None:
        self.last = 0

    def clear(self) -> None:
        self.last = 0

    def tick(self) -> str:
        skipped = 0
        for index, child in enumerate(self.children):
            status = child.execute()
            skipped += status == SKIPPED
            if status == FAILURE:
                self.reset_children()
                self.last = 0
                return FAILURE
            if status == RUNNING and index >= self.last:
                self.last = index
                return RUNNING
        self.reset_children()
        self.last = 0
        return SKIPPED if skipped == len(self.children) else SUCCESS


class RoundRobin(ControlNode):
    """Ticks the children in turn until one succeeds, and begins with the next one the next time."""

    ports: ClassVar[Ports] = ("wrap_around",)

    def prepare(self) -> None:
        self.index = self.failed = 0

    def clear(self) -> None:
        self.index = self.failed = 0

    def tick(self) -> str:
        wraps = self.boolean("wrap_around", True)  # the default of Humble and Jazzy
        self.set_status(RUNNING)
        skipped, count = 0, len(self.children)
        while self.failed + skipped < count:
            status = self.children[self.index].execute()
            if status == RUNNING:
                return RUNNING
            self.index += 1
            is_end = self.index == count
            if is_end:
                self.index = 0
            if status == SUCCESS:
                self.failed = 0
                self.reset_children()
                return SUCCESS
            self.failed += status == FAILURE
            skipped += status == SKIPPED
            if is_end and not wraps:
                break
        self.halt()
        return SKIPPED if skipped == count else FAILURE


class RecoveryNode(ControlNode):
    """Ticks the first child; if it fails, ticks the second one and then the first one again."""

    ports: ClassVar[Ports] = ("number_of_retries", "num_of_retries")
    child_counts: ClassVar[tuple[int, int | None]] = (2, 2)

    def prepare(self) -> None:
        self.index = self.retries = 0

    def clear(self) -> None:
        self.index = self.retries = 0

    def tick(self) -> str:
        most = self.integer("number_of_retries" if "number_of_retries" in self.inputs else "num_of_retries", 1)
        self.set_status(RUNNING)
        while self.retries <= most:
            status = self.children[self.index].execute()
            if status == RUNNING:
                return RUNNING
            if self.index == 0:
                if status == FAILURE and self.retries < most:
                    self.halt_child(0)
                    self.index = 1
                    continue
                self.halt()
                return status
            if status == SKIPPED:
                self.index = 0
                self.halt_child(1)
                return FAILURE
            if status == FAILURE:
                self.halt()
                return FAILURE
            self.halt_child(1)
            self.retries += 1
            self.index = 0
        self.halt()
        return FAILURE


class NonblockingSequence(ControlNode):
    """Ticks all children at each tick until all have succeeded or one has failed."""

    def tick(self) -> str:
        have_all_succeeded = True
        for child in self.children:
            status = child.execute()
            if status == FAILURE:
                self.reset_children()
                return FAILURE
            have_all_succeeded &= status != RUNNING
        if not have_all_succeeded:
            return RUNNING
        self.reset_children()
        return SUCCESS


class PersistentSequence(ControlNode):
    """Sequence whose present child is an entry of the blackboard."""

    ports: ClassVar[Ports] = ("current_child_idx",)

    def tick(self) -> str:
        if not self.has_input("current_child_idx"):
            raise TreeError("<PersistentSequence> current_child_idx has no value; set it with <Script>")
        index = self.integer("current_child_idx", 0)
        self.set_status(RUNNING)
        while 0 <= index < len(self.children):
            status = self.children[index].execute()
            if status == RUNNING:
                return RUNNING
            if status == FAILURE:
                self.reset_children()
                self.output("current_child_idx", 0)
                return FAILURE
            index += 1
            self.output("current_child_idx", index)
        self.reset_children()
        self.output("current_child_idx", 0)
        return SUCCESS


CONTROL_NODES: Final = {
    "Sequence": Sequence,
    "AsyncSequence": Sequence,
    "SequenceWithMemory": SequenceWithMemory,
    "SequenceStar": SequenceWithMemory,
    "Fallback": Fallback,
    "AsyncFallback": Fallback,
    "FallbackStar": Fallback,
    "ReactiveSequence": ReactiveSequence,
    "ReactiveFallback": ReactiveFallback,
    "Parallel": Parallel,
    "ParallelNode": Parallel,
    "ParallelAll": ParallelAll,
    "IfThenElse": IfThenElse,
    "WhileDoElse": WhileDoElse,
    **{f"Switch{cases}": Switch for cases in range(2, 7)},
    "PipelineSequence": PipelineSequence,
    "RoundRobin": RoundRobin,
    "RecoveryNode": RecoveryNode,
    "NonblockingSequence": NonblockingSequence,
    "PersistentSequence": PersistentSequence,
}
"""Classes by their name in a file."""
