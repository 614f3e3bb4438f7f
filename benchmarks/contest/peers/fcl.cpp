#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/narrowphase/detail/traversal/collision/bvh_collision_traversal_node.h>
#include <fcl/narrowphase/detail/traversal/traversal_recurse.h>
#include <fcl/narrowphase/distance.h>

#include "contest/baselines/triangle_test.hpp"
#include "contest/peers/peers.hpp"

namespace supple::benchmarks {
namespace {

using Point = fcl::Vector3d;
using Box = fcl::AABBd;

Box box_of(const Aabb& box) {
  return {Point(box.min.x, box.min.y, box.min.z), Point(box.max.x, box.max.y, box.max.z)};
}

class FclBoxes : public BoxContestant {
 public:
  void prepare(const MovingBoxes& field) override {
    for (std::size_t i = 0; i < field.boxes().size(); ++i) {
      shapes_.push_back(std::make_shared<fcl::Boxd>(1, 1, 1));
      objects_.push_back(std::make_unique<fcl::CollisionObjectd>(shapes_.back()));
      objects_.back()->setUserData(reinterpret_cast<void*>(i));
      listed_.push_back(objects_.back().get());
    }
  }
  void frame(const MovingBoxes& field) override {
    for (std::size_t i = 0; i < listed_.size(); ++i) {
      shapes_[i]->aabb_local = box_of(field.boxes()[i]);
      listed_[i]->computeAABB();
    }
    fcl::DynamicAABBTreeCollisionManagerd tree;
    tree.registerObjects(listed_);
    tree.setup();
    pairs_.clear();
    tree.collide(&pairs_, keep);
  }
  PairDigest pairs() const override {
    PairDigest digest;
    for (const IndexPair& pair : pairs_) digest.add(pair.a, pair.b);
    return digest;
  }

 private:
  static std::uint32_t number_of(const fcl::CollisionObjectd& object) {
    return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(object.getUserData()));
  }
  static bool keep(fcl::CollisionObjectd* a, fcl::CollisionObjectd* b, void* pairs) {
    if (a->getAABB().overlap(b->getAABB()))
      static_cast<std::vector<IndexPair>*>(pairs)->push_back({number_of(*a), number_of(*b)});
    return false;
  }

  std::vector<std::shared_ptr<fcl::Boxd>> shapes_;
  std::vector<std::unique_ptr<fcl::CollisionObjectd>> objects_;
  std::vector<fcl::CollisionObjectd*> listed_;
  std::vector<IndexPair> pairs_;
};

/// Lists overlapping leaves; the exact test that follows is the same for all contestants.
class LeafPairs : public fcl::detail::BVHCollisionTraversalNode<Box> {
 public:
  LeafPairs(const fcl::BVHModel<Box>& a, const fcl::BVHModel<Box>& b, IndexPair objects,
            std::vector<CopyPair>& pairs)
      : objects_(objects), pairs_(pairs) {
    model1 = &a;
    model2 = &b;
  }
  void leafTesting(int a, int b) const override {
    pairs_.push_back({objects_.a, objects_.b, static_cast<std::uint32_t>(model1->getBV(a).primitiveId()),
                      static_cast<std::uint32_t>(model2->getBV(b).primitiveId())});
  }
  bool canStop() const override { return false; }

 private:
  IndexPair objects_;
  std::vector<CopyPair>& pairs_;
};

class FclCopies : public CandidateContestant {
 public:
  void prepare(const DeformingCopies& copies) override {
    std::vector<fcl::Triangle> triangles;
    for (const Triangle& t : copies.triangles()) triangles.emplace_back(t[0], t[1], t[2]);
    models_.resize(copies.copies());
    for (std::size_t i = 0; i < models_.size(); ++i) {
      models_[i] = std::make_unique<fcl::BVHModel<Box>>();
      models_[i]->beginModel();
      models_[i]->addSubModel(convert(copies.positions(i)), triangles);
      models_[i]->endModel();
    }
  }

 private:
  const std::vector<Point>& convert(std::span<const Vec3f> positions) {
    points_.clear();
    for (const Vec3f& p : positions) points_.emplace_back(p.x, p.y, p.z);
    return points_;
  }
  void update(const DeformingCopies& copies) override {
    for (std::size_t i = 0; i < models_.size(); ++i) {
      if (!copies.moves(i)) continue;
      models_[i]->beginReplaceModel();
      models_[i]->replaceSubModel(convert(copies.positions(i)));
      models_[i]->endReplaceModel(true, true);
    }
  }
  void find_candidates(const DeformingCopies& copies) override {
    for (const IndexPair& pair : overlapping_copies(copies, boxes_)) {
      LeafPairs node(*models_[pair.a], *models_[pair.b], pair, candidates_);
      fcl::detail::collisionRecurse<double>(&node, 0, 0, nullptr);
    }
  }

  std::vector<std::unique_ptr<fcl::BVHModel<Box>>> models_;
  std::vector<Point> points_;
  std::vector<Aabb> boxes_;
};

class FclQueries : public QueryContestant {
 public:
  bool answers_kind(QueryTaskKind kind) const override { return kind == QueryTaskKind::distance; }
  void prepare(const QueryTask& task) override {
    std::vector<Point> points;
    for (const Vec3f& p : task.copies.positions(0)) points.emplace_back(p.x, p.y, p.z);
    std::vector<fcl::Triangle> triangles;
    for (const Triangle& t : task.copies.triangles()) triangles.emplace_back(t[0], t[1], t[2]);
    model_ = std::make_shared<fcl::BVHModel<fcl::OBBRSSd>>();
    model_->beginModel();
    model_->addSubModel(points, triangles);
    model_->endModel();
  }
  void frame(const QueryTask& task) override {
    fcl::Transform3d place = fcl::Transform3d::Identity();
    place.translation() = Point(task.offset.x, task.offset.y, task.offset.z);
    const fcl::CollisionObjectd a(model_), b(model_, place);
    fcl::DistanceRequestd request;
    request.enable_nearest_points = true;
    fcl::DistanceResultd result;
    answers_.assign(1, fcl::distance(&a, &b, request, result));
  }

 private:
  std::shared_ptr<fcl::BVHModel<fcl::OBBRSSd>> model_;
};

}  // namespace

std::unique_ptr<BoxContestant> make_fcl_boxes() {
  return std::make_unique<FclBoxes>();
}

std::unique_ptr<CopiesContestant> make_fcl_copies() {
  return std::make_unique<FclCopies>();
}

std::unique_ptr<QueryContestant> make_fcl_queries() {
  return std::make_unique<FclQueries>();
}

}  // namespace supple::benchmarks
