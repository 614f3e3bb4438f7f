#include "reports/self_contacts.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <span>
#include <type_traits>

#include "base/text.hpp"
#include "inputs/inputs.hpp"
#include "moving/moving_objects.hpp"
#include "reports/result_json.hpp"
#include "supple/topology.hpp"

namespace supple::cli {

namespace {

/// The vertices of an element of the contact on side 'a' or 'b'.
template <class Contact>
std::vector<std::uint32_t> vertices_of(const TriangleMesh& mesh, const Contact& contact, char side) {
  const auto corners = [&](std::uint32_t triangle) {
    const Triangle& t = mesh.triangles[triangle];
    return std::vector<std::uint32_t>(t.begin(), t.end());
  };
  if constexpr (std::is_same_v<Contact, supple::Contact>) {
    return corners(side == 'a' ? contact.triangle_a : contact.triangle_b);
  } else {
    const auto& element = side == 'a' ? contact.element_a : contact.element_b;
    const FeatureKind kind = kind_of_element(contact, side);
    if (kind == FeatureKind::face) return corners(element[0]);
    return {element.begin(), element.begin() + (kind == FeatureKind::edge ? 2 : 1)};
  }
}

}  // namespace

/// Whether the two elements have vertices at equal positions.
template <class Contact>
bool SelfContacts::is_at_seam(const Contact& contact) const {
  const TriangleMesh& mesh = input_.objects[contact.object_a.index].mesh;
  const std::span<const Vec3d> positions = objects_.positions(contact.object_a);
  const std::vector<std::uint32_t> a = vertices_of(mesh, contact, 'a'), b = vertices_of(mesh, contact, 'b');
  return std::ranges::any_of(a, [&](std::uint32_t v) {
    return std::ranges::any_of(b, [&](std::uint32_t w) { return positions[v] == positions[w]; });
  });
}

void SelfContacts::add(const DetectResult& result) {
  const auto add_all = [&](const auto& contacts) {
    for (const auto& contact : contacts) {
      if (contact.object_a != contact.object_b || input_.objects[contact.object_a.index].options.weld)
        continue;
      Counts& counts = counts_[contact.object_a];
      ++counts.all;
      if (is_at_seam(contact)) ++counts.at_seams;
    }
  };
  add_all(result.contacts);
  add_all(result.continuous_contacts);
  add_all(result.proximity_pairs);
}

std::vector<std::string> SelfContacts::notes() const {
  std::vector<std::string> notes;
  for (const auto& [object, counts] : counts_) {
    if (2 * counts.at_seams <= counts.all) continue;
    notes.push_back(
        fmt::format("{} of {} of {} with itself {} between vertices at equal positions, as at the seams of "
                    "an export; --weld makes such vertices one",
                    grouped(counts.at_seams), counted(counts.all, "contact"), name_of(input_, object),
                    counts.at_seams == 1 ? "is" : "are"));
  }
  if (const std::string note = note_of_neighbours(); !note.empty()) notes.push_back(note);
  return notes;
}

std::string SelfContacts::note_of_neighbours() const {
  if (!contains(input_.simulation.scene.contacts, ContactKinds::intersection)) return "";
  std::uint64_t pairs = 0;
  for (const InputObject& object : input_.objects) {
    if (!object.options.self_collision || object.options.neighbours == Neighbours::exact) continue;
    pairs +=
        count_neighbour_pairs(object.options.weld ? welded(object.mesh).triangles : object.mesh.triangles);
  }
  if (pairs == 0) return "";
  return fmt::format("{} that share a vertex {} not tested; --neighbours exact tests them",
                     counted(pairs, "pair of triangles", "pairs of triangles"), pairs == 1 ? "was" : "were");
}

}  // namespace supple::cli
