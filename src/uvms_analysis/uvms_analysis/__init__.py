"""What runs and trials left behind: logs, summaries, reports, trials of real vehicles."""
