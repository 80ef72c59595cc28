"""Small fits that both halves of fit_perception_noise.py need."""
import numpy as np
from scipy import optimize, stats

TICK = 1 / 30  # seconds between frames


def robust_sigma(values):
    """Standard deviation by the median absolute deviation."""
    values = np.asarray(values)
    return 1.4826 * np.median(np.abs(values - np.median(values)))


def autocovariance(series, lags):
    """Of many series with gaps (NaN), each a list over frames, around zero; one value a lag."""
    result = []
    for lag in lags:
        products = [s[lag:] * s[:len(s) - lag] for s in series if len(s) > lag]
        values = np.concatenate(products) if products else np.array([])
        values = values[np.isfinite(values)]
        result.append(values.mean() if len(values) > 20 else np.nan)
    return np.array(result)


def lasting_and_flicker(series, lags=tuple(range(0, 31)), tick=TICK):
    """Splits a series into an autoregressive part of variance L² and correlation exp(-t/T) and a
    white part of variance W²: autocovariance L² exp(-t/T) + W² [t = 0]. Gives L, T, W."""
    c = autocovariance(series, lags)
    t = np.array(lags) * tick
    use = np.isfinite(c) & (t > 0)

    def wrong(p):
        return np.exp(2 * p[0]) * np.exp(-t[use] / np.exp(p[1])) - c[use]

    start = [0.5 * np.log(max(c[1], 1e-6)), np.log(0.5)]
    fit = optimize.least_squares(wrong, start, bounds=([-12, np.log(TICK)], [5, np.log(20.0)]))
    lasting, seconds = np.exp(fit.x[0]), np.exp(fit.x[1])
    return lasting, seconds, np.sqrt(max(0.0, c[0] - lasting ** 2))


def mixture(values, rounds=200):
    """Zero-mean Gaussians of two widths, by expectation maximisation: the narrow one's sigma, the
    share of the wide one, how much wider it is."""
    x2 = np.asarray(values) ** 2
    narrow, wide, share = np.median(x2) / 0.455, 9 * np.median(x2) / 0.455, 0.1
    for _ in range(rounds):
        a = (1 - share) * np.exp(-x2 / 2 / narrow) / np.sqrt(narrow)
        b = share * np.exp(-x2 / 2 / wide) / np.sqrt(wide)
        w = b / np.maximum(a + b, 1e-300)
        share, narrow, wide = w.mean(), ((1 - w) * x2).sum() / (1 - w).sum(), (w * x2).sum() / w.sum()
    return np.sqrt(narrow), share, np.sqrt(wide / narrow)


def seconds_of_a_switch(states, tick=TICK):
    """A state that is on where a hidden autoregressive normal number lies below a quantile: the
    share of on, and the correlation time for which on is followed by on as often as it is.
    `states`: lists of 0, 1 or NaN over frames."""
    values = np.concatenate(states)
    share = np.nanmean(values)
    follow = np.concatenate([s[1:][s[:-1] == 1] for s in states])
    stay = np.nanmean(follow) if np.isfinite(follow).any() else share
    if not share < stay < 1:
        return share, 0.0, stay
    q = stats.norm.ppf(share)

    def gap(rho):
        both = stats.multivariate_normal.cdf([q, q], cov=[[1, rho], [rho, 1]])
        return both / share - stay

    rho = optimize.brentq(gap, 0, 0.9999) if gap(0.9999) > 0 else 0.9999
    return share, -tick / np.log(max(rho, 1e-6)), stay


def correlation_length(fields, valid, furthest):
    """Distance in cells, along rows, at which the autocorrelation of the fields falls to 1/e."""
    total = np.mean([(f[v] ** 2).mean() for f, v in zip(fields, valid) if v.any()])
    before = 1.0
    for lag in range(1, furthest):
        products = [(f[:, lag:] * f[:, :-lag])[v[:, lag:] & v[:, :-lag]] for f, v in zip(fields, valid)]
        now = np.concatenate(products).mean() / total
        if now < np.exp(-1):
            return lag - 1 + (before - np.exp(-1)) / (before - now)
        before = now
    return float(furthest)
