#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "supple/call_limits.hpp"
#include "supple/scene.hpp"
#include "supple/simulation.hpp"
#include "supple/types.hpp"

namespace supple::viewer {

/// Events that pause a program. Each pauses it in the step in which it begins, not again while it lasts. The
/// page can change them.
struct BreakOptions {
  /// Two objects begin to touch: with intersections or continuous contacts.
  bool contact_begin = false;
  /// Only contacts with these objects, by name: of one, or between both. Empty: any object.
  std::array<std::string, 2> objects{};
  bool intersection = false;                      ///< there are intersections
  std::optional<std::uint64_t> contacts_above{};  ///< there are more contacts, of all kinds together
  std::optional<double> depth_above{};            ///< a vertex is deeper inside a solid; penetration
  bool not_finite = false;                        ///< a vertex is NaN or infinite

  bool operator==(const BreakOptions&) const = default;
};

/// How a program is shown; see `attach`.
struct AttachOptions {
  std::string title{};                ///< of the page; "my program" when empty
  std::string address = "127.0.0.1";  ///< an IP address of this machine
  std::uint16_t port = 0;             ///< 0: any free port
  /// Keeps the token of the address, so that a page finds the program again when it is started again with the
  /// same port. Made when it does not exist.
  std::string token_file{};
  bool open_browser = true;  ///< opens the page in the user's browser, if there is a screen
  /// The share of the program's time that frames may take, at least 0. The page then gets fewer frames, but
  /// one that waits gets one every two seconds. A pause does not count.
  double max_slowdown = 0.03;
  double time_step = 0;  ///< seconds between two steps, for the time that the page shows; 0: no time
  /// The first step and each break wait until a page is connected. Without this option, nothing waits while
  /// no page is connected.
  bool wait_for_page = false;
  /// Memory in bytes for the positions of the last steps that the page got, at least 0. The page can go back
  /// to these steps, and computes speeds from them; 0 keeps none.
  double history_bytes = 5e8;
  /// Makes a second address: whoever opens it sees what the page shows of the scene, with a camera of their
  /// own, and controls nothing. See `View::watching_url`.
  bool spectators = false;
  BreakOptions breaks{};
};

/// What has the values of a field.
enum class FieldElement : std::uint8_t { vertex, face };

/// The connection of a program to a page. Its destructor closes it.
class View {
 public:
  /// The threads of the view.
  class Implementation;
  /// `attach` calls it.
  explicit View(std::unique_ptr<Implementation> implementation);
  View(View&&) noexcept;
  View& operator=(View&&) noexcept;
  ~View();

  /// The address of the page, with a secret token.
  const std::string& url() const;
  /// The address for those who may only watch, with another secret token; empty without
  /// `AttachOptions::spectators`.
  const std::string& watching_url() const;
  std::uint64_t step_count() const;   ///< steps since `attach`
  std::uint64_t frame_count() const;  ///< steps that the page was given
  double seconds_in_steps() const;    ///< time that frames have taken, without pauses
  bool is_paused() const;             ///< the program waits, or will in the next step
  /// Throws `Error` when the last step did not detect the kind of contacts that an event needs.
  void set_breaks(const BreakOptions& breaks);
  /// Shows the user's own numbers as the field `name`, which the page can choose: one for each vertex of an
  /// object, or one for each triangle. Frames from the next `detect` on have them, until they are set again.
  /// NaN is no value, and no numbers end the field of the object. Without an element, the count decides, and
  /// a count that fits both is that of vertices. All objects of a field have the same element. Copies the
  /// numbers, O(n). Any thread can call it while nothing adds or removes objects. Throws `Error` when the
  /// count fits neither vertices nor triangles of the object, or not the element, when the name is empty or
  /// not UTF-8, and when other objects have this field with another element, or as vectors.
  void set_field(ObjectId object, std::string_view name, std::span<const double> values,
                 std::optional<FieldElement> element = {});
  /// The same for vectors, which the page draws as arrows.
  void set_field(ObjectId object, std::string_view name, std::span<const Vec3d> values,
                 std::optional<FieldElement> element = {});
  /// Shows the last step until the page continues the program, the view is closed, or a stop is requested.
  /// The scene must exist, and must not have been moved.
  void wait(const CallLimits& limits = {});
  /// Ends a pause, tells the page that the program has ended, and frees the port. Later steps are not shown.
  /// Any thread can call it.
  void close();

 private:
  std::unique_ptr<Implementation> implementation_;
};

/// Shows a scene in a page while the program runs: from now on, `detect` shows its result. Replaces the
/// observer of the scene. The page can pause the program in `detect`, take single steps, and set breaks. The
/// page reads the user's scene itself, only while `detect` waits. Threads: one for the session, one for the
/// network. Throws `Error` when an option is out of range, when the scene does not detect the kind of
/// contacts that a break needs, when the address is not available, and when the library was built without
/// SUPPLE_BUILD_VIEWER.
View attach(Scene& scene, const AttachOptions& options = {});
/// The same for the scene of a simulation. The time step defaults to that of the simulation.
View attach(Simulation& simulation, const AttachOptions& options = {});

}  // namespace supple::viewer
