/* tled_field.c - fields that a gmsh file gives on its elements: an $ElementData view of vectors, by its name. */
#include "tled/tled_impl.h"
#include <errno.h>
#include <string.h>

#define MOST_TAGS 16 /* strings, numbers and whole numbers at the head of a view; gmsh writes 1 or 2, 1, 3 or 4 */

typedef struct {
  FILE       *stream;
  const char *key, *path;
  char        names[256]; /* of the views seen, for messages */
} Reader;

static PetscErrorCode Broken(const Reader *r, const char what[])
{
  return InputError(r->key, "names a view of %s, which is broken: %s\n  expected $ElementData as gmsh writes it into text files", r->path, what);
}

/* the next line, without its end; a longer one is cut */
static PetscBool NextLine(const Reader *r, char line[256])
{
  if (!fgets(line, 256, r->stream)) return PETSC_FALSE;
  if (!strchr(line, '\n')) {
    for (int c = fgetc(r->stream); c != EOF && c != '\n';) c = fgetc(r->stream);
  }
  line[strcspn(line, "\r\n")] = 0;
  return PETSC_TRUE;
}

/* a count at the head of a view and that many lines after it, of which the first goes to `first` */
static PetscBool ReadTags(const Reader *r, int least, int numbers[], char first[256])
{
  char line[256];
  int  n;

  if (!NextLine(r, line) || sscanf(line, "%d", &n) != 1 || n < least || n > MOST_TAGS) return PETSC_FALSE;
  for (int i = 0; i < n; i++) {
    if (!NextLine(r, line) || (numbers && sscanf(line, "%d", &numbers[i]) != 1)) return PETSC_FALSE;
    if (i == 0 && first) snprintf(first, 256, "%s", line);
  }
  return PETSC_TRUE;
}

/* Go to the values of the view `name`; n is how many elements have one. */
static PetscErrorCode FindView(Reader *r, const char name[], int *n)
{
  char   line[256], quoted[256], first[256];
  double version = 0.0;
  int    binary = 0, numbers[MOST_TAGS];

  PetscFunctionBegin;
  snprintf(quoted, sizeof quoted, "\"%.250s\"", name);
  while (NextLine(r, line)) {
    if (!strcmp(line, "$MeshFormat") && NextLine(r, line)) (void)sscanf(line, "%lf %d", &version, &binary);
    if (strcmp(line, "$ElementData")) continue;
    if (binary) PetscFunctionReturn(InputError(r->key, "names a view of %s, a binary file\n  expected a text file (gmsh without -bin)", r->path));
    if (!ReadTags(r, 1, NULL, first) || !ReadTags(r, 0, NULL, NULL) || !ReadTags(r, 3, numbers, NULL))
      PetscFunctionReturn(Broken(r, "the head of a view cannot be read"));
    if (!strcmp(first, quoted)) {
      if (numbers[1] != 3)
        PetscFunctionReturn(InputError(r->key, "names the view %s of %s, which has %d numbers an element\n  expected a view of vectors, with 3",
                                       name, r->path, numbers[1]));
      if (numbers[2] < 0) PetscFunctionReturn(Broken(r, "the head of a view cannot be read"));
      *n = numbers[2];
      PetscFunctionReturn(PETSC_SUCCESS);
    }
    if (strlen(r->names) + strlen(first) + 3 < sizeof r->names) strcat(strcat(r->names, r->names[0] ? ", " : ""), first);
  }
  PetscFunctionReturn(InputError(r->key, "names the view %s, which %s does not have\n  views on elements in the mesh: %s", name, r->path,
                                 r->names[0] ? r->names : "none ($ElementData)"));
}

/* the vectors of n elements, by the elements' numbers in the file: value[3 place[number - first]]; numbers without a place are others' */
static PetscErrorCode ReadVectors(const Reader *r, int n, PetscInt first, PetscInt n_place, const PetscInt place[], PetscReal value[])
{
  PetscFunctionBegin;
  for (int i = 0; i < n; i++) {
    char   line[256];
    long   number;
    double v[3];
    if (!NextLine(r, line) || sscanf(line, "%ld %lf %lf %lf", &number, &v[0], &v[1], &v[2]) != 4 || !isfinite(v[0]) || !isfinite(v[1]) ||
        !isfinite(v[2]))
      PetscFunctionReturn(Broken(r, "a line is not an element's number and three finite numbers"));
    if (number < first || number - first >= n_place || place[number - first] < 0) continue;
    for (int k = 0; k < 3; k++) value[3 * place[number - first] + k] = v[k];
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static PetscErrorCode ReadView(Reader *r, const char name[], const TLEDMesh *mesh, PetscReal value[])
{
  PetscInt       first = PETSC_MAX_INT, last = 0, *place;
  int            n     = 0;
  PetscErrorCode ierr;

  PetscFunctionBegin;
  ByCall(FindView(r, name, &n));
  for (PetscInt e = 0; e < mesh->n_tets; e++) first = PetscMin(first, mesh->tag[e]), last = PetscMax(last, mesh->tag[e]);
  PetscCall(PetscMalloc1(last - first + 1, &place));
  for (PetscInt i = 0; i <= last - first; i++) place[i] = -1;
  for (PetscInt e = 0; e < mesh->n_tets; e++) place[mesh->tag[e] - first] = e;
  ierr = ReadVectors(r, n, first, last - first + 1, place, value);
  PetscCall(PetscFree(place));
  ByCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}

/*
  TLEDFieldRead_Private - vectors on the elements of a mesh, from a view in its file

  Input Parameters:
+ key  - the scene key that names the view, for messages
. path - the mesh file: text, format 4.1 or 2.2
. name - name of the view, as gmsh shows it; of several steps the first
- mesh - the elements, with their numbers in the file

  Output Parameter:
. value - n_tets x 3, zero for an element without a value

  Errors: BY_ERR_INPUT, reported: no such view, not vectors, a binary file, broken
*/
PetscErrorCode TLEDFieldRead_Private(const char key[], const char path[], const char name[], const TLEDMesh *mesh, PetscReal value[])
{
  Reader         reader = {NULL, key, strrchr(path, '/') ? strrchr(path, '/') + 1 : path, ""};
  PetscErrorCode ierr;

  PetscFunctionBegin;
  PetscCall(PetscArrayzero(value, 3 * mesh->n_tets));
  reader.stream = fopen(path, "r");
  if (!reader.stream) PetscFunctionReturn(InputError(key, "cannot be opened: %s (%s)", path, strerror(errno)));
  ierr = ReadView(&reader, name, mesh, value);
  fclose(reader.stream);
  ByCall(ierr);
  PetscFunctionReturn(PETSC_SUCCESS);
}
