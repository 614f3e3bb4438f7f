#include "reports/reports.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <span>
#include <type_traits>
#include <utility>

#include "base/text.hpp"
#include "inputs/inputs.hpp"
#include "moving/moving_objects.hpp"
#include "reports/result_json.hpp"
#include "supple/topology.hpp"

namespace supple::cli {
namespace {

/// By `NothingToTest`.
constexpr const char* reasons_in_words[] = {
    "there is no object",
    "no object has a triangle; give surfaces of triangles, not clouds of points",
    "every triangle has a vertex that is not finite; correct the coordinates",
    "no object is solid; --solid makes all objects solid, solid = true one object of a scene file",
    "nothing moves; give frames of one object with --sequence, or a scene file with motion",
    "all margins are 0, which finds only what touches; give --margin",
    "",  // see `advice_for_one_object`
    "all objects are static; let one of them move",
    "groups and masks exclude all pairs; change group or mask of an object",
    "a filter excludes all pairs",
};

bool reads_lines(ContactKinds kind) {
  return info_of(kind).shape != SearchedShape::triangles;
}

}  // namespace

TestedKinds::TestedKinds(const Input& input, ContactKinds requested) : input_(input), requested_(requested) {
  const auto& objects = input.objects;
  are_frames_ = input.scene_text.empty() && objects.size() > 1 &&
                std::ranges::all_of(objects, [&](const InputObject& object) {
                  return object.mesh.triangles == objects.front().mesh.triangles;
                });
  has_lines_ = std::ranges::any_of(objects, [](const InputObject& object) {
    return !object.mesh.edges.empty() || !object.mesh.points.empty();
  });
  std::size_t count = 0;
  for (std::size_t i = 0; i < objects.size() && count < 2; ++i)
    count += count_finite_triangles(objects[i].mesh);
  has_one_triangle_ = count == 1;
}

void TestedKinds::add(const Frame& frame) {
  ++frames_;
  ContactKinds untested = ContactKinds::none;
  for (const UntestedKind& entry : frame.result.untested) {
    untested |= entry.kind;
    reasons_[entry.kind] = entry.reason;
  }
  for (const ContactKindInfo& of : contact_kinds) {
    if (contains(requested_, of.kind) && !contains(untested, of.kind)) tested_ |= of.kind;
  }
  if (frame.turned.empty()) return;
  ++steps_with_turns_;
  if (first_turn_) return;
  first_turn_ = frame.number;
  turned_ = frame.turned.front();
}

std::vector<std::string> TestedKinds::faults() const {
  std::vector<std::pair<std::string, std::string>> reasons;  // names of kinds, and why they were not tested
  bool is_nothing_tested = true;
  for (const ContactKindInfo& of : contact_kinds) {
    const auto [kind, name] = std::pair(of.kind, of.name);
    if (!contains(requested_, kind)) continue;
    if (was_tested(kind)) {
      is_nothing_tested = false;
      continue;
    }
    const std::string reason =
        frames_ == 0 ? "the run ended before its first result" : reason_in_words(kind, reasons_.at(kind));
    if (!reasons.empty() && reasons.back().second == reason)
      reasons.back().first += std::string(" and ") + name;
    else
      reasons.emplace_back(name, reason);
  }
  std::vector<std::string> faults;
  for (const auto& [names, reason] : reasons) {
    const bool is_all = is_nothing_tested && reasons.size() == 1;
    faults.push_back(is_all ? "nothing was tested: " + reason
                            : fmt::format("{} could not be tested: {}", names, reason));
  }
  if (first_turn_) {
    faults.push_back(
        fmt::format("in {}, first from frame {} to {}, objects turn by more than 120 degrees, first {}; "
                    "continuous contacts follow straight paths, which are not this motion, so give frames "
                    "that are closer together",
                    counted(steps_with_turns_, "step"), *first_turn_ - 1, *first_turn_,
                    one_line(input_.objects[turned_->index].mesh.name)));
  }
  return faults;
}

std::string TestedKinds::reason_in_words(ContactKinds kind, NothingToTest reason) const {
  if (reason == NothingToTest::no_elements && leaves_out_lines(kind))
    return "no object has a triangle; lines and points take part in --contacts continuous and proximity";
  if (reason == NothingToTest::no_motion && are_frames_)
    return "nothing moves; if the meshes are frames of one object, give --sequence";
  if (reason == NothingToTest::one_object) return advice_for_one_object(kind);
  return reasons_in_words[static_cast<std::size_t>(reason)];
}

/// Whether an object has lines or points, which this kind does not read.
bool TestedKinds::leaves_out_lines(ContactKinds kind) const {
  return !reads_lines(kind) && has_lines_;
}

std::string TestedKinds::advice_for_one_object(ContactKinds kind) const {
  std::string reason = input_.objects.size() == 1 ? "there is only one object"
                       : kind == ContactKinds::penetration || !reads_lines(kind)
                           ? "only one object has a triangle of finite coordinates"
                           : "only one object has elements of finite coordinates";
  const bool needs_another = kind == ContactKinds::penetration || has_one_triangle_;
  reason += needs_another ? "; give another one" : "; --self tests it against itself";
  if (leaves_out_lines(kind)) reason += "; lines and points take part in --contacts continuous and proximity";
  const TriangleMesh& mesh = input_.objects.front().mesh;
  if (input_.objects.size() != 1) return reason;
  const std::uint64_t parts = compute_topology(mesh).components;
  if (parts > 1)
    reason += fmt::format(", --parts makes an object of each of its {} connected parts", grouped(parts));
  return reason;
}

namespace {

/// The vertices of an element of the contact on side 'a' or 'b'.
template <class Contact>
std::vector<std::uint32_t> vertices_of(const TriangleMesh& mesh, const Contact& contact, char side) {
  const auto corners = [&](std::uint32_t triangle) {
    const Triangle& t = mesh.triangles[triangle];
    return std::vector<std::uint32_t>(t.begin(), t.end());
  };
  if constexpr (requires { contact.triangle_a; }) {
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
  const auto add_all = [&]<class Contact>(std::span<const Contact> contacts) {
    for (const Contact& contact : contacts) {
      if (contact.object_a != contact.object_b || input_.objects[contact.object_a.index].options.weld)
        continue;
      Counts& counts = counts_[contact.object_a];
      ++counts.all;
      if (is_at_seam(contact)) ++counts.at_seams;
    }
  };
  for_each_list([&]<class Row>(const ResultList<Row>&, auto member) {
    if constexpr (
        requires(Row row) { row.triangle_a; } || requires(Row row) { row.element_a; })
      add_all(member(result));
  });
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
