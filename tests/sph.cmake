# tests of sph
