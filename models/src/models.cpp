#include "built_in.hpp"

#include <array>
#include <string>

#include "core/error.hpp"
#include "supple/models.hpp"

namespace supple {
namespace {

struct Model {
  std::string_view name;
  TriangleMesh (*make)();
};

constexpr std::array all_models{Model{"pawn", models::make_pawn}, Model{"fish", models::make_fish},
                                Model{"rabbit", models::make_rabbit}, Model{"human", models::make_human},
                                Model{"bike", models::make_bike}};

constexpr auto names = [] {
  std::array<std::string_view, all_models.size()> result;
  for (std::size_t i = 0; i < all_models.size(); ++i) result[i] = all_models[i].name;
  return result;
}();

}  // namespace

std::span<const std::string_view> model_names() {
  return names;
}

TriangleMesh make_model(std::string_view name) {
  for (const Model& model : all_models)
    if (model.name == name) return model.make();

  std::string known;
  for (const std::string_view each : names) known.append(known.empty() ? "" : ", ").append(each);
  fail("unknown model '" + std::string(name) + "'; the built-in models are " + known);
}

}  // namespace supple
