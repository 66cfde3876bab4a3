"""What sees the elements of styles and layers of terrain, and with what they are shown and hidden."""
from dspace._core.fields import flag

MEMBER = ("fragment", "ornamental")  # keys of the dicts of set_style()


def put_member(message, scene, look, common, label):
    """Writes `fragment` and `ornamental` of a dict into a message that has `nature` and `fragment`; for an absent key,
    that of `common`. None: absent."""
    fragment, ornamental = (look.get(key, common.get(key)) for key in MEMBER)
    if fragment is not None:
        message.fragment = scene._fragment_name(fragment)
    if ornamental is not None:
        message.nature = 1 if flag(ornamental, "ornamental", label) else 0
