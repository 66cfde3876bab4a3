"""Helpers that all rooms use: checks of arguments, messages, files. Not public."""
