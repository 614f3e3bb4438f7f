#include "user_fields.hpp"

#include <algorithm>
#include <cstddef>
#include <string>

#include "session/failure.hpp"
#include "session/program/attach_descriptions.hpp"
#include "supple/utf8.hpp"

namespace supple::viewer {
namespace {

std::string what_of(std::string_view name, const std::string& object) {
  return "set_field: " + std::string(name) + " of " + object;
}

const char* plural_of(FieldElement element) {
  return element == FieldElement::vertex ? " vertices" : " triangles";
}

/// What the numbers belong to.
FieldElement element_of(const Scene& scene, ObjectId object, std::string_view name, std::size_t count,
                        std::optional<FieldElement> wanted) {
  const std::size_t vertices = scene.vertex_count(object), triangles = scene.triangle_count(object);
  const auto size = [&](FieldElement element) {
    return element == FieldElement::vertex ? vertices : triangles;
  };
  for (const FieldElement element : {FieldElement::vertex, FieldElement::face}) {
    if (count == size(element) && wanted.value_or(element) == element) return element;
  }
  const auto number = [](std::size_t n, FieldElement element) {
    return std::to_string(n) + plural_of(element);
  };
  const std::string has =
      wanted ? number(size(*wanted), *wanted)
             : number(vertices, FieldElement::vertex) + " and " + number(triangles, FieldElement::face);
  fail(what_of(name, scene.options(object).name) + " has " + std::to_string(count) +
       " values, but the object has " + has + "; give one value for each");
}

std::string words_of(const UserField& form) {
  return std::string(form.is_vector ? "a vector" : "a number") + " for each " + word_of(form.element);
}

}  // namespace

void UserFields::set(const Scene& scene, ObjectId object, std::string_view name,
                     std::span<const double> numbers, bool is_vector, std::optional<FieldElement> element) {
  if (name.empty() || valid_utf8(name) != name)
    fail("set_field: a field needs a name in UTF-8, such as stress");
  if (!scene.contains(object))
    fail("set_field: " + std::string(name) +
         ": the object is not in the scene; it was removed, or is of another scene");
  UserField form{std::string(name), FieldElement::vertex, is_vector};
  Values values;
  if (!numbers.empty()) {
    form.element = element_of(scene, object, name, numbers.size() / (is_vector ? 3 : 1), element);
    values = std::make_shared<std::vector<double>>(numbers.begin(), numbers.end());
  }
  const std::lock_guard lock(mutex_);
  for (Field& field : fields_)
    std::erase_if(field.values, [&](const auto& entry) { return !scene.contains(entry.first); });
  if (values) check_form(scene, object, form);
  auto field = std::find_if(fields_.begin(), fields_.end(),
                            [name](const Field& each) { return each.form.name == name; });
  if (field == fields_.end()) field = fields_.insert(fields_.end(), Field{});
  std::erase_if(field->values, [object](const auto& entry) { return entry.first == object; });
  if (values) {
    field->form = std::move(form);
    field->values.emplace_back(object, std::move(values));
  }
  std::erase_if(fields_, [](const Field& each) { return each.values.empty(); });
}

/// Throws when other objects have the field in another form.
void UserFields::check_form(const Scene& scene, ObjectId object, const UserField& form) const {
  const Field* const field = find(form.name);
  if (field == nullptr || field->form == form) return;
  for (const auto& [other, values] : field->values) {
    if (other != object)
      fail(what_of(form.name, scene.options(object).name) + " has " + words_of(form) + ", but " + form.name +
           " of " + scene.options(other).name + " has " + words_of(field->form) +
           "; a field has one form, so use another name");
  }
}

const UserFields::Field* UserFields::find(std::string_view name) const {
  const auto found = std::find_if(fields_.begin(), fields_.end(),
                                  [name](const Field& field) { return field.form.name == name; });
  return found == fields_.end() ? nullptr : &*found;
}

std::vector<UserField> UserFields::list() const {
  const std::lock_guard lock(mutex_);
  std::vector<UserField> forms;
  for (const Field& field : fields_) forms.push_back(field.form);
  return forms;
}

std::shared_ptr<const std::vector<double>> UserFields::values(std::string_view name, ObjectId object) const {
  const std::lock_guard lock(mutex_);
  const Field* const field = find(name);
  if (field == nullptr) return nullptr;
  for (const auto& [id, values] : field->values) {
    if (id == object) return values;
  }
  return nullptr;
}

}  // namespace supple::viewer
