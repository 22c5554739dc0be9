"""render.py - pictures without a display: spheres and triangles through one depth buffer, in numpy alone.

A scene has two layers, water and everything else, so that a body under water shows through it. Each layer keeps depth, normal
and colour per pixel; light, shadow and the darkening of hollows are put on afterwards. Lengths are those of the scene, x to the right,
y up and z towards the eye in the camera's frame, depths positive into the picture.
"""

import numpy as np

SAMPLES = 2  # pixels of the buffers to one of the picture, each way
LIGHT = np.array([-0.32, 0.72, 0.62], dtype=np.float32) / np.float32(np.sqrt(1.0052))  # from above the viewer's left shoulder
FILL = np.array([0.75, 0.1, 0.65], dtype=np.float32) / np.float32(np.sqrt(0.995))  # weak, from the right, without shadow
WATER_OVER_BODY = 0.55  # how much of the water is seen where a body is behind it


class Camera:
    """Perspective view of a box along `direction` (from the eye into the scene), `up` upwards in the picture."""

    def __init__(self, corners, direction, up, width, height, margin=1.04, angle=13.0):
        self.width, self.height = width * SAMPLES, height * SAMPLES
        forward = np.asarray(direction, float) / np.linalg.norm(direction)
        right = np.cross(forward, up)
        right /= np.linalg.norm(right)
        self.axes = np.array([right, np.cross(right, forward), -forward])
        tangent = np.tan(np.radians(angle) / 2)

        # two passes: the distance at which the corners fill the picture, then the point looked at in their middle
        target, distance = corners.mean(axis=0), 1.0
        for _ in range(8):
            view = (corners - target) @ self.axes.T
            aspect = self.width / self.height
            distance = np.max(np.maximum(np.abs(view[:, 0]) / aspect, np.abs(view[:, 1])) * margin / tangent + view[:, 2])
            scaled = view[:, :2] / (distance - view[:, 2])[:, None]
            middle = 0.5 * (scaled.max(axis=0) + scaled.min(axis=0)) * distance
            target = target + middle @ self.axes[:2]
        self.eye = target - forward * distance
        self.scale = 0.5 * self.height / tangent  # pixels of a length at distance 1

    def view(self, points):
        return (np.asarray(points, float) - self.eye) @ self.axes.T

    def project(self, view):
        """pixel coordinates and depth"""
        depth = np.maximum(-view[:, 2], 1e-9)
        return 0.5 * self.width + self.scale * view[:, 0] / depth, 0.5 * self.height - self.scale * view[:, 1] / depth, depth


