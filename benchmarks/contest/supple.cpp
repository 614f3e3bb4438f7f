#include <algorithm>
#include <limits>

#include "contest/baselines/swept_boxes.hpp"
#include "contest/contestant.hpp"
#include "supple/scene.hpp"

namespace supple::benchmarks {
namespace {

class SuppleBoxes : public BoxContestant {
 public:
  SuppleBoxes(std::uint32_t threads, BroadPhaseMethod method)
      : broad_phase_({.method = method, .scene_octree = {}, .threads = threads}) {}
  void prepare(const MovingBoxes& field) override { frame(field); }
  void frame(const MovingBoxes& field) override { pairs_ = broad_phase_.find_object_pairs(field.boxes()); }
  PairDigest pairs() const override {
    PairDigest digest;
    for (const IndexPair& pair : pairs_) digest.add(pair.a, pair.b);
    return digest;
  }

 private:
  BroadPhase broad_phase_;
  std::span<const IndexPair> pairs_;
};

/// Passes a dirty list to each search.
class SuppleBoxesWithDirtyList : public BoxContestant {
 public:
  explicit SuppleBoxesWithDirtyList(std::vector<std::uint32_t> moving) : moving_(std::move(moving)) {}
  void prepare(const MovingBoxes& field) override { pairs_ = broad_phase_.find_object_pairs(field.boxes()); }
  void frame(const MovingBoxes& field) override {
    pairs_ = broad_phase_.find_object_pairs(field.boxes(), moving_);
  }
  PairDigest pairs() const override {
    PairDigest digest;
    for (const IndexPair& pair : pairs_) digest.add(pair.a, pair.b);
    return digest;
  }

 private:
  BroadPhase broad_phase_{{.method = BroadPhaseMethod::automatic, .scene_octree = {}, .threads = 1}};
  std::vector<std::uint32_t> moving_;
  std::span<const IndexPair> pairs_;
};

SceneOptions options_of(std::uint32_t threads, ContactKinds contacts) {
  SceneOptions options;
  options.threads = threads;
  options.contacts = contacts;
  return options;
}
SceneOptions options_of(std::uint32_t threads, CopyResults results) {
  SceneOptions options = options_of(threads, ContactKinds::intersection);
  options.contact_points = results == CopyResults::contact_points;
  return options;
}

/// Divides the processor time of `detect` among its stages in proportion to their wall times.
std::vector<StageTime> stages_of(const StepStats& stats, double handing_over, double detect) {
  const double scale = stats.total_seconds > 0 ? detect / stats.total_seconds : 0;
  return {{"update", handing_over + stats.refit_seconds * scale},
          {"traversal", (stats.broad_phase_seconds + stats.traversal_seconds) * scale},
          {"triangle tests", stats.exact_seconds * scale},
          {"order and events", stats.sort_and_events_seconds * scale},
          {"refit alone", stats.refit_seconds * scale}};
}

class SuppleCopies : public CopiesContestant {
 public:
  SuppleCopies(std::uint32_t threads, CopyResults results) : scene_(options_of(threads, results)) {}

  void prepare(const DeformingCopies& copies) override {
    for (std::size_t i = 0; i < copies.copies(); ++i)
      objects_.push_back(scene_.add(copies.positions(i), copies.triangles()));
    scene_.detect();
  }
  void frame(const DeformingCopies& copies) override {
    const double start = cpu_milliseconds();
    for (std::size_t i = 0; i < objects_.size(); ++i) {
      if (copies.moves(i)) {
        scene_.share_positions(objects_[i], copies.positions(i));
      }
    }
    const double handed_over = cpu_milliseconds();
    const StepStats& stats = scene_.detect().stats;
    stages_ = stages_of(stats, handed_over - start, cpu_milliseconds() - handed_over);
  }
  PairDigest pairs() const override {
    PairDigest digest;
    for (const Contact& contact : scene_.result().contacts) {
      digest.add(contact.object_a.index + (std::uint64_t{contact.triangle_a} << 32),
                 contact.object_b.index + (std::uint64_t{contact.triangle_b} << 32));
    }
    return digest;
  }
  std::vector<StageTime> stages() const override { return stages_; }

 private:
  Scene scene_;
  std::vector<ObjectId> objects_;
  std::vector<StageTime> stages_;
};

/// The index of an edge in the ascending list.
std::uint64_t number_of(const std::vector<std::array<std::uint32_t, 2>>& edges,
                        const std::array<std::uint32_t, 2>& vertices) {
  return static_cast<std::uint64_t>(std::lower_bound(edges.begin(), edges.end(), vertices) - edges.begin());
}

class SuppleCloth : public Contestant<ClothStep> {
 public:
  explicit SuppleCloth(std::uint32_t threads) : scene_(options_of(threads, ContactKinds::continuous)) {}

