"""Two figures modelled from round shapes: a dragon and an upright, armoured animal.

Every shape is a distance (negative inside, in metres); shapes melt into each other where they meet.
The surface where the distance is zero becomes triangles. Axes as of 3D scans: y points up; the
dragon looks along -x, the animal along -z.
"""
import numpy as np


# ---- Shapes -------------------------------------------------------------------------------------

class Shape:
    """Where it may be (low, high corners of a box) and how far points are from its surface."""

    def __init__(self, low, high, distance):
        self.low, self.high, self.distance = np.asarray(low), np.asarray(high), distance


def unit(v):
    v = np.asarray(v, float)
    return v / np.sqrt((v * v).sum())


def egg(centre, radii, along=(1, 0, 0), up=(0, 1, 0)):
    """An ellipsoid: radii along `along`, along what of `up` is perpendicular to it, and across."""
    centre, radii = np.asarray(centre, float), np.asarray(radii, float)
    first = unit(along)
    second = unit(np.asarray(up, float) - np.dot(up, first) * first)
    axes = np.stack([first, second, np.cross(first, second)])

    def distance(points):
        q = (points - centre) @ axes.T / radii
        near = np.sqrt((q * q).sum(1))
        q = q / radii
        return near * (near - 1.0) / np.maximum(np.sqrt((q * q).sum(1)), 1e-9)

    reach = radii.max()
    return Shape(centre - reach, centre + reach, distance)


def smooth_curve(knots, steps):
    """Catmull-Rom through the rows of `knots`, `steps` pieces between two of them."""
    knots = np.asarray(knots, float)
    padded = np.concatenate([[2 * knots[0] - knots[1]], knots, [2 * knots[-1] - knots[-2]]])
    t = (np.arange(steps) / steps)[:, None]
    pieces = []
    for k in range(len(knots) - 1):
        a, b, c, d = padded[k:k + 4]
        pieces.append(b + 0.5 * t * (c - a + t * (2 * a - 5 * b + 4 * c - d
                                                 + t * (3 * (b - c) + d - a))))
    return np.concatenate(pieces + [knots[-1:]])


def tube(knots, steps=10, skin=None):
    """A round tube through knots (x, y, z, radius). `skin(s, angle, radius)`, if given, is added to
    its distance: s in m along the tube, angle 0 on the side that is up at its first knot."""
    curve = smooth_curve(knots, steps)
    middle, radius = curve[:, :3], curve[:, 3]
    arrow = np.diff(middle, axis=0)
    length = np.sqrt((arrow * arrow).sum(1))
    way = np.concatenate([[0.0], np.cumsum(length)])
    ups = []
    up = np.array([0.0, 1.0, 0.0])
    for piece in arrow:
        along = unit(piece)
        up = unit(up - np.dot(up, along) * along)
        ups.append(up)

    def distance(points):
        best = np.full(len(points), np.inf)
        at, angle, size = np.zeros((3, len(points)))
        for k in range(len(arrow)):
            offset = points - middle[k]
            t = np.clip(offset @ arrow[k] / length[k] ** 2, 0.0, 1.0)
            offset = offset - t[:, None] * arrow[k]
            r = radius[k] + t * (radius[k + 1] - radius[k])
            d = np.sqrt((offset * offset).sum(1)) - r
            nearer = d < best
            best = np.where(nearer, d, best)
            if skin is not None:
                turn = np.arctan2(offset @ np.cross(arrow[k] / length[k], ups[k]), offset @ ups[k])
                at = np.where(nearer, way[k] + t * length[k], at)
                angle = np.where(nearer, turn, angle)
                size = np.where(nearer, r, size)
        return best if skin is None else best + skin(at, angle, size)

    reach = radius[:, None]
    return Shape((middle - reach).min(0), (middle + reach).max(0), distance)


def above(height):
    """Everything below a level, to be cut off."""
    return Shape([-9, -9, -9], [9, height, 9], lambda points: points[:, 1] - height)


