"""What the rooms of the package share: checks of arguments, messages, files. Not public."""
