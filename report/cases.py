"""cases.py - the bodies of the report, as scenes."""

from program import mesh

LAWS = ("neo_hookean", "st_venant_kirchhoff", "neo_hookean_iso", "mooney_rivlin", "transversely_isotropic")
YOUNG = 3e6
GRAVITY = [0, 0, -9.81]
# the same load on a body of 1000 kg/m^3, integrated over the elements
WEIGHT = {"loads": ["weight"], "weight": {"groups": ["solid"], "body_force": [0, 0, -9810.0]}}


def law_keys(law, poisson):
    """keys of a law that has the small-strain constants E 3 MPa and nu where it can"""
    shear, bulk = YOUNG / (2 * (1 + poisson)), YOUNG / (3 * (1 - 2 * poisson))
    keys = {"material": law, "young": YOUNG, "poisson": poisson}
    if law == "mooney_rivlin":
        keys = {"material": law, "c10": 0.35 * shear, "c01": 0.15 * shear, "bulk": bulk}
    if law == "transversely_isotropic":
        keys.update(fibre_stiffness=2 * shear, fibre=[1.0, 0.35, 0.2])
    return keys


def body_scene(name, body, probes=None, gravity=None):
    scene = {"bodies": [name], name: {"density": 1000, **body}}
    if gravity:
        scene["gravity"] = gravity
    if probes:
        scene["probes"] = list(probes)
        scene.update({probe: {"body": name, "at": at, "quantity": "displacement"} for probe, at in probes.items()})
    return scene


def beam(size, element, law="neo_hookean", poisson=0.3, gravity=None, **keys):
    """the cantilever of 1 x 0.1 x 0.1 m under its weight"""
    body = {"mesh": str(mesh("beam_" + size, 2 if element == "t10" else 1)), "element": element, "fixed": ["clamp"], **law_keys(law, poisson), **keys}
    return body_scene("beam", body, {"tip": [1, 0.05, 0.05]}, gravity or GRAVITY)


def twist(size, element, **keys):
    """the column of 1 x 1 x 4 m, its top turned by 90 degrees in one unit of time"""
    turn = {"groups": ["top"], "kind": "motion", "angle": 90, "axis": [0, 0, 1], "point": [0, 0, 0], "course": "linear", "duration": 1}
    body = {"mesh": str(mesh("twist_" + size, 2 if element == "t10" else 1)), "element": element, "material": "neo_hookean", "young": 1e5, "poisson": 0.3,
            "fixed": ["bottom"], "constraints": ["turn"], "turn": turn, **keys}
    return body_scene("column", body)


def cook(size, element, sides, **keys):
    """Cook's membrane, nearly incompressible; sides plane (strain) or free"""
    pull = {"groups": ["load"], "traction": [0, 6.25e6, 0]}
    body = {"mesh": str(mesh("cook_" + size, 2 if element == "t10" else 1)), "element": element, "material": "neo_hookean", "young": 2 * 80.194e6 * 1.499, "poisson": 0.499,
            "fixed": ["clamp"], "loads": ["pull"], "pull": pull, **keys}
    if sides == "plane":
        body.update(constraints=["sides"], sides={"groups": ["zmin", "zmax"], "kind": "fixed", "components": ["z"]})
    return body_scene("membrane", body, {"corner": [0.048, 0.06, 0]})


def uniaxial(law, stretch):
    """a unit cube pulled in x, its other sides free to contract"""
    hold = {axis + "0": {"groups": [axis + "min"], "kind": "fixed", "components": [axis]} for axis in "xyz"}
    pull = {"groups": ["xmax"], "kind": "motion", "components": ["x"], "translation": [stretch - 1, 0, 0], "course": "linear", "duration": 1}
    body = {"mesh": str(mesh("cube_h1")), "element": "t4", **law_keys(law, 0.3), "constraints": [*hold, "pull"], **hold, "pull": pull}
    return body_scene("cube", body)


def shaken_cube(element, poisson):
    """a unit cube whose side is moved smoothly by a tenth: for orders in time"""
    shake = {"groups": ["xmin"], "kind": "motion", "translation": [0, 0.1, 0.05], "course": "ramp", "duration": 0.25}
    body = {"mesh": str(mesh("cube_h1", 2 if element == "t10" else 1)), "element": element, **law_keys("neo_hookean", poisson), "constraints": ["shake"], "shake": shake}
    return body_scene("cube", body)
