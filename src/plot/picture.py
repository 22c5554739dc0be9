"""picture.py - the 3D views: water as shaded spheres, bodies as shaded surfaces, the tank around them."""

import matplotlib.pyplot as plt
import numpy as np
from matplotlib.cm import ScalarMappable
from matplotlib.colors import LinearSegmentedColormap, Normalize

import render
import style

WATER = LinearSegmentedColormap.from_list("water", ["#15508f", "#1d6fb4", "#379bd0", "#6cc4db", "#aee2db", "#f4f6d2"])
SOLID = LinearSegmentedColormap.from_list("solid", ["#f3dcc0", "#f4b183", "#e5794f", "#c0392f", "#7b1431"])
PRESSURE = LinearSegmentedColormap.from_list("pressure", ["#9ea1a6", "#a497b8", "#9a7bb8", "#8150a4", "#551f80"])  # an obstacle without water is grey
OBSTACLE = (0.62, 0.63, 0.65)
FLOOR, WALL = (0.93, 0.935, 0.94), (0.965, 0.97, 0.975)


class View:
    """What all pictures of a run share: the camera's direction, the space shown, the colour scales."""

    def __init__(self, run, steps_of=8):
        self.run = run
        times = run.times()
        self.sample = times[np.unique(np.linspace(0, len(times) - 1, steps_of).astype(int))] if len(times) else times
        self.up = self._up()
        self.low, self.high = self._space()
        self.direction = self._direction()
        self.radius = 0.53 * run.spacing() if run.fluid else 0.0
        self.size = float(np.linalg.norm(self.high - self.low))
        self.surfaces = {body.name: body.triangles() for body in run.bodies}
        self.speed = self._speed_range() if run.fluid else None
        self.solids = self._solid_ranges()
        self.pressure = self._pressure_top()

    def _up(self):
        gravity = self.run.vector(None, "gravity")
        if gravity is None or not np.any(gravity):
            gravity = np.array([0, 0, -1.0])
        return -gravity / np.linalg.norm(gravity)

    def _direction(self):
        """along the shorter horizontal side, a little from the side and from above"""
        vertical = int(np.argmax(np.abs(self.up)))
        along = np.eye(3)[max((a for a in range(3) if a != vertical), key=lambda a: (self.high - self.low)[a])]
        into = np.cross(self.up, along)  # `along` goes to the right
        turn, tilt = np.radians(24), np.radians(19)
        return np.cos(tilt) * (np.cos(turn) * into - np.sin(turn) * along) - np.sin(tilt) * self.up

    def _space(self):
        """the box shown: where anything ever is, and the tank's floor and walls around that"""
        points = []
        for time in self.sample:
            for series in [self.run.fluid, *self.run.bodies]:
                if series is not None:
                    x = series.points(series.step_at(time))
                    x = x[np.all(np.isfinite(x), axis=1)]
                    if len(x):
                        points += [x.min(axis=0), x.max(axis=0)]
        low, high = self.run.vector("domain", "min"), self.run.vector("domain", "max")
        if not points:
            return (low, high) if low is not None and high is not None else (np.zeros(3), np.ones(3))
        seen_low, seen_high = np.min(points, axis=0), np.max(points, axis=0)
        pad = 0.03 * max(np.max(seen_high - seen_low), 1e-9)
        if low is None or high is None or np.any(high <= low):
            return seen_low - pad, seen_high + pad
        # what has flown far out of the tank is not followed, and an empty sky is not shown
        seen_low, seen_high = np.maximum(seen_low, low - 0.25 * (high - low)), np.minimum(seen_high, high + 0.25 * (high - low))
        vertical = int(np.argmax(np.abs(self.up)))
        if self.up[vertical] > 0:
            high[vertical] = min(high[vertical], seen_high[vertical] + 2 * pad)
        else:
            low[vertical] = max(low[vertical], seen_low[vertical] - 2 * pad)
        return np.minimum(low, seen_low), np.maximum(high, seen_high)

    def _speed_range(self):
        fluid = self.run.fluid
        if "velocity" not in fluid.fields:
            return None
        speeds = [np.linalg.norm(fluid.field("velocity", fluid.step_at(t)), axis=1) for t in self.sample]
        top = max((np.percentile(s[np.isfinite(s)], 99) for s in speeds if np.any(np.isfinite(s))), default=0.0)
        return nice_top(top)

    def _solid_ranges(self):
        ranges = {}
        for body in self.run.bodies:
            if "displacement" not in body.fields:
                continue
            sizes = [np.linalg.norm(body.field("displacement", body.step_at(t)), axis=1) for t in self.sample]
            ranges[body.name] = max((np.max(s[np.isfinite(s)], initial=0.0) for s in sizes), default=0.0)
        top = nice_top(max(ranges.values(), default=0.0))
        return {name: top for name in ranges}

    def _pressure_top(self):
        """end of the scale of the water's pressure on obstacles; None where there is none"""
        shown = [body for body in self.run.bodies if body.name not in self.solids and "pressure" in body.fields]
        tops = [np.percentile(body.field("pressure", body.step_at(t)), 98) for body in shown for t in self.sample]
        top = max(tops, default=0.0)
        return nice_top(top) if np.isfinite(top) and top > 0 else None

    def corners(self):
        return np.array([[(self.low, self.high)[i][0], (self.low, self.high)[j][1], (self.low, self.high)[k][2]] for i in (0, 1) for j in (0, 1) for k in (0, 1)])

    def shape(self, width):
        """size in pixels of a picture of this space"""
        right = np.cross(self.direction, self.up)
        right /= np.linalg.norm(right)
        upward = np.cross(right, self.direction)
        flat = self.corners() @ np.array([right, upward]).T
        extent = flat.max(axis=0) - flat.min(axis=0)
        return width, int(np.clip(width * extent[1] / extent[0] * 1.04, 0.3 * width, 1.1 * width))

    def draw(self, time, width):
        """the picture at a time (height x width x 3)"""
        run = self.run
        camera = render.Camera(self.corners(), self.direction, self.up, *self.shape(width))
        light = render.LIGHT @ camera.axes
        light = light + 0.6 * self.up  # steeper than the shading's light: short shadows
        shadow = render.Shadow(self.corners(), light / np.linalg.norm(light), self.up + 1e-3 * camera.axes[0])
        solid, water = render.Layer(camera), None
        self._tank(solid)
        for body in run.bodies:
            step = body.step_at(time)
            points, triangles = body.points(step), self.surfaces[body.name]
            triangles = triangles[np.all(np.isfinite(points[triangles]), axis=(1, 2))]  # of a run that broke down
            if not len(triangles):
                continue
            if body.name in self.solids:
                size = np.linalg.norm(body.field("displacement", step), axis=1)
                colours = SOLID(np.nan_to_num(size / self.solids[body.name], nan=1.0, posinf=1.0))[:, :3]
            elif self.pressure and "pressure" in body.fields:
                colours = PRESSURE(np.clip(body.field("pressure", step) / self.pressure, 0, 1))[:, :3]
            else:
                colours = np.tile(OBSTACLE, (len(points), 1))
            normals = render.corner_normals(points, triangles)
            solid.triangles(points, triangles, colours, normals, gloss=0.15, edges=0.13)
            centres = points[triangles].mean(axis=1)
            edge = np.linalg.norm(points[triangles[:, 0]] - points[triangles[:, 1]], axis=1)
            shadow.add(np.concatenate([points[triangles[:, 0]], centres]), 0.6 * float(np.median(edge)))
        if run.fluid:
            step = run.fluid.step_at(time)
            points = run.fluid.points(step)
            good = np.all(np.isfinite(points), axis=1)
            points = points[good]
            if self.speed:
                speed = np.linalg.norm(run.fluid.field("velocity", step)[good], axis=1)
                colours = WATER(np.nan_to_num(speed / self.speed, nan=1.0, posinf=1.0))[:, :3]
            else:
                colours = np.tile(WATER(0.4)[:3], (len(points), 1))
            water = render.Layer(camera)
            water.spheres(points, self.radius, colours)
            shadow.add(points, self.radius)
        bias = max(2.5 * self.radius, 0.012 * self.size)
        return render.compose(solid, water, self.size, shadow, bias)

    def _tank(self, layer):
        """walls that are seen from inside, and the box's edges; the walls' inside faces the eye when it points against the view"""
        low, high = self.run.vector("domain", "min"), self.run.vector("domain", "max")
        if low is None or high is None:
            low, high = self.low, self.high
        low, high = np.maximum(low, self.low), np.minimum(high, self.high)
        walls = self.run.section("domain").get("walls") or []
        corner = lambda i, j, k: np.array([(low, high)[i][0], (low, high)[j][1], (low, high)[k][2]])
        camera = layer.camera
        for axis in range(3):
            for side in (0, 1):
                name = "xyz"[axis] + ("min", "max")[side]
                inward = np.eye(3)[axis] * (1 - 2 * side)
                index = [[side if a == axis else (i, j)[[b for b in range(3) if b != axis].index(a)] for a in range(3)] for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))]
                quad = np.array([corner(*c) for c in index])
                if inward @ (camera.eye - quad.mean(axis=0)) <= 0 or name not in walls:
                    continue
                floor = abs(inward @ self.up) > 0.5
                layer.triangles(quad - 1e-3 * self.radius * inward, np.array([[0, 1, 2], [0, 2, 3]]), np.tile(FLOOR if floor else WALL, (4, 1)), np.tile(inward, (2, 3, 1)), gloss=0.0)
        segments = []
        for axis in range(3):
            others = [a for a in range(3) if a != axis]
            for i in (0, 1):
                for j in (0, 1):
                    ends = []
                    for s in (0, 1):
                        c = [0, 0, 0]
                        c[axis], c[others[0]], c[others[1]] = s, i, j
                        ends.append(corner(*c))
                    segments.append(ends)
        layer.lines(np.array(segments), 1.0)


