"""Closed triangle surfaces made in place, written as OFF, with their exact volume."""
import numpy as np


def icosphere(radius, center=(0, 0, 0), levels=4):
    t = (1 + 5**0.5) / 2
    v = [(-1, t, 0), (1, t, 0), (-1, -t, 0), (1, -t, 0), (0, -1, t), (0, 1, t), (0, -1, -t), (0, 1, -t), (t, 0, -1), (t, 0, 1), (-t, 0, -1), (-t, 0, 1)]
    f = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6), (7, 1, 8),
         (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    v = [np.array(p) / np.linalg.norm(p) for p in v]
    for _ in range(levels):
        middle, finer = {}, []

        def half(a, b):
            key = (min(a, b), max(a, b))
            if key not in middle:
                p = v[a] + v[b]
                v.append(p / np.linalg.norm(p))
                middle[key] = len(v) - 1
            return middle[key]

        for a, b, c in f:
            ab, bc, ca = half(a, b), half(b, c), half(c, a)
            finer += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        f = finer
    return np.array(v) * radius + np.array(center), np.array(f)


def box(low, high, n=1):
    """box with n x n squares of two triangles on each side"""
    points, faces, index = [], [], {}

    def node(p):
        key = tuple(np.round(p, 12))
        if key not in index:
            index[key] = len(points)
            points.append(key)
        return index[key]

    low, high = np.array(low, float), np.array(high, float)
    for axis in range(3):
        b, c = (axis + 1) % 3, (axis + 2) % 3
        for side in (0, 1):
            for i in range(n):
                for j in range(n):
                    q = []
                    for s, t in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)):
                        p = np.zeros(3)
                        p[axis], p[b], p[c] = side, s / n, t / n
                        q.append(node(low + p * (high - low)))
                    q = q if side else q[::-1]
                    faces += [(q[0], q[1], q[2]), (q[0], q[2], q[3])]
    return np.array(points), np.array(faces)


def volume(x, triangles):
    a, b, c = (x[triangles[:, k]] for k in range(3))
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6)


def write_off(path, x, triangles):
    with open(path, "w") as f:
        f.write(f"OFF\n{len(x)} {len(triangles)} 0\n")
        f.writelines(f"{p[0]:.17g} {p[1]:.17g} {p[2]:.17g}\n" for p in x)
        f.writelines(f"3 {t[0]} {t[1]} {t[2]}\n" for t in triangles)
