"""What a detector does wrong, from a static scene with known poses and measured depth, but without
labels. Objects are clusters of detections in space; where one should be seen, the detector's best
box there is looked up, frame by frame, with its score down to 0.05."""
from collections import Counter

import numpy as np
from scipy import optimize

from .statistics import TICK, lasting_and_flicker, mixture, robust_sigma, seconds_of_a_switch

FAMILIES = [('cup', 'bowl', 'vase', 'wine glass'), ('tv', 'laptop'), ('chair', 'couch', 'bench')]
# Things of which pictures were looked at: mugs, screens and chairs are there. Books stand side by side
# and the table fills the picture, so neither gives separate clusters; others are wrong as often as not.
LEFT_OUT = ('book', 'dining table')
RADIUS = 0.35   # metres within which detections are of one object
SUPPORT = 20    # detections that make an object
THRESHOLD = 0.3
NOT_FOUND = 0.04  # below the lowest score that is kept
WIDTH, HEIGHT, F, CX, CY = 640, 480, 525.0, 320.0, 240.0


class Scene:
    """Pictures' truth: poses of the depth camera and measured depth (see the data's README)."""

    def __init__(self, poses, depth):
        self.poses, self.depth = poses, depth  # 4x4 camera to world; metres 120 x 160

    def depth_at(self, frame, u, v, half):
        x, y = (u - CX) * 146.25 / F + 80, (v - CY) * 146.25 / F + 60
        h = max(1, int(half * 146.25 / F))
        x0, y0 = int(max(0, x - h)), int(max(0, y - h))
        patch = self.depth[frame][y0:int(y + h) + 1, x0:int(x + h) + 1]
        patch = patch[patch > 0]
        return float(np.percentile(patch, 35)) if len(patch) > 3 else None

    def to_world(self, frame, u, v, z):
        x = np.array([(u - CX) / F * z, (v - CY) / F * z, z, 1])
        return (self.poses[frame] @ x)[:3]

    def project(self, frame, point):
        x = np.linalg.inv(self.poses[frame]) @ np.append(point, 1)
        if x[2] < 0.2:
            return None
        return F * x[0] / x[2] + CX, F * x[1] / x[2] + CY, x[2]


def family_of(name):
    for family in FAMILIES:
        if name in family:
            return family[0]
    return None


def size(box):
    return np.sqrt((box[2] - box[0]) * (box[3] - box[1]))


def cut(box, margin=3):
    return np.array([box[0] < margin, box[1] < margin, box[2] > WIDTH - 1 - margin,
                     box[3] > HEIGHT - 1 - margin])


def find_objects(frames, scene, coco):
    """Clusters: dicts with family, point, metres (of the box's side at its depth)."""
    clusters = []
    for i, frame in enumerate(frames):
        for row in np.concatenate([frame['nanodet'], frame['yolox']]):
            family = family_of(coco[int(row[4])])
            if row[5] < 0.4 or family is None or cut(row[:4]).any():
                continue
            u, v = (row[0] + row[2]) / 2, (row[1] + row[3]) / 2
            z = scene.depth_at(i, u, v, size(row[:4]) / 6)
            if z is None or z > 4:
                continue
            point = scene.to_world(i, u, v, z)
            near = [c for c in clusters if c['family'] == family
                    and np.linalg.norm(np.mean(c['points'][-50:], 0) - point) < RADIUS]
            if near:
                near[0]['points'].append(point)
                near[0]['metres'].append(size(row[:4]) * z / F)
            else:
                clusters.append({'family': family, 'points': [point], 'metres': [size(row[:4]) * z / F]})
    objects = []
    for c in clusters:
        if len(c['points']) >= SUPPORT:
            objects.append({'family': c['family'], 'point': np.median(c['points'], 0),
                            'metres': float(np.median(c['metres']))})
    return objects


def expected(scene, frame, thing):
    """u, v, side in pixels where the object should be seen; None where it is not or is hidden."""
    seen = scene.project(frame, thing['point'])
    if seen is None or seen[2] > 4:
        return None
    u, v, z = seen
    side = F * thing['metres'] / z
    if not (0.1 * side < u < WIDTH - 0.1 * side and 0.1 * side < v < HEIGHT - 0.1 * side):
        return None
    measured = scene.depth_at(frame, u, v, side / 6)
    if measured is None or measured < z - max(0.25, 0.5 * thing['metres']):
        return None
    return u, v, side


def follow(frames, scene, coco, objects, net):
    """For each object a list over frames: None where it cannot be seen, else the place and the best
    box of its family there (row, or None) and all boxes there."""
    tracks = []
    for thing in objects:
        track = []
        for i, frame in enumerate(frames):
            place = expected(scene, i, thing)
            if place is None:
                track.append(None)
                continue
            u, v, side = place
            rows = frame[net]
            centre = (rows[:, :2] + rows[:, 2:4]) / 2
            sides = np.sqrt((rows[:, 2] - rows[:, 0]) * (rows[:, 3] - rows[:, 1]))
            here = (np.abs(centre - [u, v]).max(1) < 0.5 * side) & (sides > 0.4 * side) & (sides < 2 * side)
            rows = rows[here]
            own = [r for r in rows if family_of(coco[int(r[4])]) == thing['family']]
            track.append((place, max(own, key=lambda r: r[5]) if own else None, rows))
        tracks.append(track)
    return tracks


