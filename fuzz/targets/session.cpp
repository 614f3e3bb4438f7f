// Commands to a viewer's session. The first byte chooses the scene; then each line is a command, and an empty
// line lets time pass.

#include <string_view>

#include "scene_view.hpp"
#include "session.hpp"
#include "supple/error.hpp"
#include "supple/models.hpp"
#include "support/byte_reader.hpp"
#include "support/session_messages.hpp"

namespace {

using namespace supple;

constexpr int most_commands = 40;

viewer::ViewedObject ball(const char* name, Vec3d at) {
  viewer::ViewedObject object{make_icosphere(2)};
  object.options.name = name;
  for (Vec3d& p : object.mesh.positions) p = p + at;
  return object;
}

/// The frames of a recording in which the first object moves.
class MovingFrames final : public viewer::Frames {
 public:
  explicit MovingFrames(const std::vector<viewer::ViewedObject>& objects) {
    for (const viewer::ViewedObject& object : objects) rest_.push_back(object.mesh.positions);
    series_.names = {"time"};
    for (std::uint64_t frame = 0; frame < count(); ++frame)
      series_.values.push_back(0.1 * static_cast<double>(frame));
  }
  std::uint64_t count() const override { return 5; }
  void read(std::uint64_t frame, std::size_t object, std::span<Vec3d> positions) const override {
    for (std::size_t v = 0; v < positions.size(); ++v)
      positions[v] = rest_[object][v] + Vec3d{object == 0 ? 0.2 * static_cast<double>(frame) : 0, 0, 0};
  }
  const viewer::Series& series() const override { return series_; }

 private:
  std::vector<std::vector<Vec3d>> rest_;
  viewer::Series series_;
};

viewer::SceneView scene(std::uint32_t choice) {
  viewer::SceneView show;
  show.title = "balls";
  show.simulation.scene.threads = 1;
  show.objects = {ball("waves", {}), ball("soft", {1.8, 0, 0}), ball("rigid", {0, 0, 1.8}),
                  ball("rest", {-1.8, 0, 0})};
  if (choice % 4 == 1) {
    show.frames = std::make_shared<MovingFrames>(show.objects);
    return show;
  }
  show.objects[0].motion = WaveMotion{.amplitude = 0.05};
  show.objects[1].motion = MassSpringMotion{.velocity = {-1, 0, 0}};
  show.objects[2].motion = RigidMotion{.velocity = {0, 0, -1}};
  if (choice % 4 == 2) show.simulation.scene.contacts = ContactKinds::continuous;
  if (choice % 4 == 3) {
    show.simulation.scene.contacts = ContactKinds::penetration | ContactKinds::proximity;
    for (viewer::ViewedObject& object : show.objects) {
      object.options.solid = true;
      object.options.margin = 0.1;
    }
  }
  return show;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::ByteReader bytes(data, size);
  viewer::Session session(scene(bytes.byte()), {1e7});
  viewer::MessageWriter writer;
  session.greet();
  std::string_view rest = bytes.text();
  for (int i = 0; i < most_commands && !rest.empty() && !session.ended(); ++i) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
    if (line.empty())
      session.advance(0.02);
    else
      session.command(line);
    fuzz::drain(session, writer);
  }
  session.command(R"({"do": "credit", "frames": 1})");
  session.advance(0.02);
  fuzz::drain(session, writer);
  return 0;
}
