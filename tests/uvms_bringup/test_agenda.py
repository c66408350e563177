"""Goals in turn: which one is due, and what became of each."""

import numpy as np

from uvms_analysis.log.run_end import RunEnd
from uvms_bringup.agenda import Agenda, in_turn, path_of
from uvms_core.signals import JointGoal, PathGoal, PoseGoal

SECOND = 1_000_000_000
LEVEL = np.array([0.0, 0.0, 0.0, 1.0])
POSE = PoseGoal(np.zeros(3), LEVEL, 0.0, 1.0, 0.0)
JOINTS = JointGoal(np.array([1.0]), np.zeros((1, 4)))
PATH = PathGoal(np.array([0.0, 1.0]), np.zeros((2, 3)), np.tile(LEVEL, (2, 1)))


def test_each_begins_when_the_one_before_it_has_succeeded():
    agenda = Agenda((POSE, JOINTS))
    assert (agenda.due, agenda.state) == (POSE, "running")
    agenda.begin(0)
    assert agenda.due is None
    agenda.end(3 * SECOND, "succeeded", "there")
    assert agenda.due is JOINTS
    agenda.begin(3 * SECOND)
    agenda.end(5 * SECOND, "succeeded")
    assert (agenda.due, agenda.state, agenda.begun) == (None, "succeeded", 2)
    first, second = agenda.records()
    assert first == {
        "kind": "pose",
        "state": "succeeded",
        "message": "there",
        "began_s": 0.0,
        "ended_s": 3.0,
    }
    assert (second["kind"], second["began_s"], second["ended_s"]) == ("joints", 3.0, 5.0)


def test_one_that_fails_is_the_last():
    agenda = Agenda([POSE, JOINTS, PATH])
    agenda.begin(0)
    agenda.end(SECOND, "succeeded")
    agenda.refuse(SECOND, "too far")
    assert (agenda.due, agenda.state) == (None, "rejected")
    assert [record["state"] for record in agenda.records()] == ["succeeded", "rejected", "waiting"]
    assert agenda.records()[1]["message"] == "too far"


def test_no_goal_and_a_single_one():
    assert (Agenda(None).due, Agenda(None).state, in_turn(None)) == (None, "none", ())
    assert in_turn(POSE) == (POSE,)
    assert path_of((POSE, PATH)) is PATH
    assert path_of((PATH, PATH)) is None


def test_the_end_of_a_run_keeps_them_and_older_logs_have_none():
    agenda = Agenda((POSE, JOINTS))
    agenda.begin(0)
    end = RunEnd(9.0, goal="running", goals=agenda.records())
    record = end.to_metadata()
    assert RunEnd.from_metadata(record).goals == agenda.records()
    del record["goals"]
    assert RunEnd.from_metadata(record).goals == ()


def test_the_phase_says_what_the_goals_are_at():
    agenda = Agenda((POSE, JOINTS))
    assert agenda.phase == "goal 1 of 2 (pose) being planned"
    agenda.begin(0)
    assert agenda.phase == "goal 1 of 2 (pose) active"
    agenda.end(SECOND, "succeeded")
    assert agenda.phase == "goal 2 of 2 (joints) being planned"
    agenda.begin(SECOND)
    agenda.end(2 * SECOND, "succeeded")
    assert agenda.phase == "all goals succeeded"


def test_the_phase_says_what_has_failed_and_why():
    agenda = Agenda((POSE, JOINTS))
    agenda.begin(0)
    agenda.end(SECOND, "canceled")
    assert agenda.phase == "goal 1 of 2 (pose) canceled"
    refused = Agenda(PATH)
    refused.refuse(0, "out of reach")
    assert refused.phase == "goal 1 of 1 (path) rejected: out of reach"
    assert Agenda(None).phase == "no goal"
