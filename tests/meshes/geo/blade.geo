// A blade across a current, clamped at its foot: 5 mm thick, 0.2 m high, 40 mm wide, of which the half y > 0; the plane y = 0 is one of symmetry. Metres.
SetFactory("OpenCASCADE");
thickness = 0.005; half = 0.02; height = 0.2; x = -0.5*thickness; e = 1e-6;
Rectangle(1) = {x, 0, 0, thickness, half};
Transfinite Curve{1, 3} = 2; Transfinite Curve{2, 4} = 3; Transfinite Surface{1} Alternate;
made[] = Extrude {0, 0, height} { Surface{1}; Layers{20}; };
root() = Surface In BoundingBox {x - e, -e, -e, x + thickness + e, half + e, e};
middle() = Surface In BoundingBox {x - e, -e, -e, x + thickness + e, e, height + e};
skin() = Boundary {Volume{made[1]};}; skin() -= root(); skin() -= middle();
Physical Volume("solid") = {made[1]};
Physical Surface("root") = {root()};
Physical Surface("skin") = {skin()};
Physical Surface("middle") = {middle()};
