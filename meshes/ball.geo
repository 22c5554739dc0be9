// A ball of radius 0.08 m at the origin.
// gmsh -3 -format msh41 ball.geo -o ball.msh        about 2,500 tetrahedra. Metres.
SetFactory("OpenCASCADE");
radius = 0.08;
Sphere(1) = {0, 0, 0, radius};
Physical Volume("solid") = {1};
Physical Surface("skin") = {Boundary {Volume{1};}};
Mesh.MeshSizeMin = 0.0165; Mesh.MeshSizeMax = 0.0165;
Mesh.Algorithm = 6;
Mesh.Algorithm3D = 1; Mesh.OptimizeThreshold = 0.5;
