// A cantilever of 1 x 0.1 x 0.1 m, clamped at x = 0.
// gmsh -3 -format msh41 beam.geo -o beam.msh        about 1,800 tetrahedra. Metres.
SetFactory("OpenCASCADE");
length = 1; side = 0.1;
Box(1) = {0, 0, 0, length, side, side};
clamp() = Surface In BoundingBox {-1e-6, -1e-6, -1e-6, 1e-6, side + 1e-6, side + 1e-6};
skin() = Boundary {Volume{1};}; skin() -= clamp();
Physical Volume("solid") = {1};
Physical Surface("clamp") = {clamp()};
Physical Surface("skin") = {skin()};
Mesh.MeshSizeMin = 0.0334; Mesh.MeshSizeMax = 0.0334;
Mesh.Algorithm = 6; Mesh.Algorithm3D = 1; Mesh.OptimizeThreshold = 0.5;
