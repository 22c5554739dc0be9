// Antoci's gate: rubber, 5 mm thick, 79 mm high, held at its upper end, with the rigid wall above it; a slab `width` deep, x from 0.1 m.
// gmsh -3 -nt 1 -order 2 -format msh41 gate.geo -o gate.msh        288 quadratic tetrahedra. Metres.
SetFactory("OpenCASCADE");
If (!Exists(width))
  width = 0.01; strips = 2;
EndIf
thickness = 0.005; length = 0.079; top = 0.17; x = 0.1; e = 1e-6;
Rectangle(1) = {x, 0, 0, thickness, width};
Transfinite Curve{1, 3} = 2; Transfinite Curve{2, 4} = strips + 1; Transfinite Surface{1} Alternate;
lower[] = Extrude {0, 0, length} { Surface{1}; Layers{16}; };
upper[] = Extrude {0, 0, top - length} { Surface{lower[0]}; Layers{8}; };
front() = Surface In BoundingBox {x - e, -e, -e, x + e, width + e, top + e};
back() = Surface In BoundingBox {x + thickness - e, -e, -e, x + thickness + e, width + e, top + e};
end() = Surface In BoundingBox {x - e, -e, -e, x + thickness + e, width + e, e};
near() = Surface In BoundingBox {x - e, -e, -e, x + thickness + e, e, top + e};
far() = Surface In BoundingBox {x - e, width - e, -e, x + thickness + e, width + e, top + e};
Physical Volume("gate") = {lower[1]};
Physical Volume("wall") = {upper[1]};
Physical Surface("skin") = {front(), back(), end()};
Physical Surface("near") = {near()};
Physical Surface("far") = {far()};
