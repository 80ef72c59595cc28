"""METER's depth, the normals and planes that follow from it, and the borders of MOSAIC's regions,
against measured depth. All on METER's grid: 48 x 64 cells of 10 pixels."""
import cv2
import numpy as np
from scipy import optimize, special

from .statistics import TICK, correlation_length, lasting_and_flicker, robust_sigma

ROWS, COLUMNS, CELL, F, CX, CY = 48, 64, 10, 52.5, 31.55, 23.55  # intrinsics in cells
SURFACES = ('wall', 'floor', 'ceiling', 'cabinet', 'table', 'door', 'shelf')


def on_grid(measured):
    """Measured depth at the cells of the colour picture; 0 where there is none. The two cameras are
    not registered: only the focal lengths are taken into account."""
    u = (np.arange(COLUMNS) * CELL + 4.5 - 320) * 146.25 / 525 + 80
    v = (np.arange(ROWS) * CELL + 4.5 - 240) * 146.25 / 525 + 60
    patches = np.stack([measured[np.clip(np.round(v + dy), 0, 119).astype(int)[:, None],
                                 np.clip(np.round(u + dx), 0, 159).astype(int)[None]]
                        for dy in (-1, 0, 1) for dx in (-1, 0, 1)])
    patches[patches <= 0] = np.nan
    enough = np.isfinite(patches).sum(0) >= 5
    middle = np.nanmedian(np.where(enough, patches, 0), 0)
    return np.where(enough & (middle > 0.4) & (middle < 5), middle, 0)


def blurred(depth, sigma):
    if sigma == 0:
        return depth
    weight = cv2.GaussianBlur((depth > 0).astype(float), (0, 0), sigma)
    return np.where(depth > 0, cv2.GaussianBlur(depth, (0, 0), sigma) / np.maximum(weight, 1e-6), 0)


def points(depth):
    v, u = np.mgrid[0:ROWS, 0:COLUMNS]
    return np.stack([(u - CX) / F * depth, (v - CY) / F * depth, depth], 2)


def normals(depth, valid, step=2):
    """Towards the camera, by central differences; and where they are good."""
    p = points(depth)
    du, dv = p[step:-step, 2 * step:] - p[step:-step, :-2 * step], p[2 * step:, step:-step] - p[:-2 * step, step:-step]
    n = np.cross(dv, du)
    n /= np.maximum(np.linalg.norm(n, axis=2, keepdims=True), 1e-9)
    z = depth[step:-step, step:-step]
    good = cv2.erode(valid.astype(np.uint8), np.ones((2 * step + 1,) * 2))[step:-step, step:-step] > 0
    jump = np.maximum(np.abs(du[..., 2]), np.abs(dv[..., 2])) < 0.15 * np.maximum(z, 0.1)
    return n, good & jump


def tilts(n, reference):
    """Components of n across the reference, radians."""
    u = np.cross(reference, [1.0, 0, 0])
    u /= np.maximum(np.linalg.norm(u, axis=2, keepdims=True), 1e-9)
    v = np.cross(reference, u)
    along = np.clip((n * reference).sum(2), -1, 1)
    across = np.stack([(n * u).sum(2), (n * v).sum(2)], 2)
    length = np.maximum(np.linalg.norm(across, axis=2), 1e-9)
    return across / length[..., None] * np.arccos(along)[..., None]


def correlation_over_time(fields, valid, lags):
    """Of fields that are two frames apart, at fixed pixels; pairs of seconds and correlation."""
    result = []
    for k in lags:
        both = [v & w for v, w in zip(valid, valid[k:])]
        a = np.concatenate([f[v] for f, v in zip(fields, both)])
        b = np.concatenate([f[v] for f, v in zip(fields[k:], both)])
        result.append((k * 2 * TICK, float((a * b).mean() / np.sqrt((a * a).mean() * (b * b).mean()))))
    return result


