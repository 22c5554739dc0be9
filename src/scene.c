/* scene.c - life of a scene, and the reports about the user's input. */
#include "scene_impl.h"
#include "output.h"

#include <errno.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

/* a scene is written by hand: a larger file is something else */
#define SCENE_BYTES_MAX (1 << 20)

/* line of an error that has none */
#define WHOLE_FILE (-1)

/* the scene that InputError looks into, and what it has reported: the user's input is one per process */
static Scene    open_scene   = NULL;
static PetscInt input_errors = 0;

/* Print "place: text", the further lines of text indented by two spaces; rank 0 only. */
static void Report(const char place[], const char text[])
{
  input_errors++;
  if (PetscGlobalRank) return;
  fprintf(stderr, "%s: ", place);
  for (const char *line = text, *end; line; line = end ? end + 1 : NULL) {
    end = strchr(line, '\n');
    if (line != text) {
      line += strspn(line, " ");
      fputs("  ", stderr);
    }
    fprintf(stderr, "%.*s\n", end ? (int)(end - line) : (int)strlen(line), line);
  }
}

PetscErrorCode SceneAddError(Scene scene, int line, const char format[], ...)
{
  char    text[2 * PETSC_MAX_PATH_LEN];
  va_list arguments;

  PetscFunctionBegin;
  va_start(arguments, format);
  vsnprintf(text, sizeof text, format, arguments);
  va_end(arguments);
  if (scene->n_errors == scene->capacity_errors) {
    scene->capacity_errors = 2 * scene->capacity_errors + 8;
    PetscCall(PetscRealloc((size_t)scene->capacity_errors * sizeof *scene->errors, &scene->errors));
  }
  scene->errors[scene->n_errors].line = line;
  PetscCall(PetscStrallocpy(text, &scene->errors[scene->n_errors].text));
  scene->n_errors++;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* errors in the order of lines, those of the command line last; insertion keeps the order within a line */
static void SortErrors(Scene scene)
{
  for (PetscInt i = 1; i < scene->n_errors; i++) {
    const SceneError error = scene->errors[i];
    PetscInt         j     = i;

    while (j > 0 && (scene->errors[j - 1].line ? scene->errors[j - 1].line : INT_MAX) > (error.line ? error.line : INT_MAX)) {
      scene->errors[j] = scene->errors[j - 1];
      j--;
    }
    scene->errors[j] = error;
  }
}

static void PrintErrors(Scene scene)
{
  char place[PETSC_MAX_PATH_LEN + 32];

  SortErrors(scene);
  for (PetscInt i = 0; i < scene->n_errors; i++) {
    if (scene->errors[i].line == WHOLE_FILE) snprintf(place, sizeof place, "%s", scene->path);
    else if (scene->errors[i].line) snprintf(place, sizeof place, "%s:%d", scene->path, scene->errors[i].line);
    else snprintf(place, sizeof place, "command line");
    Report(place, scene->errors[i].text);
  }
  if (!PetscGlobalRank)
    fprintf(stderr, "%" PetscInt_FMT " error%s in %s; nothing was run\n", scene->n_errors, scene->n_errors == 1 ? "" : "s",
            scene->path);
}

static PetscErrorCode ReadText(Scene scene)
{
  FILE  *file;
  size_t n = 0;

  PetscFunctionBegin;
  PetscCall(PetscMalloc1(SCENE_BYTES_MAX + 1, &scene->text));
  file = fopen(scene->path, "rb");
  if (file) n = fread(scene->text, 1, SCENE_BYTES_MAX + 1, file);
  if (!file || ferror(file)) {
    PetscCall(SceneAddError(scene, WHOLE_FILE, "the scene cannot be read: %s", strerror(errno)));
    n = 0;
  } else if (n > SCENE_BYTES_MAX) {
    PetscCall(SceneAddError(scene, WHOLE_FILE, "larger than 1 MB: this is not a scene"));
    n = 0;
  } else if (memchr(scene->text, 0, n)) {
    PetscCall(SceneAddError(scene, WHOLE_FILE, "has zero bytes: this is not a text"));
    n = 0;
  }
  scene->text[n] = 0;
  if (file) fclose(file);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* "-name value ..." -> overrides; a value may begin with a dash when a number follows */
static PetscErrorCode ReadOverrides(Scene scene, int argc, char *argv[])
{
  PetscFunctionBegin;
  PetscCall(PetscCalloc1((size_t)argc + 1, &scene->overrides));
  for (int i = 0; i < argc; i++) {
    const char *name = argv[i];
    Override   *o    = &scene->overrides[scene->n_overrides];

    if (name[0] != '-' || !strchr("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ", name[1]) || !name[1]) {
      PetscCall(SceneAddError(scene, 0, "%.80s is not an option\nwrite -key value, for example -sph_spacing 0.01", name));
      continue;
    }
    PetscCall(PetscStrncpy(o->name, name + 1, sizeof o->name));
    if (i + 1 < argc && (argv[i + 1][0] != '-' || strspn(argv[i + 1] + 1, "0123456789.") > 0)) o->value = argv[++i];
    for (PetscInt k = 0; k < scene->n_overrides; k++) {
      if (!strcmp(scene->overrides[k].name, o->name)) PetscCall(SceneAddError(scene, 0, "-%s is given twice", o->name));
    }
    scene->n_overrides++;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneRead(const char file[], int argc, char *argv[], const SceneSection sections[], Scene *scene)
{
  Scene       s;
  const char *slash = strrchr(file, '/');

  PetscFunctionBegin;
  *scene = NULL;
  PetscCall(PetscNew(&s));
  PetscCall(PetscStrallocpy(file, &s->path));
  if (slash) PetscCall(PetscStrncpy(s->directory, file, PetscMin((size_t)(slash - file) + 2, sizeof s->directory)));
  PetscCall(ReadOverrides(s, argc, argv));
  PetscCall(ReadText(s));
  if (s->text[0] || !s->n_errors) PetscCall(SceneParse(s));
  if (s->root && s->root->kind == NODE_MAP) PetscCall(SceneCheck(s, sections));
  if (s->n_errors) {
    PrintErrors(s);
    PetscCall(SceneDestroy(&s));
    PetscFunctionReturn(BY_ERR_INPUT);
  }
  PetscCall(SceneToOptions(s));
  open_scene = s;
  *scene     = s;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneDestroy(Scene *scene)
{
  Scene s = *scene;

  PetscFunctionBegin;
  if (!s) PetscFunctionReturn(PETSC_SUCCESS);
  if (open_scene == s) open_scene = NULL;
  for (PetscInt i = 0; i < s->n_errors; i++) PetscCall(PetscFree(s->errors[i].text));
  NodeDestroy(&s->root);
  PetscCall(PetscFree(s->errors));
  PetscCall(PetscFree(s->blocks));
  PetscCall(PetscFree(s->overrides));
  PetscCall(PetscFree(s->text));
  PetscCall(PetscFree(s->path));
  PetscCall(PetscFree(*scene));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneHas(Scene scene, const char section[], PetscBool *present)
{
  PetscFunctionBegin;
  *present = PETSC_FALSE;
  for (PetscInt i = 0; i < scene->n_blocks; i++) {
    if (!strcmp(scene->blocks[i].path, section) && scene->blocks[i].node) *present = PETSC_TRUE;
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneGetText(Scene scene, const char *text[])
{
  PetscFunctionBegin;
  *text = scene->text;
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneGetPath(Scene scene, const char *path[])
{
  PetscFunctionBegin;
  *path = scene->path;
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* text on one line, whatever it holds */
static void WriteComment(const char text[], FILE *out)
{
  for (const unsigned char *c = (const unsigned char *)text; *c; c++) fputc(*c < ' ' || *c == 127 ? '?' : *c, out);
}

PetscErrorCode SceneWrite(Scene scene, const char path[])
{
  FILE     *out;
  PetscBool failed;

  PetscFunctionBegin;
  if (PetscGlobalRank) PetscFunctionReturn(PETSC_SUCCESS);
  errno  = 0;
  out    = fopen(path, "w");
  failed = (PetscBool)(out == NULL);
  if (out) {
    fprintf(out, "# as run: ");
    WriteComment(scene->path, out);
    for (PetscInt i = 0; i < scene->n_overrides; i++) {
      fprintf(out, " -");
      WriteComment(scene->overrides[i].name, out);
      fputc(' ', out);
      WriteComment(scene->overrides[i].value ? scene->overrides[i].value : "", out);
    }
    fputc('\n', out);
    PetscCall(NodeWrite(scene->root, NULL, out));
    if (ferror(out)) failed = PETSC_TRUE;
    if (fclose(out)) failed = PETSC_TRUE;
  }
  if (failed) {
    fprintf(stderr, "%s: cannot be written: %s\n", path, strerror(errno));
    PetscFunctionReturn(BY_ERR_OUTPUT);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode SceneFormat(Scene scene, const char without[], char **text)
{
  size_t n;
  FILE  *out = open_memstream(text, &n);

  PetscFunctionBegin;
  PetscCheck(out, PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for the text of a scene");
  PetscCall(NodeWrite(scene->root, without, out));
  for (PetscInt i = 0; i < scene->n_overrides; i++) {
    if (!scene->overrides[i].used) fprintf(out, "# -%s %s\n", scene->overrides[i].name, scene->overrides[i].value ? scene->overrides[i].value : "");
  }
  PetscCheck(!fclose(out), PETSC_COMM_SELF, PETSC_ERR_MEM, "no memory for the text of a scene");
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Options that pass through to PETSc and that nothing has asked for. */
PetscErrorCode SceneReportUnused(Scene scene)
{
  PetscBool used;

  PetscFunctionBegin;
  for (PetscInt i = 0; i < scene->n_overrides; i++) {
    if (scene->overrides[i].used) continue;

    /* PetscOptionsUsed compares with names that have lost their dash */
    PetscCall(PetscOptionsUsed(NULL, scene->overrides[i].name, &used));
    if (!used && !PetscGlobalRank) fprintf(stderr, "warning: nothing in this run uses the option -%s\n", scene->overrides[i].name);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* the block of a dotted key and the rest of the key behind it: "flap.proxy.adaptive" -> flap.proxy, "adaptive" */
static const Block *FindBlock(Scene scene, const char key[], const char **rest)
{
  const Block *found = NULL;
  size_t       most  = 0;

  for (PetscInt i = 0; i < scene->n_blocks; i++) {
    const size_t n = strlen(scene->blocks[i].path);

    if (found && n <= most) continue;
    if (n && (strncmp(key, scene->blocks[i].path, n) || (key[n] && key[n] != '.'))) continue;
    found = &scene->blocks[i];
    *rest = n ? key + n + (key[n] == '.') : key;
    most  = n;
  }
  return found;
}

PetscErrorCode InputError(const char key[], const char format[], ...)
{
  char         what[2 * PETSC_MAX_PATH_LEN], place[PETSC_MAX_PATH_LEN + 128], value[512] = "", text[3 * PETSC_MAX_PATH_LEN];
  const char  *rest = key, *def = NULL;
  const Block *block = NULL;
  const Node  *node  = NULL;
  va_list      arguments;
  int          line = 0;

  va_start(arguments, format);
  vsnprintf(what, sizeof what, format, arguments);
  va_end(arguments);
  if (open_scene) block = FindBlock(open_scene, key, &rest);
  if (block) {
    node = NodeFind(block->node, rest);
    if (node) line = node->line;
    else if (block->node && block->node->key) line = block->node->line;
    for (const Key *row = block->section->keys; row->name; row++) {
      if (!strcmp(row->name, rest)) def = row->def;
    }
  }

  /* the value as the user wrote it, else the default that stands for it */
  if (node && node->kind != NODE_MAP) NodeFormat(node, value, sizeof value);
  else if (!node && def && def[0]) snprintf(value, sizeof value, "%s (default)", def);
  if (value[0]) snprintf(text, sizeof text, "%s = %s %s", key, value, what);
  else snprintf(text, sizeof text, "%s: %s", key, what);
  if (node && node->overridden) {
    snprintf(place, sizeof place, "command line");
    if (value[0]) snprintf(text, sizeof text, "-%s%s = %s %s", block->prefix, rest, value, what);
  } else if (line) snprintf(place, sizeof place, "%s:%d", open_scene->path, line);
  else snprintf(place, sizeof place, "%s", open_scene ? open_scene->path : "byssus");
  Report(place, text);
  return BY_ERR_INPUT;
}

PetscInt InputErrorCount(void) { return input_errors; }
