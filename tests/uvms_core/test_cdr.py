"""Schema texts and CDR bytes against mcap_ros2 and rosbags, which share no code with ours."""

import numpy as np
import pytest
from examples import carrying, example, names_of
from mcap_ros2._dynamic import generate_dynamic, serialize_dynamic
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from uvms_core import topics
from uvms_core.cdr import CdrError, Codec, DefinitionError, codec, schema_text, type_hash
from uvms_core.cdr.parse import SEQUENCE, Field, parse_fields, parse_schema
from uvms_core.messages import from_message, to_message

TYPES = sorted({topic.type for topic in carrying()})


def plain(value):
    """Lists and numbers alone, which mcap_ros2 can encode."""
    if isinstance(value, dict):
        return {key: plain(item) for key, item in value.items()}
    if isinstance(value, list):
        return [plain(item) for item in value]
    return value.tolist() if hasattr(value, "tolist") else value


def leaves(value, path=""):
    """Every number and text in a message of any kind, by its path; a NaN as a text."""
    if isinstance(value, (float, np.floating)) and np.isnan(value):
        yield path, "NaN"
    elif isinstance(value, (str, bytes, int, float, bool, np.generic)):
        yield path, value
    elif isinstance(value, (list, tuple, np.ndarray)):
        for index, item in enumerate(value):
            yield from leaves(item, f"{path}[{index}]")
    else:
        for name in getattr(value, "__slots__", ()) or vars(value):
            if name.islower() and not name.startswith("_"):  # rosbags keeps constants, too
                yield from leaves(getattr(value, name), f"{path}.{name}")


def store_with(name):
    """The types of Jazzy and one read from our schema text."""
    store = get_typestore(Stores.ROS2_JAZZY)
    fresh = get_types_from_msg(schema_text(name), name)
    store.register({key: kind for key, kind in fresh.items() if key not in store.types})
    return store


@pytest.mark.parametrize("topic", carrying(), ids=lambda t: t.name)
def test_bytes_are_those_of_mcap_ros2(topic):
    rng = np.random.default_rng(3)
    encode = serialize_dynamic(topic.type, schema_text(topic.type))[topic.type]
    decode = generate_dynamic(topic.type, schema_text(topic.type))[topic.type]
    for _ in range(3):
        message = to_message(topic, example(topic.signal, rng), names_of(topic))
        data = codec(topic.type).encode(message)
        assert data == encode(plain(message))
        assert dict(leaves(codec(topic.type).decode(data))) == dict(leaves(decode(data)))


@pytest.mark.parametrize("topic", carrying(), ids=lambda t: t.name)
def test_rosbags_reads_the_same(topic):
    rng = np.random.default_rng(4)
    store = store_with(topic.type)
    message = to_message(topic, example(topic.signal, rng), names_of(topic))
    data = codec(topic.type).encode(message)
    theirs = dict(leaves(store.deserialize_cdr(data, topic.type)))
    assert dict(leaves(codec(topic.type).decode(data))) == theirs


@pytest.mark.parametrize("topic", carrying(), ids=lambda t: t.name)
def test_signals_survive_the_bytes(topic):
    signal = example(topic.signal, np.random.default_rng(6))
    data = codec(topic.type).encode(to_message(topic, signal, names_of(topic)))
    back = from_message(topic, codec(topic.type).decode(data), names_of(topic))
    again = codec(topic.type).encode(to_message(topic, back, names_of(topic)))
    assert again == data


@pytest.mark.parametrize("length", range(9))
def test_padding_is_right_behind_texts_of_any_length(length):
    text = "string a\nfloat64 b\nstring[] c\nuint8 d\nuint16[] e\nfloat64[] f\nbool[3] g\nint64 h\n"
    ours = Codec("pkg/msg/Odd", text)
    message = {
        "a": "x" * length,
        "b": 1.5,
        "c": ["y" * i for i in range(length)],
        "d": 7,
        "e": list(range(length)),
        "f": [0.5] * (length % 3),
        "g": [True, False, True],
        "h": -(2**40),
    }
    data = ours.encode(message)
    assert data == serialize_dynamic("pkg/msg/Odd", text)["pkg/msg/Odd"](message)
    back = ours.decode(data)
    assert plain({name: getattr(back, name) for name in message}) == message


