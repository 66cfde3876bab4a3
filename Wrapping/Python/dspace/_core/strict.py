"""A base class whose objects accept only attributes that their class declares."""


class Strict:
    """Rejects setting an attribute that does not exist, so that a mistyped name raises an error.

    Properties, names that begin with an underscore, and names in `_own` can be set.
    """
    _own = ()
    _instead = {}  # what to do instead of setting an attribute of that name

    def __setattr__(self, name, value):
        kind = type(self)
        if not (name.startswith("_") or name in kind._own
                or hasattr(getattr(kind, name, None), "__set__")):
            settable = sorted(
                other for other in dir(kind) if not other.startswith("_")
                and getattr(getattr(kind, other), "fset", None) is not None)
            what = "is no property" if hasattr(kind, name) else "does not exist"
            raise AttributeError(f"{self!r}: attribute {name!r} {what}; accepted: "
                                 + (", ".join(settable) or "none can be set")
                                 + (f"; {kind._instead[name]}" if name in kind._instead else ""))
        object.__setattr__(self, name, value)
