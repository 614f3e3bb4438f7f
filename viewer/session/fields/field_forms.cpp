#include "fields/field_forms.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "program/attach_descriptions.hpp"
#include "program/program.hpp"

namespace supple::viewer {
namespace {

std::size_t object_count(const SceneView& show) {
  const auto has_triangles = [](const ViewedObject& object) { return !object.mesh.triangles.empty(); };
  return static_cast<std::size_t>(std::count_if(show.objects.begin(), show.objects.end(), has_triangles));
}

/// A program without a time step has no time.
bool has_time(const SceneView& show) {
  return show.simulation.time_step > 0;
}
bool has_triangles(const SceneView& show) {
  return object_count(show) > 0;
}
bool has_other_objects(const SceneView& show) {
  return object_count(show) > 1;
}
template <ContactKinds kind>
bool finds(const SceneView& show) {
  return contains(show.simulation.scene.contacts, kind);
}

struct BuiltIn {
  const char *key, *label, *unit, *doc;
  FieldElement element;
  bool is_vector;
  const char *list, *column;
  bool (*is_offered)(const SceneView&);
};

constexpr auto vertex = FieldElement::vertex;
constexpr std::array built_in = std::to_array<BuiltIn>({
    {"speed", "Speed", "length/s",
     "How far each vertex moved since the step before, divided by the time between; of a program, since its "
     "last step that the page was given",
     vertex, false, "", "", &has_time},
    {"velocity", "Velocity", "length/s",
     "The mean velocity of each vertex since the step before, or since that step of a program", vertex, true,
     "", "", &has_time},
    {"displacement", "Displacement", "length",
     "From the vertex at the start to the vertex now; of a program, from where it was when the page got the "
     "scene",
     vertex, true, "", "", [](const SceneView&) { return true; }},
    {"strain", "Strain", "",
     "The largest principal strain of each triangle: the largest stretch of any direction in it, length now "
     "/ "
     "length at rest, minus 1; of a program, the rest is as for the displacement",
     FieldElement::face, false, "", "", &has_triangles},
    {"distance", "Distance to other objects", "length",
     "From each vertex to the nearest triangle of another object, also where the vertex is inside of it; the "
     "exact nearest one, by at least one query `Scene::closest` for each vertex",
     vertex, false, "", "", &has_other_objects},
    {"depth", "Depth", "length",
     "Of each vertex inside a solid object, to the nearest point of its surface; of several objects, the "
     "largest depth",
     vertex, false, "", "", &finds<ContactKinds::penetration>},
    {"gap", "Gap", "length", "The distance of each proximity pair", vertex, false, "proximity_pairs",
     "distance", &finds<ContactKinds::proximity>},
    {"impact_time", "Time of impact", "",
     "The time of each continuous contact, from 0 at the start of the step to 1 at its end", vertex, false,
     "continuous_contacts", "toi", &finds<ContactKinds::continuous>},
    {"curve_depth", "Depth of curves", "length",
     "How far the first object must move along the normal of each curve of intersections to pass the second",
     vertex, false, "curves", "depth", &finds<ContactKinds::penetration>},
    {"curve_area", "Area of curves", "length²",
     "The area that each closed curve of intersections encloses, seen along its normal", vertex, false,
     "curves", "area", &finds<ContactKinds::penetration>},
});

FieldForm form_of(const BuiltIn& field) {
  return {field.key,     field.label,     field.doc,  field.unit,
          field.element, field.is_vector, field.list, field.column};
}

FieldForm form_of(const UserField& field) {
  return {"user:" + field.name, field.name, "", "", field.element, field.is_vector};
}

}  // namespace

std::vector<FieldForm> built_in_fields() {
  std::vector<FieldForm> forms;
  for (const BuiltIn& field : built_in) forms.push_back(form_of(field));
  return forms;
}

std::vector<FieldForm> offered_fields(const SceneView& show) {
  std::vector<FieldForm> forms;
  for (const BuiltIn& field : built_in) {
    if (field.is_offered(show)) forms.push_back(form_of(field));
  }
  if (show.program != nullptr) {
    for (const UserField& field : show.program->fields()) forms.push_back(form_of(field));
  }
  return forms;
}

const FieldForm* find_field(const std::vector<FieldForm>& fields, std::string_view key) {
  const auto found =
      std::find_if(fields.begin(), fields.end(), [key](const FieldForm& form) { return form.key == key; });
  return found == fields.end() ? nullptr : &*found;
}

void write_fields(const std::vector<FieldForm>& fields, JsonText& json) {
  json.key("fields");
  json.begin_array();
  for (const FieldForm& form : fields) {
    json.begin_object();
    json.member("key", form.key);
    json.member("label", form.label);
    json.member("doc", form.doc);
    json.member("unit", form.unit);
    json.member("element", form.list.empty() ? word_of(form.element) : "contact");
    json.member("vector", form.is_vector);
    if (!form.list.empty()) {
      json.member("list", form.list);
      json.member("column", form.column);
    }
    json.end_object();
  }
  json.end_array();
}

}  // namespace supple::viewer
