#include "session.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "answers.hpp"
#include "arguments.hpp"
#include "failure.hpp"
#include "frame_message.hpp"
#include "json_text.hpp"
#include "json_value.hpp"
#include "layers.hpp"
#include "message.hpp"
#include "player.hpp"
#include "scene_message.hpp"
#include "settings.hpp"
#include "stage.hpp"

namespace supple::viewer {
namespace {

constexpr std::int64_t most_credit = 8;
constexpr std::size_t most_replies = 256;
constexpr double largest = std::numeric_limits<double>::max();
constexpr std::int64_t largest_id = std::numeric_limits<std::uint32_t>::max();
constexpr std::int64_t largest_count = std::numeric_limits<std::int64_t>::max();

}  // namespace

class Session::Implementation {
 public:
  Implementation(SceneView show, MemoryBudget budget)
      : show_(std::move(show)),
        most_memory_(estimated_memory(show_, settings_) + budget.bytes),
        stage_(std::make_unique<Stage>(show_, settings_)) {
    if (stage_->has_motion()) player_.play(*stage_);
  }

  void greet();
  void command(std::string_view json);
  double advance(double seconds);
  std::span<const std::byte> next_message(MessageWriter& message);
  bool ended() const { return has_ended_; }

 private:
  struct Reply {
    MessageKind kind;
    std::string text;
  };
  using Handler = void (Implementation::*)(Arguments&);
  struct Command {
    const char* name;
    Handler handle;
    bool has_answer = false;  // the command has an answer, so it needs an id
  };
  static const Command commands_[];

  void obey(const JsonValue& command);
  void run(const Command& command, const JsonValue& text);
  void catch_up();

  void credit(Arguments& arguments);
  void play(Arguments& arguments);
  void pause(Arguments& arguments);
  void step(Arguments& arguments);
  void speed(Arguments& arguments);
  void loop(Arguments& arguments);
  void seek(Arguments& arguments);
  void layers(Arguments& arguments);
  void reset(Arguments& arguments);
  void set(Arguments& arguments);
  void grab(Arguments& arguments);
  void drag(Arguments& arguments);
  void release(Arguments& arguments);
  void explain(Arguments& arguments);
  void measure(Arguments& arguments);
  void read(Arguments& arguments);
  void node_pairs(Arguments& arguments);

  void read_octree(const JsonValue& octree, Layers& layers, Arguments& arguments) const;
  void read_colliding_nodes(const JsonValue& nodes, Layers& layers, Arguments& arguments) const;
  void set_stage(const Settings& settings);
  static std::uint32_t id_of(const char* name, Arguments& arguments);
  bool is_of_recording(Arguments& arguments) const;
  bool is_of_simulation(Arguments& arguments) const;
  bool fits_in_memory(const Settings& settings, Arguments& arguments) const;
  bool has_object(std::uint32_t object, Arguments& arguments) const;
  bool has_triangle(std::array<std::uint32_t, 2> triangle, Arguments& arguments) const;
  bool has_vertex(std::uint32_t object, std::uint32_t vertex, Arguments& arguments) const;

  void fail(const std::string& message, bool fatal = false, std::span<const std::string> layers = {});
  void add_reply(MessageKind kind);
  void begin_reply();
  bool pack_frame(MessageWriter& message);

  SceneView show_;
  Settings settings_;
  double most_memory_;  ///< in bytes
  std::unique_ptr<Stage> stage_;
  Player player_;
  Layers layers_;