class Figure:
    """Shapes put together one after the other; each melts into those before it over `blend`, m."""

    MARGIN = 0.02      # m around a shape where its distance is asked for

    def __init__(self):
        self.steps = []

    def add(self, shape, blend=0.012):
        self.steps.append((shape, blend, 1.0))

    def cut(self, shape, blend=0.006):
        self.steps.append((shape, blend, -1.0))

    def bounds(self):
        solid = [shape for shape, _, sign in self.steps if sign > 0]
        return (np.min([shape.low for shape in solid], axis=0),
                np.max([shape.high for shape in solid], axis=0))

    def distance(self, points):
        whole = np.full(len(points), 1.0)
        for shape, blend, sign in self.steps:
            reach = blend + self.MARGIN
            near = np.flatnonzero(np.all((points > shape.low - reach)
                                         & (points < shape.high + reach), axis=1))
            if len(near) == 0:
                continue
            # sign * smaller of both, rounded off where they are within `blend` of each other.
            old, new = sign * whole[near], shape.distance(points[near])
            round_off = np.maximum(blend - np.abs(old - new), 0.0)
            whole[near] = sign * (np.minimum(old, new) - round_off ** 2 / (4.0 * blend))
        return whole


# ---- Triangles ----------------------------------------------------------------------------------

CORNERS = np.array([[i, j, k] for i in (0, 1) for j in (0, 1) for k in (0, 1)])
CORNER = {tuple(corner): n for n, corner in enumerate(CORNERS)}


def is_simple(bits):
    """Whether a cell with these corners inside is cut into one piece inside and one outside, and
    no face of it crosswise: then one point per cell gives a 2-manifold."""
    inside = [bool(bits >> n & 1) for n in range(8)]
    for wanted in (True, False):
        group = [n for n in range(8) if inside[n] == wanted]
        if not group:
            return True
        seen, todo = {group[0]}, [group[0]]
        while todo:
            here = todo.pop()
            for n in group:
                if n not in seen and abs(CORNERS[n] - CORNERS[here]).sum() == 1:
                    seen.add(n)
                    todo.append(n)
        if len(seen) != len(group):
            return False
    for axis in range(3):
        for side in (0, 1):
            face = [n for n in range(8) if CORNERS[n][axis] == side]
            if inside[face[0]] == inside[face[3]] != inside[face[1]] == inside[face[2]]:
                return False
    return True


def cells_of(values):
    """The eight corners of every cell, as the last axis."""
    n = np.array(values.shape) - 1
    return np.stack([values[i:i + n[0], j:j + n[1], k:k + n[2]] for i, j, k in CORNERS], axis=-1)


def simplify(values, cell):
    """Fills, in place, what the grid is too coarse for: in each cell that is not simple, the
    outside corner nearest to the surface becomes inside."""
    simple = np.array([is_simple(bits) for bits in range(256)])
    for _ in range(100):
        corners = cells_of(values)
        bits = ((corners < 0.0) << np.arange(8)).sum(-1)
        bad = np.argwhere(~simple[bits])
        if len(bad) == 0:
            return
        for i, j, k in bad:
            at = corners[i, j, k]
            n = np.argmin(np.where(at >= 0.0, at, np.inf))
            values[tuple((i, j, k) + CORNERS[n])] = -1e-3 * cell
    raise RuntimeError("the grid is too coarse for the figure")


def largest_component(points, triangles):
    label = np.arange(len(points))
    while True:
        lowest = label.copy()
        np.minimum.at(lowest, triangles.ravel(), np.repeat(label[triangles].min(1), 3))
        lowest = lowest[lowest]
        if np.array_equal(lowest, label):
            break
        label = lowest
    names, sizes = np.unique(label, return_counts=True)
    kept = label == names[np.argmax(sizes)]
    renumbered = np.cumsum(kept) - 1
    return points[kept], renumbered[triangles[kept[triangles[:, 0]]]]


