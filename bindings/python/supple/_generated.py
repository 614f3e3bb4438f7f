"""Made from docs/api.json by tools/make_python.py."""

import enum


class ObjectOctreeBuild(enum.IntEnum):
    'How the octree of an object is built; see `use_comparison_methods`. The contacts are the same for all.'

    balanced = 0
    'Top-down. Distributes the triangles among the children so that leaves are about equally full. This takes the fewest leaves. The arity is eight; `Scene.add` throws `Error` for another one.'
    regular = 1
    'Top-down, as in the paper: the children of a node are the octants of its cell.'
    bottom_up = 2
    'Bottom-up: merges neighbouring triangles into leaves, then leaves into nodes, up to the root.'


class SphereFit(enum.IntEnum):
    'How a sphere is fitted to a node.'

    vertices = 0
    "The center of the node's box; the radius reaches the farthest vertex (the paper's eq. 5). Conservative."
    minimal = 1
    'The smallest sphere around the vertices, up to rounding: often smaller, never larger than that of `vertices`. Conservative. The refit takes longer.'
    medial = 2
    'Around a point of the medial axis, chosen at rest so that the sphere is smallest, which moves with a triangle, or as `vertices` where that is smaller. Conservative. Builds and refits take longer.'
    box = 3
    "Center and radius from the longest side L of the box (the paper's eq. 3 and 4). The sphere does not enclose the corners of the box, so `detect` misses collisions. Only to repeat the paper's experiment."


class RegionSphereTest(enum.IntEnum):
    'How a region of the scene octree is tested against a sphere.'

    arvo = 0
    'closest point of the region (Arvo 1990)'
    grown_box = 1
    "the paper's: center inside the region grown by the radius; reports too much near corners"


class Descent(enum.IntEnum):
    'The order in which the narrow phase compares the children of two nodes. The candidates are the same, and with spheres those of `one_side_first` can be fewer; the contacts are the same.'

    both_sides = 0
    'all children of one node with all of the other, with vector instructions'
    one_side_first = 1
    "As in the paper's Figure 4: the children of the first node with the second node, then those that collide with the children of the second node. `StepStats.boxes_tested` counts only these tests. For contacts at rest; it is slower and needs `use_comparison_methods`."


class FeatureKind(enum.IntEnum):
    'The smallest part of a triangle on which a point of an intersection lies.'

    vertex = 0
    edge = 1
    face = 2


class IntersectionKind(enum.IntEnum):
    'What two intersecting closed triangles share.'

    point = 0
    segment = 1
    polygon = 2


class ElementPairKind(enum.IntEnum):
    'The kinds of the two elements of a continuous contact: first of object a, then of object b. A contact of an object with itself is never `face_vertex` or `edge_vertex`: its element a is the vertex. The last three occur with `ObjectOptions.edges` and `points`: a vertex and an edge or a point of these lists.'

    vertex_face = 0
    face_vertex = 1
    edge_edge = 2
    vertex_edge = 3
    edge_vertex = 4
    vertex_vertex = 5


class ImpactCertainty(enum.IntEnum):
    'Whether an impact is proven.'

    certain = 0
    'proven: the elements touch'
    within_tolerance = 1
    'So close that floating point cannot decide. Only when `exact` is off.'


class Lasting(enum.IntEnum):
    'Whether something was there in the last step. What ends is no longer listed.'

    begin = 0
    stay = 1


class ManifoldSource(enum.IntEnum):
    'What a manifold summarises.'

    curve = 0
    pairs = 1


class BoundingVolume(enum.IntEnum):
    "Shape that encloses the nodes of an object's octree, and the object itself in the broad phase. The contacts are the same for all. Searches for continuous contacts and proximity use boxes for the nodes, and boxes or spheres for the objects.\n\nVolumes other than boxes need `use_comparison_methods`. Oriented boxes and k-DOPs are tested where boxes overlap. They are tighter than boxes, and take more memory and more time to refit and to test."

    aabb = 0
    'axis-aligned box'
    sphere = 1
    'fitted as `SphereFit` says'
    obb = 2
    'Box along the principal axes of the surface (Gottschalk, Lin and Manocha 1996). Each refit computes its axes again.'
    kdop14 = 3
    'Polytopes with fixed directions (Klosowski et al. 1998): the faces of the box, and planes that cut off its corners (14), its edges (18), or both (26).'
    kdop18 = 4
    kdop26 = 5


class BroadPhaseMethod(enum.IntEnum):
    'How object pairs are found. All methods report the same pairs in the same order.'

    automatic = 0
    'Picks octree or grid in each step. The octree runs when fewer than one object in 24 changed in this step and in each of the three before; otherwise the grid runs. A scene in which more than 256 other objects share the grid cell of an average object runs the octree, and tries the grid again after 64 steps.'
    octree = 1
    "The paper's incremental octree of regions. Best when few objects change, or when many objects are in few places. `SceneInspector.regions` returns its regions."
    grid = 2
    'A hierarchical grid that is rebuilt in each step with changes. Best when many objects change.'
    sweep = 3
    'sweep and prune along one axis; needs `use_comparison_methods`'
    brute = 4
    'every object against every other; needs `use_comparison_methods`'
    sweep3 = 5
    'sweep and prune on three lists that stay sorted (Baraff 1992); needs `use_comparison_methods`'


class ContactKinds(enum.IntFlag):
    'Kinds of contacts, a set: `ContactKinds::intersection | ContactKinds::continuous`.'

    none = 0
    'object pairs and candidate counts only'
    intersection = 1
    'every pair of triangles that intersects, with normal and points'
    continuous = 2
    'Every vertex and face and every two edges that touch on their paths within the step. Bodies that already cut through each other at the start of the step are found by `intersection`, not by `continuous`.'
    proximity = 4
    'Every two features, or elements, within the margins of their objects at the current positions; see `ProximityPair`.'
    penetration = 8
    'What objects that intersect do: vertices inside solids with their depths, and contained parts; with `SceneOptions.curves` also curves. See `Penetration`, `ContainedPart` and `IntersectionCurve`. It includes `intersection`.'


class ElementKinds(enum.IntEnum):
    'The pairs of elements that continuous contacts and proximity search. For proximity, `all` also has edges that cross faces.'

    all = 0
    vertex_face = 1
    'vertices with faces, edges and points'
    edge_edge = 2


class ContinuousListing(enum.IntEnum):
    'Which continuous contacts are listed.'

    all = 0
    first = 1
    'The first contact of each vertex, edge and face, by time of impact and then in canonical order.'


class Neighbours(enum.IntEnum):
    'Whether triangles of one object that share a vertex id are tested against each other.'

    skip = 0
    exact = 1
    'Intersections of triangles with themselves also find triangles that share a vertex or an edge and meet elsewhere, as exact arithmetic decides. Two triangles with the same vertices always do.'


class CurveKind(enum.IntEnum):
    'How the contacts of a curve are linked.'

    closed = 0
    'a loop of segments'
    open = 1
    'a chain of segments with two ends'
    branched = 2
    'everything else: more than two contacts meet in a point, or triangles share more or less than a segment'


class ProximityListing(enum.IntEnum):
    'What a list of proximity pairs contains.'

    features = 0
    'Each pair of features once: two vertices, a vertex and the inside of an edge or of a face, or the insides of two edges; and each edge that crosses a face. What a solver needs: one pair for each constraint.'
    elements = 1
    'Every vertex and face and every two edges within the margins, with their closest points; and each edge that crosses a face.'


class Containment(enum.IntEnum):
    'Where a point is with respect to closed surfaces.'

    outside = 0
    on = 1
    'in a triangle'
    inside = 2
    'a ray from the point crosses the surface an odd number of times'


class NothingToTest(enum.IntEnum):
    'Why there was nothing to test for a kind of contacts.'

    no_objects = 0
    'the scene has no object'
    no_elements = 1
    'No object has a triangle. For continuous contacts and proximity: nor an edge or a point, or no edge when only pairs of edges are searched.'
    not_finite = 2
    'each element has a vertex that is not finite'
    no_solid = 3
    'penetration: no object is solid'
    no_motion = 4
    'continuous contacts: no object has a path'
    no_margin = 5
    'proximity: all margins are 0, so that only elements at distance 0 are near'
    one_object = 6
    'one object has elements, and it is not tested against itself or has only one'
    all_static = 7
    'all objects with elements are static'
    groups = 8
    'groups and masks of objects exclude all pairs'
    filter = 9
    'the pair filter excludes all pairs'