  bool is_greeted_ = false;
  bool has_ended_ = false;
  std::uint64_t generation_ = 0;
  bool owes_scene_ = false, owes_series_ = false, has_news_ = false;
  std::int64_t credit_ = 0;
  std::deque<Reply> replies_;
  std::optional<double> id_;  // of the current command
  FramePacker packer_;
  JsonText json_;
};

const Session::Implementation::Command Session::Implementation::commands_[] = {
    {"credit", &Implementation::credit},
    {"play", &Implementation::play},
    {"pause", &Implementation::pause},
    {"step", &Implementation::step},
    {"speed", &Implementation::speed},
    {"loop", &Implementation::loop},
    {"seek", &Implementation::seek},
    {"layers", &Implementation::layers},
    {"reset", &Implementation::reset},
    {"set", &Implementation::set},
    {"grab", &Implementation::grab},
    {"drag", &Implementation::drag},
    {"release", &Implementation::release},
    {"explain", &Implementation::explain, true},
    {"measure", &Implementation::measure, true},
    {"read", &Implementation::read, true},
    {"node_pairs", &Implementation::node_pairs, true},
};

void Session::Implementation::greet() {
  is_greeted_ = true;
  owes_scene_ = true;
  has_news_ = true;
  credit_ = 0;
  replies_.clear();
  layers_ = {};
  if (SimulationSource* const simulation = stage_->simulation()) simulation->release();
}

double Session::Implementation::advance(double seconds) {
  if (!is_greeted_ || has_ended_) return Player::idle_seconds;
  Player::Outcome outcome;
  auto failure = failure_of([&] { outcome = player_.advance(*stage_, seconds); });
  if (outcome.failure) failure = Failure{*outcome.failure};
  if (failure) {
    id_.reset();
    player_.pause();
    has_news_ = true;
    if (SimulationSource* const simulation = stage_->simulation(); simulation && !failure->out_of_memory)
      simulation->release();
    fail(failure->message, failure->out_of_memory);
    return 0;
  }
  has_news_ = has_news_ || outcome.changed;
  return outcome.wait;
}

std::span<const std::byte> Session::Implementation::next_message(MessageWriter& message) {
  if (!is_greeted_) return {};
  if (owes_scene_) {
    owes_scene_ = false;
    owes_series_ = stage_->recording() != nullptr;
    has_news_ = true;
    packer_.forget();
    pack_scene(*stage_, ++generation_, json_, message);
  } else if (owes_series_) {
    owes_series_ = false;
    pack_series(*stage_->show().frames, message);
  } else if (!replies_.empty()) {
    message.begin(replies_.front().kind);
    message.add_text(replies_.front().text);
    replies_.pop_front();
  } else if (has_news_ && credit_ > 0 && !has_ended_) {
    has_news_ = false;
    if (!pack_frame(message)) return next_message(message);
    --credit_;
  } else {
    return {};
  }
  return message.finish();
}

/// Returns false on failure, and then drops the optional layers.
bool Session::Implementation::pack_frame(MessageWriter& message) {
  const FrameView frame{stage_->show(), stage_->source(),  layers_,         stage_->center(),
                        generation_,    player_.playing(), player_.speed(), player_.loop()};
  const auto failure = failure_of([&] { packer_.pack(frame, message); });
  if (!failure) return true;
  id_.reset();
  packer_.forget();
  const std::vector<std::string> dropped = layer_names(layers_);
  layers_ = {};
  has_news_ = true;
  fail(failure->message, dropped.empty(), dropped);
  return false;
}

// Commands. Each reads and checks everything before it changes anything.

void Session::Implementation::command(std::string_view json) {
  if (has_ended_) return;
  id_.reset();
  if (replies_.size() >= most_replies) {
    // Limit the replies that wait for a page that does not read them.
    replies_.pop_back();
    fail("more than " + std::to_string(most_replies) + " answers are waiting; some commands were ignored");
    return;
  }
  std::size_t error = 0;
  const auto text = parse_json(json, error);
  if (!text || text->kind != JsonValue::Kind::object) {
    fail("a command must be a JSON object such as {\"do\": \"play\"}; this text is not valid from byte " +
         std::to_string(error) + " on");
    return;
  }
  obey(*text);
}

void Session::Implementation::obey(const JsonValue& text) {
  if (const JsonValue* const id = text.find("id")) {
    if (!id->is_number()) return fail("id must be a number");
    id_ = id->number;
  }
  const JsonValue* const name = text.find("do");
  if (name == nullptr || name->kind != JsonValue::Kind::text)
    return fail("a command needs the member \"do\", such as {\"do\": \"play\"}");
  const std::string& wanted = name->text;
  for (const Command& command : commands_) {
    if (wanted == command.name) return run(command, text);
  }
  std::string list;
  for (const Command& command : commands_) list += (list.empty() ? "" : ", ") + std::string(command.name);
  fail("there is no command " + wanted.substr(0, 40) + "; the commands are " + list);
}

/// Goes to the last requested frame, so that answers refer to it.
void Session::Implementation::catch_up() {
  if (!stage_->recording()) return;
  const auto id = id_;
  advance(0);
  id_ = id;
}

void Session::Implementation::run(const Command& command, const JsonValue& text) {
  Arguments arguments(text, command.name);
  if (command.has_answer && !id_)
    return fail(std::string(command.name) + " has an answer, so it needs an \"id\" that is a number");
  if (command.has_answer) catch_up();
  begin_reply();
  const auto failure = failure_of([&] { (this->*command.handle)(arguments); });
  if (failure) arguments.fail(failure->message);
  if (!arguments.error().empty()) return fail(arguments.error());
  json_.end_object();
  if (id_) add_reply(MessageKind::answer);
}

void Session::Implementation::credit(Arguments& arguments) {
  const auto frames = arguments.required("frames", arguments.integer("frames", 0, largest_count));
  if (!arguments.check()) return;
  credit_ = std::min(most_credit, credit_ + std::min(frames, most_credit));
}

void Session::Implementation::play(Arguments& arguments) {
  if (!arguments.check()) return;
  player_.play(*stage_);
  has_news_ = true;
}

void Session::Implementation::pause(Arguments& arguments) {
  if (!arguments.check()) return;
  player_.pause();
  has_news_ = true;
}

void Session::Implementation::step(Arguments& arguments) {
  constexpr std::int64_t most_steps = 1'000'000;
  const std::int64_t fewest = stage_->recording() ? -most_steps : 1;
  const auto count = arguments.integer("count", fewest, most_steps).value_or(1);
  if (!arguments.check()) return;
  player_.step(count);
  has_news_ = true;
}

void Session::Implementation::speed(Arguments& arguments) {
  auto factor = arguments.required("factor", arguments.number("factor", 0, 10));
  if (factor != 0 && factor < 0.1) arguments.must_be("factor", "0, or from 0.1 to 10");
  if (!arguments.check()) return;
  player_.set_speed(factor);
  has_news_ = true;
}

void Session::Implementation::loop(Arguments& arguments) {
  const bool on = arguments.required("on", arguments.boolean("on"));
  if (!is_of_recording(arguments) || !arguments.check()) return;
  player_.set_loop(on);
  has_news_ = true;
}

void Session::Implementation::seek(Arguments& arguments) {
  if (!is_of_recording(arguments)) return;
  const auto count = static_cast<std::int64_t>(stage_->recording()->frame_count());
  const auto frame =
      arguments.required("frame", arguments.integer("frame", 0, std::max<std::int64_t>(count, 1) - 1));
  if (!arguments.check()) return;
  player_.seek(static_cast<std::uint64_t>(frame));
}

void Session::Implementation::layers(Arguments& arguments) {
  Layers layers = layers_;
  layers.candidates = arguments.boolean("candidates").value_or(layers.candidates);
  layers.scene_regions = arguments.boolean("scene_regions").value_or(layers.scene_regions);
  layers.colliding_vertices = arguments.boolean("colliding_vertices").value_or(layers.colliding_vertices);
  if (const JsonValue* const octree = arguments.member("octree")) {
    layers.octree_objects.clear();
    if (octree->kind != JsonValue::Kind::null) read_octree(*octree, layers, arguments);
  }
  if (const JsonValue* const nodes = arguments.member("colliding_nodes")) {
    layers.colliding_nodes.reset();
    if (nodes->kind != JsonValue::Kind::null) read_colliding_nodes(*nodes, layers, arguments);
  }
  if (!arguments.check()) return;
  layers_ = std::move(layers);
  has_news_ = true;
}

void Session::Implementation::read_octree(const JsonValue& octree, Layers& layers,
                                          Arguments& arguments) const {
  if (octree.kind != JsonValue::Kind::object)
    return arguments.must_be("octree", "null, or {\"objects\": […], \"level\": …}");
  Arguments inner(octree, "octree");
  auto objects = inner.required("objects", inner.numbers("objects"));
  const auto level = inner.required("level", inner.integer("level", -1, 1000));
  for (const std::uint32_t object : objects) {
    if (!has_object(object, inner)) break;
  }
  if (!inner.check()) return arguments.fail(inner.error());
  std::sort(objects.begin(), objects.end());
  objects.erase(std::unique(objects.begin(), objects.end()), objects.end());
  layers.octree_objects = std::move(objects);
  layers.octree_level.reset();
  if (level >= 0) layers.octree_level = static_cast<std::uint32_t>(level);
}

void Session::Implementation::read_colliding_nodes(const JsonValue& nodes, Layers& layers,
                                                   Arguments& arguments) const {
  if (nodes.kind != JsonValue::Kind::object)
    return arguments.must_be("colliding_nodes", "null, or {\"objects\": [a, b], \"level\": …}");
  Arguments inner(nodes, "colliding_nodes");
  const auto objects = inner.numbers("objects");
  const auto level = inner.required("level", inner.integer("level", CollidingNodes::all_levels, 1000));
  if (objects && objects->size() != 2) inner.must_be("objects", "the numbers of two objects");
  for (const std::uint32_t object : objects.value_or(std::vector<std::uint32_t>())) {
    if (!has_object(object, inner)) break;
  }
  if (!inner.check()) return arguments.fail(inner.error());
  layers.colliding_nodes = CollidingNodes{{}, level};
  if (objects) layers.colliding_nodes->objects = {(*objects)[0], (*objects)[1]};
}

void Session::Implementation::reset(Arguments& arguments) {
  Settings settings = settings_;
  if (const auto seed = arguments.digits("seed")) settings.seed = *seed;
  if (!is_of_simulation(arguments) || !arguments.check()) return;
  set_stage(settings);
}

void Session::Implementation::set(Arguments& arguments) {
  Settings settings = settings_;
  const auto keep = [](auto& setting, const auto& value) {
    if (value) setting = static_cast<typename std::remove_reference_t<decltype(setting)>::value_type>(*value);
  };
  const auto read = [&]<class Struct, class Value>(const Field<Struct, Value>& field, Value& value) {
    return is_setting(field) && arguments.option(field, value);
  };
  settings.scene.read(read);
  settings.octree.read(read);
  if (stage_->simulation()) {
    keep(settings.objects, arguments.integer("objects", 1, 100'000));
    keep(settings.integrator, arguments.one_of<Integrator>("integrator"));
    keep(settings.time_step, arguments.number("time_step", 1e-6, 10));
  }
  if (!arguments.check() || !fits_in_memory(settings, arguments)) return;
  set_stage(settings);
}

bool Session::Implementation::fits_in_memory(const Settings& settings, Arguments& arguments) const {
  const double needed = estimated_memory(show_, settings);
  if (needed <= most_memory_) return true;
  const auto megabytes = [](double bytes) {
    return std::to_string(static_cast<std::uint64_t>(bytes / 1e6)) + " MB";
  };
  arguments.fail(std::to_string(settings.objects.value_or(show_.objects.size())) +
                 " objects with such octrees can need " + megabytes(needed) + ", and this session has " +
                 megabytes(most_memory_) +
                 "; show fewer objects, or larger leaves, or use supple view with a larger --max-memory");
  return false;
}

/// On failure nothing changes.
void Session::Implementation::set_stage(const Settings& settings) {
  const std::uint64_t frame = stage_->recording() ? stage_->recording()->step() : 0;
  auto stage = std::make_unique<Stage>(show_, settings, frame);
  stage_ = std::move(stage);
  settings_ = settings;
  player_.restart();
  std::erase_if(layers_.octree_objects,
                [this](std::uint32_t object) { return object >= stage_->show().objects.size(); });
  if (auto& nodes = layers_.colliding_nodes;
      nodes && nodes->objects && std::ranges::max(*nodes->objects) >= stage_->show().objects.size())
    nodes->objects.reset();
  owes_scene_ = true;
}

void Session::Implementation::grab(Arguments& arguments) {
  const auto object = id_of("object", arguments), vertex = id_of("vertex", arguments);
  const auto radius = arguments.number("radius", 0, largest);
  if (radius && !(*radius > 0)) arguments.must_be("radius", "more than 0");
  if (!is_of_simulation(arguments) || !has_vertex(object, vertex, arguments) || !arguments.check()) return;
  if (const auto reason = stage_->simulation()->grab(object, vertex, radius)) return arguments.fail(*reason);
  has_news_ = true;
}

void Session::Implementation::drag(Arguments& arguments) {
  const Vec3d to = arguments.required("to", arguments.point("to"));
  if (!is_of_simulation(arguments) || !arguments.check()) return;
  if (!stage_->simulation()->holds()) return arguments.fail("nothing is held; grab a vertex first");
  stage_->simulation()->drag(stage_->center().back(to));
}

void Session::Implementation::release(Arguments& arguments) {
  if (!is_of_simulation(arguments) || !arguments.check()) return;
  stage_->simulation()->release();
  has_news_ = true;
}

void Session::Implementation::explain(Arguments& arguments) {
  const auto a = arguments.required("a", arguments.pair("a")),
             b = arguments.required("b", arguments.pair("b"));
  if (!has_triangle(a, arguments) || !has_triangle(b, arguments) || !arguments.check()) return;
  answer_explain(stage_->show(), stage_->source(), stage_->center(), a, b, json_);
}

void Session::Implementation::measure(Arguments& arguments) {
  const auto a = id_of("a", arguments), b = id_of("b", arguments);
  if (!has_object(a, arguments) || !has_object(b, arguments) || !arguments.check()) return;
  answer_measure(stage_->show(), stage_->source(), stage_->center(), a, b, json_);
}

void Session::Implementation::read(Arguments& arguments) {
  const auto object = id_of("object", arguments);
  const auto vertex = arguments.integer("vertex", 0, largest_id);
  const auto triangle = arguments.integer("triangle", 0, largest_id);
  if (vertex && triangle) arguments.fail("give a vertex or a triangle, not both");
  if (!has_object(object, arguments)) return;
  if (vertex && !has_vertex(object, static_cast<std::uint32_t>(*vertex), arguments)) return;
  if (triangle && !has_triangle({object, static_cast<std::uint32_t>(*triangle)}, arguments)) return;
  if (!arguments.check()) return;
  const Source& source = stage_->source();
  if (vertex)
    answer_read_vertex(source, object, static_cast<std::uint32_t>(*vertex), json_);
  else if (triangle)
    answer_read_triangle(stage_->show(), source, object, static_cast<std::uint32_t>(*triangle), json_);
  else
    answer_read_object(stage_->show(), source, object, json_);
}

void Session::Implementation::node_pairs(Arguments& arguments) {
  const auto a = id_of("a", arguments), b = id_of("b", arguments);
  if (!has_object(a, arguments) || !has_object(b, arguments) || !arguments.check()) return;
  answer_node_pairs(stage_->source(), a, b, json_);
}

std::uint32_t Session::Implementation::id_of(const char* name, Arguments& arguments) {
  return static_cast<std::uint32_t>(arguments.required(name, arguments.integer(name, 0, largest_id)));
}

bool Session::Implementation::is_of_recording(Arguments& arguments) const {
  if (stage_->recording()) return true;
  arguments.fail("this is a simulation; only a recording can do that");
  return false;
}

bool Session::Implementation::is_of_simulation(Arguments& arguments) const {
  if (stage_->simulation()) return true;
  arguments.fail("this is a recording; only a simulation can do that");
  return false;
}

bool Session::Implementation::has_object(std::uint32_t object, Arguments& arguments) const {
  const std::size_t count = stage_->show().objects.size();
  if (object < count) return true;
  arguments.fail("there is no object " + std::to_string(object) + "; there are " + std::to_string(count) +
                 ", numbered from 0");
  return false;
}

bool Session::Implementation::has_vertex(std::uint32_t object, std::uint32_t vertex,
                                         Arguments& arguments) const {
  if (!has_object(object, arguments)) return false;
  const std::size_t count = stage_->show().objects[object].mesh.positions.size();
  if (vertex < count) return true;
  arguments.fail("object " + std::to_string(object) + " has no vertex " + std::to_string(vertex) +
                 "; it has " + std::to_string(count) + ", numbered from 0");
  return false;
}

bool Session::Implementation::has_triangle(std::array<std::uint32_t, 2> triangle,
                                           Arguments& arguments) const {
  if (!has_object(triangle[0], arguments)) return false;
  const std::size_t count = stage_->show().objects[triangle[0]].mesh.triangles.size();
  if (triangle[1] < count) return true;
  arguments.fail("object " + std::to_string(triangle[0]) + " has no triangle " + std::to_string(triangle[1]) +
                 "; it has " + std::to_string(count) + ", numbered from 0");
  return false;
}

// Replies.

void Session::Implementation::begin_reply() {
  json_.clear();
  json_.begin_object();
  if (id_) json_.member("id", *id_);
}

void Session::Implementation::add_reply(MessageKind kind) {
  replies_.push_back({kind, std::string(json_.text())});
}

/// `layers` are the layers that frames no longer contain.
void Session::Implementation::fail(const std::string& message, bool fatal,
                                   std::span<const std::string> layers) {
  has_ended_ = fatal;
  begin_reply();
  json_.member("message", message);
  json_.member("fatal", fatal);
  if (!layers.empty()) json_.member("layers", layers);
  json_.end_object();
  add_reply(MessageKind::failure);
}

Session::Session(SceneView show, MemoryBudget budget)
    : implementation_(std::make_unique<Implementation>(std::move(show), budget)) {}
Session::~Session() = default;
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;

void Session::greet() {
  implementation_->greet();
}
void Session::command(std::string_view json) {
  implementation_->command(json);
}
double Session::advance(double seconds) {
  return implementation_->advance(seconds);
}
std::span<const std::byte> Session::next_message(MessageWriter& message) {
  return implementation_->next_message(message);
}
bool Session::ended() const {
  return implementation_->ended();
}

}  // namespace supple::viewer
