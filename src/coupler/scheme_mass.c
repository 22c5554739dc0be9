/* scheme_mass.c - added mass inside the pressure solve (method 5.3), for flexible bodies.

   Over a step dt the body answers a change of its nodal forces f with a change of its mean velocity z. For a rigid body of mass M that is
   z = dt/2 f/M, whatever the number of substeps (velocity Verlet). For an elastic one, mode by mode with theta = omega dt, the exact
   answer is z = dt (1 - cos theta)/(M theta^2) f; the operator

       z = S f,   (M + beta dt^2 K) z = dt/2 f

   follows it: at beta = 1/4, the trapezoidal rule, it is exact at low theta and the envelope 2/(M theta^2) of the exact answer at high. Measured
   on a block of water that hits a soft light ball (tests/conservation/free_body.yaml): largest compression of the water 17, 11, 2.7, 5 %
   at beta = 1/12, 1/6, 1/4, 1/2, against 1.8 % when the step is repeated until solid and response agree (coupler.passes); the gain of
   energy by the splitting is 4, 3, -1.5, 1 % against -1.5 %.
   It replaces the nodal or impedance mass m_R of method 5.3 by the body's own stiffness K (TLEDResponse()), so that every interface
   shape has its own added-mass balance. With g_ib the boundary gradient of particle i that belongs to proxy b, N_ba the proxy's barycentric
   weights, the nodal force is f_a = sum_b N_ba sum_i m p~_i g_ib, and the wall's answer adds

       (A p~)_i += dt sum_b g_ib . sum_a N_ba z_a

   to the pressure equation: symmetric and positive, so conjugate gradients go on working. */
#include "coupler_impl.h"
#include "mat3.h"

/* y = P x of a node; P NULL: all directions are free */
static void Free(const PetscReal P[9], const PetscReal x[3], PetscReal y[3])
{
  for (int i = 0; i < 3; i++) y[i] = P ? Dot3(&P[3 * i], x) : x[i];
}

/* a block of rows of node a and columns of node b: P_a B P_b; at entries line[i][j] */
static void ProjectBlock(const PetscReal P_a[9], const PetscReal P_b[9], PetscScalar *line[3])
{
  PetscReal half[9], column[3], to[3];

  for (int i = 0; i < 3; i++) Free(P_b, line[i], &half[3 * i]); /* P_b is symmetric */
  for (int j = 0; j < 3; j++) {
    for (int i = 0; i < 3; i++) column[i] = half[3 * i + j];
    Free(P_a, column, to);
    for (int i = 0; i < 3; i++) line[i][j] = to[i];
  }
}

/* held directions answer nothing: A_ab <- P_a A_ab P_b + (I - P_a) m_a for a = b. Each row of blocks of three has the same columns. */
static PetscErrorCode ProjectConstrained(CouplerSurface *s, const PetscReal mass[], Mat A)
{
  const PetscInt  *row, *column;
  const PetscReal *P_a, *P_b;
  PetscScalar     *value;
  PetscInt         n;
  PetscBool        done;

  PetscFunctionBegin;
  PetscCall(MatGetRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &n, &row, &column, &done));
  PetscCheck(done, PETSC_COMM_SELF, PETSC_ERR_SUP, "the response's matrix does not tell its pattern");
  PetscCall(MatSeqAIJGetArray(A, &value));
  for (PetscInt a = 0; a < s->n_nodes; a++) {
    PetscCall(TLEDGetProjector(s->tled, a, &P_a));
    for (PetscInt k = 0; k < row[3 * a + 1] - row[3 * a]; k += 3) {
      const PetscInt b       = column[row[3 * a] + k] / 3;
      PetscScalar   *line[3] = {&value[row[3 * a] + k], &value[row[3 * a + 1] + k], &value[row[3 * a + 2] + k]};

      PetscCall(TLEDGetProjector(s->tled, b, &P_b));
      if (P_a || P_b) ProjectBlock(P_a, P_b, line);
      for (int i = 0; i < 9 && P_a && a == b; i++) line[i / 3][i % 3] += mass[a] * ((i % 4 ? 0.0 : 1.0) - P_a[i]);
    }
  }
  PetscCall(MatSeqAIJRestoreArray(A, &value));
  PetscCall(MatRestoreRowIJ(A, 0, PETSC_FALSE, PETSC_FALSE, &n, &row, &column, &done));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode CreateSolver(CouplerSurface *s)
{
  CouplerResponse *r = &s->response;
  PC               pc;
  char             prefix[BY_NAME_MAX + 16];

  PetscFunctionBegin;
  PetscCall(MatDuplicate(r->tangent, MAT_DO_NOT_COPY_VALUES, &r->matrix));
  PetscCall(MatSetOption(r->matrix, MAT_SPD, PETSC_TRUE));
  PetscCall(MatSetOption(r->matrix, MAT_KEEP_NONZERO_PATTERN, PETSC_TRUE));
  PetscCall(MatCreateVecs(r->matrix, &r->solution, &r->rhs));
  PetscCall(KSPCreate(PETSC_COMM_SELF, &r->ksp));
  PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "%s_response_", s->name));
  PetscCall(KSPSetOptionsPrefix(r->ksp, prefix));
  PetscCall(KSPSetType(r->ksp, KSPPREONLY));
  PetscCall(KSPGetPC(r->ksp, &pc));
  PetscCall(PCSetType(pc, PCCHOLESKY));
  PetscCall(PCFactorSetMatOrderingType(pc, MATORDERINGND));
  PetscCall(PCFactorSetShiftType(pc, MAT_SHIFT_POSITIVE_DEFINITE));
  PetscCall(KSPSetFromOptions(r->ksp));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* matrix of the response for a step dt about the displacement r->at */
