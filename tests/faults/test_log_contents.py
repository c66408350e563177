"""Logs whose checksums are right and whose definitions, metadata or attachments say otherwise."""

import pytest
from damage import reassembled, swapped_attachments, write
from judged import count_of, judged
from mcap.opcode import Opcode
from rewrite import rewrite

from uvms_analysis.log.read import RunLog
from uvms_analysis.summary import summarise
from uvms_bringup.scenario import load_scenario
from uvms_core.vehicle import dump_vehicle


def other_order(text):
    """The first two fields of the definition exchange their places."""
    lines = text.decode().splitlines()
    fields = [k for k, line in enumerate(lines) if line and not line.startswith(("#", " "))][:2]
    lines[fields[0]], lines[fields[1]] = lines[fields[1]], lines[fields[0]]
    return "\n".join(lines).encode()


DEFINITIONS = {
    "nonsense": lambda text: b"\xff\xfe not a definition",
    "empty": lambda text: b"",
    "other order of fields": other_order,
    "another type": lambda text: b"float64 x\nfloat64 y\n",
    "a python keyword as a field": lambda text: b"float64 class\nfloat64 def\n",
    "a type that contains itself": lambda text: b"A a\n" + b"=" * 80 + b"\nMSG: p/A\nA a\n",
    "an endless array": lambda text: b"float64[18446744073709551615] x\n",
}
READ = ("/ground_truth/odometry", "/reference", "/allocation", "/diagnostics", "/joint_states")


@pytest.mark.parametrize("name", DEFINITIONS)
def test_foreign_definitions_are_named(whole_log, whole, tmp_path, saw, name):
    results = []
    for topic in READ[: 1 if name != "other order of fields" else 5]:
        target = tmp_path / topic.replace("/", "_") / "run.mcap"
        path = rewrite(
            whole_log,
            target,
            schema=lambda own, text, t=topic: (own, DEFINITIONS[name](text) if own == t else text),
        )
        results.append(judged(path, whole, tmp_path))
        assert results[-1] == "fault stated"
    saw(f"definition of a type: {name}", count_of(results), str(len(results)))


METADATA = {
    "seed: abc": lambda all_: all_ | {"uvms": all_["uvms"] | {"seed": "abc"}},
    "no seed": lambda all_: all_ | {"uvms": {"scenario": "x"}},
    "no record of the run": lambda all_: {"run_end": all_["run_end"]},
    "no record of the end": lambda all_: {"uvms": all_["uvms"]},
    "asked_s is text": lambda all_: all_ | {"run_end": all_["run_end"] | {"asked_s": '"x"'}},
    "asked_s is nothing": lambda all_: all_ | {"run_end": all_["run_end"] | {"asked_s": "{"}},
    "sent is a number": lambda all_: all_ | {"run_end": all_["run_end"] | {"sent": "3"}},
    "foreign is a number": lambda all_: all_ | {"run_end": all_["run_end"] | {"foreign": "3"}},
    "goal unknown": lambda all_: all_ | {"run_end": all_["run_end"] | {"goal": '"lost"'}},
    "no goal": lambda all_: all_ | {"run_end": all_["run_end"] | {"goal": "null"}},
    "asked for longer": lambda all_: all_ | {"run_end": all_["run_end"] | {"asked_s": "40.0"}},
    "asked for shorter": lambda all_: all_ | {"run_end": all_["run_end"] | {"asked_s": "1.0"}},
    "not a number of seconds": lambda all_: (
        all_ | {"run_end": all_["run_end"] | {"asked_s": "NaN"}}
    ),
}


@pytest.mark.parametrize("name", METADATA)
def test_metadata_that_say_something_else_are_named(whole_log, whole, tmp_path, saw, name):
    path = rewrite(whole_log, tmp_path / "log" / "run.mcap", metadata=METADATA[name])
    assert judged(path, whole, tmp_path) == "fault stated"
    summary = summarise(path, wall_s=0.0)
    saw(f"metadata of a log: {name}", summary["reasons"][0])


def swap(attachments, first, second):
    return attachments | {first: attachments[second], second: attachments[first]}


ATTACHMENTS = {
    "config.yaml for vehicle.yaml": lambda all_: swap(all_, "config.yaml", "vehicle.yaml"),
    "path.json for vehicle.yaml": lambda all_: swap(all_, "path.json", "vehicle.yaml"),
    "no vehicle.yaml": lambda all_: {k: v for k, v in all_.items() if k != "vehicle.yaml"},
    "no config.yaml": lambda all_: {k: v for k, v in all_.items() if k != "config.yaml"},
    "vehicle.yaml is not text": lambda all_: all_ | {"vehicle.yaml": b"\xff\xfe\x00"},
    "config.yaml is a list": lambda all_: all_ | {"config.yaml": b"- 1\n"},
    "config.yaml without the plant": lambda all_: all_ | {"config.yaml": b"control: 3\n"},
    "a period of nothing": lambda all_: (
        all_
        | {
            "config.yaml": all_["config.yaml"].replace(
                b"control_period_s: 0.05", b"control_period_s: 0"
            )
        }
    ),
}


@pytest.mark.parametrize("name", ATTACHMENTS)
def test_attachments_that_say_something_else_are_named(whole_log, whole, tmp_path, saw, name):
    path = rewrite(whole_log, tmp_path / "log" / "run.mcap", attachments=ATTACHMENTS[name])
    assert judged(path, whole, tmp_path) == "fault stated"
    saw(f"attachments of a log: {name}", summarise(path, wall_s=0.0)["reasons"][0])


def test_attachments_that_were_exchanged_or_taken_away_are_named(data, whole, tmp_path, saw):
    path = write(tmp_path / "swapped.mcap", swapped_attachments(data))
    assert judged(path, whole, tmp_path) == "fault stated"
    assert (
        "its attachment 'config.yaml' is not the one that was recorded" in RunLog.open(path).fault
    )

    def without_path(parts):
        return [p for p in parts if p[0] != Opcode.ATTACHMENT or b"path.json" not in p[:60]]

    path = write(tmp_path / "less.mcap", reassembled(data, without_path))
    assert judged(path, whole, tmp_path) == "fault stated"
    assert "its attachment 'path.json' is missing" in RunLog.open(path).fault
    saw("attachments exchanged or taken away, checksums right", "named; the run is invalid", "2")


def test_a_path_that_is_none_costs_only_the_figures_that_need_it(whole_log, whole, tmp_path, saw):
    for text in (
        b"{",
        b"[]",
        b'{"times": [0, 0], "positions": [[0,0,0],[1,1,1]], "orientations": []}',
    ):
        folder = tmp_path / str(len(text))
        change = {"path.json": text}
        path = rewrite(whole_log, folder / "run.mcap", attachments=lambda a, c=change: a | c)
        summary = summarise(path, wall_s=0.0)
        assert summary["outcome"] == "invalid"
        assert "path.json" in summary["missing"]["end_effector_error_m"]
        assert summary["roll_deg"] == whole["roll_deg"]
    saw(
        "path.json is not a path",
        "figures without it stay, the others say why they are missing",
        "3",
    )


def test_joints_of_another_vehicle_are_named(whole_log, whole, tmp_path, saw):
    other = load_scenario("manipulation", vehicle="bluerov2_alpha5").load_vehicle()
    text = dump_vehicle(other).encode()
    path = rewrite(
        whole_log, tmp_path / "log" / "run.mcap", attachments=lambda a: a | {"vehicle.yaml": text}
    )
    assert judged(path, whole, tmp_path) == "fault stated"
    saw("vehicle.yaml of another vehicle", "named: its joints are not those of the messages")
