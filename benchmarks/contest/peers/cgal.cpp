#include <CGAL/box_intersection_d.h>

#include <algorithm>

#include "contest/baselines/swept_boxes.hpp"
#include "contest/baselines/triangle_test.hpp"
#include "contest/peers/peers.hpp"

namespace supple::benchmarks {
namespace {

/// CGAL compares all boxes with each other below this count.
constexpr std::ptrdiff_t cutoff = 200;

/// A box with a number, because CGAL reorders boxes. CGAL takes boxes with equal `id` for the same box, even
/// in different lists, so boxes of the second list have the highest bit set.
class NumberedBox : public CGAL::Box_intersection_d::Box_d<float, 3, CGAL::Box_intersection_d::ID_NONE> {
 public:
  NumberedBox() = default;
  NumberedBox(const Aabb& box, std::uint32_t number, bool is_second)
      : Box_d(const_cast<float*>(&box.min.x), const_cast<float*>(&box.max.x)),
        id_(number | (is_second ? second_list : 0)) {}
  std::uint32_t id() const { return id_; }
  std::uint32_t number() const { return id_ & ~second_list; }

 private:
  static constexpr std::uint32_t second_list = 0x80000000u;
  std::uint32_t id_ = 0;
};

void list(std::span<const Aabb> boxes, std::vector<NumberedBox>& numbered, bool is_second = false) {
  numbered.clear();
  for (std::uint32_t i = 0; i < boxes.size(); ++i) numbered.emplace_back(boxes[i], i, is_second);
}

class CgalBoxes : public BoxContestant {
 public:
  void prepare(const MovingBoxes&) override {}
  void frame(const MovingBoxes& field) override {
    list(field.boxes(), boxes_);
    pairs_.clear();
    CGAL::box_self_intersection_d(
        boxes_.begin(), boxes_.end(),
        [&](const NumberedBox& a, const NumberedBox& b) {
          pairs_.push_back({a.number(), b.number()});
        },
        cutoff);
  }
  PairDigest pairs() const override {
    PairDigest digest;
    for (const IndexPair& pair : pairs_) digest.add(pair.a, pair.b);
    return digest;
  }

 private:
  std::vector<NumberedBox> boxes_;
  std::vector<IndexPair> pairs_;
};

/// The boxes of all triangles; for each pair of copies, the boxes that overlap both copies.
class CgalCopies : public CandidateContestant {
 public:
  void prepare(const DeformingCopies& copies) override {
    const std::size_t count = copies.triangles().size();
    triangle_boxes_.resize(copies.copies() * count);
    for (std::size_t i = 0; i < copies.copies(); ++i) find_boxes(copies, i);
  }

 private:
  void find_boxes(const DeformingCopies& copies, std::size_t copy) {
    const auto positions = copies.positions(copy);
    Aabb* box = &triangle_boxes_[copy * copies.triangles().size()];
    for (const Triangle& t : copies.triangles()) {
      const Vec3f &p = positions[t[0]], &q = positions[t[1]], &r = positions[t[2]];
      *box++ = {{std::min(p.x, std::min(q.x, r.x)), std::min(p.y, std::min(q.y, r.y)),
                 std::min(p.z, std::min(q.z, r.z))},
                {std::max(p.x, std::max(q.x, r.x)), std::max(p.y, std::max(q.y, r.y)),
                 std::max(p.z, std::max(q.z, r.z))}};
    }
  }
  void update(const DeformingCopies& copies) override {
    for (std::size_t i = 0; i < copies.copies(); ++i) {
      if (copies.moves(i)) find_boxes(copies, i);
    }
  }
  void list_within(std::size_t copy, std::size_t count, const Aabb& other, std::vector<NumberedBox>& boxes,
                   bool is_second) {
    boxes.clear();
    const Aabb* const all = &triangle_boxes_[copy * count];
    for (std::uint32_t i = 0; i < count; ++i) {
      if (boxes_overlap(all[i], other)) boxes.emplace_back(all[i], i, is_second);
    }
  }
  void find_candidates(const DeformingCopies& copies) override {
    for (const IndexPair& pair : overlapping_copies(copies, bounds_)) {
      list_within(pair.a, copies.triangles().size(), bounds_[pair.b], boxes_a_, false);
      list_within(pair.b, copies.triangles().size(), bounds_[pair.a], boxes_b_, true);
      CGAL::box_intersection_d(
          boxes_a_.begin(), boxes_a_.end(), boxes_b_.begin(), boxes_b_.end(),
          [&](const NumberedBox& a, const NumberedBox& b) {
            candidates_.push_back({pair.a, pair.b, a.number(), b.number()});
          },
          cutoff);
    }
  }

  std::vector<Aabb> triangle_boxes_, bounds_;
  std::vector<NumberedBox> boxes_a_, boxes_b_;
};

class CgalCloth : public ClothContestant {
 public:
  void prepare(const ClothStep& step) override { elements_.prepare(step); }
  void frame(const ClothStep& step) override {
    elements_.update(step);
    candidates_.clear();
    list(elements_.vertex_boxes, boxes_a_);
    list(elements_.face_boxes, boxes_b_, true);
    CGAL::box_intersection_d(
        boxes_a_.begin(), boxes_a_.end(), boxes_b_.begin(), boxes_b_.end(),
        [&](const NumberedBox& a, const NumberedBox& b) {
          const std::uint32_t vertex = elements_.used_vertices[a.number()];
          if (!has_corner(step.triangles[b.number()], vertex))
            candidates_.push_back({false, vertex, b.number()});
        },
        cutoff);
    list(elements_.edge_boxes, boxes_a_);
    CGAL::box_self_intersection_d(
        boxes_a_.begin(), boxes_a_.end(),
        [&](const NumberedBox& a, const NumberedBox& b) {
          if (!elements_.edges_share(a.number(), b.number()))
            candidates_.push_back({true, a.number(), b.number()});
        },
        cutoff);
  }
  std::span<const ElementPair> candidates() const override { return candidates_; }

 private:
  ClothBoxes elements_;
  std::vector<NumberedBox> boxes_a_, boxes_b_;
  std::vector<ElementPair> candidates_;
};

}  // namespace

std::unique_ptr<BoxContestant> make_cgal_boxes() {
  return std::make_unique<CgalBoxes>();
}

std::unique_ptr<CopiesContestant> make_cgal_copies() {
  return std::make_unique<CgalCopies>();
}

std::unique_ptr<ClothContestant> make_cgal_cloth() {
  return std::make_unique<CgalCloth>();
}

}  // namespace supple::benchmarks
