// A bar of 0.1 x 0.1 m that ends at z = 0: a block of 0.05 m, above a spring of 1 m that stands on the group bottom. All nodes lie in four planes z = const.
// gmsh -3 -nt 1 -format msh41 piston.geo -o piston.msh. Metres.
width = 0.1; block = 0.05; spring = 1; size = 0.05;
Point(1) = {0, 0, -block - spring, size}; Point(2) = {width, 0, -block - spring, size};
Point(3) = {width, width, -block - spring, size}; Point(4) = {0, width, -block - spring, size};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4}; Plane Surface(1) = {1};
Transfinite Curve{1, 2, 3, 4} = 3; Transfinite Surface{1};
lower[] = Extrude {0, 0, spring} { Surface{1}; Layers{2}; };
upper[] = Extrude {0, 0, block} { Surface{lower[0]}; Layers{1}; };
Physical Volume("spring") = {lower[1]};
Physical Volume("block") = {upper[1]};
Physical Surface("bottom") = {1};
Physical Surface("top") = {upper[0]};
