// A sheet of 1 x 1 x 0.02 in 12 x 12 cells.
// gmsh -3 -nt 1 -format msh41 hard_sheet.geo -o hard_sheet.msh
Point(1) = {0, 0, 0};
line[] = Extrude {1, 0, 0} { Point{1}; Layers{{12}, {1}}; };
side[] = Extrude {0, 1, 0} { Line{line[1]}; Layers{{12}, {1}}; };
solid[] = Extrude {0, 0, 0.02} { Surface{side[1]}; Layers{{1}, {1}}; };
Physical Volume("solid") = {solid[1]};
Physical Surface("bottom") = {side[1]};
Physical Surface("top") = {solid[0]};
Physical Surface("sides") = {solid[2], solid[3], solid[4], solid[5]};
