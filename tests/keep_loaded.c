/* keep_loaded.c - in sanitized builds only: plugins stay loaded to the end, so that the leaks of OpenMPI's plugins carry the names by
   which tests/lsan.supp knows them. */

int dlclose(void *handle);

int dlclose(void *handle)
{
  (void)handle;
  return 0;
}
