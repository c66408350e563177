"""Campaigns: many runs of varied scenarios, judged by requirements; one idea a file."""
