#!/usr/bin/env python3
"""Makes the meshes of the scenes into meshes/ (or the folder given): terrain, bowl, two figures.

Each is binary little-endian PLY in metres, closed, facing outwards, and the same bytes every time.
"""
import pathlib
import sys

try:
    import numpy as np
except ImportError:
    sys.exit("make_meshes.py needs numpy (Debian: apt-get install python3-numpy)")

sys.dont_write_bytecode = True    # no folder of it beside the scripts
import figures

# ---- Meshes -------------------------------------------------------------------------------------

def check(name, points, triangles):
    """Stops unless the surface is closed, a 2-manifold and faces outwards; returns its volume."""
    a, b, c = (points[triangles[:, k]] for k in range(3))
    area = 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)
    longest = np.max([np.linalg.norm(q - p, axis=1) for p, q in ((a, b), (b, c), (c, a))], axis=0)
    if not np.all(area > 1e-6 * longest ** 2):
        sys.exit(f"{name}: a triangle has no area")

    # Each edge runs once each way: closed, and two triangles at every edge.
    tails = triangles.ravel()
    heads = triangles[:, [1, 2, 0]].ravel()
    forth = tails * len(points) + heads
    back = heads * len(points) + tails
    if len(np.unique(forth)) != len(forth) or not np.array_equal(np.sort(forth), np.sort(back)):
        sys.exit(f"{name}: an edge is open, shared by more than two triangles or turned over")

    # Around each corner the triangles form one ring. "Next edge around this corner" permutes the
    # edges; each cycle of it is labelled with its smallest edge, by doubling the stride.
    order = np.argsort(forth)
    edges = np.arange(len(forth))
    ends_here = edges - edges % 3 + (edges + 2) % 3
    stride = order[np.searchsorted(forth[order], back)][ends_here]
    label = edges
    while True:
        smaller = np.minimum(label, label[stride])
        if np.array_equal(smaller, label):
            break
        label, stride = smaller, stride[stride]
    if len(np.unique(label)) != len(points) or len(np.unique(tails)) != len(points):
        sys.exit(f"{name}: a corner is unused, or two parts of the surface touch in it")

    volume = np.einsum("ij,ij->", a, np.cross(b, c)) / 6.0
    if not volume > 0.0:
        sys.exit(f"{name}: faces inwards")
    return volume


def write(folder, name, points, triangles, comment):
    """Rounds to micrometres, so that no library's last bit shows in the file, and checks."""
    points = (np.round(points, 6) + 0.0).astype("<f4")
    volume = check(name, points.astype(float), triangles)
    faces = np.empty(len(triangles), dtype=[("n", "u1"), ("corners", "<i4", 3)])
    faces["n"] = 3
    faces["corners"] = triangles
    header = (f"ply\nformat binary_little_endian 1.0\ncomment {comment}\n"
              f"element vertex {len(points)}\n"
              "property float x\nproperty float y\nproperty float z\n"
              f"element face {len(triangles)}\n"
              "property list uchar int vertex_indices\nend_header\n")
    data = header.encode("ascii") + points.tobytes() + faces.tobytes()
    path = folder / f"{name}.ply"
    unfinished = path.with_suffix(".ply.tmp")
    unfinished.write_bytes(data)
    unfinished.replace(path)
    low, high = points.min(axis=0), points.max(axis=0)
    print(f"{path}: {len(points)} points, {len(triangles)} triangles, {len(data)} bytes, "
          f"{volume:.6f} m3, from {np.round(low, 3).tolist()} to {np.round(high, 3).tolist()} m")


# ---- Terrain ------------------------------------------------------------------------------------

# Hills as bells: centre x and y, height, half widths along and across, direction of "along".
# Two hills and the ridge between them cross the line of the two jets (from the corners at -, - and
# +, +), so that each jet strikes one flank of the saddle and its sand runs off into the valleys.
HILLS = [
    (0.30, -0.27, 0.205, 0.20, 0.145, -50.0),
    (-0.31, 0.29, 0.150, 0.19, 0.150, -35.0),
    (0.00, 0.01, 0.085, 0.30, 0.120, -45.0),
    (0.52, 0.20, 0.075, 0.18, 0.120, 70.0),
    (-0.53, -0.16, 0.085, 0.20, 0.110, 80.0),
    (-0.17, -0.57, 0.050, 0.22, 0.110, 10.0),
    (0.13, 0.56, 0.040, 0.20, 0.120, -10.0),
]