def logit(p):
    return np.log(p / (1 - p))


def fit_scores(tracks, slopes):
    """What is left of the scores' logits after size and border, whose effects are known. A thing that
    is smaller than it usually is here is less sure; mugs of 50 px are as sure as chairs of 110 px."""
    series, offsets, gaps, scores, usuals = [], [], [], [], []
    for track in tracks:
        z, gone = np.full(len(track), np.nan), np.full(len(track), np.nan)
        usual = np.median([e[0][2] for e in track if e])
        for i, entry in enumerate(track):
            if entry is None:
                continue
            (u, v, side), best, _ = entry
            score = best[5] if best is not None else NOT_FOUND
            beyond = max(0, side / 2 - u, u + side / 2 - WIDTH) + max(0, side / 2 - v, v + side / 2 - HEIGHT)
            z[i] = logit(min(0.99, score)) - slopes['per_log_size'] * min(0, np.log(side / usual))
            if beyond > 0:
                z[i] -= slopes['per_hidden'] * beyond / side + slopes['truncated']
            gone[i] = float(score < THRESHOLD)
            scores.append(score)
        if np.isfinite(z).sum() > 30:
            offsets.append(np.nanmean(z))
            usuals.append(float(usual))
            series.append(z - offsets[-1])
            gaps.append(gone)
    lasting, seconds, flicker = lasting_and_flicker(series)
    missed, miss_seconds, stay = seconds_of_a_switch(gaps)
    return {'at_usual_size': np.mean(offsets), 'offsets': [tuple(offsets)], 'usual px': [tuple(usuals)], 'per_thing': np.std(offsets, ddof=1), 'lasting': lasting,
            'seconds': seconds, 'flicker': flicker, 'things': len(offsets), 'looks': len(scores),
            'share below 0.05': np.mean(np.array(scores) < 0.05), 'missed': missed,
            'missed after missed': stay}


def edge_series(tracks):
    """Edges of sure boxes over the box's side, one series an object and edge; cut ones are gaps."""
    edges, extents, scores = [], [], []
    for track in tracks:
        e, w, z = (np.full((len(track), 4), np.nan) for _ in range(3))
        for i, entry in enumerate(track):
            if entry is None or entry[1] is None or entry[1][5] < THRESHOLD:
                continue
            box = entry[1][:4]
            extent = np.array([box[2] - box[0], box[3] - box[1]] * 2)
            free = ~cut(box)
            e[i][free], w[i][free], z[i][free] = box[free], extent[free], logit(min(0.99, entry[1][5]))
        for j in range(4):
            edges.append(e[:, j]), extents.append(w[:, j]), scores.append(z[:, j])
    return edges, extents, scores


def fit_difference(a, b):
    """Two networks' edges of one object in one frame: half of the variance of their difference is
    what each is wrong by, as far as they are not wrong together. What the difference changes by from
    frame to frame is flicker, free of the camera's motion."""
    ea, wa, za = edge_series(a)
    eb, wb, _ = edge_series(b)
    series, pixels, side, sure = [], [], [], []
    for x, y, v, w, z in zip(ea, eb, wa, wb, za):
        extent = (v + w) / 2
        with np.errstate(invalid='ignore'):
            gap = np.where(np.abs(x - y) < 0.3 * extent, x - y, np.nan)  # else of different things
        series.append(gap / extent)
        jump = (gap[1:-1] - (gap[:-2] + gap[2:]) / 2) / np.sqrt(1.5) / np.sqrt(2)
        ok = np.isfinite(jump)
        pixels.append(jump[ok]), side.append(extent[1:-1][ok]), sure.append(z[1:-1][ok])
    pixels, side, sure = (np.concatenate(k) for k in (pixels, side, sure))
    by_size = [(float(np.median(side[s])), float(robust_sigma(pixels[s])))
               for s in np.array_split(np.argsort(side), 6)]
    # flicker² = floor² + (share of side)², through the medians of six sizes
    x, y = np.array(by_size).T
    floor2, share2 = optimize.nnls(np.column_stack([np.ones(6), x ** 2]), y ** 2)[0]
    unit = pixels / np.sqrt(floor2 + share2 * side ** 2)
    core, tail_share, tail_factor = mixture(unit)
    slope = np.polyfit(sure, np.log(np.maximum(np.abs(unit), 0.01)), 1)[0]
    lasting, seconds, _ = lasting_and_flicker(series)
    return {'lasting (lower bound)': lasting / np.sqrt(2), 'seconds': seconds, 'flicker': core * np.sqrt(share2),
            'floor_px': core * np.sqrt(floor2), 'tail_share': tail_share, 'tail_factor': tail_factor,
            'per_score': -slope, 'px by size': by_size, 'edges': len(pixels)}