def fit_edges(pairs, reach=10):
    """Mean profile of ln depth across steps of the measured depth along rows, as a share of the
    step: an error function of some width and height, for the network and for the measurement (whose
    own width is that of the grid)."""
    def profile(which):
        values = []
        for p, m in pairs:
            ln = np.log(np.where(m > 0, m, 1))
            for y in range(ROWS):
                for x in range(reach, COLUMNS - reach):
                    if not (m[y, x - reach:x + reach + 1] > 0).all():
                        continue
                    step = ln[y, x + 2] - ln[y, x - 2]
                    flat = np.ptp(ln[y, x - reach:x - 1]) + np.ptp(ln[y, x + 2:x + reach + 1])
                    sharp = abs(ln[y, x + 1] - ln[y, x - 1])
                    if abs(step) > 0.25 and flat < 0.5 * abs(step) and sharp > 0.7 * abs(step):
                        line = np.log(which(p, m)[y, x - reach:x + reach + 1])
                        values.append((line - line.mean()) / step)
        return np.mean(values, 0), len(values)

    o = np.arange(-reach, reach + 1)
    def fitted(line):
        f = optimize.least_squares(lambda q: q[0] / 2 * special.erf((o - q[1]) / np.sqrt(2) / q[2]) + q[3] - line,
                                   [1, 0, 2, 0], bounds=([0, -5, 0.2, -1], [3, 5, 20, 1]))
        return f.x
    line, count = profile(lambda p, m: p)
    network, own = fitted(line), fitted(profile(lambda p, m: m)[0])
    return {'steps': count, 'height of the network': network[0], 'width in cells': network[2],
            'height, measured': own[0], 'width in cells, measured': own[2],
            'blur': np.sqrt(max(0, network[2] ** 2 - own[2] ** 2)) * CELL / 640}


def fit_depth(pairs, sigma):
    scale = np.array([np.median(np.log(p[m > 0] / m[m > 0])) for p, m in pairs])
    spread = robust_sigma(scale)
    series = [scale - scale.mean()]
    lasting, seconds, flicker = lasting_and_flicker(series, lags=tuple(range(0, 61)), tick=2 * TICK)
    best = (np.inf,)
    for smear in (2, 4, 6, 8, 12, 16):
        wide = [np.log(np.maximum(blurred(m, smear), 0.1)) for _, m in pairs]
        for sharp in np.arange(0, 1.01, 0.1):
            fields, valid = [], []
            for (p, m), s, w in zip(pairs, scale, wide):
                said = sharp * np.log(np.maximum(blurred(m, sigma), 0.1)) + (1 - sharp) * w
                fields.append(np.where(m > 0, np.log(p) - said, 0)), valid.append(m > 0)
                fields[-1][m > 0] -= np.median(fields[-1][m > 0])
            wrong = np.median([f[v].std() for f, v in zip(fields, valid)])
            best = min(best, (wrong, smear, sharp, fields, valid), key=lambda b: b[0])
    wrong, smear, sharp, fields, valid = best
    every = np.concatenate([f[v] for f, v in zip(fields, valid)])
    return {'scale': np.exp(np.median(scale)), 'scale_spread (robust)': spread, 'scale_spread': scale.std(),
            'scale_seconds': seconds, 'white part of it': flicker,
            'sharp': sharp, 'smear': smear * CELL / 640, 'median std then': wrong,
            'local (std)': every.std(), 'local (robust)': robust_sigma(every),
            'local_length': correlation_length(fields, valid, 32) * CELL / 640,
            'local, correlation by seconds': correlation_over_time(fields, valid, (1, 3, 7, 15, 30, 60))}


def fit_normals(pairs):
    fields, valid, angles, series = [], [], [], []
    for p, m in pairs:
        a, ok = normals(p, p > 0)
        b, good = normals(blurred(m, 1), m > 0)
        t = np.nan_to_num(tilts(a, b))
        good = good & ok
        angles.append(np.degrees(np.linalg.norm(t, axis=2)[good]))
        fields += [t[..., 0], t[..., 1]]
        valid += [good, good]
    every = np.concatenate([f[v] for f, v in zip(fields, valid)])
    angles = np.concatenate(angles)
    return {'angle_deg (robust, an axis)': np.degrees(robust_sigma(every)), 'angle_deg (std, an axis)': np.degrees(every.std()),
            'median angle in all': np.median(angles), 'under 11.25 degrees': np.mean(angles < 11.25),
            'under 30 degrees': np.mean(angles < 30),
            'length': correlation_length(fields, valid, 32) * CELL / 640,
            'correlation by seconds': correlation_over_time(fields[::2], valid[::2], (1, 3, 7, 15, 30))}


def plane_through(x, tolerance, rng, rounds=100):
    """RANSAC, then least squares: n, d (n x + d = 0), share of inliers."""
    best = None
    for _ in range(rounds):
        a, b, c = x[rng.choice(len(x), 3, replace=False)]
        n = np.cross(b - a, c - a)
        if np.linalg.norm(n) < 1e-9:
            continue
        n /= np.linalg.norm(n)
        inside = np.abs((x - a) @ n) < tolerance * x[:, 2]
        if best is None or inside.sum() > best.sum():
            best = inside
    mean = x[best].mean(0)
    n = np.linalg.svd(x[best] - mean, full_matrices=False)[2][2]
    n = n if n @ mean < 0 else -n
    return n, -n @ mean, best.mean()


