#!/usr/bin/python3
"""Fill a closed triangle surface with tetrahedra, by gmsh.

    solid_from_surface.py IN.{stl,off,obj,ply} -o OUT.msh (--size S | --tets N) [--scale F]

The surface is classified and remeshed at the size S [m, after scaling], or at the size that gives N tetrahedra within 10 %. OUT.msh is in
format 4.1 with the physical groups `solid` (volume) and `skin` (its whole boundary). Exit status: 0 done, 1 gmsh failed,
2 the input cannot be used.
"""
import argparse
import collections
import math
import os
import subprocess
import sys
import tempfile

SCRIPT = """// discrete surface -> patches -> their geometry -> volume
Merge "{surface}";
ClassifySurfaces {{{angle} * Pi / 180, 1, 1, Pi}};
CreateGeometry;
Surface Loop(1) = Surface {{:}};
Volume(1) = {{1}};
Physical Volume("solid") = {{1}};
Physical Surface("skin") = Surface {{:}};
Mesh.MeshSizeMin = {size}; Mesh.MeshSizeMax = {size};
Mesh.Algorithm = 6; Mesh.Algorithm3D = 1; Mesh.OptimizeThreshold = 0.5;
"""


def fail(message, status=2):
    """print what is wrong and what is expected, and leave"""
    print(f"solid_from_surface.py: {message}", file=sys.stderr)
    sys.exit(status)


def read_off(path):
    """points and triangles of an OFF file; polygons are cut into fans"""
    with open(path) as f:
        words = [w for line in f for w in line.split("#")[0].split()]
    if not words or words[0] != "OFF":
        raise ValueError("it does not begin with OFF")
    n_points, n_faces = int(words[1]), int(words[2])
    at = 4 + 3 * n_points
    if len(words) < at:
        raise ValueError("it ends within its points")
    points = [tuple(map(float, words[4 + 3 * i: 7 + 3 * i])) for i in range(n_points)]
    triangles = []
    for _ in range(n_faces):
        n = int(words[at])
        face = [int(w) for w in words[at + 1: at + 1 + n]]
        if len(face) < n:
            raise ValueError("it ends within its faces")
        triangles += [(face[0], face[k], face[k + 1]) for k in range(1, n - 1)]
        at += 1 + n
    return points, triangles


def read_vtk(path, kind):
    """points and triangles of an STL, OBJ or PLY file, by VTK's readers"""
    from vtkmodules.vtkFiltersCore import vtkTriangleFilter
    if kind == ".stl":
        from vtkmodules.vtkIOGeometry import vtkSTLReader as Reader
    elif kind == ".obj":
        from vtkmodules.vtkIOGeometry import vtkOBJReader as Reader
    else:
        from vtkmodules.vtkIOPLY import vtkPLYReader as Reader
    from vtkmodules.vtkCommonCore import vtkObject
    vtkObject.GlobalWarningDisplayOff()
    reader, cut = Reader(), vtkTriangleFilter()
    reader.SetFileName(path)
    cut.SetInputConnection(reader.GetOutputPort())
    cut.PassVertsOff()
    cut.PassLinesOff()
    cut.Update()
    mesh = cut.GetOutput()
    points = [mesh.GetPoint(i) for i in range(mesh.GetNumberOfPoints())]
    cells = (mesh.GetCell(i).GetPointIds() for i in range(mesh.GetNumberOfCells()))
    return points, [tuple(cell.GetId(k) for k in range(3)) for cell in cells]


def read_surface(path):
    """points and triangles of a surface file, whatever its kind"""
    kind = os.path.splitext(path)[1].lower()
    if kind not in (".stl", ".off", ".obj", ".ply"):
        fail(f"{path}: '{kind}' is not a surface file that can be read\n  expected .stl, .off, .obj or .ply")
    if not os.path.isfile(path):
        fail(f"{path}: no such file")
    try:
        points, triangles = read_off(path) if kind == ".off" else read_vtk(path, kind)
    except (ValueError, IndexError, UnicodeDecodeError) as error:
        fail(f"{path}: cannot be read: {error}")
    if not triangles:
        fail(f"{path}: holds no triangles (or is not a {kind[1:].upper()} file)")
    if max(max(t) for t in triangles) >= len(points) or min(min(t) for t in triangles) < 0:
        fail(f"{path}: cannot be read: a triangle names a point that is not there")
    return points, triangles


def weld(points, triangles):
    """one point for each place (an STL repeats them), no triangles without area"""
    number, place = {}, []
    new = []
    for p in points:
        if p not in number:
            number[p] = len(place)
            place.append(p)
        new.append(number[p])
    triangles = [tuple(new[a] for a in t) for t in triangles]
    return place, [t for t in triangles if len(set(t)) == 3]


def check_closed(path, points, triangles):
    """each edge has two triangles, which run along it in opposite directions"""
    count = collections.Counter()
    for t in triangles:
        for k in range(3):
            count[t[k], t[(k + 1) % 3]] += 1
    def show(a, b):
        return "({:g}, {:g}, {:g}) - ({:g}, {:g}, {:g})".format(*points[a], *points[b])
    open_edges = [e for e in count if count[e] + count[e[::-1]] == 1]
    if open_edges:
        fail(f"{path}: the surface is not closed: {len(open_edges)} open edges, the first is {show(*open_edges[0])}\n"
             "  close its holes in a mesh editor; a solid needs a watertight surface")
    bad = [e for e in count if count[e] != 1 or count[e[::-1]] != 1]
    if bad:
        fail(f"{path}: the surface meets itself or its triangles are not all turned the same way, at edge {show(*bad[0])}\n"
             "  every edge must have two triangles that run along it in opposite directions")


