"""Runs for the tests of outcomes, and copies of their logs with one thing changed."""

from dataclasses import replace

import numpy as np
from rewrite import rewrite

from uvms_analysis.log.read import RunLog
from uvms_analysis.outcome import judge
from uvms_bringup.scenario import load_scenario
from uvms_bringup.session import prepare
from uvms_core import topics
from uvms_core.cdr import codec
from uvms_core.diagnostics import Status
from uvms_core.messages import from_message, to_message
from uvms_core.signals import Allocation, AppliedThrust
from uvms_dynamics.kernels.rotations import rpy_to_quat

DURATION_S = 6.0


TICK = 50_000_000


def simulated(folder, scenario, *settings, **changes):
    ready = prepare(load_scenario(scenario, settings, **changes), str(folder), "lockstep", "uvms")
    return folder / "run.mcap", ready.run_simulation()


def edited(source, target, topic, change):
    """A copy of a log in which every signal of a topic goes through `change`."""
    vehicle = RunLog.open(source).vehicle
    thrusters = topic.signal in (Allocation, AppliedThrust)
    names = vehicle.thruster_names if thrusters else vehicle.joint_names
    own = codec(topic.type)

    def change_all(messages):
        for place, (name, entry) in enumerate(messages):
            if name == topic.resolve():
                signal = change(from_message(topic, own.decode(entry.data)))
                data = own.encode(to_message(topic, signal, names))
                messages[place] = (name, entry._replace(data=data))
        return messages

    return rewrite(source, target / "run.mcap", messages=change_all)


def ended(source, target, pace="lockstep", **changes):
    """A copy of a log with another record of the run's end."""
    end = replace(RunLog.open(source).end, **changes)

    def change(metadata):
        about = metadata["uvms"] | {"pace": pace}
        return metadata | {"uvms": about, "run_end": end.to_metadata()}

    return rewrite(source, target / "run.mcap", metadata=change)


def outcome_of(path):
    return judge(RunLog.open(path))


def off_from(begin_s, end_s, metres):
    def change(odometry):
        if begin_s * 1e9 <= odometry.stamp < end_s * 1e9:
            return replace(odometry, position=odometry.position + np.array([0.0, metres, 0.0]))
        return odometry

    return change


def counters_of_parts(summary):
    return [c for role, c in summary["node_counters"].items() if role != topics.PLANT]


def without(source, target, *gone, unsent=True):
    """A copy of a log without some topics; `unsent`: with a record that nobody sent them."""
    names = {topic.resolve() for topic in gone}
    end = RunLog.open(source).end
    end = replace(end, sent={k: v for k, v in end.sent.items() if k not in names or not unsent})
    return rewrite(
        source,
        target / "run.mcap",
        metadata=lambda all_: all_ | {"run_end": end.to_metadata()},
        messages=lambda all_: [(name, entry) for name, entry in all_ if name not in names],
    )


def with_statuses(source, target, *statuses):
    """A copy of a log in which nodes say more at the end."""
    own = codec(topics.DIAGNOSTICS.type)

    def change(messages):
        last = max(entry.stamp for name, entry in messages if name == "/clock")
        like = next(entry for name, entry in messages if name == "/diagnostics")
        for name, values in statuses:
            status = Status(last, name, values=values)
            data = own.encode(to_message(topics.DIAGNOSTICS, status, ()))
            messages.append(("/diagnostics", like._replace(stamp=last, data=data)))
        return messages

    end = RunLog.open(source).end
    sent = end.sent | {"/diagnostics": end.sent["/diagnostics"] + len(statuses)}
    return rewrite(
        source,
        target / "run.mcap",
        messages=change,
        metadata=lambda all_: all_ | {"run_end": replace(end, sent=sent).to_metadata()},
    )


def capsized(after, degrees):
    def change(odometry):
        if odometry.stamp < after:
            return odometry
        return replace(odometry, quaternion=rpy_to_quat(np.deg2rad(degrees), 0.0, 0.0))

    return change
