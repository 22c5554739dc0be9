/* proxy_transfer.c - forces on proxies to the nodes of the surface (method 5.1). */
#include "proxy/proxy_impl.h"

/* Pseudo-inverse times M of a symmetric positive 3x3 matrix: theta = A^+ M. Eigenvalues below 1e-10 of the largest count as zero (all
   nodes on a line: no moment about it can be made). Jacobi rotations. */
static void SolveSymmetric(const double A[9], const double M[3], double theta[3])
{
  double a[9], V[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};

  for (int i = 0; i < 9; i++) a[i] = A[i];
  for (int sweep = 0; sweep < 30; sweep++) {
    for (int p = 0; p < 2; p++) {
      for (int q = p + 1; q < 3; q++) {
        if (a[3*p + q] == 0.0) continue;
        const double tau = (a[4*q] - a[4*p])/(2.0*a[3*p + q]), t = (tau >= 0.0 ? 1.0 : -1.0)/(fabs(tau) + sqrt(1.0 + tau*tau));
        const double c = 1.0/sqrt(1.0 + t*t), s = t*c;
        for (int k = 0; k < 3; k++) {
          const double kp = a[3*k + p], kq = a[3*k + q], vp = V[3*k + p], vq = V[3*k + q];
          a[3*k + p] = c*kp - s*kq, a[3*k + q] = s*kp + c*kq;
          V[3*k + p] = c*vp - s*vq, V[3*k + q] = s*vp + c*vq;
        }
        for (int k = 0; k < 3; k++) {
          const double pk = a[3*p + k], qk = a[3*q + k];
          a[3*p + k] = c*pk - s*qk, a[3*q + k] = s*pk + c*qk;
        }
      }
    }
  }
  const double top = PetscMax(fabs(a[0]), PetscMax(fabs(a[4]), fabs(a[8])));
  for (int i = 0; i < 3; i++) theta[i] = 0.0;
  for (int k = 0; k < 3; k++) {
    const double v[3] = {V[k], V[3 + k], V[6 + k]};
    if (!(a[4*k] > 1e-10*top)) continue;
    for (int i = 0; i < 3; i++) theta[i] += v[i]*Dot3(v, M)/a[4*k];
  }
}

/* moment about c that is still missing: `wanted` about c less that of the nodal forces; f = forces of this call alone */
static void MissingMoment(const Proxy p, const double f[], const double c[3], const double wanted[3], double M[3])
{
  for (int k = 0; k < 3; k++) M[k] = wanted[k];
  for (PetscInt a = 0; a < p->surface.n_nodes; a++) {
    double r[3], m[3];
    Sub3(&p->geometry.x[3*a], c, r);
    Cross3(r, &f[3*a], m);
    for (int k = 0; k < 3; k++) M[k] -= m[k];
  }
}

/* add the self-balanced field f_a += w_a theta x (x_a - c), sum w (x_a - c) = 0: no force, and the moment M about any point */
static void AddCouple(const Proxy p, const double c[3], const double M[3], double f[])
{
  const PetscReal *w = p->node_weight;
  double           A[9] = {0}, theta[3];

  for (PetscInt a = 0; a < p->surface.n_nodes; a++) {
    double r[3];
    if (w[a] == 0.0) continue;
    Sub3(&p->geometry.x[3*a], c, r);
    const double r2 = Dot3(r, r);
    for (int i = 0; i < 3; i++) {
      for (int j = 0; j < 3; j++) A[3*i + j] += w[a]*((i == j ? r2 : 0.0) - r[i]*r[j]);
    }
  }
  SolveSymmetric(A, M, theta);
  for (PetscInt a = 0; a < p->surface.n_nodes; a++) {
    double r[3], d[3];
    if (w[a] == 0.0) continue;
    Sub3(&p->geometry.x[3*a], c, r);
    Cross3(theta, r, d);
    for (int k = 0; k < 3; k++) f[3*a + k] += w[a]*d[k];
  }
}

/*@
  ProxyTransfer - take the forces on proxies to the nodes, keeping total force and moment

  Input Parameters:
+ proxy  - the proxies
. force  - force on each proxy [N], n_proxies x 3
- moment - their moment about the origin as the fluid made it [N m]; NULL: that of the forces at the proxies

  Output Parameter:
. node_force - n_nodes x 3 [N], added to

  Notes:
  Each force goes to the three nodes of its triangle by the proxy's barycentric weights, which are >= 0, so a push stays a push at
  every node. The fluid exerts its forces where the particles are, up to h off the surface, so a couple remains. Letting each force
  act where its line meets the proxy's plane (method 5.1) removes it too, but with affine weights of size (distance off)/(edge
  length): on meshes finer than h they are large, of both signs, and load needle triangles with opposed forces that are pure noise.
  Here the couple of the whole body is added as the rotation field theta x (x_a - x_c) w_a over all surface nodes, w_a the area
  that node a stands for: the smallest such forces in the norm sum |f_a|^2/w_a, exact in force and moment for any mesh. A surface whose
  nodes lie on one line takes no moment about it.

  Cost: O(nodes + proxies).  Tests: tests/unit/proxy/test_transfer.c

.seealso: ProxyGetContacts(), ProxyGetInterpolation()
@*/
PetscErrorCode ProxyTransfer(Proxy p, const PetscReal force[], const PetscReal moment[3], PetscReal node_force[])
{
  PetscReal *f, c[3] = {0, 0, 0}, weight = 0.0, total[3] = {0, 0, 0}, wanted[3] = {0, 0, 0}, M[3], shift[3];

  PetscFunctionBegin;
  PetscCheck(p->setup, PETSC_COMM_SELF, PETSC_ERR_ORDER, "call ProxySetUp() first");
  if (!p->n) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscCalloc1(3*p->surface.n_nodes, &f));
  for (PetscInt b = 0; b < p->n; b++) {
    double m[3];
    for (int i = 0; i < 3; i++) {
      for (int k = 0; k < 3; k++) f[3*p->nodes[3*b + i] + k] += p->weights[3*b + i]*force[3*b + k];
    }
    Cross3(&p->x[3*b], &force[3*b], m);
    for (int k = 0; k < 3; k++) total[k] += force[3*b + k], wanted[k] += m[k];
  }

  // centre of the nodal weights; moments about it, where the numbers are small
  for (PetscInt a = 0; a < p->surface.n_nodes; a++) {
    weight += p->node_weight[a];
    for (int k = 0; k < 3; k++) c[k] += p->node_weight[a]*p->geometry.x[3*a + k];
  }
  for (int k = 0; k < 3; k++) c[k] /= weight;
  if (moment) {
    for (int k = 0; k < 3; k++) wanted[k] = moment[k];
  }
  Cross3(c, total, shift);
  for (int k = 0; k < 3; k++) wanted[k] -= shift[k];

  // the second round removes what the first left by round-off
  for (int round = 0; round < 2; round++) {
    MissingMoment(p, f, c, wanted, M);
    AddCouple(p, c, M, f);
  }
  for (PetscInt i = 0; i < 3*p->surface.n_nodes; i++) node_force[i] += f[i];
  PetscCall(PetscFree(f));
  PetscFunctionReturn(PETSC_SUCCESS);
}