def polygonise(figure, cell):
    """Surface nets: a point in every cell that the surface cuts, a quadrilateral for every edge of
    the grid that it cuts; then the points are evened out along the surface and drawn onto it."""
    low, high = figure.bounds()
    low = low - 3.0 * cell
    ticks = [low[k] + cell * np.arange(int((high[k] - low[k]) / cell) + 4) for k in range(3)]
    grid = np.stack(np.meshgrid(*ticks, indexing="ij"), -1)
    values = figure.distance(grid.reshape(-1, 3)).reshape(grid.shape[:3])
    simplify(values, cell)

    corners = cells_of(values)
    inside = corners < 0.0
    cut = inside.any(-1) & ~inside.all(-1)
    number = np.full(cut.shape, -1)
    number[cut] = np.arange(cut.sum())
    at = corners[cut]
    total, count = np.zeros((len(at), 3)), np.zeros((len(at), 1))
    for m, corner in enumerate(CORNERS):
        for axis in range(3):
            if corner[axis] == 0:
                n = CORNER[tuple(corner + np.eye(3, dtype=int)[axis])]
                crossed = (at[:, m] < 0.0) != (at[:, n] < 0.0)
                rise = np.where(crossed, at[:, m] - at[:, n], 1.0)
                total[crossed] += corner
                total[:, axis] += np.where(crossed, at[:, m], 0.0) / rise
                count += crossed[:, None]
    points = low + cell * (np.argwhere(cut) + total / count)

    triangles = []
    solid = values < 0.0
    for axis in range(3):
        ahead = np.roll(np.arange(3), -axis)                   # axis, then the two across it
        s = solid.transpose(ahead)
        cell_number = number.transpose(ahead)
        here, there = s[:-1, 1:-1, 1:-1], s[1:, 1:-1, 1:-1]
        for edges, order in ((here & ~there, (0, 1, 2, 3)), (~here & there, (3, 2, 1, 0))):
            i, j, k = np.nonzero(edges)
            around = [cell_number[i, j, k], cell_number[i, j + 1, k],
                      cell_number[i, j + 1, k + 1], cell_number[i, j, k + 1]]
            a, b, c, d = (around[n] for n in order)
            shorter = (((points[a] - points[c]) ** 2).sum(1)
                       <= ((points[b] - points[d]) ** 2).sum(1))[:, None]
            triangles += [np.where(shorter, np.stack([a, b, c], -1), np.stack([a, b, d], -1)),
                          np.where(shorter, np.stack([a, c, d], -1), np.stack([b, c, d], -1))]
    points, triangles = largest_component(points, np.concatenate(triangles))

    for sweep in range(7):
        if sweep < 5:
            mean, ends = np.zeros_like(points), np.zeros(len(points))
            for k in range(3):
                for other in (1, 2):
                    np.add.at(mean, triangles[:, k], points[triangles[:, (k + other) % 3]])
                np.add.at(ends, triangles[:, k], 2)
            points = points + 0.5 * (mean / ends[:, None] - points)
        points = points + draw_onto(figure, points, cell)
    return points, triangles


def draw_onto(figure, points, cell):
    """The step from each point to the surface, at most a third of a cell."""
    away, slope = figure.distance(points), np.empty_like(points)
    aside = 0.02 * cell
    for axis in range(3):
        slope[:, axis] = (figure.distance(points + aside * np.eye(3)[axis]) - away) / aside
    steepness = np.maximum((slope * slope).sum(1), 0.1)
    step = -(away / steepness)[:, None] * slope
    length = np.sqrt((step * step).sum(1))
    return step * np.minimum(1.0, cell / 3.0 / np.maximum(length, 1e-12))[:, None]


# ---- Dragon -------------------------------------------------------------------------------------

def scales(around, length, depth):
    """A net of cushions for a tube: `around` of them in a ring, each `length` m long."""
    def skin(s, angle, radius):
        u = 0.5 * around * angle + np.pi * s / length
        v = 0.5 * around * angle - np.pi * s / length
        cushion = np.sqrt(np.abs(np.sin(u) * np.sin(v)))
        return depth * np.minimum(radius / 0.04, 1.0) * (0.6 - cushion)
    return skin


SPINE = [  # x, y, z, radius
    (-0.205, 0.395, 0.000, 0.030), (-0.150, 0.392, 0.004, 0.034), (-0.110, 0.345, 0.012, 0.037),
    (-0.112, 0.280, 0.014, 0.042), (-0.135, 0.220, 0.004, 0.052), (-0.095, 0.172, -0.012, 0.058),
    (-0.020, 0.178, -0.026, 0.056), (0.055, 0.205, -0.016, 0.056), (0.130, 0.195, 0.010, 0.058),
    (0.190, 0.140, 0.022, 0.045), (0.245, 0.090, 0.012, 0.033), (0.300, 0.098, -0.014, 0.027),
    (0.322, 0.160, -0.026, 0.023), (0.295, 0.222, -0.016, 0.019), (0.258, 0.262, 0.004, 0.015),
    (0.258, 0.310, 0.016, 0.010)]