def fit_cut(tracks):
    """Edges of things that the border must cut, from the border, over the box's side."""
    values = []
    for track in tracks:
        for entry in track:
            if entry is None or entry[1] is None or entry[1][5] < THRESHOLD:
                continue
            (u, v, side), box = entry[0], entry[1][:4]
            reach = [u - side / 2, v - side / 2, WIDTH - u - side / 2, HEIGHT - v - side / 2]
            off = [box[0], box[1], WIDTH - 1 - box[2], HEIGHT - 1 - box[3]]
            for j in range(4):
                if reach[j] < -0.1 * side:
                    values.append(max(0, off[j]) / (box[2 + j % 2] - box[j % 2]))
    return {'rms off the border': float(np.sqrt(np.mean(np.square(values)))),
            'median off the border': float(np.median(values)), 'edges': len(values)}


def iou(a, b):
    w = min(a[2], b[2]) - max(a[0], b[0])
    h = min(a[3], b[3]) - max(a[1], b[1])
    inter = max(0, w) * max(0, h)
    return inter / (size(a) ** 2 + size(b) ** 2 - inter)


def fit_classes(tracks, coco):
    """Classes of the surest box on a thing, and second boxes on it. A box of another family counts
    only where it lies on the best box of the thing's own family: else it is another thing's."""
    wrong, confused, second, ratios = [], Counter(), [], []
    for track in tracks:
        states, twice = np.full(len(track), np.nan), np.full(len(track), np.nan)
        same = [[r for r in e[2] if iou(r[:4], e[1][:4]) > 0.6 and r[5] >= THRESHOLD]
                if e and e[1] is not None else [] for e in track]
        tops = [coco[int(max(rows, key=lambda r: r[5])[4])] if rows else None for rows in same]
        names = Counter(name for name in tops if name)
        if sum(names.values()) < 30:
            continue
        usual = names.most_common(1)[0][0]
        for i, (entry, name) in enumerate(zip(track, tops)):
            if not name:
                continue
            states[i] = float(name != usual)
            confused[(usual, name)] += name != usual
            best = max(same[i], key=lambda r: r[5])
            again = [r for r in entry[2] if r is not best and r[5] >= THRESHOLD and 0.2 < iou(best[:4], r[:4])
                     and family_of(coco[int(r[4])]) == family_of(usual) and not np.array_equal(r, best)]
            twice[i] = float(len(again) > 0)
            ratios += [max(r[5] for r in again) / best[5]] if again else []
        wrong.append(states), second.append(twice)
    share, seconds, stay = seconds_of_a_switch(wrong)
    twice, twice_seconds, _ = seconds_of_a_switch(second)
    within = sum(n for (a, b), n in confused.items() if family_of(a) == family_of(b))
    return ({'wrong': share, 'seconds': seconds, 'wrong after wrong': stay,
             'within the family': within / max(1, sum(confused.values())), 'pairs': (+confused).most_common(6)},
            {'share': twice, 'seconds': twice_seconds, 'score_factor': float(np.median(ratios or [0]))})


def fit_false_alarms(frames, scene, coco, objects, net):
    """Boxes that belong to no object: false ones, but also real things that are rarely found."""
    alive, lengths, sizes, scores, names, total = [], [], [], [], Counter(), 0
    for i, frame in enumerate(frames):
        places = [(t, expected(scene, i, t)) for t in objects]
        # What is out of view may still show a part.
        now = []
        for r in frame[net][frame[net][:, 5] >= THRESHOLD]:
            name = coco[int(r[4])]
            u, v = (r[0] + r[2]) / 2, (r[1] + r[3]) / 2
            known = any(p and abs(p[0] - u) < 0.8 * p[2] and abs(p[1] - v) < 0.8 * p[2]
                        and family_of(name) == t['family'] for t, p in places)
            if known or name in LEFT_OUT or cut(r[:4]).any():
                continue
            total += 1
            names[name] += 1
            sizes.append(size(r[:4])), scores.append(r[5] - THRESHOLD)
            old = [a for a in alive if a[1] == r[4] and iou(a[0], r[:4]) > 0.3]
            now.append((r[:4], r[4], old[0][2] + 1 if old else 1))
        lengths += [a[2] for a in alive if not any(n[1] == a[1] and iou(n[0], a[0]) > 0.3 for n in now)]
        alive = now
    lengths = np.array(lengths + [a[2] for a in alive])
    short = lengths[lengths <= 30].sum() / lengths.sum()
    return {'per_picture': total / len(frames), 'mean seconds': lengths.mean() * TICK,
            'share in tracks of a second or less': short, 'score_above': float(np.mean(scores)),
            'size_px': float(np.median(sizes)), 'size_log_spread': float(np.std(np.log(sizes))),
            'classes': names.most_common(8)}
