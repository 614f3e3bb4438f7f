// 3MF (https://github.com/3MFConsortium/spec_core) with its production extension: a zip archive with models
// in XML. A model has objects; an object is a mesh, or components that place other objects; the items of the
// build place objects.

#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "animation/transform.hpp"
#include "core/error.hpp"
#include "core/quotes.hpp"
#include "files/number_text.hpp"
#include "readers.hpp"
#include "xml_nodes.hpp"
#include "zip_reader.hpp"

namespace supple {
namespace {

/// An object that an item or a component places.
struct Placement {
  std::string part, object;
  Transform transform = identity_transform;
};

struct ThreeMfObject {
  std::vector<Vec3d> positions;
  std::vector<Triangle> triangles;
  std::vector<Placement> components;
  std::uint64_t size = 0;  // vertices, triangles and placements with those of its components; 0: not known
};

struct Model {
  std::string unit;
  std::map<std::string, ThreeMfObject> objects;
  std::vector<Placement> items;
};

std::string without_slash(std::string path) {
  if (path.starts_with('/')) path.erase(0, 1);
  return path;
}

/// Extensions of 3MF that do not change which triangles an object has. The names of namespaces end with the
/// date of their version.
constexpr std::string_view harmless_extensions[] = {
    "/core/", "/production/", "/material/", "/trianglesets/", "/slice/",
};

/// Reads the model in one part of the archive.
class ModelReader {
 public:
  ModelReader(std::string& text, const std::string& file, const std::string& part)
      : file_(file), part_(part) {
    constexpr unsigned options = pugi::parse_escapes | pugi::parse_wconv_attribute;
    const pugi::xml_parse_result result = document_.load_buffer_inplace(text.data(), text.size(), options);
    if (!result) fail_at(result.offset, one_line(result.description()));
  }

  Model read() {
    const pugi::xml_node root = child(document_, "model");
    if (!root) fail_at(0, "this is not a model of 3MF: it has no element 'model'");
    check_extensions(root);
    Model model;
    model.unit = attribute(root, "unit");
    for (const pugi::xml_node& node : child(root, "resources").children()) {
      if (name_of(node) != "object") continue;
      const std::string id = attribute(node, "id");
      if (!model.objects.try_emplace(id, read_object(node)).second)
        fail_here(node, "two objects have the id " + in_quotes(id));
    }
    for (const pugi::xml_node& node : child(root, "build").children()) {
      if (name_of(node) == "item") model.items.push_back(read_placement(node));
    }
    return model;
  }

 private:
  [[noreturn]] void fail_at(std::ptrdiff_t offset, const std::string& message) const {
    fail(file_ + ", part " + in_quotes(part_) + ", byte " + std::to_string(offset) + ": " + message);
  }
  [[noreturn]] void fail_here(const pugi::xml_node& node, const std::string& message) const {
    fail_at(node.offset_debug(), message);
  }

  void check_extensions(const pugi::xml_node& root) const {
    const std::string required = attribute(root, "requiredextensions");
    constexpr std::string_view blanks = " \t\r\n";
    for (std::size_t first = required.find_first_not_of(blanks); first != std::string::npos;) {
      const std::size_t last = std::min(required.find_first_of(blanks, first), required.size());
      const std::string prefix = required.substr(first, last - first);
      const std::string space = root.attribute(("xmlns:" + prefix).c_str()).value();
      if (std::ranges::none_of(harmless_extensions, [&](std::string_view name) {
            return space.find(name) != std::string::npos;
          })) {
        fail_here(root, "the file requires the extension " + in_quotes(prefix) + " of 3MF (" +
                            one_line(space.substr(0, 100)) +
                            "), which is not supported; export the mesh without it, or as STL");
      }
      first = required.find_first_not_of(blanks, last);
    }
  }

  ThreeMfObject read_object(const pugi::xml_node& node) const {
    if (attribute(node, "meshresolution") == "lowres")
      fail_here(node,
                "the shape of the object is in its slices, which are not supported; export its full mesh");
    ThreeMfObject object;
    const pugi::xml_node mesh = child(node, "mesh");
    for (const pugi::xml_node& vertex : child(mesh, "vertices").children()) {
      if (name_of(vertex) == "vertex") object.positions.push_back(read_vertex(vertex));
    }
    for (const pugi::xml_node& triangle : child(mesh, "triangles").children()) {
      if (name_of(triangle) == "triangle") object.triangles.push_back(read_triangle(triangle, object));
    }
    for (const pugi::xml_node& component : child(node, "components").children()) {
      if (name_of(component) == "component") object.components.push_back(read_placement(component));
    }
    return object;
  }