def add_leg(dragon, side, hip, knee, ankle, paw, thick):
    dragon.add(egg(hip, (1.25 * thick, 1.7 * thick, 0.95 * thick), up=(0.3, 1, 0)), 0.03)
    dragon.add(tube([(*hip, thick), (*knee, 0.72 * thick), (*ankle, 0.48 * thick),
                     (*paw, 0.46 * thick)]), 0.02)
    x, y, z = paw
    for turn in (-0.55, 0.0, 0.55):
        toe = np.array([-np.cos(turn), 0.0, side * 0.25 + np.sin(turn)])
        a, b, c = (np.array([x, y, z]) + reach * toe for reach in (0.012, 0.040, 0.066))
        dragon.add(tube([(*a, 0.017), (b[0], 0.019, b[2], 0.0145), (c[0], 0.004, c[2], 0.006)]),
                   0.008)
    heel = np.array([x + 0.032, 0.004, z])
    dragon.add(tube([(x + 0.006, y, z, 0.014), (*heel, 0.006)]), 0.008)
    # A tuft of flames at the elbow.
    for rise in (0.0, 0.02):
        a = np.asarray(knee, float) + (0.012, rise, side * 0.006)
        dragon.add(tube([(*a, 0.013), (*(a + (0.034, 0.012, side * 0.008)), 0.009),
                         (*(a + (0.058, 0.034, side * 0.010)), 0.006)]), 0.008)


def add_head(dragon):
    dragon.add(egg((-0.222, 0.405, 0), (0.052, 0.041, 0.042), along=(-1, -0.1, 0)), 0.02)
    # Upper jaw with a broad nose; the lower jaw hangs open.
    dragon.add(tube([(-0.235, 0.404, 0, 0.034), (-0.285, 0.396, 0, 0.026),
                     (-0.322, 0.398, 0, 0.022)]), 0.012)
    dragon.add(egg((-0.326, 0.408, 0), (0.022, 0.018, 0.030)), 0.010)
    dragon.add(tube([(-0.222, 0.374, 0, 0.028), (-0.262, 0.343, 0, 0.020),
                     (-0.300, 0.328, 0, 0.016), (-0.316, 0.334, 0, 0.013)]), 0.010)
    dragon.add(tube([(-0.240, 0.372, 0, 0.016), (-0.275, 0.356, 0, 0.010),
                     (-0.300, 0.356, 0, 0.007), (-0.314, 0.368, 0, 0.006)]), 0.008)  # tongue
    dragon.add(tube([(-0.302, 0.322, 0, 0.012), (-0.296, 0.296, 0, 0.011),
                     (-0.276, 0.270, 0, 0.0065)]), 0.008)                            # beard
    for side in (-1, 1):
        dragon.add(egg((-0.266, 0.414, side * 0.025), (0.0135, 0.0135, 0.0125)), 0.002)
        dragon.add(tube([(-0.288, 0.418, side * 0.020, 0.006), (-0.272, 0.434, side * 0.028, 0.009),
                         (-0.248, 0.434, side * 0.034, 0.010),
                         (-0.222, 0.448, side * 0.042, 0.006)]), 0.005)              # brow
        dragon.add(egg((-0.332, 0.422, side * 0.017), (0.012, 0.011, 0.012)), 0.006)
        dragon.add(tube([(-0.324, 0.388, side * 0.016, 0.009),
                         (-0.328, 0.362, side * 0.017, 0.0055)]), 0.005)             # fang
        dragon.add(tube([(-0.322, 0.398, side * 0.022, 0.009),
                         (-0.322, 0.380, side * 0.052, 0.0075),
                         (-0.292, 0.362, side * 0.074, 0.007),
                         (-0.258, 0.372, side * 0.088, 0.006)]), 0.006)              # whisker
        # Antlers with one branch.
        dragon.add(tube([(-0.225, 0.432, side * 0.020, 0.014), (-0.190, 0.460, side * 0.034, 0.012),
                         (-0.148, 0.468, side * 0.046, 0.010),
                         (-0.108, 0.484, side * 0.044, 0.0065)]), 0.008)
        dragon.add(tube([(-0.174, 0.464, side * 0.038, 0.010),
                         (-0.160, 0.488, side * 0.056, 0.0065)]), 0.006)
        # Mane: flames from the cheeks backwards.
        for height, out, back in ((0.416, 0.044, 0.076), (0.392, 0.054, 0.085),
                                  (0.366, 0.046, 0.070)):
            root = np.array([-0.214, height, side * 0.026])
            tip = root + (back, 0.004, side * out)
            dragon.add(tube([(*root, 0.015), (*(0.5 * (root + tip) + (0, -0.012, side * 0.010)),
                                              0.013), (*tip, 0.006)]), 0.006)


