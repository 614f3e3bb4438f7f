"""Types for annotations, made from docs/api.json and the descriptions in the headers by tools/make_python.py:
options as keywords, such as `SceneOptions`; rows of tables, such as `Contact` of `Table[Contact]`."""

from __future__ import annotations

from typing import Any, Collection, Iterable, Literal, Sequence, TypedDict, Union

import numpy as np
import numpy.typing as npt
from numpy.typing import ArrayLike

from ._generated import (
    BoundingVolume,
    BroadPhaseMethod,
    ContactKinds,
    ContinuousListing,
    Descent,
    ElementKinds,
    Integrator,
    Neighbours,
    ObjectOctreeBuild,
    ProximityListing,
    RegionSphereTest,
    SphereFit,
)
from ._tables import Record, Table

Number = Union[float, "np.floating[Any]", "np.integer[Any]"]
Numbers = Union[Sequence[float], "npt.NDArray[Any]"]
Whole = Union[int, "np.integer[Any]"]
Kind = Literal["none", "intersection", "continuous", "proximity", "penetration"]
#: One kind, several with commas, or a collection.
Kinds = Union[ContactKinds, str, Collection[Union[ContactKinds, Kind]]]


class ImpactOptions(TypedDict, total=False):
    'Options as keywords.'

    min_separation: Number
    'Continuous contacts: distance at which two elements count as touching'
    undecided: bool | np.bool_ | Literal['report', 'exact']
    'Continuous contacts that floating point cannot decide: exact arithmetic decides them (exact), or they are reported as within tolerance (report)'
    exact: bool | np.bool_ | Literal['report', 'exact']
    'Continuous contacts that floating point cannot decide: exact arithmetic decides them (exact), or they are reported as within tolerance (report)'
    max_time: Number
    'Continuous contacts: leave out those later in the step, which is from 0 to 1'
    skip_parting: bool | np.bool_
    'Continuous contacts: leave out elements that are within the separation at the start and part'


class ObjectOctreeOptions(TypedDict, total=False):
    'Options as keywords.'

    max_level: Whole
    "Deepest level of the object's octree; the root is level 0"
    leaf_size: Whole
    'A node with at most this many triangles is not split; half as many with continuous contacts or proximity'
    tree_arity: Whole
    "Children of a node of the object's octree"
    arity: Whole
    "Children of a node of the object's octree"
    object_octree: ObjectOctreeBuild | Literal['balanced', 'regular', 'bottom_up']
    "How the object's octree is built: with equally full leaves (balanced), from the octants of each cell as in the paper (regular), or by merging neighbours (bottom-up)"
    build: ObjectOctreeBuild | Literal['balanced', 'regular', 'bottom_up']
    "How the object's octree is built: with equally full leaves (balanced), from the octants of each cell as in the paper (regular), or by merging neighbours (bottom-up)"
    rebuild_degraded: bool | np.bool_
    "Rebuild the object's octree when it has become slow because the object deformed"


class SceneOctreeOptions(TypedDict, total=False):
    'Options as keywords.'

    scene_octree_max_level: Whole
    'Deepest level of the scene octree; 0 means the largest possible level, 20'
    max_level: Whole
    'Deepest level of the scene octree; 0 means the largest possible level, 20'
    scene_octree_expand_at: Whole
    'A region of the scene octree expands when this many of its objects fit into regions of half its edge; 0 means 2 for scenes of up to 64 objects, otherwise 96'
    expand_at: Whole
    'A region of the scene octree expands when this many of its objects fit into regions of half its edge; 0 means 2 for scenes of up to 64 objects, otherwise 96'
    region_test: RegionSphereTest | Literal['arvo', 'grown_box']
    "Test of a region of the scene octree against a sphere: Arvo's test, or the test of the paper (grown box)"
    region_sphere_test: RegionSphereTest | Literal['arvo', 'grown_box']
    "Test of a region of the scene octree against a sphere: Arvo's test, or the test of the paper (grown box)"
    scene_octree_expand_for_large: bool | np.bool_ | Literal['off', 'on']
    "Count all objects of a region, also those that dividing it cannot separate (the paper's Figure 2); needs a deepest level from 1 to 6"
    expand_for_large_objects: bool | np.bool_ | Literal['off', 'on']
    "Count all objects of a region, also those that dividing it cannot separate (the paper's Figure 2); needs a deepest level from 1 to 6"
    scene_octree_min_level: Whole
    'Regions above this level of the scene octree always expand; 1 in the paper'
    min_level: Whole
    'Regions above this level of the scene octree always expand; 1 in the paper'
    scene_octree_arity: Whole
    'Children of a region of the scene octree'
    arity: Whole
    'Children of a region of the scene octree'
    scene_octree_root: Numbers | None
    'Root region of the scene octree, a cube; without a value it is fitted to the objects'
    root: Numbers | None
    'Root region of the scene octree, a cube; without a value it is fitted to the objects'


class ComparisonOptions(TypedDict, total=False):
    'Options as keywords.'

    sphere_fit: SphereFit | Literal['vertices', 'minimal', 'medial', 'box']
    "How spheres are fitted: around the middle of the box up to the farthest vertex (vertices), as small as possible (minimal), on the medial axis (medial), or from the box by the paper's eq. 3 and 4, which misses contacts (box)"
    colliding_vertices: bool | np.bool_
    "Also report the paper's output: the vertices in the colliding leaves of both octrees"
    descent: Descent | Literal['both_sides', 'one_side_first']
    "Order in which the children of two nodes are compared: all with all (both sides), or first the children of one node with the other node, as in the paper's Figure 4 (one side first)"
    lazy_refit: bool | np.bool_ | Literal['off', 'on']
    'Refit below the root of an object only the nodes where it may collide with another object'


class ObjectOptions(ObjectOctreeOptions, total=False):
    'Options as keywords.'

    name: str
    'Name of the object in tables, messages and results'
    self_collision: bool | np.bool_
    'Also test the object against itself'
    neighbours: Neighbours | Literal['skip', 'exact']
    'Triangles of one object that share a vertex: not tested (skip), or tested for intersection beyond what they share (exact)'
    weld: bool | np.bool_
    'Vertices with equal positions count as one, so that a seam that was split for texture coordinates is no border'
    static: bool | np.bool_
    'The object never moves; static objects are not tested against each other'
    is_static: bool | np.bool_
    'The object never moves; static objects are not tested against each other'
    margin: Number
    'Proximity: two objects are near where they come within the sum of their margins'
    min_separation: Number
    'Continuous contacts: added to the minimum separation, for each of two objects'
    solid: bool | np.bool_
    'Penetration: the object is solid, so that vertices can be inside it; its surface must be closed and oriented alike'
    group: Whole
    'Two objects are tested when the group of each has a bit in common with the mask of the other'
    mask: Whole
    'Groups, as bits, with which the object is tested'
    octree: ObjectOctreeOptions
    "Shape of the object's octree"


