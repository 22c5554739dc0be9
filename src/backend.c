/* backend.c - which backends were built, and what this machine has. */
#include "backend.h"

#include <gmshc.h>
#include <hdf5.h>
#include <metis.h>
#include <omp.h>
#include <petscviewer.h>
#include <yaml.h>

#if defined(BYSSUS_HAVE_CUDA)
#include <cuda_runtime_api.h>
#endif

PetscErrorCode BackendGetThreads(PetscInt *threads)
{
  *threads = omp_get_max_threads();
  return PETSC_SUCCESS;
}

PetscBool BackendHasCUDA(void)
{
#if defined(BYSSUS_HAVE_CUDA)
  return PETSC_TRUE;
#else
  return PETSC_FALSE;
#endif
}

PetscErrorCode BackendGetDevice(PetscInt *n_devices, char name[], size_t n_name)
{
  PetscFunctionBegin;
  *n_devices = 0;
  PetscCall(PetscStrncpy(name, "none", n_name));
#if defined(BYSSUS_HAVE_CUDA)
  {
    struct cudaDeviceProp properties;
    int                   count = 0;

    /* no driver is no device, not a failure */
    if (cudaGetDeviceCount(&count) == cudaSuccess && count > 0 && cudaGetDeviceProperties(&properties, 0) == cudaSuccess) {
      *n_devices = count;
      PetscCall(PetscStrncpy(name, properties.name, n_name));
    } else (void)cudaGetLastError();
  }
#endif
  PetscFunctionReturn(PETSC_SUCCESS);
}

const char *BackendGetVersion(void) { return BYSSUS_VERSION; }

const char *BackendGetRevision(void) { return BYSSUS_REVISION; }

static PetscErrorCode ViewLibraries(PetscViewer viewer)
{
  PetscInt major, minor, subminor;
  unsigned h5_major, h5_minor, h5_release;

  PetscFunctionBegin;
  PetscCall(PetscGetVersionNumber(&major, &minor, &subminor, NULL));
  PetscCall(PetscViewerASCIIPrintf(viewer, "PETSc           %" PetscInt_FMT ".%" PetscInt_FMT ".%" PetscInt_FMT "\n", major, minor,
                                   subminor));
  PetscCheck(H5get_libversion(&h5_major, &h5_minor, &h5_release) >= 0, PETSC_COMM_SELF, PETSC_ERR_LIB,
             "HDF5 does not tell its version");
  PetscCall(PetscViewerASCIIPrintf(viewer, "HDF5            %u.%u.%u\n", h5_major, h5_minor, h5_release));
  PetscCall(PetscViewerASCIIPrintf(viewer, "METIS           %d.%d.%d\n", METIS_VER_MAJOR, METIS_VER_MINOR, METIS_VER_SUBMINOR));
  PetscCall(PetscViewerASCIIPrintf(viewer, "gmsh            %s\n", GMSH_API_VERSION));
  PetscCall(PetscViewerASCIIPrintf(viewer, "libyaml         %s\n", yaml_get_version_string()));
  PetscFunctionReturn(PETSC_SUCCESS);
}

PetscErrorCode BackendView(PetscViewer viewer)
{
  PetscInt threads, devices;
  char     name[256];

  PetscFunctionBegin;
  PetscCall(PetscViewerASCIIPrintf(viewer, "Byssus          %s (%s)\n", BackendGetVersion(), BackendGetRevision()));
  PetscCall(ViewLibraries(viewer));
  PetscCall(BackendGetThreads(&threads));
  PetscCall(BackendGetDevice(&devices, name, sizeof name));
  PetscCall(PetscViewerASCIIPrintf(viewer, "backends        openmp%s\n", BackendHasCUDA() ? ", cuda" : ""));
  PetscCall(PetscViewerASCIIPrintf(viewer, "threads         %" PetscInt_FMT "\n", threads));
  if (devices) PetscCall(PetscViewerASCIIPrintf(viewer, "CUDA devices    %" PetscInt_FMT " (%s)\n", devices, name));
  else PetscCall(PetscViewerASCIIPrintf(viewer, "CUDA devices    none\n"));
  PetscFunctionReturn(PETSC_SUCCESS);
}