  Vec3d read_vertex(const pugi::xml_node& node) const {
    Vec3d position;
    for (int axis = 0; axis < 3; ++axis) {
      const char name[] = {"xyz"[axis], '\0'};
      const std::string_view text = node.attribute(name).value();
      const char* end = text.data() + text.size();
      if (text.empty() || parse_double(text.data(), end, position[axis]) != end)
        fail_here(node,
                  std::string("expected a number for ") + name + " of a vertex, found " + in_quotes(text));
    }
    return position;
  }

  Triangle read_triangle(const pugi::xml_node& node, const ThreeMfObject& object) const {
    constexpr const char* names[] = {"v1", "v2", "v3"};
    Triangle triangle;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::string_view text = node.attribute(names[i]).value();
      const char* end = text.data() + text.size();
      std::int64_t id = 0;
      if (text.empty() || parse_integer(text.data(), end, id) != end)
        fail_here(node, std::string("expected an integer for ") + names[i] + " of a triangle, found " +
                            in_quotes(text));
      if (id < 0 || static_cast<std::uint64_t>(id) >= object.positions.size()) {
        fail_here(node, "vertex index " + std::to_string(id) +
                            " of a triangle is out of range; its object has " +
                            std::to_string(object.positions.size()) + " vertices, counted from 0");
      }
      triangle[i] = static_cast<std::uint32_t>(id);
    }
    return triangle;
  }

  Placement read_placement(const pugi::xml_node& node) const {
    Placement placement{without_slash(attribute(node, "path")), attribute(node, "objectid")};
    if (placement.part.empty()) placement.part = part_;
    const std::string text = attribute(node, "transform");
    if (text.empty()) return placement;
    // Twelve numbers: the rows of a matrix that is multiplied from the right.
    const char* place = text.data();
    const char* end = place + text.size();
    const auto skip_blanks = [&] {
      while (place != end && (*place == ' ' || *place == '\t' || *place == '\n' || *place == '\r')) ++place;
    };
    for (std::size_t i = 0; i < 12; ++i) {
      skip_blanks();
      double value = 0;
      const char* next = parse_double(place, end, value);
      if (next == nullptr)
        fail_here(node,
                  "the transform " + in_quotes(text) + " has " + std::to_string(i) + " numbers; it needs 12");
      placement.transform[i % 3][i / 3] = value;
      place = next;
    }
    skip_blanks();
    if (place != end) fail_here(node, "the transform " + in_quotes(text) + " has more than 12 numbers");
    return placement;
  }

  const std::string& file_;
  const std::string& part_;
  pugi::xml_document document_;
};

class ThreeMfReader {
 public:
  ThreeMfReader(std::string_view bytes, const std::string& file) : file_(file), archive_(bytes, file) {}

  MeshFile read() {
    const std::string root = root_part();
    const Model& model = model_in(root);
    if (model.items.empty()) {
      fail(file_ + ": the build of the file has no items, so no object is placed (it has " +
           std::to_string(model.objects.size()) + "); place them in the program that wrote the file");
    }
    result_.frame = {UpAxis::z, metres_of(model.unit)};
    std::uint64_t size = 0;
    for (const Placement& item : model.items) size = std::min(most, size + size_of(item, 0));
    if (size > stored_ + (std::uint64_t{1} << 25)) {
      fail(file_ +
           ": its components repeat objects until there are more than 33 million vertices and triangles; "
           "place fewer copies");
    }
    for (const Placement& item : model.items) append(item, identity_transform);
    return std::move(result_);
  }

 private:
  static constexpr std::uint64_t most = std::uint64_t{1} << 62;

  std::string root_part() {
    const std::string relations = "_rels/.rels";
    if (archive_.contains(relations)) {
      std::string text = archive_.read(relations);
      pugi::xml_document document;
      document.load_buffer_inplace(text.data(), text.size());
      for (const pugi::xml_node& node : child(document, "Relationships").children()) {
        if (attribute(node, "Type").ends_with("/3dmodel")) return without_slash(attribute(node, "Target"));
      }
    }
    const std::string usual = "3D/3dmodel.model";
    if (!archive_.contains(usual)) fail(file_ + ": the zip archive has no 3D model, so it is not a 3MF file");
    return usual;
  }