class SceneOptions(SceneOctreeOptions, ImpactOptions, ComparisonOptions, total=False):
    'Options as keywords.'

    bounding_volume: BoundingVolume | Literal['aabb', 'sphere', 'obb', 'kdop14', 'kdop18', 'kdop26']
    'Shape that encloses the objects and the nodes of their octrees'
    broad_phase: BroadPhaseMethod | Literal['automatic', 'octree', 'grid', 'sweep', 'brute', 'sweep3']
    'How object pairs are found; all methods find the same pairs'
    scene_octree: SceneOctreeOptions
    'Shape of the scene octree'
    contacts: Kinds
    'Contacts to find: pairs of triangles that intersect (intersection); vertices and faces, and pairs of edges, that touch on their paths from the frame before (continuous); pairs within the margins of their objects (proximity); vertices inside solid objects, contained parts and curves of intersection (penetration, which includes intersection); several of these with commas between them; or none. Bodies that already cut through each other at the start of the paths are found by intersection, not by continuous'
    contact_points: bool | np.bool_
    'Compute the normal and the points of each contact of triangles'
    impact: ImpactOptions
    'Options of continuous contacts'
    proximity_listing: ProximityListing | Literal['features', 'elements']
    'Proximity: list each pair of closest features once (features), or every vertex and face and every two edges within the margins (elements)'
    element_kinds: ElementKinds | Literal['all', 'vertex_face', 'edge_edge']
    'Continuous contacts and proximity: search all pairs of elements, only vertices with faces (vertex_face), or only pairs of edges (edge_edge)'
    continuous_listing: ContinuousListing | Literal['all', 'first']
    'Continuous contacts: list all, or the first of each vertex, edge and face (first)'
    manifolds: bool | np.bool_
    'Penetration and proximity: also reduce each patch of contacts to a normal, a depth and at most four points, with ids that last from frame to frame'
    curves: bool | np.bool_
    'List the curves in which surfaces intersect, with what they enclose, a normal and a depth, for penetration'
    threads: Whole
    'Worker threads; 0 means one per core'
    comparison: ComparisonOptions
    'Options for comparison'


class StepOptions(TypedDict, total=False):
    'Options as keywords.'

    keep: Number
    'Share of its distance at the start that each pair of elements keeps in a safe step'


class BroadPhaseOptions(SceneOctreeOptions, total=False):
    'Options as keywords.'

    method: BroadPhaseMethod | Literal['automatic', 'octree', 'grid', 'sweep', 'brute', 'sweep3']
    'How overlapping pairs are found'
    scene_octree: SceneOctreeOptions
    'Shape of the scene octree'
    threads: Whole
    'Worker threads; 0 means one per core'
    kind_pairs: Iterable[tuple[int, int]]
    'Wanted pairs of kinds of volumes'


class MassSpringOptions(TypedDict, total=False):
    'Options as keywords.'

    integrator: Integrator | Literal['verlet', 'symplectic_euler', 'backward_euler']
    'How a step is integrated: verlet (second order) and symplectic_euler (first order) are fast and need short steps; backward_euler is slower and stable at any stiffness'
    substeps: Whole
    'Number of equal parts of a step'
    mass: Number
    'Mass of each vertex'
    vertex_mass: Number
    'Mass of each vertex'
    stiffness: Number
    'N/m'
    rest_length: Number
    ''
    connect_pieces: bool | np.bool_
    'Springs also connect the pieces of the mesh, so that they do not drift apart'
    damping: Number
    'N s/m'
    air_friction: Number
    'N s/m'
    bending_stiffness: Number
    'N/m'
    area_stiffness: Number
    'N/m'
    volume_stiffness: Number
    'Pa'
    gravity: Numbers
    'Acceleration of each vertex'
    max_strain: Number
    ''
    yield_strain: Number
    ''
    plastic_rate: Number
    '1/s'
    threads: Whole
    'Worker threads; 0 means one per core'


class MassSpringMotionHandle(TypedDict, total=False):
    'Options as keywords.'

    by: Numbers
    'Displacement of the vertices'
    seconds: Number
    'Duration of the movement; afterwards the vertices stay'


class MassSpringMotion(MassSpringOptions, total=False):
    'Options as keywords.'

    springs: MassSpringOptions
    'Masses and springs of the object'
    velocity: Numbers
    'Velocity that the object gets after deform_seconds'
    random_speed: Number
    'Speed in a random direction that is added to the velocity'
    random_force: Number
    'Root mean square of random forces that deform the object'
    deform_seconds: Number
    'How long the object deforms in place; then constant random forces end, and the object gets its velocity'
    force_change_seconds: Number
    'Time in which the random forces change into others; they act until the end. 0: constant forces'
    seed: Whole | None
    'Seed of the random numbers, instead of the number of the object; each copy adds its own number'


class RigidMotion(TypedDict, total=False):
    'Options as keywords.'

    velocity: Numbers
    'Velocity at the start'
    random_speed: Number
    'Speed in a random direction that is added to the velocity'
    spin: Numbers
    'Angular velocity: its direction is the axis through the centre of the vertices, its length the speed, counter-clockwise'
    random_spin: Number
    'Angular velocity about a random axis that is added to the spin'
    seed: Whole | None
    'Seed of the random numbers, instead of the number of the object; each copy adds its own number'


class ContactResponse(TypedDict, total=False):
    'Options as keywords.'

    thickness: Number
    'Distance that the response keeps between elements'
    restitution: Number
    'Fraction of the approaching velocity that is reversed: 0 stops the approach, 1 reverses it'
    friction: Number
    "Coulomb's coefficient of friction"
    iterations: Whole
    'Largest number of rounds of detection and impulses per step'


class SimulationOptions(SceneOctreeOptions, ImpactOptions, ComparisonOptions, total=False):
    'Options as keywords.'

    scene: SceneOptions
    'Options of the detection'
    time_step: Number
    'Time from one frame to the next'
    bounds: ArrayLike | None
    'Lowest and highest corner of the box that reflects objects'
    border: ArrayLike | None
    'Lowest and highest corner of the box that reflects objects'
    seed: Whole
    'Seed of the random numbers: velocities, forces and rotations'
    fused_refit: bool | np.bool_ | Literal['off', 'on']
    'The loop of the motion finds the bounds of each body, instead of a loop of the refit; needs a lazy refit'
    response: ContactResponse | None
    'Response to contacts'
    bounding_volume: BoundingVolume | Literal['aabb', 'sphere', 'obb', 'kdop14', 'kdop18', 'kdop26']
    'Shape that encloses the objects and the nodes of their octrees'
    broad_phase: BroadPhaseMethod | Literal['automatic', 'octree', 'grid', 'sweep', 'brute', 'sweep3']
    'How object pairs are found; all methods find the same pairs'
    contacts: Kinds
    'Contacts to find: pairs of triangles that intersect (intersection); vertices and faces, and pairs of edges, that touch on their paths from the frame before (continuous); pairs within the margins of their objects (proximity); vertices inside solid objects, contained parts and curves of intersection (penetration, which includes intersection); several of these with commas between them; or none. Bodies that already cut through each other at the start of the paths are found by intersection, not by continuous'
    contact_points: bool | np.bool_
    'Compute the normal and the points of each contact of triangles'
    proximity_listing: ProximityListing | Literal['features', 'elements']
    'Proximity: list each pair of closest features once (features), or every vertex and face and every two edges within the margins (elements)'
    element_kinds: ElementKinds | Literal['all', 'vertex_face', 'edge_edge']
    'Continuous contacts and proximity: search all pairs of elements, only vertices with faces (vertex_face), or only pairs of edges (edge_edge)'
    continuous_listing: ContinuousListing | Literal['all', 'first']
    'Continuous contacts: list all, or the first of each vertex, edge and face (first)'
    manifolds: bool | np.bool_
    'Penetration and proximity: also reduce each patch of contacts to a normal, a depth and at most four points, with ids that last from frame to frame'
    curves: bool | np.bool_
    'List the curves in which surfaces intersect, with what they enclose, a normal and a depth, for penetration'
    threads: Whole
    'Worker threads; 0 means one per core'


