"""Labels of objects in images, as COCO (cocodataset.org, "Data format") has them."""
import numpy as np


def run_lengths(mask):
    """Lengths of runs of 0 and 1 in a mask (h, w), column by column, the first of 0: COCO's uncompressed RLE."""
    flat = np.asarray(mask, bool).ravel(order="F")
    edges = np.flatnonzero(np.diff(flat)) + 1
    lengths = np.diff(np.concatenate(([0], edges, [len(flat)])))
    return ([0] if flat[0] else []) + lengths.tolist()


def annotations(labels, categories):
    """Of an image of labels (h, w): dicts of object (name), category_id, bbox [x, y, w, h], area and segmentation, in the order of
    the categories, then of the objects' names. categories: [(category's id, {object's id: its name})]."""
    found = []
    for category, objects in categories:
        for id, name in sorted(objects.items(), key=lambda item: item[1]):
            mask = labels == id
            rows, columns = np.flatnonzero(mask.any(axis=1)), np.flatnonzero(mask.any(axis=0))
            if not len(rows):
                continue
            x, y = int(columns[0]), int(rows[0])
            found.append({"object": name, "category_id": category, "iscrowd": 0, "area": int(mask.sum()),
                          "bbox": [x, y, int(columns[-1]) - x + 1, int(rows[-1]) - y + 1],
                          "segmentation": {"size": list(mask.shape), "counts": run_lengths(mask)}})
    return found
