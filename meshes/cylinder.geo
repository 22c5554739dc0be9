// Closed surface of a cylinder, an obstacle: radius 0.05 m, length 0.2 m along y, centred at the origin.
// gmsh -2 -bin -format stl cylinder.geo -o cylinder.stl        about 1,300 triangles. Metres.
SetFactory("OpenCASCADE");
radius = 0.05; length = 0.2;
Cylinder(1) = {0, -0.5*length, 0, 0, length, 0, radius};
Physical Surface("skin") = {Boundary {Volume{1};}};
Mesh.MeshSizeMin = 0.0125; Mesh.MeshSizeMax = 0.0125;
Mesh.Algorithm = 6;
