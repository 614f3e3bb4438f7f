#include "reports/self_contacts.hpp"

#include <fmt/core.h>

#include "base/text.hpp"
#include "inputs/inputs.hpp"
#include "supple/topology.hpp"

namespace supple::cli {

/// Whether the two elements have vertices at equal positions.
template <class Contact>
bool SelfContacts::is_at_seam(const Contact& contact) const {
  const ElementVertices a = scene_.vertices_of(contact, ContactSide::a),
                        b = scene_.vertices_of(contact, ContactSide::b);
  for (std::uint32_t i = 0; i < a.count; ++i) {
    const Vec3d position = scene_.position(contact.object_a, a.ids[i]);
    for (std::uint32_t j = 0; j < b.count; ++j) {
      if (position == scene_.position(contact.object_b, b.ids[j])) return true;
    }
  }
  return false;
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
                    grouped(counts.at_seams), counted(counts.all, "contact"), name_of(scene_, object),
                    counts.at_seams == 1 ? "is" : "are"));
  }
  if (const std::string note = note_of_neighbours(); !note.empty()) notes.push_back(note);
  return notes;
}

std::string SelfContacts::note_of_neighbours() const {
  if (!contains(scene_.options().contacts, ContactKinds::intersection)) return "";
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
