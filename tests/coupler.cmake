# tests of coupler
