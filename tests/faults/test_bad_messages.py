"""Bad messages on every topic that a node reads: nobody dies, nothing bad gets out, all recover."""

import numpy as np
import pytest
from bad_messages import random_bytes, structured
from wire import NODES, wire

from uvms_core import topics
from uvms_core.cdr import CdrError, codec
from uvms_core.signals import BY_THRUSTER
from uvms_core.vehicle import load_vehicle

VEHICLE = load_vehicle()
READ = sorted(
    {topic for own in topics.NODES.values() for topic in own.inputs} - {topics.CLOCK},
    key=lambda topic: topic.name,
)
"""Every topic that some node of the loop reads; /clock is read by none of ours."""
A_TICK = 20
"""Bad messages between two ticks, while the good ones go on."""
RECOVERY_S = 2.0


def names_of(topic):
    by_thruster = topic.signal in BY_THRUSTER
    return VEHICLE.thruster_names if by_thruster else VEHICLE.joint_names


def bad(kind, topic, rng, good):
    if kind == "random":
        return random_bytes(rng, good)
    return structured(rng, topic, good, names_of(topic))


def flood(w, topic, kind, count, seed):
    """Bad messages amid good ones; the wire itself fails where an output is not finite."""
    rng, good = np.random.default_rng(seed), w.last[topic.name]

    def inject():
        for _ in range(A_TICK):
            w.inject(topic.name, bad(kind, topic, rng, good))

    w.run(0.05 * count / A_TICK, inject)


def check_all(kind, count, saw):
    worst = 0.0
    with wire() as w:
        w.start()
        w.run(1.0)
        for seed, topic in enumerate(READ):
            flood(w, topic, kind, count, seed)
            w.run(RECOVERY_S - 0.5)
            assert w.works(), (topic.name, {r: n._status for r, n in w.nodes.items()})
            worst = max(worst, float(np.linalg.norm(w.heard["ground_truth/odometry"][-1].nu[:3])))
        refused = sum(node._refused for node in w.nodes.values())
        assert set(w.nodes) == set(NODES)
    assert refused > 0.2 * count * len(READ)
    saw(
        f"{kind} bad messages, {count} on each topic that a node reads",
        f"no node died, nothing bad was published, all worked 2 s later; {refused} refused",
        str(count * len(READ)),
    )


@pytest.mark.parametrize("kind", ["random", "structured"])
def test_forty_bad_messages_on_each_topic(kind, saw):
    check_all(kind, 40, saw)


@pytest.mark.long
@pytest.mark.parametrize("kind", ["random", "structured"])
def test_a_thousand_bad_messages_on_each_topic(kind, saw):
    check_all(kind, 1000, saw)


@pytest.mark.parametrize("topic", READ, ids=lambda topic: topic.name)
def test_a_reader_never_allocates_by_a_length_that_the_bytes_do_not_have(topic):
    """A message with a huge length at any place is refused at once, or read as what it is."""
    import tracemalloc

    rng = np.random.default_rng(1)
    with wire_of_one_tick() as good:
        data = good[topic.name]
    wire_codec = codec(topic.type)
    tracemalloc.start()
    for at in range(4, len(data) - 4, 4):
        for length in (b"\xff\xff\xff\xff", b"\xff\xff\xff\x7f", b"\x00\x00\x00\x40"):
            try:
                wire_codec.decode(data[:at] + length + data[at + 4 :])
            except CdrError:
                continue
    for _ in range(300):
        try:
            wire_codec.decode(b"\x00\x01\x00\x00" + rng.bytes(int(rng.integers(0, 3000))))
        except CdrError:
            continue
    _, peak = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert peak < 2_000_000


_GOOD: dict[str, bytes] = {}


class wire_of_one_tick:  # noqa: N801 (reads as a function)
    """Good bytes of every topic, made once by the real nodes."""

    def __enter__(self):
        if not _GOOD:
            with wire() as w:
                w.start()
                w.run(1.0)
                _GOOD.update(w.last)
        return _GOOD

    def __exit__(self, *_):
        return None