class BreakOptions(TypedDict, total=False):
    'Options as keywords.'

    contact_begin: bool | np.bool_
    'Two objects begin to touch'
    intersection: bool | np.bool_
    'Triangles intersect'
    contacts_above: Whole | None
    'More contacts than'
    depth_above: Number | None
    'A vertex deeper in a solid than'
    not_finite: bool | np.bool_
    'A vertex is NaN or infinite'


class AttachOptions(BreakOptions, total=False):
    'Options as keywords.'

    title: str
    'Title of the page'
    address: str
    'An IP address of this machine'
    port: Whole
    'Port of the page; 0 is any free one'
    token_file: str
    'A file that keeps the token of the address; made when it does not exist'
    open_browser: bool | np.bool_
    'Open the page in the browser, if there is a screen'
    max_slowdown: Number
    "The share of the program's time that frames may take"
    time_step: Number
    'Time between two steps; 0 shows no time'
    wait_for_page: bool | np.bool_
    'The first step and each break wait until a page is connected'
    history_bytes: Number
    'Memory for the last steps, to which the page can go back'
    spectators: bool | np.bool_
    ''
    breaks: BreakOptions
    'Events that pause the program'


class DetectRequest(ImpactOptions, total=False):
    'Keywords of `Scene.detect` and `Scene.search`.'

    contacts: Kinds
    'Contacts to find: pairs of triangles that intersect (intersection); vertices and faces, and pairs of edges, that touch on their paths from the frame before (continuous); pairs within the margins of their objects (proximity); vertices inside solid objects, contained parts and curves of intersection (penetration, which includes intersection); several of these with commas between them; or none. Bodies that already cut through each other at the start of the paths are found by intersection, not by continuous'
    impact: ImpactOptions
    'Options of continuous contacts'
    proximity_listing: ProximityListing | Literal['features', 'elements']
    'Proximity: list each pair of closest features once (features), or every vertex and face and every two edges within the margins (elements)'
    element_kinds: ElementKinds | Literal['all', 'vertex_face', 'edge_edge']
    'Continuous contacts and proximity: search all pairs of elements, only vertices with faces (vertex_face), or only pairs of edges (edge_edge)'
    continuous_listing: ContinuousListing | Literal['all', 'first']
    'Continuous contacts: list all, or the first of each vertex, edge and face (first)'
    manifolds: bool | np.bool_
    'Penetration and proximity: also reduce each patch of contacts to a normal, a depth and at most four points, with ids that last from frame to frame'
    curves: bool | np.bool_
    'List the curves in which surfaces intersect, with what they enclose, a normal and a depth, for penetration'
    max_contacts: Whole | None
    'The largest number of contacts of each kind'


class StepStats(TypedDict):
    '`Result.stats`.'

    refit_seconds: float
    'Time to refit octrees to new positions'
    broad_phase_seconds: float
    'Time of the broad phase, which finds object pairs'
    rebuild_seconds: float
    'Time to rebuild degraded octrees'
    traversal_seconds: float
    'Time of the narrow phase, which finds candidates'
    exact_seconds: float
    'Time of the exact stage, which decides the candidates'
    penetration_seconds: float
    'Time to find vertices inside solids, contained parts and curves'
    manifold_seconds: float
    'Time to find manifolds and their ids'
    sort_and_events_seconds: float
    'Time to sort contacts and to find events'
    total_seconds: float
    'Time of the whole detection'
    broad_phase_method: str
    'Method of the broad phase that ran'
    objects_refitted: int
    'objects'
    triangles_refitted: int
    'triangles'
    octrees_rebuilt: int
    'octrees'
    triangles_rebuilt: int
    'triangles'
    object_pairs_tested: int
    'pairs'
    object_pairs: int
    'pairs'
    node_pairs_visited: int
    'Pairs of octree nodes in the narrow phase; depends on the number of threads'
    boxes_tested: int
    'Tests of two volumes in nodes and leaves; depends on the number of threads'
    candidate_pairs: int
    'pairs'
    vertex_face_candidates: int
    'pairs'
    edge_edge_candidates: int
    'pairs'
    exact_fallbacks: int
    'pairs'
    contacts: int
    'contacts'
    proximity_pairs: int
    'pairs'
    penetrations: int
    'vertices'
    curves: int
    'curves'


class ClosestPoint(Record):
    'The nearest triangle of a point. Exact arithmetic decides which one it is; of several at the same distance it is the one with the smallest object, then the smallest number.'

    __slots__ = ()
    object: np.uint32
    'Object of the triangle'
    object_generation: np.uint32
    'Object of the triangle'
    triangle: np.uint32
    'Nearest triangle'
    feature_kind: Literal['vertex', 'edge', 'face']
    'Smallest part of it that holds the closest point'
    feature_index: np.uint8
    'Smallest part of it that holds the closest point'
    distance: np.float64
    'Distance to the triangle; negative for a signed distance inside'
    barycentric: npt.NDArray[np.float64]
    'Barycentric coordinates of the closest point'
    point: npt.NDArray[np.float64]
    'Closest point'
    normal: npt.NDArray[np.float64]
    'Unit vector from it to the point of the query'


class FoundClosestPoint(Record):
    'The nearest triangle of a point. Exact arithmetic decides which one it is; of several at the same distance it is the one with the smallest object, then the smallest number.'

    __slots__ = ()
    found: np.bool_
    'Whether there is an answer; the other members are valid only then'
    object: np.uint32
    'Object of the triangle'
    object_generation: np.uint32
    'Object of the triangle'
    triangle: np.uint32
    'Nearest triangle'
    feature_kind: Literal['vertex', 'edge', 'face']
    'Smallest part of it that holds the closest point'
    feature_index: np.uint8
    'Smallest part of it that holds the closest point'
    distance: np.float64
    'Distance to the triangle; negative for a signed distance inside'
    barycentric: npt.NDArray[np.float64]
    'Barycentric coordinates of the closest point'
    point: npt.NDArray[np.float64]
    'Closest point'
    normal: npt.NDArray[np.float64]
    'Unit vector from it to the point of the query'


class CollidingVertices(Record):
    "The paper's output for one pair of objects: the vertices of both in the leaves that collide, as the user's numbers, ascending. They are a range of `DetectResult.colliding_vertices`: first the vertices of a, then the vertices of b."

    __slots__ = ()
    a: np.uint32
    'Object a'
    a_generation: np.uint32
    'Object a'
    b: np.uint32
    'Object b'
    b_generation: np.uint32
    'Object b'
    first_vertex: np.uint32
    'First vertex in a leaf that collides'
    count_a: np.uint32
    'Number of these vertices of object a'
    count_b: np.uint32
    'Number of vertices of object b, which follow'


