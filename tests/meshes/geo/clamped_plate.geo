// A plate of 1 x 0.2 x 0.1 m beneath z = 0 between x = 0 and 1, with 0.1 m more at either end to be clamped: groups left and right.
// gmsh -3 -nt 1 -order 2 -format msh41 clamped_plate.geo -o clamped_plate.msh. Metres.
depth = 0.2; thickness = 0.1; size = 0.1;
Point(1) = {-0.1, 0, -thickness, size}; Point(2) = {-0.1, depth, -thickness, size};
Line(1) = {1, 2}; Transfinite Curve{1} = 3;
lower[] = Extrude {0, 0, thickness} { Line{1}; Layers{1}; };
left[] = Extrude {0.1, 0, 0} { Surface{lower[1]}; Layers{1}; };
middle[] = Extrude {1, 0, 0} { Surface{left[0]}; Layers{10}; };
right[] = Extrude {0.1, 0, 0} { Surface{middle[0]}; Layers{1}; };
Physical Volume("plate") = {middle[1]};
Physical Volume("left") = {left[1]};
Physical Volume("right") = {right[1]};
eps = 1e-6;
top() = Surface In BoundingBox {-0.1 - eps, -eps, -eps, 1.1 + eps, depth + eps, eps};
Physical Surface("top") = {top()};
bottom() = Surface In BoundingBox {-eps, -eps, -thickness - eps, 1 + eps, depth + eps, -thickness + eps};
Physical Surface("bottom") = {bottom()};
