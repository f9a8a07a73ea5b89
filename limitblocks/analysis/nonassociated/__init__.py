"""The solution for real friction and the way to it; import from the modules."""