class Contact(Record):
    'Two triangles that intersect, as exact arithmetic decides on the given coordinates. Touching counts.\n\nThe pair, its `kind`, `point_count` and the features of its points are exact. The normal and the positions of the points are rounded. All have the same bits for any number of threads, instruction set and compiler.'

    __slots__ = ()
    object_a: np.uint32
    'Object a; the same as b for a contact with itself'
    object_a_generation: np.uint32
    'Object a; the same as b for a contact with itself'
    object_b: np.uint32
    'Object b'
    object_b_generation: np.uint32
    'Object b'
    triangle_a: np.uint32
    'Triangle of object a'
    triangle_b: np.uint32
    'Triangle of object b'
    kind: Literal['point', 'segment', 'polygon']
    'What the triangles share'
    point_count: np.uint8
    'Points of the intersection: 1, 2, or 3 to 6 in order around a polygon'
    first_point: np.uint32
    'The first of these points'
    normal: npt.NDArray[np.float64]
    'Unit vector from b to a; zero without contact points'
    object: npt.NDArray[np.uint32]
    'Both sides in one'
    triangle: npt.NDArray[np.uint32]
    'Both sides in one'
    vertices: npt.NDArray[np.uint32]
    'The vertices of both elements, (2, 3)'


class ContactGroup(Record):
    'The contacts of one pair of objects, or of one object with itself (`a == b`): a range of `DetectResult.contacts`, `continuous_contacts` or `proximity_pairs`. Only pairs with contacts of that kind are listed.'

    __slots__ = ()
    a: np.uint32
    'Object a; the same as b for contacts of an object with itself'
    a_generation: np.uint32
    'Object a; the same as b for contacts of an object with itself'
    b: np.uint32
    'Object b'
    b_generation: np.uint32
    'Object b'
    first_contact: np.uint32
    'First contact of the objects in its list'
    contact_count: np.uint32
    'Number of contacts'


class ContactPoint(Record):
    'An extreme point of the intersection of two triangles: feature a meets feature b there.'

    __slots__ = ()
    position: npt.NDArray[np.float64]
    'The point'
    feature_a_kind: Literal['vertex', 'edge', 'face']
    'Smallest part of triangle a on which the point lies'
    feature_a_index: np.uint8
    'Smallest part of triangle a on which the point lies'
    feature_b_kind: Literal['vertex', 'edge', 'face']
    'Smallest part of triangle b on which the point lies'
    feature_b_index: np.uint8
    'Smallest part of triangle b on which the point lies'


class ContainedPart(Record):
    'A connected part of an object that is inside a solid object and touches no triangle of it. Triangles that share a vertex id are connected.'

    __slots__ = ()
    inner: np.uint32
    'Object of the part'
    inner_generation: np.uint32
    'Object of the part'
    outer: np.uint32
    'Solid object that contains the part'
    outer_generation: np.uint32
    'Solid object that contains the part'
    vertex: np.uint32
    'Smallest vertex of the part'
    vertex_count: np.uint32
    'Vertices of the part'
    is_whole: np.bool_
    'Whether all parts of the object are contained'


class ContinuousContact(Record):
    'Two elements that touch on their paths within the step. Bodies that already cut through each other at the start of the step have no continuous contact until two of their elements touch; `Contact` reports them. Edges are the distinct pairs of vertices of the triangles and those of `ObjectOptions.edges`. Within one object, elements that share a vertex id are not a contact, and edge a or vertex a is the smaller one.\n\nWith `ImpactCertainty.certain`, the pair is exact. `toi`, the barycentric coordinates, `point` and `normal` are rounded.'

    __slots__ = ()
    object_a: np.uint32
    'Object a; the same as b for a contact with itself'
    object_a_generation: np.uint32
    'Object a; the same as b for a contact with itself'
    object_b: np.uint32
    'Object b'
    object_b_generation: np.uint32
    'Object b'
    kind: Literal['vf', 'fv', 'ee', 've', 'ev', 'vv']
    'Kinds of the elements: v vertex, e edge, f face; a before b'
    element_a: npt.NDArray[np.uint32]
    'Element of object a'
    element_b: npt.NDArray[np.uint32]
    'Element of object b'
    certainty: Literal['certain', 'within_tolerance']
    'Whether the contact is proven'
    touching_at_start: np.bool_
    'Whether the elements touch already at the start of the step; the time is then 0'
    toi: np.float64
    'Time of impact: 0 at the start of the step, 1 at its end'
    start_distance: np.float64
    'Distance at the start of the step'
    barycentric_a: npt.NDArray[np.float64]
    'Barycentric coordinates of the point on element a'
    barycentric_b: npt.NDArray[np.float64]
    'Barycentric coordinates of the point on element b'
    point: npt.NDArray[np.float64]
    'Midpoint of the two points at the time of impact'
    normal: npt.NDArray[np.float64]
    'Unit vector from b to the side of element a'
    barycentric: npt.NDArray[np.float64]
    'Both sides in one'
    element: npt.NDArray[np.uint32]
    'Both sides in one'
    object: npt.NDArray[np.uint32]
    'Both sides in one'
    vertices: npt.NDArray[np.uint32]
    'The vertices of both elements, (2, 3)'


class ContinuousDifference(Record):
    'A pair of elements on which `verify` and the last `Scene.detect` differ.'

    __slots__ = ()
    object_a: np.uint32
    'Object a'
    object_a_generation: np.uint32
    'Object a'
    object_b: np.uint32
    'Object b'
    object_b_generation: np.uint32
    'Object b'
    kind: Literal['vf', 'fv', 'ee', 've', 'ev', 'vv']
    'Kinds of the elements'
    element_a: npt.NDArray[np.uint32]
    'Element of object a'
    element_b: npt.NDArray[np.uint32]
    'Element of object b'
    fault: Literal['missed', 'added', 'late', 'early']
    'What is wrong'
    element: npt.NDArray[np.uint32]
    'Both sides in one'
    object: npt.NDArray[np.uint32]
    'Both sides in one'


class Difference(Record):
    'A pair on which `verify` and the last `Scene.detect` differ.'

    __slots__ = ()
    object_a: np.uint32
    'Object a'
    object_a_generation: np.uint32
    'Object a'
    object_b: np.uint32
    'Object b'
    object_b_generation: np.uint32
    'Object b'
    triangle_a: np.uint32
    'Triangle of object a'
    triangle_b: np.uint32
    'Triangle of object b'
    missed: np.bool_
    'Whether the pair intersects and was not reported'
    object: npt.NDArray[np.uint32]
    'Both sides in one'
    triangle: npt.NDArray[np.uint32]
    'Both sides in one'


class ElementDistance(Record):
    'The closest points of two closed elements a and b: points, edges or triangles.\n\nThe features are exact: the smallest parts of the elements that hold the closest points. A point is vertex 0. Edge 0 of an edge is the edge without its ends, and the face of a triangle is its interior. Where several features hold them, which needs parallel edges, an edge without length or a triangle without area, the smallest counts: two vertices before a vertex of a and an edge of b, before an edge of a and a vertex of b; then the smaller index on a, then on b. The edges of a triangle count in the order (0, 1), (0, 2), (1, 2).'

    __slots__ = ()
    distance: np.float64
    'Distance of the elements'
    feature_a_kind: Literal['vertex', 'edge', 'face']
    'Smallest part of element a that holds the closest point'
    feature_a_index: np.uint8
    'Smallest part of element a that holds the closest point'
    feature_b_kind: Literal['vertex', 'edge', 'face']
    'Smallest part of element b that holds the closest point'
    feature_b_index: np.uint8
    'Smallest part of element b that holds the closest point'
    barycentric_a: npt.NDArray[np.float64]
    'Barycentric coordinates of the closest point on element a'
    barycentric_b: npt.NDArray[np.float64]
    'Barycentric coordinates of the closest point on element b'
    point_a: npt.NDArray[np.float64]
    'Closest point of a'
    point_b: npt.NDArray[np.float64]
    'Closest point of b'
    normal: npt.NDArray[np.float64]
    'Unit vector from b to a'
    barycentric: npt.NDArray[np.float64]
    'Both sides in one'
    point: npt.NDArray[np.float64]
    'Both sides in one'


