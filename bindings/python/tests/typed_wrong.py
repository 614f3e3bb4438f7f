"""A program with mistakes: mypy and pyright report each line with the comment `wrong`, and no other line."""
# ruff: noqa: B018, F821

import numpy as np

import supple
from supple.typing import ObjectOptions

mesh = supple.make_box()
positions = np.asarray(mesh.positions)
options: ObjectOptions = {"margin": 0.1, "solid": True}
scene = supple.Scene(contacts={"intersection", "proximity"}, threads=1)
box = scene.add(mesh, name="box", margin=np.float64(0.01), octree={"leaf_size": 8})
scene.add(mesh, margin=0.01, **options)  # wrong: margin twice
ball = scene.add(positions, mesh.triangles, **options)
scene.add(mesh, margn=0.01)  # wrong
scene.add(mesh, margin="0.01")  # wrong
scene.add(mesh, octree={"leaf_sise": 8})  # wrong
supple.Scene(contacs="proximity")  # wrong
supple.Scene(contacts={"proximty"})  # wrong
supple.Scene(broad_phase="grids")  # wrong
supple.Scene(broad_phase=supple.BroadPhaseMethod.grid, undecided="report", curves=True)
supple.Scene(broad_phase=supple.FeatureKind.edge)  # wrong

result = scene.detect(
    contacts=supple.ContactKinds.intersection | supple.ContactKinds.proximity, max_contacts=10
)
scene.detect(max_contact=10)  # wrong
scene.detect(broad_phase="grid")  # wrong
scene.search(contacts="penetration", curves=True).contained_part  # wrong
result.contcts  # wrong
result.contacts, result.intersection, result.proximity, result.continuous, result.curves, result.events
for contact in result.contacts:
    contact.normal, contact.object_a, contact.vertices, contact.barycentic  # wrong
first = result.proximity_pairs[0]
first.distance, first.kind_a, first.object, first["distance"]
first.distnace  # wrong
if result.contacts[0].kind == "segmnt":  # wrong for mypy
    pass
near = result.proximity[result.proximity["distance"] < 0.1]
near[0].distance + near[1:][0].distance
near.colums  # wrong
result.stats["total_seconds"] * 2, result.untested
result.stats["total_secnds"]  # wrong
for pair in result:
    pair.contacts[0].normal, pair.contcts  # wrong

closest = scene.closest(positions, signed=True)
closest[0].found, closest[0].barycentric, closest["distance"].sum()
closest[0].fond  # wrong
scene.cast(positions, positions)[0].t, scene.distances()[0].distance, scene.distances(0.5)
step = scene.collision_free_step()
if step.limit is not None:
    step.limit.kind, step.limit.element_a, step.limit.elements  # wrong
step.limit.kind  # wrong: it can be None
supple.first_impact("vertex_face", [], [], min_separation=0.1)[0].toi
supple.first_impact("face_vertex", [], [])  # wrong
supple.point_triangle_distance([], [])[0].distances  # wrong

simulation = supple.Simulation(
    border=[[-1, -1, -1], [1, 1, 1]], seed=1, contacts="none", response={"friction": 0.5}
)
supple.Simulation(time_stp=0.1)  # wrong
body = simulation.add(mesh, springs={"random_speed": 0.4, "stiffness": 10})
simulation.add(mesh, springs={"random_sped": 0.4})  # wrong
simulation.add(mesh, rigid={"velocity": (0.3, 0, 0), "spin": np.zeros(3)})
simulation.add(mesh, rigid={"velocity": 3})  # wrong
for each in simulation.run(3, contacts="intersection"):
    each.contacts[0].point_count
    each.contact  # wrong
supple.MassSpringBody(mesh, mass=0.1, integrator="verlet", fixed_vertices=[1])
supple.MassSpringBody(mesh, mas=0.1)  # wrong
supple.open("run.h5")[0].contacts, supple.open("run.h5")[0].contacs  # wrong
supple.plot.counts([result])
supple.plots.counts([result])  # wrong
supple.BroadPhase(method="octree", kind_pairs=[(0, 1)])
supple.BroadPhase(methd="octree")  # wrong
scene.set_pair_filter(lambda a, b: a.index < b.index)
scene.set_pair_filter(3)  # wrong
supple.save_mesh(mesh, "box.obj")
supple.save_mesh("box.obj", mesh)  # wrong
