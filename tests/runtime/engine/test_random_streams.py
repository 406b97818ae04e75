"""A draw depends only on the seed, the name, the channel and the sample's index."""

import numpy as np

from simkit.runtime.engine.random_streams import RandomStreams


def draws(stream, indices):
    return np.array([stream.normal(i).copy() for i in indices])


def test_a_skipped_sample_does_not_shift_the_following_samples():
    every = draws(RandomStreams(3).stream("m::l::s", "noise", 6), range(1000))
    some = draws(RandomStreams(3).stream("m::l::s", "noise", 6), [0, 999, 500, 7])
    np.testing.assert_array_equal(some, every[[0, 999, 500, 7]])


def test_streams_with_different_names_channels_and_seeds_differ():
    base = draws(RandomStreams(1).stream("a", "x", 4), range(50))
    for seed, name, channel in ((1, "b", "x"), (1, "a", "y"), (2, "a", "x"), (-1, "a", "x")):
        other = RandomStreams(seed).stream(name, channel, 4)
        assert np.abs(draws(other, range(50)) - base).min() > 1e-9


def test_draws_from_one_stream_do_not_affect_another_stream():
    streams = RandomStreams(1)
    first = streams.stream("a", "x", 4)
    before = first.normal(0).copy()
    streams.stream("b", "x", 4).normal(0)
    np.testing.assert_array_equal(first.normal(1), RandomStreams(1).stream("a", "x", 4).normal(1))
    np.testing.assert_array_equal(first.normal(0), before)


def test_normal_draws_have_mean_zero_and_deviation_one_and_do_not_repeat():
    values = draws(RandomStreams(0).stream("a", "x", 3), range(20000))
    assert np.abs(values.mean(axis=0)).max() < 5 / np.sqrt(20000)
    np.testing.assert_allclose(values.std(axis=0), 1.0, atol=0.02)
    assert len(np.unique(values)) == values.size


def test_uniform_draws_fill_plus_and_minus_one_evenly_and_by_index_alone():
    stream = RandomStreams(0).stream("a", "x", 3)
    values = np.array([stream.uniform(i) for i in range(20000)])
    assert values.min() < -0.999 and values.max() > 0.999
    np.testing.assert_allclose(values.mean(axis=0), 0, atol=5 / np.sqrt(3 * 20000))
    np.testing.assert_allclose(values.std(axis=0), 1 / np.sqrt(3), rtol=0.02)
    np.testing.assert_array_equal(RandomStreams(0).stream("a", "x", 3).uniform(12345), values[12345])
    assert not np.array_equal(stream.normal(5), stream.uniform(5))


def test_reseeding_changes_existing_streams_too():
    streams = RandomStreams(1)
    stream = streams.stream("a", "x", 2)
    stream.normal(0)
    streams.reseed(9)
    np.testing.assert_array_equal(stream.normal(0), RandomStreams(9).stream("a", "x", 2).normal(0))


def test_a_part_of_a_block_has_the_numbers_of_the_whole_block_after_any_seeds():
    whole = RandomStreams(5).stream("a", "x", 3).normals(0, 10_000).copy()
    streams = RandomStreams(5)
    stream = streams.stream("a", "x", 3)
    np.testing.assert_array_equal(stream.normals(0, 7), whole[:7])
    for seed in (5, 6, 5):
        streams.reseed(seed)
    for index in (3, len(whole) - 1, 0):
        np.testing.assert_array_equal(stream.normal(index), whole[index])
    np.testing.assert_array_equal(stream.normals(100, 10_000), whole[100:])
