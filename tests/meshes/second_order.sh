#!/bin/sh
# second_order.sh BODY.msh OUT.msh - the same mesh with quadratic tetrahedra: vertices and elements stay, straight edges get a node each.
# How beam_h1_order2.msh and cook_h1_order2.msh were made; gmsh 4.8.4.
[ $# = 2 ] || { echo "usage: $0 BODY.msh OUT.msh" >&2; exit 2; }
exec gmsh "$1" -3 -order 2 -nt 1 -format msh41 -o "$2"
