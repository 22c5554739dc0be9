# sources of src/tled
