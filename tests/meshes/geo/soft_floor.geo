// A block of 0.1 x 0.1 x 0.05 m that ends at z = 0, sides in the planes x, y = 0 and 0.1: under a column of water in a periodic domain.
// gmsh -3 -nt 1 -format msh41 soft_floor.geo -o soft_floor.msh. Metres.
SetFactory("OpenCASCADE");
Box(1) = {0, 0, -0.05, 0.1, 0.1, 0.05};
Physical Volume("solid") = {1};
Physical Surface("xmin") = {1}; Physical Surface("xmax") = {2};
Physical Surface("ymin") = {3}; Physical Surface("ymax") = {4};
Physical Surface("bottom") = {5}; Physical Surface("top") = {6};
MeshSize {:} = 0.025;
