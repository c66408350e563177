"""The planner methods that come with the package, one file each; see `interfaces.StepMethod`."""
