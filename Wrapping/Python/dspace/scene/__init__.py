"""Scenes, and the viewports that show them."""
