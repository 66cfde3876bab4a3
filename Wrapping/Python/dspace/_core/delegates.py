"""Delegation of a class's methods to a collaborator."""
import functools


def delegate(collaborator, name):
    """Returns a method or property for the body of a class. It makes `collaborator(self)` and calls its member `name`.
    Signature and docstring are those of the member."""
    member = getattr(collaborator, name)
    if isinstance(member, property):
        return property(lambda self: member.fget(collaborator(self)), doc=member.__doc__)

    @functools.wraps(member)
    def call(self, *arguments, **keywords):
        return member(collaborator(self), *arguments, **keywords)

    return call
