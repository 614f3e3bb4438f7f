#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "failure.hpp"
#include "messages/answers.hpp"
#include "object_arguments.hpp"
#include "pins/pin_commands.hpp"
#include "program/program_commands.hpp"
#include "session_implementation.hpp"

namespace supple::viewer {
namespace {

constexpr std::int64_t most_credit = 8;
constexpr double largest = std::numeric_limits<double>::max();
constexpr std::int64_t largest_count = std::numeric_limits<std::int64_t>::max();

}  // namespace

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
    {"break", &Implementation::set_breaks},
    {"pins", &Implementation::pins},
    {"program", &Implementation::program},
};

// Commands. Each reads and checks everything before it changes anything.

void Session::Implementation::command(std::string_view json) {
  if (has_ended_) return;
  replies_.id.reset();
  if (replies_.full()) {
    replies_.drop_last();
    fail("more than " + std::to_string(Replies::most) + " answers are waiting; some commands were ignored");
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
    replies_.id = id->number;
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
  if (!stage_->recording() && !player_.has_target()) return;
  const auto id = replies_.id;
  advance(0);
  replies_.id = id;
}

void Session::Implementation::run(const Command& command, const JsonValue& text) {
  Arguments arguments(text, command.name);
  if (command.has_answer && !replies_.id)
    return fail(std::string(command.name) + " has an answer, so it needs an \"id\" that is a number");
  if (command.has_answer) catch_up();
  if (command.has_answer && !stage_->is_open()) {
    if (deferred_.size() >= Replies::most)
      return fail(std::string(command.name) + ": too many commands wait");
    return deferred_.push_back(text);
  }
  replies_.begin();
  const auto failure = failure_of([&] { (this->*command.handle)(arguments); });
  if (failure) arguments.fail(failure->message);
  if (!arguments.error().empty()) return fail(arguments.error());
  replies_.end_answer();
}

void Session::Implementation::credit(Arguments& arguments) {
  const auto frames = arguments.required("frames", arguments.integer("frames", 0, largest_count));
  if (!arguments.check()) return;
  credit_ = std::min(most_credit, credit_ + std::min(frames, most_credit));
  if (has_sent_frame_) player_.set_watched(true);  // the page has drawn it
}

void Session::Implementation::play(Arguments& arguments) {
  if (!arguments.check()) return;
  player_.play(*stage_);
  has_news_ = true;
}

void Session::Implementation::pause(Arguments& arguments) {
  if (!arguments.check()) return;
  player_.pause(*stage_);
  has_news_ = true;
}

void Session::Implementation::step(Arguments& arguments) {
  constexpr std::int64_t most_steps = 1'000'000;
  const std::int64_t fewest = stage_->recording() || stage_->history().count() > 0 ? -most_steps : 1;
  const auto count = arguments.integer("count", fewest, most_steps).value_or(1);
  if (count == 0) arguments.must_be("count", "a number of steps other than 0");
  if (!arguments.check()) return;
  player_.step(*stage_, count);
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
  const auto from = arguments.integer("from", 0, largest_count);
  const auto to = arguments.integer("to", from.value_or(0), largest_count);
  if (from.has_value() != to.has_value()) arguments.fail("from and to, the section, need each other");
  if (!has_frames(arguments) || !arguments.check()) return;
  std::optional<std::array<std::uint64_t, 2>> section;
  if (from) section = {static_cast<std::uint64_t>(*from), static_cast<std::uint64_t>(*to)};
  player_.set_loop(on, section);
  has_news_ = true;
}

void Session::Implementation::seek(Arguments& arguments) {
  if (!has_frames(arguments)) return;
  const auto [first, last] = stage_->range();
  const auto step = arguments.required(
      "frame", arguments.integer("frame", static_cast<std::int64_t>(first), static_cast<std::int64_t>(last)));
  if (!arguments.check()) return;
  if (stage_->recording() != nullptr) return player_.seek(static_cast<std::uint64_t>(step));
  if (SimulationSource* const simulation = stage_->simulation(); simulation && simulation->holds()) {
    simulation->release();
    take_state();
  }
  player_.pause(*stage_);
  player_.seek(stage_->history().frame_of(static_cast<std::uint64_t>(step)));
}

void Session::Implementation::layers(Arguments& arguments) {
  const std::vector<FieldForm> fields = offered_fields(scene());
  const auto layers = read_layers(layers_, scene(), fields, arguments);
  if (!layers) return;
  layers_ = *layers;
  field_.choose(find_field(fields, layers_.field));
  has_news_ = true;
}

void Session::Implementation::reset(Arguments& arguments) {
  Settings settings = settings_;
  if (const auto seed = arguments.digits("seed")) settings.restart.seed = *seed;
  if (!is_of_simulation(arguments) || !arguments.check()) return;
  restart(settings);
}

void Session::Implementation::set(Arguments& arguments) {
  if (stage_->program() != nullptr && stage_->past() == nullptr)
    return arguments.fail(
        "the program chooses its options itself; in the past of a program you can choose others");
  const Settings settings =
      read_settings(settings_, show_.simulation.scene, stage_->simulation() != nullptr, arguments);
  if (!arguments.check() || !fits_in_memory(show_, settings, most_memory_, arguments)) return;
  settings.restart == settings_.restart ? change(settings) : restart(settings);
}

void Session::Implementation::replace_stage(std::unique_ptr<Stage> stage) {
  survey_.clear();
  stage_ = std::move(stage);
}

/// Changes how contacts are found. The objects stay where they are: a simulation keeps its state, and a
/// recording its frame. On failure nothing changes.
void Session::Implementation::change(const Settings& settings) {
  if (stage_->recording() != nullptr)
    replace_stage(make_stage(settings, stage_->recording()->frame()));
  else
    stage_->set_detection(show_, settings);
  has_other_options_ = stage_->program() != nullptr;
  settings_ = settings;
  owes_scene_ = true;
}

/// Takes what a program did since the last call. When it has added or removed objects, the page gets the
/// scene again.
void Session::Implementation::follow_program() {
  ProgramSource& source = *stage_->program();
  for (const StepRow& row : source.program().take_rows()) packer_.add_step(row);
  pins_.add(source.program().take_pin_rows());
  if (!stage_->is_open()) return;
  if (stage_->past() == nullptr) {
    if (auto changed = source.changed_view()) {
      show_ = std::move(*changed);
      replace_stage(make_stage(settings_));
      stage_->program()->advance();
      field_.restart();
      keep_objects(layers_, scene().objects.size());
      owes_scene_ = true;
    }
    stage_->keep();
  }
  owes_scene_ = owes_scene_ || offered_fields(scene()) != fields_;
  for (const JsonValue& text : std::exchange(deferred_, {})) obey(text);
}

/// Starts again at the first step. On failure nothing changes.
void Session::Implementation::restart(const Settings& settings) {
  replace_stage(make_stage(settings));
  is_past_ = false;
  settings_ = settings;
  player_.restart();
  keep_objects(layers_, scene().objects.size());
  packer_.restart();
  pins_.restart();
  take_state();
  field_.restart();
  ++numbers_.run;
  owes_scene_ = true;
}

void Session::Implementation::grab(Arguments& arguments) {
  if (!is_of_simulation(arguments)) return;
  if (stage_->past() != nullptr)
    return arguments.fail("the past cannot be pulled; go to the newest step first");
  const std::uint32_t object = read_object("object", scene(), arguments);
  const std::uint32_t vertex = arguments.required("vertex", read_vertex(object, scene(), arguments));
  const auto radius = arguments.number("radius", 0, largest);
  if (radius && !(*radius > 0)) arguments.must_be("radius", "more than 0");
  if (!arguments.check()) return;
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
  if (!stage_->simulation()->holds()) return;
  stage_->simulation()->release();
  take_state();
  has_news_ = true;
}

void Session::Implementation::explain(Arguments& arguments) {
  const ObjectTriangle a = read_object_triangle("a", scene(), arguments),
                       b = read_object_triangle("b", scene(), arguments);
  if (arguments.check()) answer_explain(scene(), stage_->source(), stage_->center(), a, b, replies_.json);
}

void Session::Implementation::measure(Arguments& arguments) {
  const std::uint32_t a = read_object("a", scene(), arguments), b = read_object("b", scene(), arguments);
  if (arguments.check()) answer_measure(scene(), stage_->source(), stage_->center(), a, b, replies_.json);
}

void Session::Implementation::read(Arguments& arguments) {
  const std::uint32_t object = read_object("object", scene(), arguments);
  const auto vertex = read_vertex(object, scene(), arguments);
  const auto triangle = read_triangle(object, scene(), arguments);
  if (vertex && triangle) arguments.fail("give a vertex or a triangle, not both");
  if (!arguments.check()) return;
  if (vertex) {
    answer_read_vertex(stage_->source(), object, *vertex, replies_.json);
    field_.answer(*stage_, FieldElement::vertex, object, *vertex, replies_.json);
  } else if (triangle) {
    answer_read_triangle(scene(), stage_->source(), object, *triangle, replies_.json);
    field_.answer(*stage_, FieldElement::face, object, *triangle, replies_.json);
  } else {
    answer_read_object(scene(), stage_->source(), object, replies_.json);
  }
}

void Session::Implementation::node_pairs(Arguments& arguments) {
  const std::uint32_t a = read_object("a", scene(), arguments), b = read_object("b", scene(), arguments);
  if (arguments.check()) answer_node_pairs(stage_->source(), a, b, replies_.json);
}

bool Session::Implementation::has_frames(Arguments& arguments) const {
  if (stage_->recording() != nullptr || stage_->history().count() > 0) return true;
  arguments.fail("no steps are kept, because the history has no memory");
  return false;
}

bool Session::Implementation::is_of_simulation(Arguments& arguments) const {
  if (!stage_->simulation()) arguments.fail("this is not a simulation; only a simulation can do that");
  return stage_->simulation() != nullptr;
}

bool Session::Implementation::is_of_program(Arguments& arguments) const {
  if (!stage_->program()) arguments.fail("this is not a running program; only a program can do that");
  return stage_->program() != nullptr;
}

void Session::Implementation::set_breaks(Arguments& arguments) {
  if (!is_of_program(arguments)) return;
  const BreakOptions breaks = read_breaks(arguments);
  if (arguments.check()) stage_->program()->program().set_breaks(breaks);
}

/// The pins of a program are measured by its thread, in each step.
void Session::Implementation::pins(Arguments& arguments) {
  auto pins = read_pins(scene(), stage_->source(), arguments);
  if (!pins) return;
  if (ProgramSource* const source = stage_->program()) source->program().set_pins(*pins);
  if (stage_->recording() != nullptr) survey_.set(*pins);
  pins_.set(std::move(*pins));
  if (stage_->program() != nullptr && stage_->is_open())
    pins_.measure(stage_->source().scene(), stage_->source().step(), stage_->source().time());
  has_news_ = true;
}

void Session::Implementation::program(Arguments& arguments) {
  if (!replies_.id) return arguments.fail("it has an answer, so it needs an \"id\" that is a number");
  if (is_of_program(arguments) && arguments.check())
    answer_program(stage_->program()->program().state(), replies_.json);
}

}  // namespace supple::viewer
