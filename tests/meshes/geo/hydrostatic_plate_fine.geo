// The plate under a column of water with elements half as large.
fine = 2;
Include "hydrostatic_plate.geo";
