/* keys.c - one parser of textual values for defaults, options and the check of scenes. */
#include "keys.h"

#include <petscviewer.h>

#include <ctype.h>
#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>
#include <sys/stat.h>
#include <unistd.h>

/* one parsed value of any type; KEY_REAL uses real[0] */
typedef union {
  PetscReal real[3];
  PetscInt  integer;
  PetscBool boolean;
  int       choice;
  Names     names;
  Reals     reals;
  char      text[PETSC_MAX_PATH_LEN];
} KeyValue;

/* bounds at and beyond this size are no bounds: tables write PETSC_MAX_REAL, DBL_MAX or INFINITY */
#define UNBOUNDED 1e300

static size_t ValueSize(KeyType type)
{
  switch (type) {
  case KEY_REAL: return sizeof(PetscReal);
  case KEY_INT: return sizeof(PetscInt);
  case KEY_BOOL: return sizeof(PetscBool);
  case KEY_VEC3: return 3 * sizeof(PetscReal);
  case KEY_NAMES: return sizeof(Names);
  case KEY_REALS: return sizeof(Reals);
  case KEY_CHOICE: return sizeof(int);
  case KEY_STRING:
  case KEY_FILE: return PETSC_MAX_PATH_LEN;
  }
  return 0;
}

/* optimal string alignment: insert, delete, change a letter or swap two neighbours, without regard to case; words longer than a
   name count as far apart */
PetscInt KeyDistance(const char a[], const char b[])
{
  const size_t n_a = strlen(a), n_b = strlen(b);
  PetscInt     rows[3][BY_NAME_MAX + 1], *above = rows[0], *row = rows[1], *oldest = rows[2];

  if (n_a > BY_NAME_MAX || n_b > BY_NAME_MAX) return BY_NAME_MAX;
  for (size_t j = 0; j <= n_b; j++) row[j] = (PetscInt)j;
  for (size_t i = 1; i <= n_a; i++) {
    PetscInt *const next = oldest;

    oldest = above;
    above  = row;
    row    = next;
    row[0] = (PetscInt)i;
    for (size_t j = 1; j <= n_b; j++) {
      const int      c_a = tolower((unsigned char)a[i - 1]), c_b = tolower((unsigned char)b[j - 1]);
      const PetscInt shorter = PetscMin(above[j], row[j - 1]) + 1;

      row[j] = PetscMin(shorter, above[j - 1] + (c_a != c_b));
      if (i > 1 && j > 1 && c_a == tolower((unsigned char)b[j - 2]) && c_b == tolower((unsigned char)a[i - 2])) {
        row[j] = PetscMin(row[j], oldest[j - 2] + 1);
      }
    }
  }
  return row[n_b];
}

PetscBool KeyIsNear(const char word[], const char known[])
{
  const PetscInt distance = KeyDistance(word, known);
  const size_t   longest  = PetscMax(strlen(word), strlen(known));

  /* a third of a short word is another word: "at" is not a misspelt "min" */
  return (PetscBool)(distance < 3 && 2 * (size_t)distance <= longest);
}

static int Append(char text[], size_t n, const char format[], ...) PETSC_ATTRIBUTE_FORMAT(3, 4);
static int Append(char text[], size_t n, const char format[], ...)
{
  const size_t used = strlen(text);
  va_list      arguments;
  int          length;

  va_start(arguments, format);
  length = vsnprintf(text + used, n - used, format, arguments);
  va_end(arguments);
  return length;
}

static PetscBool HasUnit(const Key *key) { return (PetscBool)(key->unit && key->unit[0] && strcmp(key->unit, "1")); }

/* a list of numbers */
static PetscBool IsList(const Key *key) { return (PetscBool)(key->type == KEY_VEC3 || key->type == KEY_REALS); }

static PetscBool HasRange(const Key *key) { return (PetscBool)(key->lo < key->hi); }

static void AppendRange(const Key *key, char text[], size_t n)
{
  const PetscBool below = (PetscBool)(HasRange(key) && key->lo > -UNBOUNDED);
  PetscBool       above = (PetscBool)(HasRange(key) && key->hi < UNBOUNDED);

  if (key->type == KEY_INT && key->hi >= PETSC_MAX_INT) above = PETSC_FALSE;
  if (below) Append(text, n, " %s %g", key->flags & KEY_LO_OPEN ? ">" : ">=", key->lo);
  if (above) Append(text, n, "%s %s %g", below ? " and" : "", key->flags & KEY_HI_OPEN ? "<" : "<=", key->hi);
}

