/* sph_open.h - an opening of the fluid's domain, as sph_open.c (what it does) and sph_open_setup.c (how a scene says it) share it. */
#ifndef BY_SPH_OPEN_H
#define BY_SPH_OPEN_H

#include "course.h"
#include "sph_impl.h"

struct _SPHOpening {
  char      name[BY_NAME_MAX];
  PetscBool inlet;                /* particles come out of it; else they go into it                     */
  int       side;                 /* of the domain, 0..5; -1: a tap in the domain                       */
  PetscReal center[3];            /* of the patch [m]                                                   */
  PetscReal n[3], a[3], b[3];     /* unit vectors: along the flow, and across it                        */
  PetscReal half[2];              /* half of the patch along a and b; of a disc the radius, and that which holds its columns [m] */
  PetscBool disc, whole;          /* shape; whole: all of an open side, however far out                 */
  PetscReal length;               /* of the buffer of an inlet, of either zone of an outlet [m]         */
  PetscReal velocity;             /* mean over the patch [m/s]; negative: an outlet that gives pressure */
  int       profile;              /* SPHProfile                                                         */
  int       profile_axis;         /* 0: a, 1: b; -1: the radius of a disc                               */
  PetscReal profile_origin;       /* coordinate of the domain where that of the patch is 0 [m]          */
  PetscReal scale;                /* of a parabola, so that its mean over the columns is one            */
  Course    table, course;        /* of the profile over the coordinate; of all with time               */
  PetscReal pressure, level;      /* downstream of an outlet [Pa], [m] along -gravity                   */
  PetscBool has_level;
  PetscReal volume;               /* that comes out of a tap [m^3]; 0 = no end                          */
  PetscReal count;                /* particles made or taken out since the start                        */

  /* columns of particles in the buffer of an inlet */
  PetscInt   cells[2], n_columns;
  PetscReal  cell[2], step;       /* of a column across, and from particle to particle along it [m]     */
  PetscInt  *column_of;           /* cells[0] x cells[1], or -1                                         */
  PetscReal *column, *last;       /* n_columns x 2 coordinates a, b; s of the last particle             */
};

#endif
