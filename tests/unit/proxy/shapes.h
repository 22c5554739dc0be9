/* shapes.h - triangle surfaces made here: plate, box, sphere, cylinder, torus; outward. */
#ifndef BY_SHAPES_H
#define BY_SHAPES_H

#include <math.h>
#include <stdlib.h>
#include <string.h>

typedef struct {
  int     n_nodes, n_triangles;
  double *x;
  int    *triangles;
} Shape;

static inline Shape ShapeAllocate(int n_nodes, int n_triangles)
{
  Shape s = {0, 0, NULL, NULL};
  s.x         = (double *)calloc(3*(size_t)n_nodes, sizeof(double));
  s.triangles = (int *)calloc(3*(size_t)n_triangles, sizeof(int));
  return s;
}
static inline void ShapeFree(Shape *s)
{
  free(s->x);
  free(s->triangles);
}
static inline int ShapeNode(Shape *s, double x, double y, double z)
{
  double *p = &s->x[3*s->n_nodes];
  p[0] = x, p[1] = y, p[2] = z;
  return s->n_nodes++;
}
static inline void ShapeTriangle(Shape *s, int a, int b, int c)
{
  int *t = &s->triangles[3*s->n_triangles++];
  t[0] = a, t[1] = b, t[2] = c;
}

/* nodes at the same place (within tol) become one */
static inline void ShapeWeld(Shape *s, double tol)
{
  int *map = (int *)malloc(sizeof(int)*(size_t)s->n_nodes), n = 0;
  for (int i = 0; i < s->n_nodes; i++) {
    int j = 0;
    while (j < n && !(fabs(s->x[3*i] - s->x[3*j]) < tol && fabs(s->x[3*i + 1] - s->x[3*j + 1]) < tol && fabs(s->x[3*i + 2] - s->x[3*j + 2]) < tol)) j++;
    if (j == n) {
      memmove(&s->x[3*n], &s->x[3*i], 3*sizeof(double));
      n++;
    }
    map[i] = j;
  }
  for (int i = 0; i < 3*s->n_triangles; i++) s->triangles[i] = map[s->triangles[i]];
  s->n_nodes = n;
  free(map);
}

/* plate [-a, a] x [-b, b] at z = 0, normal +z, n x m cells; `twist` moves inner nodes in the plane so that no two triangles are alike */
static inline Shape ShapePlate(double a, double b, int n, int m, double twist)
{
  Shape s = ShapeAllocate((n + 1)*(m + 1), 2*n*m);
  for (int j = 0; j <= m; j++) {
    for (int i = 0; i <= n; i++) {
      const double in = i > 0 && i < n && j > 0 && j < m ? twist : 0.0;
      ShapeNode(&s, a*(2.0*(i + in*sin(3.1*i + 1.7*j))/n - 1.0), b*(2.0*(j + in*sin(1.3*i - 2.9*j))/m - 1.0), 0.0);
    }
  }
  for (int j = 0; j < m; j++) {
    for (int i = 0; i < n; i++) {
      const int k = j*(n + 1) + i;
      ShapeTriangle(&s, k, k + 1, k + n + 2);
      ShapeTriangle(&s, k, k + n + 2, k + n + 1);
    }
  }
  return s;
}

/* box [-a, a] x [-b, b] x [-c, c] with na x nb x nc cells along the axes */
static inline Shape ShapeBox(double a, double b, double c, int na, int nb, int nc)
{
  const double half[3] = {a, b, c};
  const int    n[3] = {na, nb, nc}, cells = 2*(na*nb + nb*nc + nc*na);
  Shape        s = ShapeAllocate(2*((na + 1)*(nb + 1) + (nb + 1)*(nc + 1) + (nc + 1)*(na + 1)), 2*cells);
  for (int axis = 0; axis < 3; axis++) {
    const int u = (axis + 1)%3, v = (axis + 2)%3;
    for (int side = -1; side <= 1; side += 2) {
      const int first = s.n_nodes;
      for (int j = 0; j <= n[v]; j++) {
        for (int i = 0; i <= n[u]; i++) {
          double p[3];
          p[axis] = side*half[axis];
          p[u]    = half[u]*(2.0*i/n[u] - 1.0);
          p[v]    = half[v]*(2.0*j/n[v] - 1.0);
          ShapeNode(&s, p[0], p[1], p[2]);
        }
      }
      for (int j = 0; j < n[v]; j++) {
        for (int i = 0; i < n[u]; i++) {
          const int k = first + j*(n[u] + 1) + i, w = n[u] + 1;
          if (side > 0) ShapeTriangle(&s, k, k + 1, k + w + 1), ShapeTriangle(&s, k, k + w + 1, k + w);
          else ShapeTriangle(&s, k, k + w + 1, k + 1), ShapeTriangle(&s, k, k + w, k + w + 1);
        }
      }
    }
  }
  ShapeWeld(&s, 1e-9*(a + b + c));
  return s;
}

