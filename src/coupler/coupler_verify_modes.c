/* coupler_verify_modes.c - natural frequencies from the eigenvalue problem beside the spectrum of the explicit solid, ringing. */
#include "coupler_verify.h"

/* samples to a period of the highest mode asked for, and amplitude over the body's size: small, so that the motion is linear */
#define SAMPLES_PER_PERIOD 16
#define AMPLITUDE          1e-7

/* What is looked for and found. */
typedef struct {
  PetscInt   n, n_nodes, n_samples, node;
  PetscReal  dt;         /* between samples [s]                                      */
  PetscReal *frequency;  /* n [Hz], of the eigenvalue problem                        */
  PetscReal *peak;       /* n [Hz], of the ringing solid                             */
  PetscReal *shapes;     /* n x (n_nodes x 3), of unit mass norm                     */
  PetscReal *modal;      /* n x n_samples                                            */
  PetscReal *record;     /* n_samples x 3, displacement of `node` [m]                */
} Ringing;

/* largest extent [m], and the node that moves most in the sum of all shapes, each scaled to its largest */
static PetscErrorCode Measure(Verify *v, Ringing *r, PetscReal *size)
{
  const PetscReal *X;
  PetscReal        low[3], high[3], most = -1.0, *motion;

  PetscFunctionBegin;
  PetscCall(TLEDGetMesh(VerifyBody(v, EXPLICIT), NULL, NULL, &X));
  PetscCall(PetscCalloc1(r->n_nodes, &motion));
  for (int i = 0; i < 3; i++) low[i] = high[i] = X[i];
  for (PetscInt k = 0; k < 3 * r->n_nodes; k++) {
    low[k % 3]  = PetscMin(low[k % 3], X[k]);
    high[k % 3] = PetscMax(high[k % 3], X[k]);
  }
  for (PetscInt m = 0; m < r->n; m++) {
    const PetscReal *shape = &r->shapes[m * 3 * r->n_nodes];
    PetscReal        top   = 0.0;

    for (PetscInt k = 0; k < 3 * r->n_nodes; k++) top = PetscMax(top, PetscAbsReal(shape[k]));
    for (PetscInt k = 0; k < 3 * r->n_nodes; k++) motion[k / 3] += PetscAbsReal(shape[k]) / top;
  }
  for (PetscInt a = 0; a < r->n_nodes; a++) {
    if (motion[a] > most) r->node = a;
    most = PetscMax(most, motion[a]);
  }
  *size = PetscMax(high[0] - low[0], PetscMax(high[1] - low[1], high[2] - low[2]));
  PetscCall(PetscFree(motion));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* <body>_ringdown.csv: displacement of one node, and every mode's part */
static PetscErrorCode Record(Verify *v, const Ringing *r)
{
  char        file[2 * BY_NAME_MAX], names[BY_REALS_MAX][64];
  const char *headers[4 + BY_REALS_MAX] = {"time [s]", "node_x [m]", "node_y [m]", "node_z [m]"};
  Table       table;

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(file, sizeof(file), "%s_ringdown.csv", VerifyName(v)));
  for (PetscInt m = 0; m < r->n; m++) {
    PetscCall(PetscSNPrintf(names[m], sizeof(names[m]), "mode_%d [kg^0.5 m]", (int)m + 1));
    headers[4 + m] = names[m];
  }
  ByCall(TableCreate(v->params.directory, file, 4 + r->n, headers, PETSC_FALSE, 0.0, &table));
  for (PetscInt s = 0; s < r->n_samples; s++) {
    PetscReal row[4 + BY_REALS_MAX] = {r->dt * s, r->record[3 * s], r->record[3 * s + 1], r->record[3 * s + 2]};

    for (PetscInt m = 0; m < r->n; m++) row[4 + m] = r->modal[m * r->n_samples + s];
    ByCall(TableWrite(table, row));
  }
  PetscCall(TableDestroy(&table));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FrequencyTable(Verify *v, const Ringing *r)
{
  PetscReal worst = 0.0;
  char      text[128];

  PetscFunctionBegin;
  PetscCall(PetscPrintf(PETSC_COMM_WORLD, "  %-6s %22s %22s %12s\n", "mode", "eigenvalue [Hz]", "ringing, explicit [Hz]", "difference"));
  PetscCall(JsonBegin(v->json, "modes"));
  for (PetscInt m = 0; m < r->n; m++) {
    const PetscReal difference = PetscAbsReal(r->peak[m] / r->frequency[m] - 1.0);
    char            key[16];

    worst = PetscMax(worst, difference);
    PetscCall(PetscPrintf(PETSC_COMM_WORLD, "  %-6d %22.10g %22.10g %12.2e\n", (int)m + 1, (double)r->frequency[m], (double)r->peak[m], (double)difference));
    PetscCall(PetscSNPrintf(key, sizeof(key), "%d", (int)m + 1));
    PetscCall(JsonBegin(v->json, key));
    PetscCall(JsonReal(v->json, "eigenvalue", r->frequency[m]));
    PetscCall(JsonReal(v->json, "ringing", r->peak[m]));
    PetscCall(JsonEnd(v->json));
  }
  PetscCall(JsonReal(v->json, "tolerance", v->params.modes_tolerance));
  PetscCall(JsonEnd(v->json));
  PetscCall(PetscSNPrintf(text, sizeof(text), "largest difference of a frequency %.2e, allowed %.2g", (double)worst, (double)v->params.modes_tolerance));
  PetscCall(VerifyJudge(v, text, (PetscBool)(worst <= v->params.modes_tolerance)));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* run the explicit solid and look for the peak of each mode within a tenth of its frequency */
static PetscErrorCode Ring(Verify *v, Ringing *r)
{
  PetscReal      size = 0.0;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  r->dt        = 1.0 / (SAMPLES_PER_PERIOD * r->frequency[r->n - 1]);
  r->n_samples = 1 + (PetscInt)PetscCeilReal(v->params.periods / (r->frequency[0] * r->dt));
  PetscCall(PetscMalloc2(r->n * r->n_samples, &r->modal, 3 * r->n_samples, &r->record));
  PetscCall(Measure(v, r, &size));
  ierr = TLEDRingDown(VerifyBody(v, EXPLICIT), r->n, r->frequency, r->shapes, AMPLITUDE * size, r->node, r->dt, r->n_samples, r->modal, r->record);
  if (ierr == BY_ERR_BREAKDOWN) ByCall(VerifyBreakdown(v, EXPLICIT, "ringing"));
  ByCall(ierr);
  for (PetscInt m = 0; m < r->n; m++) {
    PetscCall(TLEDSpectrumPeak(r->n_samples, r->dt, &r->modal[m * r->n_samples], 0.9 * r->frequency[m], 1.1 * r->frequency[m], &r->peak[m]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ VerifyModes - frequencies of the body as built, without gravity, and the peaks of the explicit solid ringing in those modes @*/
PetscErrorCode VerifyModes(Verify *v)
{
  TLED            tled    = VerifyBody(v, EXPLICIT);
  const PetscReal none[3] = {0.0, 0.0, 0.0};
  Ringing         r       = {0};
  PetscBool       have;

  PetscFunctionBegin;
  PetscCall(TLEDHaveModes(&have));
  if (!have) PetscFunctionReturn(InputError("verify.modes", "needs SLEPc, with which this program was not built\nDebian: apt install slepc-dev, then build again; or leave it out"));
  r.n = v->params.modes;
  PetscCall(TLEDGetSize(tled, &r.n_nodes, NULL));
  PetscCall(PetscMalloc3(r.n, &r.frequency, r.n, &r.peak, r.n * 3 * r.n_nodes, &r.shapes));
  ByCall(TLEDModes(PETSC_COMM_WORLD, tled, r.n, r.frequency, r.shapes));
  if (!(r.frequency[0] > 0.0)) PetscFunctionReturn(InputError("verify.modes", "the body %s is free or unstable: its lowest frequency is %g Hz\nhold it with `fixed`", VerifyName(v), (double)r.frequency[0]));
  PetscCall(TLEDSave(tled));
  PetscCall(TLEDSetGravity(tled, none));
  ByCall(Ring(v, &r));
  PetscCall(TLEDSetGravity(tled, v->side[EXPLICIT]->gravity));
  PetscCall(TLEDRestore(tled));
  ByCall(FrequencyTable(v, &r));
  ByCall(Record(v, &r));
  PetscCall(PetscFree3(r.frequency, r.peak, r.shapes));
  PetscCall(PetscFree2(r.modal, r.record));
  PetscFunctionReturn(PETSC_SUCCESS);
}
