// A plate under a column of water, clamped at both ends: 1 m long, 0.05 m thick, its upper side at z = 0, a slab 0.2 m deep; `fine` times the elements each way. Metres.
SetFactory("OpenCASCADE");
If (!Exists(fine))
  fine = 1;
EndIf
thickness = 0.05; width = 0.2; length = 1; e = 1e-6;
Rectangle(1) = {0, 0, -thickness, length, width};
Transfinite Curve{1, 3} = 20*fine + 1; Transfinite Curve{2, 4} = 2*fine + 1; Transfinite Surface{1} Alternate;
made[] = Extrude {0, 0, thickness} { Surface{1}; Layers{fine}; };
left() = Surface In BoundingBox {-e, -e, -thickness - e, e, width + e, e};
right() = Surface In BoundingBox {length - e, -e, -thickness - e, length + e, width + e, e};
near() = Surface In BoundingBox {-e, -e, -thickness - e, length + e, e, e};
far() = Surface In BoundingBox {-e, width - e, -thickness - e, length + e, width + e, e};
Physical Volume("solid") = {made[1]};
Physical Surface("top") = {Surface In BoundingBox {-e, -e, -e, length + e, width + e, e}};
Physical Surface("ends") = {left(), right()};
Physical Surface("sides") = {near(), far()};
