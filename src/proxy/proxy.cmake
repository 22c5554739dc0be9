# sources of src/proxy
