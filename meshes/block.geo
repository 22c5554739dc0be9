// A block of 0.1 x 0.1 x 0.08 m standing on z = 0.
// gmsh -3 -nt 1 -format msh41 block.geo -o block.msh        about 900 tetrahedra. Metres.
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 0.1, 0.1, 0.08};
Physical Volume("solid") = {1};
Physical Surface("bottom") = {5};
Physical Surface("top") = {6};
Physical Surface("sides") = {1, 2, 3, 4};
MeshSize {:} = 0.018;