class FoundElementDistance(Record):
    'The closest points of two closed elements a and b: points, edges or triangles.\n\nThe features are exact: the smallest parts of the elements that hold the closest points. A point is vertex 0. Edge 0 of an edge is the edge without its ends, and the face of a triangle is its interior. Where several features hold them, which needs parallel edges, an edge without length or a triangle without area, the smallest counts: two vertices before a vertex of a and an edge of b, before an edge of a and a vertex of b; then the smaller index on a, then on b. The edges of a triangle count in the order (0, 1), (0, 2), (1, 2).'

    __slots__ = ()
    found: np.bool_
    'Whether there is an answer; the other members are valid only then'
    distance: np.float64
    'Distance of the elements'
    feature_a_kind: Literal['vertex', 'edge', 'face']
    'Smallest part of element a that holds the closest point'
    feature_a_index: np.uint8
    'Smallest part of element a that holds the closest point'
    feature_b_kind: Literal['vertex', 'edge', 'face']
    'Smallest part of element b that holds the closest point'
    feature_b_index: np.uint8
    'Smallest part of element b that holds the closest point'
    barycentric_a: npt.NDArray[np.float64]
    'Barycentric coordinates of the closest point on element a'
    barycentric_b: npt.NDArray[np.float64]
    'Barycentric coordinates of the closest point on element b'
    point_a: npt.NDArray[np.float64]
    'Closest point of a'
    point_b: npt.NDArray[np.float64]
    'Closest point of b'
    normal: npt.NDArray[np.float64]
    'Unit vector from b to a'
    barycentric: npt.NDArray[np.float64]
    'Both sides in one'
    point: npt.NDArray[np.float64]
    'Both sides in one'


class EndedManifold(Record):
    'A manifold of the last step that no manifold of this step continues.'

    __slots__ = ()
    a: np.uint32
    'Object a'
    a_generation: np.uint32
    'Object a'
    b: np.uint32
    'Object b'
    b_generation: np.uint32
    'Object b'
    id: np.uint64
    'Id of the manifold'


class Impact(Record):
    'The first contact of two elements. The certainty is exact; all numbers are rounded.'

    __slots__ = ()
    toi: np.float64
    'Time of impact: 0 at the start of the step, 1 at its end'
    certainty: Literal['certain', 'within_tolerance']
    'Whether the impact is proven'
    touching_at_start: np.bool_
    'Whether the elements touch already at the start; the time is then 0'
    start_distance: np.float64
    'Distance at the start'
    barycentric: npt.NDArray[np.float64]
    'Barycentric coordinates of both points'
    point: npt.NDArray[np.float64]
    'Midpoint of the two points at the time of impact'
    normal: npt.NDArray[np.float64]
    'Unit vector from b to the side of element a'


class FoundImpact(Record):
    'The first contact of two elements. The certainty is exact; all numbers are rounded.'

    __slots__ = ()
    found: np.bool_
    'Whether there is an answer; the other members are valid only then'
    toi: np.float64
    'Time of impact: 0 at the start of the step, 1 at its end'
    certainty: Literal['certain', 'within_tolerance']
    'Whether the impact is proven'
    touching_at_start: np.bool_
    'Whether the elements touch already at the start; the time is then 0'
    start_distance: np.float64
    'Distance at the start'
    barycentric: npt.NDArray[np.float64]
    'Barycentric coordinates of both points'
    point: npt.NDArray[np.float64]
    'Midpoint of the two points at the time of impact'
    normal: npt.NDArray[np.float64]
    'Unit vector from b to the side of element a'


class IntersectionCurve(Record):
    "A curve in which two objects intersect, or one object intersects itself: the contacts that are linked by common points. A point links two contacts when it lies on the same features of both objects, for example on an edge of a and a face of b. So the links are exact.\n\nA closed or an open curve runs from point to point, a contact between each two, in the direction n_b x n_a of the normals of the triangles. A closed one starts with its smallest contact. A branched one has ascending contacts and no points.\n\nOn each of two surfaces, a curve encloses the vertices that it cuts off: those on the smaller of the two sides, by the number of vertices, and of equal sides the one inside the other object. It encloses nothing where it does not divide the connected part of the surface, and where a vertex makes the sides ambiguous. On a curve of an object with itself, side a has the smaller triangle of the curve's smallest contact. See Baraff, Witkin and Kass, Untangling Cloth, 2003.\n\n`normal` and `depth` say how a leaves b: after a moves by `depth` along `normal`, no vertex of the contact is inside the other object, and two convex objects have no common inside. So the depth is at least that of the deepest vertex of the contact, and at most the overlap of two convex objects along the normal.\n\nThe contact is what is behind the curve on each surface: the triangles of the curve's contacts, and those around the vertices that are behind the other surface and that edges without contacts connect to the curve. Exact signs decide what is behind, so vertices that are on the other surface hide nothing. Where a part goes through the other object, so that it is in front again beyond another curve, its far end belongs to the contact, too, unless it has many more vertices than the curve has contacts. Where the other object is not solid, or the same one, the contact has at most 64 + 16 n + n² / 4 vertices of a side for n contacts, those nearest to the curve by edges. O(n log n) for n triangles of the contact, and the rays.\n\nThe depth along a direction is the longest way, in this direction, from a point of a to a point of b straight ahead; rays from vertices inside add the triangles through which these leave. Triangles parallel to the direction have nothing ahead, and triangles that touch only beside each other are not ahead of each other: sides that slide past each other do not count. Between two objects, the longest way goes on from its ends to triangles beside them while these have a longer one: a also leaves what it would only enter on its way. So convex objects are apart after the move. Where the longest way begins in the front of a solid a, or ends in the back of a solid b, the other side there counts, too. A direction in which nothing is ahead counts only where all are such; the depth is then 0, as for surfaces that only touch.\n\n`normal` has the least depth of these: the outward normals of the faces of b, and the reverse of those of a, on which the curve lies (of more than twelve, those of at least an eighth of the curve); the direction of the curve's area, or of its segments when it is not closed; and the shortest moves out of two or three of these faces at once, where no face alone is shorter. Where there are none, it is the mean direction of the contacts' normals by length. Contacts in which one triangle is nowhere behind the other only touch: their faces count where there are no others. Of several directions with the same depth (within 2^-36), it is the one with the largest x, then y, then z component, by magnitude. A depth of at most 2^-49 of the largest coordinate is rounding and can be too long. A small move can change the normal, but hardly the depth. To exchange a and b reverses the normal, unless opposite directions have the same depth."

    __slots__ = ()
    a: np.uint32
    'Object a; the same as b for a curve of an object with itself'
    a_generation: np.uint32
    'Object a; the same as b for a curve of an object with itself'
    b: np.uint32
    'Object b'
    b_generation: np.uint32
    'Object b'
    kind: Literal['closed', 'open', 'branched']
    'How the contacts of the curve are linked'
    first_contact: np.uint32
    'First contact of the curve'
    contact_count: np.uint32
    'Number of contacts'
    first_point: np.uint32
    'First point of the curve'
    point_count: np.uint32
    'Number of points: one more than contacts for an open curve, none for a branched one'
    first_enclosed: np.uint32
    'First vertex that the curve cuts off'
    enclosed_count_a: np.uint32
    'Number of these vertices of object a'
    enclosed_count_b: np.uint32
    'Number of vertices of object b, which follow'
    centroid: npt.NDArray[np.float64]
    'Centroid of the segments'
    area: npt.NDArray[np.float64]
    'Vector area of a closed curve; else zero'
    normal: npt.NDArray[np.float64]
    'Unit vector along which a leaves b; zero if none'
    depth: np.float64
    'How far a must move along the normal'


