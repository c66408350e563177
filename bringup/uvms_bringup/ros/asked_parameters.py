"""What a node of a running graph has been given: its parameters."""

import time
from functools import partial
from typing import Any

from rcl_interfaces.msg import ParameterType
from rcl_interfaces.srv import GetParameters, GetParameterTypes, ListParameters
from rclpy.node import Node
from rclpy.parameter import parameter_value_to_python

from uvms_core.ros.request import Request

ANSWER_S = 30.0
"""Wall time within which a node that is there answers, on a machine with other things to do."""
NOT_SET = ParameterType.PARAMETER_NOT_SET
SERVICES = {
    ListParameters: "list_parameters",
    GetParameterTypes: "get_parameter_types",
    GetParameters: "get_parameters",
}
"""What each request is called at a node."""


def parameters_of(node: Node, role: str, patience_s: float) -> dict[str, Any] | None:
    """The parameters of another node by name, without those that are not set.

    Args:
        node: that asks; somebody else must be spinning it.
        role: name of the node that is asked.
        patience_s: wall time after which there is no such node, and the answer is None, in s. A
            node that is there has `ANSWER_S` to answer.
    """
    ask = partial(_answer, node, role, patience_s)
    if (listed := ask(ListParameters)) is None:
        return None
    names = list(listed.result.names)
    if (typed := ask(GetParameterTypes, names=names)) is None:
        return None
    # a node of rclpy answers nothing at all where one of those that it is asked for is not set
    names = [name for name, kind in zip(names, typed.types, strict=True) if kind != NOT_SET]
    if (given := ask(GetParameters, names=names)) is None:
        return None
    values = map(parameter_value_to_python, given.values)
    return dict(zip(names, values, strict=True))


def _answer(node: Node, role: str, patience_s: float, kind: Any, **question: Any) -> Any:
    """The answer to a request; None where there is none in time."""
    client = node.create_client(kind, f"{role}/{SERVICES[kind]}")
    until, is_there = time.monotonic() + patience_s, False
    request = Request(lambda: client.call_async(kind.Request(**question)), client.service_is_ready)
    while (answer := request.answer()) is None and time.monotonic() < until:
        if request.times_asked == 1 and not is_there:
            is_there, until = True, time.monotonic() + ANSWER_S
        time.sleep(0.05)
    node.destroy_client(client)
    return answer
