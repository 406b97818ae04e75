"""Client library `rospy` of ROS 1."""

from __future__ import annotations

from importlib import import_module

from simkit_nodes.interfaces import ROS1
from simkit_nodes.ros1_modules.rospy import log
from simkit_nodes.ros1_modules.rospy.client import (
    delete_param,
    get_param,
    get_param_cached,
    get_param_names,
    get_published_topics,
    has_param,
    init_node,
    myargv,
    on_shutdown,
    search_param,
    set_param,
    spin,
    wait_for_message,
)
from simkit_nodes.ros1_modules.rospy.core import (
    get_node_uri,
    get_ros_root,
    is_shutdown,
    parse_rosrpc_uri,
    signal_shutdown,
)
from simkit_nodes.ros1_modules.rospy.exceptions import (
    ROSException,
    ROSInitException,
    ROSInternalException,
    ROSInterruptException,
    ROSSerializationException,
    ROSTimeMovedBackwardsException,
    TransportException,
    TransportInitError,
    TransportTerminated,
)
from simkit_nodes.ros1_modules.rospy.log import *  # noqa: F403 - the functions of the log, by level and form
from simkit_nodes.ros1_modules.rospy.msg import AnyMsg
from simkit_nodes.ros1_modules.rospy.msproxy import MasterProxy, get_master
from simkit_nodes.ros1_modules.rospy.names import get_caller_id, get_name, get_namespace, remap_name, resolve_name
from simkit_nodes.ros1_modules.rospy.rostime import Duration, Time, get_rostime, get_time
from simkit_nodes.ros1_modules.rospy.service import Service, ServiceException, ServiceProxy, wait_for_service
from simkit_nodes.ros1_modules.rospy.timer import Rate, Timer, sleep
from simkit_nodes.ros1_modules.rospy.topics import Message, Publisher, SubscribeListener, Subscriber

Header = ROS1.message_class("std_msgs/msg/Header")

import_module("xml.etree.ElementTree")  # a program that imports `xml` alone has it from the modules of ROS 1

__all__ = [
    *log.__all__,
    "AnyMsg",
    "Duration",
    "Header",
    "MasterProxy",
    "Message",
    "Publisher",
    "ROSException",
    "ROSInitException",
    "ROSInternalException",
    "ROSInterruptException",
    "ROSSerializationException",
    "ROSTimeMovedBackwardsException",
    "Rate",
    "Service",
    "ServiceException",
    "ServiceProxy",
    "SubscribeListener",
    "Subscriber",
    "Time",
    "Timer",
    "TransportException",
    "TransportInitError",
    "TransportTerminated",
    "delete_param",
    "get_caller_id",
    "get_master",
    "get_name",
    "get_namespace",
    "get_node_uri",
    "get_param",
    "get_param_cached",
    "get_param_names",
    "get_published_topics",
    "get_ros_root",
    "get_rostime",
    "get_time",
    "has_param",
    "init_node",
    "is_shutdown",
    "myargv",
    "on_shutdown",
    "parse_rosrpc_uri",
    "remap_name",
    "resolve_name",
    "search_param",
    "set_param",
    "signal_shutdown",
    "sleep",
    "spin",
    "wait_for_message",
    "wait_for_service",
]
