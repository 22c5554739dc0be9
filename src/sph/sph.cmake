# sources of src/sph
