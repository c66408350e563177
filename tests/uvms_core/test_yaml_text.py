"""YAML that people write: one line that says where and why, whatever is wrong with it."""

import pytest

from uvms_core.errors import ConfigError
from uvms_core.yaml_text import parse_yaml, read_yaml


def refusal(text: str) -> str:
    with pytest.raises(ConfigError) as fault:
        parse_yaml(text, "it", ConfigError)
    return str(fault.value)


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
        ("[1]: 2", "line 1, column 1: found unhashable key"),
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
