// A hare of ellipsoids, 0.21 m high, sitting on z = 0: flat base, round back, sharp ears.
// gmsh -3 -nt 1 -format msh41 hare.geo -o hare.msh        about 2,000 tetrahedra. Metres.
SetFactory("OpenCASCADE");
Sphere(1) = {0, 0, 0.045, 0.055};                        // body
Dilate {{0, 0, 0.045}, {1.4, 1.0, 1.1}} { Volume{1}; }
Sphere(2) = {0.055, 0, 0.11, 0.034};                     // head
Dilate {{0.055, 0, 0.11}, {1.15, 1.0, 1.0}} { Volume{2}; }
For k In {0:1}                                           // ears
  Sphere(3 + k) = {0, 0, 0, 0.04};
  Dilate {{0, 0, 0}, {0.42, 0.28, 1.0}} { Volume{3 + k}; }
  Rotate {{0, 1, 0}, {0, 0, 0}, -0.35} { Volume{3 + k}; }
  Rotate {{1, 0, 0}, {0, 0, 0}, 0.3 - 0.6 * k} { Volume{3 + k}; }
  Translate {0.03, -0.02 + 0.04 * k, 0.165} { Volume{3 + k}; }
EndFor
Sphere(5) = {-0.075, 0, 0.035, 0.016};                   // tail
BooleanUnion(10) = { Volume{1}; Delete; }{ Volume{2:5}; Delete; };
Box(11) = {-0.2, -0.2, -0.1, 0.4, 0.4, 0.1};             // what is below the floor
BooleanDifference(12) = { Volume{10}; Delete; }{ Volume{11}; Delete; };
base() = Surface In BoundingBox {-0.2, -0.2, -1e-4, 0.2, 0.2, 1e-4};
all() = Boundary { Volume{12}; };
skin() = all();
skin() -= base();
Physical Volume("solid") = {12};
Physical Surface("base") = {base()};
Physical Surface("skin") = {skin()};
Mesh.MeshSizeMin = 0.015; Mesh.MeshSizeMax = 0.015;
Mesh.Algorithm = 6; Mesh.Algorithm3D = 1; Mesh.OptimizeThreshold = 0.5;
