/* tled_viscous.c - materials with a Prony series: their histories, the mode in which forces are asked for, and the stress of a pack of
   elements. The formulas are in tled_prony.h.

   The history of an integration point is S_iso(old), then h_i of each term, six numbers each, lane beside lane. */
#include "tled/tled_lanes.h"

/*
  TLEDViscousSetUp_Private - histories for the elements whose material has a Prony series, at rest; nothing for a body that has none
*/
PetscErrorCode TLEDViscousSetUp_Private(TLED tled)
{
  const TLEDBlocks *b = &tled->blocks;
  TLEDLoops        *w = &tled->loops;
  size_t            n = 0;

  PetscFunctionBegin;
  for (PetscInt k = 0; k < tled->n_materials; k++) w->viscous = w->viscous || tled->laws[k].n_prony;
  if (!w->viscous) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(b->n_packs, &w->history_offset));
  for (int pack = 0; pack < b->n_packs; pack++) {
    const int n_prony       = tled->laws[b->material[pack]].n_prony;
    w->history_offset[pack] = n;
    n += n_prony ? (size_t)(6 * L * b->n_points * (1 + n_prony)) : 0;
  }
  tled->n_history = (PetscInt)n;
  PetscCall(PetscCalloc3(n, &w->history, n, &tled->saved_history, tled->n_materials, &w->prony));
  TLEDSetViscous_Private(tled, TLED_VISCOUS_STEP, 0.0);
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode TLEDViscousDestroy_Private(TLED tled)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(tled->loops.history_offset));
  PetscCall(PetscFree3(tled->loops.history, tled->saved_history, tled->loops.prony));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  TLEDSetViscous_Private - in which mode forces, energies and stiffnesses of viscous materials are meant from now on

  Input Parameters:
+ mode - TLED_VISCOUS_INSTANT: the elastic law, without histories; TLED_VISCOUS_STEP: a step dt after the last commit;
         TLED_VISCOUS_COMMIT: the same, and the forces' displacement becomes the new state of the histories
- dt   - [s]; 0: a jump; PETSC_MAX_REAL: everything has relaxed, the law of statics

  The mode between calls of the public functions is a step of dt = 0. Of no effect for a body without Prony series.
*/
void TLEDSetViscous_Private(TLED tled, TLEDViscousMode mode, PetscReal dt)
{
  TLEDLoops *w = &tled->loops;

  if (!w->viscous) return;
  w->viscous_mode = mode;
  for (int k = 0; k < w->n_laws; k++) TLEDPronyFactors(&w->laws[k], dt, &w->prony[k]);
}