class Layer:
    """Depth, normal (camera frame) and colour of what is nearest in each pixel."""

    def __init__(self, camera):
        n = camera.width * camera.height
        self.camera = camera
        self.depth = np.full(n, np.inf, dtype=np.float32)
        self.normal = np.zeros((n, 3), dtype=np.float32)
        self.colour = np.zeros((n, 3), dtype=np.float32)
        self.gloss = np.zeros(n, dtype=np.float32)  # 0: matte, as walls are
        self.line = np.full(n, np.inf, dtype=np.float32)  # depth of lines, which cast and take no light

    def spheres(self, points, radius, colours, gloss=0.25):
        """draw a sphere at every point: one pass over the particles for each pixel offset of the largest disc"""
        camera = self.camera
        view = camera.view(points)
        x, y, depth = camera.project(view)
        order = np.argsort(-depth, kind="stable")  # of two on one pixel the nearer is drawn last
        x, y, depth = x[order], y[order], depth[order]
        r = camera.scale * radius / depth
        inside = (depth > 2 * radius) & (x > -r) & (x < camera.width + r) & (y > -r) & (y < camera.height + r)
        order, x, y, depth, r = (a[inside] for a in (order, x, y, depth, r))
        if not len(x):
            return
        owner = np.full(camera.width * camera.height, -1, dtype=np.int32)
        reach = int(np.ceil(r.max())) + 1
        px, py = np.floor(x).astype(np.int32), np.floor(y).astype(np.int32)
        for dy in range(-reach, reach + 1):
            for dx in range(-reach, reach + 1):
                if np.hypot(max(abs(dx) - 1, 0), max(abs(dy) - 1, 0)) > r.max():
                    continue
                u, v = (px + dx + 0.5 - x) / r, (py + dy + 0.5 - y) / r
                rest = 1 - u * u - v * v
                hit = (rest > 0) & (px + dx >= 0) & (px + dx < camera.width) & (py + dy >= 0) & (py + dy < camera.height)
                k = np.flatnonzero(hit)
                pixel = (py[k] + dy) * camera.width + px[k] + dx
                z = (depth[k] - radius * np.sqrt(rest[k])).astype(np.float32)
                near = z < self.depth[pixel]
                self.depth[pixel[near]] = z[near]
                owner[pixel[near]] = k[near]
        drawn = np.flatnonzero(owner >= 0)
        k = owner[drawn]
        u = (drawn % camera.width + 0.5 - x[k]) / r[k]
        v = (drawn // camera.width + 0.5 - y[k]) / r[k]
        self.normal[drawn] = np.stack([u, -v, np.sqrt(np.maximum(1 - u * u - v * v, 0))], axis=1)
        self.colour[drawn] = np.asarray(colours, np.float32)[order[k]]
        self.gloss[drawn] = gloss

    def triangles(self, points, triangles, colours, normals=None, gloss=0.15, edges=0.0):
        """draw triangles; `colours` by point, `normals` by corner (n x 3 x 3, scene frame) or flat, `edges` darkens their borders"""
        camera = self.camera
        view = camera.view(points)
        x, y, depth = camera.project(view)
        corners = view[triangles]
        flat = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        flat /= np.maximum(np.linalg.norm(flat, axis=1, keepdims=True), 1e-30)
        normals = np.repeat(flat[:, None, :], 3, axis=1) if normals is None else normals @ camera.axes.T
        colours = np.asarray(colours, float)[triangles]
        tx, ty, tz = x[triangles], y[triangles], depth[triangles]
        low = np.maximum(np.floor(np.stack([tx.min(axis=1), ty.min(axis=1)], axis=1)), 0).astype(int)
        high = np.minimum(np.ceil(np.stack([tx.max(axis=1), ty.max(axis=1)], axis=1)), [camera.width, camera.height]).astype(int)
        area = (tx[:, 1] - tx[:, 0]) * (ty[:, 2] - ty[:, 0]) - (tx[:, 2] - tx[:, 0]) * (ty[:, 1] - ty[:, 0])
        for t in np.flatnonzero((np.abs(area) > 1e-9) & np.all(high > low, axis=1) & np.all(-corners[:, :, 2] > 1e-6, axis=1)):
            gx = np.arange(low[t, 0], high[t, 0]) + 0.5
            gy = (np.arange(low[t, 1], high[t, 1]) + 0.5)[:, None]
            b1 = ((gx - tx[t, 0]) * (ty[t, 2] - ty[t, 0]) - (tx[t, 2] - tx[t, 0]) * (gy - ty[t, 0])) / area[t]
            b2 = ((tx[t, 1] - tx[t, 0]) * (gy - ty[t, 0]) - (gx - tx[t, 0]) * (ty[t, 1] - ty[t, 0])) / area[t]
            b0 = 1 - b1 - b2
            row, column = np.nonzero((b0 >= 0) & (b1 >= 0) & (b2 >= 0))
            if not len(row):
                continue
            # linear in the plane of the picture is linear in 1/depth in the scene
            weight = np.stack([b0[row, column], b1[row, column], b2[row, column]], axis=1)
            border = weight.min(axis=1)
            weight = weight / tz[t]
            z = 1 / weight.sum(axis=1)
            weight *= z[:, None]
            pixel = (row + low[t, 1]) * camera.width + column + low[t, 0]
            near = z < self.depth[pixel]
            pixel, weight = pixel[near], weight[near]
            normal = weight @ normals[t]
            normal *= np.where(normal[:, 2:] < 0, -1, 1) / np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-9)
            shade = np.ones(len(pixel))
            if edges:
                longest = np.max(np.hypot(tx[t] - np.roll(tx[t], 1), ty[t] - np.roll(ty[t], 1)))
                width = 1.2 * longest / max(abs(area[t]), 1e-9)  # a border of about a pixel
                shade -= edges * np.clip(1.5 - border[near] / width, 0, 1)
            self.depth[pixel] = z[near]
            self.normal[pixel] = normal
            self.colour[pixel] = (weight @ colours[t]) * shade[:, None]
            self.gloss[pixel] = gloss

    def lines(self, segments, width=1.6):
        """draw line segments (n x 2 x 3)"""
        camera = self.camera
        half = max(width * SAMPLES / 2, 0.5)
        for segment in segments:
            x, y, depth = camera.project(camera.view(segment))
            s = np.linspace(0, 1, int(np.hypot(x[1] - x[0], y[1] - y[0]) * 1.5) + 2)
            z = (0.998 / ((1 - s) / depth[0] + s / depth[1])).astype(np.float32)
            for ox in np.arange(-half + 0.5, half, 1.0):
                for oy in np.arange(-half + 0.5, half, 1.0):
                    px = np.floor(x[0] + s * (x[1] - x[0]) + ox).astype(int)
                    py = np.floor(y[0] + s * (y[1] - y[0]) + oy).astype(int)
                    ok = (px >= 0) & (px < camera.width) & (py >= 0) & (py < camera.height)
                    np.minimum.at(self.line, py[ok] * camera.width + px[ok], z[ok])


