"""Terrain: queries, style, colour layers and wheel tracks."""
