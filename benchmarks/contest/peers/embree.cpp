#include <embree3/rtcore.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>

#include "contest/baselines/plain_distance.hpp"
#include "contest/baselines/swept_boxes.hpp"
#include "contest/baselines/triangle_test.hpp"
#include "contest/peers/peers.hpp"

namespace supple::benchmarks {
namespace {

/// A device with one thread, as for all contestants.
class Device {
 public:
  Device() : device_(rtcNewDevice(configuration().c_str())) {
    if (device_ == nullptr) throw std::runtime_error("Embree cannot create a device");
  }
  ~Device() { rtcReleaseDevice(device_); }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;
  operator RTCDevice() const { return device_; }

 private:
  static std::string configuration() {
    const std::string& limit = embree_instruction_set();
    return "threads=1,set_affinity=0" + (limit.empty() ? "" : ",isa=" + limit);
  }

  RTCDevice device_;
};

/// User geometry whose boxes come from a callback, because `rtcCollide` does not accept triangles.
class BoxScene {
 public:
  BoxScene(RTCDevice device, std::size_t count, RTCBoundsFunction bounds, void* user, RTCBuildQuality quality)
      : scene_(rtcNewScene(device)), geometry_(rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER)) {
    // Only dynamic scenes of low quality refit or build by Morton codes. Compact scenes refit faster.
    rtcSetSceneBuildQuality(scene_, RTC_BUILD_QUALITY_LOW);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_DYNAMIC | RTC_SCENE_FLAG_COMPACT);
    rtcSetGeometryUserPrimitiveCount(geometry_, static_cast<unsigned>(count));
    rtcSetGeometryUserData(geometry_, user);
    rtcSetGeometryBoundsFunction(geometry_, bounds, nullptr);
    rtcSetGeometryBuildQuality(geometry_, quality);
    rtcCommitGeometry(geometry_);
    rtcAttachGeometry(scene_, geometry_);
    rtcCommitScene(scene_);
  }
  ~BoxScene() {
    rtcReleaseGeometry(geometry_);
    rtcReleaseScene(scene_);
  }
  BoxScene(const BoxScene&) = delete;
  BoxScene& operator=(const BoxScene&) = delete;

  void update() {
    rtcCommitGeometry(geometry_);
    rtcCommitScene(scene_);
  }
  RTCScene scene() const { return scene_; }

 private:
  RTCScene scene_;
  RTCGeometry geometry_;
};

void set_bounds(RTCBounds& bounds, const Aabb& box) {
  bounds.lower_x = box.min.x;
  bounds.lower_y = box.min.y;
  bounds.lower_z = box.min.z;
  bounds.upper_x = box.max.x;
  bounds.upper_y = box.max.y;
  bounds.upper_z = box.max.z;
}

void bounds_of_listed_box(const RTCBoundsFunctionArguments* arguments) {
  const auto* const boxes = static_cast<const Aabb* const*>(arguments->geometryUserPtr);
  set_bounds(*arguments->bounds_o, (*boxes)[arguments->primID]);
}

class EmbreeBoxes : public BoxContestant {
 public:
  void prepare(const MovingBoxes& field) override {
    boxes_ = field.boxes().data();
    scene_ = std::make_unique<BoxScene>(device_, field.boxes().size(), bounds_of_listed_box, &boxes_,
                                        RTC_BUILD_QUALITY_LOW);
  }
  void frame(const MovingBoxes& field) override {
    boxes_ = field.boxes().data();
    scene_->update();
    pairs_.clear();
    rtcCollide(scene_->scene(), scene_->scene(), keep, this);
  }
  PairDigest pairs() const override {
    PairDigest digest;
    for (const IndexPair& pair : pairs_) digest.add(pair.a, pair.b);
    return digest;
  }

 private:
  /// Receives overlapping leaves, in both orders.
  static void keep(void* user, RTCCollision* collisions, unsigned count) {
    auto& self = *static_cast<EmbreeBoxes*>(user);
    for (unsigned i = 0; i < count; ++i) {
      const unsigned a = collisions[i].primID0, b = collisions[i].primID1;
      if (a < b && boxes_overlap(self.boxes_[a], self.boxes_[b])) self.pairs_.push_back({a, b});
    }
  }

  Device device_;
  const Aabb* boxes_ = nullptr;
  std::unique_ptr<BoxScene> scene_;
  std::vector<IndexPair> pairs_;
};

