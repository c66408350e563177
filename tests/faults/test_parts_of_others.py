"""A part of somebody else's cannot change what happened, nor end the run without a word."""

import numpy as np
from outcome_runs import simulated

from uvms_analysis.log.read import RunLog
from uvms_bringup.cli import main
from uvms_control.controller import Controller
from uvms_core import topics


class Overwriter(Controller):
    """Writes into everything that it is given."""

    def step(self, odometry, joints, disturbance, reference):
        answer = super().step(odometry, joints, disturbance, reference)
        told = self._budget.restoring, self._budget.external
        for array in (odometry.nu, odometry.position, joints.position, disturbance.wrench, *told):
            array[:] = 0.0
        reference.q[:] = 0.0
        return answer


class Exit(Controller):
    """Ends the program."""

    def step(self, odometry, joints, disturbance, reference):
        if odometry.stamp >= 1_000_000_000:
            raise SystemExit(0)
        return super().step(odometry, joints, disturbance, reference)


def test_what_a_law_writes_into_its_inputs_stays_its_own(tmp_path, saw):
    ours, _ = simulated(tmp_path / "ours", "hover", duration_s=2.0)
    law = f"control.law={__name__}:Overwriter"
    theirs, _ = simulated(tmp_path / "theirs", "hover", law, duration_s=2.0)
    for topic in (topics.JOINT_STATES, topics.ODOMETRY, topics.TRUE_ODOMETRY):
        one, other = RunLog.open(ours).series(topic), RunLog.open(theirs).series(topic)
        assert np.array_equal(one.position, other.position), topic.name
    budgets = (RunLog.open(log).series(topics.DISTURBANCE_BUDGET) for log in (ours, theirs))
    one, other = budgets
    assert np.array_equal(one.restoring, other.restoring)
    assert one.restoring.any()
    saw("a law that writes into its inputs", "it gets copies: log and motion are the same")


def test_a_law_that_ends_the_program_ends_the_run_with_a_reason(tmp_path, saw, capsys):
    arguments = ["simulate", "hover", "--duration", "3", "--output", str(tmp_path / "run")]
    assert main([*arguments, "--set", f"control.law={__name__}:Exit"]) == 1
    out = capsys.readouterr().out
    assert "outcome: aborted" in out
    assert "SystemExit" in out
    saw("a law that calls sys.exit(0)", "aborted, exit 1, named")
