"""Link attachers for Gazebo Classic: `libgazebo_link_attacher.so` of ROS 2 and `libgazebo_ros_link_attacher.so`.

The names of the services and the fields of their types are those of the packages IFRA_LinkAttacher of Cranfield
University (`ros2_linkattacher`, `linkattacher_msgs`) and `gazebo_ros_link_attacher` of PAL Robotics.
"""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING, Final

from simkit.params import Params
from simkit.plugins.base import WorldPlugin
from simkit.plugins.endpoints import offers
from simkit.plugins.joints.run_time_welds import close_weld, open_weld
from simkit.plugins.world.service_entities import RequestRefused, find_entity

if TYPE_CHECKING:
    from simkit.msgs import Attach_Request, AttachLink_Request, DetachLink_Request
    from simkit.runtime import Simulation

ATTACH: Final = "linkattacher_msgs/srv/AttachLink"
DETACH: Final = "linkattacher_msgs/srv/DetachLink"
ATTACH_ROS_1: Final = "gazebo_ros_link_attacher/srv/Attach"

LinkPair = tuple[str, str, str, str]
"""Model and link, then the other model and link, as the request names them."""


class GazeboLinkAttacher(WorldPlugin):
    """Attaches a link of a model to a link of another model by a service, and detaches it by another one.

    Attached links keep the relative pose that they had at the moment of the request. A repeated request attaches them
    in their present pose. A pair of links is detached by the names with which it was attached. Gazebo adds a revolute
    joint with the limits 0 and 0, which gives way a little; simkit adds a rigid weld.
    """

    endpoints = (offers("ATTACHLINK", ATTACH), offers("DETACHLINK", DETACH))
    filenames = ("libgazebo_link_attacher.so",)

    def load(self, parent: Simulation, params: Params) -> None:
        self._welds: dict[LinkPair, str] = {}
        self._offer_services()

    def _offer_services(self) -> None:
        self.offer("ATTACHLINK", ATTACH, partial(self._on_request, True))
        self.offer("DETACHLINK", DETACH, partial(self._on_request, False))

    def _on_request(self, shall_attach: bool, request: AttachLink_Request | DetachLink_Request) -> dict[str, object]:
        pair = request.model1_name, request.link1_name, request.model2_name, request.link2_name
        error = self._attach(pair) if shall_attach else self._detach(pair)
        first, second = (f"{{MODEL , LINK}} -> {{{model} , {link}}}" for model, link in (pair[:2], pair[2:]))
        done = f"{'ATTACHED' if shall_attach else 'DETACHED'}: {first} -- {second}."
        return {"success": not error, "message": error or done}

    def _attach(self, pair: LinkPair) -> str:
        """Attach two links in their present poses; return the reason if this is not possible."""
        try:
            first, second = self._link(*pair[:2]), self._link(*pair[2:])
            if first == second:
                raise RequestRefused(f"link {first!r} cannot be attached to itself")
            links, fixed_to = self.sim.engine.names.links, self.sim.mj_model.body_weldid
            if not any(fixed_to[links[link].body] for link in (first, second)):
                raise RequestRefused(f"links {first!r} and {second!r} are both static")
        except RequestRefused as error:
            self.log.warning("%s", error)
            return str(error)
        weld = f"#attached {first} {second}"
        close_weld(self.sim, weld, first, second)
        self._welds = {**self._welds, pair: weld}
        return ""

    def _detach(self, pair: LinkPair) -> str:
        """Detach two links; return the reason if they were not attached."""
        if not open_weld(self.sim, self._welds.get(pair, "")):
            error = f"{'::'.join(pair[:2])} and {'::'.join(pair[2:])} were not attached by these names, in this order"
            self.log.warning("%s", error)
            return error
        return ""

    def _link(self, model: str, link: str) -> str:
        """Return the scoped name of a link of a model."""
        scoped = find_entity(self.sim, model, ("model",))[1]
        return find_entity(self.sim, link if link.startswith(f"{scoped}::") else f"{scoped}::{link}", ("link",))[1]


class GazeboRosLinkAttacher(GazeboLinkAttacher):
    """Attaches and detaches links, as `GazeboLinkAttacher`; with the services of the node `/link_attacher_node`."""

    endpoints = (offers("/link_attacher_node/attach", ATTACH_ROS_1), offers("/link_attacher_node/detach", ATTACH_ROS_1))
    filenames = ("libgazebo_ros_link_attacher.so",)

    def _offer_services(self) -> None:
        self.offer("/link_attacher_node/attach", ATTACH_ROS_1, partial(self._on_ros_1_request, True))
        self.offer("/link_attacher_node/detach", ATTACH_ROS_1, partial(self._on_ros_1_request, False))

    def _on_ros_1_request(self, shall_attach: bool, request: Attach_Request) -> dict[str, object]:
        pair = request.model_name_1, request.link_name_1, request.model_name_2, request.link_name_2
        return {"ok": not (self._attach(pair) if shall_attach else self._detach(pair))}