class EmbreeCopies : public CandidateContestant {
 public:
  void prepare(const DeformingCopies& copies) override {
    meshes_.resize(copies.copies());
    for (std::size_t i = 0; i < copies.copies(); ++i) {
      meshes_[i] = {copies.positions(i).data(), copies.triangles().data()};
      scenes_.push_back(std::make_unique<BoxScene>(device_, copies.triangles().size(), bounds_of_triangle,
                                                   &meshes_[i], RTC_BUILD_QUALITY_REFIT));
    }
  }

 private:
  struct Mesh {
    const Vec3f* positions = nullptr;
    const Triangle* triangles = nullptr;
  };
  struct Pair {
    EmbreeCopies* self;
    IndexPair objects;
  };

  static void bounds_of_triangle(const RTCBoundsFunctionArguments* arguments) {
    const Mesh& mesh = *static_cast<const Mesh*>(arguments->geometryUserPtr);
    const Triangle& t = mesh.triangles[arguments->primID];
    const Vec3f &p = mesh.positions[t[0]], &q = mesh.positions[t[1]], &r = mesh.positions[t[2]];
    set_bounds(*arguments->bounds_o, {{std::min(p.x, std::min(q.x, r.x)), std::min(p.y, std::min(q.y, r.y)),
                                       std::min(p.z, std::min(q.z, r.z))},
                                      {std::max(p.x, std::max(q.x, r.x)), std::max(p.y, std::max(q.y, r.y)),
                                       std::max(p.z, std::max(q.z, r.z))}});
  }
  static void keep(void* user, RTCCollision* collisions, unsigned count) {
    const Pair& pair = *static_cast<const Pair*>(user);
    for (unsigned i = 0; i < count; ++i) {
      pair.self->candidates_.push_back(
          {pair.objects.a, pair.objects.b, collisions[i].primID0, collisions[i].primID1});
    }
  }
  void update(const DeformingCopies& copies) override {
    for (std::size_t i = 0; i < scenes_.size(); ++i) {
      meshes_[i].positions = copies.positions(i).data();
      if (copies.moves(i)) scenes_[i]->update();
    }
  }
  void find_candidates(const DeformingCopies& copies) override {
    for (const IndexPair& objects : overlapping_copies(copies, boxes_)) {
      Pair pair{this, objects};
      rtcCollide(scenes_[objects.a]->scene(), scenes_[objects.b]->scene(), keep, &pair);
    }
  }

  Device device_;
  std::vector<Mesh> meshes_;
  std::vector<std::unique_ptr<BoxScene>> scenes_;
  std::vector<Aabb> boxes_;
};

/// The boxes of the vertices, edges and faces of a cloth.
class EmbreeElements {
 public:
  ClothBoxes boxes;  ///< change them before `prepare` and `find`

  void prepare(const ClothStep& step) {
    triangles_ = step.triangles;
    lists_ = {boxes.vertex_boxes.data(), boxes.edge_boxes.data(), boxes.face_boxes.data()};
    const std::size_t counts[] = {boxes.vertex_boxes.size(), boxes.edge_boxes.size(),
                                  boxes.face_boxes.size()};
    for (std::size_t i = 0; i < 3; ++i) {
      scenes_[i] = std::make_unique<BoxScene>(device_, counts[i], bounds_of_listed_box, &lists_[i],
                                              RTC_BUILD_QUALITY_REFIT);
    }
  }
  /// Calls `visit(ElementPair)` with all pairs of a vertex and a face, and of two edges, whose boxes overlap
  /// and that share no vertex.
  template <class Visit>
  void find(const Visit& visit) {
    Search<Visit> search{*this, visit};
    for (const auto& scene : scenes_) scene->update();
    rtcCollide(scenes_[0]->scene(), scenes_[2]->scene(), Search<Visit>::visit_vertex_face, &search);
    rtcCollide(scenes_[1]->scene(), scenes_[1]->scene(), Search<Visit>::visit_edges, &search);
  }

 private:
  template <class Visit>
  struct Search {
    const EmbreeElements& elements;
    const Visit& visit;