def terrain_height(x, y):
    # Long swells, turned against the square, so that no slope is as even as a bell's.
    height = (0.012 * np.sin(5.1 * x + 2.2 * y + 1.0) * np.cos(4.3 * y - 1.7 * x - 0.6)
              + 0.006 * np.sin(13.0 * x - 7.0 * y) * np.sin(6.0 * x + 12.0 * y + 0.8))
    for centre_x, centre_y, top, along, across, degrees in HILLS:
        turn = np.radians(degrees)
        u = (x - centre_x) * np.cos(turn) + (y - centre_y) * np.sin(turn)
        v = (y - centre_y) * np.cos(turn) - (x - centre_x) * np.sin(turn)
        height = height + top * np.exp(-0.5 * ((u / along) ** 2 + (v / across) ** 2))
    return height


def make_terrain():
    """A block with hills on top, a little wider than the 1.2 m square whose walls cut it."""
    cells = 84
    ticks = np.linspace(-0.63, 0.63, cells + 1)
    x, y = np.meshgrid(ticks, ticks, indexing="ij")
    z = terrain_height(x, y)
    inside = (np.abs(x) <= 0.6) & (np.abs(y) <= 0.6)
    z = 0.25 * (z - z[inside].min()) / (z[inside].max() - z[inside].min())
    top = np.stack([x, y, z], axis=-1).reshape(-1, 3)

    index = np.arange((cells + 1) ** 2).reshape(cells + 1, cells + 1)
    a, b, c, d = index[:-1, :-1], index[1:, :-1], index[1:, 1:], index[:-1, 1:]
    # The shorter diagonal in height, so that ridges and valleys stay smooth.
    steep = (np.abs(z[:-1, :-1] - z[1:, 1:]) <= np.abs(z[1:, :-1] - z[:-1, 1:]))[..., None]
    first = np.where(steep, np.stack([a, b, c], -1), np.stack([a, b, d], -1))
    second = np.where(steep, np.stack([a, c, d], -1), np.stack([b, c, d], -1))

    # Sides and bottom hang on the rim, counter-clockwise from above.
    rim = np.concatenate([index[:-1, 0], index[-1, :-1], index[:0:-1, -1], index[0, :0:-1]])
    below = len(top) + np.arange(len(rim))
    bottom = top[rim] * [1.0, 1.0, 0.0] + [0.0, 0.0, -0.05]
    centre = len(top) + len(rim)
    after, below_after = np.roll(rim, -1), np.roll(below, -1)
    triangles = np.concatenate([
        first.reshape(-1, 3), second.reshape(-1, 3),
        np.stack([rim, below, below_after], -1), np.stack([rim, below_after, after], -1),
        np.stack([below, np.full_like(below, centre), below_after], -1)])
    return np.concatenate([top, bottom, [[0.0, 0.0, -0.05]]]), triangles


# ---- Bowl ---------------------------------------------------------------------------------------

RIM_RADIUS = 0.58     # m, inside
DEPTH = 0.36          # m, from the top of the rim to the bottom inside
FOOT_HEIGHT = 0.024   # m, from the ground to the underside
WALL_AT_BOTTOM, WALL_AT_RIM = 0.016, 0.0125


