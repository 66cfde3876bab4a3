"""Cameras and vantages."""
