// Writes messages of sessions in which every kind of every record occurs, for the test of the page's reader.
// Exits with 1 when a kind occurs in none, so that a new kind must be added to the scenes here.
//
// usage: record_kinds FOLDER

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lists/lists_of_frames.hpp"
#include "session.hpp"
#include "supple/inspection_descriptions.hpp"
#include "supple/models.hpp"
#include "supple/result_descriptions.hpp"
#include "support/viewer_messages.hpp"

namespace {

using supple::ContactKinds;
using supple::TriangleMesh;
using supple::Vec3d;
using supple::ViewerMessage;
using supple::viewer::SceneView;

SceneView scene_of(const char* title, ContactKinds kinds, std::vector<TriangleMesh> meshes) {
  SceneView show;
  show.title = title;
  show.simulation.scene.contacts = kinds;
  for (TriangleMesh& mesh : meshes) {
    mesh.name = "object " + std::to_string(show.objects.size());
    show.objects.push_back({std::move(mesh)});
    show.objects.back().options.margin = 0.5;
  }
  return show;
}

/// Particles, a triangle, rods and particles again, which touch in all kinds of pairs.
std::vector<TriangleMesh> rods_and_particles() {
  const TriangleMesh triangle{"", {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}}, {{0, 1, 2}}};
  const TriangleMesh rods{"", {{2, -1, 0}, {2, 1, 0}, {5, 5, -1}, {5, 5, 1}}, {}, {{0, 1}, {2, 3}}, {}};
  const TriangleMesh first{"", {{1, 1, 0}, {5, 5, 0}, {6, 6, 0}}, {}, {}, {0, 1, 2}};
  const TriangleMesh last{"", {{1.5, 1, 0}, {5, 5, 0.5}, {6, 6, 0}}, {}, {}, {0, 1, 2}};
  return {first, triangle, rods, last};
}

TriangleMesh moved(TriangleMesh mesh, const Vec3d& by) {
  for (Vec3d& p : mesh.positions) p += by;
  return mesh;
}

/// Pairs of objects, far from each other, whose curves and intersections are of all kinds.
std::vector<TriangleMesh> intersecting() {
  const TriangleMesh sphere = supple::make_icosphere(2);
  const TriangleMesh sheet{"", {{10, -1, 0}, {12, -1, 0}, {11, 1, 0}}, {{0, 1, 2}}};
  const TriangleMesh blade{"", {{11, -0.5, -1}, {11, 0, -1}, {11, -0.25, 1}}, {{0, 1, 2}}};
  const TriangleMesh tip{"", {{10.5, -0.75, 0}, {10, -0.75, 1}, {10.5, -0.5, 1}}, {{0, 1, 2}}};
  const TriangleMesh box = moved(supple::make_box({1, 1, 1}, 1), {20, 0, 0});
  return {sphere, moved(sphere, {1.4, 0.13, 0.07}), sheet, blade, tip, box, moved(box, {0.25, 1, 0.25})};
}

/// The kinds that occurred, by the name of the record.
class Kinds {
 public:
  void add(const ViewerMessage& frame) {
    add(frame, "contacts", "kind", "contact");
    add(frame, "continuous_contacts", "kind", "impact");
    add(frame, "continuous_contacts", "certainty", "certainty");
    add(frame, "curves", "kind", "curve");
  }
  template <class Enum>
  bool has_all(const std::string& record) {
    bool all = true;
    for (std::uint32_t i = 0; i < supple::words<Enum>.size(); ++i) {
      if (found_[record].contains(i)) continue;
      std::fprintf(stderr, "no %s of kind %s occurs; add one to the scenes of this program\n", record.c_str(),
                   supple::words<Enum>[i]);
      all = false;
    }
    return all;
  }

 private:
  void add(const ViewerMessage& frame, std::string_view list, std::string_view name, const char* record) {
    std::uint32_t number = 0;
    for (const supple::viewer::ListOfFrames& each : supple::viewer::lists_of_frames()) {
      for (const supple::viewer::Column& column : each.columns) {
        const std::uint32_t section = number++;
        if (list != each.info->name || name != column.name || !frame.has(33, section)) continue;
        for (const std::uint8_t kind : frame.values<std::uint8_t>(33, section)) found_[record].insert(kind);
      }
    }
  }
  std::map<std::string, std::set<std::uint32_t>> found_;
};

void write(const std::filesystem::path& path, const char* data, std::size_t size) {
  std::ofstream file(path, std::ios::binary);
  file.write(data, static_cast<std::streamsize>(size));
  if (!file.flush()) throw std::runtime_error("cannot write " + path.string());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return std::fprintf(stderr, "usage: %s FOLDER\n", argv[0]), 2;
  const std::filesystem::path folder = argv[1];
  std::filesystem::create_directories(folder);
  std::vector<SceneView> scenes{
      scene_of("impacts", ContactKinds::continuous | ContactKinds::proximity, rods_and_particles()),
      scene_of("undecided", ContactKinds::continuous, rods_and_particles()),
      scene_of("curves", ContactKinds::penetration | ContactKinds::proximity, intersecting())};
  scenes[1].simulation.scene.impact.exact = false;
  for (const std::size_t i : {0u, 1u}) scenes[2].objects[i].options.solid = true;

  Kinds kinds;
  nlohmann::json list{{"sessions", nlohmann::json::array()}};
  for (const SceneView& show : scenes) {
    supple::viewer::Session session(show);
    session.greet();
    session.command(
        R"({"do": "layers", "candidates": true, "scene_regions": true, "colliding_vertices": true,
            "octree": {"objects": [1], "level": -1}, "colliding_nodes": {"level": -1}})");
    nlohmann::json files = nlohmann::json::array();
    supple::viewer::MessageWriter writer;
    const auto drain = [&] {
      for (auto bytes = session.next_message(writer); !bytes.empty(); bytes = session.next_message(writer)) {
        const ViewerMessage message(bytes);
        if (message.kind == ViewerMessage::frame) kinds.add(message);
        files.push_back(show.title + " " + std::to_string(files.size()) + ".bin");
        write(folder / files.back().get<std::string>(), reinterpret_cast<const char*>(bytes.data()),
              bytes.size());
      }
    };
    drain();
    for (int step = 0; step < 2; ++step) {
      session.command(R"({"do": "credit", "frames": 1})");
      session.advance(0.02);
      drain();
    }
    list["sessions"].push_back(files);
  }
  list["stages"] = supple::words<supple::PairStage>;
  const std::string text = list.dump(1);
  write(folder / "kinds.json", text.data(), text.size());
  bool all = kinds.has_all<supple::IntersectionKind>("contact");
  all = kinds.has_all<supple::ElementPairKind>("impact") && all;
  all = kinds.has_all<supple::ImpactCertainty>("certainty") && all;
  all = kinds.has_all<supple::CurveKind>("curve") && all;
  return all ? 0 : 1;
}
