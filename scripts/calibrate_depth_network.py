#!/usr/bin/python3
"""Measures by what factor a depth network's metres must be multiplied to be metres, and how sure
that is: the `calibration` of its card (docs/perception.md).

    scripts/calibrate_depth_network.py [--card cards/meter_xxs_nyu.yaml] [--models ../shared/models]
        [--data ../shared/data/tum_fr1_xyz] [--check ../shared/data/redkitchen] [--every 10]

On `data` and `check` (TUM layout, with groundtruth.txt and calibration.yaml) corners are followed
through the pictures (Lucas-Kanade) and triangulated with the true poses. Where a folder has measured
depth, that is used as well, as a second opinion, moved only by the focal lengths. The factor is the
median over pictures of each picture's median of measured / predicted.

Three scatters (all of the logarithm, robust: 1.4826 times the median absolute deviation, or half of
the difference for two scenes) make the sigma of one picture's scale: within `data` over pictures,
and between the two scenes. Two scenes say little of their spread, so a floor (--floor) is put below
the second. Needs python3-opencv, python3-numpy, python3-yaml; a minute on one core."""
import argparse
import os

import cv2
import numpy as np
import yaml

HERE = os.path.dirname(os.path.abspath(__file__))
MIN_PARALLAX_DEG, MAX_REPROJECTION_PX, MIN_POINTS = 2.0, 1.5, 25
STRIDE, STEPS = 2, 16  # a corner is followed over STEPS pictures, each STRIDE after the last


class DepthNetwork:
    """The depth that a card describes, before its factor."""

    def __init__(self, file, models):
        card = yaml.safe_load(open(file))
        self.net = cv2.dnn.readNetFromONNX(os.path.join(models, card['file']))
        self.output, self.unit, self.input = card['output'], card['unit'], card['input']

    def __call__(self, bgr):
        i = self.input
        size = (i['width'], i['height'])
        x = cv2.resize(bgr, size, interpolation=cv2.INTER_AREA if i['filter'] == 'area'
                       else cv2.INTER_LINEAR).astype(np.float32)
        if i['channels'] == 'rgb':
            x = x[:, :, ::-1]
        x = (x - np.float32(i['mean'])) / np.float32(i['std'])
        self.net.setInput(np.ascontiguousarray(x.transpose(2, 0, 1)[None]))
        depth = self.net.forward(self.output).squeeze() * self.unit
        return cv2.resize(depth, (bgr.shape[1], bgr.shape[0]))


class Sequence:
    """A folder in the layout of TUM RGB-D."""

    def __init__(self, folder):
        self.folder = folder
        rows = lambda name: [l.split() for l in open(os.path.join(folder, name)) if l[0] != '#']
        self.pictures = [(float(t), f) for t, f in rows('rgb.txt')]
        self.calibration = yaml.safe_load(open(os.path.join(folder, 'calibration.yaml')))
        c = self.calibration['color']
        self.K = np.array([[c['fx'], 0, c['cx']], [0, c['fy'], c['cy']], [0, 0, 1]])
        self.distortion = np.array(c['distortion'])
        exact = os.path.join(folder, 'groundtruth_sfm.txt')
        self.poses = np.array(rows('groundtruth_sfm.txt' if os.path.exists(exact)
                                   else 'groundtruth.txt'), float)
        self.depths = [(float(t), f) for t, f in rows('depth.txt')] if os.path.exists(
            os.path.join(folder, 'depth.txt')) else []

    def picture(self, index):
        return cv2.imread(os.path.join(self.folder, self.pictures[index][1]))

    def pose(self, index):
        """Camera to world, interpolated; None beyond 50 ms from both neighbours."""
        t, times = self.pictures[index][0], self.poses[:, 0]
        j = int(np.searchsorted(times, t))
        if j == 0 or j == len(times) or times[j] - times[j - 1] > 0.1:
            return None
        a, b = self.poses[j - 1], self.poses[j]
        w = (t - a[0]) / (b[0] - a[0])
        q = (1 - w) * a[4:] + w * b[4:] * np.sign(a[4:] @ b[4:])
        x, y, z, s = q / np.linalg.norm(q)
        T = np.eye(4)
        T[:3, 3] = (1 - w) * a[1:4] + w * b[1:4]
        T[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * s), 2 * (x * z + y * s)],
                     [2 * (x * y + z * s), 1 - 2 * (x * x + z * z), 2 * (y * z - x * s)],
                     [2 * (x * z - y * s), 2 * (y * z + x * s), 1 - 2 * (x * x + y * y)]]
        return T


def follow(sequence, first):
    """Pixels of corners in the following pictures (steps x n x 2, NaN where lost) and poses."""
    before = cv2.cvtColor(sequence.picture(first), cv2.COLOR_BGR2GRAY)
    points = cv2.goodFeaturesToTrack(before, 400, 0.01, 10)
    tracks, poses = [points[:, 0].copy()], [sequence.pose(first)]
    alive = np.ones(len(points), bool)
    for k in range(1, STEPS + 1):
        index = first + k * STRIDE
        if index >= len(sequence.pictures) or sequence.pose(index) is None:
            break
        now = cv2.cvtColor(sequence.picture(index), cv2.COLOR_BGR2GRAY)
        moved, ok, _ = cv2.calcOpticalFlowPyrLK(before, now, points, None, winSize=(15, 15))
        back, ok_back, _ = cv2.calcOpticalFlowPyrLK(now, before, moved, None, winSize=(15, 15))
        alive &= (ok[:, 0] > 0) & (ok_back[:, 0] > 0)
        alive &= np.linalg.norm((back - points)[:, 0], axis=1) < 0.7
        tracks.append(np.where(alive[:, None], moved[:, 0], np.nan))
        poses.append(sequence.pose(index))
        before, points = now, moved
    return np.array(tracks), poses


