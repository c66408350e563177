"""A start with lost answers: what is asked is asked again, and who is missing is named."""

import pytest
from in_process import graph_of, spin_until
from rclpy.node import Node
from rclpy.task import Future
from std_srvs.srv import Trigger

from uvms_bringup.errors import RunError
from uvms_bringup.ros import conductor
from uvms_bringup.ros.conductor import Conductor
from uvms_core.ros.request import Request
from uvms_core.ros.roll_call import NO_ANSWER, NOT_UP, RollCall
from uvms_dynamics.nodes.plant import PlantNode

AGAIN_S = 0.05


class Service:
    """A service whose first answers get lost."""

    def __init__(self, lost: int) -> None:
        self.lost, self.sent = lost, []

    def ask(self) -> Future:
        self.sent.append(Future())
        if len(self.sent) > self.lost:
            self.sent[-1].set_result("here")
        return self.sent[-1]


class Forgetful(Node):
    """Drops the first answer to the roll call, as a service does that has not found its client."""

    def __init__(self) -> None:
        super().__init__("controller")
        self.asked = 0
        service = self.create_service(Trigger, "controller/ready", self._answer)
        send = service.send_response
        service.send_response = lambda *answer: send(*answer) if self.asked > 1 else None

    def _answer(self, _, response):
        self.asked += 1
        response.success = True
        return response


def test_a_question_is_asked_again_until_an_answer_comes():
    service = Service(lost=2)
    request = Request(service.ask, lambda: True, again_s=0.0)
    assert [request.answer() for _ in range(4)] == [None, None, None, "here"]
    assert request.answer() == "here"
    assert len(service.sent) == request.times_asked == 3


def test_a_late_answer_to_the_first_question_counts():
    service = Service(lost=9)
    request = Request(service.ask, lambda: True, again_s=0.0)
    assert [request.answer() for _ in range(2)] == [None, None]
    service.sent[0].set_result("late")
    assert request.answer() == "late"


def test_nobody_is_asked_who_is_not_there_nor_twice_at_once():
    there = []
    service = Service(lost=9)
    request = Request(service.ask, lambda: bool(there), again_s=3600.0)
    assert request.answer() is None
    assert service.sent == []
    there.append(True)
    assert [request.answer() for _ in range(3)] == [None] * 3
    assert len(service.sent) == 1


def test_the_roll_call_gets_over_a_lost_answer():
    with graph_of(Forgetful, lambda: Node("asker")) as (spinner, (forgetful, asker)):
        roll_call = RollCall(asker, ("controller", "navigation"), again_s=AGAIN_S)
        seen = set()

        def came() -> bool:
            seen.update(roll_call.poll().items())
            return "controller" not in roll_call.poll()

        spin_until(spinner, came)
        assert roll_call.poll() == {"navigation": NOT_UP}
    assert ("controller", NO_ANSWER) in seen
    assert forgetful.asked >= 2


def test_who_is_missing_is_printed_and_named_in_the_error(monkeypatch, capfd):
    monkeypatch.setattr(conductor, "START_PATIENCE_S", 1.0)
    monkeypatch.setattr(conductor, "NOTICE_S", 0.4)

    def lead() -> Conductor:
        return Conductor(lambda *message: None, lambda: None, ())

    with graph_of(lead, PlantNode) as (spinner, (leader, _)):
        with pytest.raises(
            RunError, match=r"timed out after 1 s .*motion_planner: has not come up"
        ):
            leader.conduct(spinner, None)
    err = capfd.readouterr().err
    assert "waiting for: " in err
    assert "controller: has not come up" in err


def test_a_node_that_is_not_up_is_named_before_what_others_lack():
    lacks = {"plant": "nobody publishes 'joint_command'", "controller": NOT_UP}
    assert conductor._missing(lacks) == "controller: has not come up"
    assert conductor._missing({"plant": "no topic"}) == "plant: no topic"


def test_the_plant_may_be_asked_twice_to_start_and_to_go_on():
    with graph_of(PlantNode) as (_, (plant,)):
        answers = [plant._answer_start(None, Trigger.Response()) for _ in range(2)]
        assert [answer.success for answer in answers] == [True, True]
        assert answers[1].message == "already running"
