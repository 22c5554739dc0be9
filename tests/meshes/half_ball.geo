// half a ball of radius 0.05 m on the plane z = 0: gmsh -3 -nt 1 -format msh41 -o half_ball.msh, and -order 2 -o half_ball_2.msh
SetFactory("OpenCASCADE");
Sphere(1) = {0, 0, 0, 0.05, 0, Pi/2, 2*Pi};
MeshSize {:} = 0.03;
s() = Boundary { Volume{1}; };
Physical Surface("dome") = {s(0)};
Physical Surface("base") = {s(1)};
Physical Volume("solid") = {1};
