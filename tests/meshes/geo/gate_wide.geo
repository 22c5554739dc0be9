// Half of a gate as wide as Antoci's tank, 100 mm: the plane y = 0 is one of symmetry.
width = 0.05; strips = 5;
Include "../../../meshes/gate.geo";