class LimitingPair(Record):
    'The two elements that limit a step, named as in `ContinuousContact`.'

    __slots__ = ()
    object_a: np.uint32
    'Object a'
    object_a_generation: np.uint32
    'Object a'
    object_b: np.uint32
    'Object b'
    object_b_generation: np.uint32
    'Object b'
    kind: Literal['vf', 'fv', 'ee', 've', 'ev', 'vv']
    'Kinds of the elements'
    element_a: npt.NDArray[np.uint32]
    'Element of object a'
    element_b: npt.NDArray[np.uint32]
    'Element of object b'
    element: npt.NDArray[np.uint32]
    'Both sides in one'
    object: npt.NDArray[np.uint32]
    'Both sides in one'
    vertices: npt.NDArray[np.uint32]
    'The vertices of both elements, (2, 3)'


class ListedRayHit(Record):
    'One of the triangles on a ray; see `Scene.cast_all`.'

    __slots__ = ()
    query: np.uint32
    'Place of the ray in the list of rays'
    object: np.uint32
    'Object of the triangle'
    object_generation: np.uint32
    'Object of the triangle'
    triangle: np.uint32
    'Triangle that the ray hits'
    t: np.float64
    'Parameter of the hit along the direction of the ray'
    point: npt.NDArray[np.float64]
    'Point of the hit'
    barycentric: npt.NDArray[np.float64]
    'Barycentric coordinates of the hit'
    hits: np.uint64
    'Triangles on the whole ray; 1 if they were not counted'


class Manifold(Record):
    'A patch of contacts of two objects, or of one object with itself, reduced to what a rigid body needs: one normal, one depth, and at most four points that span it. With penetration, each `IntersectionCurve` is a patch. Two objects without a curve have the patches of their proximity pairs: a patch has the nearest pair that is in no patch yet, and all pairs in no patch whose normals are within 45 degrees of its normal. It does not depend on how the surfaces are divided into triangles. A patch of two objects also replaces pairs whose elements are as far apart along its normal as the nearest pair: for example an edge of a floor and an edge of the side of a box that stands on it.\n\nWhere objects touch, or are as near as coordinates are rounded (2^-40 of their size), the points of a pair give no direction. The surfaces around the points do: the direction in which a plane lies between both, which is the normal of a face where there is such a face. So a box on a floor has the normal of the floor, whichever of them is a. Surfaces that lie in the plane keep the side to which they look, closed ones first. A pair where one surface fits into the other one has the normal of each face that keeps them apart, so a box in a corner has a patch for each wall.\n\nPairs know nothing of depth. Two objects whose surfaces cut through each other have no manifold of pairs, and a patch has none when the way between the points of its nearest pair starts inside a solid. So no manifold moves a body deeper. Request penetration, too, where objects may overlap.\n\nThe points are the deepest one, the one farthest from it, and those that add most area. Of several deepest ones (within 2^-40), the first is a corner of the patch. Of points that add as much, the deepest is taken. Points that add less than 2^-10 of the distance of the first two are left out, so an edge has two points and a vertex has one. They run counter-clockwise, seen from a.\n\nA manifold keeps its id while it stays. Of all manifolds of two objects in two steps that follow each other, those with most features in common are the same, then those whose points are nearest to each other. (A feature is a vertex, edge or triangle of one object.) So the only manifold of two objects stays as long as they have one; when a patch splits, one part stays and the others begin; when patches merge, one stays and the others end. The points of a manifold that stays are matched in the same way. A step without manifolds ends all.'

    __slots__ = ()
    a: np.uint32
    'Object a; the same as b for a patch of an object with itself'
    a_generation: np.uint32
    'Object a; the same as b for a patch of an object with itself'
    b: np.uint32
    'Object b'
    b_generation: np.uint32
    'Object b'
    id: np.uint64
    'Id of the manifold, while it stays'
    lasting: Literal['begin', 'stay']
    'Whether the manifold was there in the last step (stay) or not (begin)'
    source: Literal['curve', 'pairs']
    'What the manifold summarises: a curve of intersection (curve) or proximity pairs (pairs)'
    normal: npt.NDArray[np.float64]
    'Unit vector from b to a'
    depth: np.float64
    'Depth of the curve, or minus the smallest distance'
    first_point: np.uint32
    'First point of the manifold'
    point_count: np.uint32
    'Number of points: 1 to 4'
    record: np.uint32
    'Index of the curve or of the nearest proximity pair'


class ManifoldPoint(Record):
    'One of the points that span a manifold.'

    __slots__ = ()
    id: np.uint64
    'Id of the point, while it stays'
    lasting: Literal['begin', 'stay']
    'Whether the point was there in the last step (stay) or not (begin)'
    position: npt.NDArray[np.float64]
    'The point'
    depth: np.float64
    'How deep the point is; negative where the objects are apart'


class NonFiniteVertex(Record):
    'A vertex with a coordinate that is not a finite number. The triangles that use it are inert: they are in no box and in no contact until the vertex has a finite position. Vertices that nothing uses, such as those that `ObjectOptions.weld` replaces by others, are not listed.'

    __slots__ = ()
    object: np.uint32
    'Object of the vertex'
    object_generation: np.uint32
    'Object of the vertex'
    vertex: np.uint32
    'Vertex with a coordinate that is not finite'
    position: npt.NDArray[np.float64]
    'Its position'


class ObjectPair(Record):
    'Two different objects, `a.index < b.index`.'

    __slots__ = ()
    a: np.uint32
    'Object a'
    a_generation: np.uint32
    'Object a'
    b: np.uint32
    'Object b'
    b_generation: np.uint32
    'Object b'


class Overlap(Record):
    'A triangle that shares a point with a box or a sphere. Exact.'

    __slots__ = ()
    query: np.uint32
    'Place of the box or sphere in the list of queries'
    object: np.uint32
    'Object of the triangle'
    object_generation: np.uint32
    'Object of the triangle'
    triangle: np.uint32
    'Triangle that overlaps it'


class Penetration(Record):
    'A vertex of one object inside another object, which is solid. A vertex that is on the surface is not inside. Exact, but for the rounded numbers.'

    __slots__ = ()
    object_a: np.uint32
    'Object of the vertex'
    object_a_generation: np.uint32
    'Object of the vertex'
    object_b: np.uint32
    'Solid object in which the vertex is'
    object_b_generation: np.uint32
    'Solid object in which the vertex is'
    vertex: np.uint32
    'Vertex of object a'
    triangle: np.uint32
    'Nearest triangle of object b'
    feature_kind: Literal['vertex', 'edge', 'face']
    'Smallest part of it that holds the closest point'
    feature_index: np.uint8
    'Smallest part of it that holds the closest point'
    depth: np.float64
    'Distance to the surface of object b'
    barycentric: npt.NDArray[np.float64]
    'Barycentric coordinates of the closest point'
    point: npt.NDArray[np.float64]
    'Closest point'
    normal: npt.NDArray[np.float64]
    'Unit vector from the vertex to this point'
    object: npt.NDArray[np.uint32]
    'Both sides in one'