/* sphere of radius R about the origin: the icosahedron's faces split into n^2, pushed out */
static inline Shape ShapeSphere(double R, int n)
{
  static const int faces[20][3] = {{0, 11, 5}, {0, 5, 1}, {0, 1, 7}, {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                   {3, 9, 4}, {3, 4, 2}, {3, 2, 6}, {3, 6, 8}, {3, 8, 9}, {4, 9, 5}, {2, 4, 11}, {6, 2, 10}, {8, 6, 7}, {9, 8, 1}};
  const double     g = 0.5*(1.0 + sqrt(5.0));
  const double     corner[12][3] = {{-1, g, 0}, {1, g, 0}, {-1, -g, 0}, {1, -g, 0}, {0, -1, g}, {0, 1, g}, {0, -1, -g}, {0, 1, -g}, {g, 0, -1}, {g, 0, 1}, {-g, 0, -1}, {-g, 0, 1}};
  Shape            s = ShapeAllocate(10*(n + 1)*(n + 2), 20*n*n);
  for (int f = 0; f < 20; f++) {
    const double *a = corner[faces[f][0]], *b = corner[faces[f][1]], *c = corner[faces[f][2]];
    const int     first = s.n_nodes;
    for (int i = 0; i <= n; i++) {
      for (int j = 0; j <= n - i; j++) {
        double p[3], l = 0.0;
        for (int k = 0; k < 3; k++) p[k] = ((n - i - j)*a[k] + i*b[k] + j*c[k])/n, l += p[k]*p[k];
        l = R/sqrt(l);
        ShapeNode(&s, l*p[0], l*p[1], l*p[2]);
      }
    }
    for (int i = 0, row = first; i < n; i++) {
      const int next = row + n - i + 1;
      for (int j = 0; j < n - i; j++) {
        ShapeTriangle(&s, row + j, next + j, row + j + 1);
        if (j < n - i - 1) ShapeTriangle(&s, row + j + 1, next + j, next + j + 1);
      }
      row = next;
    }
  }
  ShapeWeld(&s, 1e-6*R);
  return s;
}

/* closed cylinder of radius R along z from -L/2 to L/2: n around, m along, caps as rings */
static inline Shape ShapeCylinder(double R, double L, int n, int m)
{
  const int rings = n/6 > 0 ? n/6 : 1;
  Shape     s = ShapeAllocate(n*(m + 1) + 2*(n*rings + 1), 2*n*m + 4*n*rings);
  for (int j = 0; j <= m; j++) {
    for (int i = 0; i < n; i++) ShapeNode(&s, R*cos(2.0*M_PI*i/n), R*sin(2.0*M_PI*i/n), L*((double)j/m - 0.5));
  }
  for (int j = 0; j < m; j++) {
    for (int i = 0; i < n; i++) {
      const int a = j*n + i, b = j*n + (i + 1)%n;
      ShapeTriangle(&s, a, b, b + n);
      ShapeTriangle(&s, a, b + n, a + n);
    }
  }
  for (int side = 0; side < 2; side++) {
    int outer = side ? m*n : 0;
    for (int r = rings - 1; r >= 0; r--) {
      const int    inner = s.n_nodes;
      const double z = L*(side - 0.5);
      for (int i = 0; i < (r ? n : 1); i++) ShapeNode(&s, R*r/rings*cos(2.0*M_PI*i/n), R*r/rings*sin(2.0*M_PI*i/n), z);
      for (int i = 0; i < n; i++) {
        const int a = outer + i, b = outer + (i + 1)%n, c = r ? inner + i : inner, d = r ? inner + (i + 1)%n : inner;
        if (side) ShapeTriangle(&s, a, b, d);
        else ShapeTriangle(&s, a, d, b);
        if (r && side) ShapeTriangle(&s, a, d, c);
        if (r && !side) ShapeTriangle(&s, a, c, d);
      }
      outer = inner;
    }
  }
  return s;
}

/* torus about z, radii R and r */
static inline Shape ShapeTorus(double R, double r, int n, int m)
{
  Shape s = ShapeAllocate(n*m, 2*n*m);
  for (int i = 0; i < n; i++) {
    for (int j = 0; j < m; j++) {
      const double u = 2.0*M_PI*i/n, v = 2.0*M_PI*j/m;
      ShapeNode(&s, (R + r*cos(v))*cos(u), (R + r*cos(v))*sin(u), r*sin(v));
    }
  }
  for (int i = 0; i < n; i++) {
    for (int j = 0; j < m; j++) {
      const int a = i*m + j, b = ((i + 1)%n)*m + j, c = ((i + 1)%n)*m + (j + 1)%m, d = i*m + (j + 1)%m;
      ShapeTriangle(&s, a, b, c);
      ShapeTriangle(&s, a, c, d);
    }
  }
  return s;
}

/* enclosed volume */
static inline double ShapeVolume(const Shape *s)
{
  double v = 0.0;
  for (int t = 0; t < s->n_triangles; t++) {
    const double *a = &s->x[3*s->triangles[3*t]], *b = &s->x[3*s->triangles[3*t + 1]], *c = &s->x[3*s->triangles[3*t + 2]];
    v += (a[0]*(b[1]*c[2] - b[2]*c[1]) + a[1]*(b[2]*c[0] - b[0]*c[2]) + a[2]*(b[0]*c[1] - b[1]*c[0]))/6.0;
  }
  return v;
}

#endif
