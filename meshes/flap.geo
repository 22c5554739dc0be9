// A flap across a tank of 1.0 x 0.24 x 0.5 m, clamped at its lower edge: 0.024 m thick, 0.2 m wide (0.02 m from each side wall), 0.2 m high.
// gmsh -3 -format msh41 flap.geo -o flap.msh        about 3,000 tetrahedra, three layers through the thickness. Metres.
SetFactory("OpenCASCADE");
x = 0.55; thickness = 0.024; y = 0.02; width = 0.2; height = 0.2;
size = 0.0168; // of the triangles in the flap's plane; each layer of prisms is cut into tetrahedra
Point(1) = {x, y, 0, size}; Point(2) = {x, y + width, 0, size}; Point(3) = {x, y + width, height, size}; Point(4) = {x, y, height, size};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Extrude {thickness, 0, 0} { Surface{1}; Layers{3}; }
root() = Surface In BoundingBox {x - 1e-6, y - 1e-6, -1e-6, x + thickness + 1e-6, y + width + 1e-6, 1e-6};
skin() = Boundary {Volume{1};}; skin() -= root();
Physical Volume("solid") = {1};
Physical Surface("root") = {root()};
Physical Surface("skin") = {skin()};
Mesh.Algorithm = 6;
