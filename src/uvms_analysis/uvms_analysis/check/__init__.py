"""Whether a log is complete: what should be in it against what is, and how that hangs together.

Each kind of check is a file of its own and returns findings; `check_log` runs them all.
"""

from uvms_analysis.check.finding import Finding
from uvms_analysis.check.run import Check, TopicRow, check_log

__all__ = ["Check", "Finding", "TopicRow", "check_log"]
