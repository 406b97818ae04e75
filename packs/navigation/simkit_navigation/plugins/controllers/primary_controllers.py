"""Controllers of simkit by their name in Nav2, without the rotation shim, which wraps one of them."""

from __future__ import annotations

from typing import Any, Final

from simkit_navigation.plugins.controllers.dwb_controller import DwbController
from simkit_navigation.plugins.controllers.graceful_controller import GracefulController
from simkit_navigation.plugins.controllers.mppi_controller import MppiController
from simkit_navigation.plugins.controllers.pure_pursuit import PurePursuit
from simkit_navigation.plugins.controllers.tutorial_pure_pursuit import PurePursuitController

PRIMARY_CONTROLLERS: Final[dict[str, type[Any]]] = {
    "nav2_regulated_pure_pursuit_controller::RegulatedPurePursuitController": PurePursuit,
    "nav2_mppi_controller::MPPIController": MppiController,
    "dwb_core::DWBLocalPlanner": DwbController,
    "nav2_pure_pursuit_controller::PurePursuitController": PurePursuitController,
    "nav2_graceful_controller::GracefulController": GracefulController,
}
"""Classes by name; each is a `Controller`."""
