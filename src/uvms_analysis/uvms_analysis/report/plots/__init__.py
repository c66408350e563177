"""The plots of the report, one file a subject."""
