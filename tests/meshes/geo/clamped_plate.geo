// A plate of 1 x 0.2 x 0.1 m that ends at z = 0: groups left and right are its ends.
// gmsh -3 -nt 1 -order 2 -format msh41 clamped_plate.geo -o clamped_plate.msh. Metres.
depth = 0.2; thickness = 0.1;
Point(1) = {0, 0, -thickness}; Point(2) = {0, depth, -thickness};
Line(1) = {1, 2}; Transfinite Curve{1} = 3;
side[] = Extrude {0, 0, thickness} { Line{1}; Layers{1}; };
plate[] = Extrude {1, 0, 0} { Surface{side[1]}; Layers{10}; };
Physical Volume("plate") = {plate[1]};
Physical Surface("left") = {side[1]};
Physical Surface("right") = {plate[0]};
eps = 1e-6;
Physical Surface("top") = {Surface In BoundingBox {-eps, -eps, -eps, 1 + eps, depth + eps, eps}};
Physical Surface("bottom") = {Surface In BoundingBox {-eps, -eps, -thickness - eps, 1 + eps, depth + eps, -thickness + eps}};