class PenetrationDifference(Record):
    'A vertex of a on which `verify` and the last `Scene.detect` differ: inside b, on its surface, the smallest vertex of a contained part, or inside b within a curve.'

    __slots__ = ()
    object_a: np.uint32
    'Object of the vertex'
    object_a_generation: np.uint32
    'Object of the vertex'
    object_b: np.uint32
    'Solid object'
    object_b_generation: np.uint32
    'Solid object'
    vertex: np.uint32
    'Vertex of object a'
    fault: Literal['missed', 'added', 'inexact']
    'What is wrong'
    object: npt.NDArray[np.uint32]
    'Both sides in one'


class PenetrationGroup(Record):
    'The vertices of a that are inside b or on its surface: ranges of `DetectResult.penetrations` and of `DetectResult.vertices_on_surface`, each with ascending vertices. Only pairs with such a vertex are listed. The vertices of b inside a are a group of their own.'

    __slots__ = ()
    a: np.uint32
    'Object whose vertices are inside b or on its surface'
    a_generation: np.uint32
    'Object whose vertices are inside b or on its surface'
    b: np.uint32
    'Solid object'
    b_generation: np.uint32
    'Solid object'
    first_penetration: np.uint32
    'First vertex inside'
    penetration_count: np.uint32
    'Number of vertices inside'
    first_on_surface: np.uint32
    'First vertex on the surface'
    on_surface_count: np.uint32
    'Number of vertices on the surface'


class ProximityDifference(Record):
    'A pair of features or elements on which `verify` and the last `Scene.detect` differ.'

    __slots__ = ()
    object_a: np.uint32
    'Object a'
    object_a_generation: np.uint32
    'Object a'
    object_b: np.uint32
    'Object b'
    object_b_generation: np.uint32
    'Object b'
    kind_a: Literal['vertex', 'edge', 'face']
    'Kind of element a'
    kind_b: Literal['vertex', 'edge', 'face']
    'Kind of element b'
    element_a: npt.NDArray[np.uint32]
    'Element of object a'
    element_b: npt.NDArray[np.uint32]
    'Element of object b'
    fault: Literal['missed', 'added', 'inexact']
    'What is wrong'
    element: npt.NDArray[np.uint32]
    'Both sides in one'
    object: npt.NDArray[np.uint32]
    'Both sides in one'
    kind: npt.NDArray[np.uint8]
    'Both sides in one'


class ProximityPair(Record):
    'Two features or elements whose distance is at most the sum of the margins of their objects, or twice the margin within one object. Exact arithmetic decides this on the given coordinates, and which features hold the closest points; `distance.hpp` says which where several do. The sum is rounded to double once.\n\nAn edge and a face are a pair at distance 0 where the inside of the edge crosses the inside of the face, with its ends on different sides of the plane: surfaces that cut through each other are near, also away from all other edges and vertices. Each other point of an edge and a face is in a pair of a vertex and the face or of two edges at distance 0. So each point is named once. Such a pair is the same in both listings and for all margins. `ElementKinds.vertex_face` and `edge_edge` leave it out.\n\nWithin one object, elements that share a vertex id are left out. So features that share one occur only through other elements. A vertex stands before an edge or a face there, and the smaller of two vertices or edges stands first.'

    __slots__ = ()
    object_a: np.uint32
    'Object a; the same as b for a pair of one object'
    object_a_generation: np.uint32
    'Object a; the same as b for a pair of one object'
    object_b: np.uint32
    'Object b'
    object_b_generation: np.uint32
    'Object b'
    kind_a: Literal['vertex', 'edge', 'face']
    'Kind of element a'
    kind_b: Literal['vertex', 'edge', 'face']
    'Kind of element b'
    element_a: npt.NDArray[np.uint32]
    'Element of object a'
    element_b: npt.NDArray[np.uint32]
    'Element of object b'
    feature_a_kind: Literal['vertex', 'edge', 'face']
    'Smallest part of element a that holds the closest point'
    feature_a_index: np.uint8
    'Smallest part of element a that holds the closest point'
    feature_b_kind: Literal['vertex', 'edge', 'face']
    'Smallest part of element b that holds the closest point'
    feature_b_index: np.uint8
    'Smallest part of element b that holds the closest point'
    distance: np.float64
    'Distance of the elements'
    barycentric_a: npt.NDArray[np.float64]
    'Barycentric coordinates of the closest point on element a'
    barycentric_b: npt.NDArray[np.float64]
    'Barycentric coordinates of the closest point on element b'
    point_a: npt.NDArray[np.float64]
    'Closest point of a'
    point_b: npt.NDArray[np.float64]
    'Closest point of b'
    normal: npt.NDArray[np.float64]
    'Unit vector from b to a'
    barycentric: npt.NDArray[np.float64]
    'Both sides in one'
    element: npt.NDArray[np.uint32]
    'Both sides in one'
    object: npt.NDArray[np.uint32]
    'Both sides in one'
    point: npt.NDArray[np.float64]
    'Both sides in one'
    kind: npt.NDArray[np.uint8]
    'Both sides in one'
    vertices: npt.NDArray[np.uint32]
    'The vertices of both elements, (2, 3)'


class RayHit(Record):
    'The first triangle on a ray, as a closed set: its edges and corners count. Exact arithmetic decides which triangle it is; of several at the same t it is the one with the smallest object, then the smallest number.'

    __slots__ = ()
    object: np.uint32
    'Object of the triangle'
    object_generation: np.uint32
    'Object of the triangle'
    triangle: np.uint32
    'Triangle that the ray hits'
    t: np.float64
    'Parameter of the hit along the direction of the ray'
    point: npt.NDArray[np.float64]
    'Point of the hit'
    barycentric: npt.NDArray[np.float64]
    'Barycentric coordinates of the hit'
    hits: np.uint64
    'Triangles on the whole ray; 1 if they were not counted'


class FoundRayHit(Record):
    'The first triangle on a ray, as a closed set: its edges and corners count. Exact arithmetic decides which triangle it is; of several at the same t it is the one with the smallest object, then the smallest number.'

    __slots__ = ()
    found: np.bool_
    'Whether there is an answer; the other members are valid only then'
    object: np.uint32
    'Object of the triangle'
    object_generation: np.uint32
    'Object of the triangle'
    triangle: np.uint32
    'Triangle that the ray hits'
    t: np.float64
    'Parameter of the hit along the direction of the ray'
    point: npt.NDArray[np.float64]
    'Point of the hit'
    barycentric: npt.NDArray[np.float64]
    'Barycentric coordinates of the hit'
    hits: np.uint64
    'Triangles on the whole ray; 1 if they were not counted'


