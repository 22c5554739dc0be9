"""Blocks of water with fields of velocity: a box that fills its domain has the domain's volume to round-off, discs and balls that of their
shape within a shell of the lattice, and the kinetic energy is the field's."""
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from case import Case, Report  # noqa: E402

report = Report()

# vortices in a periodic box that the spacing does not divide: sums over whole waves are exact
run = Case("fields.yaml", sph_water_min="0,0,0", sph_water_max="1,1,0.31", sph_water_field="taylor_green", sph_water_amplitude=1, sph_water_wavelength=1)
report.below("energy of vortices in a box over rho V U^2/4 - 1", run.ledger["fluid_kinetic"][0] / (1000 * 0.31 / 4) - 1, 1e-4)
report.below("compression of the box's lattice", run.ledger["compression_max"][0], 1e-3)

# the same, between walls: 14 x 14 layers in the walls' directions, as many upwards as 0.05 m hold
walls = dict(domain_walls="xmin,xmax,ymin,ymax,zmin", domain_periodic="", gravity="0,0,-9.81")
run = Case("fields.yaml", sph_water_min="0,0,0", sph_water_max="1,1,0.2", **walls)
report.below("layers of a tank that the spacing does not divide", run.summary["fluid"]["particles"] - 14 * 14 * 3, 0)

# a disc, through a slab that repeats: a quarter of rho pi R^2 L (rate R)^2; shells of the lattice hold a per cent of 8,000 particles
slab = dict(domain_min="-3,-3,0", domain_max="3,3,0.32", domain_periodic="z", sph_spacing=0.05, sph_water_shape="cylinder", sph_water_radius=1)
run = Case("fields.yaml", sph_water_field="strain", sph_water_rate=-10, run_output_every=1e-5, run_end=1e-5, **slab)
wanted = np.pi * 0.32
report.below("volume of a disc over pi R^2 L - 1", run.summary["fluid"]["particles"] * 0.05**3 / wanted - 1, 0.005)
report.below("energy of a straining disc over its exact one - 1", run.ledger["fluid_kinetic"][0] / (1000 * wanted / 4 * 100) - 1, 0.01)

ball = dict(domain_min="-3,-3,-3", domain_max="3,3,3", domain_periodic="", sph_spacing=0.1, sph_water_shape="sphere", sph_water_radius=1)
run = Case("fields.yaml", sph_water_field="rotation", sph_water_rate=3, sph_water_center="0.1,0,0", **ball)
wanted = 4 / 3 * np.pi
report.below("volume of a ball over 4/3 pi R^3 - 1", run.summary["fluid"]["particles"] * 0.1**3 / wanted - 1, 0.01)
report.below("energy of a spinning ball over its exact one - 1", run.ledger["fluid_kinetic"][0] / (1000 * wanted / 5 * 9) - 1, 0.02)

Case("fields.yaml", status=2)
Case("fields.yaml", status=2, sph_water_shape="sphere")
Case("fields.yaml", status=2, sph_water_field="taylor_green", sph_water_min="0,0,0", sph_water_max="1,1,0.31")
report.end()
