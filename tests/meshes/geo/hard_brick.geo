// A unit cube of one cell: six tetrahedra.
// gmsh -3 -nt 1 -format msh41 hard_brick.geo -o hard_brick.msh
Point(1) = {0, 0, 0};
line[] = Extrude {1, 0, 0} { Point{1}; Layers{{1}, {1}}; };
side[] = Extrude {0, 1, 0} { Line{line[1]}; Layers{{1}, {1}}; };
solid[] = Extrude {0, 0, 1} { Surface{side[1]}; Layers{{1}, {1}}; };
Physical Volume("solid") = {solid[1]};
Physical Surface("bottom") = {side[1]};
Physical Surface("top") = {solid[0]};
Physical Surface("sides") = {solid[2], solid[3], solid[4], solid[5]};
