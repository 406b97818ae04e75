"""Runner for worlds in scripts, as in gz-sim: `TestFixture`, `Server` and `ServerConfig`."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import ClassVar, Final

from simkit import load
from simkit_gz_python import transport
from simkit_gz_python.sim.entity_component_manager import EntityComponentManager, manager_of
from simkit_gz_python.sim.system_hub import EventManager, UpdateInfo, update_paused

__all__ = ["Server", "ServerConfig", "TestFixture"]

_EMPTY: Final = "<sdf version='1.9'><world name='default'/></sdf>"


class ServerConfig:
    """Configuration of a server: the world and the seed."""

    def __init__(self) -> None:
        self._source: str = _EMPTY
        self._seed = 0

    def set_sdf_file(self, path: object) -> bool:
        """Set the world file."""
        self._source = str(path)
        return True

    def set_sdf_string(self, text: str) -> bool:
        """Set the world as SDF text."""
        self._source = str(text)
        return True

    def set_seed(self, seed: int) -> None:
        """Set the seed of the sensor noise."""
        self._seed = int(seed)


class _Callbacks:
    """System that calls the callbacks of a fixture; a reset does not remove the callbacks."""

    __slots__ = ("given", "hooks", "is_final", "steps")

    def __init__(self) -> None:
        self.hooks: dict[str, list[Callable[..., None]]] = {}
        self.is_final = False
        self.given: tuple[object, ...] = ()
        self.steps = 0

    def call(self, hook: str, *values: object) -> None:
        if self.is_final:
            for callback in self.hooks.get(hook, ()):
                callback(*values)

    def configure(self, entity: int, sdf: object, ecm: EntityComponentManager, events: EventManager) -> None:
        self.given = (entity, sdf, ecm, events)

    def pre_update(self, info: UpdateInfo, ecm: EntityComponentManager) -> None:
        self.steps += 1
        self.call("pre_update", info, ecm)

    def update(self, info: UpdateInfo, ecm: EntityComponentManager) -> None:
        self.call("update", info, ecm)

    def post_update(self, info: UpdateInfo, ecm: EntityComponentManager) -> None:
        self.call("post_update", info, ecm)

    def reset(self, info: UpdateInfo, ecm: EntityComponentManager) -> None:
        self.call("reset", info, ecm)

    def __deepcopy__(self, memo: dict[int, object]) -> _Callbacks:
        return self


class Server:
    """Runner of a world in this process.

    Attributes:
        simulation: simkit's simulation of the world.
    """

    def __init__(self, config: ServerConfig | None = None, callbacks: _Callbacks | None = None) -> None:
        chosen = config if config is not None else ServerConfig()
        self._callbacks = callbacks if callbacks is not None else _Callbacks()
        self.simulation = load(chosen._source, seed=chosen._seed, plugins=[self._callbacks])
        self._thread: threading.Thread | None = None
        self._stops = False
        transport.adopt_early_nodes(self.simulation)

    # ------------------------------------------------------------------ running

    def run(self, blocking: bool = False, iterations: int = 0, paused: bool = True) -> bool:
        """Run a number of iterations; with 0, run until `stop` is called.

        A fixed number of iterations is always complete when the method returns, even if `blocking` is false. Then
        `is_running` is false. An endless run uses a separate thread if `blocking` is false; the thread ends at `stop`.

        Args:
            blocking: Wait for the end of an endless run.
            iterations: Number of iterations.
            paused: Call the hooks without stepping the physics.

        Returns:
            True if the world ran; False if another thread already runs the world.
        """
        if self.is_running():
            return False
        if iterations or blocking:
            try:
                self._go(iterations, paused)
            except KeyboardInterrupt:
                if iterations:
                    raise  # Ctrl-C is a regular end, but only of an endless run
            return True
        self._stops = False
        self._thread = threading.Thread(target=self._go, args=(0, paused), daemon=True, name="gz-server")
        self._thread.start()
        return True

    def run_once(self, paused: bool = False) -> bool:
        """Run one iteration."""
        return self.run(True, 1, paused)

    def _go(self, iterations: int, paused: bool) -> None:
        done, sim, calls = 0, self.simulation, self._callbacks
        if not paused and iterations:
            end = calls.steps + iterations
            while calls.steps < end:  # a callback may reset the simulation; the remaining iterations follow the reset
                sim.control.serve(sim.tick + end - calls.steps)
            return
        while not self._stops and (not iterations or done < iterations):
            if paused:
                update_paused(self.simulation)
            else:
                self.simulation.step()
            done += 1

    def stop(self) -> None:
        """Stop a run in a separate thread."""
        self._stops = True
        if self._thread is not None:
            self._thread.join()
        self._thread = None

    def is_running(self, runner: int = 0) -> bool:
        """Check whether a thread is running the world."""
        return self._thread is not None and self._thread.is_alive()

    def reset_all(self) -> None:
        """Reset the simulation."""
        self.simulation.reset()

    # ------------------------------------------------------------------ entities

    @contextmanager
    def ecm(self, runner: int = 0) -> Iterator[EntityComponentManager]:
        """Yield the entity component manager of the world; a server has only one world, number 0.

        Raises:
            ValueError: The number is not 0.
        """
        if runner != 0:
            raise ValueError(f"there is no world {runner}; the only world has number 0")
        yield manager_of(self.simulation)

    def has_entity(self, name: str, runner: int = 0) -> bool:
        """Check whether an entity has this name."""
        return any(record.name == name for record in manager_of(self.simulation).sync())

    def entity_by_name(self, name: str, runner: int = 0) -> int | None:
        """Return the entity with this name; None if there is none."""
        entities = (record.entity for record in manager_of(self.simulation).sync() if record.name == name)
        return next(entities, None)

    def entity_count(self, runner: int = 0) -> int:
        """Return the number of entities."""
        return manager_of(self.simulation).entity_count()

    def system_count(self, runner: int = 0) -> int:
        """Return the number of plugins, including the plugins that simkit adds."""
        return len(self.simulation.engine.structure.all_plugins())

    def iteration_count(self, runner: int = 0) -> int:
        """Return the number of steps since loading or the last reset."""
        return self.simulation.tick

    def current_info(self, runner: int = 0) -> UpdateInfo | None:
        """Return the present time; None for an unknown world."""
        if runner != 0:
            return None
        sim = self.simulation
        return UpdateInfo(sim.time_ns, sim.engine.clock.time_ns(1), sim.tick, not self.is_running())


class TestFixture:
    """World with callbacks.

    Register callbacks with `on_pre_update` and similar methods, then call `finalize` and `server().run(…)`.
    """

    __test__: ClassVar[bool] = False  # the name begins with "Test", but pytest must not collect it

    def __init__(self, path_or_config: object) -> None:
        self._callbacks = _Callbacks()
        config = path_or_config
        if not isinstance(config, ServerConfig):
            config = ServerConfig()
            config.set_sdf_file(path_or_config)
        self._server = Server(config, self._callbacks)

    def server(self) -> Server:
        """Return the server of the world."""
        return self._server

    def _on(self, hook: str, callback: Callable[..., None]) -> TestFixture:
        self._callbacks.hooks.setdefault(hook, []).append(callback)
        return self

    def on_configure(self, callback: Callable[..., None]) -> TestFixture:
        """Register a callback that `finalize` calls with (entity, element, manager, events)."""
        return self._on("configure", callback)

    def on_pre_update(self, callback: Callable[..., None]) -> TestFixture:
        """Register a callback before each physics step."""
        return self._on("pre_update", callback)

    def on_update(self, callback: Callable[..., None]) -> TestFixture:
        """Register a callback at each physics step."""
        return self._on("update", callback)

    def on_post_update(self, callback: Callable[..., None]) -> TestFixture:
        """Register a callback after each physics step."""
        return self._on("post_update", callback)

    def on_reset(self, callback: Callable[..., None]) -> TestFixture:
        """Register a callback for resets."""
        return self._on("reset", callback)

    def finalize(self) -> TestFixture:
        """Activate the callbacks."""
        if not self._callbacks.is_final:
            self._callbacks.is_final = True
            self._callbacks.call("configure", *self._callbacks.given)
        return self