def corner_normals(points, triangles, crease=50.0):
    """normals by corner: mean of the faces around the point that are within `crease` degrees of the triangle's own"""
    edge = points[triangles]
    face = np.cross(edge[:, 1] - edge[:, 0], edge[:, 2] - edge[:, 0])
    unit = face / np.maximum(np.linalg.norm(face, axis=1, keepdims=True), 1e-30)
    flat = triangles.ravel()
    order = np.argsort(flat, kind="stable")
    first = np.searchsorted(flat[order], np.arange(len(points)))
    count = np.bincount(flat, minlength=len(points))
    limit = np.cos(np.radians(crease))
    normals = np.zeros((len(flat), 3))
    owner = np.arange(len(flat)) // 3
    for slot in range(count.max() if len(count) else 0):
        other = first[flat] + slot
        ok = slot < count[flat]
        neighbour = order[np.where(ok, other, 0)] // 3
        alike = ok & (np.einsum("ij,ij->i", unit[neighbour], unit[owner]) > limit)
        normals[alike] += face[neighbour[alike]]
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
    return normals.reshape(-1, 3, 3)


def blur(image, radius):
    """mean over a square, twice: a bell-like blur in a time that does not depend on its width"""
    width = 2 * radius + 1
    for axis in (0, 1, 0, 1):
        edges = [(radius + 1, radius) if a == axis else (0, 0) for a in (0, 1)]
        sums = np.cumsum(np.pad(image, edges, mode="edge"), axis=axis, dtype=np.float64)
        high, low = (sums[width:], sums[:-width]) if axis == 0 else (sums[:, width:], sums[:, :-width])
        image = ((high - low) / width).astype(np.float32)
    return image


class Shadow:
    """What the light sees, from straight along `direction` (scene frame), as a depth map."""

    def __init__(self, corners, direction, up, size=700):
        forward = -np.asarray(direction, float)
        right = np.cross(forward, up)
        right /= np.linalg.norm(right)
        self.axes = np.array([right, np.cross(right, forward), forward])
        seen = corners @ self.axes.T
        self.low, high = seen.min(axis=0), seen.max(axis=0)
        self.size, self.step = size, float(np.max(high[:2] - self.low[:2])) * 1.02 / size
        self.depth = np.full((size + 2) ** 2, np.inf, dtype=np.float32)

    def _cells(self, points):
        seen = np.asarray(points, np.float32) @ self.axes.T.astype(np.float32)
        index = np.clip((seen[:, :2] - self.low[:2].astype(np.float32)) * np.float32(1 / self.step), -1, self.size).astype(np.int32) + 1
        return index, seen[:, 2]

    def add(self, points, radius):
        index, depth = self._cells(points)
        reach = max(int(np.ceil(radius / self.step)), 1)
        for dy in range(-reach, reach + 1):
            for dx in range(-reach, reach + 1):
                if dx * dx + dy * dy <= reach * reach:
                    cell = np.clip(index + [dx, dy], 0, self.size + 1)
                    np.minimum.at(self.depth, cell[:, 1] * (self.size + 2) + cell[:, 0], depth)

    def lit(self, points, bias):
        """share of light at each point, softened over the cells around"""
        index, depth = self._cells(points)
        total = np.zeros(len(points), dtype=np.float32)
        for dy in (-2, 0, 2):
            row = np.clip(index[:, 1] + dy, 0, self.size + 1) * (self.size + 2)
            for dx in (-2, 0, 2):
                total += self.depth[row + np.clip(index[:, 0] + dx, 0, self.size + 1)] > depth - np.float32(bias)
        return total / 9


