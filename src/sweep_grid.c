/* sweep_grid.c - what is varied: the command line and the section `sweep` become axes, axes become points, each read once by the scene's own
   reader so that every wrong key and value is found before anything runs. */
#include "sweep_impl.h"

#include <ctype.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

PetscErrorCode SweepKeep(Sweep *s, const char text[], size_t n, char **kept)
{
  PetscFunctionBegin;
  if (s->n_strings == s->capacity) {
    s->capacity = 2 * s->capacity + 64;
    PetscCall(PetscRealloc((size_t)s->capacity * sizeof(*s->strings), &s->strings));
  }
  PetscCall(PetscMalloc1(n + 1, kept));
  PetscCall(PetscMemcpy(*kept, text, n));
  (*kept)[n]                 = 0;
  s->strings[s->n_strings++] = *kept;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* length of the text up to a separator that is not within [] */
static size_t PieceLength(const char text[], char separator)
{
  size_t n     = 0;
  int    depth = 0;

  for (; text[n] && (depth > 0 || text[n] != separator); n++) depth += (text[n] == '[') - (text[n] == ']');
  return n;
}

/* the words behind an option of ours, at most `n` and up to the next option: joined by commas */
static PetscErrorCode TakeWords(Sweep *s, int n, int argc, char *argv[], int *i, char **joined)
{
  char text[BY_NAMES_MAX * (BY_NAME_MAX + 1)] = "";

  PetscFunctionBegin;
  while (n-- > 0 && *i + 1 < argc && argv[*i + 1][0] != '-') {
    const size_t used = strlen(text);
    snprintf(text + used, sizeof(text) - used, "%s%s", used ? "," : "", argv[++*i]);
  }
  PetscCall(SweepKeep(s, text, strlen(text), joined));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ SweepReadArguments - ours are taken, what is left are keys for every run @*/
PetscErrorCode SweepReadArguments(Sweep *s, int argc, char *argv[])
{
  static const char *const ours[]    = {"-over", "-reference", "-probe", "-directory", "-jobs"};
  static const char *const meaning[] = {"expected -over key=value,value with a key of the scene, for example -over sph.spacing=0.01,0.02",
                                        "expected -reference key=value, for example -reference sph.spacing=0.005", "expected -probe NAME ...",
                                        "expected -directory DIR, where tables and runs go", "expected -jobs N, runs at the same time"};
  static char section[3][32] = {"-sweep_probes", "-sweep_directory", "-sweep_jobs"};

  PetscFunctionBegin;
  s->path = argv[0];
  PetscCall(PetscCalloc1((size_t)argc + 8, &s->overrides));
  for (int i = 1; i < argc; i++) {
    int which = 0;

    while (which < 5 && strcmp(argv[i], ours[which])) which++;
    if (which == 5) {
      s->overrides[s->n_overrides++] = argv[i];
      continue;
    }
    if (i + 1 == argc || argv[i + 1][0] == '-') PetscFunctionReturn(InputError(ours[which], "names nothing\n%s", meaning[which]));
    if (which == 0) {
      if (s->n_over == SWEEP_AXES_MAX) PetscFunctionReturn(InputError("-over", "is given more than %d times", SWEEP_AXES_MAX));
      s->over[s->n_over++] = argv[++i];
    } else if (which == 1) {
      if (s->reference_text) PetscFunctionReturn(InputError("-reference", "is given twice\n-reference key=value,key=value sets several keys"));
      s->reference_text = argv[++i];
    } else {
      s->overrides[s->n_overrides++] = section[which - 2];
      PetscCall(TakeWords(s, which == 2 ? BY_NAMES_MAX : 1, argc, argv, &i, &s->overrides[s->n_overrides]));
      s->n_overrides++;
    }
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* "sph.spacing" -> "sph_spacing", as options and run directories have it */
static PetscErrorCode KeepOption(Sweep *s, const char key[], size_t n, char **option)
{
  PetscFunctionBegin;
  while (n && isspace((unsigned char)*key)) {
    key++;
    n--;
  }
  while (n && isspace((unsigned char)key[n - 1])) n--;
  PetscCall(SweepKeep(s, key, n, option));
  for (char *c = *option; *c; c++) {
    if (*c == '.') *c = '_';
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* a value that is the name of a file beside the scene becomes that file's path, as in the scene's own keys */
static PetscErrorCode KeepValue(Sweep *s, const char value[], size_t n, PetscBool of_scene, char **kept)
{
  const char *slash = strrchr(s->path, '/');
  char        path[2 * PETSC_MAX_PATH_LEN], *end;
  struct stat status;

  PetscFunctionBegin;
  PetscCall(SweepKeep(s, value, n, kept));
  (void)strtod(*kept, &end);
  if (!of_scene || !slash || !n || !*end || value[0] == '/') PetscFunctionReturn(PETSC_SUCCESS);
  snprintf(path, sizeof(path), "%.*s/%s", (int)(slash - s->path), s->path, *kept);
  if (!stat(path, &status) && S_ISREG(status.st_mode)) PetscCall(SweepKeep(s, path, strlen(path), kept));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* one value of an axis: as many parts, joined by colons, as it has keys */
static PetscErrorCode AddChoice(Sweep *s, SweepAxis *axis, const char where[], PetscInt n_keys, char *keys[], const char value[], size_t n, PetscBool of_scene)
{
  SweepChoice *choice = &axis->choice[axis->n];
  const char  *part   = value;

  PetscFunctionBegin;
  if (axis->n == BY_NAMES_MAX) PetscFunctionReturn(InputError(where, "has more than %d values", BY_NAMES_MAX));
  PetscCall(SweepKeep(s, value, n, &choice->label));
  for (PetscInt i = 0; i < axis->n; i++) {
    if (!strcmp(axis->choice[i].label, choice->label)) PetscFunctionReturn(InputError(where, "has the value %s twice", choice->label));
  }
  for (PetscInt k = 0; k < n_keys; k++) {
    const size_t left   = (size_t)(value + n - part);
    const size_t length = n_keys > 1 ? PetscMin(PieceLength(part, ':'), left) : left;

    if (!length || (k + 1 < n_keys ? length == left : length < left)) {
      PetscFunctionReturn(InputError(where, "has the value '%s' for %" PetscInt_FMT " keys\nexpected one for each, joined by colons", choice->label, n_keys));
    }
    choice->setting[k].option = keys[k];
    PetscCall(KeepValue(s, part, length, of_scene, &choice->setting[k].value));
    part += length + 1;
  }
  choice->n = n_keys;
  axis->n++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* "sph.spacing=0.01,0.02", "a.kernel,a.eta_min=half_space:0.4,ellipsoid:1" */
static PetscErrorCode AddAxisOfText(Sweep *s, const char text[])
{
  SweepAxis   *axis = &s->axis[s->n_axes];
  const size_t n    = PieceLength(text, '=');
  PetscInt     n_keys = 0;
  char        *keys[SWEEP_KEYS_MAX];

  PetscFunctionBegin;
  if (!n || !text[n]) PetscFunctionReturn(InputError("-over", "%s has no key and values\nexpected -over key=value,value, for example -over sph.spacing=0.01,0.02", text));
  for (const char *key = text; key <= text + n; key += PieceLength(key, ',') + 1) {
    if (n_keys == SWEEP_KEYS_MAX) PetscFunctionReturn(InputError("-over", "%.60s has more than %d keys", text, SWEEP_KEYS_MAX));
    PetscCall(KeepOption(s, key, PetscMin(PieceLength(key, ','), (size_t)(text + n - key)), &keys[n_keys++]));
  }
  PetscCall(SweepKeep(s, text, n, &axis->name));
  for (const char *value = text + n + 1;; value++) {
    const size_t length = PieceLength(value, ',');

    ByCall(AddChoice(s, axis, "-over", n_keys, keys, value, length, PETSC_FALSE));
    value += length;
    if (!*value) break;
  }
  s->n_axes++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* section sweep.<name> */
static PetscErrorCode AddAxisOfScene(Sweep *s, const char name[])
{
  SweepAxis      *axis = &s->axis[s->n_axes];
  SweepAxisParams params;
  char            prefix[2 * BY_NAME_MAX], where[3 * BY_NAME_MAX], *keys[SWEEP_KEYS_MAX];

  PetscFunctionBegin;
  PetscCall(PetscSNPrintf(prefix, sizeof(prefix), "sweep_%s_", name));
  PetscCall(KeysSetDefaults(SweepAxisKeys, &params));
  PetscCall(KeysSetFromOptions(SweepAxisKeys, prefix, &params));
  PetscCall(PetscSNPrintf(where, sizeof(where), "sweep.%s.keys", name));
  if (!params.keys.n || params.keys.n > SWEEP_KEYS_MAX) PetscFunctionReturn(InputError(where, "expected one to %d keys of the scene, as in sph.spacing", SWEEP_KEYS_MAX));
  for (PetscInt k = 0; k < params.keys.n; k++) PetscCall(KeepOption(s, params.keys.name[k], strlen(params.keys.name[k]), &keys[k]));
  PetscCall(SweepKeep(s, name, strlen(name), &axis->name));
  PetscCall(PetscSNPrintf(where, sizeof(where), "sweep.%s.values", name));
  if (!params.values.n) PetscFunctionReturn(InputError(where, "has no value"));
  for (PetscInt k = 0; k < params.values.n; k++) {
    ByCall(AddChoice(s, axis, where, params.keys.n, keys, params.values.name[k], strlen(params.values.name[k]), PETSC_TRUE));
  }
  s->n_axes++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* "key=value" up to n */
static PetscErrorCode AddReference(Sweep *s, const char where[], const char text[], size_t n, PetscBool of_scene)
{
  SweepSetting *setting = &s->reference[s->n_reference];
  const char   *equal   = (const char *)memchr(text, '=', n);

  PetscFunctionBegin;
  if (!equal || equal == text || equal + 1 == text + n) PetscFunctionReturn(InputError(where, "%.*s is not key=value", (int)PetscMin(n, 60), text));
  if (s->n_reference == SWEEP_KEYS_MAX) PetscFunctionReturn(InputError(where, "sets more than %d keys", SWEEP_KEYS_MAX));
  PetscCall(KeepOption(s, text, (size_t)(equal - text), &setting->option));
  PetscCall(KeepValue(s, equal + 1, (size_t)(text + n - equal - 1), of_scene, &setting->value));
  s->n_reference++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* "key=value,key=value"; a piece without = belongs to the value before it: gravity=0,0,-9.81 */
static PetscErrorCode ReadReferenceText(Sweep *s, const char text[])
{
  PetscFunctionBegin;
  for (const char *start = text; *start;) {
    size_t n = PieceLength(start, ',');

    while (start[n]) {
      const size_t next = PieceLength(start + n + 1, ',');
      if (memchr(start + n + 1, '=', next)) break;
      n += next + 1;
    }
    ByCall(AddReference(s, "-reference", start, n, PETSC_FALSE));
    start += n + (start[n] == ',');
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* "a.kernel,a.eta_min" -> "kernel,eta_min" */
static void KeepLastWords(char name[])
{
  char *to = name;

  for (const char *word = name; *word;) {
    const size_t n    = strcspn(word, ",");
    const char  *last = word;

    for (size_t k = 0; k < n; k++) {
      if (word[k] == '.') last = word + k + 1;
    }
    memmove(to, last, (size_t)(word + n - last));
    to += word + n - last;
    word += n;
    if (*word) *to++ = *word++;
  }
  *to = 0;
}

/* axes are called by the last words of their keys, unless that leaves two alike */
static PetscErrorCode ShortenNames(Sweep *s)
{
  char *shorter[SWEEP_AXES_MAX];

  PetscFunctionBegin;
  for (PetscInt a = 0; a < s->n_axes; a++) {
    PetscCall(SweepKeep(s, s->axis[a].name, strlen(s->axis[a].name), &shorter[a]));
    KeepLastWords(shorter[a]);
  }
  for (PetscInt a = 0; a < s->n_axes; a++) {
    PetscInt alike = 0;
    for (PetscInt b = 0; b < s->n_axes; b++) alike += !strcmp(shorter[a], shorter[b]);
    if (alike == 1) s->axis[a].name = shorter[a];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*@ SweepReadAxes - axes and reference, from the command line or else the section `sweep`, which is in the options database @*/
PetscErrorCode SweepReadAxes(Sweep *s)
{
  PetscFunctionBegin;
  for (PetscInt a = 0; a < (s->n_over ? s->n_over : s->params.over.n); a++) {
    if (s->n_over) ByCall(AddAxisOfText(s, s->over[a]));
    else if (a == SWEEP_AXES_MAX) PetscFunctionReturn(InputError("sweep.over", "has more than %d names", SWEEP_AXES_MAX));
    else ByCall(AddAxisOfScene(s, s->params.over.name[a]));
  }
  if (!s->n_axes) {
    PetscFunctionReturn(InputError("sweep.over", "names nothing to vary\ngive -over key=value,value, or the scene a section `sweep: {over: [a], a: {keys: [sph.spacing], values: [0.01, 0.02]}}`"));
  }
  PetscCall(ShortenNames(s));
  if (s->reference_text) ByCall(ReadReferenceText(s, s->reference_text));
  for (PetscInt k = 0; k < s->params.reference.n && !s->reference_text; k++) {
    ByCall(AddReference(s, "sweep.reference", s->params.reference.name[k], strlen(s->params.reference.name[k]), PETSC_TRUE));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* read the scene with some settings; `text`: what decides the result, when asked for */
static PetscErrorCode ReadWith(Sweep *s, PetscInt n, const SweepSetting setting[], char **text)
{
  Scene          scene;
  char         **words;
  int            count = 0;
  PetscErrorCode ierr;
  char          *whole;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1((size_t)s->n_overrides + 3 * (size_t)n + 1, &words));
  for (int i = 0; i < s->n_overrides; i++) words[count++] = s->overrides[i];
  for (PetscInt i = 0; i < n; i++) {
    char option[4 * BY_NAME_MAX];

    PetscCall(PetscSNPrintf(option, sizeof(option), "-%s", setting[i].option));
    PetscCall(SweepKeep(s, option, strlen(option), &words[count++]));
    words[count++] = setting[i].value;
  }
  ierr = SceneRead(s->path, count, words, s->sections, &scene);
  PetscCall(PetscFree(words));
  ByCall(ierr);
  if (text) {
    PetscCall(SceneFormat(scene, "sweep", &whole));
    PetscCall(SweepKeep(s, whole, strlen(whole), text));
    free(whole);
  }
  PetscCall(SceneDestroy(&scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* "<axis>=<value>+<axis>=<value>", with letters that a directory can have */
static void NamePoint(const Sweep *s, PetscInt k)
{
  SweepPoint *p = &s->point[k];

  p->name[0] = 0;
  for (PetscInt a = 0; a < s->n_axes; a++) {
    const char  *slash = strrchr(p->label[a], '/');
    const size_t used  = strlen(p->name);
    snprintf(p->name + used, sizeof(p->name) - used - 8, "%s%s=%s", a ? "+" : "", s->axis[a].name, slash ? slash + 1 : p->label[a]);
  }
  for (char *c = p->name; *c; c++) {
    if (!isalnum((unsigned char)*c) && !strchr("._-+=:", *c)) *c = '_';
  }
  for (PetscInt j = 0; j < k; j++) {
    if (strcmp(s->point[j].name, p->name)) continue;
    snprintf(p->name + strlen(p->name), 8, "+%" PetscInt_FMT, k);
    break;
  }
}

/* what the reference has along an axis: the values of its keys in the scene */
static PetscErrorCode LabelReference(Sweep *s, SweepPoint *p)
{
  char      option[4 * BY_NAME_MAX], value[PETSC_MAX_PATH_LEN], text[PETSC_MAX_PATH_LEN];
  PetscBool found;

  PetscFunctionBegin;
  for (PetscInt a = 0; a < s->n_axes; a++) {
    text[0] = 0;
    for (PetscInt k = 0; k < s->axis[a].choice[0].n; k++) {
      const size_t used = strlen(text);

      PetscCall(PetscSNPrintf(option, sizeof(option), "-%s", s->axis[a].choice[0].setting[k].option));
      PetscCall(PetscOptionsGetString(NULL, NULL, option, value, sizeof(value), &found));
      snprintf(text + used, sizeof(text) - used, "%s%s", k ? ":" : "", found ? value : "default");
    }
    PetscCall(SweepKeep(s, text, strlen(text), &p->label[a]));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the reference is a point of the grid when its scene is that of one, else a run of its own */
static PetscErrorCode AddReferencePoint(Sweep *s)
{
  SweepPoint *p = &s->point[s->n_points];
  PetscInt    n = 0;

  PetscFunctionBegin;
  /* keys in the order of the axes, as the points have them */
  for (PetscInt a = 0; a < s->n_axes; a++) {
    for (PetscInt k = 0; k < s->axis[a].choice[0].n; k++) {
      for (PetscInt i = 0; i < s->n_reference; i++) {
        if (!strcmp(s->reference[i].option, s->axis[a].choice[0].setting[k].option)) p->setting[n++] = s->reference[i];
      }
    }
  }
  for (PetscInt i = 0; i < s->n_reference; i++) {
    PetscBool there = PETSC_FALSE;
    for (PetscInt k = 0; k < n; k++) there = (PetscBool)(there || !strcmp(s->reference[i].option, p->setting[k].option));
    if (!there) p->setting[n++] = s->reference[i];
  }
  p->n = n;
  ByCall(ReadWith(s, p->n, p->setting, &p->scene));
  for (s->reference_point = 0; s->reference_point < s->n_points; s->reference_point++) {
    if (!strcmp(s->point[s->reference_point].scene, p->scene)) PetscFunctionReturn(PETSC_SUCCESS);
  }
  PetscCall(LabelReference(s, p));
  PetscCall(PetscStrncpy(p->name, "reference", sizeof(p->name)));
  s->n_points++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* whether any section has a key with the last words of an option */
static PetscBool EndsInKey(const SceneSection sections[], const char option[])
{
  for (const SceneSection *section = sections; section->name; section++) {
    for (const Key *key = section->keys; key->name; key++) {
      const size_t n = strlen(option), m = strlen(key->name);
      if (m <= n && !strcmp(option + n - m, key->name) && (m == n || option[n - m - 1] == '_')) return PETSC_TRUE;
    }
  }
  return PETSC_FALSE;
}

/* every value by itself, so that each error is told once */
static PetscErrorCode CheckValues(Sweep *s)
{
  PetscErrorCode found = PETSC_SUCCESS;

  PetscFunctionBegin;
  for (PetscInt a = 0; a < s->n_axes; a++) {
    for (PetscInt i = 0; i < s->axis[a].n; i++) {
      PetscBool            known = PETSC_TRUE;
      const PetscErrorCode ierr  = ReadWith(s, s->axis[a].choice[i].n, s->axis[a].choice[i].setting, NULL);

      if (ierr != BY_ERR_INPUT) {
        PetscCall(ierr);
        continue;
      }
      found = ierr;
      for (PetscInt k = 0; k < s->axis[a].choice[i].n; k++) known = (PetscBool)(known && EndsInKey(s->sections, s->axis[a].choice[i].setting[k].option));
      if (!known) break; /* not again for the other values */
    }
  }
  if (s->n_reference) {
    const PetscErrorCode ierr = ReadWith(s, s->n_reference, s->reference, NULL);
    if (ierr != BY_ERR_INPUT) PetscCall(ierr);
    else found = ierr;
  }
  PetscFunctionReturn(found);
}

/*@ SweepMakePoints - all combinations of the axes' values, the first axis slowest, and the reference behind them @*/
PetscErrorCode SweepMakePoints(Sweep *s)
{
  double total = 1.0;

  PetscFunctionBegin;
  for (PetscInt a = 0; a < s->n_axes; a++) total *= (double)s->axis[a].n;
  if (total > SWEEP_POINTS_MAX) PetscFunctionReturn(InputError("sweep.over", "makes %g runs, more than %d", total, SWEEP_POINTS_MAX));
  ByCall(CheckValues(s));
  PetscCall(PetscCalloc1((size_t)total + 1, &s->point));
  for (PetscInt k = 0; k < (PetscInt)total; k++) {
    SweepPoint *p    = &s->point[k];
    PetscInt    rest = k;

    for (PetscInt a = s->n_axes - 1; a >= 0; a--) {
      p->label[a] = s->axis[a].choice[rest % s->axis[a].n].label;
      rest /= s->axis[a].n;
    }
    for (PetscInt a = 0; a < s->n_axes; a++) {
      for (PetscInt i = 0; i < s->axis[a].n; i++) {
        const SweepChoice *choice = &s->axis[a].choice[i];
        for (PetscInt j = 0; j < choice->n && choice->label == p->label[a]; j++) p->setting[p->n++] = choice->setting[j];
      }
    }
    ByCall(ReadWith(s, p->n, p->setting, &p->scene));
    NamePoint(s, k);
    s->n_points++;
  }
  if (s->n_reference) ByCall(AddReferencePoint(s));
  for (PetscInt k = 0; k < s->n_points; k++) {
    PetscCall(PetscSNPrintf(s->point[k].directory, PETSC_MAX_PATH_LEN, "%s/%s", s->params.directory, s->point[k].name));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
