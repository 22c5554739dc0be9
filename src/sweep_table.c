/* sweep_table.c - what the runs of a sweep left, beside each other: cost from summary.json, differences of probes and energy from the reference
   run; sweep.csv and sweep.md. */
#include "sweep_impl.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

PetscErrorCode SweepReadText(const char directory[], const char name[], char **text)
{
  char   path[PETSC_MAX_PATH_LEN];
  FILE  *file;
  size_t n = 0, capacity = 1 << 14;

  PetscFunctionBegin;
  *text = NULL;
  ByCall(OutputPath(directory, name, "", path));
  file = fopen(path, "rb");
  if (!file) PetscFunctionReturn(PETSC_SUCCESS);
  PetscCall(PetscMalloc1(capacity + 1, text));
  for (size_t m = 1; m;) {
    if (n == capacity) PetscCall(PetscRealloc((capacity *= 2) + 1, text));
    n += m = fread(*text + n, 1, capacity - n, file);
  }
  fclose(file);
  (*text)[n] = 0;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* a dotted path against a pattern in which * stands for any one word */
static PetscBool Matches(const char path[], const char pattern[])
{
  for (; *pattern; pattern++) {
    if (*pattern == '*') path += strcspn(path, ".");
    else if (*path++ != *pattern) return PETSC_FALSE;
  }
  return (PetscBool)(*path == 0);
}

/* sum of the numbers of a JSON text whose path matches ("fluid.particles", "bodies.*.proxies_mean"); NaN without any */
static double JsonSum(const char text[], const char pattern[])
{
  char   path[1024] = "";
  size_t before[32] = {0}; /* length of the path around each open object */
  int    depth      = 0;
  double sum        = NAN;

  for (const char *c = text; c && *c;) {
    if (*c == '{' && depth < 31) before[++depth] = strlen(path);
    if (*c == '}' && depth > 0) path[before[depth--]] = 0;
    if (*c == '"') {
      const char *word = ++c;

      while (*c && *c != '"') c += c[0] == '\\' && c[1] ? 2 : 1;
      if (*c && c[1 + strspn(c + 1, " \t\n")] == ':') {
        path[before[depth]] = 0;
        snprintf(path + before[depth], sizeof(path) - before[depth], "%s%.*s", before[depth] ? "." : "", (int)(c - word), word);
      }
    } else if ((isdigit((unsigned char)*c) || *c == '-') && Matches(path, pattern)) {
      char *end;

      sum = (isnan(sum) ? 0.0 : sum) + strtod(c, &end);
      c   = end;
      continue;
    } else if (isdigit((unsigned char)*c) || *c == '-') {
      c += strcspn(c, ",}\n");
      continue;
    }
    if (*c) c++;
  }
  return sum;
}

/* a CSV file of numbers with headers `name [unit]`; the first column is the time */
typedef struct {
  PetscInt n_rows, n_columns;
  char    *text, **name;
  double  *value; /* n_rows x n_columns */
} Columns;

static PetscErrorCode ReadColumns(const char directory[], const char file[], Columns *t)
{
  char    *line, *next;
  PetscInt n_lines = 0, n = 1;

  PetscFunctionBegin;
  memset(t, 0, sizeof(*t));
  PetscCall(SweepReadText(directory, file, &t->text));
  if (!t->text || !(next = strchr(t->text, '\n'))) PetscFunctionReturn(PETSC_SUCCESS);
  *next++ = 0;
  for (const char *c = t->text; *c; c++) n += *c == ',';
  for (const char *c = next; *c; c++) n_lines += *c == '\n';
  t->n_columns = n;
  PetscCall(PetscMalloc1(n, &t->name));
  PetscCall(PetscMalloc1((size_t)n * (size_t)(n_lines + 1), &t->value));
  line = t->text;
  for (PetscInt k = 0; k < n; k++) {
    char *end  = strchr(line, ','), *unit;
    t->name[k] = line;
    if (end) *end = 0;
    if ((unit = strstr(line, " ["))) *unit = 0;
    line = end ? end + 1 : line;
  }
  while (n_lines--) {
    PetscInt k = 0;

    for (line = next; k < n; k++) {
      char *end;
      t->value[t->n_rows * n + k] = strtod(line, &end);
      if (end == line || (*end != ',' && *end != '\n')) break;
      line = end + 1;
    }
    t->n_rows += k == n; /* a broken row is left out */
    next = strchr(next, '\n') + 1;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode FreeColumns(Columns *t)
{
  PetscFunctionBegin;
  PetscCall(PetscFree(t->text));
  PetscCall(PetscFree(t->name));
  PetscCall(PetscFree(t->value));
  memset(t, 0, sizeof(*t));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscInt FindColumn(const Columns *t, const char name[])
{
  for (PetscInt k = 1; k < t->n_columns; k++) {
    if (!strcmp(t->name[k], name)) return k;
  }
  return -1;
}

/* a quantity: the columns of its components */
typedef struct {
  PetscInt n, column[3];
} Quantity;

static Quantity FindQuantity(const Columns *t, const char name[])
{
  static const char *const ends[] = {"_x", "_y", "_z"};
  Quantity                 q      = {0, {-1, -1, -1}};
  char                     component[2 * BY_NAME_MAX];

  q.column[0] = FindColumn(t, name);
  if (q.column[0] >= 0) q.n = 1;
  for (int k = 0; k < 3 && q.n == k; k++) {
    snprintf(component, sizeof(component), "%s%s", name, ends[k]);
    q.column[k] = FindColumn(t, component);
    q.n += q.column[k] >= 0;
  }
  return q;
}

/* value of a column at a time, linearly between rows; *row is where the search begins */
static double ValueAt(const Columns *t, PetscInt column, double time, PetscInt *row)
{
  const PetscInt n = t->n_columns;
  const double  *v = t->value;
  double         a, b;

  while (*row + 2 < t->n_rows && v[(*row + 1) * n] < time) (*row)++;
  if (*row + 1 >= t->n_rows) return v[*row * n + column];
  a = v[*row * n];
  b = v[(*row + 1) * n];
  if (!(b > a)) return v[(*row + 1) * n + column];
  a = (time - a) / (b - a);
  return (1.0 - a) * v[*row * n + column] + a * v[(*row + 1) * n + column];
}

/* how far a run is from the reference: rms over the reference's rows, and distance of the means, both over the reference's largest value */
typedef struct {
  double rms, mean;
} Difference;

static Difference Compare(const Columns *run, const Columns *reference, const char name[])
{
  const Quantity a = FindQuantity(run, name), r = FindQuantity(reference, name);
  const PetscInt n = reference->n_columns;
  double         square = 0.0, largest = 0.0, sum[3] = {0.0};
  PetscInt       row = 0, count = 0;
  Difference     d   = {NAN, NAN};

  if (!r.n || a.n != r.n || !run->n_rows) return d;
  for (PetscInt i = 0; i < reference->n_rows; i++) {
    const double time = reference->value[i * n];
    double       off[3] = {0.0}, size = 0.0, distance = 0.0;

    if (time > run->value[(run->n_rows - 1) * run->n_columns] * (1.0 + 1e-9)) break;
    for (PetscInt k = 0; k < r.n; k++) {
      const double value = reference->value[i * n + r.column[k]];

      off[k] = ValueAt(run, a.column[k], time, &row) - value;
      size += value * value;
      distance += off[k] * off[k];
    }
    if (!isfinite(size) || !isfinite(distance)) continue; /* a gauge that was dry */
    largest = fmax(largest, size);
    square += distance;
    for (int k = 0; k < 3; k++) sum[k] += off[k];
    count++;
  }
  if (!count || !(largest > 0.0)) return d;
  d.rms  = sqrt(square / (double)count / largest);
  d.mean = sqrt((sum[0] * sum[0] + sum[1] * sum[1] + sum[2] * sum[2]) / largest) / (double)count;
  return d;
}

/* sum of all energies since the start, as a column `total` behind the ledger's; `scale`: largest kinetic and strain energy */
static double AddEnergy(Columns *t)
{
  static const char *const parts[] = {"fluid_kinetic", "solid_kinetic", "solid_strain", "fluid_potential", "solid_potential"};
  double                   scale = 0.0;

  for (PetscInt i = t->n_rows - 1; i >= 0; i--) {
    double total = 0.0, moving = 0.0;

    for (int k = 0; k < 5; k++) {
      const PetscInt c     = FindColumn(t, parts[k]);
      const double   value = c < 0 ? 0.0 : t->value[i * t->n_columns + c];

      total += value - (c < 0 ? 0.0 : t->value[c]);
      if (k < 3) moving += value;
    }
    scale                           = fmax(scale, moving);
    t->value[i * t->n_columns + 1] = total; /* in place of the step's number */
  }
  return scale;
}

static double CompareEnergy(const Columns *run, const Columns *reference, double scale)
{
  double   square = 0.0;
  PetscInt row    = 0;

  if (!run->n_rows || !reference->n_rows || !(scale > 0.0)) return NAN;
  for (PetscInt i = 0; i < reference->n_rows; i++) {
    const double *r   = reference->value + i * reference->n_columns;
    const double  off = ValueAt(run, 1, r[0], &row) - r[1];

    square += off * off;
  }
  return sqrt(square / (double)reference->n_rows) / scale;
}

enum { COLUMN_PARTICLES, COLUMN_PROXIES, COLUMN_STEPS, COLUMN_CPU, COLUMN_STEP, COLUMN_SHARE, COLUMN_DENSITY, COLUMN_PENETRATIONS, COLUMN_ENERGY, N_COLUMNS };

static const char *const column_names[N_COLUMNS] = {"particles [1]", "proxies [1]", "steps [1]", "cpu [s]", "step_cpu [s]", "proxy_share [1]", "density_error [1]", "penetrations [1]", "energy_difference [1]"};

typedef struct {
  double     value[N_COLUMNS];
  Difference probe[BY_NAMES_MAX];
} Row;

/* cost and errors of one run from its summary */
static PetscErrorCode ReadSummary(const SweepPoint *p, Row *row)
{
  static const char *const paths[] = {"fluid.particles", "bodies.*.proxies_mean", "steps", NULL, "cpu_seconds_per_step", NULL, "fluid.density_error_mean", "coupling.penetrations"};
  char  *text, *cpu;
  double all, output;

  PetscFunctionBegin;
  for (int k = 0; k < N_COLUMNS; k++) row->value[k] = NAN;
  for (PetscInt k = 0; k < BY_NAMES_MAX; k++) row->probe[k] = (Difference){NAN, NAN};
  PetscCall(SweepReadText(p->directory, "sweep.cpu", &cpu));
  if (cpu) row->value[COLUMN_CPU] = atof(cpu);
  PetscCall(PetscFree(cpu));
  PetscCall(SweepReadText(p->directory, "summary.json", &text));
  if (!text) PetscFunctionReturn(PETSC_SUCCESS);
  for (int k = 0; k < COLUMN_ENERGY; k++) {
    if (paths[k]) row->value[k] = JsonSum(text, paths[k]);
  }
  all                      = JsonSum(text, "phases_cpu.*");
  output                   = JsonSum(text, "phases_cpu.output");
  row->value[COLUMN_SHARE] = JsonSum(text, "phases_cpu.proxies") / (all - output);
  PetscCall(PetscFree(text));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the rows of all runs; differences of those that ran to their end */
static PetscErrorCode ReadRows(Sweep *s, Row rows[])
{
  const SweepPoint *best = s->reference_point < 0 ? NULL : &s->point[s->reference_point];
  Columns           probes, ledger;
  double            scale = 0.0;

  PetscFunctionBegin;
  memset(&probes, 0, sizeof(probes));
  memset(&ledger, 0, sizeof(ledger));
  if (best && best->state == SWEEP_DONE) {
    PetscCall(ReadColumns(best->directory, "probes.csv", &probes));
    PetscCall(ReadColumns(best->directory, "ledger.csv", &ledger));
    scale = AddEnergy(&ledger);
  }
  for (PetscInt k = 0; k < s->n_points; k++) {
    const SweepPoint *p = &s->point[k];
    Columns           run;

    if (p->state < SWEEP_DONE) continue;
    PetscCall(ReadSummary(p, &rows[k]));
    if (p->state != SWEEP_DONE || !best || p == best) continue;
    PetscCall(ReadColumns(p->directory, "probes.csv", &run));
    for (PetscInt i = 0; i < s->probes.n; i++) rows[k].probe[i] = Compare(&run, &probes, s->probes.name[i]);
    PetscCall(FreeColumns(&run));
    PetscCall(ReadColumns(p->directory, "ledger.csv", &run));
    (void)AddEnergy(&run);
    rows[k].value[COLUMN_ENERGY] = CompareEnergy(&run, &ledger, scale);
    PetscCall(FreeColumns(&run));
  }
  PetscCall(FreeColumns(&probes));
  PetscCall(FreeColumns(&ledger));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static const char *StateWord(const Sweep *s, PetscInt k)
{
  static const char *const words[] = {"waits", "interrupted", "running", "done", "breakdown", "failed"};

  return k == s->reference_point && s->point[k].state == SWEEP_DONE ? "reference" : words[s->point[k].state];
}

/* a text cell of a CSV file */
static PetscErrorCode AddCell(OutputText *text, const char word[])
{
  PetscFunctionBegin;
  if (!strpbrk(word, ",\"\n")) PetscCall(OutputTextAdd(text, "%s", word));
  else {
    PetscCall(OutputTextAdd(text, "\""));
    for (const char *c = word; *c; c++) PetscCall(OutputTextAdd(text, *c == '"' ? "\"\"" : "%c", *c));
    PetscCall(OutputTextAdd(text, "\""));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode AddNumber(OutputText *text, double x)
{
  char number[32] = "";

  PetscFunctionBegin;
  if (isfinite(x)) OutputFormatReal(x, number);
  PetscCall(OutputTextAdd(text, ",%s", number));
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode WriteCSV(const Sweep *s, const Row rows[])
{
  OutputText     text = {NULL, 0, 0};
  char           path[PETSC_MAX_PATH_LEN];
  PetscErrorCode status;

  PetscFunctionBegin;
  PetscCall(OutputTextAdd(&text, "run"));
  for (PetscInt a = 0; a < s->n_axes; a++) {
    PetscCall(OutputTextAdd(&text, ","));
    PetscCall(AddCell(&text, s->axis[a].name));
  }
  PetscCall(OutputTextAdd(&text, ",status"));
  for (int c = 0; c < N_COLUMNS; c++) PetscCall(OutputTextAdd(&text, ",%s", column_names[c]));
  for (PetscInt i = 0; i < s->probes.n; i++) PetscCall(OutputTextAdd(&text, ",%s_rms [1],%s_mean [1]", s->probes.name[i], s->probes.name[i]));
  for (PetscInt k = 0; k < s->n_points; k++) {
    PetscCall(OutputTextAdd(&text, "\n"));
    PetscCall(AddCell(&text, s->point[k].name));
    for (PetscInt a = 0; a < s->n_axes; a++) {
      PetscCall(OutputTextAdd(&text, ","));
      PetscCall(AddCell(&text, s->point[k].label[a]));
    }
    PetscCall(OutputTextAdd(&text, ",%s", StateWord(s, k)));
    for (int c = 0; c < N_COLUMNS; c++) PetscCall(AddNumber(&text, rows[k].value[c]));
    for (PetscInt i = 0; i < s->probes.n; i++) {
      PetscCall(AddNumber(&text, rows[k].probe[i].rms));
      PetscCall(AddNumber(&text, rows[k].probe[i].mean));
    }
  }
  PetscCall(OutputTextAdd(&text, "\n"));
  status = OutputPath(s->params.directory, "sweep", ".csv", path);
  if (!status) status = OutputReplaceText(path, text.text, text.n, PETSC_FALSE);
  free(text.text);
  PetscFunctionReturn(status);
}

/* a number for people: three digits, percent for errors */
static PetscErrorCode AddShown(OutputText *text, double x, PetscBool percent)
{
  PetscFunctionBegin;
  if (!isfinite(x)) PetscCall(OutputTextAdd(text, " |"));
  else if (percent) PetscCall(OutputTextAdd(text, " %.3g %% |", 100.0 * x));
  else if (x == floor(x) || fabs(x) >= 1000.0) PetscCall(OutputTextAdd(text, " %.0f |", x));
  else PetscCall(OutputTextAdd(text, " %.3g |", x));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* columns that hold anything */
static void FindShown(const Sweep *s, const Row rows[], PetscBool shown[], PetscBool *probes)
{
  *probes = PETSC_FALSE;
  for (int c = 0; c < N_COLUMNS; c++) {
    shown[c] = PETSC_FALSE;
    for (PetscInt k = 0; k < s->n_points; k++) shown[c] = (PetscBool)(shown[c] || isfinite(rows[k].value[c]));
  }
  for (PetscInt k = 0; k < s->n_points; k++) {
    for (PetscInt i = 0; i < s->probes.n; i++) *probes = (PetscBool)(*probes || isfinite(rows[k].probe[i].rms));
  }
}

static PetscErrorCode AddTable(const Sweep *s, const Row rows[], OutputText *text)
{
  static const char *const heads[N_COLUMNS] = {"particles", "proxies", "steps", "cpu, s", "cpu a step, s", "proxies' share", "density error", "inside", "energy off"};
  PetscBool                shown[N_COLUMNS], probes;
  PetscInt                 n = s->n_axes + 1;

  PetscFunctionBegin;
  FindShown(s, rows, shown, &probes);
  PetscCall(OutputTextAdd(text, "|"));
  for (PetscInt a = 0; a < s->n_axes; a++) PetscCall(OutputTextAdd(text, " %s |", s->axis[a].name));
  PetscCall(OutputTextAdd(text, " status |"));
  for (int c = 0; c < N_COLUMNS; c++) {
    if (shown[c]) PetscCall(OutputTextAdd(text, " %s |", heads[c]));
    n += shown[c];
  }
  for (PetscInt i = 0; i < s->probes.n && probes; i++) PetscCall(OutputTextAdd(text, " %s: rms, mean |", s->probes.name[i]));
  n += probes ? s->probes.n : 0;
  PetscCall(OutputTextAdd(text, "\n|"));
  for (PetscInt k = 0; k < n; k++) PetscCall(OutputTextAdd(text, " --- |"));
  for (PetscInt k = 0; k < s->n_points; k++) {
    PetscCall(OutputTextAdd(text, "\n|"));
    for (PetscInt a = 0; a < s->n_axes; a++) PetscCall(OutputTextAdd(text, " %s |", s->point[k].label[a]));
    PetscCall(OutputTextAdd(text, " %s |", StateWord(s, k)));
    for (int c = 0; c < N_COLUMNS; c++) {
      if (shown[c]) PetscCall(AddShown(text, rows[k].value[c], (PetscBool)(c == COLUMN_SHARE || c == COLUMN_DENSITY || c == COLUMN_ENERGY)));
    }
    for (PetscInt i = 0; i < s->probes.n && probes; i++) {
      const Difference *d = &rows[k].probe[i];
      PetscCall(isfinite(d->rms) ? OutputTextAdd(text, " %.3g %%, %.3g %% |", 100.0 * d->rms, 100.0 * d->mean) : OutputTextAdd(text, " |"));
    }
  }
  PetscCall(OutputTextAdd(text, "\n"));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* table, what broke down, what the columns mean */
static PetscErrorCode WriteMarkdown(const Sweep *s, const Row rows[], PetscBool show)
{
  OutputText     text = {NULL, 0, 0};
  char           path[PETSC_MAX_PATH_LEN];
  PetscErrorCode status;
  size_t         table;

  PetscFunctionBegin;
  PetscCall(OutputTextAdd(&text, "# Sweep of %s\n\n", s->path));
  table = text.n;
  PetscCall(AddTable(s, rows, &text));
  for (PetscInt k = 0; k < s->n_points; k++) {
    if (s->point[k].why) PetscCall(OutputTextAdd(&text, "\n%s: the simulation %s\n", s->point[k].name, s->point[k].why));
  }
  if (show) printf("%s", text.text + table);
  PetscCall(OutputTextAdd(&text, "\ncpu: of the whole run, all threads; a step: of the time loop. Proxies' share: of a step without outputs. Density error: mean compression of "
                                 "the water. Inside: most particles inside a body.\n"));
  if (s->reference_point >= 0) {
    PetscCall(OutputTextAdd(&text, "Against the run %s: rms of the difference over time, and difference of the means over time, both over the largest value of the reference; "
                                   "energy off: rms of the difference of all energies since the start, over the largest kinetic and strain energy.\n", s->point[s->reference_point].name));
  }
  status = OutputPath(s->params.directory, "sweep", ".md", path);
  if (!status) status = OutputReplaceText(path, text.text, text.n, PETSC_FALSE);
  free(text.text);
  PetscFunctionReturn(status);
}

/*@ SweepWriteTables - sweep.csv and sweep.md of the runs that are finished; `show`: the table on the screen too @*/
PetscErrorCode SweepWriteTables(Sweep *s, PetscBool show)
{
  Row           *rows;
  PetscErrorCode status;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(s->n_points, &rows));
  for (PetscInt k = 0; k < s->n_points; k++) {
    for (int c = 0; c < N_COLUMNS; c++) rows[k].value[c] = NAN;
    for (PetscInt i = 0; i < BY_NAMES_MAX; i++) rows[k].probe[i] = (Difference){NAN, NAN};
  }
  PetscCall(ReadRows(s, rows));
  status = WriteCSV(s, rows);
  if (!status) status = WriteMarkdown(s, rows, show);
  PetscCall(PetscFree(rows));
  PetscFunctionReturn(status);
}
