/* sph_loops.h - what the pair loops of every backend see: raw pointers and sizes, no PETSc. `real` is float or double, chosen
   by the table of loops. Results of a loop do not depend on the number of threads. */
#ifndef BY_SPH_LOOPS_H
#define BY_SPH_LOOPS_H

#define SPH_LOOPS_HELD 1   /* a particle whose velocity is prescribed */
#define SPH_PAIR_CHUNK 256 /* particles whose neighbours share one slice of the list: the unit of work of a thread */

#define SPH_IMAGES 7 /* mirrors of a particle: six planes and the nearest surface */

/* cells of edge >= h, x fastest; a particle outside is in the nearest border cell */
typedef struct {
  double lo[3], cell[3];     /* corner and edge of a cell [m]                            */
  int    n[3];               /* cells along each axis                                    */
  int    periodic[3];        /* 1: the first cell follows the last                       */
  double period[3];          /* extent of a periodic axis [m]; 0 = not periodic          */
  int   *start;              /* n[0] n[1] n[2] + 1, first particle of each cell          */
} SPHGrid;

typedef struct {
  int           n;           /* particles                                                */
  int           kernel;      /* SPHKernelType of density                                 */
  int           gradient_kernel; /* SPHKernelType of gradients                           */
  int           capacity;    /* slots per particle, on average over a chunk              */
  double        h, mass;     /* support [m], mass of a particle [kg]                     */
  double        rho0;        /* rest density [kg/m^3]                                    */
  SPHGrid       grid;
  const double *x;           /* n x 3 positions [m], sorted by cell                      */
  int          *cell;        /* n, cell of each particle                                 */
  int          *start;       /* n, first slot of particle i                              */
  int          *count;       /* n, neighbours of i (without i)                           */
  int          *neighbour;   /* n_chunks SPH_PAIR_CHUNK capacity                         */
  void         *gradient;    /* real, 3 per slot: m grad_i W_ij [kg/m^4]                 */
  void         *compact;     /* real, 1 per slot: c_ij of SPHPairLaplacian [kg/m^5]; NULL unless the solver is isph */
  void         *viscous;     /* real, a slot: weight of a pair's viscosity; viscous fluids only */
  void         *near_x;      /* real, 3 x n: positions from the grid's corner, x.. y.. z.. */
  void         *pressure;    /* real, n: p~                                              */
  void         *vector;      /* real, 4 per particle: acceleration or velocity           */
  void         *wall;        /* real, 4 per particle: G_i [kg/m^4]                       */
  const unsigned char *held; /* n, SPH_LOOPS_HELD where pressure moves nothing; or NULL  */
} SPHLoops;


/* A table of loops. Every entry must be filled; status 0 is success. */
typedef struct {
  const char *name;
  int         real_size;                                                         /* bytes of real                        */
  int  (*Pairs)(const SPHLoops *l, double density[]);                            /* lists, gradients, sum_j m W; 1: capacity too small, 2: no memory */
  void (*Move)(const SPHLoops *l, const double x[], double density[]);           /* the same lists: gradients, and sum_j m W, of particles at x (n x 3) */
  void (*Density)(const SPHLoops *l, const double x[], double density[]);        /* sum_j m W alone; gradients stay where they are */
  void (*SetWalls)(const SPHLoops *l, const double G[]);                         /* n x 3 -> wall                        */
  void (*SetPressure)(const SPHLoops *l, const double p[], const double scale[]); /* p scale -> pressure; scale may be NULL */
  void (*SetVelocity)(const SPHLoops *l, const double v[]);                      /* n x 3 -> vector                      */
  void (*Acceleration)(const SPHLoops *l);                                       /* vector = -D^T pressure               */
  void (*GetVector)(const SPHLoops *l, double a[]);                              /* vector -> n x 3                      */
  void (*Rate)(const SPHLoops *l, double factor, const double scale[], double rate[]); /* factor scale D vector          */
  void (*Diagonal)(const SPHLoops *l, double diagonal[]);                        /* of D D^T                             */
  void (*Artificial)(const SPHLoops *l, double mu_over_rho2, double a[]);        /* a += Monaghan's viscous acceleration of vector, approaching pairs alone */
  void (*ViscousWeights)(const SPHLoops *l, int central, double mu, const double volume[]); /* viscous = weights of the pairs, from 1/rho of each particle */
  void (*Viscous)(const SPHLoops *l, int central, const double v[], double a[]); /* a = viscous acceleration of v, n x 3; in double, so that stiff flows lose nothing */
  void (*ViscousDiagonal)(const SPHLoops *l, int central, double diagonal[]);    /* -da_i/dv_i of it, n x 3              */
  void (*Filter)(const SPHLoops *l, double factor, double a[]);                  /* a += factor sum [(v_i - v_j) . g] g of vector */
  /* compact Laplacian and corrected gradients; distance: SPH_IMAGES per particle [m], >= h where there is no wall */
  void (*Compact)(const SPHLoops *l, const double distance[], double moments[], double trace[]); /* -> compact; sum c d d^T (6), its trace with images */
  void (*ScaleCompact)(const SPHLoops *l, const double N[], double diagonal[]);  /* compact_ij *= SPHPairStretch of N (6 per particle); sums of rows */
  void (*Laplacian)(const SPHLoops *l, double factor, const double scale[], double out[]); /* factor scale sum c_ij (p_i - p_j) */
  void (*Difference)(const SPHLoops *l);                                         /* vector = sum (p_j - p_i) m grad W    */
  /* n x 9: sum (v_j - v_i)_a (m grad W)_b of vector; deviation, n x 3 or NULL: sum c_ij (v_i - v_j) / sum c_ij */
  void (*VelocityGradient)(const SPHLoops *l, double gradient[], double deviation[]);
  void (*Concentration)(const SPHLoops *l, double w0, double gradient[]);        /* n x 3: sum weight m grad W           */
  void (*Smooth)(const SPHLoops *l, double factor, double a[]);                  /* a += factor sum (m/rho0) (v_j - v_i) W of vector */
  void (*Repulsion)(const SPHLoops *l, const double x[], double k, double distance, double n, double a[]); /* a -= sum k (W/W(distance))^n m grad W, particles at x */
} SPHLoopTable;

extern const SPHLoopTable SPHLoopsOpenMPSingle, SPHLoopsOpenMPDouble;

#endif