def fit_planes(frames, measured, names):
    rng = np.random.default_rng(0)
    angles, offsets, bad, regions = [], [], 0, 0
    for i in range(0, len(frames)):
        if 'labels' not in frames[i] or 'depth' not in frames[i]:
            continue
        labels = cv2.resize(frames[i]['labels'], (COLUMNS, ROWS), interpolation=cv2.INTER_NEAREST)
        p, m = frames[i]['depth'], on_grid(measured[i])
        p = p / np.exp(np.median(np.log(p[m > 0] / m[m > 0])))
        for k in [names.index(s) for s in SURFACES if s in names]:
            count, parts, stats, _ = cv2.connectedComponentsWithStats((labels == k).astype(np.uint8))
            for j in range(1, count):
                mask = (parts == j) & (m > 0)
                if mask.sum() < 0.05 * ROWS * COLUMNS:
                    continue
                n, d, share = plane_through(points(m)[mask], 0.02, rng)
                if share < 0.7:
                    continue  # the region is no plane
                regions += 1
                near = np.abs(points(m)[mask] @ n + d) < 0.02 * m[mask]
                x = points(p)[mask][near]
                got, e, _ = plane_through(x, 0.04, rng)
                middle = points(m)[mask][near].mean(0)
                angle = np.degrees(np.arccos(np.clip(got @ n, -1, 1)))
                # Along the viewing ray, where both planes meet it.
                ratio = (-e / (got @ middle)) if abs(got @ middle) > 1e-6 else np.nan
                bad += not (angle < 30 and 0.5 < ratio < 2)
                if angle < 30 and 0.5 < ratio < 2:
                    t = tilts(got[None, None], n[None, None])[0, 0]
                    angles += [np.degrees(t[0]), np.degrees(t[1])]
                    offsets.append(np.log(ratio))
    return {'angle_deg (robust, an axis)': 1.4826 * np.median(np.abs(angles)), 'offset': 1.4826 * np.median(np.abs(offsets)),
            'rms angle, an axis': np.sqrt(np.mean(np.square(angles))), 'rms offset': np.sqrt(np.mean(np.square(offsets))),
            'unusable (over 30 degrees or a factor 2)': bad / regions, 'regions': regions}


def fit_masks(frames):
    """Borders of regions in one frame and, moved by dense optical flow, in the next one."""
    flow_of = cv2.DISOpticalFlow_create(cv2.DISOPTICAL_FLOW_PRESET_MEDIUM)
    moved_by, changed, relative = [], [], []
    for a, b in zip(frames, frames[1:]):
        if 'labels' not in a or 'labels' not in b:
            continue
        flow = flow_of.calc(b['grey'], a['grey'], None)  # where b's pixels were in a
        y, x = np.mgrid[0:480, 0:640].astype(np.float32)
        before = cv2.remap(a['labels'], x + flow[..., 0], y + flow[..., 1], cv2.INTER_NEAREST, borderMode=cv2.BORDER_REPLICATE)
        changed.append(np.mean(before[20:-20, 20:-20] != b['labels'][20:-20, 20:-20]))
        for k in np.unique(before):
            p, q = (before == k).astype(np.uint8), (b['labels'] == k).astype(np.uint8)
            if min(p.sum(), q.sum()) < 3000 or (p & q).sum() < 0.7 * (p | q).sum():
                continue  # a region that changed its label is no ragged border
            signed = cv2.distanceTransform(p, cv2.DIST_L2, 5) - cv2.distanceTransform(1 - p, cv2.DIST_L2, 5)
            border = (q ^ cv2.erode(q, np.ones((3, 3)))).astype(bool)
            border[:20], border[-20:], border[:, :20], border[:, -20:] = 0, 0, 0, 0
            moved = signed[border]
            moved_by.append(moved)
            relative.append(moved / np.sqrt(p.sum()))
    every = np.concatenate(moved_by)
    # Of both frames' errors: one has the share 1/√2.
    return {'px (robust)': robust_sigma(every) / np.sqrt(2), 'px (std)': every.std() / np.sqrt(2),
            'ragged (robust)': robust_sigma(np.concatenate(relative)) / np.sqrt(2),
            'ragged (std)': np.concatenate(relative).std() / np.sqrt(2),
            'pixels that change label in a frame': np.mean(changed), 'regions': len(moved_by)}


def fit(frames, measured, surfaces):
    pairs = [(f['depth'], on_grid(measured[i])) for i, f in enumerate(frames) if 'depth' in f]
    pairs = [(p, m) for p, m in pairs if (m > 0).sum() > 500]
    edges = fit_edges(pairs)
    return [('METER: depth across steps', edges),
            ('METER: depth', fit_depth(pairs, edges['blur'] * 640 / CELL)), ('METER: normals from its depth', fit_normals(pairs)),
            ('METER + MOSAIC: planes', fit_planes(frames, measured, surfaces)),
            ('MOSAIC: borders', fit_masks(frames))]
