import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from uvms_planner.genome import decode, encode


def coded(increment, lower, upper, bits):
    chromosome = np.zeros(len(increment) * bits, dtype=np.uint8)
    encode(np.array(increment), np.array(lower), np.array(upper), bits, chromosome)
    return chromosome


def decoded(chromosome, lower, upper, bits):
    out = np.zeros(len(lower))
    decode(chromosome, np.array(lower), np.array(upper), bits, out)
    return out


@given(
    share=st.floats(0.0, 1.0),
    low=st.floats(-10.0, 10.0),
    width=st.floats(1e-6, 10.0),
    bits=st.integers(2, 52),
)
@settings(max_examples=200, deadline=None)
def test_what_is_encoded_comes_back_within_half_a_code(share, low, width, bits):
    lower, upper = [low, -1.0], [low + width, 1.0]
    increment = [low + share * width, 0.25]
    back = decoded(coded(increment, lower, upper, bits), lower, upper, bits)
    codes = 2**bits - 1
    assert abs(back[0] - increment[0]) <= 0.5 * width / codes + 4e-15 * (abs(low) + width)
    assert abs(back[1] - 0.25) <= 1.0 / codes + 1e-15


@given(st.lists(st.integers(0, 1), min_size=24, max_size=24))
@settings(max_examples=100, deadline=None)
def test_every_chromosome_is_within_the_bounds_and_comes_back_bit_by_bit(bits):
    lower, upper = [-2.0, 0.0, 5.0], [1.0, 0.5, 7.0]
    chromosome = np.array(bits, dtype=np.uint8)
    values = decoded(chromosome, lower, upper, 8)
    assert np.all(values >= lower)
    assert np.all(values <= upper)
    assert np.array_equal(coded(values, lower, upper, 8), chromosome)


def test_neighbouring_codes_differ_in_one_bit():
    for number in range(255):
        first = coded([float(number)], [0.0], [255.0], 8)
        second = coded([float(number + 1)], [0.0], [255.0], 8)
        assert np.sum(first != second) == 1


def test_all_codes_of_a_variable_are_reached():
    values = {
        decoded(np.array(list(np.binary_repr(k, 4)), dtype=np.uint8), [0.0], [15.0], 4)[0]
        for k in range(16)
    }
    assert values == set(map(float, range(16)))


def test_a_held_variable_stays_where_it_is():
    assert decoded(coded([0.3], [0.0], [0.0], 16), [0.0], [0.0], 16)[0] == 0.0


def test_what_is_outside_is_encoded_as_the_nearest_bound():
    assert decoded(coded([9.0], [-1.0], [1.0], 16), [-1.0], [1.0], 16)[0] == 1.0
    assert decoded(coded([-9.0], [-1.0], [1.0], 16), [-1.0], [1.0], 16)[0] == -1.0
