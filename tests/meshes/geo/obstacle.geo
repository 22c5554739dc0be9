// The elastic obstacle of Walhorn et al. 2005: 12 mm thick, 80 mm high, its front at x = 0.292 m, clamped at its foot; a slab 14.6 mm deep. Metres.
SetFactory("OpenCASCADE");
thickness = 0.012; width = 0.0146; height = 0.08; x = 0.292; e = 1e-6;
Rectangle(1) = {x, 0, 0, thickness, width};
Transfinite Curve{1, 3} = 2; Transfinite Curve{2, 4} = 2; Transfinite Surface{1} Alternate;
made[] = Extrude {0, 0, height} { Surface{1}; Layers{10}; };
root() = Surface In BoundingBox {x - e, -e, -e, x + thickness + e, width + e, e};
near() = Surface In BoundingBox {x - e, -e, -e, x + thickness + e, e, height + e};
far() = Surface In BoundingBox {x - e, width - e, -e, x + thickness + e, width + e, height + e};
skin() = Boundary {Volume{made[1]};}; skin() -= root(); skin() -= near(); skin() -= far();
Physical Volume("solid") = {made[1]};
Physical Surface("root") = {root()};
Physical Surface("skin") = {skin()};
Physical Surface("sides") = {near(), far()};
