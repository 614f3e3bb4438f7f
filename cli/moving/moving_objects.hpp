#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "supple/simulation.hpp"
#include "supple/verify.hpp"

namespace supple::cli {

struct Input;
struct InputObject;

/// The energy of a body of masses and springs.
struct BodyEnergy {
  ObjectId object;
  MassSpringEnergy energy;
};

/// The objects of an input, which move step by step, and their contacts. Here all are in one process; of the
/// program for several ranks, each rank has some of them, and calls that are not const are collective.
class MovingObjects {
 public:
  /// Throws `Error` as `build_simulation` does.
  explicit MovingObjects(const Input& input);
  virtual ~MovingObjects() = default;
  MovingObjects(const MovingObjects&) = delete;
  MovingObjects& operator=(const MovingObjects&) = delete;

  // As the functions of `Simulation`.
  virtual const DetectResult& detect(const DetectRequest& request) { return simulation_.detect(request); }
  virtual const DetectResult& step(const DetectRequest& request) { return simulation_.step(request); }
  /// Call it before each step with continuous contacts.
  void remember_positions();
  virtual VerifyReport verify(const CallLimits& limits) {
    return supple::verify(simulation_.scene(), limits);
  }
  /// The objects whose straight paths in the last step are not their motion, ascending.
  virtual std::vector<ObjectId> turned();
  /// The energies of all bodies, ascending by object. When there are several ranks, only rank 0 has them.
  virtual std::vector<BodyEnergy> energies();
  /// See `viewer::warning_of_long_steps`.
  virtual std::optional<std::string> warning_of_long_steps();
  /// Where an object is now. When there are several ranks, the rank that moves the object knows it, and rank
  /// 0 knows it of objects that touch themselves.
  virtual std::span<const Vec3d> positions(ObjectId object) const { return simulation_.positions(object); }
  /// The rank that moves an object; 0 when all ranks do.
  virtual int rank_of(ObjectId) const { return 0; }
  /// Call it when reports and recordings have begun: they do not need the meshes of most objects again.
  virtual void release_meshes(Input&) {}
  virtual int rank_count() const { return 1; }

  std::uint64_t step_count() const { return simulation_.step_count(); }
  double time() const { return simulation_.time(); }
  double motion_seconds() const { return simulation_.motion_seconds(); }
  /// The scene with all objects, in one process.
  const Scene& scene() const { return simulation_.scene(); }

 protected:
  /// Without objects.
  explicit MovingObjects(const SimulationOptions& options) : simulation_(options) {}
  /// Finds the objects of this process, whose inputs these are, that spin too fast. Call it when all are
  /// added.
  void find_spins(const std::vector<InputObject>& objects);

  Simulation simulation_;  ///< of the objects in this process
  /// Where they were at the last `remember_positions`.
  std::vector<std::vector<Vec3d>> before_;

 private:
  std::vector<bool> spins_;  ///< by more than 120 degrees in each step, possibly by whole turns
};

}  // namespace supple::cli