  void prepare(const ClothStep& step) override {
    cloth_ = scene_.add(step.start, step.triangles, {.self_collision = true});
    edges_ = edges_of(step.triangles);
    frame(step);
  }
  void frame(const ClothStep& step) override {
    const double start = cpu_milliseconds();
    scene_.set_motion(cloth_, step.start, step.end);
    const double handed_over = cpu_milliseconds();
    const StepStats& stats = scene_.detect().stats;
    stages_ = stages_of(stats, handed_over - start, cpu_milliseconds() - handed_over);
  }
  PairDigest pairs() const override {
    PairDigest digest;
    for (const ContinuousContact& contact : scene_.result().continuous_contacts) {
      if (contact.kind == ElementPairKind::edge_edge)
        digest.add(number_of(edges_, contact.element_a), number_of(edges_, contact.element_b));
      else
        digest.add(contact.element_a[0], contact.element_b[0] + (std::uint64_t{1} << 32));
    }
    return digest;
  }
  std::vector<StageTime> stages() const override { return stages_; }

 private:
  Scene scene_;
  ObjectId cloth_;
  std::vector<std::array<std::uint32_t, 2>> edges_;
  std::vector<StageTime> stages_;
};

class SuppleClothBoxes : public ClothContestant {
 public:
  explicit SuppleClothBoxes(std::uint32_t threads) {
    BroadPhaseOptions options;
    options.threads = threads;
    options.kind_pairs = {{vertex, face}, {edge, edge}};
    broad_phase_ = BroadPhase(options);
  }
  void prepare(const ClothStep& step) override {
    triangles_ = step.triangles;
    elements_.prepare(step);
    kinds_.assign(elements_.vertex_boxes.size(), vertex);
    kinds_.resize(kinds_.size() + elements_.edge_boxes.size(), edge);
    kinds_.resize(kinds_.size() + elements_.face_boxes.size(), face);
    frame(step);
  }
  void frame(const ClothStep& step) override {
    elements_.update(step);
    candidates_.clear();
    const auto first_edge = static_cast<std::uint32_t>(elements_.vertex_boxes.size());
    const auto first_face = first_edge + static_cast<std::uint32_t>(elements_.edge_boxes.size());
    for (const IndexPair& pair : broad_phase_.find_object_pairs(elements_.boxes, kinds_)) {
      if (pair.a < first_edge) {
        const std::uint32_t v = elements_.used_vertices[pair.a], f = pair.b - first_face;
        if (!has_corner(triangles_[f], v)) candidates_.push_back({false, v, f});
      } else if (const std::uint32_t a = pair.a - first_edge, b = pair.b - first_edge;
                 !elements_.edges_share(a, b)) {
        candidates_.push_back({true, a, b});
      }
    }
  }
  std::span<const ElementPair> candidates() const override { return candidates_; }

 private:
  enum Kind : std::uint8_t { vertex, edge, face };

  BroadPhase broad_phase_;
  ClothBoxes elements_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint8_t> kinds_;
  std::vector<ElementPair> candidates_;
};

class SuppleNearCloth : public Contestant<ClothStep> {
 public:
  SuppleNearCloth(std::uint32_t threads, double margin, ProximityListing listing)
      : scene_(options_for(threads, listing)), margin_(margin) {}

  void prepare(const ClothStep& step) override {
    cloth_ = scene_.add(step.start, step.triangles, {.self_collision = true, .margin = margin_});
    edges_ = edges_of(step.triangles);
    frame(step);
  }
  void frame(const ClothStep& step) override {
    const double start = cpu_milliseconds();
    scene_.set_positions(cloth_, step.start);
    const double handed_over = cpu_milliseconds();
    const StepStats& stats = scene_.detect().stats;
    stages_ = stages_of(stats, handed_over - start, cpu_milliseconds() - handed_over);
  }
  /// As the other contestants number their pairs: only with the listing of elements.
  PairDigest pairs() const override {
    PairDigest digest;
    for (const ProximityPair& pair : scene_.result().proximity_pairs) {
      if (pair.kind_a == FeatureKind::vertex)
        digest.add(pair.element_a[0], pair.element_b[0] + (std::uint64_t{1} << 32));
      else if (pair.kind_b == FeatureKind::edge)  // crossings are not listed by the others
        digest.add(number_of(edges_, pair.element_a), number_of(edges_, pair.element_b));
    }
    return digest;
  }
  std::vector<StageTime> stages() const override { return stages_; }

