#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "answers/penetration/surface_view.hpp"
#include "core/kept_lists.hpp"
#include "queries/object_queries.hpp"
#include "supple/penetration.hpp"
#include "supple/result.hpp"
#include "world/world.hpp"

namespace supple {

/// Curves with the lists that they refer to.
struct CurveLists {
  std::vector<IntersectionCurve> curves;
  std::vector<std::uint32_t> contacts;
  std::vector<Vec3d> points;
  std::vector<std::uint32_t> enclosed;

  void clear() {
    curves.clear();
    contacts.clear();
    points.clear();
    enclosed.clear();
  }
};

/// The data of an object that penetrations and curves read.
struct PenetratedObject {
  QueriedObject queried;
  SurfaceView surface;
  bool is_solid = false;
};

/// The contacts of two objects, or of one object with itself.
struct CurveInput {
  const PenetratedObject *a = nullptr, *b = nullptr;
  const ContactGroup* group = nullptr;
  const DetectResult* result = nullptr;  ///< with the contacts of the group, and their points

  bool same_object() const { return a == b; }
};

/// Links contacts to curves; see `IntersectionCurve`.
class CurveMaker {
 public:
  virtual ~CurveMaker() = default;
  /// Appends the curves of a group, ordered by their smallest contacts. O(n log n) for n contacts, and the
  /// vertices that each curve encloses.
  virtual void find(const CurveInput& input, CurveLists& lists) = 0;
};

/// The manifolds of a scene from step to step; see `Manifold`.
class ManifoldMaker {
 public:
  virtual ~ManifoldMaker() = default;
  /// Finds the manifolds of a result over this world, which has the curves and the pairs; none for an empty
  /// one. `lists_all_pairs`: none is left out of the pairs of two objects. The lists are those of the last
  /// step until `publish`.
  virtual void find(const DetectResult& result, const World& world, bool lists_all_pairs) = 0;
  /// Adds the lists to the result. Does not fail.
  virtual void publish(DetectResult& result) = 0;
  /// Keeps each list that `publish` adds.
  virtual void keep(KeptLists& kept) = 0;
};

/// What is in the library supple::manifold.
struct ManifoldMethods {
  std::unique_ptr<CurveMaker> (*curve_maker)();  ///< with the memory of one worker
  std::unique_ptr<ManifoldMaker> (*manifold_maker)();
};

/// Any number of threads may set the same methods, which must live until the end.
void set_manifold_methods(const ManifoldMethods& methods);
/// Throws `Error` when no methods were set. `what` names what needs them.
const ManifoldMethods& manifold_methods(const std::string& what);

}  // namespace supple