/*
  TLEDCommitViscous_Private - the histories go on by a step dt that ended at displacement u; a body that has none is left alone

  Errors: BY_ERR_BREAKDOWN, not reported, when an element of u is inverted
*/
PetscErrorCode TLEDCommitViscous_Private(TLED tled, const PetscReal u[], PetscReal dt)
{
  PetscErrorCode ierr;

  PetscFunctionBegin;
  if (!tled->loops.viscous) PetscFunctionReturn(PETSC_SUCCESS);
  TLEDSetViscous_Private(tled, TLED_VISCOUS_COMMIT, dt);
  ierr = TLEDForces_Private(tled, u, tled->trial);
  TLEDSetViscous_Private(tled, TLED_VISCOUS_STEP, 0.0);
  ByCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const double *History(const TLEDLoops *w, int pack, int point)
{
  return w->history + w->history_offset[pack] + 6 * L * (1 + w->laws[w->blocks->material[pack]].n_prony) * point;
}

/* law of a lane's integration point as the mode has it */
void TLEDLocalLawAt_Private(const TLEDLoops *w, int lane, int point, TLEDLocalLaw *m)
{
  const int pack = lane / L, l = lane % L, material = w->blocks->material[pack];

  m->law   = &w->laws[material];
  m->relax = 0.0;
  for (int k = 0; k < 6; k++) m->past[k] = 0.0;
  for (int k = 0; k < 3; k++) m->fibre[k] = w->blocks->fibre ? w->blocks->fibre[(3 * pack + k) * L + l] : 0.0;
  if (!m->law->n_prony || w->viscous_mode == TLED_VISCOUS_INSTANT) return;
  const double        *history = History(w, pack, point);
  const TLEDPronyStep *s       = &w->prony[material];
  for (int i = 0; i < m->law->n_prony; i++) {
    m->relax += m->law->alpha[i] * (s->gain[i] - 1.0);
    for (int k = 0; k < 6; k++)
      m->past[k] += m->law->alpha[i] * (s->keep[i] * history[(6 * (i + 1) + k) * L + l] - s->gain[i] * history[k * L + l]);
  }
}

/* stored energy [J/m^3] of a lane's integration point as the mode has it */
double TLEDLocalEnergy_Private(const TLEDLoops *w, int lane, int point, const TLEDLocalLaw *m, const double H[9])
{
  const int            pack = lane / L, l = lane % L;
  const double         inv_J = 1.0 / (1.0 + TLEDJacobianMinusOne(H));
  double               energy = TLEDEnergy(m->law, m->fibre, H), S[6], h[6], Hbar[9];

  if (!m->law->n_prony || w->viscous_mode == TLED_VISCOUS_INSTANT) return energy;
  const double        *history = History(w, pack, point);
  const TLEDPronyStep *s       = &w->prony[w->blocks->material[pack]];
  TLEDIsochoricStress(m->law, m->fibre, H, inv_J, S);
  (void)TLEDShapeGradient(H, inv_J, Hbar);
  const double W_iso = TLEDEnergy(m->law, m->fibre, Hbar);
  for (int i = 0; i < m->law->n_prony; i++) {
    for (int k = 0; k < 6; k++) h[k] = s->keep[i] * history[(6 * (i + 1) + k) * L + l] + s->gain[i] * (S[k] - history[k * L + l]);
    energy += m->law->alpha[i] * (TLEDPronySpring(m->law, H, S, W_iso, h) - W_iso);
  }
  return energy;
}

/* elastic stress P and isochoric stress S of the lanes */
INLINE void PackElastic(int law, const TLEDLaw *material, const double fibre[], double H_of[9][L], double P_of[9][L], double S_of[6][L])
{
  const TLEDLaw m = KnownLaw(law, material);
  double        jm1[L], ln_J[L] = {0.0};

  for (int l = 0; l < L; l++) {
    const double H[9] = {H_of[0][l], H_of[1][l], H_of[2][l], H_of[3][l], H_of[4][l], H_of[5][l], H_of[6][l], H_of[7][l], H_of[8][l]};
    jm1[l]            = TLEDJacobianMinusOne(H);
  }
  if (law == TLED_LAW_NEO_HOOKEAN) PackLogarithms(jm1, ln_J);
#pragma GCC ivdep
  for (int l = 0; l < L; l++) {
    const double H[9] = {H_of[0][l], H_of[1][l], H_of[2][l], H_of[3][l], H_of[4][l], H_of[5][l], H_of[6][l], H_of[7][l], H_of[8][l]};
    const double inv_J = 1.0 / (1.0 + jm1[l]);
    double       P[9], S[6], a[3];
    LaneFibre(fibre, l, a);
    TLEDStress(&m, a, H, ln_J[l], inv_J, P);
    TLEDIsochoricStress(&m, a, H, inv_J, S);
    P_of[0][l] = P[0], P_of[1][l] = P[1], P_of[2][l] = P[2];
    P_of[3][l] = P[3], P_of[4][l] = P[4], P_of[5][l] = P[5];
    P_of[6][l] = P[6], P_of[7][l] = P[7], P_of[8][l] = P[8];
    S_of[0][l] = S[0], S_of[1][l] = S[1], S_of[2][l] = S[2];
    S_of[3][l] = S[3], S_of[4][l] = S[4], S_of[5][l] = S[5];
  }
}

#define ELASTIC_OF(Law, number)                                                                                    \
  KERNEL void Elastic##Law(const TLEDLaw *m, const double fibre[], double H[9][L], double P[9][L], double S[6][L]) \
  {                                                                                                                \
    PackElastic(number, m, fibre, H, P, S);                                                                        \
  }
ELASTIC_OF(NeoHookean, TLED_LAW_NEO_HOOKEAN)
ELASTIC_OF(StVenantKirchhoff, TLED_LAW_ST_VENANT_KIRCHHOFF)
ELASTIC_OF(NeoHookeanIso, TLED_LAW_NEO_HOOKEAN_ISO)
ELASTIC_OF(MooneyRivlin, TLED_LAW_MOONEY_RIVLIN)
ELASTIC_OF(Transverse, TLED_LAW_TRANSVERSE)

/* R = sum_i alpha_i (h_i - S) of the lanes, S over R; with `commit` the histories go on */
static void PackRelax(const TLEDLaw *m, const TLEDPronyStep *s, int commit, double history[], double S[6][L])
{
  double R[6][L];

  for (int k = 0; k < 6; k++)
    for (int l = 0; l < L; l++) R[k][l] = 0.0;
  for (int i = 0; i < m->n_prony; i++) {
    for (int k = 0; k < 6; k++) {
      double *h = &history[(6 * (i + 1) + k) * L];
      for (int l = 0; l < L; l++) {
        const double now = s->keep[i] * h[l] + s->gain[i] * (S[k][l] - history[k * L + l]);
        R[k][l] += m->alpha[i] * (now - S[k][l]);
        h[l] = commit ? now : h[l];
      }
    }
  }
  for (int k = 0; k < 6; k++) {
    for (int l = 0; l < L; l++) {
      history[k * L + l] = commit ? S[k][l] : history[k * L + l];
      S[k][l]            = R[k][l];
    }
  }
}

/*
  TLEDViscousStress_OpenMP - stress of one integration point of a pack of elements with a Prony series

  Input Parameters:
+ loops  - mode and histories
. pack   - the pack
. point  - the integration point
. commit - 1: the histories go on to this state, when the mode is TLED_VISCOUS_COMMIT
- H      - displacement gradient that the law sees

  Output Parameter:
. P - first Piola-Kirchhoff stress [Pa]
*/
void TLEDViscousStress_OpenMP(const TLEDLoops *w, int pack, int point, int commit, double H_of[9][L], double P_of[9][L])
{
  const TLEDLaw *m     = &w->laws[w->blocks->material[pack]];
  const double  *fibre = w->blocks->fibre ? w->blocks->fibre + 3 * L * pack : NULL;
  double         S[6][L] __attribute__((aligned(64)));

  switch (m->law) {
  case TLED_LAW_NEO_HOOKEAN: ElasticNeoHookean(m, fibre, H_of, P_of, S); break;
  case TLED_LAW_ST_VENANT_KIRCHHOFF: ElasticStVenantKirchhoff(m, fibre, H_of, P_of, S); break;
  case TLED_LAW_NEO_HOOKEAN_ISO: ElasticNeoHookeanIso(m, fibre, H_of, P_of, S); break;
  case TLED_LAW_MOONEY_RIVLIN: ElasticMooneyRivlin(m, fibre, H_of, P_of, S); break;
  default: ElasticTransverse(m, fibre, H_of, P_of, S); break;
  }
  if (w->viscous_mode == TLED_VISCOUS_INSTANT) return;
  PackRelax(m, &w->prony[w->blocks->material[pack]], commit && w->viscous_mode == TLED_VISCOUS_COMMIT,
            w->history + w->history_offset[pack] + 6 * L * (1 + m->n_prony) * point, S);
#pragma GCC ivdep
  for (int l = 0; l < L; l++) {
    const double H[9] = {H_of[0][l], H_of[1][l], H_of[2][l], H_of[3][l], H_of[4][l], H_of[5][l], H_of[6][l], H_of[7][l], H_of[8][l]};
    const double R[6] = {S[0][l], S[1][l], S[2][l], S[3][l], S[4][l], S[5][l]};
    double       F[9], P[9] = {P_of[0][l], P_of[1][l], P_of[2][l], P_of[3][l], P_of[4][l], P_of[5][l], P_of[6][l], P_of[7][l], P_of[8][l]};
    TLEDDeformationGradient(H, F);
    TLEDAddSecondStress(F, R, P);
    P_of[0][l] = P[0], P_of[1][l] = P[1], P_of[2][l] = P[2];
    P_of[3][l] = P[3], P_of[4][l] = P[4], P_of[5][l] = P[5];
    P_of[6][l] = P[6], P_of[7][l] = P[7], P_of[8][l] = P[8];
  }
}
