#include <BulletCollision/BroadphaseCollision/btDbvt.h>
#include <BulletCollision/Gimpact/btGImpactBvh.h>

#include <cmath>

#include "contest/baselines/triangle_test.hpp"
#include "contest/peers/peers.hpp"

namespace supple::benchmarks {
namespace {

btDbvtVolume volume_of(const Aabb& box) {
  return btDbvtVolume::FromMM(btVector3(box.min.x, box.min.y, box.min.z),
                              btVector3(box.max.x, box.max.y, box.max.z));
}

class BulletBoxes : public BoxContestant {
 public:
  void prepare(const MovingBoxes& field) override {
    for (std::size_t i = 0; i < field.boxes().size(); ++i)
      leaves_.push_back(tree_.insert(volume_of(field.boxes()[i]), reinterpret_cast<void*>(i)));
    tree_.optimizeTopDown();
  }
  void frame(const MovingBoxes& field) override {
    for (std::size_t i = 0; i < leaves_.size(); ++i) {
      btDbvtVolume volume = volume_of(field.boxes()[i]);
      tree_.update(leaves_[i], volume);
    }
    tree_.optimizeIncremental(static_cast<int>(leaves_.size() / 100 + 1));
    keep_.pairs.clear();
    tree_.collideTTpersistentStack(tree_.m_root, tree_.m_root, keep_);
  }
  PairDigest pairs() const override {
    PairDigest digest;
    for (const IndexPair& pair : keep_.pairs) digest.add(pair.a, pair.b);
    return digest;
  }

 private:
  struct Keep : btDbvt::ICollide {
    static std::uint32_t number_of(const btDbvtNode* leaf) {
      return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(leaf->data));
    }
    void Process(const btDbvtNode* a, const btDbvtNode* b) override {
      if (a != b) pairs.push_back({number_of(a), number_of(b)});
    }
    std::vector<IndexPair> pairs;
  };

  btDbvt tree_;
  std::vector<btDbvtNode*> leaves_;
  Keep keep_;
};

/// GImpact compares boxes by rounded centres and half extents. This factor compensates the rounding.
constexpr float widened = 0x1p-18f;

class MeshBoxes : public btPrimitiveManagerBase {
 public:
  MeshBoxes(const Vec3f* first_position, const std::vector<Triangle>& all_triangles)
      : positions(first_position), triangles_(all_triangles) {}

  bool is_trimesh() const override { return true; }
  int get_primitive_count() const override { return static_cast<int>(triangles_.size()); }
  void get_primitive_box(int triangle, btAABB& box) const override {
    const Triangle& t = triangles_[static_cast<std::size_t>(triangle)];
    box.calc_from_triangle_margin(point(t[0]), point(t[1]), point(t[2]), widened);
  }
  void get_primitive_triangle(int, btPrimitiveTriangle&) const override {}

  const Vec3f* positions;

 private:
  btVector3 point(std::uint32_t vertex) const {
    const Vec3f& p = positions[vertex];
    return {p.x, p.y, p.z};
  }

  const std::vector<Triangle>& triangles_;
};

class BulletCopies : public CandidateContestant {
 public:
  void prepare(const DeformingCopies& copies) override {
    for (std::size_t i = 0; i < copies.copies(); ++i) {
      meshes_.push_back(std::make_unique<MeshBoxes>(copies.positions(i).data(), copies.triangles()));
      trees_.push_back(std::make_unique<btGImpactBvh>(meshes_.back().get()));
      trees_.back()->buildSet();
    }
  }

 private:
  void update(const DeformingCopies& copies) override {
    for (std::size_t i = 0; i < trees_.size(); ++i) {
      meshes_[i]->positions = copies.positions(i).data();
      if (copies.moves(i)) trees_[i]->update();
    }
  }
  void find_candidates(const DeformingCopies& copies) override {
    const btTransform identity = btTransform::getIdentity();
    for (const IndexPair& pair : overlapping_copies(copies, boxes_)) {
      found_.clear();
      btGImpactBvh::find_collision(trees_[pair.a].get(), identity, trees_[pair.b].get(), identity, found_);
      for (int i = 0; i < found_.size(); ++i) {
        candidates_.push_back({pair.a, pair.b, static_cast<std::uint32_t>(found_[i].m_index1),
                               static_cast<std::uint32_t>(found_[i].m_index2)});
      }
    }
  }

  std::vector<std::unique_ptr<MeshBoxes>> meshes_;
  std::vector<std::unique_ptr<btGImpactBvh>> trees_;
  btPairSet found_;
  std::vector<Aabb> boxes_;
};

}  // namespace

std::unique_ptr<BoxContestant> make_bullet_boxes() {
  return std::make_unique<BulletBoxes>();
}

std::unique_ptr<CopiesContestant> make_bullet_copies() {
  return std::make_unique<BulletCopies>();
}

}  // namespace supple::benchmarks