def enclosed_volume(points, triangles):
    """signed volume by the divergence theorem"""
    total = 0.0
    for a, b, c in triangles:
        (x0, y0, z0), (x1, y1, z1), (x2, y2, z2) = points[a], points[b], points[c]
        total += x0 * (y1 * z2 - z1 * y2) - y0 * (x1 * z2 - z1 * x2) + z0 * (x1 * y2 - y1 * x2)
    return total / 6.0


def write_msh(path, points, triangles, scale):
    """the surface as a gmsh 2.2 file: the one format of gmsh's that keeps who is whose neighbour"""
    with open(path, "w") as f:
        f.write(f"$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{len(points)}\n")
        for i, p in enumerate(points):
            f.write("{} {:.17g} {:.17g} {:.17g}\n".format(i + 1, *(scale * x for x in p)))
        f.write(f"$EndNodes\n$Elements\n{len(triangles)}\n")
        for i, t in enumerate(triangles):
            f.write("{} 2 2 1 1 {} {} {}\n".format(i + 1, *(a + 1 for a in t)))
        f.write("$EndElements\n")


def count_tetrahedra(path):
    """number of tetrahedra in an ASCII 4.1 file"""
    n, left = 0, -1
    with open(path) as f:
        for line in f:
            if line.startswith("$Elements"):
                left = 0
                next(f)
            elif line.startswith("$EndElements"):
                break
            elif left == 0:
                _, _, kind, left = map(int, line.split())
                n += left if kind == 4 else 0
            elif left > 0:
                left -= 1
    return n


def run_gmsh(surface, size, angle, out):
    """mesh at one size, with edges kept where the surface bends by more than `angle`; returns the number of tetrahedra and gmsh's error"""
    script = os.path.join(os.path.dirname(surface), "solid.geo")
    with open(script, "w") as f:
        f.write(SCRIPT.format(surface=surface, size=size, angle=angle))
    if os.path.exists(out):
        os.remove(out)
    try:
        done = subprocess.run(["gmsh", "-3", "-nt", "1", "-format", "msh41", script, "-o", out], capture_output=True, text=True)
    except FileNotFoundError:
        fail("the program gmsh is not installed (Debian: apt-get install gmsh)", 1)
    errors = [line.split(":", 1)[1].strip() for line in (done.stdout + done.stderr).splitlines() if line.startswith("Error")]
    n = count_tetrahedra(out) if os.path.exists(out) and not done.returncode else 0
    return n, errors[0] if errors else "no tetrahedra came out"


def mesh(surface, size, angles, volume, out):
    """Mesh at one size. A scanned surface has chance edges that cut it into patches gmsh cannot unfold, or can only with slivers of
    elements: then the next, blunter angle is tried, and `angles` keeps the one that works in front."""
    expected = 8.5 * volume / size**3  # a regular tetrahedron fills size^3/8.5
    for k, angle in enumerate(list(angles)):
        n, error = run_gmsh(surface, size, angle, out)
        if 0 < n <= 3 * expected + 200:
            del angles[:k]
            return n
    fail(f"gmsh could not mesh the surface at size {size:g}: {error}\n  try another --size or --angle, or mend the surface", 1)


def main():
    parser = argparse.ArgumentParser(description="Fill a closed triangle surface with tetrahedra, by gmsh.")
    parser.add_argument("surface", help="STL, OFF, OBJ or PLY file of a closed surface")
    parser.add_argument("-o", "--output", required=True, help="gmsh file to write")
    how = parser.add_mutually_exclusive_group(required=True)
    how.add_argument("--size", type=float, help="edge length of the tetrahedra [m, after scaling]")
    how.add_argument("--tets", type=int, help="number of tetrahedra, met within 10 %%")
    parser.add_argument("--scale", type=float, default=1.0, help="factor on the coordinates (1)")
    parser.add_argument("--angle", type=float, help="edges sharper than this stay edges [degrees] (40; blunter where that fails)")
    args = parser.parse_args()
    for name, value in (("--size", args.size), ("--tets", args.tets), ("--scale", args.scale)):
        if value is not None and not (0 < value < math.inf):
            fail(f"{name} {value}: expected a finite number > 0")

    points, triangles = weld(*read_surface(args.surface))
    check_closed(args.surface, points, triangles)
    volume = enclosed_volume(points, triangles) * args.scale**3
    if volume < 0:
        triangles, volume = [t[::-1] for t in triangles], -volume

    with tempfile.TemporaryDirectory() as folder:
        surface, out = os.path.join(folder, "surface.msh"), os.path.join(folder, "solid.msh")
        write_msh(surface, points, triangles, args.scale)
        angles = [args.angle] if args.angle else [40.0, 90.0, 180.0]
        size = args.size or (8.5 * volume / args.tets) ** (1 / 3)
        n = mesh(surface, size, angles, volume, out)
        for _ in range(8 if args.tets else 0):
            if abs(n - args.tets) <= 0.1 * args.tets:
                break
            size *= (n / args.tets) ** (1 / 3)
            n = mesh(surface, size, angles, volume, out)
        if args.tets and abs(n - args.tets) > 0.1 * args.tets:
            fail(f"{n} tetrahedra at best, {args.tets} were asked for: the surface needs a finer mesh than that", 1)
        with open(out, "rb") as made, open(args.output, "wb") as f:
            f.write(made.read())
    print(f"{args.output}: {n} tetrahedra, size {size:.4g} m, volume {volume:.4g} m^3")


if __name__ == "__main__":
    main()