    static void visit_vertex_face(void* user, RTCCollision* collisions, unsigned count) {
      const auto& [elements, visit] = *static_cast<const Search*>(user);
      const ClothBoxes& boxes = elements.boxes;
      for (unsigned i = 0; i < count; ++i) {
        const std::uint32_t place = collisions[i].primID0, face = collisions[i].primID1;
        const std::uint32_t vertex = boxes.used_vertices[place];
        if (boxes_overlap(boxes.vertex_boxes[place], boxes.face_boxes[face]) &&
            !has_corner(elements.triangles_[face], vertex))
          visit(ElementPair{false, vertex, face});
      }
    }
    static void visit_edges(void* user, RTCCollision* collisions, unsigned count) {
      const auto& [elements, visit] = *static_cast<const Search*>(user);
      const ClothBoxes& boxes = elements.boxes;
      for (unsigned i = 0; i < count; ++i) {
        const std::uint32_t a = collisions[i].primID0, b = collisions[i].primID1;
        if (a < b && boxes_overlap(boxes.edge_boxes[a], boxes.edge_boxes[b]) && !boxes.edges_share(a, b))
          visit(ElementPair{true, a, b});
      }
    }
  };

  Device device_;
  std::vector<Triangle> triangles_;
  std::array<const Aabb*, 3> lists_{};
  std::array<std::unique_ptr<BoxScene>, 3> scenes_;
};

class EmbreeCloth : public ClothContestant {
 public:
  void prepare(const ClothStep& step) override {
    elements_.boxes.prepare(step);
    elements_.boxes.update(step);
    elements_.prepare(step);
  }
  void frame(const ClothStep& step) override {
    elements_.boxes.update(step);
    candidates_.clear();
    elements_.find([&](const ElementPair& pair) { candidates_.push_back(pair); });
  }
  std::span<const ElementPair> candidates() const override { return candidates_; }

 private:
  EmbreeElements elements_;
  std::vector<ElementPair> candidates_;
};

class EmbreeNearCloth : public Contestant<ClothStep> {
 public:
  explicit EmbreeNearCloth(double margin) : margin_(margin) {}
  void prepare(const ClothStep& step) override {
    elements_.boxes.prepare(step);
    elements_.boxes.update_grown(step, margin_);
    elements_.prepare(step);
  }
  void frame(const ClothStep& step) override {
    elements_.boxes.update_grown(step, margin_);
    near_.clear();
    const std::vector<Vec3d>& p = step.start;
    elements_.find([&](const ElementPair& pair) {
      double distance = 0;
      if (pair.is_edge_edge) {
        const auto &e = elements_.boxes.edges[pair.a], &f = elements_.boxes.edges[pair.b];
        distance = plain_distance({p[e[0]], p[e[1]]}, {p[f[0]], p[f[1]]});
      } else {
        const Triangle& t = step.triangles[pair.b];
        distance = plain_distance(p[pair.a], {p[t[0]], p[t[1]], p[t[2]]});
      }
      if (distance <= 2 * margin_) near_.push_back({pair, distance});
    });
  }
  PairDigest pairs() const override {
    PairDigest digest;
    for (const NearPair& pair : near_)
      digest.add(pair.elements.a,
                 pair.elements.b + (std::uint64_t{pair.elements.is_edge_edge ? 0u : 1u} << 32));
    return digest;
  }

 private:
  struct NearPair {
    ElementPair elements;
    double distance;
  };

  double margin_;
  EmbreeElements elements_;
  std::vector<NearPair> near_;
};