class ResultPlacement(enum.IntEnum):
    'On which rank the contacts of a step are.'

    gathered = 0
    'all on rank 0: the lists of `Scene.detect`'
    owner = 1
    'On the rank that added object a; of an object in parts, on the lowest rank that has one of them. The events and pairs of two objects are on a rank that their ids choose.'
    spread = 2
    'Where they were found, so nothing is sent: as even as the work. The events and pairs of two objects are on a rank that their ids choose.'


class PairStage(enum.IntEnum):
    'The stage that separated two triangles, in the order of the stages. With continuous contacts, a stage separates the triangles for the whole step. Their elements are tested separately, so `contact` then takes precedence over every stage except the first.'

    not_tested = 0
    'The scene does not test these objects (static, group and mask, filter, no self-collision) or these triangles (groups of vertices).'
    shared_vertex = 1
    'Both in one object, with a common vertex, or the same triangle: no contact, unless `Neighbours.exact` finds that they also meet elsewhere.'
    inert = 2
    'a corner is not a finite number'
    object_volumes = 3
    'the volumes of the objects are apart: the broad phase'
    octree_volumes = 4
    'the volumes of two octree cells are apart: the narrow phase'
    triangle_boxes = 5
    'the boxes of the triangles are apart: the leaves'
    exact_test = 6
    'the triangles are apart: the exact stage'
    contact = 7
    'the triangles intersect: a contact'


class ContinuousDifferenceFault(enum.IntEnum):
    'What is wrong with the pair.'

    missed = 0
    'the pair touches and was not reported'
    added = 1
    'reported as certain, but does not touch'
    late = 2
    'reported with a time after the first contact, or as apart at the start while they touch there'
    early = 3
    'earlier than `toi_tolerance_at` allows, or as touching at the start while they are apart'


class ProximityDifferenceFault(enum.IntEnum):
    'What is wrong with the pair.'

    missed = 0
    'the pair is within the margins and was not reported'
    added = 1
    'reported, but not within the margins, or not of closest features, or twice'
    inexact = 2
    'reported with other features than those that are closest, or with an inaccurate distance'


class PenetrationDifferenceFault(enum.IntEnum):
    'What is wrong with the vertex.'

    missed = 0
    'inside, on the surface or contained, and not reported as that'
    added = 1
    'reported, but not so'
    inexact = 2
    'reported with another triangle than the nearest, or with an inaccurate depth; or it does not leave b when it moves along the normal of the curve by its depth'


class Integrator(enum.IntEnum):
    'How a time step advances positions and velocities.'

    verlet = 0
    'Velocity Verlet with the damping of Teschner et al. 2004. Second order, one evaluation of forces per step.'
    symplectic_euler = 1
    'New velocities first, then positions with these velocities. First order, one evaluation of forces per step.'
    backward_euler = 2
    'Implicit: up to six sparse linear systems per step. First order, stable at any stiffness.'


ENUMERATIONS = [ObjectOctreeBuild, SphereFit, RegionSphereTest, Descent, FeatureKind, IntersectionKind, ElementPairKind, ImpactCertainty, Lasting, ManifoldSource, BoundingVolume, BroadPhaseMethod, ContactKinds, ElementKinds, ContinuousListing, Neighbours, CurveKind, ProximityListing, Containment, NothingToTest, ResultPlacement, PairStage, ContinuousDifferenceFault, ProximityDifferenceFault, PenetrationDifferenceFault, Integrator]