 private:
  static SceneOptions options_for(std::uint32_t threads, ProximityListing listing) {
    SceneOptions options = options_of(threads, ContactKinds::proximity);
    options.proximity_listing = listing;
    return options;
  }

  Scene scene_;
  double margin_;
  ObjectId cloth_;
  std::vector<std::array<std::uint32_t, 2>> edges_;
  std::vector<StageTime> stages_;
};

class SuppleQueries : public QueryContestant {
 public:
  explicit SuppleQueries(std::uint32_t threads) : scene_(options_of(threads, ContactKinds::penetration)) {}
  bool answers_kind(QueryTaskKind) const override { return true; }
  void prepare(const QueryTask& task) override {
    for (std::size_t i = 0; i < task.copies.copies(); ++i)
      objects_.push_back(scene_.add(task.copies.positions(i), task.copies.triangles(),
                                    {.solid = task.kind == QueryTaskKind::penetration}));
    if (task.kind == QueryTaskKind::distance)
      objects_.push_back(scene_.add(task.copies.positions(0), task.copies.triangles()));
    answers_.resize(task.points.size() + task.rays.size());
    frame(task);
  }
  void frame(const QueryTask& task) override {
    const bool is_moving = task.kind == QueryTaskKind::rays || task.kind == QueryTaskKind::penetration;
    for (std::size_t i = 0; is_moving && i < objects_.size(); ++i)
      scene_.share_positions(objects_[i], task.copies.positions(i));
    if (task.kind == QueryTaskKind::distance) {
      scene_.set_transform(objects_[1], {.translation = task.offset});
      answers_.assign(1, scene_.distance(objects_[0], objects_[1])->distance);
    } else if (task.kind == QueryTaskKind::closest) {
      closest_.resize(task.points.size());
      scene_.closest(task.points, closest_);
      for (std::size_t i = 0; i < closest_.size(); ++i) answers_[i] = closest_[i]->distance;
    } else if (task.kind == QueryTaskKind::inside) {
      inside_.resize(task.points.size());
      scene_.inside(task.points, inside_);
      for (std::size_t i = 0; i < inside_.size(); ++i)
        answers_[i] = inside_[i] == Containment::inside ? 1 : 0;
    } else if (task.kind == QueryTaskKind::rays) {
      hits_.resize(task.rays.size());
      scene_.cast(task.rays, hits_);
      for (std::size_t i = 0; i < hits_.size(); ++i)
        answers_[i] = hits_[i] ? hits_[i]->t : std::numeric_limits<double>::infinity();
    } else {
      answers_.assign(4, 0);
      for (const Penetration& p : scene_.detect().penetrations) {
        const std::size_t place = p.object_a == objects_[0] ? 0 : 2;
        answers_[place] += 1;
        answers_[place + 1] += p.depth;
      }
    }
  }

 private:
  Scene scene_;
  std::vector<ObjectId> objects_;
  std::vector<std::optional<ClosestPoint>> closest_;
  std::vector<std::optional<RayHit>> hits_;
  std::vector<Containment> inside_;
};

}  // namespace

std::unique_ptr<BoxContestant> make_supple_boxes(std::uint32_t threads, BroadPhaseMethod method) {
  return std::make_unique<SuppleBoxes>(threads, method);
}

std::unique_ptr<BoxContestant> make_supple_boxes_with_dirty_list(std::vector<std::uint32_t> moving) {
  return std::make_unique<SuppleBoxesWithDirtyList>(std::move(moving));
}

std::unique_ptr<CopiesContestant> make_supple_copies(std::uint32_t threads, CopyResults results) {
  return std::make_unique<SuppleCopies>(threads, results);
}

std::unique_ptr<Contestant<ClothStep>> make_supple_cloth(std::uint32_t threads) {
  return std::make_unique<SuppleCloth>(threads);
}

std::unique_ptr<ClothContestant> make_supple_cloth_boxes(std::uint32_t threads) {
  return std::make_unique<SuppleClothBoxes>(threads);
}

std::unique_ptr<Contestant<ClothStep>> make_supple_near_cloth(std::uint32_t threads, double margin,
                                                              ProximityListing listing) {
  return std::make_unique<SuppleNearCloth>(threads, margin, listing);
}

std::unique_ptr<QueryContestant> make_supple_queries(std::uint32_t threads) {
  return std::make_unique<SuppleQueries>(threads);
}

}  // namespace supple::benchmarks
