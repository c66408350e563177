"""Damaged logs: each gives a stated fault, or exactly the figures of the undamaged one.

The source is a real simulated run with a path. Nothing may raise but LogError, and a run whose log
was damaged never counts as completed unless every figure is that of the whole log.
"""

import json

import numpy as np
import pytest
from damage import (
    flipped,
    flipped_in,
    reassembled,
    swapped_attachments,
    write,
)
from mcap.opcode import Opcode
from rewrite import rewrite

from uvms_analysis.check import check_log
from uvms_analysis.check.text import as_text
from uvms_analysis.errors import LogError
from uvms_analysis.log.read import RunLog
from uvms_analysis.log.recover import recover
from uvms_analysis.report import report
from uvms_analysis.report.page import write_page
from uvms_analysis.summary import summarise
from uvms_bringup.scenario import load_scenario
from uvms_bringup.session import prepare
from uvms_core.vehicle import dump_vehicle

SEEDS_OF_QUICK = 2
FIGURES_APART = ("wall_s", "real_time_factor", "log_fault", "check", "missing", "reasons")


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """Folder and figures of four seconds on a path."""
    folder = tmp_path_factory.mktemp("run") / "whole"
    scenario = load_scenario("manipulation", duration_s=4.0)
    summary = prepare(scenario, str(folder), "lockstep", "uvms simulate").run_simulation()
    assert summary["outcome"] == "completed"
    return folder / "run.mcap"


@pytest.fixture(scope="module")
def whole(run):
    return figures(run)


@pytest.fixture(scope="module")
def data(run):
    return run.read_bytes()


def figures(path):
    summary = summarise(path, wall_s=0.0)
    return {key: value for key, value in summary.items() if key not in FIGURES_APART}


def judged(path, whole, tmp_path):
    """What the tools say about a log: an error, or a stated fault, or the figures of the whole."""
    try:
        log = RunLog.open(path)
    except LogError:
        return "refused"
    check = check_log(log)
    assert check.verdict in as_text(check)
    json.dumps(check.to_json(), allow_nan=False)
    summary = summarise(log, wall_s=0.0)
    json.dumps(summary)
    page = write_page(tmp_path / "report.html", log, summary, []).read_text(encoding="utf-8")
    assert f"Outcome: {summary['outcome']}" in page
    if summary["outcome"] == "completed":
        assert check.complete
        assert {k: v for k, v in summary.items() if k not in FIGURES_APART} == whole
        return "same figures"
    assert summary["reasons"]
    assert not check.complete
    return "fault stated"


def count_of(results):
    return ", ".join(f"{results.count(one)} {one}" for one in sorted(set(results)))


KINDS = {
    "header": Opcode.HEADER,
    "chunk": Opcode.CHUNK,
    "message index": Opcode.MESSAGE_INDEX,
    "attachment": Opcode.ATTACHMENT,
    "metadata": Opcode.METADATA,
    "end of data": Opcode.DATA_END,
    "schema": Opcode.SCHEMA,
    "channel": Opcode.CHANNEL,
    "statistics": Opcode.STATISTICS,
    "chunk index": Opcode.CHUNK_INDEX,
    "attachment index": Opcode.ATTACHMENT_INDEX,
    "metadata index": Opcode.METADATA_INDEX,
    "summary offset": Opcode.SUMMARY_OFFSET,
    "footer": Opcode.FOOTER,
}


def flip_everywhere(data, whole, tmp_path, seeds):
    results = []
    for name, code in KINDS.items():
        for seed in seeds:
            damaged = flipped_in(data, code, np.random.default_rng([code, seed]))
            path = write(tmp_path / f"{name} {seed}.mcap", damaged)
            result = judged(path, whole, tmp_path)
            assert result != "same figures", f"a bit in a {name} (seed {seed}) goes unseen"
            results.append(result)
            path.unlink()
    return results


def test_a_bit_in_any_kind_of_record_is_seen(data, whole, tmp_path, saw):
    results = flip_everywhere(data, whole, tmp_path, range(SEEDS_OF_QUICK))
    saw("a bit flipped in each kind of record of a log", count_of(results), str(len(results)))


