"""What size, hiding and the border of the picture do to a detector, by doing it: the same picture
made smaller, a thing half covered, the picture moved until the border cuts a thing. No labels are
needed, because the detector is compared with itself."""
import os
import pickle

import cv2
import numpy as np

from .detector_fit import NOT_FOUND, cut, iou, logit, size
from .network_outputs import NanoDet, listed

COVERED = 0.5
SHIFTED = 0.4


def best_match(rows, box, cls, least=0.3):
    """The box of the same class that is most like this one; None if none is."""
    same = [r for r in rows if r[4] == cls and iou(r[:4], box) > least]
    return max(same, key=lambda r: r[5]) if same else None


def change(before, row):
    return logit(row[5] if row is not None else NOT_FOUND) - logit(before[5])


def shrink(detector, bgr, row, factor):
    """The picture made smaller in the middle of a grey one."""
    h, w = bgr.shape[:2]
    small = cv2.resize(bgr, None, fx=factor, fy=factor, interpolation=cv2.INTER_AREA)
    x, y = (w - small.shape[1]) // 2, (h - small.shape[0]) // 2
    canvas = np.full_like(bgr, 114)
    canvas[y:y + small.shape[0], x:x + small.shape[1]] = small
    box = row[:4] * factor + [x, y, x, y]
    return change(row, best_match(detector(canvas), box, row[4])) / np.log(factor)


def cover(detector, bgr, row, side, rng):
    """One half of the box is covered by a piece of the picture from elsewhere. Gives the change of
    the score and where the covered edge goes: 0 to what is seen, 1 stays where it was."""
    h, w = bgr.shape[:2]
    x0, y0, x1, y1 = row[:4]
    bw, bh = x1 - x0, y1 - y0
    part = {0: (x0 - 0.3 * bw, y0 - 0.3 * bh, x0 + COVERED * bw, y1 + 0.3 * bh),
            1: (x0 - 0.3 * bw, y0 - 0.3 * bh, x1 + 0.3 * bw, y0 + COVERED * bh),
            2: (x1 - COVERED * bw, y0 - 0.3 * bh, x1 + 0.3 * bw, y1 + 0.3 * bh),
            3: (x0 - 0.3 * bw, y1 - COVERED * bh, x1 + 0.3 * bw, y1 + 0.3 * bh)}[side]
    a, b = np.clip(part[0::2], 0, w).astype(int), np.clip(part[1::2], 0, h).astype(int)
    cw, ch = a[1] - a[0], b[1] - b[0]
    if cw < 4 or ch < 4 or cw >= w or ch >= h:
        return None
    sx, sy = rng.integers(0, w - cw), rng.integers(0, h - ch)
    changed = bgr.copy()
    changed[b[0]:b[1], a[0]:a[1]] = bgr[sy:sy + ch, sx:sx + cw]
    seen = row[:4].copy()
    seen[side] += (1 if side < 2 else -1) * COVERED * (bw if side % 2 == 0 else bh)
    found = best_match(detector(changed), seen, row[4])
    went = None if found is None else (found[side] - seen[side]) / (row[side] - seen[side])
    return change(row, found), went


def shift(detector, bgr, row):
    """The picture is moved to the left until its border cuts the box; what opens is a reflection."""
    move = row[0] + SHIFTED * (row[2] - row[0])
    M = np.float32([[1, 0, -move], [0, 1, 0]])
    moved = cv2.warpAffine(bgr, M, (bgr.shape[1], bgr.shape[0]), borderMode=cv2.BORDER_REFLECT)
    # The reflection begins right of the picture; left, the border is a real one.
    seen = np.array([0, row[1], row[2] - move, row[3]])
    found = best_match(detector(moved), seen, row[4])
    off = None if found is None else max(0.0, found[0]) / (seen[2] - seen[0])
    return change(row, found), off


def measure(data, models, cache):
    if cache and os.path.exists(cache + '.interventions'):
        with open(cache + '.interventions', 'rb') as f:
            return pickle.load(f)
    detector, rng = NanoDet(models), np.random.default_rng(0)
    result = {'shrink': [], 'cover': [], 'went': [], 'shift': [], 'off': []}
    for _, name in listed(data, 'rgb.txt')[::20]:
        bgr = cv2.imread(os.path.join(data, name))
        rows = [r for r in detector(bgr) if r[5] > 0.4 and not cut(r[:4]).any() and size(r[:4]) > 40]
        for row in sorted(rows, key=lambda r: -r[5])[:2]:
            for factor in (0.7, 0.5):
                result['shrink'].append((size(row[:4]) * factor, shrink(detector, bgr, row, factor)))
            got = cover(detector, bgr, row, int(rng.integers(4)), rng)
            if got is not None:
                result['cover'].append(got[0])
                result['went'] += [got[1]] if got[1] is not None else []
            change_, off = shift(detector, bgr, row)
            result['shift'].append(change_)
            result['off'] += [off] if off is not None else []
    if cache:
        with open(cache + '.interventions', 'wb') as f:
            pickle.dump(result, f)
    return result


def fit(data, models, cache):
    m = measure(data, models, cache)
    hidden = np.median(m['cover']) / COVERED
    return {'per_log_size': np.median([s for _, s in m['shrink']]),
            'quartiles of per_log_size': [tuple(np.percentile([s for _, s in m['shrink']], [25, 75]))],
            'per_hidden': hidden,
            'lost when half hidden': np.mean(np.array(m['cover']) < -2),
            'amodal_share': np.median(m['went']),
            'quartiles of amodal_share': [tuple(np.percentile(m['went'], [25, 75]))],
            'change when cut by 0.4': np.median(m['shift']),
            'truncated': np.median(m['shift']) - SHIFTED * hidden,
            'rms off the border': np.sqrt(np.mean(np.square(m['off']))),
            'boxes': len(m['cover'])}
