"""YAML 1.2 as people write it, one line of error with its place, and text that survives."""

from pathlib import Path

import pytest
import yaml

from uvms_core.errors import ConfigError
from uvms_core.yaml_text import MAX_VALUES, dump_yaml, parse_yaml, read_yaml


def refusal(text: str) -> str:
    with pytest.raises(ConfigError) as fault:
        parse_yaml(text, "it", ConfigError)
    return str(fault.value)


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1e-3", 0.001),
        ("5E6", 5e6),
        ("012", 12),
        ("0o12", 10),
        ("on", "on"),
        ("off", "off"),
        ("yes", "yes"),
        ("no", "no"),
        ("true", True),
        ("1:30", "1:30"),
        ("~", None),
        ("", None),
    ],
)
def test_scalars_are_those_of_yaml_1_2(text, value):
    found = parse_yaml(text, "it", ConfigError)
    assert (found, type(found)) == (value, type(value))


def test_text_that_looks_like_a_number_stays_text_for_either_version():
    """ROS reads parameter files as YAML 1.1, this project reads 1.2."""
    texts = ["1e-3", ".5e3", "012", "0o12", "0x1f", "1:30", "1_000", "on", "yes", "~", "x", "1."]
    data = {"texts": texts, "numbers": [1e-5, -1e300, 0.1, 12, True, None]}
    written = dump_yaml(data)
    assert parse_yaml(written, "it", ConfigError) == data
    assert yaml.safe_load(written) == data


def test_an_alias_counts_for_all_that_it_stands_for():
    lines = ["a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]"]
    lines += [f"a{k + 1}: &a{k + 1} [{', '.join([f'*a{k}'] * 10)}]" for k in range(20)]
    assert f"more than {MAX_VALUES} values" in refusal("\n".join(lines))
    assert len(parse_yaml("\n".join(lines[:3]), "it", ConfigError)["a2"]) == 10


def test_merge_keys_are_taken_and_may_be_overruled():
    text = "a: &a {x: 1, y: 2}\nb: &b {<<: *a, y: 3}\nc: {<<: *b, y: 4}\n"
    data = parse_yaml(text, "it", ConfigError)
    assert data == {"a": {"x": 1, "y": 2}, "b": {"x": 1, "y": 3}, "c": {"x": 1, "y": 4}}


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("a: 1\nb: 2\na: 3\n", "line 3, column 1: the key 'a' is given twice"),
        ("a: {b: 1, 'b': 2}", "line 1, column 11: the key 'b' is given twice"),
        ("a: [1, 2", "line 1, column 9: expected ',' or ']', but got '<stream end>'"),
        ("a: 2020-99-99", "month must be in 1..12"),
        ("&a [*a]", "more than 100000 values"),
        ("a: *b", "line 1, column 4: found undefined alias 'b'"),
        ("a:\n\t- 1", "line 2, column 1: found character '\\t' that cannot start any token"),
        ("a: {<<: {b: 1}, <<: {c: 1}}", "line 1, column 17: found duplicate merge key"),
        ("a: !!python/object:os.system x", "line 1, column 4: could not determine a constructor"),
        ("a: \x00", "unacceptable character #x0000"),
        ("[" * 5000, "maximum recursion depth exceeded"),
    ],
)
def test_what_is_no_yaml_is_refused_in_one_line(text, reason):
    message = refusal(text)
    assert message.startswith("it: is not valid YAML: ")
    assert reason in message
    assert len(message.splitlines()) == 1


def test_files_that_cannot_be_read(tmp_path):
    latin = tmp_path / "latin.yaml"
    latin.write_bytes("name: grün".encode("latin-1"))
    with pytest.raises(ConfigError) as fault:
        read_yaml(latin, "it", ConfigError)
    assert str(fault.value) == "it: cannot be read: byte 8 is not UTF-8; save the file as UTF-8"
    with pytest.raises(ConfigError) as fault:
        read_yaml(tmp_path, "it", ConfigError)
    assert str(fault.value) == "it: cannot be read: Is a directory"


def bomb(deeper: str) -> str:
    """Nine times the level before on each of nine lines; `deeper` has the nine aliases at {}."""
    lines = ["a0: &a0 {x: 1}"]
    lines += [f"a{k + 1}: &a{k + 1} {deeper.format(', '.join([f'*a{k}'] * 9))}" for k in range(8)]
    return "{" + ", ".join(lines) + "}"


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        (bomb("[{}]"), "more than 100000 values"),
        (bomb("{{<<: [{}]}}"), "more than 100000 values"),
        ("&a {<<: *a}", "more than 100000 values"),
        ("? &a [1, 1]\n: 1\n? [*a, *a]\n: 2", "column 3: a name must be one word or number"),
        ("a: " + "9" * 5000, "a number of 5000 characters, 999"),
        ("a: 0x" + "f" * 5000, "a number of 5002 characters, 0xfff"),
        ("a: 2020-01-01", "line 1, column 4: 2020-01-01 is a date to YAML; put it in quotes"),
        ("a: !!set {b, c}", "could not determine a constructor for the tag '!!set'"),
        ("a: !!binary aGk=", "could not determine a constructor for the tag '!!binary'"),
        ("a: !!bool maybe", "maybe"),
        ("a: " + "{b: " * 60 + "1" + "}" * 60, "groups may be 50 deep"),
        ("a: '" + "x" * 600_000 + "'", "more than 500000 characters"),
        ("a: \udcff", "unacceptable character #xdcff"),
    ],
)
def test_what_would_take_for_ever_or_is_no_plain_data_is_refused(text, reason):
    message = refusal(text)
    assert reason in message
    assert len(message.splitlines()) == 1
    assert len(message) < 300


def test_directives_anchors_and_a_byte_order_mark_are_read(tmp_path):
    assert parse_yaml("%YAML 1.2\n---\na: 1\n", "it", ConfigError) == {"a": 1}
    assert parse_yaml("[&a 1, &a 2, *a]", "it", ConfigError) == [1, 2, 2]
    marked = tmp_path / "marked.yaml"
    marked.write_bytes(b"\xef\xbb\xbfa: 1\n")
    assert read_yaml(marked, "it", ConfigError) == {"a": 1}


def test_no_more_of_an_endless_file_is_read_than_its_bound():
    with pytest.raises(ConfigError, match="more than 500000 characters"):
        read_yaml(Path("/dev/zero"), "it", ConfigError)
