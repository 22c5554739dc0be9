/* scene_keys.c - the table of all keys, for -help and the reference page. */
#include "scene.h"

#include <stdio.h>
#include <string.h>

/* how a section is addressed: "sph", "flap" for a body, "flap.proxy" */
static void SectionPath(const SceneSection sections[], const SceneSection *section, char path[], size_t n)
{
  char around[256] = "";

  for (const SceneSection *s = sections; s->name && section->parent; s++) {
    if (!strcmp(s->name, section->parent)) {
      SectionPath(sections, s, around, sizeof around);
      break;
    }
  }
  snprintf(path, n, "%s%s%s%s%s", around, around[0] ? "." : "", section->list ? "<" : "", section->name, section->list ? ">" : "");
}

/* "bodies", "sph.fill": the list that names blocks of a kind */
static void ListPath(const SceneSection sections[], const SceneSection *section, char path[], size_t n)
{
  const SceneSection plain = {section->list, NULL, section->parent, NULL, NULL};

  SectionPath(sections, &plain, path, n);
}

static void PrintSection(const SceneSection sections[], const SceneSection *section, PetscBool markdown, FILE *out)
{
  char path[256], list[256] = "", prefix[256], allowed[512];

  SectionPath(sections, section, path, sizeof path);
  if (section->list) ListPath(sections, section, list, sizeof list);
  for (char *c = strcpy(prefix, path); *c; c++) {
    if (*c == '.') *c = '_';
  }
  if (markdown) {
    fprintf(out, "\n## %s%s%s\n\n", path[0] ? "`" : "", path[0] ? path : "top of the scene", path[0] ? "`" : "");
    if (section->help || section->list) fprintf(out, "%s%s", section->help ? section->help : "", section->list ? "" : "\n\n");
    if (section->list) fprintf(out, "%sone section for each name in `%s`\n\n", section->help ? "; " : "", list);
    fprintf(out, "| key | value | default | meaning |\n| --- | --- | --- | --- |\n");
  } else {
    fprintf(out, "\n%s%s%s", path[0] ? path : "top of the scene", section->help ? ": " : "", section->help ? section->help : "");
    fprintf(out, section->list ? " (one for each name in %s)\n" : "\n", list);
  }
  for (const Key *key = section->keys; key->name; key++) {
    const char *def = key->flags & KEY_REQUIRED ? "required" : key->def && key->def[0] ? key->def : "none";

    (void)KeyDescribe(key, allowed, sizeof allowed);
    if (!(key->flags & KEY_REQUIRED) && !(key->def && key->def[0])) {
      if (key->type == KEY_REAL || key->type == KEY_INT) def = "0";
      else if (key->type == KEY_VEC3) def = "0, 0, 0";
      else if (key->type == KEY_BOOL) def = "false";
      else if (key->type == KEY_CHOICE) def = key->choices[0];
    }
    if (markdown) fprintf(out, "| `%s` | %s | %s | %s |\n", key->name, allowed, def, key->help);
    else fprintf(out, "  -%s%s%s <%s>\n      %s; %s\n", prefix, prefix[0] ? "_" : "", key->name, def, key->help, allowed);
  }
}

PetscErrorCode ScenePrintKeys(const SceneSection sections[], const char kind[], FILE *out)
{
  PetscBool markdown;

  PetscFunctionBegin;
  PetscCall(PetscStrcmp(kind, "markdown", &markdown));
  if (markdown)
    fprintf(out, "# Keys of a scene\n\nPrinted by `byssus info -keys`; every value in SI units. On the command line: `-section_key "
                 "value`.\n");
  else fprintf(out, "Keys of a scene as options: -section_key <default>; every value in SI units.\n");
  for (const SceneSection *section = sections; section->name; section++) PrintSection(sections, section, markdown, out);
  PetscFunctionReturn(PETSC_SUCCESS);
}
