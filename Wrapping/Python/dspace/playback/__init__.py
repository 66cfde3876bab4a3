"""Recordings played back."""