/// Triangles, for rays and closest points.
class EmbreeQueries : public QueryContestant {
 public:
  bool answers_kind(QueryTaskKind kind) const override {
    return kind == QueryTaskKind::closest || kind == QueryTaskKind::rays;
  }
  ~EmbreeQueries() override {
    for (const RTCGeometry geometry : geometries_) rtcReleaseGeometry(geometry);
    if (scene_ != nullptr) rtcReleaseScene(scene_);
  }
  void prepare(const QueryTask& task) override {
    const bool is_moving = task.kind == QueryTaskKind::rays;
    scene_ = rtcNewScene(device_);
    rtcSetSceneFlags(scene_,
                     is_moving ? RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_DYNAMIC : RTC_SCENE_FLAG_NONE);
    const auto& triangles = task.copies.triangles();
    for (std::size_t i = 0; i < task.copies.copies(); ++i) {
      const RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
      rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, triangles.data(), 0,
                                 sizeof(Triangle), triangles.size());
      const auto positions = task.copies.positions(i);
      rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, positions.data(), 0,
                                 sizeof(Vec3f), positions.size());
      if (is_moving) rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_REFIT);
      rtcCommitGeometry(geometry);
      rtcAttachGeometry(scene_, geometry);
      geometries_.push_back(geometry);
    }
    rtcCommitScene(scene_);
    positions_ = task.copies.positions(0).data();
    triangles_ = triangles.data();
    answers_.resize(task.points.size() + task.rays.size());
  }
  void frame(const QueryTask& task) override {
    if (task.kind == QueryTaskKind::rays)
      cast(task);
    else
      find_closest(task);
  }

 private:
  void cast(const QueryTask& task) {
    for (const RTCGeometry geometry : geometries_) {
      rtcUpdateGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0);
      rtcCommitGeometry(geometry);
    }
    rtcCommitScene(scene_);
    for (std::size_t i = 0; i < task.rays.size(); ++i) {
      const auto& [origin, direction] = task.rays[i];
      RTCRayHit hit{};
      hit.ray.org_x = static_cast<float>(origin.x);
      hit.ray.org_y = static_cast<float>(origin.y);
      hit.ray.org_z = static_cast<float>(origin.z);
      hit.ray.dir_x = static_cast<float>(direction.x);
      hit.ray.dir_y = static_cast<float>(direction.y);
      hit.ray.dir_z = static_cast<float>(direction.z);
      hit.ray.tfar = std::numeric_limits<float>::infinity();
      hit.ray.mask = ~0u;
      hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      rtcIntersect1(scene_, &context, &hit);
      answers_[i] = hit.hit.geomID == RTC_INVALID_GEOMETRY_ID ? std::numeric_limits<double>::infinity()
                                                              : double{hit.ray.tfar};
    }
  }

  void find_closest(const QueryTask& task) {
    for (std::size_t i = 0; i < task.points.size(); ++i) {
      const Vec3d& p = task.points[i];
      RTCPointQuery query{static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z), 0,
                          std::numeric_limits<float>::infinity()};
      RTCPointQueryContext context;
      rtcInitPointQueryContext(&context);
      rtcPointQuery(scene_, &query, &context, shrink, this);
      answers_[i] = double{query.radius};
    }
  }

  static float dot(const Vec3f& a, const Vec3f& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
  static Vec3f between(const Vec3f& a, const Vec3f& b) { return {b.x - a.x, b.y - a.y, b.z - a.z}; }

  /// Shrinks the query to the distance of a triangle (Ericson, Real-Time Collision Detection, 5.1.5).
  static bool shrink(RTCPointQueryFunctionArguments* arguments) {
    const auto& self = *static_cast<EmbreeQueries*>(arguments->userPtr);
    const Triangle& t = self.triangles_[arguments->primID];
    const Vec3f p{arguments->query->x, arguments->query->y, arguments->query->z};
    const Vec3f &a = self.positions_[t[0]], &b = self.positions_[t[1]], &c = self.positions_[t[2]];
    const Vec3f ab = between(a, b), ac = between(a, c), ap = between(a, p), bp = between(b, p),
                cp = between(c, p);
    const auto [v, w] =
        nearest_weights(dot(ab, ap), dot(ac, ap), dot(ab, bp), dot(ac, bp), dot(ab, cp), dot(ac, cp));
    const Vec3f way{ap.x - v * ab.x - w * ac.x, ap.y - v * ab.y - w * ac.y, ap.z - v * ab.z - w * ac.z};
    const float distance = std::sqrt(dot(way, way));
    if (distance >= arguments->query->radius) return false;
    arguments->query->radius = distance;
    return true;
  }

  Device device_;
  RTCScene scene_ = nullptr;
  std::vector<RTCGeometry> geometries_;
  const Vec3f* positions_ = nullptr;
  const Triangle* triangles_ = nullptr;
};

}  // namespace

std::unique_ptr<BoxContestant> make_embree_boxes() {
  return std::make_unique<EmbreeBoxes>();
}

std::unique_ptr<CopiesContestant> make_embree_copies() {
  return std::make_unique<EmbreeCopies>();
}
std::unique_ptr<CopiesContestant> make_embree_copies_with_points() {
  return with_contact_points(std::make_unique<EmbreeCopies>());
}

std::unique_ptr<ClothContestant> make_embree_cloth() {
  return std::make_unique<EmbreeCloth>();
}

std::unique_ptr<Contestant<ClothStep>> make_embree_near_cloth(double margin) {
  return std::make_unique<EmbreeNearCloth>(margin);
}

std::unique_ptr<QueryContestant> make_embree_queries() {
  return std::make_unique<EmbreeQueries>();
}

}  // namespace supple::benchmarks
