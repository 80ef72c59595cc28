"""How well the boxes of one object agree with one ellipsoid that stands still, over all frames with
known poses: what remains are errors that change with the view, and what is no ellipsoid about the
object. So this bounds errors of boxes from above, where the difference of two networks bounds them
from below."""
import numpy as np
from scipy import optimize
from scipy.spatial.transform import Rotation

from .detector_fit import CX, CY, F, THRESHOLD, cut, logit
from .statistics import lasting_and_flicker, robust_sigma


def boxes_of(p, T_cw):
    """Boxes of an ellipsoid (centre, log axes, rotation vector) in cameras n x 4 x 4: n x 4."""
    Q = np.zeros((4, 4))
    R = Rotation.from_rotvec(p[6:]).as_matrix()
    Q[:3, :3] = R @ np.diag(np.exp(2 * p[3:6])) @ R.T - np.outer(p[:3], p[:3])
    Q[:3, 3] = Q[3, :3] = -p[:3]
    Q[3, 3] = -1
    P = np.array([[F, 0, CX], [0, F, CY], [0, 0, 1]]) @ T_cw[:, :3]
    C = P @ Q @ P.transpose(0, 2, 1)
    def ends(i):
        root = np.sqrt(np.maximum(C[:, i, 2] ** 2 - C[:, i, i] * C[:, 2, 2], 0))
        a, b = (C[:, i, 2] - root) / C[:, 2, 2], (C[:, i, 2] + root) / C[:, 2, 2]
        return np.minimum(a, b), np.maximum(a, b)
    (x0, x1), (y0, y1) = ends(0), ends(1)
    return np.stack([x0, y0, x1, y1], 1)


def fit(objects, tracks, T_wc):
    """T_wc: by frame, the colour camera's, or None."""
    series, values, names, sure, wrong_by = [], [], [], [], []
    for thing, track in zip(objects, tracks):
        use = [i for i, e in enumerate(track) if e and e[1] is not None and e[1][5] >= THRESHOLD
               and T_wc[i] is not None and not cut(e[1][:4]).any()]
        if len(use) < 30:
            continue
        T_cw = np.linalg.inv(np.array([T_wc[i] for i in use]))
        seen = np.array([track[i][1][:4] for i in use])
        extent = np.stack([seen[:, 2] - seen[:, 0], seen[:, 3] - seen[:, 1]] * 2, 1)
        def wrong(p):
            shape = p[3:6] - p[3:6].mean()  # the design's weak prior
            return np.concatenate([((boxes_of(p, T_cw) - seen) / extent / 0.05).ravel(), shape / 0.4])
        start = np.concatenate([thing['point'], np.log([thing['metres'] / 2] * 3), [0, 0, 0]])
        found = optimize.least_squares(wrong, start, loss='cauchy', max_nfev=200)
        r = (boxes_of(found.x, T_cw) - seen) / extent
        values.append(r.ravel())
        z = logit(np.array([min(0.99, track[i][1][5]) for i in use]))
        sure.append(z - z.mean())
        rms = np.log(np.maximum(np.sqrt((np.clip(r, -0.3, 0.3) ** 2).mean(1)), 1e-3))
        wrong_by.append(rms - rms.mean())
        names.append((thing['family'], float(robust_sigma(r)), len(use)))
        for j in range(4):
            s = np.full(len(track), np.nan)
            s[use] = np.where(np.abs(r[:, j]) < 6 * robust_sigma(r), r[:, j], np.nan)
            series.append(s)
    lasting, seconds, flicker = lasting_and_flicker(series, lags=tuple(range(0, 61, 2)))
    return {'lasting': lasting, 'seconds': seconds, 'flicker': flicker,
            'per_score (within an object)': -np.polyfit(np.concatenate(sure), np.concatenate(wrong_by), 1)[0],
            'total': robust_sigma(np.concatenate(values)),
            'objects': ['%s %.3f (%d)' % n for n in names]}
