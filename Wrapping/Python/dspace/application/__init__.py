"""What the menus of DspaceQt do: the object `app` of its Python prompt."""
from dspace.application.app import App

__all__ = ["App"]
