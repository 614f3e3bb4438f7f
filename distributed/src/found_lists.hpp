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

/// The lists of a result, with memory of their own.
struct FoundLists {
  std::array<std::vector<ObjectPair>, pair_lists> pairs;  ///< by `PairList`
  std::vector<ContactGroup> groups, continuous_groups, proximity_groups;
  std::vector<Contact> contacts;
  std::vector<ContactPoint> contact_points;
  std::vector<ContinuousContact> continuous_contacts;
  std::vector<ProximityPair> proximity_pairs;
  std::vector<PenetrationGroup> penetration_groups;
  std::vector<Penetration> penetrations;
  std::vector<std::uint32_t> vertices_on_surface;
  std::vector<ContainedPart> contained_parts;
  std::vector<IntersectionCurve> curves;
  std::vector<std::uint32_t> curve_contacts;  ///< of the contacts of the curve's objects until `arrange`
  std::vector<Vec3d> curve_points;
  std::vector<std::uint32_t> enclosed_vertices;
  std::vector<NonFiniteVertex> non_finite_vertices;

  void clear() { *this = {}; }
  /// Reads records with all that belongs to them, as `write_record` wrote them.
  void read(Reader& from);
  /// Sorts all lists in canonical order, drops repeated records, and lists the groups.
  void arrange();
  /// Adds spans of all lists.
  void list(DetectResult& result) const;
};

/// The canonical order.
bool is_before(const ContinuousContact& p, const ContinuousContact& q);

// Each writes a record of `found`, whose objects, vertices and triangles are the user's numbers already, with
// all that belongs to it. The points of a curve and of a contact are those of `found`.

void write_record(const DetectResult& found, const Contact& contact, Writer& to);
void write_record(const DetectResult& found, const ContinuousContact& contact, Writer& to);
void write_record(const DetectResult& found, const ProximityPair& pair, Writer& to);
void write_record(const ContainedPart& part, Writer& to);
void write_record(const NonFiniteVertex& vertex, Writer& to);
void write_pair(PairList list, const ObjectPair& pair, Writer& to);
/// The lists of a group, with the user's numbers.
void write_record(const PenetrationGroup& group, const std::vector<Penetration>& penetrations,
                  const std::vector<std::uint32_t>& on_surface, Writer& to);
/// `contacts` are those of the curve, counted from the first contact of its objects.
void write_record(const DetectResult& found, const IntersectionCurve& curve,
                  const std::vector<std::uint32_t>& contacts, const std::vector<std::uint32_t>& enclosed,
                  Writer& to);

}  // namespace supple