  Model& model_in(const std::string& part) {
    const auto [place, is_new] = models_.try_emplace(part);
    if (is_new) {
      std::string text = archive_.read(archive_.contains(part) ? part : decoded(part));
      place->second = ModelReader(text, file_, place->first).read();
      for (const auto& [id, object] : place->second.objects)
        stored_ += object.positions.size() + object.triangles.size();
    }
    return place->second;
  }

  // Names of parts are those of the archive, or with %20 and the like.
  static std::string decoded(const std::string& part) {
    std::string result;
    for (std::size_t i = 0; i < part.size(); ++i) {
      const auto digit = [&](std::size_t k) {
        const std::size_t value = std::string_view("0123456789abcdef0123456789ABCDEF").find(part[k]);
        return value == std::string_view::npos ? -1 : static_cast<int>(value % 16);
      };
      if (part[i] == '%' && i + 2 < part.size() && digit(i + 1) >= 0 && digit(i + 2) >= 0) {
        result += static_cast<char>(16 * digit(i + 1) + digit(i + 2));
        i += 2;
      } else {
        result += part[i];
      }
    }
    return result;
  }

  double metres_of(const std::string& unit) const {
    constexpr std::pair<std::string_view, double> units[] = {
        {"", 0.001},      {"micron", 1e-6}, {"millimeter", 0.001}, {"centimeter", 0.01},
        {"inch", 0.0254}, {"foot", 0.3048}, {"meter", 1}};
    for (const auto& [name, metres] : units) {
      if (name == unit) return metres;
    }
    fail(file_ + ": unknown unit " + in_quotes(unit) +
         "; it may be micron, millimeter, centimeter, inch, foot or meter");
  }

  ThreeMfObject& object_of(const Placement& placement) {
    Model& model = model_in(placement.part);
    if (metres_of(model.unit) != result_.frame.unit)
      fail(file_ + ": part " + in_quotes(placement.part) +
           " has another unit than the file; save it with one unit");
    const auto place = model.objects.find(placement.object);
    if (place == model.objects.end())
      fail(file_ + ": there is no object " + in_quotes(placement.object) + " in part " +
           in_quotes(placement.part));
    return place->second;
  }

  // Visits each object once, so that components of components cost no time before there are too many.
  std::uint64_t size_of(const Placement& placement, int depth) {
    constexpr int deepest = 100;
    if (depth > deepest)
      fail(file_ + ": object " + in_quotes(placement.object) + " is nested more than " +
           std::to_string(deepest) + " deep; does it contain itself?");
    ThreeMfObject& object = object_of(placement);
    if (object.size != 0) return object.size;
    std::uint64_t size = 1 + object.positions.size() + object.triangles.size();
    for (const Placement& component : object.components)
      size = std::min(most, size + size_of(component, depth + 1));
    return object.size = size;
  }

  void append(const Placement& placement, const Transform& to_scene) {
    const ThreeMfObject& object = object_of(placement);
    const Transform transform =
        to_scene == identity_transform ? placement.transform : to_scene * placement.transform;
    append(object, transform);
    for (const Placement& component : object.components) append(component, transform);
  }

  void append(const ThreeMfObject& object, const Transform& transform) {
    TriangleMesh& mesh = result_.mesh;
    const auto first = static_cast<std::uint32_t>(mesh.positions.size());
    for (const Vec3d& position : object.positions) mesh.positions.push_back(apply(transform, position));
    const bool turns_around = mirrors(transform);
    for (Triangle triangle : object.triangles) {
      for (std::uint32_t& id : triangle) id += first;
      if (turns_around) std::swap(triangle[1], triangle[2]);
      mesh.triangles.push_back(triangle);
    }
  }

  std::string file_;
  ZipReader archive_;
  std::map<std::string, Model> models_;
  std::uint64_t stored_ = 0;  // vertices and triangles of all models
  MeshFile result_;
};

}  // namespace

MeshFile read_3mf(std::string_view bytes, const std::string& file) {
  return ThreeMfReader(bytes, file).read();
}

}  // namespace supple