def hollows(layer, drawn, size):
    """how much a pixel lies deeper than what is around it, 0 to 1"""
    camera = layer.camera
    deepest = layer.depth[drawn].max() if drawn.any() else 0
    depth = np.where(drawn, layer.depth, deepest).reshape(camera.height, camera.width)
    total = np.zeros_like(depth)
    for radius in (camera.height // 160, camera.height // 45):
        total += 0.5 * np.clip((depth - blur(depth, max(radius, 1))) / np.float32(0.02 * size), 0, 1)
    return total.ravel()


def shade(layer, size, shadow, bias):
    """lit colours of a layer, and whether a pixel is drawn; `size` is the length of the scene. In pieces that fit the cache."""
    camera = layer.camera
    drawn = np.isfinite(layer.depth)
    picture = np.zeros((len(drawn), 3), dtype=np.float32)
    hollow = hollows(layer, drawn, size)
    half = LIGHT + np.array([0, 0, 1], np.float32)
    half = half / np.linalg.norm(half)
    eye, axes = camera.eye.astype(np.float32), camera.axes.astype(np.float32)
    everything = np.flatnonzero(drawn)
    for k in np.array_split(everything, len(everything) // 200000 + 1):
        normal, depth = layer.normal[k], layer.depth[k]
        x = ((k % camera.width + (0.5 - 0.5 * camera.width)) / camera.scale).astype(np.float32) * depth
        y = ((0.5 * camera.height - 0.5 - k // camera.width) / camera.scale).astype(np.float32) * depth
        lit = shadow.lit(eye + np.stack([x, y, -depth], axis=1) @ axes, bias)
        key = np.clip(normal @ LIGHT, 0, 1) * (0.35 + 0.65 * lit)
        light = 0.52 + 0.08 * normal[:, 1] + 0.48 * key + 0.2 * np.clip(normal @ FILL, 0, 1)
        gloss = layer.gloss[k] * np.clip(normal @ half, 0, 1) ** 40 * lit
        matte = layer.gloss[k] == 0  # walls and floor: light paper, whichever way they face
        light = np.where(matte, 0.86 + 0.14 * lit, light) * (1 - np.where(matte, np.float32(0.12), np.float32(0.55)) * hollow[k])
        picture[k] = layer.colour[k] * light[:, None] + gloss[:, None]
    return np.clip(picture, 0, 1, out=picture), drawn


def compose(solid, water, size, shadow, bias, background=(1.0, 1.0, 1.0), line=(0.45, 0.5, 0.55)):
    """the picture (height x width x 3, 0 to 1): water over solid, each pixel the mean of its samples"""
    camera = solid.camera
    behind, seen = shade(solid, size, shadow, bias)
    picture = np.where(seen[:, None], behind, np.asarray(background, np.float32))
    if water is not None:
        front, wet = shade(water, size, shadow, bias)
        over = wet & (water.depth < solid.depth)
        body = over & seen & (solid.gloss > 0)  # walls and floor do not shine through
        share = np.where(body, WATER_OVER_BODY, 1.0).astype(np.float32)[:, None]
        picture = np.where(over[:, None], share * front + (1 - share) * picture, picture)
    nearest = solid.depth if water is None else np.minimum(solid.depth, water.depth)
    edge = solid.line < nearest * 1.001
    picture[edge] = 0.3 * picture[edge] + 0.7 * np.asarray(line, np.float32)
    picture = picture.reshape(camera.height // SAMPLES, SAMPLES, camera.width // SAMPLES, SAMPLES, 3)
    return picture.mean(axis=(1, 3))