def test_nested_lists_and_empty_structures():
    text = (
        "pkg/Inner[] many\npkg/Nothing none\npkg/Inner[2] two\nuint8 end\n"
        + "=" * 80
        + "\nMSG: pkg/Inner\nuint8 tag\nfloat64 x\nstring name\n"
        + "=" * 80
        + "\nMSG: pkg/Nothing\n# empty\n"
    )
    one, two = ({"tag": i, "x": 0.25 * i, "name": "ab" * i} for i in (1, 2))
    message = {"many": [one, two, one], "none": {}, "two": [two, one], "end": 9}
    ours = Codec("pkg/msg/Outer", text)
    data = ours.encode(message)
    assert data == serialize_dynamic("pkg/msg/Outer", text)["pkg/msg/Outer"](message)
    back = ours.decode(data)
    assert [item.name for item in back.many] == ["ab", "abab", "ab"]
    assert back.end == 9


def test_rclpy_and_ours_read_each_other():
    serialization = pytest.importorskip("rclpy.serialization")
    from nav_msgs.msg import Odometry

    topic = topics.ODOMETRY
    signal = example(topic.signal, np.random.default_rng(8))
    data = codec(topic.type).encode(to_message(topic, signal))
    theirs = serialization.deserialize_message(data, Odometry)
    for msg in (theirs, codec(topic.type).decode(serialization.serialize_message(theirs))):
        back = from_message(topic, msg)
        np.testing.assert_array_equal(back.nu, signal.nu)
        np.testing.assert_array_equal(back.twist_covariance, signal.twist_covariance)


def test_dependencies_come_once_and_breadth_first():
    marks = [line for line in schema_text("nav_msgs/msg/Odometry").splitlines() if "MSG: " in line]
    assert marks == [
        "MSG: std_msgs/Header",
        "MSG: geometry_msgs/PoseWithCovariance",
        "MSG: geometry_msgs/TwistWithCovariance",
        "MSG: builtin_interfaces/Time",
        "MSG: geometry_msgs/Pose",
        "MSG: geometry_msgs/Twist",
        "MSG: geometry_msgs/Point",
        "MSG: geometry_msgs/Quaternion",
        "MSG: geometry_msgs/Vector3",
    ]
    assert "\n" + "=" * 80 + "\nMSG: std_msgs/Header\n" in schema_text("nav_msgs/msg/Odometry")


@pytest.mark.parametrize("name", TYPES)
def test_type_hash_is_what_rosbags_works_out(name):
    assert type_hash(name) == store_with(name).hash_rihs01(name)


def test_fields_are_parsed():
    text = (
        "# comment\nuint8 OK=0\nstring NAME = 'x # y'\nfloat64 w 1\nstring<=10 s\n"
        "float64[36] c\nPoint[<=4] p\nmsgs/msg/Thing t # why\n"
    )
    assert parse_fields("geo", text) == (
        Field("w", "float64"),
        Field("s", "string"),
        Field("c", "float64", 36),
        Field("p", "geo/Point", SEQUENCE),
        Field("t", "msgs/Thing"),
    )


def test_unsupported_types_are_named():
    with pytest.raises(DefinitionError, match="field x: type 'wstring' is not supported"):
        parse_fields("pkg", "wstring x")


def test_unknown_types_say_where_was_looked():
    with pytest.raises(
        DefinitionError, match=r"nav_msgs/msg/Nonsense is not installed.*; looked fo"
    ):
        schema_text("nav_msgs/msg/Nonsense")
    with pytest.raises(DefinitionError, match="'Odometry' is not a type name"):
        schema_text("Odometry")


def test_a_wrong_dependency_mark_is_named():
    with pytest.raises(DefinitionError, match="a dependency starts with 'IDL: x', not 'MSG: '"):
        parse_schema("pkg/msg/A", "uint8 a\n" + "=" * 80 + "\nIDL: x\n")


def test_too_few_bytes_are_refused():
    topic = topics.ODOMETRY
    message = to_message(topic, example(topic.signal, np.random.default_rng(8)))
    data = codec(topic.type).encode(message)
    for length in range(len(data)):
        with pytest.raises(CdrError, match="nav_msgs/msg/Odometry"):
            codec(topic.type).decode(data[:length])


def test_big_endian_is_refused():
    with pytest.raises(CdrError, match="starts with 00000000, not little-endian CDR"):
        codec("rosgraph_msgs/msg/Clock").decode(bytes(12))


def test_missing_fields_and_wrong_lengths_are_refused():
    message = to_message(topics.WRENCH_COMMAND, example(topics.WRENCH_COMMAND.signal, _rng()))
    del message["wrench"]["torque"]
    with pytest.raises(CdrError, match="cannot be encoded: KeyError"):
        codec(topics.WRENCH_COMMAND.type).encode(message)
    message = to_message(topics.ODOMETRY, example(topics.ODOMETRY.signal, _rng()))
    message["pose"]["covariance"] = np.zeros(35)
    with pytest.raises(CdrError, match=r"covariance has shape \(35,\); it must be \(36,\)"):
        codec(topics.ODOMETRY.type).encode(message)


def _rng():
    return np.random.default_rng(1)
