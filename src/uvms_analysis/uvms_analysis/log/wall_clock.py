"""The clock on the wall, which says when a message was recorded and nothing else."""

from time import time_ns

__all__ = ["time_ns"]
