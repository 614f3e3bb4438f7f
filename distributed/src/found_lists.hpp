#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "bytes.hpp"
#include "supple/result.hpp"

namespace supple {

/// Pairs of different objects whose changes are events: with volumes that overlap, with contacts, within
/// their margins, and one inside the other.
enum class PairList : std::uint8_t { volumes, contacts, margins, inside };
inline constexpr std::size_t pair_lists = 4;

/// The lists of a result, with memory of their own and the user's numbers.
struct FoundLists {
  std::array<std::vector<ObjectPair>, pair_lists> pairs;  ///< by `PairList`
  std::vector<Contact> contacts;
  std::vector<ContactPoint> contact_points;
  std::vector<ContinuousContact> continuous_contacts;
  std::vector<ProximityPair> proximity_pairs;
  std::vector<PenetrationGroup> penetration_groups;
  std::vector<Penetration> penetrations;
  std::vector<std::uint32_t> vertices_on_surface;
  std::vector<ContainedPart> contained_parts;
  std::vector<IntersectionCurve> curves;
  std::vector<std::uint32_t> curve_contacts;  ///< from the first contact of the curve's objects on
  std::vector<Vec3d> curve_points;
  std::vector<std::uint32_t> enclosed_vertices;
  std::vector<NonFiniteVertex> non_finite_vertices;

  void clear();
  bool is_empty() const;
  void write(Writer& to) const;
  /// Adds the lists that `write` wrote.
  void append(Reader& from);
  /// Sorts all lists in canonical order.
  void sort();
  /// Lists the groups of the contacts, and adds spans of all lists. `curve_contacts` then counts from the
  /// first contact of all.
  void list(DetectResult& result);

 private:
  template <class Lists, class Visit>
  static void visit(Lists& lists, const Visit& visit);

  std::vector<ContactGroup> groups_, continuous_groups_, proximity_groups_;
};

/// The canonical order.
bool is_before(const ContinuousContact& p, const ContinuousContact& q);

}  // namespace supple
