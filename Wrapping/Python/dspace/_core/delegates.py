"""Methods of a class that a collaborator of it has."""
import functools


def delegate(collaborator, name):
    """The method or property `name` of the class `collaborator`, as one of a class whose instance `collaborator(instance)`
    takes; with its signature and docstring."""
    member = getattr(collaborator, name)
    if isinstance(member, property):
        return property(lambda self: member.fget(collaborator(self)), doc=member.__doc__)

    @functools.wraps(member)
    def call(self, *arguments, **keywords):
        return member(collaborator(self), *arguments, **keywords)

    return call
