// A flexible plate that stands in a stream along x, clamped at its foot z = 0: 0.03 m thick, 0.12 m wide, 0.16 m high, centred on the z axis.
// gmsh -3 -format msh41 plate.geo -o plate.msh        about 2,400 tetrahedra, three layers through the thickness. Metres.
SetFactory("OpenCASCADE");
thickness = 0.03; width = 0.12; height = 0.16; x = -0.5*thickness; y = -0.5*width;
size = 0.0145; // of the triangles in the plate's plane; each layer of prisms is cut into tetrahedra
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
