"""Commands of this package: one light module each, an entry point in the group `uvms.commands`."""
