"""Frames, their poses and their events."""
