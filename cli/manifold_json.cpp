#include "manifold_json.hpp"

#include "session/described_json.hpp"
#include "supple/result_descriptions.hpp"

namespace supple::cli {
namespace {

void write_objects(JsonWriter& json, ObjectId a, ObjectId b) {
  json.member("a", std::uint64_t{a.index});
  json.member("b", std::uint64_t{b.index});
}

}  // namespace

void write_manifolds(JsonWriter& json, const DetectResult& result) {
  json.key("manifolds");
  json.begin_array();
  for (const Manifold& manifold : result.manifolds) {
    json.begin_object();
    write_objects(json, manifold.a, manifold.b);
    viewer::write_members(json, manifold);
    json.key("points");
    json.begin_array();
    for (const ManifoldPoint& point : result.points_of(manifold)) {
      json.begin_object();
      viewer::write_members(json, point);
      json.end_object();
    }
    json.end_array();
    json.end_object();
  }
  json.end_array();
  json.key("ended_manifolds");
  json.begin_array();
  for (const EndedManifold& ended : result.ended_manifolds) {
    json.begin_object();
    write_objects(json, ended.a, ended.b);
    json.member("id", ended.id);
    json.end_object();
  }
  json.end_array();
}

}  // namespace supple::cli
