"""volume.py - the volume that particles occupy: of the set where their summed volume, smoothed by the kernel, is above one half."""

import itertools

import numpy as np


def cubic_spline(r, h):
    """W(r) of method 1, zero from h on [1/m^3]"""
    q = r / h
    return 8 / (np.pi * h**3) * np.where(q < 0.5, 1 - 6 * q * q * (1 - q), 2 * np.clip(1 - q, 0, None) ** 3)


def mirrored(x, low, high, walls, periodic, h):
    """particles with their images: behind walls (names as in a scene) and through periodic sides (axes)"""
    for axis in range(3):
        images = [x]
        for side, face in ((0, low[axis]), (1, high[axis])):
            near = np.abs(x[:, axis] - face) < h
            if "xyz"[axis] in periodic:
                shift = (high[axis] - low[axis]) * (1 - 2 * side)
                images.append(x[near] + np.eye(3)[axis] * shift)
            elif "xyz"[axis] + ("min", "max")[side] in walls:
                image = x[near].copy()
                image[:, axis] = 2 * face - image[:, axis]
                images.append(image)
        x = np.concatenate(images)
    return x


def occupied(x, spacing, low, high, walls=(), periodic=()):
    """volume [m^3] in the box low, high where sum_j dx^3 W(x - x_j) > 1/2, support 2 dx, on cells of about dx/2; isolated drops fall below"""
    h = 2 * spacing
    low, high = np.array(low, float), np.array(high, float)
    low, high = low.copy(), np.minimum(high, np.maximum(x.max(axis=0) + h, low + spacing))
    for axis in range(3):
        if "xyz"[axis] in periodic:
            high[axis] = low[axis] + spacing * round((high[axis] - low[axis]) / spacing)
    n = np.maximum(1, np.round((high - low) / (0.5 * spacing)).astype(int))
    step = (high - low) / n
    points = mirrored(x, low, high, walls, periodic, h)
    cell = np.floor((points - low) / step).astype(int)
    total = np.zeros(n.prod())
    reach = [range(-int(np.ceil(h / s)), int(np.ceil(h / s)) + 1) for s in step]
    for offset in itertools.product(*reach):
        at = cell + offset
        inside = np.all((at >= 0) & (at < n), axis=1)
        at = at[inside]
        r = np.linalg.norm(low + (at + 0.5) * step - points[inside], axis=1)
        near = r < h
        total += np.bincount(np.ravel_multi_index(at[near].T, n), weights=spacing**3 * cubic_spline(r[near], h), minlength=total.size)
    return float(np.sum(total > 0.5) * step.prod())
