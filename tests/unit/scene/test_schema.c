/* test_schema.c - the tables of the whole program: complete rows, defaults that pass their own check, names that fit together. */
#include "coupler/coupler.h"
#include "check.h"

#include <string.h>

static void every_default_passes_its_own_check(void **state)
{
  char why[1024];

  (void)state;
  for (const SceneSection *section = CouplerSchema; section->name; section++) {
    for (const Key *key = section->keys; key->name; key++) {
      if (!key->def || !key->def[0]) continue;
      assert_petsc(KeyCheck(key, key->def, why, sizeof why));
      if (why[0]) fail_msg("%s: %s = %s %s", section->name, key->name, key->def, why);
    }
  }
}

static void every_row_has_help_unit_and_a_name_as_users_write_it(void **state)
{
  (void)state;
  for (const SceneSection *section = CouplerSchema; section->name; section++) {
    for (const Key *key = section->keys; key->name; key++) {
      const PetscBool number = (PetscBool)(key->type == KEY_REAL || key->type == KEY_INT || key->type == KEY_VEC3 || key->type == KEY_REALS);

      if (strspn(key->name, "abcdefghijklmnopqrstuvwxyz_0123456789") != strlen(key->name))
        fail_msg("%s: %s", section->name, key->name);
      if (!key->help || !key->help[0] || strchr(key->help, '|'))
        fail_msg("%s: %s has no help, or one that breaks the table", section->name, key->name);
      if (number && (!key->unit || !key->unit[0])) fail_msg("%s: %s is a number without unit", section->name, key->name);
      if (key->type == KEY_CHOICE && !key->choices) fail_msg("%s: %s is a choice of nothing", section->name, key->name);
      if (number && key->lo > key->hi)
        fail_msg("%s: %s has no value between %g and %g", section->name, key->name, key->lo, key->hi);
      for (const Key *other = section->keys; other < key; other++) assert_string_not_equal(other->name, key->name);
    }
  }
}

static void every_list_of_blocks_is_a_key_of_its_parent(void **state)
{
  (void)state;
  for (const SceneSection *section = CouplerSchema; section->name; section++) {
    PetscBool found = (PetscBool)(section->list == NULL);

    for (const SceneSection *parent = CouplerSchema; parent->name; parent++) {
      if (strcmp(parent->name, section->parent ? section->parent : "")) continue;
      for (const Key *key = parent->keys; key->name && section->list; key++) {
        if (!strcmp(key->name, section->list) && key->type == KEY_NAMES) found = PETSC_TRUE;
      }
    }
    if (!found) fail_msg("%s: no list %s", section->name, section->list);
  }
}

CHECK_MAIN(cmocka_unit_test(every_default_passes_its_own_check),
           cmocka_unit_test(every_row_has_help_unit_and_a_name_as_users_write_it),
           cmocka_unit_test(every_list_of_blocks_is_a_key_of_its_parent))