def triangulated(sequence, first):
    """Pixels (n x 2) and depths (n) of corners of a picture."""
    tracks, poses = follow(sequence, first)
    f = sequence.K[0, 0]
    from_first = [np.linalg.inv(T) @ poses[0] for T in poses]
    ideal = [cv2.undistortPoints(np.nan_to_num(t)[:, None].astype(np.float64), sequence.K,
                                 sequence.distortion)[:, 0] for t in tracks]
    pixels, depths = [], []
    for i in range(tracks.shape[1]):
        seen = [k for k in range(len(poses)) if np.isfinite(tracks[k, i, 0])]
        if len(seen) < 4:
            continue
        rows = [r for k in seen for r in (ideal[k][i][0] * from_first[k][2] - from_first[k][0],
                                          ideal[k][i][1] * from_first[k][2] - from_first[k][1])]
        X = np.linalg.svd(np.array(rows))[2][3]
        X = X / X[3]
        seen_at = [from_first[k] @ X for k in seen]
        if min(s[2] for s in seen_at) < 0.1:
            continue
        error = [f * np.linalg.norm(s[:2] / s[2] - ideal[k][i]) for k, s in zip(seen, seen_at)]
        centres = [np.linalg.inv(from_first[k])[:3, 3] for k in seen]
        rays = [(X[:3] - c) / np.linalg.norm(X[:3] - c) for c in centres]
        parallax = np.degrees(np.arccos(np.clip(min(r @ rays[0] for r in rays), -1, 1)))
        if max(error) < MAX_REPROJECTION_PX and parallax > MIN_PARALLAX_DEG:
            pixels.append(tracks[0, i])
            depths.append(X[2])
    return np.array(pixels), np.array(depths)


def measured(sequence, first, size):
    """Depth pictures' pixels and depths, taken to the colour camera by the focal lengths only."""
    t = sequence.pictures[first][0]
    stamp, file = min(sequence.depths, key=lambda d: abs(d[0] - t))
    if abs(stamp - t) > 0.02:
        return np.zeros((0, 2)), np.zeros(0)
    d = sequence.calibration['depth']
    raw = cv2.imread(os.path.join(sequence.folder, file), cv2.IMREAD_UNCHANGED) / d['scale']
    v, u = np.nonzero(raw)
    x = (u - d['cx']) / d['fx'] * sequence.K[0, 0] + sequence.K[0, 2]
    y = (v - d['cy']) / d['fy'] * sequence.K[1, 1] + sequence.K[1, 2]
    inside = (x >= 0) & (y >= 0) & (x < size[0] - 0.5) & (y < size[1] - 0.5)
    return np.stack([x, y], 1)[inside], raw[v, u][inside]


def spread(values):
    return 1.4826 * np.median(np.abs(values - np.median(values)))


def scale_of(folder, network, every):
    """Median factor and spread of its logarithm, by what more pictures could be had from."""
    sequence = Sequence(folder)
    by_corner, by_sensor = [], []
    for first in range(5, len(sequence.pictures), every):
        if sequence.pose(first) is None:
            continue
        bgr = sequence.picture(first)
        predicted = network(bgr)
        for found, where in ((by_corner, triangulated(sequence, first)),
                             (by_sensor, measured(sequence, first, bgr.shape[1::-1])
                              if sequence.depths else (np.zeros((0, 2)), np.zeros(0)))):
            pixels, depths = where
            if len(depths) < MIN_POINTS:
                continue
            x, y = np.round(pixels).astype(int).T
            found.append(np.median(depths / predicted[y, x]))
    for name, found in (('triangulated', by_corner), ('measured depth', by_sensor)):
        if found:
            low, middle, high = np.percentile(found, [10, 50, 90])
            print('%-14s %-15s %3d pictures: factor %.3f (10..90 %%: %.3f .. %.3f), sigma of ln %.3f'
                  % (os.path.basename(folder.rstrip('/')), name, len(found), middle, low, high,
                     spread(np.log(found))))
    best = by_corner if len(by_corner) >= len(by_sensor) else by_sensor
    return np.median(best), spread(np.log(best))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    shared = os.path.join(HERE, '..', '..', 'shared')
    parser.add_argument('--card', default=os.path.join(HERE, '..', 'cards', 'meter_xxs_nyu.yaml'))
    parser.add_argument('--models', default=os.path.join(shared, 'models'))
    parser.add_argument('--data', default=os.path.join(shared, 'data', 'tum_fr1_xyz'))
    parser.add_argument('--check', default=os.path.join(shared, 'data', 'redkitchen'))
    parser.add_argument('--every', type=int, default=10, help='of how many pictures one is used')
    parser.add_argument('--floor', type=float, default=0.2,
                        help='least sigma of ln(scale) between scenes')
    options = parser.parse_args()
    cv2.setNumThreads(1)
    cv2.setRNGSeed(0)
    network = DepthNetwork(options.card, options.models)
    factor, within = scale_of(options.data, network, options.every)
    other, _ = scale_of(options.check, network, options.every)
    between = abs(np.log(other / factor)) / 2
    sigma = float(np.hypot(within, max(between, options.floor)))
    print('calibration: {factor: %.3f, sigma: %.3f}' % (factor, sigma))
    print('the other scene lies %.1f sigma away' % abs(np.log(other / factor) / sigma))


if __name__ == '__main__':
    main()