class TriangleIntersection(Record):
    'What two closed triangles share: the extreme points of their intersection.'

    __slots__ = ()
    intersects: np.bool_
    'Whether the triangles have a point in common'
    used_exact_fallback: np.bool_
    'Whether integers decided because floating-point filters could not'
    kind: Literal['point', 'segment', 'polygon']
    'What they share; meaningful if they intersect'
    point_count: np.uint8
    'Points of the intersection: 0 to 6'
    position_0: npt.NDArray[np.float64]
    'The point'
    feature_a_kind_0: Literal['vertex', 'edge', 'face']
    'Smallest part of triangle a on which the point lies'
    feature_a_index_0: np.uint8
    'Smallest part of triangle a on which the point lies'
    feature_b_kind_0: Literal['vertex', 'edge', 'face']
    'Smallest part of triangle b on which the point lies'
    feature_b_index_0: np.uint8
    'Smallest part of triangle b on which the point lies'
    position_1: npt.NDArray[np.float64]
    'The point'
    feature_a_kind_1: Literal['vertex', 'edge', 'face']
    'Smallest part of triangle a on which the point lies'
    feature_a_index_1: np.uint8
    'Smallest part of triangle a on which the point lies'
    feature_b_kind_1: Literal['vertex', 'edge', 'face']
    'Smallest part of triangle b on which the point lies'
    feature_b_index_1: np.uint8
    'Smallest part of triangle b on which the point lies'
    position_2: npt.NDArray[np.float64]
    'The point'
    feature_a_kind_2: Literal['vertex', 'edge', 'face']
    'Smallest part of triangle a on which the point lies'
    feature_a_index_2: np.uint8
    'Smallest part of triangle a on which the point lies'
    feature_b_kind_2: Literal['vertex', 'edge', 'face']
    'Smallest part of triangle b on which the point lies'
    feature_b_index_2: np.uint8
    'Smallest part of triangle b on which the point lies'
    position_3: npt.NDArray[np.float64]
    'The point'
    feature_a_kind_3: Literal['vertex', 'edge', 'face']
    'Smallest part of triangle a on which the point lies'
    feature_a_index_3: np.uint8
    'Smallest part of triangle a on which the point lies'
    feature_b_kind_3: Literal['vertex', 'edge', 'face']
    'Smallest part of triangle b on which the point lies'
    feature_b_index_3: np.uint8
    'Smallest part of triangle b on which the point lies'
    position_4: npt.NDArray[np.float64]
    'The point'
    feature_a_kind_4: Literal['vertex', 'edge', 'face']
    'Smallest part of triangle a on which the point lies'
    feature_a_index_4: np.uint8
    'Smallest part of triangle a on which the point lies'
    feature_b_kind_4: Literal['vertex', 'edge', 'face']
    'Smallest part of triangle b on which the point lies'
    feature_b_index_4: np.uint8
    'Smallest part of triangle b on which the point lies'
    position_5: npt.NDArray[np.float64]
    'The point'
    feature_a_kind_5: Literal['vertex', 'edge', 'face']
    'Smallest part of triangle a on which the point lies'
    feature_a_index_5: np.uint8
    'Smallest part of triangle a on which the point lies'
    feature_b_kind_5: Literal['vertex', 'edge', 'face']
    'Smallest part of triangle b on which the point lies'
    feature_b_index_5: np.uint8
    'Smallest part of triangle b on which the point lies'
    normal: npt.NDArray[np.float64]
    'Unit vector from b to a'


class UntestedKind(Record):
    'A kind of contacts for which there was nothing to test.'

    __slots__ = ()
    kind: Literal['none', 'intersection', 'continuous', 'intersection,continuous', 'proximity', 'intersection,proximity', 'continuous,proximity', 'intersection,continuous,proximity', 'penetration', 'intersection,penetration', 'continuous,penetration', 'intersection,continuous,penetration', 'proximity,penetration', 'intersection,proximity,penetration', 'continuous,proximity,penetration', 'intersection,continuous,proximity,penetration']
    'Kind of contacts'
    reason: Literal['no_objects', 'no_elements', 'not_finite', 'no_solid', 'no_motion', 'no_margin', 'one_object', 'all_static', 'groups', 'filter']
    'Why there was nothing to test'


class ResultLists:
    'The lists of a result.'

    @property
    def object_pairs(self) -> Table[ObjectPair]:
        'pairs whose volumes overlap and whose filters agree'
        raise NotImplementedError

    @property
    def groups(self) -> Table[ContactGroup]:
        'of `contacts`'
        raise NotImplementedError

    @property
    def contacts(self) -> Table[Contact]:
        'contacts'
        raise NotImplementedError

    @property
    def intersection(self) -> Table[Contact]:
        'intersection'
        raise NotImplementedError

    @property
    def contact_points(self) -> Table[ContactPoint]:
        'contact_points'
        raise NotImplementedError

    @property
    def continuous_groups(self) -> Table[ContactGroup]:
        'of `continuous_contacts`'
        raise NotImplementedError

    @property
    def continuous_contacts(self) -> Table[ContinuousContact]:
        'Ordered by object a, object b, kind, element a, element b.'
        raise NotImplementedError

    @property
    def continuous(self) -> Table[ContinuousContact]:
        'Ordered by object a, object b, kind, element a, element b.'
        raise NotImplementedError

    @property
    def proximity_groups(self) -> Table[ContactGroup]:
        'of `proximity_pairs`'
        raise NotImplementedError

    @property
    def proximity_pairs(self) -> Table[ProximityPair]:
        'Ordered by object a, object b, kind a, kind b, element a, element b.'
        raise NotImplementedError

    @property
    def proximity(self) -> Table[ProximityPair]:
        'Ordered by object a, object b, kind a, kind b, element a, element b.'
        raise NotImplementedError

    @property
    def penetration_groups(self) -> Table[PenetrationGroup]:
        'Of `penetrations` and `vertices_on_surface`; ordered by object a, object b.'
        raise NotImplementedError

    @property
    def penetrations(self) -> Table[Penetration]:
        'ordered by object a, object b, vertex'
        raise NotImplementedError

    @property
    def penetration(self) -> Table[Penetration]:
        'ordered by object a, object b, vertex'
        raise NotImplementedError

    @property
    def vertices_on_surface(self) -> npt.NDArray[np.uint32]:
        'vertices_on_surface'
        raise NotImplementedError

    @property
    def contained_parts(self) -> Table[ContainedPart]:
        'ordered by inner object, outer object, vertex'
        raise NotImplementedError

    @property
    def curves(self) -> Table[IntersectionCurve]:
        'Ordered by object a, object b, smallest contact.'
        raise NotImplementedError

    @property
    def curve_contacts(self) -> npt.NDArray[np.uint32]:
        'indices into `contacts`'
        raise NotImplementedError

    @property
    def curve_points(self) -> npt.NDArray[np.float64]:
        'curve_points'
        raise NotImplementedError

    @property
    def enclosed_vertices(self) -> npt.NDArray[np.uint32]:
        'enclosed_vertices'
        raise NotImplementedError

    @property
    def manifolds(self) -> Table[Manifold]:
        'Ordered by object a, object b, then curves by their first contact, and pairs by their smallest distance.'
        raise NotImplementedError

    @property
    def manifold_points(self) -> Table[ManifoldPoint]:
        'manifold_points'
        raise NotImplementedError

    @property
    def ended_manifolds(self) -> Table[EndedManifold]:
        'those of the last step that are gone, in its order'
        raise NotImplementedError

    @property
    def colliding_vertex_groups(self) -> Table[CollidingVertices]:
        'colliding_vertex_groups'
        raise NotImplementedError

    @property
    def colliding_vertices(self) -> npt.NDArray[np.uint32]:
        'colliding_vertices'
        raise NotImplementedError

    @property
    def non_finite_vertices(self) -> Table[NonFiniteVertex]:
        'non_finite_vertices'
        raise NotImplementedError