PetscErrorCode CouplerResponseMake(Coupler c, CouplerSurface *s, PetscReal dt)
{
  CouplerResponse *r = &s->response;
  const PetscReal *mass;
  Vec              U;

  PetscFunctionBegin;
  PetscCall(VecCreateSeqWithArray(PETSC_COMM_SELF, 3, 3 * s->n_nodes, r->at, &U));
  PetscCall(TLEDResponse(s->tled, U, &r->tangent));
  PetscCall(VecDestroy(&U));
  if (!r->ksp) PetscCall(CreateSolver(s));
  PetscCall(MatCopy(r->tangent, r->matrix, SAME_NONZERO_PATTERN));
  PetscCall(MatScale(r->matrix, c->params.response_beta * dt * dt));
  PetscCall(TLEDGetMass(s->tled, &mass));
  for (PetscInt i = 0; i < 3 * s->n_nodes; i++) PetscCall(MatSetValue(r->matrix, i, i, mass[i / 3], ADD_VALUES));
  PetscCall(MatAssemblyBegin(r->matrix, MAT_FINAL_ASSEMBLY));
  PetscCall(MatAssemblyEnd(r->matrix, MAT_FINAL_ASSEMBLY));
  PetscCall(ProjectConstrained(s, mass, r->matrix));
  PetscCall(KSPSetOperators(r->ksp, r->matrix, r->matrix));
  PetscCall(KSPSetUp(r->ksp));
  r->dt = r->dt_step = dt;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* What forces do to the mean velocity over that of held ones: those that are linear in time over n substeps come later, and their way is shorter by the first
   moment of their change */
static PetscErrorCode SetShare(Coupler c, CouplerSurface *s, PetscReal dt)
{
  PetscInt n = 1;

  PetscFunctionBegin;
  if (c->params.forces == COUPLER_FORCES_INTERPOLATED) ByCall(TLEDGetSubsteps(s->tled, dt, &n));
  s->response.share = 1.0 - (1.0 - 1.0 / ((PetscReal)n * (PetscReal)n)) / 3.0 * dt / (dt + (c->dt > 0.0 ? c->dt : dt));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* matrix of the response for the current state and step; made again when the step or the body has changed */
PetscErrorCode CouplerResponseSetUp(Coupler c, CouplerSurface *s, PetscReal dt)
{
  CouplerResponse *r = &s->response;
  const PetscReal *u;
  Vec              U, V, F;

  PetscFunctionBegin;
  ByCall(SetShare(c, s, dt));
  r->dt_step = dt;
  if (r->dt > 0.0 && PetscAbsReal(dt / r->dt - 1.0) < 0.05 && r->age++ < c->params.response_every) PetscFunctionReturn(PETSC_SUCCESS);
  if (!r->at) PetscCall(PetscMalloc1(3 * s->n_nodes, &r->at));
  PetscCall(TLEDGetVectors(s->tled, &U, &V, &F));
  PetscCall(VecGetArrayRead(U, &u));
  PetscCall(PetscArraycpy(r->at, u, 3 * s->n_nodes));
  PetscCall(VecRestoreArrayRead(U, &u));
  PetscCall(CouplerResponseMake(c, s, dt));
  r->age = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* velocity = S force, both n_nodes x 3; zero in held directions */
PetscErrorCode CouplerResponseSolve(CouplerSurface *s, const PetscReal force[], PetscReal velocity[])
{
  CouplerResponse *r = &s->response;
  const PetscReal *z, *P;
  PetscReal       *b;

  PetscFunctionBegin;
  PetscCall(VecGetArrayWrite(r->rhs, &b));
  for (PetscInt a = 0; a < s->n_nodes; a++) {
    PetscCall(TLEDGetProjector(s->tled, a, &P));
    Free(P, &force[3 * a], &b[3 * a]);
    for (int k = 0; k < 3; k++) b[3 * a + k] *= 0.5 * r->dt_step * r->share;
  }
  PetscCall(VecRestoreArrayWrite(r->rhs, &b));
  PetscCall(KSPSolve(r->ksp, r->rhs, r->solution));
  PetscCall(VecGetArrayRead(r->solution, &z));
  PetscCall(PetscArraycpy(velocity, z, 3 * s->n_nodes));
  PetscCall(VecRestoreArrayRead(r->solution, &z));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* For the couple of a transfer (ProxyTransfer()): sum over the pairs of each touched particle of (x_i - x_b) x share, in s->arm */
PetscErrorCode CouplerArms(Coupler c, PetscInt k)
{
  CouplerSurface    *s = &c->surface[k];
  const SPHContacts *q = &c->contacts[k];

  PetscFunctionBegin;
  if (q->n_touched > s->n_arms) {
    s->n_arms = q->n_touched + q->n_touched / 2;
    PetscCall(PetscFree(s->arm));
    PetscCall(PetscMalloc1(3 * s->n_arms, &s->arm));
  }
  for (PetscInt t = 0; t < q->n_touched; t++) {
    PetscReal *arm = s->arm + 3 * t;

    for (int i = 0; i < 3; i++) arm[i] = 0.0;
    for (PetscInt j = q->start[t]; j < q->start[t + 1]; j++) {
      double r[3], m[3];

      Sub3(q->position + 3 * t, q->place + 3 * q->proxy[j], r);
      Cross3(r, q->share + 3 * j, m);
      for (int i = 0; i < 3; i++) arm[i] += m[i];
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* nodal forces of the pressures p~ on one surface, in s->answer; proxy_work is scratch */
static PetscErrorCode ForcesFromPressure(Coupler c, PetscInt k, const PetscReal p[], const PetscReal factor[])
{
  CouplerSurface    *s = &c->surface[k];
  const SPHContacts *q = &c->contacts[k];
  PetscReal          moment[3] = {0, 0, 0};

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(s->proxy_work, 3 * q->n_proxies));
  for (PetscInt t = 0; t < q->n_touched; t++) {
    const PetscReal scale = c->mass * p[q->particle[t]] * c->rest_density * factor[t];

    if (scale == 0.0) continue;
    for (int i = 0; i < 3; i++) moment[i] += scale * s->arm[3 * t + i];
    for (PetscInt j = q->start[t]; j < q->start[t + 1]; j++) {
      for (int i = 0; i < 3; i++) s->proxy_work[3 * q->proxy[j] + i] += scale * q->share[3 * j + i];
    }
  }
  PetscCall(PetscArrayzero(s->answer, 3 * s->n_nodes));
  PetscCall(ProxyForcesToNodes(s->proxy, s->proxy_work, s->answer));
  PetscCall(ProxyAddCouple(s->proxy, moment, s->answer));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Ap_i += dt sum_b g_ib . (v_b + rotation x (x_i - x_b)) with the velocities of s->answer: the transpose of ForcesFromPressure() */
static PetscErrorCode AddWallRate(Coupler c, PetscInt k, const PetscReal factor[], PetscReal Ap[])
{
  CouplerSurface    *s = &c->surface[k];
  const SPHContacts *q = &c->contacts[k];
  PetscReal          rotation[3];

  PetscFunctionBegin;
  PetscCall(ProxyGetRotation(s->proxy, s->answer, rotation));
  PetscCall(ProxyVelocitiesFromNodes(s->proxy, s->answer, s->proxy_work));
  for (PetscInt t = 0; t < q->n_touched; t++) {
    PetscReal rate = Dot3(rotation, s->arm + 3 * t);

    for (PetscInt j = q->start[t]; j < q->start[t + 1]; j++) {
      for (int i = 0; i < 3; i++) rate += q->share[3 * j + i] * s->proxy_work[3 * q->proxy[j] + i];
    }
    Ap[q->particle[t]] += s->response.dt_step * c->rest_density * factor[t] * rate;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* SPHResponse of all bodies */
PetscErrorCode CouplerResponseApply(void *ctx, PetscInt n, const PetscReal p[], PetscReal Ap[])
{
  Coupler c = (Coupler)ctx;

  PetscFunctionBegin;
  (void)n;
  for (PetscInt k = 0; k < c->n_bodies; k++) {
    CouplerSurface  *s = &c->surface[k];
    const PetscReal *factor;

    if (!s->answers) continue;
    PetscCall(SPHGetUnionFactors(c->sph, k, &factor));
    PetscCall(ForcesFromPressure(c, k, p, factor));
    PetscCall(CouplerResponseSolve(s, s->answer, s->answer));
    PetscCall(AddWallRate(c, k, factor, Ap));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode CouplerResponseDestroy(CouplerResponse *r)
{
  PetscFunctionBegin;
  PetscCall(MatDestroy(&r->tangent));
  PetscCall(MatDestroy(&r->matrix));
  PetscCall(KSPDestroy(&r->ksp));
  PetscCall(VecDestroy(&r->rhs));
  PetscCall(VecDestroy(&r->solution));
  PetscCall(PetscFree(r->at));
  PetscFunctionReturn(PETSC_SUCCESS);
}
