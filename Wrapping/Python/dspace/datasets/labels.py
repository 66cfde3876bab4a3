"""Labels of objects in images, as COCO (cocodataset.org, "Data format") has them."""
import numpy as np


def run_lengths(mask):
    """Lengths of runs of 0 and 1 in a mask (h, w), column by column, the first of 0: COCO's uncompressed RLE."""
    flat = np.asarray(mask, bool).ravel(order="F")
    edges = np.flatnonzero(np.diff(flat)) + 1
    lengths = np.diff(np.concatenate(([0], edges, [len(flat)])))
    return ([0] if flat[0] else []) + lengths.tolist()


def compressed(lengths):
    """Run lengths as COCO's compressed RLE: a text.

    Each from the fourth on is the difference from the one two before it. A number is written in groups of five bits, the lowest
    first, until the rest is the sign alone; a group has 32 added where another follows, and stands as the character 48 + group."""
    groups = []
    for index, length in enumerate(lengths):
        value = length - lengths[index - 2] if index > 2 else length
        while True:
            group, value = value & 31, value >> 5
            ends = value == (-1 if group & 16 else 0)
            groups.append(48 + group + (0 if ends else 32))
            if ends:
                break
    return bytes(groups).decode("ascii")


def annotations(labels, categories, compress=False):
    """Of an image of labels (h, w): dicts of object (name), category_id, bbox [x, y, w, h], area and segmentation, in the order of
    the categories, then of the objects' names. categories: [(category's id, {object's id: its name})]. compress: the counts of a
    segmentation are a compressed text, not a list."""
    found = []
    for category, objects in categories:
        for id, name in sorted(objects.items(), key=lambda item: item[1]):
            mask = labels == id
            rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
            if not len(rows):
                continue
            x, y = int(columns[0]), int(rows[0])
            lengths = run_lengths(mask)
            found.append({"object": name, "category_id": category, "iscrowd": 0, "area": int(mask.sum()),
                          "bbox": [x, y, int(columns[-1]) - x + 1, int(rows[-1]) - y + 1],
                          "segmentation": {"size": list(mask.shape), "counts": compressed(lengths) if compress else lengths}})
    return found
