
#include "options.hpp"
#include "records.hpp"
#include "scene.hpp"
#include "supple/difference_descriptions.hpp"
#include "supple/verify.hpp"

namespace supple::python {
namespace {

/// The lists of groups, which `for_each_list` leaves out because they follow from the records.
template <class Found, class Visit>
void visit_other_lists(Found& found, const Visit& visit) {
  for (const ContactKindInfo& kind : contact_kinds) {
    if (kind.groups != nullptr) visit(kind.groups_name, found.*kind.groups);
  }
  visit("ended_manifolds", found.ended_manifolds);
  visit("non_finite_vertices", found.non_finite_vertices);
  visit("untested", found.untested);
  for_each_events(
      [&](const auto&, const auto&, const char* stay, auto member) { visit(stay, member(found).stay); });
}

/// Calls `visit(name, list)` for all lists of a result.
template <class Found, class Visit>
void visit_lists(Found& found, const Visit& visit) {
  for_each_list([&](const auto& list, auto member) { visit(list.name, member(found)); });
  visit_other_lists(found, visit);
}

nb::object table_of(const std::shared_ptr<Lists>& lists, const DetectResult& found, const std::string& name) {
  nb::object table;
  visit_lists(found, [&]<class Row>(const char* list, std::span<const Row> rows) {
    if (name != list) return;
    table = to_table(rows, owner_of(new std::shared_ptr<Lists>(lists)));
  });
  if (!table.is_valid()) throw nb::attribute_error(("a result has no list '" + name + "'").c_str());
  return table;
}

}  // namespace

nb::list members_of(const RecordInfo& record) {
  static constexpr const char* codes[] = {"?", "u1", "u4", "u8", "f8"};  // by `ScalarType`
  nb::list members;
  for (const FieldInfo& field : record.fields) {
    nb::object words = nb::none();
    if (!field.words.empty()) {
      nb::list list;
      for (const char* word : field.words) list.append(word);
      words = nb::tuple(list);
    }
    const auto add = [&](const char* part, std::size_t count, std::size_t offset, const nb::object& values) {
      const std::string place = field.place < 0 ? "" : "_" + std::to_string(field.place);
      members.append(nb::make_tuple(field.name + std::string(part) + place,
                                    codes[static_cast<std::size_t>(field.scalar)], count,
                                    field.offset + offset, values, field.doc, field.unit));
    };
    switch (field.kind) {
      case FieldInfo::Kind::numbers:
        add("", field.count == 1 ? 0 : field.count, 0, words);
        break;
      case FieldInfo::Kind::object:
        add("", 0, offsetof(ObjectId, index), nb::none());
        add("_generation", 0, offsetof(ObjectId, generation), nb::none());
        break;
      case FieldInfo::Kind::feature:
        add("_kind", 0, offsetof(Feature, kind), words);
        add("_index", 0, offsetof(Feature, index), nb::none());
    }
  }
  return members;
}

std::vector<std::size_t> padding_of(const RecordInfo& record) {
  std::vector<bool> is_used(record.bytes);
  for (const FieldInfo& field : record.fields)
    std::fill_n(is_used.begin() + static_cast<std::ptrdiff_t>(field.offset), field.bytes(), true);
  std::vector<std::size_t> places;
  for (std::size_t i = 0; i < record.bytes; ++i) {
    if (!is_used[i]) places.push_back(i);
  }
  return places;
}

std::unique_ptr<Result> copy_of(const DetectResult& found) {
  const auto memory = std::make_shared<std::vector<std::shared_ptr<const void>>>();
  auto copy = std::make_unique<Result>(Result{found, std::make_shared<Lists>(Lists{nullptr, memory})});
  visit_lists(copy->found, [&]<class Row>(const char*, std::span<const Row>& rows) {
    const auto list = std::make_shared<const std::vector<Row>>(rows.begin(), rows.end());
    memory->push_back(list);
    rows = *list;
  });
  return copy;
}

void bind_results(nb::module_& module) {
  nb::class_<Result>(module, "Result")
      .def(nb::init<>())
      .def_prop_ro("step", [](const Result& r) { return r.found.step; })
      .def_prop_ro("truncated", [](const Result& r) { return r.found.truncated; })
      .def_prop_ro("stopped", [](const Result& r) { return r.found.stopped; })
      .def("stats", [](const Result& r) { return dict_of(r.found.stats); })
      .def("untested",
           [](const Result& r) {
             nb::list list;
             for (const UntestedKind& each : r.found.untested)
               list.append(nb::make_tuple(word_of(each.kind), word_of(each.reason)));
             return list;
           })
      .def("counts",
           [](const Result& r) {
             nb::dict counts;
             visit_lists(r.found, [&](const char* name, auto rows) { counts[name] = rows.size(); });
             return counts;
           })
      .def("table",
           [](const Result& r, const std::string& name) { return table_of(r.lists, r.found, name); });

  module.def("lists", [] {
    nb::dict lists;
    for (const ListInfo& list : list_infos()) {
      const bool is_answer = list.answers != ContactKinds::none;
      lists[list.name] = nb::make_tuple(list.item, list.doc, is_answer ? word_of(list.answers) : "",
                                        is_answer ? info_of(list.answers).groups_name : "");
    }
    return lists;
  });
  module.def("layouts", [] {
    nb::dict layouts;
    for (const auto& [name, item, doc, answers, record] : list_infos()) {
      if (*record.name != 0) layouts[record.name] = nb::make_tuple(record.bytes, members_of(record));
    }
    add_layout<ContactGroup>(layouts);
    add_layout<EndedManifold>(layouts);
    add_layout<NonFiniteVertex>(layouts);
    add_layout<UntestedKind>(layouts);
    add_layout<Difference>(layouts);
    add_layout<ContinuousDifference>(layouts);
    add_layout<ProximityDifference>(layouts);
    add_layout<PenetrationDifference>(layouts);
    add_layout<Found<ClosestPoint>>(layouts);
    add_layout<Found<RayHit>>(layouts);
    add_layout<ListedRayHit>(layouts);
    add_layout<Overlap>(layouts);
    add_layout<LimitingPair>(layouts);
    add_layout<Found<ElementDistance>>(layouts);
    add_layout<Found<Impact>>(layouts);
    add_layout<TriangleIntersection>(layouts);
    return layouts;
  });
}

}  // namespace supple::python
