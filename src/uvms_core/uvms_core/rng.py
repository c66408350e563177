"""One seed, many generators: each consumer of random numbers has its own, by name."""

import hashlib

import numpy as np


def generator(seed: int, name: str) -> np.random.Generator:
    """Generator that depends on the seed and the consumer's name alone.

    The name is hashed with SHA-256, so that streams are the same on every machine and in every
    process, and a new consumer does not shift the others' numbers.
    """
    digest = hashlib.sha256(name.encode()).digest()
    words = [int.from_bytes(digest[i : i + 4], "little") for i in range(0, 16, 4)]
    return np.random.default_rng(np.random.SeedSequence([seed, *words]))
