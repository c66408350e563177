"""Which sensors are believed, and whether the estimate is: gates, levels, trials, health."""