def make_dragon():
    dragon = Figure()
    dragon.add(tube(SPINE, steps=8, skin=scales(10, 0.042, 0.0045)))

    for side in (-1, 1):
        front, hind = (-0.105, 0.158), (0.130, 0.170)
        add_leg(dragon, side, (*front, side * 0.055), (-0.078, 0.098, side * 0.088),
                (-0.108, 0.046, side * 0.098), (-0.130, 0.020, side * 0.098), 0.036)
        add_leg(dragon, side, (*hind, side * 0.055), (0.108, 0.098, side * 0.092),
                (0.172, 0.060, side * 0.098), (0.150, 0.020, side * 0.099), 0.040)

    # The crest: flames along the spine that lean backwards.
    line = smooth_curve(SPINE, 6)
    way = np.concatenate([[0.0], np.cumsum(np.sqrt((np.diff(line[:, :3], axis=0) ** 2).sum(1)))])
    for s in np.arange(0.035, way[-1] - 0.03, 0.036):
        x, y, z, radius, ahead_x, ahead_y, ahead_z = (
            *(np.interp(s, way, line[:, k]) for k in range(4)),
            *(np.interp(s + 0.01, way, line[:, k]) - np.interp(s, way, line[:, k])
              for k in range(3)))
        ahead = unit((ahead_x, ahead_y, ahead_z))
        outward = unit(np.cross((0, 0, 1.0), ahead))
        foot = np.array([x, y, z]) + 0.85 * radius * outward
        size = 0.017 + 0.48 * radius
        dragon.add(egg(foot + 0.2 * size * ahead, (1.25 * size, 0.45 * size, 0.0075),
                       along=outward + 0.7 * ahead, up=ahead), 0.008)
    add_head(dragon)

    # The tail ends in a flame.
    for lean, height in ((-0.030, 0.055), (0.0, 0.075), (0.034, 0.050)):
        dragon.add(tube([(0.258, 0.300, 0.014, 0.011),
                         (0.258 + 0.7 * lean, 0.300 + 0.55 * height, 0.018, 0.012),
                         (0.258 + lean, 0.300 + height, 0.018, 0.006)]), 0.008)
    dragon.cut(above(0.0), 0.004)
    points, triangles = polygonise(dragon, 0.0056)
    return points * (0.7 / np.ptp(points[:, 0])), triangles


# ---- Armadillo ----------------------------------------------------------------------------------

def banded(shape, depth, pitch):
    """The shape with grooves across, level behind and falling to the front."""
    def distance(points):
        wave = np.cos(2.0 * np.pi * (points[:, 1] + 0.35 * points[:, 2]) / pitch)
        return shape.distance(points) + depth * np.maximum(wave, -0.3)
    return Shape(shape.low - depth, shape.high + depth, distance)


def add_arm(animal, side, elbow, wrist, palm):
    animal.add(egg((side * 0.140, 0.535, 0.010), (0.074, 0.062, 0.068), along=(side, 0.3, 0)), 0.03)
    animal.add(tube([(side * 0.120, 0.530, 0.010, 0.056), (side * elbow[0], *elbow[1:], 0.042),
                     (side * wrist[0], *wrist[1:], 0.033)], steps=16), 0.02)
    animal.add(egg((side * palm[0], *palm[1:]), (0.036, 0.038, 0.026)), 0.015)
    for spread in (-0.85, -0.15, 0.55):
        way = np.array([np.sin(0.45 + spread), np.cos(0.45 + spread), -0.35])
        knots = [np.array(palm) + reach * way + (0, 0, fall)
                 for reach, fall in ((0.02, 0), (0.055, 0), (0.085, -0.016))]
        animal.add(tube([(side * k[0], k[1], k[2], r)
                         for k, r in zip(knots, (0.020, 0.017, 0.008))]), 0.008)
    x, y, z = palm                                                       # thumb
    animal.add(tube([(side * (x - 0.02), y - 0.01, z - 0.010, 0.018),
                     (side * (x - 0.045), y + 0.005, z - 0.040, 0.015),
                     (side * (x - 0.050), y + 0.025, z - 0.062, 0.008)]), 0.008)