def nice_top(value):
    """the next of 1, 1.5, 2, 3, 4, 5, 6, 8 x 10^n above a value, for a scale that ends in a round number"""
    if not np.isfinite(value) or value <= 0:
        return 1.0
    power = 10.0 ** np.floor(np.log10(value))
    return float(next(m for m in (1, 1.5, 2, 3, 4, 5, 6, 8, 10) if m * power >= value * 0.999) * power)


def add_scales(figure, view, box):
    """colour scales side by side in `box` (left, bottom, width, height of the figure)"""
    scales = []
    if view.speed:
        scales.append((WATER, view.speed, "speed of the water [m/s]"))
    if view.solids:
        scales.append((SOLID, next(iter(view.solids.values())), "displacement of the body [m]" if len(view.solids) == 1 else "displacement of the bodies [m]"))
    if view.pressure:
        scales.append((PRESSURE, view.pressure, "pressure on obstacles [Pa]"))
    left, bottom, width, height = box
    for n, (colours, top, label) in enumerate(scales):
        axes = figure.add_axes([left + n * width / max(len(scales), 1), bottom, 0.82 * width / max(len(scales), 1), height])
        bar = figure.colorbar(ScalarMappable(Normalize(0, top), colours), cax=axes, orientation="horizontal")
        bar.outline.set_visible(False)
        bar.ax.tick_params(length=0, labelsize=9, pad=2)
        bar.set_label(label, fontsize=9.5, color=style.TEXT, labelpad=2)


