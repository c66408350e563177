"""Damaged logs: each gives a stated fault, or exactly the figures of the undamaged one.

The source is a real simulated run with a path. Nothing may raise but LogError, and a run whose log
was damaged never counts as completed unless every figure is that of the whole log.
"""

import numpy as np
import pytest
from damage import flipped, flipped_in, reassembled, write
from judged import count_of, judged
from mcap.opcode import Opcode
from rewrite import rewrite

from uvms_analysis.log.read import RunLog
from uvms_analysis.log.recover import recover
from uvms_analysis.report import report

SEEDS_OF_QUICK = 1


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
    "count", [4, pytest.param(40, marks=pytest.mark.long)], ids=["quick", "long"]
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
    "seeds", [range(1), pytest.param(range(1, 12), marks=pytest.mark.long)], ids=["quick", "long"]
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
    "seeds", [range(1), pytest.param(range(1, 12), marks=pytest.mark.long)], ids=["quick", "long"]
)
def test_messages_that_were_changed_are_seen(whole_log, whole, tmp_path, saw, change, seeds):
    results = []
    for seed in seeds:
        rng = np.random.default_rng(seed)
        path = rewrite(
            whole_log,
            tmp_path / f"{seed}" / "run.mcap",
            messages=lambda all_, r=rng: change(all_, r),
        )
        assert RunLog.open(path).fault == ""
        results.append(judged(path, whole, tmp_path))
        assert results[-1] != "same figures" or change is shuffled, seed
    saw(f"messages {change.__name__}, checksums right", count_of(results), str(len(seeds)))


@pytest.mark.long
@pytest.mark.parametrize("seed", range(6))
def test_damaged_logs_still_have_a_report(data, tmp_path, saw, seed):
    rng = np.random.default_rng(seed)
    damaged = flipped(flipped(data, rng), rng) if seed % 2 else data[: len(data) * (seed + 1) // 7]
    page = report(write(tmp_path / "bad.mcap", damaged)).read_text(encoding="utf-8")
    assert "Outcome: invalid" in page
    saw("report of a damaged log", "drawn as far as it goes, with a red banner")