@pytest.mark.long
def test_many_bits_in_every_kind_of_record_are_seen(data, whole, tmp_path, saw):
    results = flip_everywhere(data, whole, tmp_path, range(100, 108))
    for seed in range(60):  # several at once, anywhere
        rng = np.random.default_rng(seed)
        damaged = data
        for _ in range(int(rng.integers(1, 6))):
            damaged = flipped(damaged, rng)
        results.append(judged(write(tmp_path / "bits.mcap", damaged), whole, tmp_path))
    assert "same figures" not in results
    saw("bits flipped everywhere in a log", count_of(results), str(len(results)))


def cuts(data, count, seed):
    rng = np.random.default_rng(seed)
    return [int(at) for at in rng.integers(0, len(data), count)]


@pytest.mark.parametrize(
    "count", [6, pytest.param(40, marks=pytest.mark.long)], ids=["quick", "long"]
)
def test_a_log_that_breaks_off_says_so(data, whole, tmp_path, saw, count):
    results = [
        judged(write(tmp_path / "cut.mcap", data[:at]), whole, tmp_path)
        for at in cuts(data, count, count)
    ]
    assert "same figures" not in results
    saw("a log that breaks off", count_of(results), str(count))


def test_what_is_recovered_of_a_cut_log_counts_only_if_it_is_all(data, whole, tmp_path, saw):
    results = []
    for k, at in enumerate([20_000, len(data) // 2, 4 * len(data) // 5, len(data) - 200]):
        cut = write(tmp_path / f"{k}" / "cut.mcap", data[:at])
        out = tmp_path / f"{k}" / "out.mcap"
        found = recover(cut, out)
        assert found.kept_bytes + found.lost_bytes == len(cut.read_bytes())
        assert RunLog.open(out).fault == ""
        results.append(judged(out, whole, tmp_path))
    # Of the last one nothing but the index at the end was cut off.
    assert results == ["fault stated"] * 3 + ["same figures"]
    saw("`uvms recover` of a log that broke off", count_of(results), "4")


def moved_chunks(data, seed):
    rng = np.random.default_rng(seed)

    def change(parts):
        places = [k for k, part in enumerate(parts) if part[0] == Opcode.CHUNK]
        order = rng.permutation(places)
        while list(order) == places:
            order = rng.permutation(places)
        taken = [parts[k] for k in order]
        for place, part in zip(places, taken, strict=True):
            parts[place] = part
        return parts

    return reassembled(data, change)


def doubled_chunk(data, seed):
    def change(parts):
        places = [k for k, part in enumerate(parts) if part[0] == Opcode.CHUNK]
        place = places[seed % len(places)]
        return [*parts[: place + 1], parts[place], *parts[place + 1 :]]

    return reassembled(data, change)


def lost_chunk(data, seed):
    def change(parts):
        places = [k for k, part in enumerate(parts) if part[0] == Opcode.CHUNK]
        place = places[seed % len(places)]
        return [part for k, part in enumerate(parts) if k != place]

    return reassembled(data, change)


@pytest.mark.parametrize("change", [moved_chunks, doubled_chunk, lost_chunk])
@pytest.mark.parametrize(
    "seeds", [range(2), pytest.param(range(2, 12), marks=pytest.mark.long)], ids=["quick", "long"]
)
def test_chunks_in_another_order_twice_or_lost_are_seen(data, whole, tmp_path, saw, change, seeds):
    results = []
    for seed in seeds:
        path = write(tmp_path / f"{seed}.mcap", change(data, seed))
        results.append(judged(path, whole, tmp_path))
        assert results[-1] != "same figures", seed
    saw(f"{change.__name__.replace('_', ' ')}, checksums right", count_of(results), str(len(seeds)))


def shuffled(messages, rng):
    """Ten neighbours of one topic come in another order."""
    topic = messages[int(rng.integers(len(messages) // 2))][0]
    places = [k for k, (name, _) in enumerate(messages) if name == topic][:10]
    order = [places[-1], *places[:-1]]
    taken = [messages[k] for k in order]
    changed = list(messages)
    for place, one in zip(places, taken, strict=True):
        changed[place] = one
    return changed


def doubled(messages, rng):
    place = int(rng.integers(len(messages)))
    return [*messages[: place + 1], messages[place], *messages[place + 1 :]]


def dropped(messages, rng):
    place = int(rng.integers(len(messages)))
    return [*messages[:place], *messages[place + 1 :]]


def restamped(messages, rng):
    """One message of a stamped topic is recorded a control period later than it was."""
    places = [k for k, (name, _) in enumerate(messages) if name == "/ground_truth/odometry"]
    place = places[int(rng.integers(len(places)))]
    name, entry = messages[place]
    late = (name, entry._replace(stamp=entry.stamp + 50_000_000))
    return [*messages[:place], late, *messages[place + 1 :]]


def exchanged(messages, rng):
    """Two messages of a topic exchange their contents, and keep their places and times."""
    places = [k for k, (name, _) in enumerate(messages) if name == "/ground_truth/odometry"]
    first, second = rng.choice(places, 2, replace=False)
    changed = list(messages)
    for own, other in ((first, second), (second, first)):
        name, entry = messages[own]
        changed[own] = (name, entry._replace(data=messages[other][1].data))
    return changed


@pytest.mark.parametrize("change", [shuffled, doubled, dropped, restamped, exchanged])
@pytest.mark.parametrize(
    "seeds", [range(2), pytest.param(range(2, 12), marks=pytest.mark.long)], ids=["quick", "long"]
)
def test_messages_that_were_changed_are_seen(run, whole, tmp_path, saw, change, seeds):
    results = []
    for seed in seeds:
        rng = np.random.default_rng(seed)
        path = rewrite(
            run, tmp_path / f"{seed}" / "run.mcap", messages=lambda all_, r=rng: change(all_, r)
        )
        assert RunLog.open(path).fault == ""
        results.append(judged(path, whole, tmp_path))
        assert results[-1] != "same figures" or change is shuffled, seed
    saw(f"messages {change.__name__}, checksums right", count_of(results), str(len(seeds)))


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
def test_foreign_definitions_are_named(run, whole, tmp_path, saw, name):
    results = []
    for topic in READ[: 2 if name != "other order of fields" else 5]:
        target = tmp_path / topic.replace("/", "_") / "run.mcap"
        path = rewrite(
            run,
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
def test_metadata_that_say_something_else_are_named(run, whole, tmp_path, saw, name):
    path = rewrite(run, tmp_path / "log" / "run.mcap", metadata=METADATA[name])
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
def test_attachments_that_say_something_else_are_named(run, whole, tmp_path, saw, name):
    path = rewrite(run, tmp_path / "log" / "run.mcap", attachments=ATTACHMENTS[name])
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


def test_a_path_that_is_none_costs_only_the_figures_that_need_it(run, whole, tmp_path, saw):
    for text in (
        b"{",
        b"[]",
        b'{"times": [0, 0], "positions": [[0,0,0],[1,1,1]], "orientations": []}',
    ):
        folder = tmp_path / str(len(text))
        change = {"path.json": text}
        path = rewrite(run, folder / "run.mcap", attachments=lambda a, c=change: a | c)
        summary = summarise(path, wall_s=0.0)
        assert summary["outcome"] == "invalid"
        assert "path.json" in summary["missing"]["end_effector_error_m"]
        assert summary["roll_deg"] == whole["roll_deg"]
    saw(
        "path.json is not a path",
        "figures without it stay, the others say why they are missing",
        "3",
    )


def test_joints_of_another_vehicle_are_named(run, whole, tmp_path, saw):
    other = load_scenario("manipulation", vehicle="bluerov2_alpha5").load_vehicle()
    text = dump_vehicle(other).encode()
    path = rewrite(
        run, tmp_path / "log" / "run.mcap", attachments=lambda a: a | {"vehicle.yaml": text}
    )
    assert judged(path, whole, tmp_path) == "fault stated"
    saw("vehicle.yaml of another vehicle", "named: its joints are not those of the messages")


@pytest.mark.long
@pytest.mark.parametrize("seed", range(6))
def test_damaged_logs_still_have_a_report(data, tmp_path, saw, seed):
    rng = np.random.default_rng(seed)
    damaged = flipped(flipped(data, rng), rng) if seed % 2 else data[: len(data) * (seed + 1) // 7]
    page = report(write(tmp_path / "bad.mcap", damaged)).read_text(encoding="utf-8")
    assert "Outcome: invalid" in page
    saw("report of a damaged log", "drawn as far as it goes, with a red banner")