/* "a finite number > 0 [Pa s]": what may be written for a key */
PetscErrorCode KeyDescribe(const Key *key, char text[], size_t n)
{
  PetscFunctionBegin;
  text[0] = 0;
  switch (key->type) {
  case KEY_REAL: Append(text, n, "a finite number"); break;
  case KEY_INT: Append(text, n, "an integer"); break;
  case KEY_BOOL: Append(text, n, "true or false"); break;
  case KEY_VEC3: Append(text, n, "three finite numbers [x, y, z]"); break;
  case KEY_REALS: Append(text, n, "a list of finite numbers"); break;
  case KEY_STRING: Append(text, n, "text"); break;
  case KEY_FILE: Append(text, n, "an existing file"); break;
  case KEY_NAMES: Append(text, n, key->choices ? "a list out of" : "a list of names"); break;
  case KEY_CHOICE: Append(text, n, "one of"); break;
  }
  if (key->choices) {
    for (PetscInt i = 0; key->choices[i]; i++) Append(text, n, "%s %s", i ? "," : "", key->choices[i]);
  }
  if (key->type == KEY_REAL || key->type == KEY_INT || IsList(key)) {
    if (IsList(key) && HasRange(key) && (key->lo > -UNBOUNDED || key->hi < UNBOUNDED)) Append(text, n, ", each");
    AppendRange(key, text, n);
    if (HasUnit(key)) Append(text, n, "%s [%s]", IsList(key) ? " in" : "", key->unit);
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

/* Why a value is refused: `what`, then on the next line what is allowed, with the default as an example. */
static PetscBool Refuse(const Key *key, const char what[], char why[], size_t n_why)
{
  char allowed[512];

  (void)KeyDescribe(key, allowed, sizeof allowed);
  snprintf(why, n_why, "%s\nexpected %s", what, allowed);
  if (key->def && key->def[0] && !key->choices && key->type != KEY_BOOL) Append(why, n_why, ", for example %s", key->def);
  return PETSC_FALSE;
}

static PetscBool ParseReal(const Key *key, const char text[], PetscReal *value, char why[], size_t n_why)
{
  char  *end = NULL;
  double x;

  x = strtod(text, &end);
  if (end == text) return Refuse(key, text[0] ? "is not a number" : "is empty", why, n_why);
  while (isspace((unsigned char)*end)) end++;
  if (*end) return Refuse(key, "has text after the number (write the number alone, in SI units)", why, n_why);
  if (!isfinite(x)) return Refuse(key, "is not a finite number", why, n_why);
  if (HasRange(key)) {
    const PetscBool low  = (PetscBool)(key->flags & KEY_LO_OPEN ? x <= key->lo : x < key->lo);
    const PetscBool high = (PetscBool)(key->flags & KEY_HI_OPEN ? x >= key->hi : x > key->hi);
    if (low || high) return Refuse(key, "is out of range", why, n_why);
  }
  *value = x;
  return PETSC_TRUE;
}

static PetscBool ParseInt(const Key *key, const char text[], PetscInt *value, char why[], size_t n_why)
{
  PetscReal x;

  if (!ParseReal(key, text, &x, why, n_why)) return PETSC_FALSE;
  if (x != floor(x)) return Refuse(key, "is not an integer", why, n_why);
  if (fabs(x) > PETSC_MAX_INT) return Refuse(key, "is out of range", why, n_why);
  *value = (PetscInt)x;
  return PETSC_TRUE;
}

static PetscBool ParseBool(const Key *key, const char text[], PetscBool *value, char why[], size_t n_why)
{
  static const char *const words[] = {"false", "true", "no", "yes", "off", "on", "0", "1"};

  for (int i = 0; i < 8; i++) {
    if (!strcasecmp(text, words[i])) {
      *value = (PetscBool)(i % 2);
      return PETSC_TRUE;
    }
  }
  return Refuse(key, text[0] ? "is neither true nor false" : "is empty", why, n_why);
}

static PetscInt FindChoice(const char *const choices[], const char word[])
{
  for (PetscInt i = 0; choices[i]; i++) {
    if (!strcmp(choices[i], word)) return i;
  }
  return -1;
}

static PetscBool RefuseChoice(const Key *key, const char word[], char why[], size_t n_why)
{
  const char *nearest = NULL;
  char        what[BY_NAME_MAX + 32];

  snprintf(what, sizeof what, "is not known");
  if (key->type == KEY_NAMES) snprintf(what, sizeof what, "has the unknown word %.*s", BY_NAME_MAX, word);
  (void)Refuse(key, what, why, n_why);
  for (PetscInt i = 0; key->choices[i]; i++) {
    const char *choice = key->choices[i];
    if (KeyIsNear(word, choice) && (!nearest || KeyDistance(word, choice) < KeyDistance(word, nearest))) nearest = choice;
  }
  if (nearest) Append(why, n_why, "\ndid you mean %s?", nearest);
  return PETSC_FALSE;
}

/* next item of "a, b, c" or "[a, b, c]" without the blanks around it; PETSC_FALSE after the last */
static PetscBool NextItem(const char **cursor, char item[], size_t n)
{
  const char *start = *cursor, *end;

  if (!start) return PETSC_FALSE;
  end     = strchr(start, ',');
  *cursor = end ? end + 1 : NULL;
  if (!end) end = start + strlen(start);
  while (start < end && isspace((unsigned char)*start)) start++;
  while (end > start && isspace((unsigned char)end[-1])) end--;
  snprintf(item, n, "%.*s", (int)PetscMin((size_t)(end - start), n - 1), start);
  return PETSC_TRUE;
}

static PetscBool ParseVec3(const Key *key, const char text[], PetscReal value[3], char why[], size_t n_why)
{
  const char *cursor = text;
  char        item[128];
  PetscInt    n = 0;

  while (NextItem(&cursor, item, sizeof item)) {
    PetscReal x;
    if (!ParseReal(key, item, &x, why, n_why)) return PETSC_FALSE;
    if (n < 3) value[n] = x;
    n++;
  }
  if (n != 3) return Refuse(key, "does not have three components", why, n_why);
  return PETSC_TRUE;
}

static PetscBool ParseReals(const Key *key, const char text[], Reals *value, char why[], size_t n_why)
{
  const char *cursor = text;
  char        item[128];

  value->n = 0;
  if (text[strspn(text, " \t")] == 0) return PETSC_TRUE;
  while (NextItem(&cursor, item, sizeof item)) {
    if (value->n == BY_REALS_MAX) return Refuse(key, "has more than 16 numbers", why, n_why);
    if (!ParseReal(key, item, &value->value[value->n], why, n_why)) return PETSC_FALSE;
    value->n++;
  }
  return PETSC_TRUE;
}

static PetscBool ParseNames(const Key *key, const char text[], Names *value, char why[], size_t n_why)
{
  const char *cursor = text;
  char        item[BY_NAME_MAX + 1], what[BY_NAME_MAX + 64];

  value->n = 0;
  if (text[strspn(text, " \t")] == 0) return PETSC_TRUE;
  while (NextItem(&cursor, item, sizeof item)) {
    if (!item[0]) return Refuse(key, "has an empty name", why, n_why);
    if (strlen(item) >= BY_NAME_MAX) return Refuse(key, "has a name longer than 63 letters", why, n_why);
    if (key->choices && FindChoice(key->choices, item) < 0) return RefuseChoice(key, item, why, n_why);
    for (PetscInt i = 0; i < value->n; i++) {
      if (!strcmp(value->name[i], item)) {
        snprintf(what, sizeof what, "has %s twice", item);
        return Refuse(key, what, why, n_why);
      }
    }
    if (value->n == BY_NAMES_MAX) return Refuse(key, "has more than 32 names", why, n_why);
    strcpy(value->name[value->n++], item);
  }
  return PETSC_TRUE;
}

static PetscBool ParseText(const Key *key, const char text[], char value[], char why[], size_t n_why)
{
  if (strlen(text) >= PETSC_MAX_PATH_LEN) return Refuse(key, "is too long", why, n_why);
  strcpy(value, text);
  return PETSC_TRUE;
}

/* The parser: text as a user writes it -> value; what is wrong and what is allowed go to `why`. */
static PetscBool Parse(const Key *key, const char given[], KeyValue *value, char why[], size_t n_why)
{
  const char *start = given + strspn(given, " \t\r\n");
  size_t      n     = strlen(start);
  char        text[PETSC_MAX_PATH_LEN];

  why[0] = 0;
  memset(value, 0, sizeof *value);
  if (key->type == KEY_STRING || key->type == KEY_FILE) return ParseText(key, given, value->text, why, n_why);
  while (n && isspace((unsigned char)start[n - 1])) n--;
  if (n >= sizeof text) return Refuse(key, "is too long", why, n_why);

  /* lists may wear brackets */
  if ((IsList(key) || key->type == KEY_NAMES) && n >= 2 && start[0] == '[' && start[n - 1] == ']') {
    start++;
    n -= 2;
  }
  memcpy(text, start, n);
  text[n] = 0;
  switch (key->type) {
  case KEY_REAL: return ParseReal(key, text, &value->real[0], why, n_why);
  case KEY_INT: return ParseInt(key, text, &value->integer, why, n_why);
  case KEY_BOOL: return ParseBool(key, text, &value->boolean, why, n_why);
  case KEY_VEC3: return ParseVec3(key, text, value->real, why, n_why);
  case KEY_REALS: return ParseReals(key, text, &value->reals, why, n_why);
  case KEY_NAMES: return ParseNames(key, text, &value->names, why, n_why);
  case KEY_CHOICE:
    value->choice = (int)FindChoice(key->choices, text);
    return value->choice >= 0 ? PETSC_TRUE : RefuseChoice(key, text, why, n_why);
  case KEY_STRING:
  case KEY_FILE: break;
  }
  return PETSC_FALSE;
}

PetscErrorCode KeysSetDefaults(const Key keys[], void *params)
{
  KeyValue value;
  char     why[1024];

  PetscFunctionBegin;
  for (const Key *key = keys; key->name; key++) {
    memset(&value, 0, sizeof value);
    if (key->def && key->def[0]) {
      PetscCheck(Parse(key, key->def, &value, why, sizeof why), PETSC_COMM_SELF, PETSC_ERR_PLIB, "default %s of %s %s", key->def,
                 key->name, why);
    }
    memcpy((char *)params + key->offset, &value, ValueSize(key->type));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode KeysSetFromOptions(const Key keys[], const char prefix[], void *params)
{
  KeyValue  value;
  char      option[2 * BY_NAME_MAX], text[PETSC_MAX_PATH_LEN], why[1024];
  PetscBool set;

  PetscFunctionBegin;
  for (const Key *key = keys; key->name; key++) {
    PetscCall(PetscSNPrintf(option, sizeof option, "-%s", key->name));
    PetscCall(PetscOptionsGetString(NULL, prefix && prefix[0] ? prefix : NULL, option, text, sizeof text, &set));
    if (!set) continue;

    /* an option without a value switches something on */
    if (!text[0] && key->type == KEY_BOOL) strcpy(text, "true");
    PetscCheck(Parse(key, text, &value, why, sizeof why), PETSC_COMM_SELF, PETSC_ERR_ARG_OUTOFRANGE, "-%s%s = %s %s",
               prefix ? prefix : "", key->name, text, why);
    memcpy((char *)params + key->offset, &value, ValueSize(key->type));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

static void FormatValue(const Key *key, const void *at, char text[], size_t n)
{
  const PetscReal *real  = (const PetscReal *)at;
  const Names     *names = (const Names *)at;
  const Reals     *reals = (const Reals *)at;

  text[0] = 0;
  switch (key->type) {
  case KEY_REAL: Append(text, n, "%g", real[0]); break;
  case KEY_INT: Append(text, n, "%" PetscInt_FMT, *(const PetscInt *)at); break;
  case KEY_BOOL: Append(text, n, "%s", *(const PetscBool *)at ? "true" : "false"); break;
  case KEY_VEC3: Append(text, n, "%g, %g, %g", real[0], real[1], real[2]); break;
  case KEY_REALS:
    for (PetscInt i = 0; i < reals->n; i++) Append(text, n, "%s%g", i ? ", " : "", reals->value[i]);
    break;
  case KEY_CHOICE: Append(text, n, "%s", key->choices[*(const int *)at]); break;
  case KEY_NAMES:
    for (PetscInt i = 0; i < names->n; i++) Append(text, n, "%s%s", i ? ", " : "", names->name[i]);
    break;
  case KEY_STRING:
  case KEY_FILE: Append(text, n, "%s", (const char *)at); break;
  }
}

PetscErrorCode KeysView(const Key keys[], const void *params, PetscViewer viewer)
{
  char      text[PETSC_MAX_PATH_LEN];
  PetscBool ascii;

  PetscFunctionBegin;
  PetscCall(PetscObjectTypeCompare((PetscObject)viewer, PETSCVIEWERASCII, &ascii));
  if (!ascii) PetscFunctionReturn(PETSC_SUCCESS);
  for (const Key *key = keys; key->name; key++) {
    FormatValue(key, (const char *)params + key->offset, text, sizeof text);
    PetscCall(PetscViewerASCIIPrintf(viewer, "%s = %s", key->name, text[0] ? text : "(none)"));
    PetscCall(PetscViewerASCIIUseTabs(viewer, PETSC_FALSE));
    PetscCall(PetscViewerASCIIPrintf(viewer, HasUnit(key) ? " [%s]\n" : "\n", key->unit));
    PetscCall(PetscViewerASCIIUseTabs(viewer, PETSC_TRUE));
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode KeyCheck(const Key *key, const char value[], char why[], size_t n_why)
{
  KeyValue    parsed;
  struct stat status;

  PetscFunctionBegin;
  if (!Parse(key, value, &parsed, why, n_why)) PetscFunctionReturn(PETSC_SUCCESS);
  if (key->type == KEY_FILE) {
    if (!value[0]) (void)Refuse(key, "is empty", why, n_why);
    else if (stat(value, &status) || access(value, R_OK)) snprintf(why, n_why, "cannot be read: %s", strerror(errno));
    else if (!S_ISREG(status.st_mode)) snprintf(why, n_why, "is not a file");
  }
  PetscFunctionReturn(PETSC_SUCCESS);
}
