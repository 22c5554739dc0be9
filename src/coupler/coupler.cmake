# sources of src/coupler