#: The comments of functions and methods in the headers.
CONTRACTS = {
    'Aabb::empty':
        'True when the box contains no point.',
    'BoundingSphere::empty':
        'See `BoundingSphere::empty` in supple/types.hpp.',
    'BroadPhase::find_object_pairs':
        'All pairs whose closed volumes overlap, each once, sorted by (a, b). The span lasts until the next call.\n\nThe number of volumes may change between calls: volumes past the end were removed. Empty volumes are in no pair. Coordinates may be infinite. A box with a NaN is empty. A sphere with a NaN overlaps every sphere that is not empty. Spheres are compared in double: rounding may add pairs of spheres that are just apart, but never loses a pair. A call with spheres after a call with boxes, or the reverse, forgets all volumes of the call before.\n\nCost for n volumes, k pairs and c changed volumes: the comparison of volumes is O(n). When no volume changed, this is the whole cost. Otherwise the search is\n- octree: O(c + k), or O(n + k) when c is large or the regions are rebuilt,\n- grid: O(n + k) unless many volumes share cells,\n- sweep: O(n log n + pairs that overlap along one axis),\n- brute: O(n²),\n- sweep3: O(n + k + exchanges of two ends), or as sweep when a volume appears or becomes empty.\nA call with at most 2^20 pairs allocates no memory once the buffers are as large as the scene needs.',
    'BroadPhase::regions':
        'The regions that the last search used, root first, ascending by number. Empty unless the octree ran. O(regions log regions).',
    'BroadPhase::stats':
        'Statistics of the last call.',
    'BroadPhase::validate':
        'Checks every invariant. Returns an empty string, or a description of the first error. For tests.',
    'ContactKindInfo::is_in':
        'See `ContactKindInfo::is_in` in supple/result.hpp.',
    'DetectResult::contacts_of':
        'See `DetectResult::contacts_of` in supple/result.hpp.',
    'DetectResult::continuous_contacts_of':
        'See `DetectResult::continuous_contacts_of` in supple/result.hpp.',
    'DetectResult::enclosed_vertices_of':
        'The vertices that a curve encloses on one side.',
    'DetectResult::penetrations_of':
        'See `DetectResult::penetrations_of` in supple/result.hpp.',
    'DetectResult::points_of':
        'See `DetectResult::points_of` in supple/result.hpp.',
    'DetectResult::proximity_pairs_of':
        'See `DetectResult::proximity_pairs_of` in supple/result.hpp.',
    'DetectResult::vertices_on_surface_of':
        'See `DetectResult::vertices_on_surface_of` in supple/result.hpp.',
    'DistributedScene::add':
        'Adds an object whose triangles are all on this rank. Throws `Error` as `Scene.add` does, when this rank has the id, and when the options have `weld` or `same_vertex`: weld the mesh first.',
    'DistributedScene::add_part':
        "Adds a part of an object. `triangles` have the numbers of the part's vertices: 0 is the first of `part.vertices`. All ranks give the same options. Throws `Error` as `add` does.",
    'DistributedScene::closest':
        'As `Scene.closest` for the points of this rank, among the objects of all ranks. The options are the same on all ranks; a signed distance is an error. Each point goes to the ranks whose regions its ball meets, whose radius is the distance of the farthest corner of a cluster near it.',
    'DistributedScene::collision_free_step':
        'As `Scene.collision_free_step`; the same on all ranks.',
    'DistributedScene::detect':
        'Finds the contacts as `Scene.detect` does. The result is valid until the next call. Counts of its statistics are sums over all ranks, its times those of the slowest rank. A stop on one rank stops the call on all of them. Requests with `max_contacts`, manifolds or first contacts of elements are errors.',
    'DistributedScene::distances':
        'As `Scene.distances`, on the ranks that `ResultPlacement` says. A rank gets both objects of a pair. A stop on one rank is an `Error` on all of them, because an empty list would look like an answer.',
    'DistributedScene::earliest_impact':
        'As `Scene.earliest_impact`; the same on all ranks.',
    'DistributedScene::load':
        'Collective, for a scene without objects: adds those of a file of `save`, spread evenly over the ranks, however many wrote it. Parts of an object on one rank become one part. With the same options, the next steps have the results and events that they would have had without the restart. `objects` says what this rank has now. Throws `Error` when the file cannot be read, is cut off or damaged.',
    'DistributedScene::max_step':
        'As `Scene.max_step`; the same on all ranks.',
    'DistributedScene::objects':
        'The objects of which this rank has all or a part, ascending.',
    'DistributedScene::part_vertices':
        'The numbers of the vertices of the part of an object that this rank has, ascending; empty for a whole object. Valid until the object is removed.',
    'DistributedScene::positions':
        'The positions that were last set, of the vertices that this rank has.',
    'DistributedScene::rank':
        'See `DistributedScene::rank` in supple/distributed.hpp.',
    'DistributedScene::rank_count':
        'See `DistributedScene::rank_count` in supple/distributed.hpp.',
    'DistributedScene::remove':
        'Removes the object, or the part of it that this rank has.',
    'DistributedScene::save':
        'Collective: writes the objects of all ranks, with their options and positions, and what the events of the next step need, to one file. The file appears when it is whole: an older one stays until then. The options of the scene and the pair filter are not in it. Throws `Error` when the file cannot be written.',
    'DistributedScene::set_motion':
        'As `Scene.set_motion`.',
    'DistributedScene::set_options':
        'As `Scene.set_options`.',
    'DistributedScene::set_pair_filter':
        'As `Scene.set_pair_filter`. All ranks set a function that gives the same answers. In each collective call, a rank asks it once for each pair of objects that it may test.',
    'DistributedScene::set_positions':
        'The positions of the vertices that this rank added, in its order. Copies them, O(n).',
    'DistributedScene::set_vertex_groups':
        'As `Scene.set_vertex_groups` for the vertices that this rank added, in its order. Ranks that share a vertex give it the same numbers.',
    'DistributedScene::stats':
        'What this rank did in the last collective call.',
    'DistributedScene::verify':
        'As `verify`: the last collective call must be `detect`. The ranks share the pairs of objects, and all of them get the report. Each rank reads all objects again from the ranks that added them, so the call also verifies the messages of `detect`. Each rank needs memory for the whole scene.',
    'ElementVertices::begin':
        'See `ElementVertices::begin` in supple/contact.hpp.',
    'ElementVertices::end':
        'See `ElementVertices::end` in supple/contact.hpp.',
    'ElementVertices::size':
        'See `ElementVertices::size` in supple/contact.hpp.',
    'Error':
        'Unusable input: an option out of range, an unknown object, a file that cannot be read.\n\n`what()` is one line of valid UTF-8 without a trailing newline. It says what is wrong, where, and how to fix it: `rabbit.obj:17: face index 99 is out of range; the file has 12 vertices so far`. A broken invariant inside the library is never an `Error`; it asserts in debug builds.',
    'Field::has_truth_words':
        'See `Field::has_truth_words` in supple/description.hpp.',
    'FieldInfo::bytes':
        'See `FieldInfo::bytes` in supple/record_info.hpp.',
    'MassSpringBody::add_drift':
        'Adds a velocity to each mass that is not fixed, as the paper does (v_i = v_i + v_d), and to the air around it, so that friction does not stop the drift.',
    'MassSpringBody::angular_momentum':
        'Σ m x × v, about the origin',
    'MassSpringBody::area':
        'area of all triangles, m²',
    'MassSpringBody::area_error':
        'The volume that closed parts enclose, m³, negative for parts wound inward; 0 when none is closed. Parts with a vertex that is not finite at rest do not count.',
    'MassSpringBody::bounds':
        'The lowest and the highest coordinates of all vertices, which `step` has found in its loop; nothing when a vertex is not finite or there is none. O(n / 2048) after a step, otherwise O(n).',
    'MassSpringBody::center_of_mass':
        'Σ m x × v, about the origin',
    'MassSpringBody::edge_strain':
        'The volume that closed parts enclose, m³, negative for parts wound inward; 0 when none is closed. Parts with a vertex that is not finite at rest do not count.',
    'MassSpringBody::energy':
        'See `MassSpringBody::energy` in supple/motion.hpp.',
    'MassSpringBody::mean_velocity':
        'Σ m x × v, about the origin',
    'MassSpringBody::momentum':
        'Σ m v, kg m/s',
    'MassSpringBody::options':
        'See `MassSpringBody::options` in supple/motion.hpp.',
    'MassSpringBody::positions':
        'See `MassSpringBody::positions` in supple/motion.hpp.',
    'MassSpringBody::reflect':
        'Reverses the mean velocity of the body, and the velocity of the air, along an axis (0, 1, 2). The same change applies to each mass that is not fixed, so the body keeps its oscillation.',
    'MassSpringBody::set_external_forces':
        'Forces on each vertex in addition to gravity, in newtons. They stay until they are set again and do not act on fixed vertices. An empty span removes them. Throws `Error` when the size differs from the mesh.',
    'MassSpringBody::set_positions':
        'Both replace all values. They throw `Error` when the size differs from the mesh.',
    'MassSpringBody::set_velocities':
        'Both replace all values. They throw `Error` when the size differs from the mesh.',
    'MassSpringBody::springs':
        'sorted by a, then by b',
    'MassSpringBody::stable_step':
        "The longest step, with `substeps`, at which the explicit integrators are stable, by Gershgorin's bound on the frequencies and the damping of the rest state; infinite for `backward_euler`. The built-in models are stable up to 1.4 times this value.",
    'MassSpringBody::step':
        'Advances positions and velocities by `seconds` > 0, in `substeps` parts. When a number is no longer finite, or a vertex moves further in one substep than a hundred times the size of the body, the call restores the state from before and throws `Error`, which names the vertex and a stable step. O(n), without allocation in steady state, except for `backward_euler`, which solves a sparse linear system up to six times (stiff bodies by factorization). Invalidates spans that were returned before.',
    'MassSpringBody::try_step':
        'As `step`, but returns the message of the error instead of throwing it, or nothing when the step succeeded. For builds without exceptions.',
    'MassSpringBody::undo_step':
        'Restores the state from before the last `step`, also when positions or velocities were set since. External forces, drift and the velocity of the air stay. Throws `Error` when there is no such step, or it was undone or failed. O(1), or O(n) when the body flows.',
    'MassSpringBody::velocities':
        'm/s',
    'MassSpringBody::vertex_count':
        'See `MassSpringBody::vertex_count` in supple/motion.hpp.',
    'MassSpringBody::volume':
        'The volume that closed parts enclose, m³, negative for parts wound inward; 0 when none is closed. Parts with a vertex that is not finite at rest do not count.',
    'MassSpringEnergy::total':
        'See `MassSpringEnergy::total` in supple/motion.hpp.',
    'MeshTopology::closed':
        'True when there are edges and each is in an even number of triangles, so that every point has a side.',
    'MotionError':
        'A step of a body failed: a number was no longer finite, or a vertex moved too far. The message names the object, the step and a stable time step.',
    'NodePairList::is_leaf_pair':
        'See `NodePairList::is_leaf_pair` in supple/inspection.hpp.',
    'NodePairList::level_count':
        'See `NodePairList::level_count` in supple/inspection.hpp.',
    'NodePairList::pairs_of':
        'See `NodePairList::pairs_of` in supple/inspection.hpp.',
    'PositionsView::coordinate_stride':
        'See `PositionsView::coordinate_stride` in supple/views.hpp.',
    'PositionsView::data':
        'See `PositionsView::data` in supple/views.hpp.',
    'PositionsView::get':
        "Point i in the precision of the user's numbers; `Scalar` must be the scalar of the view.",
    'PositionsView::is_double':
        'See `PositionsView::is_double` in supple/views.hpp.',
    'PositionsView::point_stride':
        'See `PositionsView::point_stride` in supple/views.hpp.',
    'PositionsView::size':
        'See `PositionsView::size` in supple/views.hpp.',
    'RecordDescription::visit':
        'Calls `visitor(field)` for each member.',
    'Recorder::add':
        'Adds a frame: the positions of each object, in the order of the header. Throws `Error` when a size differs, or when the disk is full; flushed frames stay readable. When memory runs out in a function of the recorder, the recording ends after the flushed frames, too. Objects that are elsewhere have no positions; only rank 0 reads the time and the result.',
    'Recorder::close':
        'Flushes and closes both files. Throws `Error` when the disk is full.',
    'Recorder::flush':
        'Writes all frames to the file. Throws `Error` when the disk is full.',
    'Recorder::needs_flush':
        'Whether frames of several ranks have waited long enough for a call of `flush`. One process need not ask.',
    'Recording::frame':
        'Throws `Error` when there is no such frame, or its data refer to objects, triangles, vertices or rows that do not exist. Sequential reading is fastest.',
    'Recording::frame_count':
        'See `Recording::frame_count` in supple/recording.hpp.',
    'Recording::header':
        'See `Recording::header` in supple/recording.hpp.',
    'Recording::positions':
        'The positions of one object, by its index in the header.',
    'Recording::summary':
        'As `frame`, but only time, events and statistics, in a fraction of the time.',
    'RigidTransform::from_quaternion':
        'The rotation by the quaternion x i + y j + z k + w, then the translation. The quaternion need not have unit length: it is divided by its length, and each number of the matrix is within 2^-49 of the exact one. It has the same bits on every machine. Throws `Error` when the quaternion is zero or not finite.',
    'Scene::add':
        'Adds an object and builds its octree from these positions (the rest pose) in O(n log n), on all threads of the scene. An object without triangles touches nothing. Throws `Error` for a vertex id that is negative or too large; the message names the triangle and the id.',
    'Scene::any_contact':
        'Whether any triangle of one object intersects one of the other. Stops at the first. Throws `Error` when both are the same.',
    'Scene::cast':
        'For each ray the first triangle on it, or nothing when there is none, when a number of the ray is not finite, and when its direction is zero. Watertight: a ray through an edge hits a triangle of the edge.',
    'Scene::cast_all':
        'All triangles on each ray, ordered by ray, then by t as exact arithmetic compares it, object and triangle.',
    'Scene::closest':
        'For each point the nearest triangle, or nothing when there is none within the largest distance and when the point is not finite. Takes about 1.4 µs for each of many points near a surface of 70,000 triangles, and 3.5 µs for those far away; longer for single points. Throws `Error` when the largest distance is negative or NaN, and for a signed distance when a surface is open.',
    'Scene::collision_free_step':
        'A part of the step, 0 to 1, after which nothing has crossed and every pair of elements keeps a share of its distance at the start, `StepOptions.keep`; and the pair that ends it.\n\nA pair at distance d at the start keeps at least `keep` d. With separation s, a pair at distance d > s keeps at least s + `keep` (d - s). So a pair within the separation does not make the step 0, and one that parts does not end it. The exact step ends when the first pair is at the distance that it keeps. The returned step never exceeds the exact one, and is shorter by at most 2^-18 of it.\n\nElements that share a point at the start end the step there when the triangles around this point cut into each other just after the start, and when one leaves a face through the inner side on which it lies flat. Otherwise they end the step where they touch again, and not at all while they slide in one plane or move by the same vector. docs/guarantees.md has the exact conditions.\n\nOtherwise the step is positive. It is proven that also the positions from + t (to - from), computed in double, are reached without contact, for coordinates below 2^1022. Where rounding could make elements touch, the part is shortened by 2^-19 of it, then halved until it does not; the limiting pair is then the first that would touch.\n\nIgnores `ImpactOptions.max_time` and `skip_parting`. A step that is many times longer than the objects takes about the time of a short one, which is a few times that of `detect` for a short step. Throws `Error` when an option or a limit is out of its range.',
    'Scene::collision_free_steps':
        'A safe part of the step for each object, ascending, so that one pair does not stop all objects. Objects of one island move by the same part. After each island has moved by its part, or by less, nothing has crossed and every pair keeps its share as for `collision_free_step`; the islands can move in any order, or at the same time at different speeds.\n\nTwo objects that move are in one island unless every two of their elements are so far apart that what both move towards each other cannot use up their room. Objects that do not move have the step 1 and connect nothing. Takes longer than `collision_free_step`. A call that `limits` end returns one island of all objects that move. Throws `Error` as that function does.',
    'Scene::compact':
        'Renumbers the triangles that are left after edits from 0, in their order, and frees memory. Returns the new number of each id, or 2^32 - 1 for a removed one; the last result keeps the old ones. O(n log n).',
    'Scene::contains':
        'ascending',
    'Scene::detect':
        'Finds every contact of the requested kinds: intersections, penetration and pairs within the margins at the current positions, and continuous contacts within the step. The request defaults to the options of the scene. Time depends on the objects that moved and on the overlapping volumes. No memory is allocated after the largest step so far, except to sort more than 2^20 pairs of objects. An empty list of contacts means that nothing touches, unless `DetectResult.untested` says that there was nothing to test. Throws `Error` when the request is out of range.',
    'Scene::distance':
        'The nearest features of two objects, as a pair of the listing of features, or nothing when one of them has no finite triangle, edge or point. Of several pairs at the same distance, the first one in the order of `DetectResult.proximity_pairs`. When the surfaces intersect, the distance is 0, and the pair is the first point of their first contact: then an edge can be paired with a face. `object_a` is the smaller object. An object inside another one has the distance of the surfaces. Triangles with a vertex that is not finite do not count. A distance that no double holds is infinite. Starts at the result of the last call for these objects, so that objects that move little take less time. Objects that are far from each other need few decisions, unless their coordinates are so coarse that many elements are equally near. Throws `Error` when both are the same.',
    'Scene::distances':
        'The same for all pairs of objects that `detect` would test and that are within `max_distance`, closed: one pair of features for each, ordered by objects. Throws `Error` when the distance is negative or NaN.',
    'Scene::earliest_impact':
        'The first continuous contact with `SceneOptions.impact`, or nothing when nothing touches within the step. Of contacts with the same time, it is the first in canonical order. The search skips pairs that can only touch later, so with many contacts it is faster than `detect`. Does not change `result` and `verify`. A call that `limits` end returns nothing: ask `StepLimits.stop`, or call `max_step`. Throws `Error` when a limit is out of its range.',
    'Scene::edit':
        'Changes the mesh of an object: removes and adds triangles, and adds vertices. Its id, options, events, manifolds, groups and user data stay; new vertices are in all groups. O(m log m) for m triangles and vertices of all edits since the last search, so search between many edits. The next search builds the parts of the octree around them again, O(k log n) and a copy of its arrays; with edges and points of no triangle, and with methods of comparison, it builds the whole octree.\n\nAll answers are those of a scene to which the edited mesh was added, with the same ids. A pair of objects that touches before and after an edit stays. On a path, a new triangle moves as its vertices do, as if it had been there at the start. A solid is judged at once: while its surface is open, its option `solid` is false, so that nothing penetrates it, and `inside` throws as for each open surface. New vertices are not welded; triangles may name welded ones.\n\nThrows `Error`, and changes nothing, when there is no such triangle, vertex, edge or point, when one is removed twice, when a position is not finite or of the other precision, when the number of starts is not that of the new vertices on a path and 0 at rest, and when the object is static or shares its positions.',
    'Scene::for_each_vertex':
        'Calls `function(object, vertex, weight)` for each vertex of a pair: first those of a, then those of b. The weights are the barycentric coordinates of the closest or touching points, positive for a and negative for b. So their sum is 0, but for rounding, and the sum of weight times position is the vector from the point of b to the point of a. Of a `Contact`, the points are the mean of its points in both triangles, or the centres of the triangles when `SceneOptions.contact_points` is off or a triangle is flat. O(1). Throws `Error` as `vertices_of` does; of a `Contact` also when it is not of `result`.',
    'Scene::inside':
        'For each point whether it is inside an object of the filter: outside of all, else on a triangle of one, or inside at least one. Exact. A point inside a part of a surface that crosses itself is inside where a ray from it crosses the surface an odd number of times. Points that are not finite are outside, and so are all points of an object with a vertex that is not finite, except on its triangles. Takes about 0.3 µs for a point in the box of 70,000 triangles; many points in one call share a grid of at most four million cells, and a million of them take 60 ms.\n\nThe surfaces must be closed: throws `Error` when an object of the filter has an edge with an odd number of triangles, and names it. The first call checks that in O(n log n).',
    'Scene::keep_result':
        'Takes the memory of this result out of the scene: its spans stay valid as long as what is returned. `result` is then empty, as before the first step, and the next `detect` takes new memory; events go on. Call it before the next `detect` to keep a result without a copy of its own. O(size of the lists), because the scene keeps copies, from which `detect` takes the contacts of objects that do not move.',
    'Scene::max_step':
        'The largest safe part of the step, 0 to 1, and the pair that ends it: the time of the first impact, or 1 without one. Never later than the true first contact. Elements that touch at the start end it there only where their surfaces meet in the step, as for `collision_free_step`. Elements within the separation at the start do not end it when they part, as with `ImpactOptions.skip_parting`. Bodies that already cut through each other at the start do not shorten it. Throws `Error` as `earliest_impact` does.',
    'Scene::mesh_version':
        '0, and one more after each `edit` and `compact`.',
    'Scene::objects':
        'ascending',
    'Scene::options':
        'The options of an object, with its name in messages and results and all changes since it was added.',
    'Scene::overlaps':
        'All triangles that overlap each box or sphere, ordered by query, object and triangle. A box or sphere with a number that is not finite, a box with min > max, and a sphere with a negative radius overlap nothing.',
    'Scene::position':
        'The position that the exact tests use: with transforms and translations. Throws `Error` when there is no such vertex.',
    'Scene::remove':
        'Removes an object. Its pairs end at the next `detect`.',
    'Scene::result':
        'The result of the last `detect`.',
    'Scene::search':
        'As `detect`, but apart from the steps of the scene: `result`, `verify` and the events do not change, and the result has no events and no manifolds. For a search within a step, for example of a solver that tries out paths. Tests only the pairs of objects that `only` accepts, all when it is empty; for an object with self-collision, it gets the same object twice. The result is valid until the next `search`. The first call takes memory for the answers; the objects and their octrees are those of the scene. Throws `Error` as `detect` does, and when manifolds are requested.',
    'Scene::set_motion':
        'Sets a path for continuous contacts: every vertex moves straight from its position in `from` (t = 0) to its position in `to` (t = 1). Copies both, O(n). The path stays until another call moves the object; all other calls place it at rest. Everything except continuous contacts uses the end of the path. Throws `Error` as `set_positions` does, and when one view is `float` and the other `double`.',
    'Scene::set_observer':
        'Sets a function that `detect` calls at its end, in the same thread, unless the call was stopped; an empty function removes it. It reads the scene and its `result`, and must not change the scene. What it throws leaves `detect`, and the result stays. Without an observer, this costs nothing.',
    'Scene::set_options':
        'Changes the options that have a value, O(1): `{.is_static = false}` lets a static object move. Values that the options already have change nothing. Throws `Error` when a value is out of range.',
    'Scene::set_pair_filter':
        'Sets a function that excludes pairs of objects; an empty function removes it. See `PairFilter`. When it excludes all pairs whose volumes overlap, `detect` also asks for others, until it accepts one.',
    'Scene::set_positions':
        "Sets the positions of all vertices, in the user's numbering. Copies them, O(n). Replaces earlier transforms, translations and paths. Throws `Error` when the number of positions differs from the mesh. The bounds are the lowest and the highest coordinates of the positions. With them and `ComparisonOptions.lazy_refit`, `detect` does not read the vertices of an object that meets no other one. All positions must be finite and within the bounds: nothing checks that, and otherwise `detect` misses contacts. Throws `Error` when a bound is not finite.",
    'Scene::set_transform':
        'Places the positions that were last set, or those of `add`. Replaces earlier transforms and translations. O(1) when only the translation changes, O(n) otherwise. A negative determinant mirrors the object: curves and manifolds see its triangles turned over, so that they keep their outer side. Throws `Error` for a solid when the matrix is singular. The signs of determinants are exact.',
    'Scene::set_vertex_groups':
        'Gives each vertex a group and a mask, as bits. Two vertices may touch when the group of each has a bit in common with the mask of the other; for objects without groups, all bits are set. `detect`, `verify` and safe steps leave out two triangles or elements when no vertex of one may touch a vertex of the other. Queries do not read the groups. O(n). Empty lists remove them. Throws `Error` when the lists have not one number for each vertex.',
    'Scene::set_vertices':
        "Sets the positions of some vertices, O(k) for k of them, where only a part of the object moves: all others stay. `detect` then refits only the nodes of the octree around these vertices, to the same volumes. The positions are those that were last set, before the object's transform and translation, which stay; a path ends. When more than an eighth of the vertices move, and for continuous contacts and proximity, `detect` refits the whole object.\n\nShared positions are copied first, O(n). Throws `Error` when there is no such vertex, when the numbers of vertices and positions differ, and when one is `float` and the object's positions are `double`, or the other way round.",
    'Scene::share_positions':
        "As `set_positions`, but the scene reads the user's memory instead of a copy, O(1). The memory must stay valid until the object gets other positions or is removed. To change the values, write them between two calls on the scene and then call this function again.\n\nThe scene copies the positions when it cannot read them in place: when x, y and z of a point are not adjacent (a column-major n x 3 matrix), and when the point stride or the address is not a multiple of the scalar's size. Searches for continuous contacts, proximity and safe steps also copy them.",
    'Scene::translate':
        'Moves the object by `offset` in O(1), without reading its vertices. Each coordinate becomes fl(position + D) in double. D is the translation of the last `set_transform` plus all offsets since it, or since the positions were last set.',
    'Scene::triangle':
        'The vertices of a triangle, those that count in place of welded ones; nothing for one that an edit removed. Throws `Error` when the object never had such a triangle.',
    'Scene::triangle_count':
        'of its mesh, with those that edits removed',
    'Scene::vertex_count':
        'of its mesh',
    'Scene::vertices_of':
        'The vertex ids of one side of a record with a triangle or an element on each side, O(1), in the order of the barycentric coordinates: an edge as in `element_a` or `element_b`, a triangle in the order of its corners. Throws `Error` when the triangle or its object was removed.',
    'SceneInspector::bounds':
        'The box of the object in the last `detect`; empty when no vertex is finite.',
    'SceneInspector::candidates':
        'The pairs of triangles that the narrow phase passes to the exact stage: the first `limit` pairs and their total number. They include pairs that `detect` skips: of two objects that both have not moved, and in parts of an object that self-collision culling skips. With continuous contacts, they are triangles whose moving boxes come within `ImpactOptions.min_separation` or slightly more. Pairs that share a vertex are left out, although their elements are tested. As fast as `detect` with one thread; O(limit) memory.',
    'SceneInspector::cells':
        "The cells of an object's octree at `level` and the leaves above it, which together cover the object. Without a level: all leaves. Ordered by level. Cells enclose the triangles at their present positions, rounded outward; for an object on a path, at the end of the step. Cells without a finite triangle are empty.",
    'SceneInspector::explain':
        'Why two triangles are a contact of the last `detect`, or which stage separated them. Calls the pair filter. Continuous contacts and near pairs that a truncated result leaves out do not count. O(octree depth), and for these O(contacts of the objects). Throws `Error` when a triangle is out of range.',
    'SceneInspector::leaf':
        'The leaf that contains a triangle. O(octree depth). Throws `Error` when the triangle is out of range.',
    'SceneInspector::node_pairs':
        "The pairs of nodes that the narrow phase finds colliding, of two objects, or of one object with itself. Empty when the last `detect` did not compare the octrees: the broad phase or a filter excludes the pair, or the object's self-collision is off. Includes pairs that `detect` skips, as `candidates` does. O(pairs log pairs) time and memory.",
    'SceneInspector::octree_depth':
        'The deepest level with cells; 0 for an object without triangles, which has no cell.',
    'SceneInspector::octree_statistics':
        "Statistics of an object's octree, O(nodes).",
    'SceneInspector::regions':
        'Regions of the scene octree in the last step, root first; empty when another method ran.',
    'SceneInspector::validate':
        'Checks every invariant of every octree and of the broad phase. Returns an empty string, or a description of the first error.',
    'Simulation::add':
        "Adds an object that only `set_positions` moves, a body of masses and springs, a rigid object that moves, or an object with the user's motion. Throws `Error` as `Scene.add` and `MassSpringBody` do.",
    'Simulation::body':
        'The masses and springs of an object; null when it has none. The pointer is valid until the object is removed. The scene sees positions that are set here after the next step. While random forces act, the simulation sets the external forces.',
    'Simulation::detect':
        'Finds the contacts at the present positions. Nothing moves: continuous contacts are those at time 0. The request gives the limits of the detection, here and below; its kinds must be those of the scene. A detection that is stopped has no contacts, but the step was taken.',
    'Simulation::keep_result':
        '`Scene.keep_result` of this scene.',
    'Simulation::motion_seconds':
        'wall-clock time of the last step without detection',
    'Simulation::options':
        'wall-clock time of the last step without detection',
    'Simulation::positions':
        'The positions of all vertices. They are valid until the next step. Of a rigid object, the first call after a step computes them, O(n), so calls for one object must not overlap.',
    'Simulation::remove':
        "Adds an object that only `set_positions` moves, a body of masses and springs, a rigid object that moves, or an object with the user's motion. Throws `Error` as `Scene.add` and `MassSpringBody` do.",
    'Simulation::scene':
        'The scene of the simulation. Only the simulation moves its objects.',
    'Simulation::set_detection':
        'Replaces the scene by one with other options, and detects at the present positions. `objects` has all objects, in the order in which they were added. Their motion keeps its state: only the detection changes. Events begin again. Cost: that of `Scene.add` for each object. Throws `Error` as `Scene` does, and when an object was removed before; then nothing changes.',
    'Simulation::set_observer':
        '`Scene.set_observer` of this scene: it sees each detection of the simulation.',
    'Simulation::set_positions':
        "Sets the positions of an object without motion, of a body, which keeps its velocities, or of a rigid object, which keeps its velocity and spin and turns about its new centre from now on. They apply at once: the paths of the next step start there. Throws `Error` as `Scene.set_positions` does, and when the user's motion moves the object.",
    'Simulation::step':
        "Advances all objects by one time step, then detects. Continuous contacts are those on the straight paths of the step. Throws `MotionError` when a body fails, and rethrows what the user's motion throws; the state is then as before the call. Objects without motion cost nothing.",
    'Simulation::step_count':
        'steps taken',
    'Simulation::time':
        'step_count() · time_step, s',
    'Simulation::try_step':
        'As `step`, but returns the error instead of throwing it when a body fails. Returns nothing when the step succeeded; `scene().result()` then has the result. For builds without exceptions.',
    'TriangleIntersection::extreme_points':
        'See `TriangleIntersection::extreme_points` in supple/triangle_intersection.hpp.',
    'TrianglesView::size':
        'See `TrianglesView::size` in supple/views.hpp.',
    'ValueRange::above':
        'The finite values from `lowest` on, from `lowest` to `highest`, or above `lowest`.',
    'ValueRange::allows':
        'See `ValueRange::allows` in supple/description.hpp.',
    'ValueRange::from':
        'The finite values from `lowest` on, from `lowest` to `highest`, or above `lowest`.',
    'ValueRange::only_powers_of_two':
        'The finite values from `lowest` on, from `lowest` to `highest`, or above `lowest`.',
    'ValueRange::or_infinity':
        'The finite values from `lowest` on, from `lowest` to `highest`, or above `lowest`.',
    'ValueRange::or_zero':
        'The finite values from `lowest` on, from `lowest` to `highest`, or above `lowest`.',
    'VerifyReport::agrees':
        'See `VerifyReport::agrees` in supple/verify.hpp.',
    'VerifyReport::difference_count':
        'See `VerifyReport::difference_count` in supple/verify.hpp.',
    'add_key':
        'The members of the key of a row, as numbers in their order: lists are sorted by it.',
    'advice_for_open_surface':
        'How to close a surface that is open, as a clause for messages: close the holes, or weld the seams.',
    'apply_wave_motion':
        'Writes the positions at time `seconds` of vertices with the positions `rest`; both spans have the same length. Without a border the drift never ends. Along an axis where the border is smaller than the object, the object does not drift. O(n). A vertex whose rest position is not finite stays so and does not affect others.',
    'area':
        'The area, rounded; not finite when a corner is not finite.',
    'available_threads':
        'The number of threads that work when an option asks for `threads` of them (0: one for each core), at least 1; the calling thread is one of them. There are fewer when the operating system refuses to create threads, for example because of a limit of processes or of memory. All results are the same.\n\nEvery `Scene`, `BroadPhase` and body calls this, so a program needs it only to tell its user. A call that asks for more threads than all calls before creates them; they stay until the process ends. It takes about 0.3 ms for each. Any thread may call it.',
    'check':
        'Throws `Error` when a member is out of its range; the message names the first such member. `where` is the source of the options for the message; it may be empty.',
    'check_mesh':
        'Throws `Error` when a triangle, an edge or a point uses a vertex that does not exist, and when both ends of an edge are the same vertex; the message names the mesh, the place in its list, and the value.',
    'compute_topology':
        'Counts in O(n log n) time for n triangles. Throws `Error` as `check_mesh` does.',
    'contains':
        'Whether all of `kinds` are in the set.',
    'cos_turns':
        'See `cos_turns` in supple/trigonometry.hpp.',
    'count_inward_triangles':
        'The number of triangles that face inwards, into what `Scene.inside` finds inside. A solid (`ObjectOptions.solid`) takes them as if they faced outwards: each connected part by the exact sign of its volume, and holes the other way. 0 where the surface bounds no solid (`fault_of_solid`). A part of volume 0 has none. The vertex ids must be valid. O(n log n).',
    'count_leaves':
        'The number of leaves that `for_each_leaf` visits.',
    'count_neighbour_pairs':
        'The pairs of triangles with a common vertex, which `Neighbours.skip` does not test. O(n log n).',
    'cross':
        'See `cross` in supple/types.hpp.',
    'cube_around':
        'The smallest cube around a box, with the same centre. Throws `Error` when the box has no finite size.',
    'describe_surface':
        'The surface in words, for messages and tables: `closed`, `open, 4 boundary edges`.',
    'dot':
        'Sums run from left to right and each operation rounds once: error bounds in the library rely on it.',
    'edge_edge_distance':
        'See `edge_edge_distance` in supple/distance.hpp.',
    'edges_of':
        'The edges of the intersection of slabs, for drawing the `slabs` of a cell. Computed in double and rounded; none when a slab of a box is infinite.',
    'enclosing_box':
        'The box from `lowest` to `highest`, grown by `radius` on all sides and rounded outward: it contains every point whose distance along each axis is at most the radius, exactly. Bounds that are finite floats stay. Others move outward by at most 3 units in the last place or 2^-125, whichever is more; beyond the range of float they become infinite. The box is empty when a coordinate is a NaN, or when `lowest` is above `highest` along an axis. Throws `Error` when the radius is negative or a NaN. O(1), 15 to 40 ns.',
    'fail_range':
        'What `check` throws: `WHERE: STRUCTURE::NAME is VALUE; it must be WHAT`.',
    'fault_of_solid':
        'Why a surface does not bound a solid (`ObjectOptions.solid`): it is not closed, or its triangles are not oriented alike. Names the first of its faulty edges, and how to correct them, as a clause; the empty string when every edge has as many triangles in one direction as in the other. The vertex ids must be valid. O(n log n).',
    'feature_kinds':
        'The kinds of element a and of element b.',
    'find_first_difference':
        'Compares two recordings, without measured times and file-specific text, and without counts of work when their numbers of ranks differ. Returns nothing when they are equal. Positions and other lengths may differ by `tolerance` ≥ 0 in each coordinate; 0 compares bits.',
    'first_contact_by_algebra':
        'Decides the same question by exact algebra, for checking: Sturm sequences of polynomials with integer coefficients of any size. It shares no code with `first_impact` or `Scene.detect`, at any separation. Throws `Error` when `min_separation` is negative or not finite.\n\nTakes about 0.5 µs for most elements that stay apart, 0.1 to 1 ms for others, and seconds or more when coordinates range from 1e-300 to 1e300. It always ends.',
    'first_impact':
        'The first impact within the step, or nothing when the elements stay apart, as exact arithmetic decides on the given coordinates. All finite coordinates and all motions are allowed: also motions within one plane, parallel edges, degenerate faces, and no motion. Elements with a coordinate that is not finite touch nothing.\n\nThrows `Error` when an option is out of its range. Takes about 0.1 µs for elements that stay apart and 0.3 µs for others. When only exact arithmetic can decide, it takes a few microseconds, or a few hundred with a separation, and allocates memory. Coordinates that differ by more than 2^100 in size can then take milliseconds; docs/guarantees.md has a table.',
    'for_each_events':
        'Calls `visitor(begin, end, stay, member)` for the events of each set of pairs: with the lists of the pairs that begin and end, the name of the list of those that stay, and `member(result)`, the `PairEvents`.',
    'for_each_field':
        'Calls `visitor(field)` for each member, in the order of the structure.',
    'for_each_leaf':
        'Calls `visitor(field, values...)` for each leaf, in order. A leaf is a member whose type has no description; members whose type has one are visited recursively. All structures have the same type, constant or not.',
    'for_each_list':
        'Calls `visitor(list, member)` for each list with records of its own; `member(result)` is the list of a `DetectResult` or of a structure with members of the same names. Lists of groups follow from the records.',
    'info_of':
        'The entry of one kind in `contact_kinds`.',
    'intersect_triangles':
        "Makes the same decision and finds the extreme points of what the triangles share. Each point has the feature of a and the feature of b whose relative interiors meet there. The list is complete and has no duplicates.\n\nWhen corners of a triangle coincide, the smaller index names the point. When corners are collinear, the edge between the two outer corners names the segment.\n\nA point has one extreme point, a segment two, a polygon (of coplanar triangles) three to six. The points of a segment are in ascending order of (on_a, on_b). A polygon is in convex order; it starts at the smallest (on_a, on_b) and continues with the smaller of its two neighbours.\n\nCost: about 100 ns more than the decision for each point that is not a vertex.\n\nPositions: a vertex has its own bits (those of a where two vertices meet). Any other point lies on an edge. Its error along each axis is at most 2^-44 of the edge's extent plus half a unit in the last place, and it is never outside the box of either triangle. It depends on that edge and the opposite edge or face alone, not on the direction of the edge or the order of the triangles, so triangles that share an edge report the same bits there. Another order of the face's corners can change the last bits.\n\nNormal: the direction of the shortest translation of triangle a that separates the triangles: afterwards a plane perpendicular to the normal has each triangle on one of its closed sides, a on the side to which the normal points.\n- Triangles that cross in a segment: the direction of least penetration among the normals of both and the cross products of an edge of each, with either sign.\n- Triangles that touch, in a point or a segment: no translation is needed; the normal is the one of those directions whose plane separates the triangles. For a vertex on a face that is the normal of the face.\n- Coplanar triangles: the common normal with the sign of the normal of b (counter-clockwise corners).\n- A triangle without area, or with an angle below 2^-20: it acts as the segment or the point that it spans. When both lie on one line, the normal is perpendicular to the line. When both are one point, the normal is the x axis.\nThe normal is rounded: computed in double, in a fixed order of operations, with the same bits on every machine. Two edges at an angle below 2^-20 count as parallel, and triangles within 2^-32 of their size from a common plane count as coplanar.",
    'is_open_at_seams':
        'Whether most of the edges that leave the surface open are seams: welded, fewer than half of them stay. Exports of renderers split vertices for texture coordinates and normals. O(n log n).',
    'is_valid':
        'Whether the numbers are in their ranges.',
    'kind_of_element':
        "The kind of the element of side 'a' or 'b', which says what its numbers and weights mean. Records without kinds have faces.",
    'least_margin':
        'The least margin with which proximity finds the pairs of two objects before they come nearer than the thickness, m. `Simulation` raises the margins of its objects to it.',
    'list_infos':
        'The lists of a result, in the order of `for_each_list`.',
    'list_of_set_words':
        '`none, or one or more of a, b, with commas`',
    'list_of_words':
        'All words of an enumeration in one text, such as `aabb, sphere`.',
    'load_mesh':
        'Reads an OBJ, OFF, PLY (ASCII, little or big endian, float or double) or STL (ASCII or binary) file. The extension, in either case, selects the format.\n\nCoordinates keep the precision of the file, and ids keep its order: vertex i is the i-th vertex of the file. Texture and normal ids are ignored. Unused vertices stay. The lines of an OBJ file become edges, n - 1 for a polyline of n vertices, and its points become points; so do the edges of a PLY file. A face of two corners is an edge, and a face of one corner is a point, but not in STL. Faces of OFF and PLY without corners are left out. STL has no ids: corners with equal coordinates become one vertex, numbered by first use.\n\nA polygon of n corners becomes n - 2 triangles, in file order, that cover the inside of its outline once. They are the fan around its first corner where this fan stays inside, as in convex polygons. The outline is seen along the axis in which its area is the largest; in this view the cut is exact, also for corners on one line and for corners and edges that coincide. The triangles of an outline that crosses itself overlap, or some of them turn the other way; `TriangleMesh.polygons` counts these polygons, and those that are not flat.\n\nThrows `Error`; the message names the file, the line or byte, the value, and the allowed values.',
    'make_box':
        'Axis-aligned box from -size/2 to size/2. Each face is a grid of `resolution` ≥ 1 squares per side. Faces share the vertices on edges; 12 resolution² triangles.',
    'make_cloth':
        'Flat sheet in the xz plane with normal +y and side lengths `width` and `depth`: columns × rows squares with alternating diagonals; 2·columns·rows triangles.',
    'make_icosphere':
        'Geodesic sphere of radius 1: an icosahedron with each edge divided into `frequency` ≥ 1 parts; 20 frequency² triangles.',
    'make_model':
        'Makes a built-in model: y up, centered on the origin, longest side 1, with the same bits on every machine. Throws `Error` when there is no such model; the message lists the names.',
    'make_torus':
        'Torus around the y axis: `rings` ≥ 3 around the axis, `sides` ≥ 3 around the tube; 2·rings·sides triangles.',
    'model_names':
        'Names of the built-in models, which replace the models of the paper, with their numbers of vertices and faces: pawn (154, 304), fish (216, 338), rabbit (453, 902), human (1250, 2500), bike (9543, 18238).',
    'norm':
        'See `norm` in supple/types.hpp.',
    'number_of':
        'A scalar of a member as a whole number.',
    'octree_of_2007':
        "The paper's octree of an object: regular, down to single triangles.",
    'one_line':
        'Text for messages and tables: valid UTF-8 in one line. Line breaks and other control characters become `replacement`. Blanks at the end are left out.',
    'operator|':
        'See `operator|` in supple/options.hpp.',
    'operator|=':
        'See `operator|=` in supple/options.hpp.',
    'place_of_answer':
        'The place of the list that answers a kind of contacts.',
    'place_of_list':
        'The place of a list in `list_infos`. Throws `Error` when there is no list with this name.',
    'point_edge_distance':
        'See `point_edge_distance` in supple/distance.hpp.',
    'point_point_distance':
        'The distance and the closest points of two elements; nothing when they are farther apart or not finite.',
    'point_triangle_distance':
        'See `point_triangle_distance` in supple/distance.hpp.',
    'real_number':
        'A double of a member.',
    'record_info':
        'The members of records inside a record are its members; those of an array of records have a place.',
    'respond':
        'Changes the velocities of bodies so that they do not pass through anything in a step of `dt` seconds, with friction and restitution. Call it when the velocities of the step are known, and move the vertices after it:\n\n```cpp\nfor (std::size_t v = 0; v < x.size(); ++v) velocities[v] += dt / masses[v] * forces[v];\nconst double part = supple::respond(scene, cloth, velocities, masses, dt, {.thickness = 0.01});\nfor (std::size_t v = 0; v < x.size(); ++v) x[v] += part * dt * velocities[v];\nscene.set_positions(cloth, x);\n```\n\nThe scene holds the positions at the start of the step. `respond` searches proximity once, with the margins of the objects, then continuous contacts with `SceneOptions.impact`, at most `iterations` times. Give objects that may meet margins whose sum is about 1.5 times the thickness; with smaller margins, or none, they come nearer than the thickness, but still do not pass through each other. Objects that are not among `bodies` are at rest and do not react. Groups, masks, the filter and `self_collision` apply.\n\nIt does not change `Scene.result` and the events. The bodies are on the paths of the whole step (`Scene.set_motion`) until other positions are set.\n\nReturns the part of the step, 0 to 1, in which nothing touches: 1 when the impulses removed all impacts, otherwise `Scene.max_step`. Bodies that move no further than this do not pass through anything. It is 0 where surfaces that touch at the start would cross; surfaces that part or slide do not shorten it.\n\nCosts one search of proximity and usually one or two of continuous contacts, and memory in proportion to the bodies and their contacts. Throws `Error` when an option, `dt` > 0 or a mass is out of its range, when the number of velocities or masses differs from that of the vertices, when an object is listed twice, and as `Scene.set_motion` does, which needs objects that are not static.',
    'role::first_row':
        'See `role::first_row` in supple/description.hpp.',
    'role::id':
        'See `role::id` in supple/description.hpp.',
    'role::key':
        'See `role::key` in supple/description.hpp.',
    'role::object':
        'The roles of members. An id is of the object of `side`.',
    'role::rows':
        'See `role::rows` in supple/description.hpp.',
    'role::weights':
        'See `role::weights` in supple/description.hpp.',
    'rows_of':
        'The rows of all lists, in the order of `list_infos`; they belong to the owner of the lists. These are a `DetectResult`, or a structure with members of the same names. `all` gives memory that is used again.',
    'save_mesh':
        'Writes a file in the format of its extension: .obj, .off, .ply (binary little endian, double), .stl (binary, single precision). Text formats print the shortest digits that read back to the same double. Throws `Error` when the extension is unknown, when the file cannot be written, and when the mesh has edges or points of no triangle and the format is not OBJ.',
    'set_failure_handler':
        'See `set_failure_handler` in supple/error.hpp.',
    'set_rows':
        'The inverse: the lists of a result have these rows, which stay where they are.',
    'sin_turns':
        'Sine and cosine of an angle in turns (1 is a full circle), with the same bits on every machine and compiler. The standard library does not guarantee this. The error is at most 2 ulp of 1 for |turns| < 2^20; multiples of a quarter turn are exact.',
    'size_of':
        'In bytes.',
    'split_into_parts':
        'Splits a mesh into its connected parts, ordered by their smallest vertices: triangles and edges that share a vertex id are connected, and a point alone is a part. Vertices that nothing uses are in no part. With `weld`, vertices with equal positions are connected too, so that a split seam joins; they stay apart in the part, so give `ObjectOptions.weld` to its object. O(n). Throws `Error` as `check_mesh` does.',
    'squared_norm':
        'See `squared_norm` in supple/types.hpp.',
    'text_of':
        'The range in words: `a whole number from 0 to 32`, `a finite number above 0`, `2, 4 or 8`.',
    'toi_tolerance_at':
        'The most by which a reported time may be earlier than the true time `toi`.',
    'triangles_intersect':
        'Whether two closed triangles have a point in common, as exact arithmetic decides on the given coordinates. All finite coordinates are allowed. A triangle with a coordinate that is not finite touches nothing.\n\nThe result is symmetric, and independent of the order of the corners. Takes 20 to 40 ns for triangles that the plane of one of them separates, about 100 ns for others, and more when only integers can decide: a few microseconds when coordinates differ by more than 2^100 in size. Allocates memory only in that last case.',
    'triangles_intersect_by_axes':
        'Makes the same decision as `triangles_intersect` by separating axes and integers of unlimited size, for checking. It shares no code with that function and uses no floating-point arithmetic. Takes 2 to 12 microseconds for coordinates of ordinary size.',
    'unit_normal':
        'The unit normal by the right-hand rule; zero when the triangle has no area or a corner is not finite. Rounded.',
    'usable_cores':
        'The number of cores that this process may use, at least 1.',
    'use_comparison_methods':
        'Lets this process use the methods that only serve comparisons with the defaults: `SceneOptions.bounding_volume` other than `aabb`, `ObjectOctreeOptions.build` other than `balanced`, `BroadPhaseMethod.sweep`, `brute` and `sweep3`, `Descent.one_side_first`, `colliding_vertices` and `lazy_refit`. Without this call, `Scene`, `Scene.add` and `BroadPhase` throw `Error` for these options. Call it before; repeated calls and calls from several threads are allowed.\n\nIt needs a call because a linker leaves out what nothing names.',
    'use_manifolds':
        'Lets the scenes of this process find curves and make manifolds: `curves` and `manifolds` of `SceneOptions` and of `DetectRequest`. Without this call, `Scene.detect` and `Scene.search` throw `Error` for them. Call it before; repeated calls and calls from several threads are allowed.\n\nIt needs a call because a linker leaves out what nothing names.',
    'valid_utf8':
        'Replaces every byte that is not part of valid UTF-8 by U+FFFD, because names of files, and names in files, may be any bytes.',
    'value_of_set':
        'The set of a text such as `b,a`; nothing when a part of it is not a word, or the word for the empty set is not alone.',
    'value_of_word':
        'The value of a word; nothing when no value has this word.',
    'verify':
        'Recomputes the last `detect`, all kinds of contacts that it found, by exact arithmetic over all pairs of triangles or elements, and lists every difference. It shares no octrees and no filters with `detect`; a tree of exact boxes excludes pairs that are apart. Quadratic at worst: about a second for two meshes of 70,000 triangles, also with penetration. Throws `Error` when an object or option changed since the last `detect`, and when that call was stopped, truncated, or found no kind of contacts. A stop ends it after the pair of objects that it compares.',
    'verify_any_contact':
        'See `verify_any_contact` in supple/verify.hpp.',
    'verify_cast':
        'See `verify_cast` in supple/verify.hpp.',
    'verify_cast_all':
        'See `verify_cast_all` in supple/verify.hpp.',
    'verify_closest':
        'Decides a query of this name again by exact brute force and returns its wrong answers.',
    'verify_distance':
        'For objects that intersect, the distance must be 0, and the elements must share a point and belong to the triangles of the first contact.',
    'verify_distances':
        'See `verify_distances` in supple/verify.hpp.',
    'verify_inside':
        'See `verify_inside` in supple/verify.hpp.',
    'verify_overlaps':
        'See `verify_overlaps` in supple/verify.hpp.',
    'vertices_at_same_position':
        'For each vertex the first one with the same coordinates. Equals `ObjectOptions.same_vertex` of `ObjectOptions.weld`. A vertex with a NaN has no equal. O(n).',
    'viewer::View::close':
        'Ends a pause, tells the page that the program has ended, and frees the port. Later steps are not shown. Any thread can call it.',
    'viewer::View::frame_count':
        'steps that the page was given',
    'viewer::View::is_paused':
        'the program waits, or will in the next step',
    'viewer::View::seconds_in_steps':
        'time that frames have taken, without pauses',
    'viewer::View::set_breaks':
        'Throws `Error` when the last step did not detect the kind of contacts that an event needs.',
    'viewer::View::set_field':
        "Shows the user's own numbers as the field `name`, which the page can choose: one for each vertex of an object, or one for each triangle. Frames from the next `detect` on have them, until they are set again. NaN is no value, and no numbers end the field of the object. Without an element, the count decides, and a count that fits both is that of vertices. All objects of a field have the same element. Copies the numbers, O(n). Any thread can call it while nothing adds or removes objects. Throws `Error` when the count fits neither vertices nor triangles of the object, or not the element, when the name is empty or not UTF-8, and when other objects have this field with another element, or as vectors.",
    'viewer::View::step_count':
        'steps since `attach`',
    'viewer::View::url':
        'The address of the page, with a secret token.',
    'viewer::View::wait':
        'Shows the last step until the page continues the program, the view is closed, or a stop is requested. The scene must exist, and must not have been moved.',
    'viewer::View::watching_url':
        'The address for those who may only watch, with another secret token; empty without `AttachOptions.spectators`.',
    'viewer::attach':
        "Shows a scene in a page while the program runs: from now on, `detect` shows its result. Replaces the observer of the scene. The page can pause the program in `detect`, take single steps, and set breaks. The page reads the user's scene itself, only while `detect` waits. Threads: one for the session, one for the network. Throws `Error` when an option is out of range, when the scene does not detect the kind of contacts that a break needs, when the address is not available, and when the library was built without SUPPLE_BUILD_VIEWER.",
    'welded':
        'The mesh with the first of the vertices at the same position in place of all: what `ObjectOptions.weld` makes of it. Vertices keep their numbers. O(n).',
    'with_included':
        'The set with all that its kinds include.',
    'with_method_of_2007':
        "The options with the method of the paper's program of 2007: the octree of the scene as in Figure 2, with level 1 always there and 64 leaves at most (level-allowed = 2), the region test of the grown box, the descent of Figure 4, the lazy refit, and the colliding vertices of both sides as its output. Other options stay, with boxes instead of volumes that the paper does not have. Objects need `octree_of_2007`. `SimulationOptions.fused_refit` belongs to the method, too, and the root of the scene octree is the cube of the scene.",
    'word_of':
        'The word of a value; null when the value is not in the enumeration.',
}
