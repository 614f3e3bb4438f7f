#include <ode/ode.h>

#include "contest/peers/peers.hpp"

namespace supple::benchmarks {
namespace {

class OdeBoxes : public BoxContestant {
 public:
  OdeBoxes() {
    dInitODE2(0);
    dAllocateODEDataForThread(dAllocateMaskAll);
    space_ = dSweepAndPruneSpaceCreate(nullptr, dSAP_AXES_XYZ);
  }
  ~OdeBoxes() override {
    dSpaceDestroy(space_);
    dCloseODE();
  }
  OdeBoxes(const OdeBoxes&) = delete;
  OdeBoxes& operator=(const OdeBoxes&) = delete;

  void prepare(const MovingBoxes& field) override {
    for (std::size_t i = 0; i < field.boxes().size(); ++i) {
      boxes_.push_back(dCreateBox(space_, 1, 1, 1));
      dGeomSetData(boxes_.back(), reinterpret_cast<void*>(i));
    }
  }
  void frame(const MovingBoxes& field) override {
    for (std::size_t i = 0; i < boxes_.size(); ++i) {
      const Aabb& box = field.boxes()[i];
      const double low[] = {box.min.x, box.min.y, box.min.z}, high[] = {box.max.x, box.max.y, box.max.z};
      dGeomBoxSetLengths(boxes_[i], high[0] - low[0], high[1] - low[1], high[2] - low[2]);
      dGeomSetPosition(boxes_[i], 0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]),
                       0.5 * (low[2] + high[2]));
    }
    pairs_.clear();
    dSpaceCollide(space_, &pairs_, keep);
  }
  PairDigest pairs() const override {
    PairDigest digest;
    for (const IndexPair& pair : pairs_) digest.add(pair.a, pair.b);
    return digest;
  }

 private:
  static std::uint32_t number_of(dGeomID box) {
    return static_cast<std::uint32_t>(reinterpret_cast<std::uintptr_t>(dGeomGetData(box)));
  }
  static void keep(void* pairs, dGeomID a, dGeomID b) {
    static_cast<std::vector<IndexPair>*>(pairs)->push_back({number_of(a), number_of(b)});
  }

  dSpaceID space_ = nullptr;
  std::vector<dGeomID> boxes_;
  std::vector<IndexPair> pairs_;
};

}  // namespace

std::unique_ptr<BoxContestant> make_ode_boxes() {
  return std::make_unique<OdeBoxes>();
}

}  // namespace supple::benchmarks