def format_time(time):
    return f"t = {time:.4g} s"


def draw_final(run, view, width, path):
    """the last state, large"""
    image = view.draw(run.times()[-1], width)
    height, width = image.shape[:2]
    total = height + 230
    figure = plt.figure(figsize=(width / 100, total / 100), dpi=100)
    axes = figure.add_axes([0, 130 / total, 1, height / total])
    axes.imshow(image, interpolation="none", aspect="auto")
    axes.axis("off")
    figure.text(0.03, 1 - 45 / total, run.name, fontsize=21, fontweight="bold", color=style.TEXT, va="center")
    figure.text(0.97, 1 - 45 / total, format_time(run.times()[-1]), fontsize=17, color=style.MUTED, va="center", ha="right")
    add_scales(figure, view, (0.03, 75 / total, 0.6, 16 / total))
    figure.text(0.97, 40 / total, describe(run), fontsize=11, color=style.MUTED, va="center", ha="right")
    style.save(figure, path)


def draw_moments(run, view, width, path):
    """four moments, in two rows"""
    times = run.times()
    steps = np.unique(np.linspace(0, len(times) - 1, 4).round().astype(int))
    images = [view.draw(times[s], width // 2) for s in steps]
    height, width = images[0].shape[:2]
    columns = min(2, len(images))
    rows = -(-len(images) // columns)
    total_width, total = columns * width, rows * (height + 40) + 180
    figure = plt.figure(figsize=(total_width / 100, total / 100), dpi=100)
    figure.text(0.03, 1 - 40 / total, run.name, fontsize=18, fontweight="bold", color=style.TEXT, va="center")
    for n, (step, image) in enumerate(zip(steps, images)):
        top = 75 + (n // columns) * (height + 40)
        axes = figure.add_axes([(n % columns) / columns, 1 - (top + 40 + height) / total, 1 / columns, height / total])
        axes.imshow(image, interpolation="none", aspect="auto")
        axes.axis("off")
        figure.text((n % columns + 0.06) / columns, 1 - (top + 20) / total, format_time(times[step]), fontsize=14, color=style.MUTED, va="center")
    add_scales(figure, view, (0.06, 60 / total, 0.88, 14 / total))
    style.save(figure, path)


def describe(run):
    """one line of counts"""
    parts = []
    if run.fluid:
        parts.append(f"{run.fluid.n_points[run.fluid.part[-1]]:,} particles")
    for body in run.bodies:
        if body.kind == "tetrahedra":
            parts.append(f"{body.name}: {len(body.cells()):,} tetrahedra")
    return "   ·   ".join(parts)