def bowl_profile():
    """(radius, z) of the half section, from the middle inside over the rim to the middle below."""
    floor = FOOT_HEIGHT + WALL_AT_BOTTOM
    bead_rise = 0.0034                                 # of the rounded rim above its inner edge
    # The inside: round below, ever steeper, with a slight flare of the lip.
    s = np.linspace(0.0, 1.0, 400)
    radius = RIM_RADIUS * (s + 0.16 * s * (1.0 - s) + 0.05 * s ** 2 * (1 - s) ** 2)
    z = floor + (DEPTH - bead_rise) * (0.86 * s ** 2.35 + 0.14 * s ** 5)
    slope = np.stack([np.gradient(radius, s), np.gradient(z, s)], -1)
    slope /= np.linalg.norm(slope, axis=1, keepdims=True)
    slope[0] = [1.0, 0.0]                              # level in the middle
    outward = np.stack([slope[:, 1], -slope[:, 0]], -1)
    wall = WALL_AT_BOTTOM + (WALL_AT_RIM - WALL_AT_BOTTOM) * s
    inside = np.stack([radius, z], -1)
    outside = inside + wall[:, None] * outward

    # Half a circle from the inner to the outer edge.
    middle = 0.5 * (inside[-1] + outside[-1])
    arm = inside[-1] - middle
    angles = np.linspace(0.0, -np.pi, 13)[1:-1]
    bead_arc = middle + np.stack([np.cos(angles) * arm[0] - np.sin(angles) * arm[1],
                                  np.sin(angles) * arm[0] + np.cos(angles) * arm[1]], -1)

    # The foot ring: leaves the outside with a fillet, stands on a rounded edge.
    foot_out, foot_in, fillet = 0.215, 0.185, 0.010
    underside = np.interp(foot_out + fillet, outside[:, 0], outside[:, 1])
    quarter = np.linspace(0.0, 0.5 * np.pi, 7)
    edge = 0.006
    arcs = [
        np.stack([foot_out + fillet * (1 - np.sin(quarter)),
                  underside - fillet * (1 - np.cos(quarter))], -1),
        np.stack([foot_out - 0.004 - edge * (1 - np.cos(quarter)),
                  edge * (1 - np.sin(quarter))], -1),
        np.stack([foot_in + 0.004 + edge * (1 - np.sin(quarter)),
                  edge * (1 - np.cos(quarter))], -1),
        np.stack([foot_in - fillet * (1 - np.cos(quarter)),
                  FOOT_HEIGHT - fillet * (1 - np.sin(quarter))], -1),
    ]
    wall_out = outside[outside[:, 0] > foot_out + fillet + 0.004][::-1]

    def thin(line, count):
        """`count` points evenly spaced along the line, its ends included."""
        length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
        at = np.linspace(0.0, length[-1], count)
        return np.stack([np.interp(at, length, line[:, k]) for k in range(2)], -1)

    return np.concatenate([thin(inside, 48), bead_arc, thin(wall_out, 36), *arcs,
                           [[0.14, FOOT_HEIGHT], [0.07, FOOT_HEIGHT], [0.0, FOOT_HEIGHT]]])


def make_bowl(segments=192):
    """A surface of revolution; the profile's two ends lie on the axis."""
    profile = bowl_profile()
    profile[0, 0] = profile[-1, 0] = 0.0
    angles = 2.0 * np.pi * np.arange(segments) / segments
    rings = profile[1:-1]
    points = np.stack([rings[:, None, 0] * np.cos(angles), rings[:, None, 0] * np.sin(angles),
                       np.repeat(rings[:, 1:], segments, axis=1)], -1).reshape(-1, 3)
    first, last = len(points), len(points) + 1
    points = np.concatenate([points, [[0.0, 0.0, profile[0, 1]], [0.0, 0.0, profile[-1, 1]]]])

    index = np.arange(len(rings) * segments).reshape(len(rings), segments)
    here, there = index[:-1], index[1:]
    here_after, there_after = np.roll(here, -1, axis=1), np.roll(there, -1, axis=1)
    start, end = index[0], index[-1]
    triangles = np.concatenate([
        np.stack([np.full(segments, first), start, np.roll(start, -1)], -1),
        np.stack([here, there, there_after], -1).reshape(-1, 3),
        np.stack([here, there_after, here_after], -1).reshape(-1, 3),
        np.stack([end, np.full(segments, last), np.roll(end, -1)], -1)])
    return points, triangles


def main():
    root = pathlib.Path(__file__).resolve().parent.parent
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else root / "meshes"
    folder.mkdir(parents=True, exist_ok=True)
    write(folder, "terrain", *make_terrain(), "hills for a box of 1.2 x 1.2 m, in metres, z up")
    write(folder, "bowl", *make_bowl(), "a bowl of 0.58 m inner radius, in metres, z up")
    write(folder, "stand_in_dragon", *figures.make_dragon(),
          "a dragon 0.7 m long, in metres, y up, looks along -x")
    write(folder, "stand_in_armadillo", *figures.make_armadillo(),
          "an animal 0.8 m high, in metres, y up, looks along -z")


if __name__ == "__main__":
    main()
