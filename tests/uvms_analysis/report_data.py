"""What the page of a report holds: its data, its lines as numbers."""

import base64
import json
import re

import numpy as np


def page_data(page):
    """The data of the plots in the text of a page."""
    return json.loads(re.search(r'id="data">(.*?)</script>', page, re.DOTALL).group(1))


def numbers(text, kind):
    return np.frombuffer(base64.b64decode(text), dtype=f"<{kind}")


def line_of(data, key, name):
    """Times and values of a line of a plot."""
    (line,) = [one for one in data["plots"][key]["lines"] if one["name"] == name]
    times = numbers(data["times"][line["times"]], "f8")
    if "index" in line:
        times = times[numbers(line["index"], line["kind"])]
    return times, numbers(line["values"], "f4")