def add_leg_and_foot(animal, side):
    animal.add(tube([(side * 0.085, 0.280, 0.010, 0.088), (side * 0.128, 0.190, -0.030, 0.076),
                     (side * 0.140, 0.110, 0.000, 0.055), (side * 0.142, 0.045, 0.010, 0.050)],
                    steps=16), 0.03)
    animal.add(egg((side * 0.150, 0.030, -0.035), (0.058, 0.042, 0.085)), 0.02)
    for spread in (-0.035, 0.0, 0.035):
        animal.add(tube([(side * (0.152 + spread), 0.028, -0.085, 0.024),
                         (side * (0.154 + 1.25 * spread), 0.024, -0.128, 0.019),
                         (side * (0.156 + 1.4 * spread), 0.010, -0.160, 0.009)]), 0.008)


def add_face(animal):
    animal.add(tube([(0, 0.540, 0.010, 0.085), (0, 0.615, -0.050, 0.072)]), 0.03)
    animal.add(egg((0, 0.650, -0.070), (0.088, 0.076, 0.092)), 0.02)
    animal.add(tube([(0, 0.640, -0.110, 0.062), (0, 0.615, -0.180, 0.043),
                     (0, 0.600, -0.236, 0.031)]), 0.02)
    animal.add(egg((0, 0.610, -0.262), (0.022, 0.016, 0.014)), 0.006)
    for side in (-1, 1):
        animal.add(egg((side * 0.054, 0.663, -0.143), (0.021, 0.021, 0.020)), 0.003)
        animal.add(tube([(side * 0.026, 0.676, -0.158, 0.009), (side * 0.050, 0.690, -0.148, 0.013),
                         (side * 0.076, 0.676, -0.122, 0.009)]), 0.010)
        lean = (side * 0.35, 1.0, 0.10)
        ear = np.array([side * 0.076, 0.722, -0.040])
        animal.add(egg(ear, (0.086, 0.046, 0.020), along=lean, up=(1, 0, 0)), 0.012)
        animal.cut(egg(ear + (side * 0.003, 0.008, -0.020), (0.062, 0.030, 0.014), along=lean,
                       up=(1, 0, 0)), 0.008)
    # The mouth: a line along the muzzle.
    animal.cut(tube([(-0.040, 0.598, -0.190, 0.004), (-0.022, 0.584, -0.240, 0.004),
                     (0.0, 0.582, -0.258, 0.004), (0.022, 0.584, -0.240, 0.004),
                     (0.040, 0.598, -0.190, 0.004)]), 0.006)


def make_armadillo():
    animal = Figure()
    animal.add(egg((0, 0.300, 0.010), (0.135, 0.115, 0.115)))
    animal.add(banded(egg((0, 0.390, -0.010), (0.132, 0.135, 0.116)), 0.003, 0.044), 0.03)
    animal.add(egg((0, 0.495, 0.000), (0.150, 0.115, 0.110)), 0.04)
    animal.add(banded(egg((0, 0.430, 0.070), (0.172, 0.205, 0.128)), 0.006, 0.048), 0.012)
    for side in (-1, 1):
        add_leg_and_foot(animal, side)
    add_arm(animal, -1, (0.215, 0.520, 0.000), (0.255, 0.590, -0.040), (0.268, 0.630, -0.055))
    add_arm(animal, 1, (0.218, 0.510, -0.005), (0.265, 0.560, -0.060), (0.280, 0.597, -0.080))
    add_face(animal)
    animal.add(banded(tube([(0, 0.270, 0.110, 0.080), (0, 0.150, 0.180, 0.056),
                            (0.015, 0.055, 0.245, 0.036), (0.030, 0.024, 0.310, 0.022),
                            (0.015, 0.018, 0.350, 0.008)]), 0.003, 0.040), 0.02)
    animal.cut(above(0.0), 0.004)
    points, triangles = polygonise(animal, 0.0073)
    return points * (0.8 / np.ptp(points[:, 1])), triangles
