#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "supple/scene.hpp"
#include "supple/viewer.hpp"

namespace supple::viewer {

struct Pin;
struct PinRow;

/// Why a program was paused, and where.
struct Break {
  std::string event{};  ///< the name of a member of `BreakOptions`
  std::string text{};   ///< a sentence
  std::uint64_t step = 0;
  std::array<std::optional<ObjectId>, 2> objects{};
  std::optional<Vec3d> point{};  ///< one of its places
};

/// A step at which a program waits.
struct ProgramStep {
  const Scene* scene = nullptr;
  ContactKinds contacts = ContactKinds::none;  ///< that were detected
};

/// The statistics and the events of a step, which may have had no frame.
struct StepRow {
  struct Events {
    std::vector<ObjectPair> begin{}, end{};
  };
  std::uint64_t step = 0;
  StepStats stats{};
  Events contacts{}, volumes{};
};

/// A field of the user; see `View::set_field`.
struct UserField {
  std::string name{};
  FieldElement element = FieldElement::vertex;
  bool is_vector = false;

  bool operator==(const UserField&) const = default;
};

/// What a session must know between two steps.
struct ProgramState {
  bool runs = true;               ///< not paused
  bool is_held = false;           ///< waits until the page continues it
  std::uint64_t step_count = 0;   ///< since the session started
  std::uint64_t last_step = 0;    ///< `DetectResult::step`
  std::optional<Break> reason{};  ///< of the pause
  BreakOptions breaks{};
  double seconds_since_step = 0;  ///< 0 while the program waits in a step
};

/// A running program whose scene a session shows. The session may read the scene only between `enter` and
/// `leave`, while the program waits.
class Program {
 public:
  Program() = default;
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  virtual ~Program() = default;

  /// Requests a step: the program waits for `enter` in the next one that its time allows.
  virtual void request() = 0;
  /// Null when the program does not wait.
  virtual const ProgramStep* enter() = 0;
  /// A program that is not paused goes on.
  virtual void leave() = 0;
  /// The session has made a frame of the step.
  virtual void take_frame() = 0;

  virtual void set_page(bool is_connected) = 0;
  virtual void run() = 0;
  virtual void pause() = 0;
  /// Pauses after `count` more steps.
  virtual void step(std::uint64_t count) = 0;
  virtual void set_breaks(const BreakOptions& breaks) = 0;
  virtual ProgramState state() const = 0;
  /// The steps since the last call, the last ones if they are very many.
  virtual std::vector<StepRow> take_rows() = 0;
  /// What is measured in each step from now on.
  virtual void set_pins(std::vector<Pin> pins) = 0;
  /// The rows of the pins since the last call, the last ones if they are very many.
  virtual std::vector<PinRow> take_pin_rows() = 0;
  virtual double time_step() const = 0;

  virtual std::vector<UserField> fields() const = 0;
  /// One or three numbers for each element of the object; null when it has none.
  virtual std::shared_ptr<const std::vector<double>> field_values(std::string_view name,
                                                                  ObjectId object) const = 0;
};

}  // namespace supple::viewer
