#include "pins/pin_commands.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>

#include "object_arguments.hpp"
#include "sources/start.hpp"

namespace supple::viewer {
namespace {

constexpr std::size_t most_pins = 32;
constexpr std::int64_t largest_number = 0xfffffffe;

/// Four numbers of two triangles, or seven of two elements and their kind.
bool is_contact_of(const std::vector<std::uint32_t>& contact, const std::vector<std::uint32_t>& objects) {
  if (contact.size() != 4 && contact.size() != 7) return false;
  const std::uint32_t a = contact[0], b = contact[contact.size() == 4 ? 2 : 3];
  return objects.size() == 2 && a == objects[0] && b == objects[1];
}

Pin read_pin(const SceneView& scene, const Source& source, Arguments& entry) {
  Pin pin;
  pin.number = static_cast<std::uint32_t>(entry.required("pin", entry.integer("pin", 0, largest_number)));
  const auto objects = entry.required("objects", entry.numbers("objects"));
  if (!entry.error().empty()) return pin;
  if (objects.empty() || objects.size() > 2) {
    entry.must_be("objects", "one or two numbers of objects");
    return pin;
  }
  for (const std::uint32_t object : objects) {
    if (!has_object(object, scene, entry)) return pin;
    pin.objects.push_back(source.id(object));
  }
  if (objects.size() == 1)
    pin.start =
        std::make_shared<const std::vector<Vec3d>>(start_of(scene, scene.objects[objects.front()]).positions);
  if (auto contact = entry.numbers("contact")) {
    if (!is_contact_of(*contact, objects))
      entry.must_be("contact",
                    "the first four numbers of a row of contacts, or seven of impacts, of these objects");
    pin.contact = std::move(*contact);
  }
  return pin;
}

}  // namespace

std::optional<std::vector<Pin>> read_pins(const SceneView& scene, const Source& source,
                                          Arguments& arguments) {
  const JsonValue* const list = arguments.member("pins");
  if (list == nullptr || list->kind != JsonValue::Kind::list || list->elements.size() > most_pins) {
    arguments.fail("it needs \"pins\", a list of at most " + std::to_string(most_pins) + " pins");
    return std::nullopt;
  }
  std::vector<Pin> pins;
  for (const JsonValue& element : list->elements) {
    const std::string name = "pin " + std::to_string(pins.size()) + " of the list";
    if (element.kind != JsonValue::Kind::object) {
      arguments.fail(name + " is not an object");
      break;
    }
    Arguments entry(element, name);
    pins.push_back(read_pin(scene, source, entry));
    if (!entry.check()) arguments.fail(entry.error());
    for (std::size_t i = 0; i + 1 < pins.size(); ++i) {
      if (pins[i].number == pins.back().number)
        arguments.fail(name + " has the number of another pin: " + std::to_string(pins[i].number));
    }
  }
  if (!arguments.check()) return std::nullopt;
  return pins;
}

void write_pin_values(JsonText& json) {
  json.key("pin_values");
  json.begin_array();
  for_each_field<PinValues>([&](const auto& field) {
    json.begin_object();
    json.member("key", field.key);
    json.member("doc", field.doc);
    json.member("unit", field.unit);
    json.end_object();
  });
  json.end_array();
}

}  // namespace supple::viewer
