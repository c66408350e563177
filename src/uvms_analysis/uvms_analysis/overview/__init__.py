"""A quick look at a log: what it is, which topics it has, what their values are."""

from uvms_analysis.overview.info import info_text, log_info
from uvms_analysis.overview.topic_rows import TopicRow, topic_rows
from uvms_analysis.overview.values import ValueRow, value_rows, values_text

__all__ = [
    "TopicRow",
    "ValueRow",
    "info_text",
    "log_info",
    "topic_rows",
    "value_rows",
    "values_text",
]
